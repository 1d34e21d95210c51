//! A gauge as it is shown: its drift and the verdict on it.
//!
//! In: a monitor, the current values. Out: a [`Gauge`]. Never here: what is recorded, and what distances are compared with.

use std::sync::Arc;

use super::InvariantMonitor;
use super::drift_measure::DriftMeasure;
use crate::analysis::{self, Errors, LEFT, LOST, RoundedInput, Unseen, Verdict};
use crate::experiment::Gauge;
use crate::expr::Expr;

/// What is said beside the reason of a gauge whose drift cannot be known.
const UNDERFLOW: &str = "its terms underflow";
const UNRESOLVED: &str = "it cannot resolve the motion";

/// What is said beside the reason where nothing moves.
const AT_REST: &str = "at rest";

impl InvariantMonitor {
    /// The gauge, given whether the motion is at rest, where every function of the state is constant, and how rounding of the present
    /// state changes its value.
    pub(in crate::experiment::gauges) fn show(
        &self,
        values: &[f64],
        since: f64,
        (floor, errors): (f64, Errors),
        is_at_rest: bool,
        of_state: &dyn Fn(Expr) -> Option<(f64, RoundedInput)>,
    ) -> Gauge {
        let invariant = &self.invariant;
        let here = self.constant_here.as_ref().or(self.acting_here.as_ref());
        let reason = here.unwrap_or(&invariant.reason);
        let value = values[invariant.channel];
        let mut measure = if self.is_seen() {
            self.measured_by_value(floor, of_state(invariant.expression))
        } else {
            self.measured_by_terms(floor)
        };
        let rests = matches!(measure.unseen, Some(Unseen::Unresolved(_))) && is_at_rest;
        measure.unseen.take_if(|_| rests);
        let distance = if self.reference.offset {
            self.drift.last
        } else {
            (value - self.reference.value).abs()
        };
        let seen = if self.is_seen() { self.seen.greatest() } else { 0.0 };
        let farthest = self.drift.farthest.max(seen);
        let is_beyond = farthest > measure.rounding;
        let worst = measure.worst.filter(|_| is_beyond);
        let max_drift = worst.unwrap_or_else(|| measure.drift(farthest.max(distance)));
        let is_broken = self.change_law().is_some();
        let is_known = measure.is_known();
        let left = is_beyond && max_drift > LEFT && is_known && !is_broken;
        let known = |drift: f64| if is_known { drift } else { f64::NAN };
        Gauge {
            name: invariant.name.clone(),
            shown: invariant.shown.clone(),
            reason: match &measure.unseen {
                Some(Unseen::Underflow) => format!("{reason}; {UNDERFLOW}"),
                Some(Unseen::Unresolved(_)) => format!("{reason}; {UNRESOLVED}"),
                Some(Unseen::Rounded(input)) => {
                    format!("{reason}; rounding of {} explains its change", input.name)
                }
                None if rests => format!("{reason}; {AT_REST}"),
                None => reason.clone(),
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
        let is_broken = self.change_law().is_some();
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
        if let Some(law) = self.change_law() {
            return Verdict::Broken(law.to_owned());
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
}
