//! The state of one gauge: its reference value, its drift, and the verdict.
//!
//! In: values, and the size of the moving terms. Out: a [`Gauge`]. Never here: where the values come from.

use std::sync::Arc;

use super::drift_record::{Distance, DriftRecord, Early};
use super::mean::Mean;
use crate::analysis::{self, Errors, LEFT, LOST, Unseen, Verdict};
use crate::experiment::{Gauge, Reference};
use crate::expr::Expr;
use crate::system::{BatchTerms, TermSums, TermWatch};

/// The name of the gauge that is constant by the law of the energy's change.
pub(super) const ENERGY_BALANCE: &str = "energy balance";

/// What is said beside the reason of a gauge whose drift cannot be known.
const UNDERFLOW: &str = "its terms underflow";
const UNRESOLVED: &str = "it cannot resolve the motion";

/// The energy among the quantities of a [`TermWatch`].
const ENERGY: usize = 0;

/// Constant terms are large from this multiple of the others on: the value has three digits fewer than their sum.
const LARGE: f64 = 1e3;

/// What moves by less than this multiple of the error that rounding explains, and all of it away from the reference, is
/// error and no motion: a quantity each of whose terms is constant.
const ERROR: f64 = 1e3;

#[derive(Clone, Debug)]
pub(super) struct InvariantMonitor {
    pub(super) invariant: MonitoredInvariant,
    /// Whether its reference jumps with an impulse.
    jumps: bool,
    reference: ReferenceValue,
    rounding: RoundingError,
    drift: DriftRecord,
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

#[derive(Clone, Debug)]
pub(super) struct MonitoredInvariant {
    pub(super) name: String,
    pub(super) shown: String,
    pub(super) reason: String,
    /// Whether it follows from the law of motion that the quantity is constant.
    pub(super) proved: bool,
    /// The reason why it is not constant, if it is not.
    pub(super) broken: Option<String>,
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
            reference: ReferenceValue {
                initial: unknown,
                value: unknown,
                rough: unknown,
                offset: false,
                at_rest: Vec::new(),
            },
            rounding: RoundingError::default(),
            drift: DriftRecord::beginning(Mean::default()),
        }
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
        self.drift.farthest = known.farthest.unwrap_or(known.max_drift * scale);
        self.drift.worst = known.max_drift;
        self.drift.worst_scale = scale;
        self.drift.left = known.left;
        self.drift.early = Early::over();
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

    /// Records an accurate value and returns its distance; `floor` is the rounding error of a value of size 1.
    pub(super) fn observe(
        &mut self,
        time: f64,
        values: &[f64],
        terms: &TermWatch,
        floor: f64,
    ) -> f64 {
        let mut distance = values[self.invariant.channel] - self.reference.value;
        let mut moving = 0.0;
        if let Some(sums) = self.summed(terms) {
            // the terms may have grown
            self.widen(sums.size);
            moving = sums.moving;
            // where an impulse ends every step the ends of steps are not seen
            if time > self.drift.moving.time() && self.drift.worst <= LOST {
                self.drift.moving.note(time, moving);
            }
            if self.reference.offset {
                distance = self.rough(sums.value, terms.work()) - self.reference.rough;
            }
        }
        self.note(time, distance, moving, floor);
        distance
    }

    /// Records an accurate value for the history as well.
    pub(super) fn sample(&mut self, time: f64, values: &[f64], terms: &TermWatch, floor: f64) {
        let distance = self.observe(time, values, terms, floor);
        self.drift.distances.push(time, distance);
    }

    /// Records the value at the end of a step or within it.
    pub(super) fn step(&mut self, time: f64, terms: &TermWatch, floor: f64, dense: bool) {
        if let Some(sums) = self.summed(terms) {
            self.step_with(time, (sums, terms.work()), floor, dense);
        }
    }

    /// Records the values at the ends of several steps.
    pub(super) fn steps(&mut self, terms: &BatchTerms, ends: &[MonitoredStep]) {
        let Some(quantity) = self.invariant.quantity.filter(|&quantity| terms.has(quantity)) else {
            return;
        };
        let sums = terms.sums(quantity, &self.reference.at_rest);
        for (lane, (end, sums)) in ends.iter().zip(sums).enumerate() {
            self.step_with(end.time, (sums, terms.work(lane)), end.floor, end.dense);
        }
    }

