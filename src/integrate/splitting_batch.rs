//! Splitting methods of several orbits at once.
//!
//! In: a state, parameters and a limit for each lane. Out: the equal steps that an orbit alone takes.
//! An orbit whose numbers leave what is ordinary is given back as [`LaneStatus::Irregular`]. Never here:
//! stability, which the orbit alone is asked about.

use super::equal_steps::EqualSteps;
use super::fixed::Scheme;
use super::lane_status::LaneStatus;
use super::method::{Method, Settings};
use super::splitting::Splitting;
use crate::num::{BATCH, DoubleDouble};
use crate::system::{BatchSplitStep, Form, State, System};

/// The most steps between two looks at the token.
const MOST: u64 = 256;

/// One orbit.
#[derive(Clone)]
struct SplittingLane {
    status: LaneStatus,
    state: State,
    before: State,
    steps: EqualSteps,
    parameters: Vec<f64>,
}

/// Orbits by a splitting method, side by side.
pub(super) struct SplittingBatch {
    system: System,
    many: BatchSplitStep,
    /// Takes the shorter steps of dense output.
    aside: Splitting,
    /// The lane whose parameters that has.
    aside_of: Option<usize>,
    asked: Option<f64>,
    lanes: [SplittingLane; BATCH],
}

impl SplittingBatch {
    /// Room for orbits of a system; `None` where they have to be followed one by one.
    pub(super) fn new(
        system: &System,
        method: &Method,
        settings: &Settings,
    ) -> Option<SplittingBatch> {
        let asked = settings.step;
        if asked.is_some_and(|h| !(h > 0.0 && h.is_finite())) {
            return None;
        }
        let weights = (method.leapfrogs)();
        let many = system.batch_split_step(&weights).filter(|_| !weights.is_empty())?;
        let blank = State::new(0.0, Form::Momentum, vec![0.0; system.state_len()]);
        let lane = SplittingLane {
            status: LaneStatus::Empty,
            state: blank.clone(),
            before: blank,
            steps: EqualSteps::new(DoubleDouble::ZERO, DoubleDouble::ZERO),
            parameters: Vec::new(),
        };
        Some(SplittingBatch {
            system: system.clone(),
            many,
            aside: Splitting::new(system, weights)?,
            aside_of: None,
            asked,
            lanes: std::array::from_fn(|_| lane.clone()),
        })
    }

    /// Puts an orbit into a lane.
    pub(super) fn start(&mut self, lane: usize, state: &State, parameters: &[f64]) -> LaneStatus {
        let own = &mut self.lanes[lane];
        let regular = self.many.set_parameters(lane, parameters);
        own.status = LaneStatus::Irregular;
        if self.aside_of == Some(lane) {
            self.aside_of = None;
        }
        if let (true, Ok(begun)) = (regular, self.system.convert(state, Form::Momentum, parameters))
        {
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

    pub(super) fn interval(&self, lane: usize) -> (f64, f64) {
        (self.lanes[lane].before.time, self.lanes[lane].state.time)
    }

    /// Takes steps in every lane that is under way and before its limit, until one of them reaches or
    /// passes its time in `looks`, and at least one. Returns false if it was cancelled.
    #[must_use]
    pub(super) fn step(&mut self, limits: &[f64; BATCH], looks: &[f64; BATCH]) -> bool {
        if self.system.cancel().is_cancelled() {
            return false;
        }
        let mut going = [false; BATCH];
        let mut count = MOST;
        for (i, lane) in self.lanes.iter_mut().enumerate() {
            going[i] = lane.status == LaneStatus::Underway && lane.state.time < limits[i];
            if going[i] {
                count = if looks[i] > lane.state.time {
                    lane.steps.to(looks[i].min(limits[i]), count)
                } else {
                    1
                };
                self.many.set_state(i, &lane.state);
            }
        }
        self.many.advance(count);
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
        if self.aside_of != Some(lane) {
            self.aside.begin(&own.parameters);
            self.aside_of = Some(lane);
        }
        self.aside.forget();
        let step = DoubleDouble::written(time) - own.before.exact_time();
        if self.aside.advance(step.high, out).is_err() {
            out.values.fill(f64::NAN);
        }
        out.set_time(DoubleDouble::from(time));
    }
}
