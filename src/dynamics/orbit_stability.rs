//! Whether the neighbours of a periodic orbit stay near it, to first order.
//!
//! In: its multipliers. Out: one of four kinds. Never here: how multipliers are found, what is printed of them.

use super::orbit::Orbit;
use crate::num::math;

/// A multiplier up to this far from 1 is listed as 1: of a double one half of the digits are lost.
const NEAR_ONE: f64 = 1e-5;

/// (μ − 1)² of a double multiplier 1 is rounding of the matrix, up to this many times.
const TIMES: f64 = 100.0;

/// What becomes of the neighbours of a periodic orbit, to first order.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum OrbitStability {
    /// There is no direction across it but that to orbits of other energies.
    Neutral,
    /// All multipliers are 1: neighbours turn about it as little as they part exponentially, as on a torus that is filled
    /// with periodic orbits.
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

/// Whether a multiplier is 1 but for half of the digits.
pub fn is_near_one([re, im]: &[f64; 2]) -> bool {
    math::hypot(re - 1.0, *im) <= NEAR_ONE
}

impl Orbit {
    /// Whether a multiplier is 1 as far as rounding of the matrix lets it be known.
    fn is_one(&self, [re, im]: [f64; 2]) -> bool {
        let rounding = self.rounding.unwrap_or(0.0).max(f64::EPSILON);
        math::hypot(re - 1.0, im) <= (TIMES * rounding).sqrt().min(NEAR_ONE)
    }

    /// What becomes of its neighbours, to first order.
    pub fn stability(&self) -> OrbitStability {
        match (self.multipliers.is_empty(), self.stable) {
            (true, _) => OrbitStability::Neutral,
            (false, true) if self.multipliers.iter().all(|z| self.is_one(*z)) => {
                OrbitStability::Parabolic
            }
            (false, true) => OrbitStability::Stable,
            (false, false) => OrbitStability::Unstable,
        }
    }
}
