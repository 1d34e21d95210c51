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
    /// Steps between which nothing is observed.
    pub(super) block: StepBlock,
    /// Their terms, where these can be evaluated together, for states of this form.
    pub(super) batch_terms: Option<BatchTerms>,
    form: Option<Form>,
    parameters: Vec<f64>,
    /// An intermediate state and its channels.
    pub(super) state: State,
    pub(super) values: Vec<f64>,
}

impl StepSampler {
    pub(super) fn of(system: &System, parameters: &[f64]) -> StepSampler {
        StepSampler {
            block: StepBlock::default(),
            batch_terms: None,
            form: None,
            parameters: parameters.to_vec(),
            terms: system.term_watch(parameters),
            next: f64::NEG_INFINITY,
            pending: false,
            golden: 0.5,
            state: State::new(0.0, system.form(), Vec::new()),
            values: vec![f64::NAN; system.channels().len()],
        }
    }

    /// Sets the parameters.
    pub(super) fn set_parameters(&mut self, parameters: &[f64]) {
        self.terms.set_parameters(parameters);
        self.parameters = parameters.to_vec();
        self.form = None;
    }

    /// Prepares for steps between which nothing is observed, of a method whose states have this form.
    pub(super) fn prepare(&mut self, system: &System, form: Form) {
        if self.form == Some(form) {
            return;
        }
        self.form = Some(form);
        self.batch_terms = system.batch_terms(form);
        if let Some(terms) = &mut self.batch_terms {
            (0..BATCH).for_each(|lane| terms.set_parameters(lane, &self.parameters));
        }
    }

    /// The next number of Weyl's sequence: the multiples of the golden ratio are spread as evenly as possible.
    pub(super) fn next_weyl(&mut self) -> f64 {
        self.golden = (self.golden + GOLDEN).fract();
        self.golden
    }
}
