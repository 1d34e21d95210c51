//! The numbers under square roots of an expression, and which of the two roots each stands for.
//!
//! In: numbers under roots. Out: square-free numbers without common factors. Never here: residues.

use rustc_hash::FxHashMap;

use super::units::least_common;
use crate::expr::{Expr, Node, Pool};
use crate::num::Number;

/// The numbers of which square roots are taken.
#[derive(Clone, Debug, Default)]
pub(super) struct Radicals {
    /// Square-free and without common factors; none where there are other roots of numbers.
    pub(super) numbers: Vec<i64>,
    /// The position among them for each node under a root.
    pub(super) of: FxHashMap<usize, usize>,
    /// Which roots are the negative ones, a bit for each.
    pub(super) negative: u32,
}

impl Radicals {
    pub(super) fn new(
        pool: &Pool,
        orders: &FxHashMap<Expr, u64>,
        index: &FxHashMap<Expr, usize>,
    ) -> Radicals {
        let mut radicals = Radicals::default();
        for (base, order) in orders.iter().filter(|(_, order)| **order > 1) {
            let Node::Number(number) = *pool.node(*base) else { continue };
            let Some(free) = square_free(number).filter(|_| *order == 2) else {
                return Radicals::default();
            };
            let known = radicals.numbers.iter().position(|&known| known == free);
            let k = known.unwrap_or_else(|| {
                radicals.numbers.push(free);
                radicals.numbers.len() - 1
            });
            radicals.of.insert(index[base], k);
        }
        let all = &radicals.numbers;
        let divisor = |a: i64, b: i64| a / (least_common(a, b) / b);
        let coprime = (0..all.len()).all(|i| (0..i).all(|j| divisor(all[i], all[j]) == 1));
        if coprime && all.len() <= MOST_RADICALS { radicals } else { Radicals::default() }
    }
}

/// The square-free part of the product of numerator and denominator of a positive fraction.
fn square_free(number: Number) -> Option<i64> {
    let Number::Rational(n, d) = number else { return None };
    let mut free = n.checked_mul(d).filter(|free| *free > 1)?;
    let mut k = 2_i64;
    while k.checked_mul(k).is_some_and(|square| square <= free) {
        if k > LARGEST_FACTOR {
            return None;
        }
        while free % (k * k) == 0 {
            free /= k * k;
        }
        k += 1;
    }
    Some(free)
}

/// The largest factor that is searched for in a number under a root.
const LARGEST_FACTOR: i64 = 10_000;

/// The largest number of different square roots of numbers.
const MOST_RADICALS: usize = 3;