    /// Its quantity among those that have terms, and what these were at rest when the reference was taken.
    pub(super) fn terms_at_rest(&self) -> Option<(usize, &[f64])> {
        self.invariant.quantity.map(|quantity| (quantity, &*self.reference.at_rest))
    }

    /// Records the sums over the terms, and the work. A distance that rounding explains is ignored.
    pub(super) fn step_with(
        &mut self,
        time: f64,
        (TermSums { value, size, moving }, work): (TermSums, f64),
        floor: f64,
        dense: bool,
    ) {
        let distance = self.rough(value, work) - self.reference.rough;
        self.widen(size);
        self.drift.begin_if_at_rest(time, distance, moving);
        // the moving part of a lost motion is no measure of it
        if self.drift.worst <= LOST {
            self.drift.moving.note(time, moving);
        }
        if distance.abs() > floor * self.rounding.greatest {
            self.note(time, distance, moving, floor);
            // if there are rows within a step, these make the history
            if !dense {
                self.drift.distances.push(time, distance);
            }
        }
    }

    fn note(&mut self, time: f64, distance: f64, moving: f64, floor: f64) {
        let distance = distance.abs();
        self.drift.last = distance;
        if distance > self.drift.farthest {
            self.drift.farthest = distance;
        }
        let explained = floor * self.rounding.greatest;
        self.rounding.explained = self.rounding.explained.max(explained);
        let beyond = distance > explained;
        // a motion that has not begun says nothing of what will move
        if !beyond && moving == 0.0 && self.drift.moving.value() == 0.0 {
            return;
        }
        let deferred =
            self.drift.early.take(beyond.then_some(Distance { time, size: distance, moving }));
        if beyond && !deferred {
            let drift = self.drift_of(distance, moving);
            if drift > self.drift.worst {
                self.drift.worst = drift;
                self.drift.worst_scale = self.scale_of(moving.max(self.drift.moving.value()));
            }
            // rows lie before the end of the step, which was recorded first
            if drift > LEFT && self.drift.left.is_none_or(|left| time < left) {
                self.drift.left = Some(time);
            }
        }
        if self.drift.early.is_known() {
            (self.drift.worst, self.drift.left) = self.drifted();
            self.drift.worst_scale = self.scale();
            self.drift.early = Early::over();
        }
    }

    /// Why a drift would not be seen, if it would not: all its terms have always been below the numbers that have all their digits,
    /// and not because they are 0; or a motion whose energy is all but constant terms could be lost within their rounding error.
    fn unseen(&self) -> Option<Unseen> {
        let moving = self.drift.moving.value();
        if self.rounding.underflows && self.rounding.greatest < f64::MIN_POSITIVE {
            return Some(Unseen::Underflow);
        }
        let is_lost = analysis::rounding_floor(0) * self.rounding.greatest > LOST * moving;
        let within_rounding = self.drift.farthest <= self.rounding.explained;
        // the terms of others may all be constant, so that what moves of them is rounding
        (self.invariant.quantity == Some(ENERGY) && moving > 0.0 && is_lost && within_rounding)
            .then(|| Unseen::Unresolved(self.rounding.greatest / moving))
    }

    fn drift_of(&self, distance: f64, moving: f64) -> f64 {
        distance / self.scale_of(moving.max(self.drift.moving.value()))
    }

    /// The greatest drift, and when it first exceeded the limit.
    fn drifted(&self) -> (f64, Option<f64>) {
        let (mut worst, mut left) = (self.drift.worst, self.drift.left);
        for &Distance { time, size, moving } in &self.drift.early.distances {
            let drift = self.drift_of(size, moving);
            worst = worst.max(drift);
            if drift > LEFT && left.is_none_or(|left| time < left) {
                left = Some(time);
            }
        }
        (worst, left)
    }

    /// The scale of drift: the mean moving part, or the size of the terms if nothing moves.
    fn scale(&self) -> f64 {
        self.scale_of(self.drift.moving.value())
    }

