//! Yoshida's symmetric compositions of leapfrogs, of order 4, 6 and 8.
//!
//! Source: H. Yoshida, Physics Letters A 150 (1990) 262: equation 4.1 for order 4, solution A of
//! table 1 for order 6, solution D of table 2 for order 8. The further digits for order 6 are from
//! E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration, V.3.2.

use super::method::{Method, Preserves, Stepping};
use super::splitting;
use crate::num::math;

/// The weights of order 6, except the middle one.
const SIXTH: [f64; 3] = [0.784_513_610_477_557_3, 0.235_573_213_359_358_13, -1.177_679_984_178_871];

/// The weights of order 8, except the middle one.
const EIGHTH: [f64; 7] = [
    0.914_844_246_229_740,
    0.253_693_336_566_229,
    -1.444_852_236_860_48,
    -0.158_240_635_368_243,
    1.938_139_137_622_76,
    -1.960_610_232_975_49,
    0.102_799_849_391_985,
];

pub(super) const FOURTH_ORDER: Method = Method {
    name: "yoshida4",
    title: "Yoshida, order 4",
    order: Some(4),
    stepping: Stepping::Fixed,
    preserves: Preserves::SymplecticReversible,
    locates_kinks: false,
    stays_within_steps: false,
    needs: splitting::NEEDS,
    about: "Three leapfrogs, the middle one backwards: order 4 without a drift of energy. \
            Yoshida, Physics Letters A 150 (1990) 262, eq. 4.1.",
    fits: |system| splitting::fits(&FOURTH_ORDER, system),
    leapfrogs: || palindrome(&[1.0 / (2.0 - math::cbrt(2.0))]),
    make: |system, settings| splitting::make(&FOURTH_ORDER, system, settings),
};

pub(super) const SIXTH_ORDER: Method = Method {
    name: "yoshida6",
    title: "Yoshida, order 6",
    order: Some(6),
    stepping: Stepping::Fixed,
    preserves: Preserves::SymplecticReversible,
    locates_kinks: false,
    stays_within_steps: false,
    needs: splitting::NEEDS,
    about: "Seven leapfrogs of different length: order 6 without a drift of energy. Yoshida, \
            Physics Letters A 150 (1990) 262, solution A.",
    fits: |system| splitting::fits(&SIXTH_ORDER, system),
    leapfrogs: || palindrome(&SIXTH),
    make: |system, settings| splitting::make(&SIXTH_ORDER, system, settings),
};

pub(super) const EIGHTH_ORDER: Method = Method {
    name: "yoshida8",
    title: "Yoshida, order 8",
    order: Some(8),
    stepping: Stepping::Fixed,
    preserves: Preserves::SymplecticReversible,
    locates_kinks: false,
    stays_within_steps: false,
    needs: splitting::NEEDS,
    about: "Fifteen leapfrogs of different length: order 8 without a drift of energy, for small \
            errors at large steps. Yoshida, Physics Letters A 150 (1990) 262, solution D.",
    fits: |system| splitting::fits(&EIGHTH_ORDER, system),
    leapfrogs: || palindrome(&EIGHTH),
    make: |system, settings| splitting::make(&EIGHTH_ORDER, system, settings),
};

/// The weights `outer`, one that brings their sum to 1, and `outer` reversed.
fn palindrome(outer: &[f64]) -> Vec<f64> {
    let middle = 1.0 - 2.0 * outer.iter().sum::<f64>();
    outer.iter().copied().chain([middle]).chain(outer.iter().rev().copied()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrate::stability::{self, Modes};

    #[test]
    fn what_is_harmless_is_not_amplified() {
        // the first |z| beyond which the trace of the product of the leapfrogs' matrices passes ±2
        for (method, first) in
            [(FOURTH_ORDER, 1.5735), (SIXTH_ORDER, 2.2695), (EIGHTH_ORDER, 2.357)]
        {
            let weights = (method.leapfrogs)();
            let growth = splitting::growth;
            let harmless = stability::harmless(growth, &weights);
            assert!((0.85..0.9).contains(&(harmless / first)), "{} {harmless}", method.name);
            let modes = Modes { growth, weights: &weights, harmless };
            for k in 0..=20_000 {
                let z = harmless * f64::from(k) / 20_000.0;
                for direction in [[0.0, 1.0], [-0.05, 0.99], [0.0009, 0.9999], [-1.0, 0.0]] {
                    let z = direction.map(|part| part * z);
                    assert_eq!(modes.limit(&[z], 1.0), None, "{} {z:?}", method.name);
                }
            }
            // and not much more is
            assert!(modes.limit(&[[0.0, 1.5 * harmless]], 1.0).is_some(), "{}", method.name);
        }
    }
}
