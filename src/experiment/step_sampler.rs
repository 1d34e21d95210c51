//! When a motion is sampled after a step, and what is evaluated there.
//!
//! In: the terms of a system. Out: times within steps, registers for states and channels. Never here: gauges.

use super::gathered_states::{GatheredStates, ObservedAt};
use super::gauges::Gauges;
use crate::integrate::{StepBlock, spacing};
use crate::num::{BATCH, GOLDEN};
use crate::system::{BatchTerms, Form, Observer, State, System, TermWatch};

/// The digits of the clock in a step at whose end a law of the time is resolved to the same part of what it changes in the step.
const RESOLVED: f64 = 1e8;

/// A step that is at least this part of the time between two samples is observed in any case: there would be few other times.
const PART_OF_SAMPLES: f64 = 1e-3;

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
    /// The states whose terms wait to be evaluated together.
    gathered: GatheredStates,
    form: Option<Form>,
    parameters: Vec<f64>,
    depends_on_time: bool,
    /// The channels at the last state at which they were sampled.
    pub(super) values: Vec<f64>,
}

impl StepSampler {
    pub(super) fn of(system: &System, parameters: &[f64]) -> StepSampler {
        StepSampler {
            block: StepBlock::default(),
            batch_terms: None,
            gathered: GatheredStates::of(system.form()),
            form: None,
            parameters: parameters.to_vec(),
            terms: system.term_watch(parameters),
            depends_on_time: system.exact_rates().depends_on_time(),
            next: f64::NEG_INFINITY,
            pending: false,
            golden: 0.5,
            values: vec![f64::NAN; system.channels().len()],
        }
    }

    /// Whether what a law of the time changes within a step is resolved at its end, where the time is rounded to the digits of the
    /// clock; `spacing` is the time between two samples. Steps that are long beside that one are always observed.
    pub(super) fn resolves(&self, [begin, end]: [f64; 2], spacing_of_samples: f64) -> bool {
        !self.depends_on_time || is_resolved((end - begin).abs(), spacing_of_samples, spacing(end))
    }

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
        self.gathered = GatheredStates::of(form);
        if let Some(terms) = &mut self.batch_terms {
            (0..BATCH).for_each(|lane| terms.set_parameters(lane, &self.parameters));
        }
    }

    /// The gauges record the terms at a state: at once, or together with those of others until
    /// [all are recorded](StepSampler::record_gathered). A state that cannot be observed is skipped.
    pub(super) fn observe(&mut self, state: &State, at: ObservedAt, gauges: &mut Gauges) {
        if let Some(batch) = &mut self.batch_terms {
            self.gathered.add(state, at, (batch, &mut self.terms), gauges);
        } else if self.terms.observe(state) {
            gauges.step(at.time, at.steps, &self.terms, at.dense);
        }
    }

    /// The gauges sample the channels at a state. Returns whether they could be evaluated.
    pub(super) fn observe_channels(
        &mut self,
        state: &State,
        at: ObservedAt,
        observer: &mut Observer,
        gauges: &mut Gauges,
    ) -> bool {
        self.record_gathered(gauges);
        let known = self.terms.observe(state) && observer.observe(state, &mut self.values).is_ok();
        if known {
            gauges.observe_on_the_way(at.time, at.steps, &self.values, &self.terms);
        }
        known
    }

    /// The gauges record the states that wait.
    pub(super) fn record_gathered(&mut self, gauges: &mut Gauges) {
        if let Some(batch) = &mut self.batch_terms {
            self.gathered.record((batch, &mut self.terms), gauges);
        }
    }

    /// The next number of Weyl's sequence: the multiples of the golden ratio are spread as evenly as possible.
    pub(super) fn next_weyl(&mut self) -> f64 {
        self.golden = (self.golden + GOLDEN).fract();
        self.golden
    }
}

/// Whether the end of a step of a law that depends on the time is observed, by the time between samples and the digits of the clock.
fn is_resolved(step: f64, spacing_of_samples: f64, digits: f64) -> bool {
    step >= PART_OF_SAMPLES * spacing_of_samples || step >= RESOLVED * digits
}

#[cfg(test)]
mod tests {
    use super::is_resolved;

    #[test]
    fn a_step_is_resolved_from_a_hundred_million_digits_of_the_clock_or_a_thousandth_of_a_sample() {
        for unit in [1e-9, 1.0, 1e9] {
            for (step, samples, digits, expected) in [
                (1.1, 1e6, 1e-8, true),
                (0.9, 1e6, 1e-8, false),
                (1.1, 1e3, 1.0, true),
                (0.9, 1e3, 1.0, false),
            ] {
                let found = is_resolved(step * unit, samples * unit, digits * unit);
                assert_eq!(found, expected, "{step} of {samples} and {digits} in {unit}");
            }
        }
    }
}
