//! States of a motion whose terms are evaluated together.
//!
//! In: the ends of steps and states within them, one by one. Out: what the gauges record of them, to the last bit as if each had
//! been observed by itself. Never here: which states are observed, the channels.

use super::gauges::{Gauges, by_rounding_of_state};
use crate::num::{Analytic, BATCH, Batch};
use crate::system::{BatchTerms, Form, State, TermWatch};

/// From this many states on, evaluating them together takes less time than one by one.
const FEWEST: usize = 3;

/// When a state was observed.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ObservedAt {
    /// −t if the motion runs backwards.
    pub(super) clock: f64,
    pub(super) time: f64,
    pub(super) steps: u64,
    /// Whether there are rows within the step that it ends.
    pub(super) dense: bool,
}

/// The states that wait, one in each lane.
pub(super) struct GatheredStates {
    observed: Vec<ObservedAt>,
    clocks: Batch,
    numbers: Vec<Batch>,
    state: State,
}

impl GatheredStates {
    /// None yet, of a form.
    pub(super) fn of(form: Form) -> GatheredStates {
        GatheredStates {
            observed: Vec::with_capacity(BATCH),
            clocks: Batch::ZERO,
            numbers: Vec::new(),
            state: State::new(0.0, form, Vec::new()),
        }
    }

    /// Adds a state; the gauges record all that wait when there are as many as lanes.
    pub(super) fn add(
        &mut self,
        state: &State,
        at: ObservedAt,
        terms: (&mut BatchTerms, &mut TermWatch),
        gauges: &mut Gauges,
    ) {
        let lane = self.observed.len();
        let count = state.values.len();
        if self.numbers.len() != count {
            self.numbers.resize(count, Batch::ZERO);
        }
        for i in 0..count {
            self.numbers[i].0[lane] = state.values[i];
        }
        self.clocks.0[lane] = at.clock;
        self.observed.push(at);
        if self.observed.len() == BATCH {
            self.record(terms, gauges);
        }
    }

    /// The gauges record the states that wait. A state that cannot be observed is skipped.
    pub(super) fn record(
        &mut self,
        (batch, single): (&mut BatchTerms, &mut TermWatch),
        gauges: &mut Gauges,
    ) {
        let GatheredStates { observed, clocks, numbers, state } = self;
        let mut observe = |lane: usize, terms: &mut TermWatch| {
            state.set_time(observed[lane].clock.into());
            state.set_values(numbers.iter().map(|number| number.0[lane]));
            terms.observe(state)
        };
        let several = observed.len() >= FEWEST;
        if several {
            batch.evaluate_numbers(*clocks, numbers);
        }
        if several && batch.are_regular(observed.len()) {
            let ends = observed.iter().map(|at| (at.time, at.steps, at.dense));
            gauges.steps(ends, batch, &mut |lane, quantity| {
                observe(lane, single).then(|| by_rounding_of_state(single, quantity))?
            });
        } else {
            for (lane, at) in observed.iter().enumerate() {
                if observe(lane, single) {
                    gauges.step(at.time, at.steps, single, at.dense);
                }
            }
        }
        self.observed.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::super::Prepared;
    use super::super::gauges::GaugeInputs;
    use super::*;
    use crate::analysis::Errors;
    use crate::diagnostic::Document;
    use crate::integrate::{Propagator, Settings, method_named};
    use crate::mechanics::Valuation;

    /// A driven system, whose gauges are an energy that changes and its balance, and one with a momentum.
    const SYSTEMS: [&str; 2] = [
        "[parameters]\nk = 1.3\n[coordinates]\nx = 0.4\n[lagrangian]\nL = \"x'^2/2 - k*x^4/4 + 0.3*x*cos(t)\"",
        "[coordinates]\nr = 1.0\nphi = { initial = 0.0, velocity = 0.7 }\n[lagrangian]\n\
         L = \"(r'^2 + r^2*phi'^2)/2 + 1/r\"",
    ];

    #[test]
    fn gauges_record_the_same_bits_of_states_that_waited() {
        for text in SYSTEMS {
            let document = Document::new("of a test", text);
            let Prepared { model, equations, system, .. } =
                Prepared::of(&document).expect("the file is right");
            let parameters = model.parameter_values();
            let state = system.initial(0.0, &parameters, &[]).expect("there is a first state");
            let method = method_named("taylor").expect("it is the default");
            let mut motion = Propagator::new(&system, method, Settings::default(), &parameters)
                .expect("the method suits the system");
            motion.begin(&state, &parameters).expect("the motion begins");
            let mut single = system.term_watch(&parameters);
            let mut batch = system.batch_terms(state.form).expect("no terms take a solution");
            (0..BATCH).for_each(|lane| batch.set_parameters(lane, &parameters));
            let mut values = vec![0.0; system.channels().len()];
            system.observer(&parameters).observe(&state, &mut values).expect("it has values");
            assert!(single.observe(&state));
            let mut alone = Gauges::new(&model, &equations, &system);
            alone.refer(&GaugeInputs {
                time: 0.0,
                steps: 0,
                errors: Errors::Accumulated,
                values: &values,
                residuals: &[],
                action: f64::NAN,
                terms: &single,
                system: &system,
                constants: &Valuation::of_parameters(&model, &parameters),
            });
            let mut together = alone.clone();
            let mut gathered = GatheredStates::of(state.form);
            for steps in 1..=43 {
                let (end, mut one) = (motion.computed().time + 10.0, 1);
                let _ = motion.reach(end, end, &mut one).expect("it moves on");
                let clock = motion.computed().time;
                let at = ObservedAt { clock, time: clock, steps, dense: steps % 5 == 0 };
                if single.observe(motion.computed()) {
                    alone.step(clock, steps, &single, at.dense);
                }
                gathered.add(motion.computed(), at, (&mut batch, &mut single), &mut together);
                // what waits is as many as lanes, or less where somebody reads the gauges
                if steps % 13 == 0 {
                    gathered.record((&mut batch, &mut single), &mut together);
                    assert_eq!(format!("{alone:?}"), format!("{together:?}"));
                }
            }
            assert_ne!(format!("{alone:?}"), format!("{together:?}"), "nothing waited");
            gathered.record((&mut batch, &mut single), &mut together);
            assert_eq!(format!("{alone:?}"), format!("{together:?}"));
        }
    }
}
