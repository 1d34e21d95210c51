//! Printing of expressions: the order of terms and factors, the parentheses, the fractions. The
//! three notations (file, Unicode, LaTeX) differ only in a [`Style`].

use std::cmp::Reverse;

use super::node::{Expr, FunctionId, Node};
use super::pool::Pool;
use super::symbol::{Rank, Symbol};
use crate::num::Number;

type OrderOfTerm = (Reverse<Rank>, bool, usize, bool, [Vec<Symbol>; 3], Expr);

/// The binding strength of a written piece.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) enum BindingStrength {
    Sum,
    Product,
    Power,
    Atom,
}

pub(super) struct PrintedPiece {
    pub(super) text: String,
    pub(super) level: BindingStrength,
}

/// The decisions of one notation.
pub(super) trait Style {
    fn symbol<'p>(&self, pool: &'p Pool, e: Expr) -> &'p str;
    fn pi(&self) -> &'static str;
    fn minus(&self) -> &'static str;
    /// A positive number as a factor.
    fn number(&self, n: Number) -> PrintedPiece;
    fn parenthesise(&self, inner: &str) -> String;
    fn join(&self, factors: &[String]) -> String;
    /// One piece over another; on one line unless the style overrides it.
    fn fraction(&self, above: &PrintedPiece, below: &PrintedPiece) -> PrintedPiece {
        let wrap = |piece: &PrintedPiece, level| {
            if piece.level < level { self.parenthesise(&piece.text) } else { piece.text.clone() }
        };
        let text = format!(
            "{}/{}",
            wrap(above, BindingStrength::Product),
            wrap(below, BindingStrength::Power)
        );
        PrintedPiece { text, level: BindingStrength::Product }
    }
    /// `base ^ exponent` for a positive numeric exponent other than one.
    fn numeric_power(&self, printer: &Printer<'_>, base: Expr, exponent: Number) -> PrintedPiece;
    /// `base` to any power; on one line unless the style overrides it.
    fn power(&self, base: &str, exponent: &PrintedPiece) -> PrintedPiece {
        let text = if exponent.level == BindingStrength::Atom {
            format!("{base}^{}", exponent.text)
        } else {
            format!("{base}^{}", self.parenthesise(&exponent.text))
        };
        PrintedPiece { text, level: BindingStrength::Power }
    }
    fn call(&self, printer: &Printer<'_>, function: FunctionId, arguments: &[Expr])
    -> PrintedPiece;
    /// Returns whether a fractional coefficient is written in front (`½ m`) and not in the
    /// fraction.
    fn coefficient_in_front(&self, n: Number, has_denominator: bool) -> bool;
    /// Returns whether terms and factors are ordered as in a textbook; else in the order of their handles.
    fn textbook(&self) -> bool {
        true
    }
    /// Returns whether a quotient of constants stands before functions: `(g/l) sin θ`.
    fn constants_apart(&self) -> bool {
        true
    }
}

/// Writes expressions of one pool in one style.
pub(super) struct Printer<'p> {
    pub(super) pool: &'p Pool,
    pub(super) style: &'p dyn Style,
}

