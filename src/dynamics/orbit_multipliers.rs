//! What follows from the multipliers of a periodic orbit.
//!
//! In: an orbit with its matrix. Out: the names of the trivial ones, which of them rounding hides, exponents, angles, Greene's residue.
//! Never here: how the orbit was closed, what becomes of its neighbours (`orbit_stability`).

use super::orbit::Orbit;
use super::transverse::Removed;
use super::unit_circle::ON_CIRCLE;
use crate::num::math;

/// Rounding up to this size leaves of a multiplier that is smaller that it nearly vanishes.
const VANISHING: f64 = 1e-3;

/// The error of a determinant in errors of the entries of its matrix, times the largest of them.
const TIMES: f64 = 16.0;

impl Orbit {
    /// The reasons for its trivial multipliers, one for each.
    pub fn trivial_names(&self) -> Vec<&str> {
        let canonical = match self.trivial {
            Removed::Nothing => &[][..],
            Removed::Flow => &["flow"],
            Removed::FlowAndEnergy => &["flow", "energy"],
        };
        canonical.iter().copied().chain(self.levels.iter().map(String::as_str)).collect()
    }

    /// Greene's residue (2 − tr M)/4, where two multipliers are left and areas across the orbit are preserved: between 0
    /// and 1 the orbit is elliptic, below 0 hyperbolic, above 1 hyperbolic with reflection (J. M. Greene, J. Math. Phys.
    /// 20 (1979) 1183).
    pub fn residue(&self) -> Option<f64> {
        let across = &self.transverse;
        let preserves = across.nrows() == 2 && self.preserves_volume();
        preserves.then(|| (2.0 - across.trace()) / 4.0)
    }

    /// Whether the flow preserves volumes across the orbit, as far as rounding lets it be known: the product of the multipliers is 1.
    pub(super) fn preserves_volume(&self) -> bool {
        let error = self.rounding.map_or(ON_CIRCLE, |rounding| {
            // each factor of a product of two may be as large as the largest
            let size = self.transverse.amax().max(1.0);
            (TIMES * rounding.max(f64::EPSILON) * size).min(ON_CIRCLE)
        });
        self.is_symplectic || (self.transverse.determinant() - 1.0).abs() <= error
    }

    /// Whether a multiplier is so small that it is lost in rounding.
    pub fn is_lost(&self, [re, im]: [f64; 2]) -> bool {
        self.rounding.is_some_and(|rounding| math::hypot(re, im) <= rounding)
    }

    /// Whether no more is known of a multiplier than that it nearly vanishes: it is lost in rounding that is itself small. Beside
    /// a multiplier of 10¹⁶ and more nothing is known of those on the unit circle.
    pub fn nearly_vanishes(&self, multiplier: [f64; 2]) -> bool {
        self.is_lost(multiplier) && self.rounding.is_some_and(|rounding| rounding <= VANISHING)
    }

    /// The characteristic exponent ln|μ|/T of a multiplier μ: the Lyapunov exponent along its direction; nothing where μ is
    /// lost in rounding.
    pub fn exponent(&self, [re, im]: [f64; 2]) -> Option<f64> {
        let known = !self.is_lost([re, im]);
        known.then(|| math::ln(math::hypot(re, im)) / self.period)
    }

    /// The angle by which a pair of multipliers e^{±2πiν} turns in a period, in turns: 0 < ν < ½, or nothing off the unit circle.
    pub fn rotation(&self, [re, im]: [f64; 2]) -> Option<f64> {
        let on_circle = im != 0.0 && (math::hypot(re, im) - 1.0).abs() <= ON_CIRCLE;
        on_circle.then(|| math::atan2(im.abs(), re) / core::f64::consts::TAU)
    }
}
