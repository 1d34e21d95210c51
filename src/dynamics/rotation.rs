//! The rotation number of an orbit on a surface of section: the mean part of a turn from one crossing to the next.
//!
//! It is a weighted Birkhoff average, which converges faster than any power of the number of crossings where the orbit is
//! quasi-periodic, and as slowly as the mean of random numbers where it is chaotic (E. Sander and J. D. Meiss, Physica D
//! 411 (2020) 132569); how far the averages of parts of the orbit differ distinguishes one from the other. Where an axis is an angle
//! that goes round, its turns are counted; else those around the middle of the orbit, from the vertical axis towards
//! the horizontal one, as a point of (q, p) moves. The turn between two crossings is known but for whole ones: they are cut
//! where no turn of the orbit lies, so that number is in [0, 1).
//!
//! In: points in the order of the crossings. Out: the number with its error, or why there is none. Never here: motions.

use std::f64::consts::TAU;

use super::wandering::{Wandering, parts_apart};
use crate::num::{birkhoff_average, math, short};

/// The fewest crossings of which a rotation number is given.
const FEWEST: usize = 16;

/// The widest part of a turn that no turn of the orbit lies in is at least this wide.
const GAP: f64 = 0.05;

/// The points of an orbit with a rotation number differ by more than this part of their size.
const SPREAD: f64 = 1e-9;

/// An average converges if its parts differ by less than this over the number of crossings.
const CONVERGED: f64 = 0.05;

/// It does not, as in chaos, if they differ by more than this over the root of that number, as means of random numbers do.
/// Regular ones without a rotation number yet may be above it: those that do not wander are not called chaotic.
const RANDOM: f64 = 0.25;

/// By which angle the turns of an orbit are counted.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Turning {
    /// The angle on this axis.
    Axis(usize),
    /// The orbit around its middle.
    Middle,
}

/// The rotation number of an orbit.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Rotation {
    /// Turns from one crossing to the next.
    pub number: f64,
    /// The largest difference between the averages of the first half, the middle half and the last half of the orbit.
    pub error: f64,
    /// The kind of turns that were counted.
    pub turning: Turning,
}

/// Why an orbit has no rotation number.
#[derive(Clone, Copy, PartialEq, Debug, thiserror::Error)]
pub enum NoRotation {
    /// There are too few crossings.
    #[error("{0} crossings are too few for it; it takes {FEWEST}")]
    TooFew(usize),
    /// A number is not finite.
    #[error("a crossing is not finite")]
    NotFinite,
    /// All crossings are at one point.
    #[error("all crossings are at one point")]
    OnePoint,
    /// The orbit does not go once around.
    #[error("the orbit does not go once round its middle")]
    NotAround,
    /// Turns do not average though the orbit is regular: its middle lies beside it, or it is bent.
    #[error("the orbit is regular, but its turns round its middle do not average")]
    NotEnclosing,
    /// Turns of all sizes occur.
    #[error("it does not converge: turns of all sizes occur, as in chaos")]
    AllTurns,
    /// The average of parts of the orbit differs.
    #[error("it does not converge: averages of parts of the orbit differ by {}, as in chaos", short(*.0))]
    Diverges(f64),
    /// The average of parts of the orbit differs, by less than that of random numbers.
    #[error("it has not converged: averages of parts of the orbit differ by {}; whether it is regular is not decided", short(*.0))]
    Undecided(f64),
}

/// The rotation number of an orbit by its points on a section, and the periods of the axes that are angles.
///
/// # Errors
/// Returns why there is none: the orbit is chaotic, does not go round anything, or crosses too rarely.
pub fn rotation(points: &[[f64; 2]], periods: [Option<f64>; 2]) -> Result<Rotation, NoRotation> {
    if points.len() < FEWEST {
        return Err(NoRotation::TooFew(points.len()));
    }
    if points.iter().flatten().any(|x| !x.is_finite()) {
        return Err(NoRotation::NotFinite);
    }
    let round = (0..2).find_map(|axis| Some((axis, periods[axis].filter(|p| *p > 0.0)?)));
    let round = round.filter(|&(axis, period)| extent(points, axis) >= period);
    let found = match round {
        Some(round) => along(points, round),
        None => turned(points),
    };
    judged(found, points, periods, round.is_some())
}

