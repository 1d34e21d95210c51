//! The search for a stationary path between two places, of which nothing else is known.
//!
//! In: a Lagrangian, both ends, a duration. Out: a [`StationaryPath`]. Newton's method begins at the straight line; where it comes to
//! nothing from there, with what the path of a shorter time becomes as the time grows, and then with arcs beside the line. Never here:
//! Newton's method, paths that somebody gives.

use super::action::Lagrangian;
use super::error::DynamicsError;
use super::stationary_path::{StationaryPath, stationary_path};
use crate::num::math;

/// The number of parts in which the time grows.
const PARTS: u32 = 16;

/// The arcs: so many half waves of one coordinate beside the straight line, to both sides, of these heights in the size of both ends,
/// until a path is found.
const HALF_WAVES: [f64; 2] = [1.0, 2.0];
const HEIGHTS: [f64; 3] = [0.3, 1.0, 3.0];

/// The number of intervals at whose ends paths are compared.
const COMPARED: u32 = 64;

/// Finds a stationary path between two places.
///
/// # Errors
/// Returns the error from the straight line, if Newton's method comes to none from the others either, or the search is cancelled.
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
        Ok(path) => return Ok(path),
        Err(why) if lagrangian.is_cancelled() => return Err(why),
        Err(why) => why,
    };
    if let Some(path) = continued(lagrangian, &straight, duration) {
        return Ok(path);
    }
    let size = from.iter().chain(to).fold(0.0_f64, |most, x| most.max(x.abs()));
    let size = if size > 0.0 { size } else { 1.0 };
    let mut nearest: Option<(f64, StationaryPath)> = None;
    for height in HEIGHTS {
        let sides = [height, -height].into_iter().flat_map(|h| HALF_WAVES.map(|waves| (h, waves)));
        let arcs = (0..from.len()).flat_map(|k| sides.clone().map(move |(h, w)| (k, h, w)));
        for (coordinate, height, waves) in arcs {
            if lagrangian.is_cancelled() {
                return Err(first);
            }
            let arc = |time: f64| {
                let mut place = straight(time / duration);
                if time > 0.0 && time < duration {
                    let angle = waves * std::f64::consts::PI * time / duration;
                    place[coordinate] += height * size * math::sin(angle);
                }
                place
            };
            let Ok(path) = stationary_path(lagrangian, &arc, duration) else { continue };
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
    nearest.map(|(_, path)| path).ok_or(first)
}

/// What the path of a short time, which is nearly straight, becomes as the time grows; `None` where it ends on the way.
fn continued(
    lagrangian: &mut Lagrangian,
    straight: &dyn Fn(f64) -> Vec<f64>,
    duration: f64,
) -> Option<StationaryPath> {
    let mut path: Option<StationaryPath> = None;
    for k in 1..=PARTS {
        let shorter = duration * f64::from(k) / f64::from(PARTS);
        let before = path.take();
        let guess = |time: f64| {
            let part = time / shorter;
            match &before {
                Some(path) if part > 0.0 && part < 1.0 => {
                    let last = shorter - duration / f64::from(PARTS);
                    let mut place = path.at(part * last);
                    place.truncate(straight(part).len());
                    place
                }
                _ => straight(part),
            }
        };
        path = Some(stationary_path(lagrangian, &guess, shorter).ok()?);
    }
    path
}