    /// The scale of drift where this much moves.
    fn scale_of(&self, moving: f64) -> f64 {
        let is_error = is_error(moving, self.drift.farthest, self.rounding.explained);
        if is_error { self.rounding.greatest } else { moving }
    }

    pub(super) fn show(&self, values: &[f64], since: f64, floor: f64, errors: Errors) -> Gauge {
        let value = values[self.invariant.channel];
        let (scale, rounding) = (self.scale(), floor * self.rounding.greatest);
        // a rounding error is small compared with the terms
        let drift = |distance: f64| match distance {
            0.0 => 0.0,
            _ if distance <= rounding => distance / scale.max(self.rounding.greatest),
            _ => distance / scale,
        };
        let distance = if self.reference.offset {
            self.drift.last
        } else {
            (value - self.reference.value).abs()
        };
        let beyond = self.drift.farthest > rounding;
        let is_below_digits = self.drift.farthest < f64::EPSILON * self.rounding.greatest;
        let (worst, since_when) = self.drifted();
        let max_drift = if beyond { worst } else { drift(self.drift.farthest.max(distance)) };
        let drift_now = drift(distance).min(max_drift);
        let left = beyond && max_drift > LEFT;
        // what is only supposed to be conserved may change with the motion
        let errors = if self.invariant.proved { errors } else { Errors::Accumulated };
        let unseen = self.unseen();
        let is_unknown = unseen.is_some();
        let verdict = match (&self.invariant.broken, unseen) {
            (Some(law), _) => Verdict::Broken(law.clone()),
            (None, Some(unseen)) => Verdict::Unknown(unseen),
            (None, None) if beyond && max_drift > LOST => Verdict::Lost,
            (None, None) => {
                match Verdict::of(&self.drift.distances, self.drift.farthest, rounding, errors) {
                    Verdict::Secular(slope) => Verdict::Secular(slope / scale),
                    Verdict::Exact(_) if is_below_digits => Verdict::Exact(analysis::Growth::Level),
                    other => other,
                }
            }
        };
        let is_broken = self.invariant.broken.is_some();
        let history = self.drift.distances.stretches().iter().map(|stretch| {
            // what changes by the physics is seen rising and falling
            if is_broken {
                drift(stretch.mean.abs()).copysign(stretch.mean)
            } else {
                drift(stretch.peak())
            }
        });
        Gauge {
            name: self.invariant.name.clone(),
            shown: self.invariant.shown.clone(),
            reason: match unseen {
                Some(Unseen::Underflow) => format!("{}; {UNDERFLOW}", self.invariant.reason),
                Some(Unseen::Unresolved(_)) => format!("{}; {UNRESOLVED}", self.invariant.reason),
                None => self.invariant.reason.clone(),
            },
            proved: self.invariant.proved && self.invariant.broken.is_none(),
            value,
            initial: self.reference.initial,
            scale,
            farthest: self.drift.farthest,
            reference: self.reference.value,
            reference_time: since,
            drift: if is_unknown { f64::NAN } else { drift_now },
            max_drift: if is_unknown { f64::NAN } else { max_drift },
            left: (left && !is_unknown && self.invariant.broken.is_none())
                .then(|| since_when.unwrap_or(since)),
            history: if is_unknown {
                Arc::default()
            } else {
                history.map(|drift| drift as f32).collect()
            },
            verdict,
        }
    }
}

/// Whether what moves is error and no motion, where a value has been so far from its reference, and rounding explains so much.
fn is_error(moving: f64, farthest: f64, explained: f64) -> bool {
    // terms that balance each other move by more than their sum
    moving <= 2.0 * farthest && moving <= ERROR * explained
}

#[cfg(test)]
mod tests {
    use super::is_error;

    #[test]
    fn what_moves_is_error_up_to_a_thousand_times_rounding_and_twice_the_distance() {
        assert!(is_error(1.99, 1.0, 0.002) && !is_error(2.01, 1.0, 0.01));
        assert!(is_error(0.99, 1.0, 0.001) && !is_error(1.01, 1.0, 0.001));
    }
}
