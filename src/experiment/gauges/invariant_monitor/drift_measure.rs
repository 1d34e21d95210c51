//! A gauge as it is shown: its drift and the verdict on it.
//!
//! In: a monitor, the current values. Out: a [`Gauge`]. Never here: what is recorded, and when.

use std::sync::Arc;

use super::super::seen_distances::SeenDistances;
use super::{ENERGY, InvariantMonitor};
use crate::analysis::{self, Errors, LEFT, LOST, RoundedInput, Unseen, Verdict};
use crate::experiment::Gauge;
use crate::expr::Expr;

/// What is said beside the reason of a gauge whose drift cannot be known.
const UNDERFLOW: &str = "its terms underflow";
const UNRESOLVED: &str = "it cannot resolve the motion";

/// What distances are compared with.
struct DriftMeasure {
    /// What a drift is relative to.
    scale: f64,
    /// The distance that rounding explains.
    rounding: f64,
    /// What a distance is relative to that rounding explains: what the last digits of the value hide is small compared with the terms.
    hidden_scale: f64,
    /// The greatest drift, where each distance was compared with what had moved up to its time.
    worst: Option<f64>,
    /// When the drift first exceeded the limit, if it did.
    left: Option<f64>,
    /// Why nothing is known of the method by this drift.
    unseen: Option<Unseen>,
}

impl DriftMeasure {
    fn drift(&self, distance: f64) -> f64 {
        match distance {
            0.0 => 0.0,
            _ if distance <= self.rounding => distance / self.hidden_scale,
            _ => distance / self.scale,
        }
    }

    /// Whether there is a drift at all: one that rounding of the state explains has been seen.
    fn is_known(&self) -> bool {
        matches!(self.unseen, None | Some(Unseen::Rounded(_)))
    }
}

impl InvariantMonitor {
    /// The gauge, given how rounding of the present state changes its value.
    pub(in crate::experiment::gauges) fn show(
        &self,
        values: &[f64],
        since: f64,
        (floor, errors): (f64, Errors),
        of_state: &dyn Fn(Expr) -> Option<(f64, RoundedInput)>,
    ) -> Gauge {
        let invariant = &self.invariant;
        let value = values[invariant.channel];
        let measure = if self.is_seen() {
            self.measured_by_value(floor, of_state(invariant.expression))
        } else {
            self.measured_by_terms(floor)
        };
        let distance = if self.reference.offset {
            self.drift.last
        } else {
            (value - self.reference.value).abs()
        };
        let farthest = self.drift.farthest;
        let is_beyond = farthest > measure.rounding;
        let worst = measure.worst.filter(|_| is_beyond);
        let max_drift = worst.unwrap_or_else(|| measure.drift(farthest.max(distance)));
        let is_broken = invariant.broken.is_some();
        let is_known = measure.is_known();
        let left = is_beyond && max_drift > LEFT && is_known && !is_broken;
        let known = |drift: f64| if is_known { drift } else { f64::NAN };
        Gauge {
            name: invariant.name.clone(),
            shown: invariant.shown.clone(),
            reason: match &measure.unseen {
                Some(Unseen::Underflow) => format!("{}; {UNDERFLOW}", invariant.reason),
                Some(Unseen::Unresolved(_)) => format!("{}; {UNRESOLVED}", invariant.reason),
                Some(Unseen::Rounded(input)) => {
                    format!("{}; rounding of {} explains its change", invariant.reason, input.name)
                }
                None => invariant.reason.clone(),
            },
            proved: invariant.proved && !is_broken,
            value,
            initial: self.reference.initial,
            scale: measure.scale,
            farthest,
            reference: self.reference.value,
            reference_time: since,
            drift: known(measure.drift(distance).min(max_drift)),
            max_drift: known(max_drift),
            left: left.then(|| measure.left.unwrap_or(since)),
            history: if is_known { self.history(&measure) } else { Arc::default() },
            verdict: self.verdict(&measure, max_drift, errors),
        }
    }

    /// The drift in the course of time.
    fn history(&self, measure: &DriftMeasure) -> Arc<[f32]> {
        let is_broken = self.invariant.broken.is_some();
        let stretches = self.drift.distances.stretches().iter();
        let drifts = stretches.map(|stretch| {
            // what changes by the physics is seen rising and falling
            if is_broken {
                measure.drift(stretch.mean.abs()).copysign(stretch.mean)
            } else {
                measure.drift(stretch.peak())
            }
        });
        drifts.map(|drift| drift as f32).collect()
    }

    fn verdict(&self, measure: &DriftMeasure, max_drift: f64, errors: Errors) -> Verdict {
        if let Some(law) = &self.invariant.broken {
            return Verdict::Broken(law.clone());
        }
        if let Some(unseen) = &measure.unseen {
            return Verdict::Unknown(unseen.clone());
        }
        let farthest = self.drift.farthest;
        if farthest > measure.rounding && max_drift > LOST {
            return Verdict::Lost;
        }
        // what is only supposed to be conserved may change with the motion
        let errors = if self.invariant.proved { errors } else { Errors::Accumulated };
        match Verdict::of(&self.drift.distances, farthest, measure.rounding, errors) {
            Verdict::Secular(slope) => Verdict::Secular(slope / measure.scale),
            Verdict::Exact(_) if farthest < f64::EPSILON * self.rounding.greatest => {
                Verdict::Exact(analysis::Growth::Level)
            }
            other => other,
        }
    }

    /// Where the value itself shows the drift: what its last digits hide is rounding.
    fn measured_by_value(&self, floor: f64, now: Option<(f64, RoundedInput)>) -> DriftMeasure {
        let scale = self.moving();
        let explained = self.seen.explained(self.drift.farthest, floor, now);
        DriftMeasure {
            scale,
            rounding: SeenDistances::hidden(self.reference.value.abs().max(scale)),
            hidden_scale: scale,
            worst: None,
            left: self.seen.first_beyond(LEFT * scale),
            unseen: explained.map(Unseen::Rounded),
        }
    }

    /// Elsewhere: what the terms have gathered is rounding.
    fn measured_by_terms(&self, floor: f64) -> DriftMeasure {
        let scale = self.scale();
        let (worst, left) = self.drifted();
        DriftMeasure {
            scale,
            rounding: floor * self.rounding.greatest,
            hidden_scale: scale.max(self.rounding.greatest),
            worst: Some(worst),
            left,
            unseen: self.unseen(),
        }
    }

    /// Why a drift would not be seen, if it would not: all its terms have always been below the numbers that have all their digits,
    /// and not because they are 0; or a motion whose energy is all but constant terms could be lost within their rounding error.
    fn unseen(&self) -> Option<Unseen> {
        let moving = self.moving();
        if self.rounding.underflows && self.rounding.greatest < f64::MIN_POSITIVE {
            return Some(Unseen::Underflow);
        }
        let is_lost = analysis::rounding_floor(0) * self.rounding.greatest > LOST * moving;
        let within_rounding = self.drift.farthest <= self.rounding.explained;
        // the terms of others may all be constant, so that what moves of them is rounding
        (self.invariant.quantity == Some(ENERGY) && moving > 0.0 && is_lost && within_rounding)
            .then(|| Unseen::Unresolved(self.rounding.greatest / moving))
    }
}
