//! States carried by the flow of a system, and what is seen of them at given times.
//!
//! In: a system, a method, a state. Out: channels at the times, and the state at the last of them, from which it can be
//! carried on. Never here: which states, pictures.

use std::ops::ControlFlow;

use super::pool::{PoolError, in_order};
use crate::integrate::{
    BatchPropagator, Follower, LaneStatus, METHODS, Method, OrbitCourse, Propagator, Reached,
    Settings, Stepping, side_by_side,
};
use crate::num::BATCH;
use crate::system::{MotionError, Observer, State, System};

/// The states that one thread carries at a time.
const GROUP: usize = 64;

/// The steps between two checks of the token.
const STEPS_PER_CHECK: u64 = 64;

/// The flow of a system at fixed parameters, by a method.
#[derive(Clone)]
pub struct SystemFlow {
    /// The compiled law.
    pub system: System,
    /// The method, and its step or tolerance.
    pub method: (&'static Method, Settings),
    /// Those of all its motions, in the order of the model.
    pub parameters: Vec<f64>,
    /// The time at which the motion of the system began, from which periodic impulses count.
    pub start: f64,
    /// The most steps of an orbit from the first of some times to the last; one that takes more is given up.
    pub effort: Option<u64>,
}

/// A state that was carried.
#[derive(Clone, Debug, Default)]
pub struct Carried {
    /// The channels at each time, up to where the motion could be followed.
    pub seen: Vec<Vec<f64>>,
    /// The state at the last time; `None` if it did not get there.
    pub end: Option<State>,
}

impl SystemFlow {
    /// The same flow with the step that a fixed method chooses at a state, so that it is one map for all states.
    #[must_use]
    pub fn settled(mut self, at: &State) -> SystemFlow {
        let (method, settings) = self.method;
        if method.stepping == Stepping::Fixed
            && settings.step.is_none()
            && let Ok(mut motion) =
                Propagator::new(&self.system, method, settings, &self.parameters)
            && motion.begin(at, &self.parameters).is_ok()
        {
            let step = Some(motion.step_size().abs()).filter(|step| step.is_normal());
            self.method.1.step = step;
        }
        self
    }

    /// The times within a duration at which the equal steps of a fixed method end, from a state on, counted from it: its dense
    /// output has corners there. None for another method. At most so many.
    pub fn step_ends(&self, from: &State, duration: f64, most: usize) -> Vec<f64> {
        let (method, settings) = self.clone().settled(from).method;
        match settings.step {
            Some(step) if method.stepping == Stepping::Fixed => {
                let ends = (1..=most).map(|k| k as f64 * step);
                ends.take_while(|&end| end < duration).collect()
            }
            _ => Vec::new(),
        }
    }

    /// The same flow in plain `f64` where no other tolerance is asked for: orbits are then carried side
    /// by side, and a picture of many does not show the difference.
    #[must_use]
    pub fn fast(mut self) -> SystemFlow {
        let (method, settings) = self.method;
        self.method.1 = method.fast(settings);
        self
    }

    /// Carries a state forwards through these times, which do not decrease and are not before it, and reads these channels
    /// at each.
    pub fn carry(&self, from: &State, times: &[f64], channels: &[usize]) -> Carried {
        let mut carried = Carried::default();
        // where it ends early is what is there
        let from = (from, &self.parameters[..]);
        let end = self.follow(from, times, channels, &mut carried.seen);
        carried.end = end.ok().flatten();
        carried
    }

    /// The same flow by the default method, which shows the errors of a method of fixed step; `None` where the steps follow a
    /// tolerance anyway.
    pub fn by_default_method(&self) -> Option<SystemFlow> {
        let fixed = self.method.0.stepping == Stepping::Fixed;
        fixed.then(|| SystemFlow { method: (&METHODS[0], Settings::default()), ..self.clone() })
    }

