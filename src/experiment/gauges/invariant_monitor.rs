//! The state of one gauge: its reference value, its drift, and the verdict.
//!
//! In: values, and the size of the moving terms. Out: a [`Gauge`]. Never here: where the values come from.

use std::sync::Arc;

use super::mean::Mean;
use crate::analysis::{self, Errors, History, LEFT, LOST, Stretch, Unseen, Verdict};
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

/// The state of one gauge.
#[derive(Clone, Debug)]
pub(super) struct InvariantMonitor {
    pub(super) name: String,
    shown: String,
    reason: String,
    /// Whether it follows from the law of motion that the quantity is constant.
    proved: bool,
    /// The reason why it is not constant, if it is not.
    broken: Option<String>,
    pub(super) channel: usize,
    /// The index of its quantity in a [`TermWatch`]; the balance subtracts the work.
    quantity: Option<usize>,
    /// The expression that its rounding error is measured with.
    pub(super) expression: Expr,
    /// Whether its reference jumps with an impulse.
    jumps: bool,
    /// Its value when the reference was taken.
    initial: f64,
    /// The value that distances are measured from: the initial value plus the jumps of impulses.
    reference: f64,
    /// The reference as the sum of its terms in `f64`.
    rough_reference: f64,
    /// Whether it has constant terms so large that its value has fewer digits than the sum of the others.
    offset: bool,
    /// The last distance from the reference.
    last: f64,
    /// The terms at rest when the reference was taken.
    at_rest: Vec<f64>,
    /// The greatest error of its value since then, in units of ε.
    rounding: f64,
    /// The greatest distance so far that rounding explains.
    explained: f64,
    /// Whether terms that are not 0 were seen where their error is less than a normal number.
    underflows: bool,
    /// The mean size of its moving part.
    moving: Mean,
    /// The greatest distance from the reference since then.
    farthest: f64,
    /// The greatest drift: a distance over the mean moving part up to that time, or over the moving part at that time
    /// if it was greater.
    worst: f64,
    /// When its drift first exceeded the limit.
    left: Option<f64>,
    /// The first distances beyond rounding, as long as it is not known how much moves.
    early: Early,
    /// The signed distances.
    distances: History,
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

/// The quantity that a monitor watches.
pub(super) struct Subject {
    pub(super) name: String,
    pub(super) shown: String,
    pub(super) reason: String,
    pub(super) proved: bool,
    pub(super) broken: Option<String>,
    pub(super) channel: usize,
    pub(super) quantity: Option<usize>,
    pub(super) expression: Expr,
}

impl InvariantMonitor {
    pub(super) fn new(subject: Subject) -> InvariantMonitor {
        let Subject { name, shown, reason, proved, broken, channel, quantity, expression } =
            subject;
        InvariantMonitor {
            jumps: name != ENERGY_BALANCE,
            name,
            shown,
            reason,
            proved,
            broken,
            channel,
            quantity,
            expression,
            initial: f64::NAN,
            reference: f64::NAN,
            rough_reference: f64::NAN,
            offset: false,
            last: 0.0,
            at_rest: Vec::new(),
            rounding: 0.0,
            explained: 0.0,
            underflows: false,
            moving: Mean::default(),
            farthest: 0.0,
            worst: 0.0,
            left: None,
            early: Early::default(),
            distances: History::new(),
        }
    }

    /// Takes the current value as the reference.
    pub(super) fn refer(&mut self, time: f64, values: &[f64], terms: &TermWatch) {
        self.initial = values[self.channel];
        self.reference = self.initial;
        let offset = self.quantity.is_some_and(|quantity| terms.has_offset(quantity));
        let varying = self.summed(terms).map_or(0.0, |sums| sums.size);
        self.offset = offset && varying * LARGE < self.initial.abs();
        self.last = 0.0;
        self.rough_reference =
            self.summed(terms).map_or(f64::NAN, |sums| self.rough(sums.value, terms.work()));
        self.at_rest = self.quantity.map_or_else(Vec::new, |quantity| terms.at_rest(quantity));
        self.rounding = 0.0;
        self.explained = 0.0;
        self.underflows = false;
        self.moving = Mean::beginning(time);
        self.farthest = 0.0;
        self.worst = 0.0;
        self.left = None;
        self.early = Early::default();
        self.distances = History::new();
    }

    /// Continues from the saved reference of the same quantity.
    pub(super) fn restore(&mut self, known: &Reference, time: f64) {
        self.rough_reference += known.from - self.reference;
        self.forget_digits(known.from);
        self.reference = known.from;
        self.initial = known.initial.unwrap_or(known.from);
        let scale = known.scale.unwrap_or_else(|| known.from.abs());
        self.moving = Mean::of(scale, time - known.since, time);
        self.farthest = known.farthest.unwrap_or(known.max_drift * scale);
        self.worst = known.max_drift;
        self.left = known.left;
        self.early = Early::over();
    }

