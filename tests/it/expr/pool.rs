//! What the pool stores with a node, against a walk over all that is below it.

use std::collections::BTreeSet;

use phaselab::expr::{Expr, Node, Pool, Symbol};
use phaselab::num::Number;

use crate::build::{names, read};
use crate::nonempty;

const SOURCES: [&str; 7] = [
    "q",
    "(q + u)^2*sin(q + u)/(a + b*cos(q + u))",
    "m*l^2*(u^2 + q^2*sin(q)^2)/2 - m*g*l*cos(q) + (q + u)^2",
    "sqrt(q^2 + u^2)*exp(-k*sqrt(q^2 + u^2))",
    "a*q^3 + a*q^2*u - q*(a*q^2 + a*q*u)/b",
    "sin(theta)^2*q + cos(theta)^2*q + cos(theta)*cos(phi) + sin(theta)*sin(phi)",
    "q^u^k + tan(u)*abs(q - u)",
];

/// Every node below `e` and `e` itself, by recursion.
fn below(pool: &Pool, e: Expr, all: &mut BTreeSet<Expr>) {
    if all.insert(e) {
        pool.node(e).parts().into_iter().for_each(|part| below(pool, part, all));
    }
}

/// The number of nodes of `e` written out, by recursion.
fn written(pool: &Pool, e: Expr) -> u64 {
    1 + pool.node(e).parts().into_iter().map(|part| written(pool, part)).sum::<u64>()
}

fn pool_of_many(others: usize) -> (Pool, Vec<Expr>) {
    let fillers: Vec<String> = (0..others).map(|i| format!("f{i}")).collect();
    let mut parameters: Vec<&str> = fillers.iter().map(String::as_str).collect();
    parameters.extend(["m", "g", "l", "k", "a", "b"]);
    let mut model = names(&["q", "u", "theta", "phi"], &parameters);
    let all = SOURCES.map(|source| read(&mut model, source)).to_vec();
    (model.pool, all)
}

#[test]
fn a_node_is_stored_with_what_a_walk_would_find() {
    // few symbols, and more than one word of bits can tell apart
    for others in [0, 150] {
        let (pool, all) = pool_of_many(others);
        for e in nonempty(all) {
            let mut nodes = BTreeSet::new();
            below(&pool, e, &mut nodes);
            assert_eq!(pool.reachable(&[e]), nodes.iter().copied().collect::<Vec<_>>());
            assert_eq!(pool.count(e), nodes.len());
            assert_eq!(pool.weight(e), written(&pool, e));
            let symbol = |e: &Expr| match pool.node(*e) {
                Node::Symbol(s) => Some(*s),
                _ => None,
            };
            let symbols: BTreeSet<Symbol> = nodes.iter().filter_map(symbol).collect();
            assert_eq!(pool.symbols_of(e), symbols.iter().copied().collect::<Vec<_>>());
            for name in ["q", "u", "theta", "m", "k", "b", "f3", "f140"] {
                let Some(s) = pool.find_symbol(name) else { continue };
                assert_eq!(
                    pool.depends(e, s),
                    symbols.contains(&s),
                    "{} in {}",
                    name,
                    pool.text(e)
                );
            }
        }
    }
}

#[test]
fn several_roots_are_walked_as_one() {
    let (pool, all) = pool_of_many(0);
    let mut nodes = BTreeSet::new();
    for &e in &all {
        below(&pool, e, &mut nodes);
    }
    assert_eq!(pool.reachable(&all), nodes.into_iter().collect::<Vec<_>>());
    assert_eq!(pool.reachable(&[]), Vec::<Expr>::new());
}

#[test]
fn what_was_simplified_before_is_simplified_alike_again() {
    // one pool for all, in both orders, and one pool for each
    let (mut together, all) = pool_of_many(0);
    let forwards: Vec<Expr> = all.iter().map(|&e| together.simplify(e)).collect();
    for (i, &e) in all.iter().enumerate().rev() {
        assert_eq!(together.simplify(e), forwards[i]);
        let (mut alone, others) = pool_of_many(0);
        let simpler = alone.simplify(others[i]);
        assert_eq!(alone.text(simpler), together.text(forwards[i]));
        assert_eq!(alone.weight(simpler), written(&alone, simpler));
    }
    assert!(all.iter().zip(&forwards).any(|(e, simpler)| e != simpler), "something was simplified");
}

/// n/d in lowest terms by Euclid's algorithm in 128 bits.
fn lowest(n: i128, d: i128) -> Option<(i64, i64)> {
    let (mut a, mut b) = (n.unsigned_abs(), d.unsigned_abs());
    while b != 0 {
        (a, b) = (b, a % b);
    }
    let sign = d.signum();
    let (n, d) = (sign * n / a.max(1) as i128, sign * d / a.max(1) as i128);
    Some((i64::try_from(n).ok().filter(|&n| n != i64::MIN)?, i64::try_from(d).ok()?))
}

#[test]
fn rationals_are_in_lowest_terms_whatever_their_size() {
    let sizes = [0, 1, 2, 3, 12, 90, 1 << 20, 3 << 40, i64::MAX - 1, i64::MAX];
    let all: Vec<i64> = sizes.into_iter().flat_map(|n| [n, -n]).collect();
    for &a in nonempty(&all) {
        for &c in nonempty(&all) {
            let expected = |n: i128, d: i128| match lowest(n, d) {
                Some((n, d)) => Number::Rational(n, d),
                None => Number::Real(n as f64 / d as f64),
            };
            let (x, y) = (i128::from(a), i128::from(c));
            let near = |got: Number, expected: Number| match (got, expected) {
                (Number::Real(got), Number::Real(e)) => (got - e).abs() <= e.abs() * 1e-15,
                _ => got == expected,
            };
            assert!(near(Number::integer(a) + Number::integer(c), expected(x + y, 1)), "{a} + {c}");
            assert!(near(Number::integer(a) * Number::integer(c), expected(x * y, 1)), "{a} · {c}");
            if c != 0 {
                assert!(near(Number::ratio(x, y), expected(x, y)), "{a} / {c}");
                assert!(near(Number::ratio(3 * x, 7 * y), expected(3 * x, 7 * y)), "{a} / {c}");
            }
            assert_eq!(Number::integer(a).cmp(&Number::integer(c)), a.cmp(&c));
            if a != 0 && c != 0 {
                let divisor = Number::integer(a).common_divisor(Number::integer(c));
                let n = divisor.as_integer().unwrap();
                assert!(n > 0 && a % n == 0 && c % n == 0, "{a}, {c}: {n}");
                assert_eq!(lowest(i128::from(a / n), i128::from(c / n)).unwrap().1, (c / n).abs());
            }
        }
    }
}
