//! When a motion is sampled after a step, and what is evaluated there.
//!
//! In: the terms of a system. Out: times within steps, registers for states and channels. Never here: gauges.

use crate::system::{State, System, TermWatch};

/// The fractional part of the golden ratio.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Samples the motion after every step.
pub(super) struct StepSampler {
    pub(super) terms: TermWatch,
    /// When the channels are to be sampled next.
    pub(super) next: f64,
    /// Whether the end of the last step is still to be sampled.
    pub(super) pending: bool,
    /// A number in (0, 1) that never repeats, so that the sampling times do not resonate with any period.
    golden: f64,
    /// An intermediate state and its channels.
    pub(super) state: State,
    pub(super) values: Vec<f64>,
}

impl StepSampler {
    pub(super) fn of(system: &System, parameters: &[f64]) -> StepSampler {
        StepSampler {
            terms: system.term_watch(parameters),
            next: f64::NEG_INFINITY,
            pending: false,
            golden: 0.5,
            state: State::new(0.0, system.form(), Vec::new()),
            values: vec![f64::NAN; system.channels().len()],
        }
    }

    /// The next number of Weyl's sequence: the multiples of the golden ratio are spread as evenly as possible.
    pub(super) fn next_weyl(&mut self) -> f64 {
        self.golden = (self.golden + GOLDEN).fract();
        self.golden
    }
}
