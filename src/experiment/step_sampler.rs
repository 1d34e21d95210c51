//! When a motion is sampled after a step, and what is evaluated there.
//!
//! In: the terms of a system. Out: times within steps, registers for states and channels. Never here: gauges.

use crate::integrate::StepBlock;
use crate::num::BATCH;
use crate::system::{BatchTerms, Form, State, System, TermWatch};

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
    /// Steps between which nobody looks, and their terms where these can be evaluated together.
    pub(super) block: StepBlock,
    pub(super) batch_terms: Option<BatchTerms>,
    /// An intermediate state and its channels.
    pub(super) state: State,
    pub(super) values: Vec<f64>,
}

impl StepSampler {
    /// Samples the motion of a system by a method whose states have this form.
    pub(super) fn of(system: &System, form: Form, parameters: &[f64]) -> StepSampler {
        let mut sampler = StepSampler {
            block: StepBlock::default(),
            batch_terms: system.batch_terms(form),
            terms: system.term_watch(parameters),
            next: f64::NEG_INFINITY,
            pending: false,
            golden: 0.5,
            state: State::new(0.0, system.form(), Vec::new()),
            values: vec![f64::NAN; system.channels().len()],
        };
        sampler.set_parameters(parameters);
        sampler
    }

    /// Sets the parameters.
    pub(super) fn set_parameters(&mut self, parameters: &[f64]) {
        self.terms.set_parameters(parameters);
        if let Some(terms) = &mut self.batch_terms {
            (0..BATCH).for_each(|lane| terms.set_parameters(lane, parameters));
        }
    }

    /// The next number of Weyl's sequence: the multiples of the golden ratio are spread as evenly as possible.
    pub(super) fn next_weyl(&mut self) -> f64 {
        self.golden = (self.golden + GOLDEN).fract();
        self.golden
    }
}
