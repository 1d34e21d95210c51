//! Equations that are not linear, solved for their unknowns where that can be written down.
//!
//! In: equations e = 0, unknowns, and a test that a solution has to pass. Out: each unknown as an
//! expression that is free of all unknowns. An equation with one unknown is
//! solved for it by `rearrange`; several unknowns in which the equations are linear are eliminated together; an angle
//! given by the ratio of two of them makes both known up to a common factor. Branches are tried in
//! turn, principal values first. Never here: numbers, and which solution is right.

use std::collections::HashMap;

use super::linear;
use super::rearrange::{fraction, isolate, slope};
use crate::expr::{Expr, FunctionId, Node, Pool, Symbol};
use crate::num::Number;

/// The number of steps after which a search is given up.
const BUDGET: usize = 400;

/// The number of expressions after which it is given up: what has a solution that can be read needs far fewer.
const MOST_BUILT: usize = 10_000;

/// The number of steps of the pool after which it is given up, ten times those of the longest search of a preset that
/// has a result.
const ALLOWANCE: u64 = 300_000;

/// A solution, or an expression on the way to it, may not be heavier.
const HEAVIEST: u64 = 4_000;

/// Unknowns with their values.
pub(super) type Solution = Vec<(Symbol, Expr)>;

/// The first solution that `accept`s, if one is found.
pub(super) fn solve(
    pool: &mut Pool,
    equations: &[Expr],
    unknowns: &[Symbol],
    accept: &mut dyn FnMut(&mut Pool, &Solution) -> bool,
) -> Option<Solution> {
    pool.attempt(ALLOWANCE, |pool| {
        let most = pool.built() + MOST_BUILT;
        let mut search = Isolation { wanted: unknowns.to_vec(), budget: BUDGET, most, accept };
        let (equations, unknowns) = (equations.to_vec(), unknowns.to_vec());
        search.step(pool, Unsolved { equations, unknowns, found: Vec::new() })
    })
}

/// What is left to solve, and what is found, which may depend on what is left.
#[derive(Clone)]
struct Unsolved {
    equations: Vec<Expr>,
    unknowns: Vec<Symbol>,
    found: Solution,
}

impl Unsolved {
    /// What is left once these values are put in, which solve the equations with these indices.
    fn with(&self, pool: &mut Pool, values: Solution, used: &[usize]) -> Unsolved {
        let map: HashMap<Symbol, Expr> = values.iter().copied().collect();
        let left = self.equations.iter().enumerate().filter(|(k, _)| !used.contains(k));
        let equations = left.map(|(_, &e)| tidy(pool, e, &map)).collect();
        let mut found: Solution =
            self.found.iter().map(|&(s, e)| (s, tidy(pool, e, &map))).collect();
        found.extend(values);
        let unknowns = self.unknowns.iter().copied().filter(|s| !map.contains_key(s)).collect();
        Unsolved { equations, unknowns, found }
    }

    fn unknowns_of(&self, pool: &Pool, e: Expr) -> Vec<Symbol> {
        self.unknowns.iter().copied().filter(|&s| pool.depends(e, s)).collect()
    }
}

struct Isolation<'a> {
    wanted: Vec<Symbol>,
    budget: usize,
    /// No more is tried once the pool has so many expressions.
    most: usize,
    accept: &'a mut dyn FnMut(&mut Pool, &Solution) -> bool,
}

