//! The state of one gauge: its reference value, the rounding error of its values, and their distances from the reference.
//!
//! In: values, and the size of the moving terms. Out: a [`Gauge`](crate::experiment::Gauge). Never here: where the values come from.

mod comparison;
mod drift_measure;
mod gauge;

use super::drift_record::{DriftRecord, Early};
use super::mean::Mean;
use super::rest_watch::is_slow;
use super::seen_distances::{SeenDistances, by_rounding_of_state};
use crate::analysis::{RESOLVED, RoundedInput};
use crate::experiment::Reference;
use crate::experiment::energy_law::{Cause, acting};
use crate::expr::{Expr, Pool, Symbol};
use crate::mechanics::{Valuation, constant_at, vanishing_at};
use crate::system::{BatchTerms, TermSums, TermWatch};

/// The name of the gauge that is constant by the law of the energy's change.
pub(super) const ENERGY_BALANCE: &str = "energy balance";

/// The energy among the quantities of a [`TermWatch`].
const ENERGY: usize = TermWatch::ENERGY;

/// Constant terms are large from this multiple of the others on: the value has three digits fewer than their sum.
const LARGE: f64 = 1e3;

#[derive(Clone, Debug)]
pub(super) struct InvariantMonitor {
    pub(super) invariant: MonitoredInvariant,
    /// Why it is constant at the values of the parameters, if only there.
    constant_here: Option<String>,
    /// What changes it at the values of the parameters, if not all that does in general.
    acting_here: Option<String>,
    /// Whether its reference jumps with an impulse.
    jumps: bool,
    reference: ReferenceValue,
    rounding: RoundingError,
    seen: SeenDistances,
    drift: DriftRecord,
    /// Whether its terms ever differed from those at rest, at the end of a step or within it.
    was_moving: bool,
}

/// What distances are measured from.
#[derive(Clone, Debug)]
struct ReferenceValue {
    /// The value when the reference was taken.
    initial: f64,
    /// The initial value plus the jumps of impulses.
    value: f64,
    /// The same as the sum of its terms in `f64`.
    rough: f64,
    /// Whether it has constant terms so large that its value has fewer digits than the sum of the others.
    offset: bool,
    /// The terms at rest when the reference was taken.
    at_rest: Vec<f64>,
}

/// The error of the values since the reference was taken.
#[derive(Clone, Debug, Default)]
struct RoundingError {
    /// The greatest so far, in units of ε.
    greatest: f64,
    /// The greatest distance so far that rounding explains.
    explained: f64,
    /// Whether terms that are not 0 were seen where their error is less than a normal number.
    underflows: bool,
}

/// The end of a step, as a monitor sees it.
#[derive(Clone, Copy, Debug)]
pub(in crate::experiment) struct MonitoredStep {
    pub(in crate::experiment) time: f64,
    /// The rounding error that a value of size 1 may have gathered.
    pub(in crate::experiment) floor: f64,
    /// Whether there are rows within the step.
    pub(in crate::experiment) dense: bool,
}

/// The law by which a quantity changes.
#[derive(Clone, Debug)]
pub(super) struct ChangeLaw {
    /// As it is shown.
    pub(super) shown: String,
    /// What has to vanish at the values of the parameters for the quantity to be constant at these.
    pub(super) rate: ChangeRate,
}

#[derive(Clone, Debug)]
pub(super) enum ChangeRate {
    /// The rate of the energy, with the steps of the law, and its causes.
    Energy(Vec<Cause>),
    /// These expressions, all of them.
    All(Vec<Expr>),
}

#[derive(Clone, Debug)]
pub(super) struct MonitoredInvariant {
    pub(super) name: String,
    pub(super) shown: String,
    pub(super) reason: String,
    /// Whether it follows from the law of motion that the quantity is constant.
    pub(super) proved: bool,
    /// The reason why it is not constant, if it is not.
    pub(super) broken: Option<ChangeLaw>,
    pub(super) channel: usize,
    /// The index of its quantity in a [`TermWatch`]; the balance subtracts the work.
    pub(super) quantity: Option<usize>,
    /// The expression that its rounding error is measured with.
    pub(super) expression: Expr,
}

impl InvariantMonitor {
    pub(super) fn new(invariant: MonitoredInvariant) -> InvariantMonitor {
        let unknown = f64::NAN;
        InvariantMonitor {
            jumps: invariant.name != ENERGY_BALANCE,
            invariant,
            constant_here: None,
            acting_here: None,
            reference: ReferenceValue {
                initial: unknown,
                value: unknown,
                rough: unknown,
                offset: false,
                at_rest: Vec::new(),
            },
            rounding: RoundingError::default(),
            seen: SeenDistances::default(),
            drift: DriftRecord::beginning(Mean::default()),
            was_moving: false,
        }
    }

