//! Orbits followed side by side, a new one in every lane whose orbit is over.
//!
//! In: how many orbits, and what is done with each: a [`Follower`]. Out: what that keeps. Never here: what is seen of an
//! orbit, threads.

use super::{BatchPropagator, LaneStatus};
use crate::num::BATCH;

/// Whether an orbit is to be followed further.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum OrbitCourse {
    /// No farther than this time.
    Until(f64),
    /// It is over, or it has not begun.
    Over,
}

/// What is done with each of several orbits that are followed side by side.
pub trait Follower {
    /// Puts an orbit into a lane.
    fn begin(&mut self, orbit: usize, lane: usize, batch: &mut BatchPropagator) -> OrbitCourse;

    /// The time up to which an orbit that is under way need not be observed.
    fn next_observation(&self, _orbit: usize) -> f64 {
        f64::NEG_INFINITY
    }

    /// Observes all lanes after a step, before each orbit is observed by itself.
    fn observe_all(&mut self, _batch: &mut BatchPropagator) {}

    /// Looks at an orbit after a step.
    fn observe(&mut self, orbit: usize, lane: usize, batch: &mut BatchPropagator) -> OrbitCourse;

    /// An orbit has to be followed alone, from its beginning.
    fn leave(&mut self, orbit: usize);
}

/// Follows all orbits, several at a time. Returns false if it was cancelled.
pub fn side_by_side(
    batch: &mut BatchPropagator,
    orbits: usize,
    follower: &mut impl Follower,
) -> bool {
    let mut waiting = 0..orbits;
    let mut places: [Option<usize>; BATCH] = [None; BATCH];
    let mut limits = [0.0; BATCH];
    loop {
        for lane in 0..BATCH {
            while places[lane].is_none() {
                let Some(orbit) = waiting.next() else { break };
                if let OrbitCourse::Until(limit) = follower.begin(orbit, lane, batch) {
                    (places[lane], limits[lane]) = (Some(orbit), limit);
                }
            }
            if places[lane].is_none() {
                batch.clear(lane);
            }
        }
        if places.iter().all(Option::is_none) {
            return true;
        }
        let observed =
            |place: Option<usize>| place.map_or(f64::INFINITY, |i| follower.next_observation(i));
        if !batch.steps_unobserved(&limits, &places.map(observed)) {
            return false;
        }
        follower.observe_all(batch);
        for (lane, place) in places.iter_mut().enumerate() {
            let Some(orbit) = *place else { continue };
            if batch.status(lane) == LaneStatus::Irregular {
                follower.leave(orbit);
                *place = None;
            } else if let OrbitCourse::Until(limit) = follower.observe(orbit, lane, batch) {
                limits[lane] = limit;
            } else {
                *place = None;
            }
        }
    }
}
