//! Poles of a law, as a thin barrier, that equal steps may pass without having been near them, or end on.
//!
//! In: the ends of steps. Out: whether a step has passed a pole, or ends on one. Never here: what is said of it.
//!
//! What the law divides by changes its sign at a pole. Whether there is one, or what is divided vanishes with it, the rates show
//! ever nearer to the zero on the straight line between the ends of the step: at a pole they change a velocity by half of itself
//! in the time from it.

use crate::num::{DoubleDouble, math};
use crate::system::{ExactRates, State, SteepArguments, System};

/// The part of a velocity by which the rates change it near a pole.
const CHANGED: f64 = 0.5;

/// What is divided by has lost its digits at the end of a step where it is this part of what it was at the beginning, and the rates
/// there are those of a pole where they change a velocity by so many times itself in such a step.
const LANDED: (f64, f64) = (1e-13, 1e3);

/// A pole at a step.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum PoleOfStep {
    /// The step has passed it.
    Passed,
    /// The step ends on it, to all digits.
    Reached,
}

/// The number of bisections, to the last digit of a part of a step, and of distances from the zero, each half of the one before.
const BISECTIONS: u32 = 54;
const DISTANCES: i32 = 48;

/// The divisors at the end of the last of equal steps.
#[derive(Clone, Debug)]
pub(super) struct PassedPoles {
    system: System,
    parameters: Vec<f64>,
    divisors: SteepArguments,
    rates: ExactRates,
    before: State,
    /// The divisors there, if they are known.
    known: Option<Vec<f64>>,
}

impl PassedPoles {
    /// Those of a system; `None` if nothing that its law divides by can change its sign.
    pub(super) fn of(system: &System, parameters: &[f64], blank: &State) -> Option<PassedPoles> {
        let divisors = system.signed_divisors(parameters)?;
        let mut rates = system.exact_rates();
        rates.set_parameters(&system.inputs(parameters));
        let (system, parameters) = (system.clone(), parameters.to_vec());
        Some(PassedPoles {
            system,
            parameters,
            divisors,
            rates,
            before: blank.clone(),
            known: None,
        })
    }

    /// Records the end of a step. Returns the pole that it has passed or reached.
    pub(super) fn find(&mut self, state: &State) -> Option<PoleOfStep> {
        let mut now = vec![0.0; self.divisors.count()];
        let is_known = self.divisors.observe(state, &mut now).is_ok();
        let before = self.known.take().filter(|_| is_known);
        let found = before.and_then(|before| {
            let is_lost = |i: usize| now[i].abs() < LANDED.0 * before[i].abs();
            if (0..now.len()).any(is_lost) && self.runs_away(state) {
                return Some(PoleOfStep::Reached);
            }
            let has_changed = |i: &usize| before[*i] * now[*i] < 0.0;
            let crossed: Vec<usize> = (0..now.len()).filter(has_changed).collect();
            let passes = crossed.into_iter().any(|i| self.is_pole(i, before[i], state));
            passes.then_some(PoleOfStep::Passed)
        });
        self.before.copy_from(state);
        self.known = is_known.then_some(now);
        found
    }

    /// Whether the rates at the end of a step change a velocity by many times itself in another one.
    fn runs_away(&mut self, state: &State) -> bool {
        let native = |state| self.system.convert(state, self.system.form(), &self.parameters);
        let [Ok(first), Ok(last)] = [native(&self.before), native(state)] else { return false };
        let numbers: Vec<DoubleDouble> = (0..last.values.len()).map(|i| last.exact(i)).collect();
        if self.rates.evaluate(last.exact_time(), &numbers).is_err() {
            return false;
        }
        let step = (last.exact_time() - first.exact_time()).high;
        let numbers = self.system.degrees()..self.rates.moving();
        // the step itself may have ended with what the force does there
        let fastest = numbers.clone().map(|i| first.values[i].abs()).fold(0.0, f64::max);
        let largest = numbers.map(|i| (self.rates.rate(i).high * step).abs()).fold(0.0, f64::max);
        fastest > 0.0 && largest > LANDED.1 * fastest
    }

    /// Whether the law has a pole where a divisor with this value at the beginning of a step to a state is zero.
    fn is_pole(&mut self, i: usize, begin: f64, end: &State) -> bool {
        let native = |state| self.system.convert(state, self.system.form(), &self.parameters);
        let [Ok(first), Ok(last)] = [native(&self.before), native(end)] else { return false };
        let mut values = vec![0.0; self.divisors.count()];
        let (mut near, mut far) = (0.0, 1.0);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (near + far);
            if self.divisors.observe(&between(&first, &last, middle), &mut values).is_err() {
                return false;
            }
            *(if (values[i] > 0.0) == (begin > 0.0) { &mut near } else { &mut far }) = middle;
        }
        let step = (last.exact_time() - first.exact_time()).high;
        let n = self.system.degrees();
        // at a pole the change grows towards the zero, where that by an ordinary force shrinks
        let mut farther = vec![f64::INFINITY; self.rates.moving()];
        (1..=DISTANCES).any(|k| {
            let beyond = (1.0 - far) * math::powi(0.5, k);
            let there = between(&first, &last, far + beyond);
            let numbers: Vec<DoubleDouble> =
                (0..there.values.len()).map(|i| there.exact(i)).collect();
            if self.rates.evaluate(there.exact_time(), &numbers).is_err() {
                return false;
            }
            let mut is_pole = false;
            for (i, farther) in farther.iter_mut().enumerate().skip(n) {
                let size = first.values[i].abs().max(last.values[i].abs());
                let change = (self.rates.rate(i).high * beyond * step).abs();
                let grows = change.is_finite() && change > *farther;
                is_pole |= grows && size > 0.0 && change > CHANGED * size;
                *farther = change;
            }
            is_pole
        })
    }
}

/// The state at a part of the straight line between two.
fn between(first: &State, last: &State, part: f64) -> State {
    let mut state = last.clone();
    let at = |a: DoubleDouble, b: DoubleDouble| a + (b - a) * part;
    for i in 0..state.values.len() {
        state.set(i, at(first.exact(i), last.exact(i)));
    }
    state.set_time(at(first.exact_time(), last.exact_time()));
    state
}
