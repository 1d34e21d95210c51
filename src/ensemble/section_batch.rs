//! The crossings of several orbits followed side by side.
//!
//! In: starts, the plan of a section. Out: the crossings that each orbit alone has, to the last bit. Never here: where a
//! surface is crossed, threads.

use super::Start;
use super::section::{
    Crossings, OrbitStatus, SectionPlan, crossings, first_limit, next_limit, stopped_by_a_signal,
    too_coarse,
};
use crate::integrate::{
    BatchPropagator, Follower, LaneStatus, Method, OrbitCourse, Settings, side_by_side,
};
use crate::num::BATCH;
use crate::system::{Observer, State, System};

/// So few orbits are followed one by one: most lanes would be empty.
const FEW: usize = 3;

/// The number of orbits that one thread follows at a time: as many as there are lanes where orbits are followed side by
/// side, otherwise one, so that there is work for all threads.
pub fn section_group(system: &System, method: &'static Method, settings: Settings) -> usize {
    match BatchPropagator::with_events(system, method, settings) {
        Some(_) => BATCH,
        None => 1,
    }
}

/// Follows several orbits from one crossing to the next, side by side where the system and the method allow it. An orbit
/// that could not begin is handed on.
pub fn crossings_of_all(
    system: &System,
    method: &'static Method,
    settings: Settings,
    starts: Vec<Result<Start, Crossings>>,
    plan: &SectionPlan,
) -> Vec<Crossings> {
    let alone = |start: Result<Start, Crossings>| match start {
        Ok(start) => crossings(system, method, settings, &start, plan),
        Err(refused) => refused,
    };
    let together = (starts.len() >= FEW)
        .then(|| BatchPropagator::with_events(system, method, settings))
        .flatten();
    let Some(mut batch) = together else { return starts.into_iter().map(alone).collect() };
    let mut orbits = OrbitsTogether {
        system,
        plan,
        starts: &starts,
        found: vec![OrbitFound::Alone; starts.len()],
        lanes: std::array::from_fn(|_| None),
        values: vec![0.0; plan.width(system)],
        here: State::new(0.0, system.form(), Vec::new()),
    };
    let finished = side_by_side(&mut batch, starts.len(), &mut orbits);
    if !finished {
        orbits.stop();
    }
    let found = orbits.found;
    let results = found.into_iter().zip(starts).map(|(found, start)| match found {
        OrbitFound::Over(crossings) => crossings,
        OrbitFound::Alone => alone(start),
    });
    results.collect()
}

#[derive(Clone)]
enum OrbitFound {
    /// Its crossings.
    Over(Crossings),
    /// Nothing: it has to be followed by itself.
    Alone,
}

struct LaneOrbit {
    orbit: usize,
    observer: Observer,
    rows: Vec<Vec<f64>>,
    /// How far it is followed, and the limit of its steps, as for an orbit alone.
    ahead: (f64, f64),
    steps: u64,
    /// The number of steps at the last crossing.
    last: u64,
}

struct OrbitsTogether<'a> {
    system: &'a System,
    plan: &'a SectionPlan,
    starts: &'a [Result<Start, Crossings>],
    found: Vec<OrbitFound>,
    lanes: [Option<LaneOrbit>; BATCH],
    values: Vec<f64>,
    here: State,
}

impl Follower for OrbitsTogether<'_> {
    fn begin(&mut self, orbit: usize, lane: usize, batch: &mut BatchPropagator) -> OrbitCourse {
        self.found[orbit] = OrbitFound::Alone;
        let Ok(start) = &self.starts[orbit] else { return OrbitCourse::Over };
        let Ok(state) = start.state(self.system) else { return OrbitCourse::Over };
        let regular = batch.begin(lane, &state, &start.parameters) == LaneStatus::Underway;
        if !regular || self.plan.count == Some(0) || self.plan.until == Some(state.time) {
            return OrbitCourse::Over;
        }
        self.here.copy_from(batch.state(lane));
        let ahead = first_limit(self.plan, start.time);
        let observer = self.system.observer(&start.parameters);
        let rows = Vec::new();
        self.lanes[lane] = Some(LaneOrbit { orbit, observer, rows, ahead, steps: 0, last: 0 });
        OrbitCourse::Until(ahead.1)
    }

    fn observe(&mut self, _orbit: usize, lane: usize, batch: &mut BatchPropagator) -> OrbitCourse {
        let course = self.follow(lane, batch);
        if course == OrbitCourse::Over {
            self.lanes[lane] = None;
        }
        course
    }

    fn leave(&mut self, orbit: usize) {
        self.found[orbit] = OrbitFound::Alone;
        let of_orbit =
            |lane: &&mut Option<LaneOrbit>| lane.as_ref().is_some_and(|own| own.orbit == orbit);
        if let Some(lane) = self.lanes.iter_mut().find(of_orbit) {
            *lane = None;
        }
    }
}

impl OrbitsTogether<'_> {
    /// Records the crossings of the last step.
    fn follow(&mut self, lane: usize, batch: &mut BatchPropagator) -> OrbitCourse {
        let Some(own) = &mut self.lanes[lane] else { return OrbitCourse::Over };
        own.steps += 1;
        let (begin, end) = batch.interval(lane);
        // the orbit alone says why
        if own.steps == 1 && too_coarse(end, end - begin).is_some() {
            return OrbitCourse::Over;
        }
        loop {
            let event = match batch.next_event(lane, &mut self.here) {
                // the orbit alone says what is wrong
                Err(_) => return OrbitCourse::Over,
                Ok(None) => break,
                Ok(Some(event)) => event,
            };
            if event.event != self.plan.event {
                continue;
            }
            own.last = own.steps;
            if self.plan.see(&mut own.observer, &self.here, &mut self.values).is_err() {
                return OrbitCourse::Over;
            }
            own.rows.push([&[event.time], &self.values[..]].concat());
            if self.plan.count.is_some_and(|count| own.rows.len() as u64 >= count) {
                return self.complete(lane);
            }
        }
        if let Some(until) = self.plan.until {
            return if end >= until { self.complete(lane) } else { OrbitCourse::Until(until) };
        }
        if own.steps - own.last > self.plan.idle {
            return OrbitCourse::Over;
        }
        while end >= own.ahead.0 {
            own.ahead = next_limit(own.ahead.0, end - begin);
        }
        OrbitCourse::Until(own.ahead.1)
    }

    fn complete(&mut self, lane: usize) -> OrbitCourse {
        if let Some(own) = self.lanes[lane].take() {
            self.found[own.orbit] = OrbitFound::Over(Crossings {
                rows: own.rows,
                status: OrbitStatus::Completed,
                message: None,
            });
        }
        OrbitCourse::Over
    }

    /// Ends all orbits that are not over, with the crossings that they have.
    fn stop(&mut self) {
        for own in self.lanes.iter_mut().filter_map(Option::take) {
            self.found[own.orbit] = OrbitFound::Over(stopped_by_a_signal(own.rows));
        }
        for (found, start) in self.found.iter_mut().zip(self.starts) {
            if !matches!(found, OrbitFound::Over(_)) {
                let stopped = |_: &Start| stopped_by_a_signal(Vec::new());
                *found = OrbitFound::Over(start.as_ref().map_or_else(Clone::clone, stopped));
            }
        }
    }
}
