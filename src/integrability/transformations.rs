//! What changes of time and coordinates may be made of: the functions in which ξ, η and f are polynomials.
//!
//! In: a Lagrangian at the parameters' values. Out: time, coordinates, functions of them that the Lagrangian contains,
//! and oscillations in the time with the frequencies that it shows. Never here: conditions on them.

use rustc_hash::FxHashSet;

use crate::expr::{Expr, FunctionId, Node, Pool, Symbol};
use crate::mechanics::Equations;
use crate::num::Number;

/// What a change of time and coordinates changes, t first, and by how much.
pub fn changed<'a>(
    equations: &'a Equations,
    time: Expr,
    coordinates: &'a [Expr],
) -> impl Iterator<Item = (Symbol, Expr)> + 'a {
    let positions = equations.coordinates.iter().map(|c| c.position);
    let all = [(equations.symbols.time, time)].into_iter();
    all.chain(positions.zip(coordinates.iter().copied())).filter(|(_, e)| *e != Expr::ZERO)
}

/// The functions in which changes of time and coordinates are polynomials.
pub(super) fn generators_of(
    pool: &mut Pool,
    lagrangian: Expr,
    time: Symbol,
    positions: &[Symbol],
    velocities: &[Symbol],
) -> Vec<Expr> {
    let mut generators = vec![pool.variable(time)];
    generators.extend(positions.iter().map(|&q| pool.variable(q)));
    // sines, cosines, exponentials and reciprocals of coordinates that the law contains, and of the time
    for e in pool.reachable(&[lagrangian]) {
        let moving = pool.depends_on_any(e, positions) || pool.depends(e, time);
        if !moving || pool.depends_on_any(e, velocities) {
            continue;
        }
        match pool.node(e).clone() {
            Node::Call(FunctionId::Sin | FunctionId::Cos, u) => {
                for function in [FunctionId::Sin, FunctionId::Cos] {
                    let e = pool.call(function, &u);
                    if !generators.contains(&e) {
                        generators.push(e);
                    }
                }
            }
            Node::Call(FunctionId::Exp | FunctionId::Ln, _) if !generators.contains(&e) => {
                generators.push(e);
            }
            _ => {}
        }
    }
    // an oscillation in the time is found where the law is quadratic: q'' = −ω² q
    for w in frequencies(pool, lagrangian, positions, velocities) {
        let (w, t) = (pool.number(w), pool.variable(time));
        let angle = pool.mul(w, t);
        for function in [FunctionId::Sin, FunctionId::Cos] {
            let e = pool.call(function, &[angle]);
            if !generators.contains(&e) {
                generators.push(e);
            }
        }
    }
    generators
}

/// Once and twice the frequencies of oscillators, L = ½ m q̇² − ½ k q² with k/m the square of a rational, and those of
/// uniform magnetic fields.
fn frequencies(
    pool: &mut Pool,
    lagrangian: Expr,
    positions: &[Symbol],
    velocities: &[Symbol],
) -> Vec<Number> {
    let mut found = Vec::new();
    for (&q, &v) in positions.iter().zip(velocities) {
        let second = |pool: &mut Pool, s: Symbol| {
            let slope = pool.derivative(lagrangian, s);
            let curvature = pool.derivative(slope, s);
            let curvature = pool.simplify(curvature);
            pool.as_number(curvature)
        };
        let (Some(m), Some(k)) = (second(pool, v), second(pool, q)) else { continue };
        let square = -k * m.recip();
        if let Some(w) = square.exact_power(Number::HALF).filter(|w| !w.is_zero()) {
            for w in [w, w * Number::integer(2)] {
                if !found.contains(&w) {
                    found.push(w);
                }
            }
        }
        // in a uniform magnetic field: m q̇ turns at (∂²L/∂q̇∂r − ∂²L/∂q∂ṙ)/m
        for (&r, &u) in positions.iter().zip(velocities).filter(|(r, _)| **r != q) {
            let momentum = pool.derivative(lagrangian, v);
            let other = pool.derivative(lagrangian, u);
            let (a, b) = (pool.derivative(momentum, r), pool.derivative(other, q));
            let turn = pool.sub(a, b);
            let turn = pool.simplify(turn);
            if let Some(b) = pool.as_number(turn).filter(|b| !b.is_zero()) {
                let w = (b * m.recip()).abs();
                if !found.contains(&w) {
                    found.push(w);
                }
            }
        }
    }
    found
}

/// All products of some functions up to a degree, by ascending degree, the first of them 1: of the highest degree, not above
/// the one given, with no more than `most` of them, but at least of the first. With that degree.
pub(super) fn products(
    pool: &mut Pool,
    generators: &[Expr],
    degree: u32,
    most: usize,
) -> (u32, Vec<Expr>) {
    let mut seen: FxHashSet<Expr> = FxHashSet::from_iter([Expr::ONE]);
    let mut unique = vec![Expr::ONE];
    let mut last: Vec<(Expr, usize)> = vec![(Expr::ONE, 0)];
    for grown in 1..=degree {
        let (lower, mut next) = (unique.len(), Vec::new());
        for &(e, from) in &last {
            for (k, &g) in generators.iter().enumerate().skip(from) {
                let product = pool.mul(e, g);
                next.push((product, k));
                if seen.insert(product) {
                    unique.push(product);
                }
                if unique.len() > most && grown > 1 {
                    unique.truncate(lower);
                    return (grown - 1, unique);
                }
            }
        }
        last = next;
    }
    (degree, unique)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of 200 functions there are 1.4 million products up to the third degree, which are not made; those of the first always are.
    #[test]
    fn products_are_of_the_highest_degree_that_has_few_enough() {
        let mut pool = Pool::new();
        let mut some = |count: usize, most: usize| {
            let names: Vec<Expr> = (0..count)
                .map(|k| {
                    let symbol = pool.symbol(&format!("g{k}"));
                    pool.variable(symbol)
                })
                .collect();
            let (degree, products) = products(&mut pool, &names, 3, most);
            (degree, products.len())
        };
        assert_eq!([some(200, 100), some(200, 250)], [(1, 201); 2]);
        // 1 + 3 + 6 + 10
        assert_eq!([some(3, 20), some(3, 19), some(3, 9)], [(3, 20), (2, 10), (1, 4)]);
    }
}
