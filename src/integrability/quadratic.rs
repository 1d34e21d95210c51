//! Coefficients such as a + b √2, where the law has roots of numbers, as that of a system turned by 45° has.
//!
//! In: the monomials of one constant of the motion, and its coefficients modulo a prime. Out: the coefficients, guessed
//! until the constant is proved. Never here: the proof.
//!
//! With −√2 in place of √2 the same constant has the coefficients a − b √2. Of several roots all signs are taken: the
//! coefficient of a product of some of them is the mean over all signs, each with the sign of that product.

use rustc_hash::FxHashMap;

use super::ansatz::Ansatz;
use super::atoms::Atoms;
use super::coefficients::{SPARE_BITS, only};
use super::level::Ground;
use super::random::Random;
use crate::expr::{Expr, Pool};
use crate::num::{Number, Residue};

/// The coefficients of a combination known modulo a prime, whose first is 1.
pub(super) fn with_root(
    pool: &mut Pool,
    ground: &Ground<'_>,
    (atoms, ansatz): (&Atoms, &Ansatz),
    vector: &[(usize, Residue)],
    random: &mut Random,
) -> Option<Vec<Expr>> {
    let field = ground.field;
    let numbers = ground.evaluator.radicals().to_vec();
    if numbers.is_empty() {
        return None;
    }
    let columns: Vec<usize> = vector.iter().map(|(c, _)| *c).collect();
    let signs = 1_u32 << numbers.len();
    let mut conjugates = vec![vector.iter().map(|(_, x)| *x).collect::<Vec<Residue>>()];
    for negative in 1..signs {
        let evaluator = ground.evaluator.conjugate(negative);
        let other = Ground {
            law: ground.law,
            evaluator: &evaluator,
            field,
            constants: FxHashMap::default(),
            seed: ground.seed,
            is_over: ground.is_over,
        };
        conjugates.push(only(&other, atoms, ansatz, &columns, random)?);
    }
    let mean = field.inverse(field.residue(signs.into()))?;
    let mut parts: Vec<Vec<(Number, Expr)>> = vec![Vec::new(); columns.len()];
    for product in 0..signs {
        let chosen = (0..numbers.len()).filter(|k| product >> k & 1 == 1);
        let under = Number::integer(chosen.map(|k| numbers[k]).product());
        let over_root = field.inverse(field.root(field.number(under)?, 2)?)?;
        let under = pool.number(under);
        let root = pool.sqrt(under);
        for (i, parts) in parts.iter_mut().enumerate() {
            let sum = (0..signs).fold(Residue::ZERO, |sum, negative| {
                let odd = (negative & product).count_ones() % 2 == 1;
                let x = conjugates[negative as usize][i];
                if odd { field.sub(sum, x) } else { field.add(sum, x) }
            });
            let x = field.mul(field.mul(sum, mean), over_root);
            parts.push((field.fraction(x, SPARE_BITS)?, root));
        }
    }
    Some(parts.iter().map(|parts| pool.linear(Number::ZERO, parts)).collect())
}
