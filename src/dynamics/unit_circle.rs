//! Where multipliers lie with respect to the unit circle, as far as their errors let it be known.
//!
//! In: multipliers, the error of each, what rounding leaves of their matrix. Out: on it, outside, or 1. Never here: what follows for an orbit.

use crate::num::math;

/// A multiplier this close to the unit circle lies on it, whatever its error.
pub(super) const ON_CIRCLE: f64 = 1e-6;

/// A multiplier farther from 1 is none, whatever rounding leaves of it.
const NEAR_ONE: f64 = 1e-5;

/// (μ − 1)² of a double multiplier 1 is rounding of the matrix, up to this many times.
const TIMES: f64 = 100.0;

/// A multiplier off the circle has a partner 1/μ̄ if one is this near, as a part of its own distance from that.
const PARTNER: f64 = 0.5;

#[derive(Clone, Copy, Debug)]
pub(super) struct KnownMultipliers<'a> {
    pub(super) multipliers: &'a [[f64; 2]],
    /// The error of each to first order; infinite where there is none.
    pub(super) errors: &'a [f64],
    /// What rounding leaves of the entries of their matrix.
    pub(super) rounding: f64,
    /// Whether the matrix is symplectic, so that with μ off the unit circle 1/μ̄ is a multiplier as well.
    pub(super) is_symplectic: bool,
}

impl KnownMultipliers<'_> {
    /// Whether a multiplier is 1: within its error, and of a double one half of the digits of the matrix are lost.
    pub(super) fn is_one(&self, i: usize) -> bool {
        let [re, im] = self.multipliers[i];
        let most = (TIMES * self.rounding).sqrt().min(NEAR_ONE);
        math::hypot(re - 1.0, im) <= self.errors[i].min(most)
    }

    /// Whether no multiplier lies outside the unit circle but by what rounding of the matrix makes of 1.
    pub(super) fn none_is_outside(&self) -> bool {
        (0..self.multipliers.len()).all(|i| !self.is_outside(i) || self.is_one(i))
    }

    /// Whether a multiplier lies outside the unit circle.
    pub(super) fn is_outside(&self, i: usize) -> bool {
        let beyond = size(self.multipliers[i]) - 1.0;
        beyond > ON_CIRCLE
            || beyond > self.errors[i] && (!self.is_symplectic || self.has_partner(i))
    }

    /// Whether the multiplier at 1/μ̄ is another one, and not μ on the unit circle itself.
    fn has_partner(&self, i: usize) -> bool {
        let [re, im] = self.multipliers[i];
        let square = re * re + im * im;
        let off = |z: [f64; 2]| math::hypot(z[0] - re / square, z[1] - im / square);
        let others = self.multipliers.iter().enumerate().filter(|&(j, _)| j != i);
        others.map(|(_, &z)| off(z)).any(|distance| distance < PARTNER * off([re, im]))
    }
}

fn size([re, im]: [f64; 2]) -> f64 {
    math::hypot(re, im)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn known<'a>(
        multipliers: &'a [[f64; 2]],
        errors: &'a [f64],
        rounding: f64,
    ) -> KnownMultipliers<'a> {
        KnownMultipliers { multipliers, errors, rounding, is_symplectic: false }
    }

    /// Those of a proton in crossed fields, all of which are 1: √(1.2e-11) = 3.4e-6.
    #[test]
    fn what_rounding_makes_of_one_is_not_outside() {
        let off = [1.000_001_721_803_657, 1.261_323_960_354_561e-7];
        let multipliers = [off, [off[0], -off[1]], [1.0, 0.0], [0.999_998_278_194_624_4, 0.0]];
        let errors = [f64::INFINITY; 4];
        assert!(known(&multipliers, &errors, 1.176e-11).none_is_outside());
        assert!(!known(&multipliers, &errors, 1e-15).none_is_outside());
        assert!(!known(&multipliers, &[1e-7; 4], 1.176e-11).none_is_outside());
        let apart = [[1.001, 0.0], [1.0 / 1.001, 0.0]];
        assert!(!known(&apart, &errors[..2], 1.176e-11).none_is_outside());
    }

    /// √(100 ε) of what rounding leaves of the matrix, and never more than 1e-5 or the error.
    #[test]
    fn a_multiplier_is_one_to_half_of_the_digits_of_its_matrix() {
        for (rounding, error, within, beyond) in [
            (1e-14, f64::INFINITY, 0.99e-6, 1.01e-6),
            (1e-12, f64::INFINITY, 0.99e-5, 1.01e-5),
            (1e-8, f64::INFINITY, 0.99e-5, 1.01e-5),
            (1e-14, 1e-13, 0.9e-13, 1.1e-13),
        ] {
            for (re, im) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.6, -0.8)] {
                let is_one =
                    |off: f64| known(&[[1.0 + off * re, off * im]], &[error], rounding).is_one(0);
                assert!(is_one(within), "{rounding} {re} {im}");
                assert!(!is_one(beyond), "{rounding} {re} {im}");
            }
        }
    }

    /// Of a symplectic matrix a multiplier is off the circle only with its partner, whatever its error seems to be.
    #[test]
    fn a_multiplier_is_outside_beyond_its_error_and_with_its_partner() {
        let off = 1e-9;
        let (pair, alone) =
            ([[1.0 + off, 0.0], [1.0 - off, 0.0]], [[0.6, 0.8 + off], [0.6, -0.8 - off]]);
        for (multipliers, is_symplectic, outside) in
            [(pair, true, true), (pair, false, true), (alone, true, false), (alone, false, true)]
        {
            let is_outside = |error: f64| {
                let errors = [error; 2];
                let known = known(&multipliers, &errors, 1e-15);
                KnownMultipliers { is_symplectic, ..known }.is_outside(0)
            };
            assert_eq!(is_outside(0.5 * off), outside, "{multipliers:?} {is_symplectic}");
            assert!(!is_outside(2.0 * off), "{multipliers:?}");
        }
    }
}
