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

/// Finds a stationary path between two places, beginning with the straight line and then with curves beside it.
///
/// # Errors
/// Returns the error of the first path that is not resolved, or else that from the straight line, if Newton's method comes to none from
/// the others either, or the search is cancelled. Where L has kinks, a path that is not resolved ends the search: it will not be from
/// elsewhere either.
pub fn stationary_path_between(
    lagrangian: &mut Lagrangian,
    [from, to]: [&[f64]; 2],
    duration: f64,
) -> Result<StationaryPath, DynamicsError> {
    let straight = |part: f64| -> Vec<f64> {
        let between = |(a, b): (&f64, &f64)| if part == 1.0 { *b } else { a + part * (b - a) };
        from.iter().zip(to).map(between).collect()
    };
    let mut failed = match stationary_path(lagrangian, &|t| straight(t / duration), duration) {
        Err(why) if !lagrangian.is_cancelled() && !is_final(lagrangian, &why) => why,
        outcome => return outcome,
    };
    lagrangian.within_budget(|lagrangian| {
        match continued(lagrangian, &straight, duration) {
            None => {}
            Some(Err(why)) if !is_final(lagrangian, &why) => failed = clearer(failed, why),
            Some(outcome) => return outcome,
        }
        from_arcs(lagrangian, [from, to], (&straight, duration), failed)
    })
}

/// Whether no other path is resolved where this one is not.
fn is_final(lagrangian: &Lagrangian, why: &DynamicsError) -> bool {
    lagrangian.has_switches() && matches!(why, DynamicsError::Unresolved(_))
}

/// The error that says more: that of the first path there is, though it is not resolved.
fn clearer(failed: DynamicsError, why: DynamicsError) -> DynamicsError {
    match (&failed, &why) {
        (DynamicsError::Unsuited(_), DynamicsError::Unresolved(_)) => why,
        _ => failed,
    }
}

/// The path nearest to the straight line that Newton's method comes to from arcs of the least height that leads to one.
fn from_arcs(
    lagrangian: &mut Lagrangian,
    [from, to]: [&[f64]; 2],
    (straight, duration): (&dyn Fn(f64) -> Vec<f64>, f64),
    mut failed: DynamicsError,
) -> Result<StationaryPath, DynamicsError> {
    let size = from.iter().chain(to).fold(0.0_f64, |most, x| most.max(x.abs()));
    let size = if size > 0.0 { size } else { 1.0 };
    let mut nearest: Option<(f64, StationaryPath)> = None;
    for height in HEIGHTS {
        let sides = [height, -height].into_iter().flat_map(|h| HALF_WAVES.map(|waves| (h, waves)));
        let arcs = (0..from.len()).flat_map(|k| sides.clone().map(move |(h, w)| (k, h, w)));
        for (coordinate, height, waves) in arcs {
            if lagrangian.is_over() {
                return nearest.map(|(_, path)| path).ok_or(failed);
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
                Err(why) if nearest.is_none() && is_final(lagrangian, &why) => return Err(why),
                Err(why) => {
                    failed = clearer(failed, why);
                    continue;
                }
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
    nearest.map(|(_, path)| path).ok_or(failed)
}

/// What the path of a short time, which is nearly straight, becomes as the time grows.
fn continued(
    lagrangian: &mut Lagrangian,
    straight: &dyn Fn(f64) -> Vec<f64>,
    duration: f64,
) -> Option<Result<StationaryPath, DynamicsError>> {
    let step = duration / f64::from(STEPS);
    let mut path = stationary_path(lagrangian, &|time| straight(time / step), step).ok()?;
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
        let found = stationary_path(lagrangian, &guess, now);
        if k == STEPS {
            return Some(found);
        }
        path = found.ok()?;
    }
    None
}