/// An average turn that does not converge, judged by whether the orbit wanders: turns around a middle that an orbit does not enclose
/// are no smooth function of where it is.
fn judged(
    found: Result<Rotation, NoRotation>,
    points: &[[f64; 2]],
    periods: [Option<f64>; 2],
    is_angle: bool,
) -> Result<Rotation, NoRotation> {
    let Err(NoRotation::AllTurns | NoRotation::Diverges(_)) = found else { return found };
    let wandering = Wandering::of(points, periods);
    if wandering.is_random {
        found
    } else if is_angle || wandering.apart * points.len() as f64 > CONVERGED {
        let differ =
            if let Err(NoRotation::Diverges(differ)) = found { differ } else { wandering.apart };
        Err(NoRotation::Undecided(differ))
    } else {
        Err(NoRotation::NotEnclosing)
    }
}

/// The rotation number by the average turn of an angle.
fn along(points: &[[f64; 2]], (axis, period): (usize, f64)) -> Result<Rotation, NoRotation> {
    let turns: Vec<f64> =
        points.windows(2).map(|pair| (pair[1][axis] - pair[0][axis]) / period).collect();
    averaged(&turns, Turning::Axis(axis))
}

/// The rotation number by the average turn around the middle of the orbit.
fn turned(points: &[[f64; 2]]) -> Result<Rotation, NoRotation> {
    let turns = around(points)?;
    let found = averaged(&turns, Turning::Middle)?;
    let whole = found.number.round();
    if (found.number - whole).abs() * turns.len() as f64 <= 1.0 {
        return Err(NoRotation::NotAround);
    }
    Ok(Rotation { number: found.number.rem_euclid(1.0), ..found })
}

/// The rotation number of an angle alone, with whole turns.
///
/// # Errors
/// Returns why there is none.
pub fn angle_rotation(angle: &[f64], period: f64) -> Result<Rotation, NoRotation> {
    if angle.len() < FEWEST {
        return Err(NoRotation::TooFew(angle.len()));
    }
    if angle.iter().any(|x| !x.is_finite()) {
        return Err(NoRotation::NotFinite);
    }
    let points: Vec<[f64; 2]> = angle.iter().map(|&x| [x, 0.0]).collect();
    judged(along(&points, (0, period)), &points, [Some(period), None], true)
}

fn averaged(turns: &[f64], turning: Turning) -> Result<Rotation, NoRotation> {
    let (number, apart) = (birkhoff_average(turns), parts_apart(turns));
    let error = apart.max(f64::EPSILON * number.abs());
    let count = turns.len() as f64;
    if error * count > CONVERGED {
        let random = error * count.sqrt() > RANDOM;
        return Err(if random {
            NoRotation::Diverges(error)
        } else {
            NoRotation::Undecided(error)
        });
    }
    Ok(Rotation { number, error, turning })
}

fn extent(points: &[[f64; 2]], axis: usize) -> f64 {
    let least = points.iter().map(|point| point[axis]).fold(f64::INFINITY, f64::min);
    let greatest = points.iter().map(|point| point[axis]).fold(f64::NEG_INFINITY, f64::max);
    greatest - least
}

/// The turns around the middle of an orbit, each from the middle of the widest gap between them, and less than one more.
fn around(points: &[[f64; 2]]) -> Result<Vec<f64>, NoRotation> {
    let count = points.len() as f64;
    let middle = [0, 1].map(|axis| points.iter().map(|point| point[axis]).sum::<f64>() / count);
    let widths = [0, 1].map(|axis| extent(points, axis));
    let sizes = [0, 1].map(|axis| points.iter().map(|point| point[axis].abs()).fold(0.0, f64::max));
    if (0..2).all(|axis| widths[axis] <= SPREAD * sizes[axis].max(f64::MIN_POSITIVE)) {
        return Err(NoRotation::OnePoint);
    }
    let place = |point: &[f64; 2]| {
        let [x, y] = [0, 1].map(|axis| {
            let width = widths[axis].max(f64::MIN_POSITIVE);
            (point[axis] - middle[axis]) / width
        });
        // from the vertical axis towards the horizontal one
        math::atan2(x, y) / TAU
    };
    let places: Vec<f64> = points.iter().map(place).collect();
    let turns: Vec<f64> =
        places.windows(2).map(|pair| (pair[1] - pair[0]).rem_euclid(1.0)).collect();
    let cut = cut_between(&turns)?;
    Ok(turns.iter().map(|turn| cut + (turn - cut).rem_euclid(1.0) - 1.0).collect())
}

