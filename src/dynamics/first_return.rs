//! The returns of a motion near its start, from which the search for a periodic orbit begins.
//!
//! In: a state. Out: a time, or why there is none: what was searched for, for how long. Never here: whether an orbit closes.

use nalgebra::{DMatrix, DVector};

use super::carrier::Carrier;
use super::error::DynamicsError;
use super::phase_space::PhaseSpace;
use crate::integrate::{Method, Settings, Stepping};
use crate::num::{DoubleDouble, short};
use crate::system::State;

/// The steps in which a return to the start is searched for, of a series and of a fixed size.
const SEARCHED_STEPS: u64 = 600;
const SEARCHED_FIXED_STEPS: u64 = 20_000;

/// A time later than any return, in any units; the square of a distance covered in it is a number.
const ENDLESS: f64 = 1e150;

/// Where impulses may act, a step ends so much later than it begins, or this much longer than the one before.
const FIRST_SPAN: f64 = 1.0;
const GROWTH: f64 = 8.0;

/// A return this near, relative to the farthest distance, is taken at once.
const NEAR: f64 = 0.2;

/// A return up to this distance is taken if there is no nearer one.
const FAR: f64 = 0.5;

/// The difference of two states, exact, and less whole periods of the coordinates.
pub(super) fn difference(space: &PhaseSpace, end: &State, start: &State) -> DVector<f64> {
    DVector::from_fn(space.dimension(), |i, _| {
        let apart = end.exact(i) - start.exact(i);
        match space.periods()[i] {
            Some(period) => {
                let turns = (apart.high / period).round();
                (apart - DoubleDouble::from(period) * turns).high
            }
            None => apart.high,
        }
    })
}

/// The time of a return near the start, after as many others.
pub(super) fn return_near(
    space: &PhaseSpace,
    (method, settings): (&'static Method, Settings),
    start: &State,
    others: usize,
) -> Result<f64, DynamicsError> {
    let mut carrier = Carrier::new(space, method, settings, 0)?;
    carrier.start(start, &DMatrix::zeros(space.dimension(), 0))?;
    let fixed = method.stepping == Stepping::Fixed;
    let (steps, parts) = if fixed { (SEARCHED_FIXED_STEPS, 1) } else { (SEARCHED_STEPS, 16) };
    let mut extent = vec![0.0_f64; space.dimension()];
    let mut seen: Vec<(f64, DVector<f64>)> = vec![(start.time, DVector::zeros(space.dimension()))];
    let mut best: Option<(f64, f64)> = None;
    let mut stopped = None;
    'looking: for step in 1..=steps {
        let (before, now) = carrier.interval();
        // a step of free motion has no end by itself, and in one that is too long no event is found
        let limit = match (space.has_jumps(), fixed) {
            (true, _) => now + (GROWTH * (now - before)).max(FIRST_SPAN),
            (false, true) => f64::INFINITY,
            (false, false) => ENDLESS,
        };
        if let Err(why) = carrier.step(limit) {
            let why = DynamicsError::from(why);
            if why.is_cancelled() {
                return Err(why);
            }
            stopped = Some(why.to_string());
            break;
        }
        let (begin, end) = carrier.interval();
        for part in 1..=parts {
            let now = begin + (end - begin) * f64::from(part) / f64::from(parts);
            let state = match carrier.at(now) {
                Ok((state, _)) => state,
                Err(why) => {
                    stopped = Some(why.to_string());
                    break 'looking;
                }
            };
            let apart = difference(space, &state, start);
            for (extent, x) in extent.iter_mut().zip(apart.iter()) {
                *extent = extent.max(x.abs());
            }
            seen.push((now, apart));
        }
        // a look at all of them costs as much as they are
        if fixed && step % 64 != 0 {
            continue;
        }
        let distance = |apart: &DVector<f64>| {
            let parts = apart.iter().zip(&extent).filter(|(_, extent)| **extent > 0.0);
            parts.map(|(x, extent)| (x / extent) * (x / extent)).sum::<f64>().sqrt()
        };
        let all: Vec<f64> = seen.iter().map(|(_, apart)| distance(apart)).collect();
        let farthest = all.iter().copied().fold(0.0, f64::max);
        let (mut left, mut passed) = (false, 0);
        best = None;
        for k in 1..all.len() - 1 {
            left |= all[k] > 0.6 * farthest;
            if left && all[k] <= all[k - 1] && all[k] <= all[k + 1] {
                let part = all[k] / farthest;
                if part < NEAR {
                    passed += 1;
                }
                if passed > others {
                    return Ok(seen[k].0 - start.time);
                }
                if best.is_none_or(|(least, _)| part < least) {
                    best = Some((part, seen[k].0 - start.time));
                }
            }
        }
    }
    match best {
        Some((part, time)) if part < FAR && others == 0 => Ok(time),
        _ => {
            let rests = extent.iter().all(|extent| *extent == 0.0);
            let why = no_return(space, best, seen[seen.len() - 1].0 - start.time, (rests, stopped));
            let returns = best.is_some() && others == 0;
            Err(if returns { DynamicsError::Unclosed(why) } else { DynamicsError::Unsuited(why) })
        }
    }
}

/// Why no return was found: what was searched for, for how long, and what would help.
fn no_return(
    space: &PhaseSpace,
    best: Option<(f64, f64)>,
    time: f64,
    (rests, stopped): (bool, Option<String>),
) -> String {
    let found = match best {
        None if rests => {
            return "no periodic orbit to begin with: the start is an equilibrium, from which nothing moves away".to_owned();
        }
        Some((part, at)) => {
            format!("came back no nearer than {:.0} % of it, after {}", 100.0 * part, short(at))
        }
        None => "only moved away from its start".to_owned(),
    };
    let stopped = stopped.map_or(String::new(), |why| format!("; then {why}"));
    format!(
        "no periodic orbit to begin with: a return of ({}) to within {:.0} % of the farthest distance from the start was searched for over a time of {}, and the motion {found}{stopped}. Begin nearer to a periodic orbit, or give \
         its period",
        space.names().join(", "),
        100.0 * FAR,
        short(time)
    )
}
