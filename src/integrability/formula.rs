//! Combinations of monomials as expressions, with the shortest coefficients, and ansätze in words.
//!
//! In: columns with their coefficients. Out: expressions and sentences. Never here: the search.

use super::ansatz::Ansatz;
use super::atoms::Atoms;
use super::law::Law;
use crate::expr::{Expr, Node, Pool};
use crate::num::{Number, gcd};

/// Σ coefficient · monomial.
pub(super) fn combination(
    pool: &mut Pool,
    atoms: &Atoms,
    ansatz: &Ansatz,
    columns: &[usize],
    coefficients: &[Expr],
) -> Expr {
    let terms: Vec<Expr> = columns
        .iter()
        .zip(coefficients)
        .map(|(&column, &c)| {
            let monomial = ansatz.expression(pool, atoms, column);
            pool.mul(c, monomial)
        })
        .collect();
    pool.sum(&terms)
}

/// The same coefficients times a common factor, without common factors and without denominators.
pub(super) fn cleared(pool: &mut Pool, coefficients: &[Expr]) -> Vec<Expr> {
    let mut numbers = Vec::new();
    let mut factors: Vec<Vec<(Expr, Number)>> = Vec::new();
    for &e in coefficients {
        let (c, own) = match pool.node(e) {
            Node::Number(n) => (*n, Vec::new()),
            Node::Product(c, own) => (*c, own.to_vec()),
            _ => (Number::ONE, vec![(e, Number::ONE)]),
        };
        numbers.push(c);
        factors.push(own);
    }
    let mut common: Vec<(Expr, Number)> = Vec::new();
    for (base, _) in factors.concat() {
        if common.iter().any(|(b, _)| *b == base) {
            continue;
        }
        let power = |own: &Vec<(Expr, Number)>| {
            own.iter().find(|(b, _)| *b == base).map_or(Number::ZERO, |(_, n)| *n)
        };
        let least = factors.iter().map(power).min().unwrap_or(Number::ZERO);
        common.push((base, -least));
    }
    let numbers = least_integers(&numbers);
    let all = numbers.into_iter().zip(factors).map(|(c, mut own)| {
        own.extend_from_slice(&common);
        pool.monomial(c, &own)
    });
    all.collect()
}

/// The greatest number of which the coefficients of all terms are whole multiples.
pub(super) fn content(pool: &Pool, all: &[Expr]) -> Number {
    let mut numbers = Vec::new();
    for &e in all {
        match pool.node(e) {
            Node::Number(n) => numbers.push(*n),
            Node::Product(c, _) => numbers.push(*c),
            Node::Sum(constant, terms) => {
                numbers.extend([*constant].into_iter().chain(terms.iter().map(|(c, _)| *c)));
            }
            _ => numbers.push(Number::ONE),
        }
    }
    let nonzero = numbers.into_iter().filter(|n| !n.is_zero());
    nonzero.reduce(Number::common_divisor).map_or(Number::ONE, Number::abs)
}

/// The least integers in the same ratio as some rationals, the first of them positive.
fn least_integers(all: &[Number]) -> Vec<Number> {
    let fraction = |n: &Number| match n {
        Number::Rational(n, d) => Some((i128::from(*n), i128::from(*d))),
        Number::Real(_) => None,
    };
    let Some(fractions) = all.iter().map(fraction).collect::<Option<Vec<_>>>() else {
        return all.to_vec();
    };
    let common = |a: i128, b: i128| gcd(a.unsigned_abs(), b.unsigned_abs()) as i128;
    let multiple =
        fractions.iter().try_fold(1_i128, |m, (_, d)| (m / common(m, *d)).checked_mul(*d));
    let Some(multiple) = multiple else { return all.to_vec() };
    let whole = fractions.iter().map(|(n, d)| n.checked_mul(multiple / d));
    let Some(whole) = whole.collect::<Option<Vec<i128>>>() else { return all.to_vec() };
    let divisor = whole.iter().fold(0, |g, &n| common(g, n)).max(1);
    let divisor = if whole.first().is_some_and(|n| *n < 0) { -divisor } else { divisor };
    let scaled: Vec<Number> = whole.iter().map(|&n| Number::ratio(n / divisor, 1)).collect();
    let fit = scaled.iter().all(|n| matches!(n, Number::Rational(..)));
    if fit { scaled } else { all.to_vec() }
}

/// The ansatz in words: what was searched, and so where nothing else is. `print` writes an expression.
pub(super) fn words(
    law: &Law,
    atoms: &Atoms,
    ansatz: &Ansatz,
    print: &dyn Fn(Expr) -> String,
) -> String {
    let list = |all: Vec<String>| all.join(", ");
    let others = list(atoms.coefficients.iter().map(|g| print(g.expression)).collect());
    if law.positions == 0 {
        return format!("polynomials of degree up to {} in {others}", ansatz.bounds[0].1);
    }
    let momenta = list(atoms.momenta.iter().map(|&p| print(p)).collect());
    let mut degrees: Vec<(u32, u32)> = ansatz.bounds.clone();
    degrees.sort_unstable_by(|a, b| b.cmp(a));
    let in_momenta = enumerated(degrees.iter().map(|(k, _)| *k));
    if others.is_empty() {
        return format!("polynomials in {momenta} with terms of degree {in_momenta}");
    }
    let in_others = enumerated(degrees.iter().map(|(_, n)| *n));
    let each = if degrees.len() > 1 { ", respectively" } else { "" };
    format!(
        "polynomials in {momenta} with terms of degree {in_momenta}, whose coefficients are polynomials of \
         degree up to {in_others} in {others}{each}"
    )
}

/// Numbers as in a sentence: `3, 2 and 1`.
fn enumerated(numbers: impl Iterator<Item = u32>) -> String {
    let all: Vec<String> = numbers.map(|number| number.to_string()).collect();
    match all.as_slice() {
        [first @ .., last] if !first.is_empty() => format!("{} and {last}", first.join(", ")),
        _ => all.concat(),
    }
}