/// The middle of the widest part of a turn in which none of these turns lies.
fn cut_between(turns: &[f64]) -> Result<f64, NoRotation> {
    let mut sorted = turns.to_vec();
    sorted.sort_by(f64::total_cmp);
    let (Some(least), Some(greatest)) = (sorted.first(), sorted.last()) else {
        return Err(NoRotation::TooFew(turns.len()));
    };
    let mut widest = (least + 1.0 - greatest, (greatest + (least + 1.0)) / 2.0);
    for pair in sorted.windows(2) {
        let gap = pair[1] - pair[0];
        if gap > widest.0 {
            widest = (gap, f64::midpoint(pair[0], pair[1]));
        }
    }
    if widest.0 < GAP {
        return Err(NoRotation::AllTurns);
    }
    Ok(widest.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// So many points on a circle around (1, 1), 0.23 of a turn apart.
    fn circle(count: usize, radius: f64) -> Vec<[f64; 2]> {
        let point = |k: usize| {
            let (sin, cos) = math::sin_cos(TAU * 0.23 * k as f64);
            [1.0 + radius * sin, 1.0 + radius * cos]
        };
        (0..count).map(point).collect()
    }

    #[test]
    fn sixteen_crossings_are_enough() {
        assert_eq!(rotation(&circle(15, 1.0), [None; 2]), Err(NoRotation::TooFew(15)));
        let found = rotation(&circle(16, 1.0), [None; 2]);
        assert_ne!(found, Err(NoRotation::TooFew(16)));
        let angle: Vec<f64> = (0..16).map(|k| 0.23 * f64::from(k)).collect();
        assert_eq!(angle_rotation(&angle[..15], 1.0), Err(NoRotation::TooFew(15)));
        assert!(angle_rotation(&angle, 1.0).is_ok());
    }

    #[test]
    fn points_are_apart_beyond_a_billionth_of_their_size() {
        let is_one =
            |radius: f64| rotation(&circle(100, radius), [None; 2]) == Err(NoRotation::OnePoint);
        // as wide as two radii
        assert!(is_one(0.48e-9) && !is_one(0.52e-9));
    }

    #[test]
    fn turns_are_cut_in_a_gap_of_a_twentieth() {
        let turns = |count: u32| (0..count).map(move |k| f64::from(k) / f64::from(count));
        let cut = |count: u32| cut_between(&turns(count).collect::<Vec<_>>());
        assert!(cut(19).is_ok());
        assert_eq!(cut(21), Err(NoRotation::AllTurns));
    }

    /// Turns of which the averages of parts differ by this.
    fn turns_apart(apart: f64) -> Vec<f64> {
        let step = |k: i32| f64::from(u8::from(k >= 200));
        let steps: Vec<f64> = (0..400).map(step).collect();
        let unit = parts_apart(&steps);
        steps.iter().map(|step| 0.3 + apart / unit * step).collect()
    }

    #[test]
    fn an_average_converges_if_parts_differ_by_less_than_a_twentieth_over_the_number() {
        let found = |part: f64| averaged(&turns_apart(part / 400.0), Turning::Middle);
        assert!(found(0.049).is_ok());
        assert!(matches!(found(0.051), Err(NoRotation::Undecided(_))));
    }

    #[test]
    fn an_average_diverges_if_parts_differ_by_a_quarter_over_the_root_of_the_number() {
        let found = |part: f64| averaged(&turns_apart(part / 20.0), Turning::Middle);
        assert!(matches!(found(0.249), Err(NoRotation::Undecided(_))));
        assert!(matches!(found(0.251), Err(NoRotation::Diverges(_))));
    }
}
