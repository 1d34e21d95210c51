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

/// … or after which it has built so many expressions: what has a solution that can be read needs far fewer.
const MOST_BUILT: usize = 10_000;

/// … or after so many steps of the pool, ten times those of the longest search of a preset that has a result.
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
        search.step(pool, equations.to_vec(), unknowns, Vec::new())
    })
}

struct Isolation<'a> {
    wanted: Vec<Symbol>,
    budget: usize,
    /// No more is tried once the pool has so many expressions.
    most: usize,
    accept: &'a mut dyn FnMut(&mut Pool, &Solution) -> bool,
}

impl Isolation<'_> {
    /// Goes on from what is left to solve and what is found, which may depend on what is left.
    fn step(
        &mut self,
        pool: &mut Pool,
        mut equations: Vec<Expr>,
        unknowns: &[Symbol],
        found: Solution,
    ) -> Option<Solution> {
        if self.budget == 0
            || pool.built() > self.most
            || pool.is_full()
            || pool.cancel().is_cancelled()
        {
            return None;
        }
        self.budget -= 1;
        equations.retain(|&e| pool.depends_on_any(e, unknowns));
        if unknowns.is_empty() {
            let wanted = self.wanted.clone();
            let solution: Solution =
                found.into_iter().filter(|(s, _)| wanted.contains(s)).collect();
            return (self.accept)(pool, &solution).then_some(solution);
        }
        let of = |pool: &Pool, e: Expr| -> Vec<Symbol> {
            unknowns.iter().copied().filter(|&s| pool.depends(e, s)).collect()
        };
        // an equation for one unknown
        let mut single: Vec<(u64, usize, Symbol)> = Vec::new();
        for (k, &e) in equations.iter().enumerate() {
            if let [one] = of(pool, e)[..] {
                single.push((pool.weight(e), k, one));
            }
        }
        single.sort_unstable();
        for (_, k, unknown) in single {
            for value in isolate(pool, equations[k], unknown) {
                let next = self.with(pool, &equations, unknowns, &found, k, (unknown, value));
                if next.is_some() {
                    return next;
                }
            }
        }
        if let Some((rows, values)) = linear_part(pool, &equations, unknowns) {
            let rest = equations.iter().enumerate().filter(|(k, _)| !rows.contains(k));
            let mut rest: Vec<Expr> = rest.map(|(_, &e)| e).collect();
            let map: HashMap<Symbol, Expr> = values.iter().copied().collect();
            for e in &mut rest {
                *e = tidy(pool, *e, &map);
            }
            let mut found: Solution = found.clone();
            for (_, e) in &mut found {
                *e = tidy(pool, *e, &map);
            }
            found.extend(values);
            let left: Vec<Symbol> =
                unknowns.iter().copied().filter(|s| !map.contains_key(s)).collect();
            if let Some(solution) = self.step(pool, rest, &left, found) {
                return Some(solution);
            }
        }
        // y = s sin c, x = s cos c in place of atan2(y, x) = c
        for (k, &e) in equations.iter().enumerate() {
            let Some((y, x, angle)) = angle_of_two(pool, e, unknowns) else { continue };
            let s = pool.symbol("common factor of sine and cosine");
            if unknowns.contains(&s) {
                continue;
            }
            let factor = pool.variable(s);
            let mut equations = equations.clone();
            equations.remove(k);
            for (side, function) in [(y, FunctionId::Sin), (x, FunctionId::Cos)] {
                let part = pool.call(function, &[angle]);
                let part = pool.mul(factor, part);
                equations.push(pool.sub(side, part));
            }
            let unknowns = [unknowns, &[s]].concat();
            if let Some(solution) = self.step(pool, equations, &unknowns, found.clone()) {
                return Some(solution);
            }
        }
        // one unknown in terms of the others
        for k in 0..equations.len() {
            for unknown in of(pool, equations[k]) {
                for value in isolate(pool, equations[k], unknown) {
                    let next = self.with(pool, &equations, unknowns, &found, k, (unknown, value));
                    if next.is_some() {
                        return next;
                    }
                }
            }
        }
        None
    }

    /// Goes on with one unknown replaced by its value.
    fn with(
        &mut self,
        pool: &mut Pool,
        equations: &[Expr],
        unknowns: &[Symbol],
        found: &Solution,
        used: usize,
        (unknown, value): (Symbol, Expr),
    ) -> Option<Solution> {
        let value = pool.open_inverses(value);
        let value = pool.simplify(value);
        if pool.weight(value) > HEAVIEST {
            return None;
        }
        let map = HashMap::from([(unknown, value)]);
        let mut rest = equations.to_vec();
        rest.remove(used);
        for e in &mut rest {
            *e = tidy(pool, *e, &map);
        }
        let mut found: Solution = found.clone();
        for (_, e) in &mut found {
            *e = tidy(pool, *e, &map);
        }
        found.push((unknown, value));
        let left: Vec<Symbol> = unknowns.iter().copied().filter(|&s| s != unknown).collect();
        self.step(pool, rest, &left, found)
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