impl Printer<'_> {
    pub(super) fn piece(&self, e: Expr) -> PrintedPiece {
        match self.pool.node(e) {
            Node::Number(n) => self.signed_number(*n),
            Node::Pi => {
                PrintedPiece { text: self.style.pi().to_owned(), level: BindingStrength::Atom }
            }
            Node::Symbol(_) => PrintedPiece {
                text: self.style.symbol(self.pool, e).to_owned(),
                level: BindingStrength::Atom,
            },
            Node::Sum(constant, terms) => self.sum(*constant, terms),
            Node::Product(c, factors) => self.product(*c, factors),
            Node::Power(base, exponent) => {
                let base = self.at_least(*base, BindingStrength::Atom);
                self.style.power(&base, &self.piece(*exponent))
            }
            Node::Call(function, arguments) => self.style.call(self, *function, arguments),
        }
    }

    /// The text of a part, in parentheses if it binds too weakly.
    pub(super) fn at_least(&self, e: Expr, level: BindingStrength) -> String {
        self.wrap(self.piece(e), level)
    }

    /// The text of what is raised to a numeric power. The sign of what is squared is that of its first term: (p − m x)².
    pub(super) fn raised(&self, base: Expr, exponent: Number) -> String {
        let even = exponent.as_integer().is_some_and(|n| n % 2 == 0);
        if let (true, Node::Sum(constant, terms)) =
            (even && self.style.textbook(), self.pool.node(base))
            && let Some(&(first, _)) = terms.iter().min_by_key(|&&(_, t)| self.order_of_term(t))
            && first.is_negative()
        {
            let opposite: Vec<(Number, Expr)> = terms.iter().map(|&(c, t)| (-c, t)).collect();
            return self.wrap(self.sum(-*constant, &opposite), BindingStrength::Atom);
        }
        self.at_least(base, BindingStrength::Atom)
    }

    fn wrap(&self, piece: PrintedPiece, level: BindingStrength) -> String {
        if piece.level < level { self.style.parenthesise(&piece.text) } else { piece.text }
    }

    fn signed_number(&self, n: Number) -> PrintedPiece {
        if !n.is_negative() {
            return self.style.number(n);
        }
        let positive = self.wrap(self.style.number(-n), BindingStrength::Product);
        PrintedPiece {
            text: format!("{}{positive}", self.style.minus()),
            level: BindingStrength::Sum,
        }
    }

    fn sum(&self, constant: Number, terms: &[(Number, Expr)]) -> PrintedPiece {
        let mut ordered = terms.to_vec();
        if self.style.textbook() {
            ordered.sort_by_cached_key(|&(_, t)| self.order_of_term(t));
        } else {
            ordered.sort_by_key(|&(_, t)| (Reverse(self.rank(t)), t));
        }
        let mut parts: Vec<(bool, String)> =
            ordered.iter().map(|&(c, t)| (c.is_negative(), self.term(c.abs(), t))).collect();
        if !constant.is_zero() {
            let text = self.wrap(self.style.number(constant.abs()), BindingStrength::Product);
            parts.push((constant.is_negative(), text));
        }
        // a sum starts with a positive term if it has one
        if parts[0].0
            && let Some(first) = parts.iter().position(|(negative, _)| !negative)
        {
            parts[..=first].rotate_right(1);
        }
        let mut text = String::new();
        for (i, (negative, part)) in parts.iter().enumerate() {
            match (i, negative) {
                (0, false) => {}
                (0, true) => text.push_str(self.style.minus()),
                (_, false) => text.push_str(" + "),
                (_, true) => text.extend([" ", self.style.minus(), " "]),
            }
            text.push_str(part);
        }
        PrintedPiece { text, level: BindingStrength::Sum }
    }

    /// `c · e` for a positive `c`, as a summand.
    fn term(&self, c: Number, e: Expr) -> String {
        let piece = match self.pool.node(e) {
            Node::Product(_, factors) => self.product(c, factors),
            _ if c.is_one() => self.piece(e),
            _ => self.product(c, &[(e, Number::ONE)]),
        };
        self.wrap(piece, BindingStrength::Product)
    }

    fn product(&self, c: Number, factors: &[(Expr, Number)]) -> PrintedPiece {
        if c.is_negative() {
            let positive = self.product(-c, factors);
            let text = self.wrap(positive, BindingStrength::Product);
            return PrintedPiece {
                text: format!("{}{text}", self.style.minus()),
                level: BindingStrength::Sum,
            };
        }
        let mut ordered = factors.to_vec();
        ordered.sort_by_key(|&(base, _)| self.order(base));
        let (below, above): (Vec<_>, Vec<_>) =
            ordered.into_iter().partition(|(_, n)| n.is_negative());
        let below: Vec<(Expr, Number)> = below.into_iter().map(|(b, n)| (b, -n)).collect();
        let (front, over, under) = match c {
            Number::Rational(n, d) if !self.style.coefficient_in_front(c, !below.is_empty()) => {
                (Number::ONE, Number::integer(n), Number::integer(d))
            }
            _ => (c, Number::ONE, Number::ONE),
        };
        let coefficient = if front.is_one() { over } else { front };
        let constants = above.iter().take_while(|&&(base, _)| self.is_constant(base)).count();
        let (first, rest) = above.split_at(constants);
        let apart = self.style.constants_apart()
            && above
                .last()
                .is_some_and(|&(base, _)| matches!(self.pool.node(base), Node::Call(..)));
        // (5/7) g sin φ, and (g/l) sin θ
        let number_below = below.is_empty() && !under.is_one();
        let constant_below = under.is_one()
            && constants > 0
            && !rest.is_empty()
            && matches!(below[..], [(base, _)] if self.pool.as_symbol(base).is_some() && self.is_constant(base));
        if apart && (number_below || constant_below) {
            let in_fraction = if number_below { &[] } else { first };
            let (over, under) =
                (self.factors(coefficient, in_fraction), self.factors(under, &below));
            let mut pieces =
                vec![self.wrap(self.style.fraction(&over, &under), BindingStrength::Power)];
            let apart = if number_below { &above[..] } else { rest };
            pieces.extend(
                apart.iter().map(|&factor| self.wrap(self.factor(factor), BindingStrength::Power)),
            );
            return PrintedPiece {
                text: self.style.join(&pieces),
                level: BindingStrength::Product,
            };
        }
        let above = self.factors(coefficient, &above);
        if below.is_empty() && under.is_one() {
            return above;
        }
        let below = self.factors(under, &below);
        self.style.fraction(&above, &below)
    }

    /// `base ^ n` for a positive `n`.
    fn factor(&self, (base, n): (Expr, Number)) -> PrintedPiece {
        if n.is_one() { self.piece(base) } else { self.style.numeric_power(self, base, n) }
    }

    fn factors(&self, c: Number, factors: &[(Expr, Number)]) -> PrintedPiece {
        if factors.is_empty() {
            return self.style.number(c);
        }
        let mut pieces = Vec::new();
        if !c.is_one() {
            pieces.push(self.wrap(self.style.number(c), BindingStrength::Product));
        }
        if let (true, &[(base, n)]) = (pieces.is_empty(), factors) {
            return self.factor((base, n));
        }
        pieces.extend(
            factors.iter().map(|&factor| self.wrap(self.factor(factor), BindingStrength::Power)),
        );
        PrintedPiece { text: self.style.join(&pieces), level: BindingStrength::Product }
    }

    /// The highest rank among a term's symbols; variables and constants count as one rank.
    fn rank(&self, term: Expr) -> Rank {
        let ranks = self.pool.symbols_of(term).into_iter().map(|s| self.pool.symbol_info(s).rank);
        ranks.max().unwrap_or_default().max(Rank::Variable)
    }

    fn is_constant(&self, e: Expr) -> bool {
        let constant = |s| self.pool.symbol_info(s).rank == Rank::Constant;
        self.pool.symbols_of(e).into_iter().all(constant)
    }

    fn has_call(&self, e: Expr) -> bool {
        self.pool.reachable(&[e]).iter().any(|&part| matches!(self.pool.node(part), Node::Call(..)))
    }

    /// The order of terms: rates before momenta before coordinates; terms without functions first, then squares before
    /// products of several, all in the order in which the variables were introduced. A constant stands after the powers
    /// and before the functions.
    fn order_of_term(&self, term: Expr) -> OrderOfTerm {
        let rank = self.rank(term);
        let highest = |&s: &Symbol| self.pool.symbol_info(s).rank.max(Rank::Variable) == rank;
        let (constants, variables): (Vec<Symbol>, Vec<Symbol>) = self
            .pool
            .symbols_of(term)
            .into_iter()
            .partition(|&s| self.pool.symbol_info(s).rank == Rank::Constant);
        let leading: Vec<Symbol> = variables.iter().copied().filter(|s| highest(s)).collect();
        let (mut several, mut linear) = (0, rank > Rank::Variable);
        let alone = [(term, Number::ONE)];
        let factors = match self.pool.node(term) {
            Node::Product(_, factors) => &factors[..],
            _ => &alone,
        };
        for &(base, n) in factors.iter().filter(|(_, n)| !n.is_negative()) {
            if !self.has_call(base) && leading.iter().any(|&s| self.pool.depends(base, s)) {
                // ½ y² before λ (3 x² y − y³)
                several += if matches!(self.pool.node(base), Node::Sum(..)) { 2 } else { 1 };
                linear &= n.is_one() && self.pool.as_symbol(base).is_some();
            }
        }
        let quotient = factors.iter().any(|(_, n)| n.is_negative());
        let several = match (variables.is_empty(), quotient) {
            (false, _) => several.max(1),
            (true, false) => usize::MAX - 1,
            (true, true) => usize::MAX,
        };
        let leading = if linear || rank == Rank::Variable { variables.clone() } else { leading };
        (Reverse(rank), self.has_call(term), several, linear, [leading, variables, constants], term)
    }

    /// The order of factors: sums of masses, constants, sums of constants, variables, rates, brackets, functions.
    fn order(&self, e: Expr) -> (u8, u32) {
        let class = match self.pool.node(e) {
            Node::Number(_) | Node::Pi => 0,
            Node::Symbol(s) => {
                let info = self.pool.symbol_info(*s);
                match info.rank {
                    Rank::Constant if !self.style.textbook() => return (2, s.0),
                    Rank::Constant => return (2 + standing(&info.name), s.0),
                    Rank::Variable | Rank::Momentum => return (7, s.0),
                    Rank::Rate => return (8, s.0),
                }
            }
            Node::Sum(_, terms)
                if self.style.textbook() && self.is_constant(e) && !self.has_call(e) =>
            {
                let name = |&(_, t): &(Number, Expr)| {
                    self.pool.as_symbol(t).map(|s| self.pool.symbol_info(s).name.as_str())
                };
                let names: Option<Vec<&str>> = terms.iter().map(name).collect();
                let masses = names.is_some_and(|names| names.iter().any(|n| standing(n) == 1));
                if masses { 1 } else { 6 }
            }
            Node::Sum(..) | Node::Product(..) => 9,
            Node::Power(..) => 10,
            Node::Call(..) => 11,
        };
        (class, e.0)
    }
}

/// The place of a constant among constants by its usual meaning: charges and the constant of gravitation, masses, the
/// acceleration g, all others.
fn standing(name: &str) -> u8 {
    match name.trim_end_matches(|c: char| c.is_ascii_digit()) {
        "G" | "e" | "q" => 0,
        "m" | "M" if name != "M0" => 1,
        "g" => 2,
        _ => 3,
    }
}
