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

pub(super) struct VectorFidelity<'a> {
    pub(super) motion: &'a CarriedMotion,
    pub(super) growth: &'a TangentGrowth,
    pub(super) single_steps: &'a StepGrowth,
    pub(super) largest: f64,
    /// The largest |λᵢ + λⱼ| of a pair, where pairs are expected at every time.
    pub(super) pairing: Option<f64>,
    /// The logarithms of the factors by which the volume of the vectors has grown, and that of phase space by Liouville's theorem.
    pub(super) volumes: Option<[f64; 2]>,
    /// Whether vectors grow at single times by nature, as at impulses.
    pub(super) jumps: bool,
}

impl VectorFidelity<'_> {
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
        if let Some([grown, flowed]) = self.volumes
            && (grown - flowed).abs() > 1.0
            && (grown - flowed).abs() > UNPAIRED * self.largest.abs() * lasted
        {
            return Some(format!(
                "the steps do not change the volume of phase space as the motion does: the exponents add up to {}, and its mean \
                 divergence is {}, as where they lead past a pole of the coordinates, or are too coarse; {} may tell",
                short(grown / lasted),
                short(flowed / lasted),
                self.remedy()
            ));
        }
        if !self.motion.fixed || self.jumps {
            return None;
        }
        let (growth, at) = self.single_steps.outstanding(self.motion.steps)?;
        Some(format!(
            "in the single step that ends at t = {} neighbouring motions separate by e^{growth:.1}; the step leads past a pole of \
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

#[cfg(test)]
mod tests {
    use super::{CarriedMotion, StepGrowth, TangentGrowth, VectorFidelity};
    use crate::integrate::Settings;

    /// Whether there is a doubt after so long.
    fn is_doubted(lasted: f64, largest: f64, pairing: Option<f64>) -> bool {
        doubt(lasted, largest, (pairing, None))
    }

    fn doubt(
        lasted: f64,
        largest: f64,
        (pairing, volumes): (Option<f64>, Option<[f64; 2]>),
    ) -> bool {
        let motion = CarriedMotion { settings: Settings::default(), fixed: false, steps: 1000 };
        let growth =
            TangentGrowth { times: vec![3.0, 3.0 + lasted], logarithms: vec![vec![0.0; 4]; 2] };
        let single_steps = &StepGrowth::default();
        let (motion, growth) = (&motion, &growth);
        let followed = VectorFidelity {
            motion,
            growth,
            single_steps,
            largest,
            pairing,
            volumes,
            jumps: false,
        };
        followed.doubt().is_some()
    }

    /// A pair is none where its sum is a tenth of the largest exponent and areas have changed by a factor of e.
    #[test]
    fn areas_change_by_a_factor_of_e_and_a_tenth_of_the_largest_exponent() {
        for (lasted, largest, off, doubted) in [
            (10.0, 0.05, 0.101, true),
            (10.0, 0.05, 0.099, false),
            (100.0, 1.0, 0.101, true),
            (100.0, 1.0, 0.099, false),
            (100.0, -1.0, 0.099, false),
            (1e-9, 2.0, 1.01e9, true),
            (1e-9, 2.0, 0.99e9, false),
        ] {
            let case = format!("{off} of {largest} after {lasted}");
            assert_eq!(is_doubted(lasted, largest, Some(off)), doubted, "{case}");
        }
        assert!(!is_doubted(100.0, 1.0, None));
    }

    #[test]
    fn a_volume_is_off_by_a_factor_of_e_and_a_tenth_of_the_largest_exponent() {
        for (lasted, largest, off, doubted) in [
            (10.0, 0.05, 1.1, true),
            (10.0, 0.05, 0.9, false),
            (100.0, 1.0, 10.1, true),
            (100.0, 1.0, 9.9, false),
        ] {
            for flowed in [-1000.0, 0.0, 5.0] {
                for off in [off, -off] {
                    let volumes = Some([flowed + off, flowed]);
                    let found = doubt(lasted, largest, (None, volumes));
                    assert_eq!(found, doubted, "{off} of {largest} after {lasted}, {flowed}");
                }
            }
        }
    }
}
