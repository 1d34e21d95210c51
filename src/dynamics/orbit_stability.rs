//! Whether the neighbours of a periodic orbit stay near it, to first order.
//!
//! In: its multipliers. Out: one of four kinds. Never here: how multipliers are found, what is printed of them.

use super::orbit::Orbit;
use super::unit_circle::KnownMultipliers;

/// An error that rounding leaves of the matrix of the multipliers is mentioned if it may show in their digits.
pub const NOTICED_ROUNDING: f64 = 1e-8;

/// The stability of a periodic orbit, to first order.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum OrbitStability {
    /// There is no direction across it but that to orbits of other energies.
    Neutral,
    /// All multipliers are 1: neighbours turn about it as little as they part exponentially, as on a torus that is filled
    /// with periodic orbits. Or two have met at 1 or −1, and no other is outside the unit circle, as where a family bifurcates.
    Parabolic,
    /// No multiplier lies outside the unit circle.
    Stable,
    /// One does.
    Unstable,
}

impl OrbitStability {
    /// The word in tables.
    pub fn word(self) -> &'static str {
        match self {
            OrbitStability::Neutral => "neutral",
            OrbitStability::Parabolic => "parabolic",
            OrbitStability::Stable => "stable",
            OrbitStability::Unstable => "unstable",
        }
    }
}

/// Whether two multipliers of product 1 lie on the unit circle, by the trace of their matrix and its error; `None` where
/// the trace is ±2 within it.
fn is_elliptic(trace: f64, error: f64) -> Option<bool> {
    let within = 2.0 - trace.abs();
    (within.abs() > error).then_some(within > 0.0)
}

impl Orbit {
    pub(super) fn known(&self) -> KnownMultipliers<'_> {
        KnownMultipliers {
            multipliers: &self.multipliers,
            errors: &self.errors,
            rounding: self.rounding.unwrap_or(0.0).max(f64::EPSILON),
            is_symplectic: self.is_symplectic,
        }
    }

    /// Whether a multiplier is 1 as far as its error lets it be known.
    pub fn is_one(&self, i: usize) -> bool {
        self.known().is_one(i)
    }

    /// Whether no multiplier lies outside the unit circle; `None` where that is within the error of what is known of them.
    pub fn is_stable(&self) -> Option<bool> {
        match self.stability() {
            OrbitStability::Parabolic => None,
            OrbitStability::Neutral => Some(self.stable),
            OrbitStability::Stable | OrbitStability::Unstable => {
                // Greene's residue is that of two multipliers whose product is 1
                let error = 2.0 * self.rounding.unwrap_or(0.0).max(f64::EPSILON);
                match self.residue() {
                    // where the trace leaves it open the multipliers may still be known apart
                    Some(_) => is_elliptic(self.transverse.trace(), error)
                        .or_else(|| (!self.stable).then_some(false)),
                    // beside others a multiplier that rounding may have moved off the circle leaves it open
                    None if self.stable
                        && (0..self.multipliers.len()).any(|i| self.known().is_outside(i)) =>
                    {
                        None
                    }
                    None => Some(self.stable),
                }
            }
        }
    }

    /// Its stability, to first order.
    pub fn stability(&self) -> OrbitStability {
        match (self.multipliers.is_empty(), self.stable) {
            (true, _) => OrbitStability::Neutral,
            (false, true) if (0..self.multipliers.len()).all(|i| self.is_one(i)) => {
                OrbitStability::Parabolic
            }
            (false, true) => OrbitStability::Stable,
            (false, false) => OrbitStability::Unstable,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_trace_of_two_within_its_error_leaves_open_whether_an_orbit_is_stable() {
        for (trace, stable) in [
            (1.9, Some(true)),
            (-1.9, Some(true)),
            (2.0 - 1.1e-9, Some(true)),
            (2.0 - 0.9e-9, None),
            (2.0, None),
            (2.0 + 0.9e-9, None),
            (-2.0 - 0.9e-9, None),
            (2.0 + 1.1e-9, Some(false)),
            (-2.0 - 1.1e-9, Some(false)),
        ] {
            assert_eq!(is_elliptic(trace, 1e-9), stable, "{trace}");
        }
    }
}
