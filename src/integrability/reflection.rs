//! Reflections that leave a law as it is: changes of sign of some variables, as x, p_x → −x, −p_x or p → −p.
//!
//! In: a law, the functions of which a constant of the motion may be made. Out: [`Reflection`]s, each proved, none the
//! product of others. The even and the odd part of a constant of the motion are constants themselves: with σ such a
//! reflection, D(F∘σ) = ±(DF)∘σ. A search among monomials that are even or odd therefore parts into one for each class,
//! and each costs an eighth of the elimination of the whole where there are two. Never here: monomials, residues.

use std::collections::HashMap;

use super::law::{Law, RateRule};
use crate::expr::{Expr, Pool, Symbol, Zero};

/// The largest number of coordinates, or of variables of a Poisson system, of which all subsets are tried; of more only
/// those of one, of two and of all.
const ALL_SUBSETS: usize = 8;

/// The golden ratio, whose multiples make points without a pattern.
const GOLDEN: f64 = 1.618_033_988_749_895;

/// A reflection, by the functions whose sign it changes; the others do not change.
#[derive(Clone, Debug)]
pub(super) struct Reflection {
    pub(super) momenta: Vec<bool>,
    pub(super) coefficients: Vec<bool>,
}

/// The reflections under which the law is the same and each of these functions is even or odd.
pub(super) fn of(
    pool: &mut Pool,
    law: &Law,
    momenta: &[Expr],
    coefficients: &[Expr],
) -> Vec<Reflection> {
    let reversible = !law.expressions().iter().any(|&e| pool.depends(e, law.time));
    let mut found = Vec::new();
    // those known, in echelon form: as bits of the variables
    let mut known: Vec<u64> = Vec::new();
    for (flipped, reversed) in candidates(law, reversible) {
        let mut rest = flipped;
        for &one in &known {
            rest = rest.min(rest ^ one);
        }
        if rest == 0 || !leaves(pool, law, flipped, reversed) {
            continue;
        }
        let images = images(pool, law, flipped);
        let parities = |pool: &mut Pool, all: &[Expr]| -> Option<Vec<bool>> {
            all.iter().map(|&e| parity(pool, e, &images)).collect()
        };
        let (Some(momenta), Some(coefficients)) =
            (parities(pool, momenta), parities(pool, coefficients))
        else {
            continue;
        };
        known.push(rest);
        known.sort_unstable_by(|a, b| b.cmp(a));
        found.push(Reflection { momenta, coefficients });
    }
    found
}

/// Which variables may change their signs, as bits, and whether time is reversed.
fn candidates(law: &Law, reversible: bool) -> Vec<(u64, bool)> {
    let (n, count) = (law.positions, law.variables.len());
    if count == 0 || count > 64 {
        return Vec::new();
    }
    let places = if n == 0 { count } else { n };
    let mut subsets: Vec<u64> = if places <= ALL_SUBSETS {
        (1..1 << places).collect()
    } else {
        let ones = (0..places).map(|i| 1 << i);
        let pairs = (0..places).flat_map(|i| (0..i).map(move |j| 1 << i | 1 << j));
        ones.chain(pairs).chain([u64::MAX >> (64 - places)]).collect()
    };
    if n == 0 {
        let both = |s: u64| [(s, false), (s, true)].into_iter().take(1 + usize::from(reversible));
        return subsets.into_iter().flat_map(both).collect();
    }
    subsets.insert(0, 0);
    // a coordinate changes its sign together with its rate or momentum, time reversed those of all
    let rates = ((1_u64 << n) - 1) << n;
    let both = |s: u64| [(s | s << n, false), ((s | s << n) ^ rates, true)];
    let all = subsets.into_iter().flat_map(both);
    all.filter(|&(flipped, reversed)| flipped != 0 && (reversible || !reversed)).collect()
}

fn images(pool: &mut Pool, law: &Law, flipped: u64) -> HashMap<Symbol, Expr> {
    let changed = law.variables.iter().enumerate().filter(|(i, _)| flipped >> i & 1 == 1);
    changed
        .map(|(_, &s)| {
            let x = pool.variable(s);
            (s, pool.neg(x))
        })
        .collect()
}

/// What has to be odd, or even, for the law to be the same: the rate of each variable changes its sign as the variable
/// does, and once more where time is reversed. `None` if the law has another form.
fn conditions(law: &Law, flipped: u64, reversed: bool) -> Option<Vec<(Expr, bool)>> {
    let odd = |i: usize| flipped >> i & 1 == 1;
    match &law.rule {
        RateRule::Explicit(rates) => {
            Some(rates.iter().enumerate().map(|(i, &e)| (e, odd(i) != reversed)).collect())
        }
        RateRule::Solved { mass, force, rows } if rows.is_empty() && !reversed => {
            let forces = force.iter().enumerate().map(|(i, &e)| (e, odd(i)));
            let masses = mass.iter().enumerate().flat_map(|(i, row)| {
                row.iter().enumerate().map(move |(j, &e)| (e, odd(i) != odd(j)))
            });
            Some(forces.chain(masses).collect())
        }
        RateRule::Solved { .. } => None,
    }
}

fn leaves(pool: &mut Pool, law: &Law, flipped: u64, reversed: bool) -> bool {
    let Some(all) = conditions(law, flipped, reversed) else { return false };
    // most candidates are refused by numbers, which costs little
    if !all.iter().all(|&(e, odd)| seems(pool, law, e, (flipped, odd))) {
        return false;
    }
    let images = images(pool, law, flipped);
    all.into_iter().all(|(e, odd)| has(pool, e, odd, &images))
}

/// Whether a function may be odd, or even, by its values at a point and its image.
fn seems(pool: &Pool, law: &Law, e: Expr, (flipped, odd): (u64, bool)) -> bool {
    let at = |mirrored: bool| {
        pool.evaluate(e, &|symbol| match law.variables.iter().position(|&s| s == symbol) {
            Some(i) => {
                let x = 0.25 + (GOLDEN * (i + 1) as f64).fract();
                if mirrored && flipped >> i & 1 == 1 { -x } else { x }
            }
            None => GOLDEN,
        })
    };
    let (here, there) = (at(false), at(true));
    let expected = if odd { -here } else { here };
    !(here.is_finite() && there.is_finite())
        || (there - expected).abs() <= 1e-9 * (here.abs() + there.abs())
}

/// Whether a function is odd; `None` if it is neither odd nor even, or that is not proved.
fn parity(pool: &mut Pool, e: Expr, images: &HashMap<Symbol, Expr>) -> Option<bool> {
    [false, true].into_iter().find(|&odd| has(pool, e, odd, images))
}

/// Whether it is proved that a function is odd, or even.
fn has(pool: &mut Pool, e: Expr, odd: bool, images: &HashMap<Symbol, Expr>) -> bool {
    let image = pool.substitute(e, images);
    let other = if odd { pool.neg(e) } else { e };
    if image == other {
        return !pool.is_full();
    }
    let difference = pool.sub(image, other);
    pool.is_zero(difference) == Zero::Proved
}
