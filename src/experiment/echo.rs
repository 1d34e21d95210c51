//! The run before time was reversed: what a motion that goes back is held against.
//!
//! At the time t of the motion that goes back, the run before is taken from its log of steps, exactly by dense output. Their
//! distance is the return error. Every step of both adds an error of size ε, which grows on the way back to t as the
//! derivative of the flow says: like e^{λT} in chaos, in proportion to the time where the motion is regular.
//!
//! That error is the tolerance, or the rounding of a method whose step back is the inverse of one forwards. Of any other method
//! the error of truncation is much larger than both, and it is measured: the motion is carried back over steps of the run.
//!
//! In: an observed motion that has ended, times. Out: its values at those times, the distance. Never here: how a motion runs
//! backwards.

use std::sync::Arc;

use super::observed_motion::ObservedMotion;
use super::{Companion, CompanionOrigin, Return, Trail};
use crate::analysis::{CrossingLog, DistanceHistory, distance};
use crate::integrate::{Preserves, Stepping};
use crate::system::{State, instant_of};

/// Half the distance between 1 and the next number.
const ROUNDING: f64 = 1.110_223_024_625_156_5e-16;

/// The places of the run at which the error of a step is measured.
const MEASURED: usize = 24;

/// The run before time was reversed.
pub(super) struct Echo {
    run: ObservedMotion,
    trail: Trail,
    /// Its values where it was observed last, and the time.
    at: f64,
    values: Vec<f64>,
    separation: Arc<DistanceHistory>,
    turned: f64,
    /// When its clock began to count.
    began: f64,
    pub(super) start: f64,
    /// The time to which its first state is dated.
    first: f64,
    distance: Option<f64>,
    error: Option<f64>,
    step_error: f64,
    /// The state at which time was reversed, and the mean size of a step.
    state: Arc<State>,
    mean_step: f64,
    /// The mean size of the steps whose error was measured.
    step: Option<f64>,
}

impl Echo {
    /// The run that ends now, which has left this trail; `None` if none of it is known.
    pub(super) fn of(run: ObservedMotion, trail: Trail, variables: &[usize]) -> Option<Echo> {
        let (first, turned) = (run.sign() * run.known_from()?, run.time());
        let greatest = |row: &[f64]| {
            variables.iter().map(|&i| row.get(1 + i).map_or(0.0, |x| x * x)).sum::<f64>()
        };
        let size = trail.rows().map(greatest).fold(0.0, f64::max);
        Some(Echo {
            at: turned,
            values: run.values().to_vec(),
            separation: Arc::default(),
            turned,
            began: run.sign() * first,
            start: instant_of(first),
            first,
            distance: None,
            error: None,
            step: None,
            state: Arc::new(run.dated_state()),
            mean_step: run.log.mean_step().unwrap_or_else(|| run.step_size().abs()),
            step_error: run.tolerance().unwrap_or(ROUNDING) * size.sqrt(),
            run,
            trail,
        })
    }

    /// Measures the error of a step by a motion that goes back over some of the steps of the run, where neither the tolerance
    /// nor rounding is that error.
    pub(super) fn measure_step(
        &mut self,
        mut back: ObservedMotion,
        horizon: f64,
        (variables, periods): (&[usize], &[Option<f64>]),
    ) {
        let method = self.run.method();
        if method.preserves == Preserves::SymplecticReversible || method.order.is_none() {
            return;
        }
        let pick = |values: &[f64]| -> Vec<f64> { variables.iter().map(|&i| values[i]).collect() };
        let step = self.run.step_size().abs();
        let (mut error, mut steps, mut passed) = (0.0, 0.0, 0.0);
        for [from, to] in self.run.log.sample(MEASURED) {
            let times = [&from, &to].map(|known| self.run.sign() * known.state.time);
            let Some(begun) = self.run.values_at(&from.state) else { continue };
            if !back.go_to_before((&to.state, step), times[0], horizon) {
                continue;
            }
            error += distance(&pick(&begun), &pick(back.values()), periods);
            steps += (to.steps - from.steps) as f64;
            passed += (times[1] - times[0]).abs();
        }
        // steps of a size of their own miss on the way back once more
        let both = if method.stepping == Stepping::Adaptive { 2.0 } else { 1.0 };
        if steps > 0.0 && error.is_finite() {
            (self.step_error, self.step) = (both * error / steps, Some(passed / steps));
        }
    }

    /// Whether the run before has been at a time.
    pub(super) fn covers(&self, time: f64) -> bool {
        (time - self.start) * (time - self.turned) <= 0.0
    }

    /// Goes to where the run before was at a time. Returns whether it has been there.
    pub(super) fn scrub_to(&mut self, time: f64, horizon: f64) -> bool {
        let dated = if time == self.start { self.first } else { time };
        let there = self.covers(time) && self.run.go_back_to(dated, horizon, self.began);
        if there {
            self.at = time;
            self.values.copy_from_slice(self.run.values());
        }
        there
    }

    /// The motion that goes back has these values at a time. `horizon` bounds the steps of the run before as it did then.
    pub(super) fn compare(
        &mut self,
        (time, values): (f64, &[f64]),
        horizon: f64,
        (variables, periods): (&[usize], &[Option<f64>]),
    ) {
        if !self.scrub_to(time, horizon) {
            return;
        }
        let pick = |values: &[f64]| -> Vec<f64> { variables.iter().map(|&i| values[i]).collect() };
        let (then, now) = (pick(&self.values), pick(values));
        let distance = distance(&then, &now, periods);
        self.distance = Some(distance);
        if time == self.start {
            self.error = Some(distance);
        }
        let elapsed = (time - self.turned).abs();
        Arc::make_mut(&mut self.separation).add(elapsed, &then, &now, periods);
    }

    /// Whether the motion has come back to where the run before began.
    pub(super) fn is_complete(&self) -> bool {
        self.error.is_some()
    }

    pub(super) fn returned(&self) -> Return {
        Return {
            turned: self.turned,
            start: self.start,
            step_error: self.step_error,
            state: Arc::clone(&self.state),
            mean_step: self.mean_step,
            step: self.step,
            distance: self.distance,
            error: self.error,
        }
    }

    /// The distance over the time elapsed back.
    pub(super) fn separation(&self) -> Arc<DistanceHistory> {
        Arc::clone(&self.separation)
    }

    /// The run before as a motion beside the main one, where it was at the time of the main one, and on its way until then.
    pub(super) fn shown(&self, number: usize, parameters: &[f64], surfaces: usize) -> Companion {
        Companion {
            number,
            origin: CompanionOrigin::Before,
            time: self.at,
            values: self.values.as_slice().into(),
            parameters: parameters.into(),
            method: self.run.method().name,
            settings: self.run.settings(),
            fixed_step: None,
            released: self.run.released().into(),
            state: Arc::new(self.run.dated_state()),
            trail: self.trail.until(self.at),
            crossings: CrossingLog::new(surfaces),
            message: None,
        }
    }
}
