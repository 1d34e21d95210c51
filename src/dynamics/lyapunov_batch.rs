//! The Lyapunov exponents of several motions of one system, followed side by side.
//!
//! In: the phase space, start and end of each motion. Out: what [`lyapunov`] finds of each alone, to the last bit. Never here:
//! what is done with vectors, threads.

use nalgebra::{DMatrix, DVector};

use super::error::DynamicsError;
use super::lyapunov::{Lyapunov, exponents, lyapunov};
use super::lyapunov_course::{CarriedMotion, LyapunovCourse};
use super::phase_space::PhaseSpace;
use super::regular_step::RegularStep;
use super::tangent_step::{TangentStates, TangentStep};
use crate::integrate::{
    BatchPropagator, Follower, LaneStatus, Method, OrbitCourse, Settings, Stepping, side_by_side,
};
use crate::num::BATCH;
use crate::system::{MotionError, State, System};

/// So few motions are followed one by one: most lanes would be empty.
const FEW: usize = 3;

/// A motion whose exponents are asked for.
pub struct LyapunovOrbit {
    /// Its phase space; all are of one system.
    pub space: PhaseSpace,
    /// The state of the space at which it begins.
    pub start: State,
    /// The time at which it ends.
    pub until: f64,
}

/// The exponents of each motion, in the order of `orbits`; several are followed side by side where the system and the
/// method allow it.
///
/// # Errors
/// Each motion has the error that `lyapunov` gives for it.
pub fn lyapunov_of_all(
    orbits: &[LyapunovOrbit],
    (method, settings): (&'static Method, Settings),
) -> Vec<Result<Lyapunov, DynamicsError>> {
    let alone = |orbit: &LyapunovOrbit| {
        let LyapunovOrbit { space, start, until } = orbit;
        lyapunov(space, (method, settings), start, *until, &mut |_| ())
    };
    let Some((system, mut batch)) = room(orbits, (method, settings)) else {
        return orbits.iter().map(alone).collect();
    };
    let mut together = ExponentsTogether {
        orbits,
        system,
        method,
        settings,
        fixed: method.stepping == Stepping::Fixed,
        lanes: std::array::from_fn(|_| None),
        found: orbits.iter().map(|_| None).collect(),
    };
    // what a cancellation leaves is reported as cancelled, each orbit alone
    side_by_side(&mut batch, orbits.len(), &mut together);
    let found = together.found.into_iter().zip(orbits);
    found.map(|(found, orbit)| found.unwrap_or_else(|| alone(orbit))).collect()
}

/// The system with the vectors of the first motion, and room for motions of it; `None` where they have to be followed one by
/// one.
fn room(
    orbits: &[LyapunovOrbit],
    (method, settings): (&'static Method, Settings),
) -> Option<(System, BatchPropagator)> {
    let suits = |space: &PhaseSpace| !space.has_jumps() && !space.is_constrained();
    // a step that each motion would choose for itself is chosen once for all that follows
    let chosen = method.stepping == Stepping::Fixed && settings.step.is_none();
    if orbits.len() < FEW || chosen || !orbits.iter().all(|orbit| suits(&orbit.space)) {
        return None;
    }
    let begin = |orbit: &LyapunovOrbit| {
        LyapunovCourse::begin(&orbit.space, &orbit.start, orbit.until, false).ok()
    };
    let (first, (course, _)) = orbits.iter().find_map(|orbit| Some((orbit, begin(orbit)?)))?;
    let system = first.space.system().without_marks().with_tangents(course.vectors());
    let batch = BatchPropagator::new(&system, method, settings)?;
    Some((system, batch))
}

struct LyapunovLane {
    course: LyapunovCourse,
    states: TangentStates,
    steps: u64,
    regular_step: RegularStep,
}

/// Motions that are followed side by side.
struct ExponentsTogether<'a> {
    orbits: &'a [LyapunovOrbit],
    system: System,
    method: &'static Method,
    settings: Settings,
    /// Whether all steps are equal.
    fixed: bool,
    lanes: [Option<LyapunovLane>; BATCH],
    /// The exponents found; `None` where a motion has to be followed alone.
    found: Vec<Option<Result<Lyapunov, DynamicsError>>>,
}

impl Follower for ExponentsTogether<'_> {
    fn begin(&mut self, orbit: usize, lane: usize, batch: &mut BatchPropagator) -> OrbitCourse {
        let LyapunovOrbit { space, start, until } = &self.orbits[orbit];
        // the motion alone says why
        let Ok((course, vectors)) = LyapunovCourse::begin(space, start, *until, false) else {
            return OrbitCourse::Over;
        };
        // one that begins at rest has other vectors
        if course.vectors() != self.system.tangents() {
            return OrbitCourse::Over;
        }
        let states = TangentStates::new(space, &self.system);
        let full = states.join(start, &vectors);
        if batch.begin(lane, &full, space.parameters()) != LaneStatus::Underway {
            return OrbitCourse::Over;
        }
        self.lanes[lane] =
            Some(LyapunovLane { course, states, steps: 0, regular_step: RegularStep::default() });
        OrbitCourse::Until(*until)
    }

    fn observe(&mut self, orbit: usize, lane: usize, batch: &mut BatchPropagator) -> OrbitCourse {
        let LyapunovOrbit { space, until, .. } = &self.orbits[orbit];
        let Some(LyapunovLane { course, states, steps, regular_step }) = &mut self.lanes[lane]
        else {
            return OrbitCourse::Over;
        };
        *steps += 1;
        // the motion alone says what lies there
        let (begin, end) = batch.interval(lane);
        if end != *until && regular_step.vanishes_with((end - begin).abs()) {
            return OrbitCourse::Over;
        }
        let mut step = CarriedStep { batch: &mut *batch, lane, states: &mut *states };
        let Ok(renewed) = course.observe(space, &mut step) else { return OrbitCourse::Over };
        if batch.time(lane) >= *until {
            let motion =
                CarriedMotion { settings: self.settings, fixed: self.fixed, steps: *steps };
            // one that does not keep returning is followed again in all directions
            if course.departure().is_none() {
                self.found[orbit] = Some(exponents(space, self.method, course, &motion, None));
            }
            return OrbitCourse::Over;
        }
        if let Some((state, vectors)) = renewed {
            let full = states.join(&state, &vectors);
            if batch.begin(lane, &full, space.parameters()) != LaneStatus::Underway {
                return OrbitCourse::Over;
            }
        }
        OrbitCourse::Until(*until)
    }

    fn leave(&mut self, orbit: usize) {
        self.found[orbit] = None;
    }
}

/// The last step in a lane.
struct CarriedStep<'a> {
    batch: &'a mut BatchPropagator,
    lane: usize,
    states: &'a mut TangentStates,
}

impl CarriedStep<'_> {
    /// The state with its vectors, as they are carried, at a time within the step.
    fn inside(&mut self, time: f64) -> State {
        let mut full = self.batch.state(self.lane).clone();
        if time != full.time {
            self.batch.at(self.lane, time, &mut full);
        }
        full
    }
}

impl TangentStep for CarriedStep<'_> {
    fn interval(&self) -> (f64, f64) {
        self.batch.interval(self.lane)
    }

    fn at(&mut self, time: f64) -> Result<(State, DMatrix<f64>), MotionError> {
        let full = self.inside(time);
        self.states.part(&full)
    }

    fn vector(&mut self, vector: usize, time: f64) -> Result<DVector<f64>, MotionError> {
        let full = self.inside(time);
        self.states.vector(vector, full)
    }

    fn awaits_occurrence(&self) -> bool {
        false
    }
}
