//! What each node of an expression becomes: operations on the registers of its parts.
//!
//! In: a canonical node. Out: the register of its value. Never here: the sharing of equal
//! operations.

use super::lower::Lowering;
use super::program::{Op, PARAMETRIC_POWER_BITS, Register};
use crate::expr::{Expr, FunctionId, KinkBranches, Node, Pool, Rule};
use crate::num::{DoubleDouble, Number};

/// At a zero of its factors, a function of a product of this degree may have so many orders without a term between two
/// with one that the last orders of a series, by which it is judged, show nothing: an even one twice the degree, the next
/// term lying ten orders or more behind, or beyond the order of a series, which is twelve at least.
const STEEP: i64 = 6;

impl Lowering<'_> {
    pub(super) fn lower_node(&mut self, e: Expr) -> Register {
        match &*self.pool.shared(e) {
            Node::Number(n) => self.constant(n.double()),
            Node::Pi => self.constant(DoubleDouble::PI),
            &Node::Symbol(symbol) => {
                self.unknown.get_or_insert(symbol);
                self.constant(DoubleDouble::from(f64::NAN))
            }
            Node::Sum(constant, terms) => {
                let terms: Vec<(Number, Register)> =
                    terms.iter().map(|(c, t)| (*c, self.known[t])).collect();
                self.linear(*constant, &terms)
            }
            Node::Product(coefficient, factors) => match self.pool.one_sided_quotient(e) {
                Some(sides) => self.select(sides),
                None => self.lower_product(*coefficient, factors),
            },
            Node::Power(base, exponent) => {
                let (base, exponent) = (self.known[base], self.known[exponent]);
                self.lower_power(base, exponent)
            }
            Node::Call(function, arguments) => self.lower_call(*function, arguments),
        }
    }

    /// Lowers `coefficient · Π base^exponent`; factors that depend on parameters only are combined
    /// into one.
    fn lower_product(&mut self, coefficient: Number, factors: &[(Expr, Number)]) -> Register {
        if let Some(opened) = self.open_squares(coefficient, factors) {
            return self.lower(opened);
        }
        let degree = |&(base, exponent): &(Expr, Number)| {
            let n = exponent.as_integer();
            let n = n.filter(|&n| n > 0 && !self.is_fixed(self.known[&base]))?;
            Some(n.saturating_mul(self.lowest_degree(base)))
        };
        let degree = factors.iter().filter_map(degree).fold(0_i64, i64::saturating_add);
        self.program.steep |= degree >= STEEP;
        // [fixed numerator, fixed denominator, varying numerator, varying denominator]
        let mut parts: [Option<Register>; 4] = [None; 4];
        for &(base, exponent) in factors {
            let (register, inverse) = self.lower_factor(base, exponent);
            let place = 2 * usize::from(!self.is_fixed(register)) + usize::from(inverse);
            let joined = parts[place].map_or(register, |old| self.multiply(old, register));
            parts[place] = Some(joined);
        }
        let mut fixed = (!coefficient.is_one()).then(|| self.constant(coefficient.double()));
        if let Some(above) = parts[0] {
            fixed = Some(fixed.map_or(above, |c| self.multiply(c, above)));
        }
        if let Some(below) = parts[1] {
            let above = fixed.unwrap_or_else(|| self.constant(DoubleDouble::ONE));
            fixed = Some(self.push(Op::Divide(above, below)));
        }
        let above = match (fixed, parts[2]) {
            (Some(fixed), Some(above)) => self.multiply(fixed, above),
            (Some(one), None) | (None, Some(one)) => one,
            (None, None) => self.constant(DoubleDouble::ONE),
        };
        parts[3].map_or(above, |below| self.push(Op::Divide(above, below)))
    }

    /// The degree of the lowest terms of a sum of powers without a constant; 1 of anything else.
    fn lowest_degree(&self, base: Expr) -> i64 {
        let Node::Sum(constant, terms) = self.pool.node(base) else { return 1 };
        if !constant.is_zero() {
            return 1;
        }
        let degree = |&(_, term): &(Number, Expr)| match self.pool.node(term) {
            Node::Product(_, factors) => factors
                .iter()
                .map(|(_, n)| n.as_integer().unwrap_or(0).max(0))
                .fold(0_i64, i64::saturating_add),
            _ => 1,
        };
        terms.iter().map(degree).min().unwrap_or(1).max(1)
    }

    /// Lowers a power with a numeric exponent. Returns true if it belongs in the denominator.
    fn lower_factor(&mut self, base: Expr, exponent: Number) -> (Register, bool) {
        if let Some(n) = exponent.as_integer() {
            let base = self.known[&base];
            return (self.integer_power(base, n.unsigned_abs()), n < 0);
        }
        let base = self.known[&base];
        if exponent.abs() == Number::HALF {
            return (self.push(Op::Root(base)), exponent.is_negative());
        }
        let whole = exponent + -Number::HALF;
        if let Some(n @ 1..) = whole.as_integer() {
            // the root crosses zero, where its cube would only touch it
            let (root, rest) = (self.push(Op::Root(base)), self.integer_power(base, n as u64));
            return (self.multiply(root, rest), false);
        }
        let exponent = self.constant_index(exponent.double());
        (self.push(Op::Power(base, exponent)), false)
    }

    /// A product in which roots of squares are simplified, if it has any:
    /// `(b² c)^α = |b|^{2α} c^α`, and an odd power of `|b|` is `sign(b)` times that of `b`, so that
    /// `x/√(x²)` is a sign even where it is 0/0. The kink at `b = 0` becomes one that is located.
    fn open_squares(&mut self, coefficient: Number, factors: &[(Expr, Number)]) -> Option<Expr> {
        let may_open = |&(base, exponent): &(Expr, Number)| match self.pool.node(base) {
            Node::Product(..) => exponent.as_integer().is_none(),
            Node::Call(FunctionId::Abs, _) => true,
            _ => false,
        };
        if !factors.iter().any(may_open) {
            return None;
        }
        let even = |n: Number| n.as_integer().is_some_and(|n| n % 2 == 0);
        let mut opened = Vec::new();
        let mut any = false;
        for &(base, exponent) in factors {
            let shared = self.pool.shared(base);
            let inner = match &*shared {
                Node::Product(c, inner) if exponent.as_integer().is_none() => (*c, inner),
                Node::Call(FunctionId::Abs, arguments) => {
                    let b = arguments[0];
                    let own = factors.iter().find(|&&(other, _)| other == b).map(|&(_, m)| m);
                    match (own.filter(|m| m.as_integer().is_some()), exponent.as_integer()) {
                        // 1/|b| = sign(b)/b, and b |b|^α = sign(b) |b|^(1 + α)
                        (Some(_), Some(n)) if n % 2 != 0 => {
                            opened.push((self.pool.call(FunctionId::Sign, &[b]), Number::ONE));
                            opened.push((b, exponent));
                            any = true;
                        }
                        (Some(m), None) => {
                            if !even(m) {
                                opened.push((self.pool.call(FunctionId::Sign, &[b]), Number::ONE));
                            }
                            opened.push((base, m));
                            opened.push((b, -m));
                            opened.push((base, exponent));
                            any = true;
                        }
                        _ => opened.push((base, exponent)),
                    }
                    continue;
                }
                _ => {
                    opened.push((base, exponent));
                    continue;
                }
            };
            let (squares, others): (Vec<_>, Vec<_>) = inner.1.iter().partition(|(_, n)| even(*n));
            any |= !squares.is_empty();
            for (b, n) in squares {
                let power = n * exponent;
                if power.as_integer().is_none() {
                    opened.push((self.pool.call(FunctionId::Abs, &[b]), power));
                    continue;
                }
                if !even(power) {
                    opened.push((self.pool.call(FunctionId::Sign, &[b]), Number::ONE));
                }
                opened.push((b, power));
            }
            opened.push((self.pool.monomial(inner.0, &others), exponent));
        }
        any.then(|| self.pool.monomial(coefficient, &opened))
    }

    fn lower_power(&mut self, base: Register, exponent: Register) -> Register {
        if self.is_fixed(exponent) {
            let register = self.push(Op::ParametricPower(base, exponent));
            self.program.steep = true;
            self.make_room(register, 2 * PARAMETRIC_POWER_BITS);
            return register;
        }
        // b^e = exp(e ln b)
        let logarithm = self.call(FunctionId::Ln, [base, base]);
        let product = self.multiply(exponent, logarithm);
        self.call(FunctionId::Exp, [product, product])
    }

    /// Reserves further registers after one that needs several, unless they exist.
    fn make_room(&mut self, register: Register, count: usize) {
        if self.program.ops.len() == register as usize + 1 {
            for _ in 0..count {
                self.push(Op::Written);
            }
        }
    }

    fn call(&mut self, function: FunctionId, arguments: [Register; 2]) -> Register {
        let register = self.push(Op::Call(function, arguments));
        self.make_room(register, 1);
        register
    }

    fn lower_call(&mut self, function: FunctionId, arguments: &[Expr]) -> Register {
        match function.row().rule {
            Rule::Series(_) if function == FunctionId::Atan2 && self.cuts => {
                let branches = half_planes(self.pool, arguments);
                self.cuts = false;
                let register = self.select(branches);
                self.cuts = true;
                register
            }
            Rule::Series(_) => {
                let first = self.known[&arguments[0]];
                let second = arguments.get(1).map_or(first, |e| self.known[e]);
                // one operation computes both functions of a pair
                let (leader, offset) = match function {
                    FunctionId::Cos => (FunctionId::Sin, 1),
                    FunctionId::Cosh => (FunctionId::Sinh, 1),
                    other => (other, 0),
                };
                self.call(leader, [first, second]) + offset
            }
            Rule::Branch(branches) => {
                let branches = branches(self.pool, arguments);
                self.select(branches)
            }
            Rule::Power => {
                let base = self.known[&arguments[0]];
                self.push(Op::Root(base))
            }
        }
    }

    fn select(&mut self, branches: KinkBranches) -> Register {
        let positive = self.lower(branches.positive);
        let negative = self.lower(branches.negative);
        let opposite = self.pool.neg(branches.switch);
        if let Some(mode) = self.switches.iter().position(|&e| e == opposite) {
            let switch = self.program.switches[mode];
            let mode = Some(mode as u32);
            return self.push(Op::Select { switch, mode, positive: negative, negative: positive });
        }
        let switch = self.lower(branches.switch);
        let mode = (!self.is_fixed(switch)).then(|| self.mode(branches.switch, switch));
        self.push(Op::Select { switch, mode, positive, negative })
    }

    fn mode(&mut self, e: Expr, register: Register) -> u32 {
        if let Some(mode) = self.switches.iter().position(|&known| known == e) {
            return mode as u32;
        }
        self.switches.push(e);
        self.program.switches.push(register);
        self.switches.len() as u32 - 1
    }
}

/// `atan2(y, x)` on the two sides of y = 0, on each without a cut nearby: `±π/2 + atan2(∓x, ±y)`.
/// They agree where x > 0, and differ by a turn where x < 0. The cuts of the new calls lie where
/// the other branch applies.
fn half_planes(pool: &mut Pool, arguments: &[Expr]) -> KinkBranches {
    let (y, x) = (arguments[0], arguments[1]);
    let (minus_y, minus_x) = (pool.neg(y), pool.neg(x));
    let above = pool.call(FunctionId::Atan2, &[minus_x, y]);
    let below = pool.call(FunctionId::Atan2, &[x, minus_y]);
    let pi = pool.pi();
    let right_angle = pool.scale(Number::HALF, pi);
    let positive = pool.add(right_angle, above);
    let negative = pool.sub(below, right_angle);
    KinkBranches { switch: y, positive, negative }
}