impl Isolation<'_> {
    /// Continues from what is left to solve.
    fn step(&mut self, pool: &mut Pool, mut left: Unsolved) -> Option<Solution> {
        if self.budget == 0
            || pool.built() > self.most
            || pool.is_full()
            || pool.cancel().is_cancelled()
        {
            return None;
        }
        self.budget -= 1;
        left.equations.retain(|&e| pool.depends_on_any(e, &left.unknowns));
        if left.unknowns.is_empty() {
            let solution: Solution =
                left.found.into_iter().filter(|(s, _)| self.wanted.contains(s)).collect();
            return (self.accept)(pool, &solution).then_some(solution);
        }
        self.by_single_unknowns(pool, &left)
            .or_else(|| self.by_linear_part(pool, &left))
            .or_else(|| self.by_angles(pool, &left))
            .or_else(|| self.by_any_unknown(pool, &left))
    }

    /// Solves an equation for its only unknown, the lightest one first.
    fn by_single_unknowns(&mut self, pool: &mut Pool, left: &Unsolved) -> Option<Solution> {
        let mut single: Vec<(u64, usize, Symbol)> = Vec::new();
        for (k, &e) in left.equations.iter().enumerate() {
            if let [one] = left.unknowns_of(pool, e)[..] {
                single.push((pool.weight(e), k, one));
            }
        }
        single.sort_unstable();
        single.into_iter().find_map(|(_, k, unknown)| self.by_equation(pool, left, k, unknown))
    }

    /// Solves the equations that are linear together.
    fn by_linear_part(&mut self, pool: &mut Pool, left: &Unsolved) -> Option<Solution> {
        let (rows, values) = linear_part(pool, &left.equations, &left.unknowns)?;
        let next = left.with(pool, values, &rows);
        self.step(pool, next)
    }

    /// Writes y = s sin c, x = s cos c in place of atan2(y, x) = c.
    fn by_angles(&mut self, pool: &mut Pool, left: &Unsolved) -> Option<Solution> {
        for (k, &e) in left.equations.iter().enumerate() {
            let Some((y, x, angle)) = angle_of_two(pool, e, &left.unknowns) else { continue };
            let s = pool.symbol("common factor of sine and cosine");
            if left.unknowns.contains(&s) {
                continue;
            }
            let factor = pool.variable(s);
            let mut next = left.clone();
            next.equations.remove(k);
            for (side, function) in [(y, FunctionId::Sin), (x, FunctionId::Cos)] {
                let part = pool.call(function, &[angle]);
                let part = pool.mul(factor, part);
                next.equations.push(pool.sub(side, part));
            }
            next.unknowns.push(s);
            if let Some(solution) = self.step(pool, next) {
                return Some(solution);
            }
        }
        None
    }

    /// Solves an equation for one unknown in terms of the others.
    fn by_any_unknown(&mut self, pool: &mut Pool, left: &Unsolved) -> Option<Solution> {
        for (k, &e) in left.equations.iter().enumerate() {
            for unknown in left.unknowns_of(pool, e) {
                if let Some(solution) = self.by_equation(pool, left, k, unknown) {
                    return Some(solution);
                }
            }
        }
        None
    }

    /// Continues with an unknown replaced by one of its values that solve an equation.
    fn by_equation(
        &mut self,
        pool: &mut Pool,
        left: &Unsolved,
        equation: usize,
        unknown: Symbol,
    ) -> Option<Solution> {
        isolate(pool, left.equations[equation], unknown).into_iter().find_map(|value| {
            let value = pool.open_inverses(value);
            let value = pool.simplify(value);
            if pool.weight(value) > HEAVIEST {
                return None;
            }
            let next = left.with(pool, vec![(unknown, value)], &[equation]);
            self.step(pool, next)
        })
    }
}

/// An expression with values put in, in a shorter form.
pub(super) fn tidy(pool: &mut Pool, e: Expr, map: &HashMap<Symbol, Expr>) -> Expr {
    if !map.keys().any(|&s| pool.depends(e, s)) {
        return e;
    }
    let e = pool.substitute(e, map);
    let e = pool.open_inverses(e);
    pool.simplify(e)
}