    /// Shifts the reference by the jump of an impulse.
    pub(super) fn shift(&mut self, before: &[f64], after: &[f64]) {
        let jump = after[self.channel] - before[self.channel];
        if self.jumps && jump.is_finite() {
            self.reference += jump;
            self.rough_reference += jump;
            self.forget_digits(before[self.channel].abs().max(after[self.channel].abs()));
        }
    }

    /// Takes into account that a reference was computed from a value of this size.
    fn forget_digits(&mut self, value: f64) {
        if self.offset {
            self.widen(value.abs());
        }
    }

    /// Records the rounding error of its value, in units of ε, and whether it is that small by underflow.
    pub(super) fn measure(&mut self, error: f64, underflows: bool) {
        self.underflows |= underflows;
        if !self.offset {
            self.widen(error);
        }
    }

    fn widen(&mut self, error: f64) {
        if error.is_finite() {
            self.rounding = self.rounding.max(error);
        }
    }

    /// The sums over its terms, if it has terms.
    fn summed(&self, terms: &TermWatch) -> Option<TermSums> {
        let quantity = self.quantity.filter(|&quantity| terms.has(quantity))?;
        Some(terms.sums(quantity, &self.at_rest))
    }

    /// Its value, given the sum of its terms.
    fn rough(&self, sum: f64, work: f64) -> f64 {
        if self.jumps { sum } else { sum - work }
    }

    /// Records an accurate value and returns its distance; `floor` is the rounding error of a value of size 1.
    pub(super) fn look(&mut self, time: f64, values: &[f64], terms: &TermWatch, floor: f64) -> f64 {
        let mut distance = values[self.channel] - self.reference;
        let mut moving = 0.0;
        if let Some(sums) = self.summed(terms) {
            // the terms may have grown
            self.widen(sums.size);
            moving = sums.moving;
            // where an impulse ends every step the ends of steps are not seen
            if time > self.moving.time() && self.worst <= LOST {
                self.moving.note(time, moving);
            }
            if self.offset {
                distance = self.rough(sums.value, terms.work()) - self.rough_reference;
            }
        }
        self.note(time, distance, moving, floor);
        distance
    }

    /// Records an accurate value for the history as well.
    pub(super) fn sample(&mut self, time: f64, values: &[f64], terms: &TermWatch, floor: f64) {
        let distance = self.look(time, values, terms, floor);
        self.distances.push(time, distance);
    }

    /// Records the value at the end of a step or within it.
    pub(super) fn step(&mut self, time: f64, terms: &TermWatch, floor: f64, dense: bool) {
        if let Some(sums) = self.summed(terms) {
            self.step_with(time, (sums, terms.work()), floor, dense);
        }
    }

    /// Records the values at the ends of several steps.
    pub(super) fn steps(&mut self, terms: &BatchTerms, ends: &[MonitoredStep]) {
        let Some(quantity) = self.quantity.filter(|&quantity| terms.has(quantity)) else { return };
        let sums = terms.sums(quantity, &self.at_rest);
        for (lane, (end, sums)) in ends.iter().zip(sums).enumerate() {
            self.step_with(end.time, (sums, terms.work(lane)), end.floor, end.dense);
        }
    }

    /// Records the sums over the terms, and the work. A distance that rounding explains is ignored.
    fn step_with(
        &mut self,
        time: f64,
        (TermSums { value, size, moving }, work): (TermSums, f64),
        floor: f64,
        dense: bool,
    ) {
        let distance = self.rough(value, work) - self.rough_reference;
        self.widen(size);
        // the moving part of a lost motion is no measure of it
        if self.worst <= LOST {
            self.moving.note(time, moving);
        }
        if distance.abs() > floor * self.rounding {
            self.note(time, distance, moving, floor);
            // if there are rows within a step, these make the history
            if !dense {
                self.distances.push(time, distance);
            }
        }
    }

    fn note(&mut self, time: f64, distance: f64, moving: f64, floor: f64) {
        let distance = distance.abs();
        self.last = distance;
        if distance > self.farthest {
            self.farthest = distance;
        }
        let explained = floor * self.rounding;
        self.explained = self.explained.max(explained);
        let beyond = distance > explained;
        // a motion that has not begun says nothing of what will move
        if !beyond && moving == 0.0 && self.moving.value() == 0.0 {
            return;
        }
        let held = self.early.take(beyond.then_some(Distance { time, size: distance, moving }));
        if beyond && !held {
            let drift = self.drift_of(distance, moving);
            self.worst = self.worst.max(drift);
            // rows lie before the end of the step, which was recorded first
            if drift > LEFT && self.left.is_none_or(|left| time < left) {
                self.left = Some(time);
            }
        }
        if self.early.is_known() {
            (self.worst, self.left) = self.drifted();
            self.early = Early::over();
        }
    }

    /// Why a drift would not be seen, if it would not: all its terms have always been below the numbers that have all their digits,
    /// and not because they are 0; or a motion whose energy is all but constant terms could be lost within their rounding error.
    fn unseen(&self) -> Option<Unseen> {
        let moving = self.moving.value();
        if self.underflows && self.rounding < f64::MIN_POSITIVE {
            return Some(Unseen::Underflow);
        }
        let is_lost = analysis::rounding_floor(0) * self.rounding > LOST * moving;
        let within_rounding = self.farthest <= self.explained;
        // the terms of others may all be constant, so that what moves of them is rounding
        (self.quantity == Some(ENERGY) && moving > 0.0 && is_lost && within_rounding)
            .then(|| Unseen::Unresolved(self.rounding / moving))
    }

