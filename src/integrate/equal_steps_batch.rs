//! Methods of fixed step for several orbits at once.
//!
//! In: a state, parameters and a limit for each lane. Out: the equal steps that an orbit alone takes.
//! An orbit whose numbers leave what is ordinary is given back as [`LaneStatus::Irregular`]. Never here:
//! stability, which the orbit alone is asked about.

use super::equal_steps::EqualSteps;
use super::fixed::Scheme;
use super::lane_status::LaneStatus;
use super::method::Settings;
use crate::num::{BATCH, Batch, DoubleDouble};
use crate::system::{BatchStates, BatchSteps, Form, State, System};

/// The most steps between two checks of the token.
const MOST: u64 = 256;

#[derive(Clone)]
struct EqualStepsLane {
    status: LaneStatus,
    state: State,
    before: State,
    steps: EqualSteps,
    parameters: Vec<f64>,
}

/// Orbits side by side, by steps of which a scheme takes those of one orbit.
pub(super) struct EqualStepsBatch<B, S> {
    system: System,
    many: B,
    /// Takes the shorter steps of dense output.
    inner: S,
    /// The lane whose parameters that has.
    inner_lane: Option<usize>,
    asked: Option<f64>,
    lanes: [EqualStepsLane; BATCH],
    together: BatchStates,
}

impl<B: BatchSteps, S: Scheme> EqualStepsBatch<B, S> {
    /// Room for orbits of a system. Returns `None` where the step asked for is none.
    pub(super) fn new(
        system: &System,
        settings: &Settings,
        (many, inner): (B, S),
    ) -> Option<EqualStepsBatch<B, S>> {
        let asked = settings.step;
        if asked.is_some_and(|h| !(h > 0.0 && h.is_finite())) {
            return None;
        }
        let blank = State::new(0.0, inner.form(), vec![0.0; system.state_len()]);
        let together = BatchStates::new(blank.form, system.state_len());
        let lane = EqualStepsLane {
            status: LaneStatus::Empty,
            state: blank.clone(),
            before: blank,
            steps: EqualSteps::new(DoubleDouble::ZERO, DoubleDouble::ZERO),
            parameters: Vec::new(),
        };
        Some(EqualStepsBatch {
            system: system.clone(),
            many,
            inner,
            inner_lane: None,
            asked,
            lanes: std::array::from_fn(|_| lane.clone()),
            together,
        })
    }

    pub(super) fn form(&self) -> Form {
        self.inner.form()
    }

    pub(super) fn start(&mut self, lane: usize, state: &State, parameters: &[f64]) -> LaneStatus {
        let own = &mut self.lanes[lane];
        let regular = self.many.set_parameters(lane, parameters);
        own.status = LaneStatus::Irregular;
        if self.inner_lane == Some(lane) {
            self.inner_lane = None;
        }
        let form = self.inner.form();
        if let (true, Ok(begun)) = (regular, self.system.convert(state, form, parameters)) {
            let step = EqualSteps::step_of(self.asked, &self.system, state, parameters);
            own.steps = EqualSteps::new(begun.exact_time(), step);
            own.before.copy_from(&begun);
            own.state = begun;
            own.parameters = parameters.to_vec();
            own.status = LaneStatus::Underway;
            self.many.set_step(lane, step.high);
        }
        own.status
    }

    pub(super) fn clear(&mut self, lane: usize) {
        self.lanes[lane].status = LaneStatus::Empty;
    }

    pub(super) fn status(&self, lane: usize) -> LaneStatus {
        self.lanes[lane].status
    }

    pub(super) fn state(&self, lane: usize) -> &State {
        &self.lanes[lane].state
    }

    pub(super) fn time(&self, lane: usize) -> f64 {
        self.lanes[lane].state.time
    }

    /// The states of all lanes.
    pub(super) fn states(&mut self) -> &BatchStates {
        for (i, lane) in self.lanes.iter().enumerate() {
            self.together.set(i, &lane.state);
        }
        &self.together
    }

    pub(super) fn interval(&self, lane: usize) -> (f64, f64) {
        (self.lanes[lane].before.time, self.lanes[lane].state.time)
    }

    /// Takes steps in every lane that is under way and before its limit, until one of them reaches or
    /// passes its time in `observations`, and at least one. Returns false if it was cancelled.
    #[must_use]
    pub(super) fn step(&mut self, limits: &[f64; BATCH], observations: &[f64; BATCH]) -> bool {
        if self.system.cancel().is_cancelled() {
            return false;
        }
        let mut going = [false; BATCH];
        let mut count = MOST;
        for (i, lane) in self.lanes.iter_mut().enumerate() {
            going[i] = lane.status == LaneStatus::Underway && lane.state.time < limits[i];
            if going[i] {
                count = if observations[i] > lane.state.time {
                    lane.steps.to(observations[i].min(limits[i]), count)
                } else {
                    1
                };
                self.many.set_state(i, &lane.state);
            }
        }
        let EqualStepsBatch { many, lanes, .. } = self;
        let time = |lane: &EqualStepsLane, step| lane.steps.time_after(step).high;
        many.advance(count, |step| Batch(lanes.each_ref().map(|lane| time(lane, step))));
        let finite = self.many.are_finite();
        for (i, lane) in self.lanes.iter_mut().enumerate().filter(|(i, _)| going[*i]) {
            let counted = lane.steps.are_distinct(count, lane.state.time)
                && !lane.steps.are_too_many(limits[i]);
            if !(counted && finite[i]) {
                lane.status = LaneStatus::Irregular;
                continue;
            }
            self.many.write(i, &mut lane.state, &mut lane.before);
            let begin = lane.state.exact_time();
            let last = if count > 1 { lane.steps.time_after(count - 1) } else { begin };
            lane.before.set_time(last);
            lane.state.set_time(lane.steps.time_after(count));
            lane.steps.take(count);
        }
        true
    }

    /// Writes the state of a lane at a time within its last step into `out`; numbers that are not
    /// finite if there is none.
    pub(super) fn at(&mut self, lane: usize, time: f64, out: &mut State) {
        let own = &self.lanes[lane];
        if time == own.state.time {
            out.copy_from(&own.state);
            return;
        }
        out.copy_from(&own.before);
        if time == own.before.time {
            return;
        }
        if self.inner_lane != Some(lane) {
            self.inner.begin(&own.parameters);
            self.inner_lane = Some(lane);
        }
        self.inner.forget();
        let step = DoubleDouble::from_decimal(time) - own.before.exact_time();
        if self.inner.advance(step.high, out).is_err() {
            out.values.fill(f64::NAN);
        }
        out.set_time(DoubleDouble::from(time));
    }
}