    /// Takes into account which values the parameters have: a quantity that changes in general may be constant at these.
    /// Of the energy that is known elsewhere.
    pub(super) fn take_parameters(
        &mut self,
        pool: &Pool,
        values: &Valuation,
        energy: impl FnOnce() -> Option<Vec<Symbol>>,
    ) {
        let Some(law) = &self.invariant.broken else { return };
        let special = match &law.rate {
            ChangeRate::Energy(_) => energy(),
            ChangeRate::All(rates) => vanishing_at(pool, rates, values),
        };
        self.acting_here = match &law.rate {
            ChangeRate::Energy(causes) if special.is_none() => acting(pool, causes, values),
            _ => None,
        };
        self.constant_here = special.map(|parameters| constant_at(pool, &parameters, values));
    }

    /// The law by which it changes at the values of the parameters, if it does.
    fn change_law(&self) -> Option<&str> {
        let law = self.invariant.broken.as_ref().filter(|_| self.constant_here.is_none());
        law.map(|law| law.shown.as_str())
    }

    /// Takes the current value as the reference.
    pub(super) fn refer(&mut self, time: f64, values: &[f64], terms: &TermWatch) {
        let initial = values[self.invariant.channel];
        let quantity = self.invariant.quantity;
        let varying = self.summed(terms).map_or(0.0, |sums| sums.size);
        let offset = quantity.is_some_and(|quantity| terms.has_offset(quantity))
            && varying * LARGE < initial.abs();
        let rough =
            self.summed(terms).map_or(f64::NAN, |sums| self.rough(sums.value, terms.work()));
        let at_rest = quantity.map_or_else(Vec::new, |quantity| terms.at_rest(quantity));
        self.reference = ReferenceValue { initial, value: initial, rough, offset, at_rest };
        self.rounding = RoundingError::default();
        self.seen = SeenDistances::default();
        self.was_moving = false;
        self.drift = DriftRecord::beginning(Mean::beginning(time));
    }

    /// Continues from the saved reference of the same quantity.
    pub(super) fn restore(&mut self, known: &Reference, time: f64) {
        self.reference.rough += known.from - self.reference.value;
        self.forget_digits(known.from);
        self.reference.value = known.from;
        self.reference.initial = known.initial.unwrap_or(known.from);
        let scale = known.scale.unwrap_or_else(|| known.from.abs());
        self.drift.moving = Mean::of(scale, time - known.since, time);
        self.drift.most_moving = scale;
        self.drift.farthest = known.farthest.unwrap_or(known.max_drift * scale);
        self.drift.worst = known.max_drift;
        self.drift.worst_scale = scale;
        self.drift.left = known.left;
        self.drift.early = Early::over();
        if known.max_drift > RESOLVED {
            self.seen.resume(known.left.unwrap_or(known.since), self.drift.farthest);
        }
    }

    /// Shifts the reference by the jump of an impulse.
    pub(super) fn shift(&mut self, before: &[f64], after: &[f64]) {
        let jump = after[self.invariant.channel] - before[self.invariant.channel];
        if self.jumps && jump.is_finite() {
            self.reference.value += jump;
            self.reference.rough += jump;
            self.forget_digits(
                before[self.invariant.channel].abs().max(after[self.invariant.channel].abs()),
            );
        }
    }

    /// Takes into account that a reference was computed from a value of this size.
    fn forget_digits(&mut self, value: f64) {
        if self.reference.offset {
            self.widen(value.abs());
        }
    }

    /// Records the rounding error of its value, in units of ε, and whether it is that small by underflow.
    pub(super) fn measure(&mut self, error: f64, underflows: bool) {
        self.rounding.underflows |= underflows;
        if !self.reference.offset {
            self.widen(error);
        }
    }

    fn widen(&mut self, error: f64) {
        if error.is_finite() {
            self.rounding.greatest = self.rounding.greatest.max(error);
        }
    }

    /// The sums over its terms, if it has terms.
    fn summed(&self, terms: &TermWatch) -> Option<TermSums> {
        let quantity = self.invariant.quantity.filter(|&quantity| terms.has(quantity))?;
        Some(terms.sums(quantity, &self.reference.at_rest))
    }

    fn rough(&self, sum: f64, work: f64) -> f64 {
        if self.jumps { sum } else { sum - work }
    }

    /// Takes it for rounding where a distance, farther than any before, is no more than that of the state, as where two bodies that are
    /// far from the origin nearly collide: such a distance is not recorded, so that what is lost there for good shows later. `by_state`
    /// says by how much rounding of the state changes the quantity.
    fn measure_far(
        &mut self,
        (time, distance): (f64, f64),
        TermSums { size, moving, .. }: TermSums,
        floor: f64,
        by_state: impl FnOnce(usize) -> Option<(f64, RoundedInput)>,
    ) -> bool {
        let distance = distance.abs();
        let is_far = distance > 2.0 * self.drift.farthest
            && distance > floor * self.rounding.greatest
            && self.change_law().is_none()
            && moving > 0.0;
        let change = self.invariant.quantity.filter(|_| is_far).and_then(by_state);
        self.seen.note_if_rounding((time, distance), size, change)
    }

