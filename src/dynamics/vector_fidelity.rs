//! Whether tangent vectors were carried as the motion carries its neighbours: steps of a method lead past a pole of the coordinates
//! with vectors that mean nothing beyond it, while the motion itself continues.
//!
//! In: the growth of the vectors, how they were carried. Out: why it shows nothing, if so. Never here: where the pole lies.

use super::lyapunov_course::CarriedMotion;
use super::step_growth::StepGrowth;
use super::tangent_growth::TangentGrowth;
use crate::num::short;

/// A pair of exponents whose sum is this part of the largest one is none.
const UNPAIRED: f64 = 0.1;

/// What is known of a motion that was followed.
pub(super) struct Followed<'a> {
    pub(super) motion: &'a CarriedMotion,
    pub(super) growth: &'a TangentGrowth,
    pub(super) single_steps: &'a StepGrowth,
    /// The largest exponent.
    pub(super) largest: f64,
    /// The largest |λᵢ + λⱼ| of a pair, where pairs are expected at every time.
    pub(super) pairing: Option<f64>,
    /// Whether vectors grow at single times by nature, as at impulses.
    pub(super) jumps: bool,
}

impl Followed<'_> {
    /// Why the growth of the vectors shows nothing of the motion.
    pub(super) fn doubt(&self) -> Option<String> {
        let lasted = self.growth.end() - self.growth.begin();
        if let Some(off) = self.pairing.filter(|_| !self.jumps)
            && off * lasted > 1.0
            && off > UNPAIRED * self.largest.abs()
        {
            return Some(format!(
                "the steps do not keep the areas that the motion keeps: exponents of a pair add up to {}, not to 0, as where \
                 they lead past a pole of the coordinates, or are too coarse; {} may tell",
                short(off),
                self.remedy()
            ));
        }
        if !self.motion.fixed || self.jumps {
            return None;
        }
        let (parted, at) = self.single_steps.outstanding(self.motion.steps)?;
        Some(format!(
            "in the single step that ends at t = {} neighbouring motions part by e^{parted:.1}; the step leads past a pole of \
             the coordinates, or is too long; {} may tell",
            short(at),
            self.remedy()
        ))
    }

    /// What may show more.
    fn remedy(&self) -> &'static str {
        if self.motion.fixed {
            "other coordinates, the default method or a smaller step"
        } else {
            "other coordinates or a smaller tolerance"
        }
    }
}