/// Equations that are linear in as many unknowns, and the values of these.
fn linear_part(
    pool: &mut Pool,
    equations: &[Expr],
    unknowns: &[Symbol],
) -> Option<(Vec<usize>, Solution)> {
    let zeros: HashMap<Symbol, Expr> = unknowns.iter().map(|&s| (s, Expr::ZERO)).collect();
    let mut rows: Vec<(usize, Vec<Expr>)> = Vec::new();
    for (k, &e) in equations.iter().enumerate() {
        let slopes: Vec<Expr> = unknowns.iter().map(|&s| slope(pool, e, s)).collect();
        if slopes.iter().all(|&slope| !pool.depends_on_any(slope, unknowns)) {
            rows.push((k, slopes));
        }
    }
    let occurs: Vec<usize> =
        (0..unknowns.len()).filter(|&j| rows.iter().any(|(_, row)| row[j] != Expr::ZERO)).collect();
    if occurs.len() < 2 || occurs.len() != rows.len() {
        return None;
    }
    let matrix: Vec<Vec<Expr>> =
        rows.iter().map(|(_, row)| occurs.iter().map(|&j| row[j]).collect()).collect();
    let mut right = Vec::new();
    for (k, _) in &rows {
        let at_zero = pool.substitute(equations[*k], &zeros);
        right.push(pool.neg(at_zero));
    }
    let values = linear::solve(pool, &matrix, &right).ok()?.x.ok()?;
    let values: Vec<Expr> = values.into_iter().map(|e| without_inner_fractions(pool, e)).collect();
    let found = occurs.iter().map(|&j| unknowns[j]).zip(values).collect();
    Some((rows.into_iter().map(|(k, _)| k).collect(), found))
}

/// An equal expression in which no factor is a sum of fractions: `a/(x + y²/x) = a x/(x² + y²)`.
fn without_inner_fractions(pool: &mut Pool, e: Expr) -> Expr {
    let Node::Product(c, factors) = pool.node(e).clone() else { return e };
    let mut parts: Vec<(Expr, Number)> = Vec::new();
    for (base, n) in factors {
        let Node::Sum(constant, terms) = pool.node(base).clone() else {
            parts.push((base, n));
            continue;
        };
        let mut below: Vec<(Expr, i64)> = Vec::new();
        for (_, term) in &terms {
            let Node::Product(_, factors) = pool.node(*term) else { continue };
            for &(factor, power) in factors {
                let Some(power) = power.as_integer().filter(|&power| power < 0) else { continue };
                match below.iter_mut().find(|(known, _)| *known == factor) {
                    Some(known) => known.1 = known.1.max(-power),
                    None => below.push((factor, -power)),
                }
            }
        }
        let common: Vec<(Expr, Number)> =
            below.into_iter().map(|(factor, power)| (factor, Number::integer(power))).collect();
        let common = pool.monomial(Number::ONE, &common);
        let mut above = vec![(constant, common)];
        for (c, term) in terms {
            above.push((c, pool.mul(term, common)));
        }
        let above = pool.linear(Number::ZERO, &above);
        parts.extend([(above, n), (common, -n)]);
    }
    let e = pool.monomial(c, &parts);
    pool.simplify(e)
}

/// y, x and c of an equation atan2(y, x) = c in which unknowns occur in y and x alone.
fn angle_of_two(pool: &mut Pool, e: Expr, unknowns: &[Symbol]) -> Option<(Expr, Expr, Expr)> {
    for part in pool.reachable(&[e]) {
        let (y, x) = match pool.node(part) {
            Node::Call(FunctionId::Atan2, arguments) => (arguments[0], arguments[1]),
            Node::Call(FunctionId::Atan, arguments) => {
                let ratio = arguments[0];
                fraction(pool, ratio)
            }
            _ => continue,
        };
        if !pool.depends_on_any(y, unknowns) || !pool.depends_on_any(x, unknowns) {
            continue;
        }
        let z = pool.symbol("an angle to be found");
        let variable = pool.variable(z);
        let replaced = pool.replace(e, part, variable);
        if pool.depends_on_any(replaced, unknowns) {
            continue;
        }
        if let Some(angle) = isolate(pool, replaced, z).into_iter().next() {
            return Some((y, x, angle));
        }
    }
    None
}
