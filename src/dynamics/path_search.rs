//! The search for a stationary path between two places, of which nothing else is known.
//!
//! In: a Lagrangian, both ends, a duration. Out: a [`StationaryPath`]. Newton's method begins at the straight line; where it comes to
//! nothing from there, with what the path of a shorter time becomes as the time grows, and then with arcs beside the line. Never here:
//! Newton's method, paths that somebody gives.

use super::action::Lagrangian;
use super::error::DynamicsError;
use super::stationary_path::{StationaryPath, stationary_path};
use crate::num::math;

/// The number of steps in which the duration grows.
const STEPS: u32 = 16;

/// The arcs: so many half waves of one coordinate beside the straight line, to both sides, of these heights in the size of both ends,
/// until a path is found.
const HALF_WAVES: [f64; 2] = [1.0, 2.0];
const HEIGHTS: [f64; 3] = [0.3, 1.0, 3.0];

/// The number of intervals at whose ends paths are compared.
const COMPARED: u32 = 64;

/// Finds a stationary path between two places.
///
/// # Errors
/// Returns the error from the straight line, if Newton's method comes to none from the others either, or the search is cancelled;
/// and the first path that is not resolved, as it will be from elsewhere.
pub fn stationary_path_between(
    lagrangian: &mut Lagrangian,
    [from, to]: [&[f64]; 2],
    duration: f64,
) -> Result<StationaryPath, DynamicsError> {
    let straight = |part: f64| -> Vec<f64> {
        let between = |(a, b): (&f64, &f64)| if part == 1.0 { *b } else { a + part * (b - a) };
        from.iter().zip(to).map(between).collect()
    };
    let first = match stationary_path(lagrangian, &|t| straight(t / duration), duration) {
        Err(why @ DynamicsError::Unsuited(_)) if !lagrangian.is_cancelled() => why,
        outcome => return outcome,
    };
    let elsewhere = |lagrangian: &mut Lagrangian| {
        match continued(lagrangian, &straight, duration) {
            Err(DynamicsError::Unsuited(_)) => {}
            outcome => return outcome.map(Some),
        }
        from_arcs(lagrangian, [from, to], &straight, duration)
    };
    lagrangian.within_budget(elsewhere)?.ok_or(first)
}

/// The path nearest to the straight line that Newton's method comes to from arcs of the least height that leads to one.
fn from_arcs(
    lagrangian: &mut Lagrangian,
    [from, to]: [&[f64]; 2],
    straight: &dyn Fn(f64) -> Vec<f64>,
    duration: f64,
) -> Result<Option<StationaryPath>, DynamicsError> {
    let size = from.iter().chain(to).fold(0.0_f64, |most, x| most.max(x.abs()));
    let size = if size > 0.0 { size } else { 1.0 };
    let mut nearest: Option<(f64, StationaryPath)> = None;
    for height in HEIGHTS {
        let sides = [height, -height].into_iter().flat_map(|h| HALF_WAVES.map(|waves| (h, waves)));
        let arcs = (0..from.len()).flat_map(|k| sides.clone().map(move |(h, w)| (k, h, w)));
        for (coordinate, height, waves) in arcs {
            if lagrangian.is_over() {
                return Ok(nearest.map(|(_, path)| path));
            }
            let arc = |time: f64| {
                let mut place = straight(time / duration);
                if time > 0.0 && time < duration {
                    let angle = waves * std::f64::consts::PI * time / duration;
                    place[coordinate] += height * size * math::sin(angle);
                }
                place
            };
            let path = match stationary_path(lagrangian, &arc, duration) {
                Ok(path) => path,
                Err(DynamicsError::Unsuited(_)) => continue,
                Err(why) if nearest.is_none() => return Err(why),
                Err(_) => continue,
            };
            let apart = |k: u32| -> f64 {
                let part = f64::from(k) / f64::from(COMPARED);
                let both = straight(part).into_iter().zip(path.at(part * duration));
                both.map(|(a, b)| (a - b) * (a - b)).sum()
            };
            let away = (1..COMPARED).map(apart).sum::<f64>();
            if nearest.as_ref().is_none_or(|(least, _)| away < *least) {
                nearest = Some((away, path));
            }
        }
        if nearest.is_some() {
            break;
        }
    }
    Ok(nearest.map(|(_, path)| path))
}

/// What the path of a short time, which is nearly straight, becomes as the time grows.
fn continued(
    lagrangian: &mut Lagrangian,
    straight: &dyn Fn(f64) -> Vec<f64>,
    duration: f64,
) -> Result<StationaryPath, DynamicsError> {
    let step = duration / f64::from(STEPS);
    let mut path = stationary_path(lagrangian, &|time| straight(time / step), step)?;
    for k in 2..=STEPS {
        let (before, now) = (step * f64::from(k - 1), step * f64::from(k));
        let guess = |time: f64| match time / now {
            part if part > 0.0 && part < 1.0 => {
                let mut place = path.at(part * before);
                place.truncate(place.len() / 2);
                place
            }
            part => straight(part),
        };
        path = stationary_path(lagrangian, &guess, now)?;
    }
    Ok(path)
}