    /// Records an accurate value and returns its distance; `floor` is the rounding error of a value of size 1.
    pub(super) fn observe(
        &mut self,
        time: f64,
        values: &[f64],
        terms: &TermWatch,
        floor: f64,
    ) -> f64 {
        let mut distance = values[self.invariant.channel] - self.reference.value;
        let (mut moving, mut size, mut is_rounding) = (0.0, 0.0_f64, false);
        if let Some(sums) = self.summed(terms) {
            // the terms may have grown
            self.widen(sums.size);
            if !self.reference.offset {
                let by_state = |quantity| by_rounding_of_state(terms, quantity);
                is_rounding = self.measure_far((time, distance), sums, floor, by_state);
            }
            moving = sums.moving;
            size = sums.size;
            self.was_moving |= !is_slow(&sums);
            self.drift.see_moving(moving);
            if self.reference.offset {
                distance = self.rough(sums.value, terms.work()) - self.reference.rough;
            }
            // where an impulse ends every step the ends of steps are not seen
            if time > self.drift.moving.time() {
                self.drift.note_moving(time, distance, moving);
            }
        }
        if !self.reference.offset {
            let value = values[self.invariant.channel].abs();
            self.seen.note(time, distance.abs(), size.max(value).max(self.reference.value.abs()));
        }
        if !is_rounding {
            self.note(time, distance, moving, floor);
        }
        distance
    }

    /// Records an accurate value for the history as well.
    pub(super) fn sample(&mut self, time: f64, values: &[f64], terms: &TermWatch, floor: f64) {
        let distance = self.observe(time, values, terms, floor);
        self.drift.distances.push(time, distance);
    }

    /// Records the value at the end of a step or within it.
    pub(super) fn step(&mut self, end: MonitoredStep, terms: &TermWatch) {
        if let Some(sums) = self.summed(terms) {
            let by_state = |quantity| by_rounding_of_state(terms, quantity);
            self.step_with(end, (sums, terms.work()), by_state);
        }
    }

    /// Records the values at the ends of several steps. `by_state` says by how much rounding of one of the states changes a
    /// quantity.
    pub(super) fn steps(
        &mut self,
        terms: &BatchTerms,
        ends: &[MonitoredStep],
        by_state: &mut dyn FnMut(usize, usize) -> Option<(f64, RoundedInput)>,
    ) {
        let Some(quantity) = self.invariant.quantity.filter(|&quantity| terms.has(quantity)) else {
            return;
        };
        let sums = terms.sums(quantity, &self.reference.at_rest);
        for (lane, (end, sums)) in ends.iter().zip(sums).enumerate() {
            self.step_with(*end, (sums, terms.work(lane)), |quantity| by_state(lane, quantity));
        }
    }

    /// Its quantity among those that have terms, and what these were at rest when the reference was taken.
    pub(super) fn terms_at_rest(&self) -> Option<(usize, &[f64])> {
        self.invariant.quantity.map(|quantity| (quantity, &*self.reference.at_rest))
    }

    /// Whether it is the energy of a motion that was slow at the end of every step.
    pub(super) fn was_slow(&self) -> bool {
        self.invariant.quantity == Some(ENERGY) && !self.was_moving
    }

    /// Records the sums over the terms, and the work. A distance that rounding explains is ignored.
    pub(super) fn step_with(
        &mut self,
        MonitoredStep { time, floor, dense }: MonitoredStep,
        (sums, work): (TermSums, f64),
        by_state: impl FnOnce(usize) -> Option<(f64, RoundedInput)>,
    ) {
        let TermSums { value, size, moving, .. } = sums;
        self.was_moving |= !is_slow(&sums);
        let distance = self.rough(value, work) - self.reference.rough;
        self.widen(size);
        let is_rounding = self.measure_far((time, distance), sums, floor, by_state);
        if self.drift.begin_if_at_rest(time, distance, moving) {
            self.seen.begin();
        }
        self.drift.see_moving(moving);
        self.drift.note_moving(time, distance, moving);
        if !is_rounding && distance.abs() > floor * self.rounding.greatest {
            self.note(time, distance, moving, floor);
            // if there are rows within a step, these make the history
            if !dense {
                self.drift.distances.push(time, distance);
            }
        }
    }

    /// Records by how much rounding of the state changes the value, in units of ε.
    pub(super) fn measure_state(&mut self, change: Option<(f64, RoundedInput)>) {
        self.seen.note_rounding(change);
    }
}