    /// Carries many states on all cores, several of them side by side where the system and the method
    /// allow it, as each would be carried alone, to the last bit. `done` is called with the number of states carried so far.
    ///
    /// # Errors
    /// Returns an error if there are no threads.
    pub fn carry_all(
        &self,
        from: &[Option<&State>],
        times: &[f64],
        channels: &[usize],
        mut done: impl FnMut(u64),
    ) -> Result<Vec<Carried>, PoolError> {
        let mut all = Vec::with_capacity(from.len());
        let groups: Vec<&[Option<&State>]> = from.chunks(GROUP).collect();
        let one = |group: usize| {
            let own = |&state| (state, &self.parameters[..]);
            let group: Vec<_> = groups[group].iter().map(own).collect();
            self.carry_each(&group, times, channels)
        };
        in_order(0, groups.len(), self.system.cancel(), one, |_, carried| {
            all.extend(carried);
            done(all.len() as u64);
            ControlFlow::Continue(())
        })?;
        Ok(all)
    }

    /// How many states [`SystemFlow::carry_each`] is best given at a time: as many as there are lanes where states are
    /// carried side by side, otherwise one, so that there is work for all threads.
    pub fn group(&self) -> usize {
        let (method, settings) = self.method;
        match BatchPropagator::new(&self.system.without_marks(), method, settings) {
            Some(_) => BATCH,
            None => 1,
        }
    }

    /// Carries states, each with parameters of its own in place of those of the flow, on this thread, several of them side
    /// by side as [`SystemFlow::carry_all`] does.
    pub fn carry_each(
        &self,
        from: &[(Option<&State>, &[f64])],
        times: &[f64],
        channels: &[usize],
    ) -> Vec<Carried> {
        let alone = |(state, parameters): (Option<&State>, &[f64])| {
            let mut carried = Carried::default();
            if let Some(state) = state {
                let seen = &mut carried.seen;
                // where it ends early is what is there
                let end = self.follow((state, parameters), times, channels, seen);
                carried.end = end.ok().flatten();
            }
            carried
        };
        let (method, settings) = self.method;
        match BatchPropagator::new(&self.system.without_marks(), method, settings) {
            Some(mut batch) => {
                let mut together = CarriedTogether {
                    system: &self.system,
                    from,
                    times,
                    channels,
                    sights: std::array::from_fn(|_| None),
                    here: State::new(0.0, self.system.form(), Vec::new()),
                    carried: vec![Some(Carried::default()); from.len()],
                    effort: self.effort,
                    steps: [0; BATCH],
                };
                // what a cancellation leaves is not asked for
                side_by_side(&mut batch, from.len(), &mut together);
                let carried = together.carried.into_iter().zip(from);
                carried.map(|(one, &own)| one.unwrap_or_else(|| alone(own))).collect()
            }
            None => from.iter().map(|&own| alone(own)).collect(),
        }
    }

    fn follow(
        &self,
        (from, parameters): (&State, &[f64]),
        times: &[f64],
        channels: &[usize],
        seen: &mut Vec<Vec<f64>>,
    ) -> Result<Option<State>, MotionError> {
        let (method, settings) = self.method;
        let system = self.system.without_marks();
        let Ok(mut motion) = Propagator::new(&system, method, settings, parameters) else {
            return Ok(None);
        };
        motion.restore(from, parameters, self.start, &[])?;
        let mut sight = FlowObserver::new(motion.system(), parameters, channels);
        let last = times.last().copied().unwrap_or(from.time);
        for &time in times {
            loop {
                let left = self.effort.map_or(u64::MAX, |most| most.saturating_sub(motion.steps()));
                match motion.reach_unexplained(time, last, &mut STEPS_PER_CHECK.min(left))? {
                    Reached::Arrived => break,
                    Reached::Ended => return Ok(None),
                    Reached::OutOfBudget | Reached::Occurred(_) => {}
                }
                let given_up = self.effort.is_some_and(|most| motion.steps() >= most);
                if given_up || self.system.cancel().is_cancelled() {
                    return Ok(None);
                }
            }
            seen.push(sight.of(motion.state())?);
        }
        Ok(Some(motion.state().clone()))
    }
}

struct FlowObserver<'a> {
    observer: Observer,
    channels: &'a [usize],
    /// Whether all channels are columns: those after them are computed only where one is read.
    leading: bool,
    values: Vec<f64>,
}