    fn drift_of(&self, distance: f64, moving: f64) -> f64 {
        distance / self.scale_of(moving.max(self.moving.value()))
    }

    /// The greatest drift, and when it first exceeded the limit.
    fn drifted(&self) -> (f64, Option<f64>) {
        let (mut worst, mut left) = (self.worst, self.left);
        for &Distance { time, size, moving } in &self.early.distances {
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
        self.scale_of(self.moving.value())
    }

    /// The scale of drift where this much moves.
    fn scale_of(&self, moving: f64) -> f64 {
        // terms that balance each other move by more than their sum
        let is_error = moving <= 2.0 * self.farthest && moving <= ERROR * self.explained;
        if is_error { self.rounding } else { moving }
    }

    pub(super) fn show(&self, values: &[f64], since: f64, floor: f64, errors: Errors) -> Gauge {
        let value = values[self.channel];
        let (scale, rounding) = (self.scale(), floor * self.rounding);
        // a rounding error is small compared with the terms
        let drift = |distance: f64| match distance {
            0.0 => 0.0,
            _ if distance <= rounding => distance / scale.max(self.rounding),
            _ => distance / scale,
        };
        let distance = if self.offset { self.last } else { (value - self.reference).abs() };
        let beyond = self.farthest > rounding;
        let is_below_digits = self.farthest < f64::EPSILON * self.rounding;
        let (worst, since_when) = self.drifted();
        let max_drift = if beyond { worst } else { drift(self.farthest.max(distance)) };
        let drift_now = drift(distance).min(max_drift);
        let left = beyond && max_drift > LEFT;
        // what is only supposed to be conserved may change with the motion
        let errors = if self.proved { errors } else { Errors::Accumulated };
        let unseen = self.unseen();
        let is_unknown = unseen.is_some();
        let verdict = match (&self.broken, unseen) {
            (Some(law), _) => Verdict::Broken(law.clone()),
            (None, Some(unseen)) => Verdict::Unknown(unseen),
            (None, None) if beyond && max_drift > LOST => Verdict::Lost,
            (None, None) => match Verdict::of(&self.distances, self.farthest, rounding, errors) {
                Verdict::Secular(slope) => Verdict::Secular(slope / scale),
                Verdict::Exact(_) if is_below_digits => Verdict::Exact(analysis::Growth::Level),
                other => other,
            },
        };
        let history = self.distances.stretches().iter().map(Stretch::peak);
        Gauge {
            name: self.name.clone(),
            shown: self.shown.clone(),
            reason: match unseen {
                Some(Unseen::Underflow) => format!("{}; {UNDERFLOW}", self.reason),
                Some(Unseen::Unresolved(_)) => format!("{}; {UNRESOLVED}", self.reason),
                None => self.reason.clone(),
            },
            proved: self.proved && self.broken.is_none(),
            value,
            initial: self.initial,
            scale,
            farthest: self.farthest,
            reference: self.reference,
            reference_time: since,
            drift: if is_unknown { f64::NAN } else { drift_now },
            max_drift: if is_unknown { f64::NAN } else { max_drift },
            left: (left && !is_unknown && self.broken.is_none())
                .then(|| since_when.unwrap_or(since)),
            history: if is_unknown {
                Arc::default()
            } else {
                history.map(|peak| drift(peak) as f32).collect()
            },
            verdict,
        }
    }
}

/// A distance from the reference, and what moved at that time.
#[derive(Clone, Copy, Debug)]
struct Distance {
    time: f64,
    size: f64,
    moving: f64,
}

/// The number of first looks, whose distances are held until there were …
const FIRST_LOOKS: u32 = 64;

/// … so many.
const LOOKS_TO_KNOW: u32 = 2 * FIRST_LOOKS;

/// The distances at the first looks. A motion that begins at rest moves little in its first steps, and the error of the first
/// may be as large as all that has moved: they are compared with what moves a few steps later.
#[derive(Clone, Debug, Default)]
struct Early {
    looks: u32,
    distances: Vec<Distance>,
}

impl Early {
    /// That of a motion that has moved.
    fn over() -> Early {
        Early { looks: LOOKS_TO_KNOW + 1, distances: Vec::new() }
    }

    /// Whether what moves is just known.
    fn is_known(&self) -> bool {
        self.looks == LOOKS_TO_KNOW
    }

    /// Takes a look, with a distance if rounding does not explain it. Returns whether the distance is held.
    fn take(&mut self, distance: Option<Distance>) -> bool {
        if self.looks < LOOKS_TO_KNOW {
            self.looks += 1;
        }
        let is_first = self.looks <= FIRST_LOOKS;
        self.distances.extend(distance.filter(|_| is_first));
        is_first
    }
}