impl FlowObserver<'_> {
    fn new<'a>(system: &System, parameters: &[f64], channels: &'a [usize]) -> FlowObserver<'a> {
        let columns = system.columns();
        let leading = channels.iter().all(|&channel| channel < columns);
        let count = if leading { columns } else { system.channels().len() };
        let (observer, values) = (system.observer(parameters), vec![0.0; count]);
        FlowObserver { observer, channels, leading, values }
    }

    fn of(&mut self, state: &State) -> Result<Vec<f64>, MotionError> {
        if self.leading {
            self.observer.observe_columns(state, &mut self.values)?;
        } else {
            self.observer.observe(state, &mut self.values)?;
        }
        Ok(self.channels.iter().map(|&c| self.values[c]).collect())
    }
}

/// States carried side by side.
struct CarriedTogether<'a> {
    system: &'a System,
    from: &'a [(Option<&'a State>, &'a [f64])],
    times: &'a [f64],
    channels: &'a [usize],
    /// What is seen in each lane, and with which parameters.
    sights: [Option<(&'a [f64], FlowObserver<'a>)>; BATCH],
    here: State,
    /// What becomes of each state; `None` for what has to be carried alone.
    carried: Vec<Option<Carried>>,
    effort: Option<u64>,
    /// The steps of the orbit in each lane.
    steps: [u64; BATCH],
}

impl Follower for CarriedTogether<'_> {
    fn begin(&mut self, orbit: usize, lane: usize, batch: &mut BatchPropagator) -> OrbitCourse {
        let (Some(state), parameters) = self.from[orbit] else { return OrbitCourse::Over };
        if batch.begin(lane, state, parameters) == LaneStatus::Irregular {
            self.carried[orbit] = None;
            return OrbitCourse::Over;
        }
        if self.sights[lane].as_ref().is_none_or(|(known, _)| *known != parameters) {
            let sight = FlowObserver::new(self.system, parameters, self.channels);
            self.sights[lane] = Some((parameters, sight));
        }
        self.steps[lane] = 0;
        self.seen(orbit, lane, batch)
    }

    fn next_observation(&self, orbit: usize) -> f64 {
        let seen = self.carried[orbit].as_ref().map_or(0, |one| one.seen.len());
        self.times.get(seen).copied().unwrap_or(f64::NEG_INFINITY)
    }

    fn observe(&mut self, orbit: usize, lane: usize, batch: &mut BatchPropagator) -> OrbitCourse {
        self.steps[lane] += 1;
        let course = self.seen(orbit, lane, batch);
        let given_up = self.effort.is_some_and(|most| self.steps[lane] >= most);
        if given_up { OrbitCourse::Over } else { course }
    }

    fn leave(&mut self, orbit: usize) {
        self.carried[orbit] = None;
    }
}

impl CarriedTogether<'_> {
    /// Reads the channels at all times that have been reached.
    fn seen(&mut self, orbit: usize, lane: usize, batch: &mut BatchPropagator) -> OrbitCourse {
        let (Some(one), Some((_, sight))) = (&mut self.carried[orbit], &mut self.sights[lane])
        else {
            return OrbitCourse::Over;
        };
        let Some(&last) = self.times.last() else {
            one.end = Some(batch.state(lane).clone());
            return OrbitCourse::Over;
        };
        let known = batch.time(lane);
        while let Some(&time) = self.times.get(one.seen.len()) {
            if time > known {
                return OrbitCourse::Until(last);
            }
            batch.at(lane, time, &mut self.here);
            match sight.of(&self.here) {
                Ok(row) => one.seen.push(row),
                Err(_) => return OrbitCourse::Over,
            }
        }
        one.end = Some(self.here.clone());
        OrbitCourse::Over
    }
}
