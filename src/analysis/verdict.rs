//! The assessment of a quantity that should be conserved: at the rounding floor, oscillating within
//! bounds, drifting away, or lost.
//!
//! In: the [`History`] of its distance from the reference, and how the method's errors depend on the
//! past. Out: a [`Verdict`]. Never here: where
//! the values come from, or the law of a quantity that the physics itself changes.

use super::history::{History, Stretch};
use crate::num::math;

/// The verdict on a drift.
#[derive(Clone, PartialEq, Debug)]
pub enum Verdict {
    /// The motion is too short for a verdict: for any, for one on a function of the state that has
    /// not yet returned, or for one on an error that has changed but a few times, or unevenly, and may add up.
    Open,
    /// Not known, since no drift of it can be seen.
    Unknown(Unseen),
    /// At the rounding floor; contains how the error grows.
    Exact(Growth),
    /// Oscillates without trend, as the energy of a symplectic method does.
    Bounded,
    /// Grows with time, or has left its value permanently: the method does not preserve the
    /// invariant. Contains the drift per unit of time.
    Secular(f64),
    /// Has drifted by more than a tenth of its varying part, in whatever way.
    Lost,
    /// Not conserved by the physics. Contains the law for its change, in Unicode mathematics.
    Broken(String),
    /// Conserved on one branch of the function that it is made of; the motion is on another, where another number is conserved.
    OtherBranch,
    /// The residual of a constraint that no longer acts: there is nothing to judge.
    Released,
}

/// Why it cannot be seen whether a method keeps a quantity.
#[derive(Clone, PartialEq, Debug)]
pub enum Unseen {
    /// Its terms underflow.
    Underflow,
    /// What moves is less than the rounding error of its terms, which are larger by this factor.
    Unresolved(f64),
    /// Its value has changed, and rounding of the state explains the change.
    Rounded(RoundedInput),
}

/// The variable of a state whose rounding changes a quantity most.
#[derive(Clone, PartialEq, Debug)]
pub struct RoundedInput {
    /// Its name.
    pub name: String,
    /// The distance between neighbouring numbers where it is.
    pub digits: f64,
}

/// The dependence of a method's errors on the past.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Errors {
    /// The error of an invariant is a function of the state, as the energy's is under a symplectic
    /// method: where it has left its value it returns as the motion does. If the step is long for a
    /// narrow place, such as a pericentre, each passage changes its level by what depends on where
    /// the steps fall, in both directions. So a changed level shows nothing, and only a trend does.
    OfState,
    /// What is lost in a step stays lost.
    Accumulated,
}

/// The growth of a drift at the rounding floor.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Growth {
    /// It does not grow.
    Level,
    /// It grows like a random walk, with the square root of time, the best that rounding allows
    /// (Brouwer, *On the accumulation of errors in numerical integration*, Astron. J. 46, 1937).
    Root,
    /// It grows faster: rounding errors do not average out.
    Faster,
}

impl Verdict {
    /// The verdict in one to four words, for reports: `exact`, `bounded`, `secular`, `lost`,
    /// `not conserved`, `open`, `unknown`, `other branch`, `released`.
    pub fn word(&self) -> &'static str {
        match self {
            Verdict::Open => "open",
            Verdict::Unknown(_) => "unknown",
            Verdict::Exact(_) => "exact",
            Verdict::Bounded => "bounded",
            Verdict::Secular(_) => "secular",
            Verdict::Lost => "lost",
            Verdict::Broken(_) => "not conserved",
            Verdict::OtherBranch => "other branch",
            Verdict::Released => "released",
        }
    }

    /// The verdict on a history of distances (signed, 0 at the reference). Their `greatest` may be
    /// known from more samples than the history has. `floor` is the distance that rounding alone
    /// may cause, see [`rounding_floor`].
    ///
    /// An oscillation that has not yet turned looks like a trend: the verdict on a short history
    /// may change as it grows longer.
    pub fn of(distances: &History, greatest: f64, floor: f64, errors: Errors) -> Verdict {
        let intervals = distances.stretches();
        if intervals.len() < FEWEST {
            return Verdict::Open;
        }
        // the last interval may contain few values, and its mean would count too much
        let whole = &intervals[..intervals.len() - 1];
        if greatest.max(distances.peak()) <= floor {
            return Verdict::Exact(growth(whole));
        }
        let slope = match errors {
            Errors::Accumulated => trend(whole)
                .or_else(|| departure(whole, floor))
                .or_else(|| early_departure(whole, floor)),
            // so far the state has only gone one way, and its function with it
            Errors::OfState if !turns(whole, RETURNED) && !repeats(whole, floor) => {
                return Verdict::Open;
            }
            Errors::OfState => trend(whole),
        };
        match slope {
            Some(slope) => Verdict::Secular(slope),
            None if errors == Errors::Accumulated
                && greatest.max(distances.peak()) > FAR * floor =>
            {
                // after a few passages levels that are left may or may not add up, and so may what inclines
                let is_settled = turns(whole, OFTEN) && !inclines(whole);
                if is_settled { Verdict::Bounded } else { Verdict::Open }
            }
            None => Verdict::Bounded,
        }
    }
}

/// A quantity is lost if it drifts by more than this part of its varying part.
pub const LOST: f64 = 0.1;

/// A drift of more than this part of the varying part is reported to the user.
pub const LEFT: f64 = 1e-6;

/// A drift of more than this part of the varying part is not called exact, even if rounding of the state explains it.
pub const RESOLVED: f64 = 1e-9;

/// The minimal number of intervals for a verdict.
const FEWEST: usize = 17;

/// The relative drift that rounding alone explains after this many steps: a random walk of a few
/// units in the last place, four standard deviations wide.
#[inline]
pub fn rounding_floor(steps: u64) -> f64 {
    f64::EPSILON * (16.0 + 4.0 * (steps as f64).sqrt())
}

/// Whether a quantity comes back: the way it covers, up and down, is much longer than what lies between its extremes. It
/// is as long for a rise, and twice as long for one peak.
fn turns(intervals: &[Stretch], times: f64) -> bool {
    let greatest = intervals.iter().map(|s| s.greatest).fold(f64::MIN, f64::max);
    let least = intervals.iter().map(|s| s.least).fold(f64::MAX, f64::min);
    // the shortest way through both extremes of every interval, whose order is not known, that ends at its least value, and
    // that ends at its greatest
    let (mut last, mut ways) = ([intervals[0].least; 2], [0.0_f64; 2]);
    for s in intervals {
        let ends = [s.least, s.greatest];
        let to = |x: f64| (ways[0] + (x - last[0]).abs()).min(ways[1] + (x - last[1]).abs());
        ways = [to(s.greatest), to(s.least)].map(|way| way + s.greatest - s.least);
        last = ends;
    }
    ways[0].min(ways[1]) >= times * (greatest - least)
}

/// How much longer that way is, at least, for a function of the state: it has come back by half.
const RETURNED: f64 = 1.5;

/// The same where errors accumulate: it has come back three times and is away again.
const OFTEN: f64 = 7.0;

/// Whether a quantity rises or falls on the whole beside its oscillation, though not in every part as a trend does: an uneven loss
/// may look like that for a while, and what oscillates does not.
fn inclines(intervals: &[Stretch]) -> bool {
    let greatest = intervals.iter().map(|s| s.greatest).fold(f64::MIN, f64::max);
    let least = intervals.iter().map(|s| s.least).fold(f64::MAX, f64::min);
    SLOPED.iter().all(|&count| {
        let means: Vec<f64> =
            blocks(intervals, count).map(|part| average(part, |s| s.mean)).collect();
        let middle = 0.5 * (count - 1) as f64;
        let mean = means.iter().sum::<f64>() / count as f64;
        let (mut across, mut along) = (0.0, 0.0);
        for (k, value) in means.iter().enumerate() {
            across += (k as f64 - middle) * (value - mean);
            along += math::powi(k as f64 - middle, 2);
        }
        let slope = across / along;
        let beside =
            |(k, value): (usize, &f64)| math::powi(value - mean - slope * (k as f64 - middle), 2);
        let rest: f64 = means.iter().enumerate().map(beside).sum();
        let error = (rest / ((count - 2) as f64 * along)).sqrt();
        // that of the whole time
        let rise = slope.abs() * intervals.len() as f64 / (intervals.len() / count) as f64;
        rise > INCLINED * (greatest - least) && slope.abs() > SURE * error
    })
}

/// The numbers of blocks through whose means lines are drawn: no sine of 3.4 to 37 periods, at any phase, has slopes that are sure
/// in both.
const SLOPED: [usize; 2] = [8, 13];

/// The least rise of these lines, in amplitudes.
const INCLINED: f64 = 0.1;

/// The least slope of these lines in standard errors.
const SURE: f64 = 4.5;

/// Whether what lies beside a straight line comes and goes with a motion that returns: steps along a staircase, which has
/// not come back itself. A curve that only bends, or a line as straight as rounding allows, shows no return.
fn repeats(intervals: &[Stretch], floor: f64) -> bool {
    let (slope, _) = line(intervals);
    let rest: Vec<f64> = intervals.iter().map(|s| s.mean - slope * s.middle()).collect();
    let greatest = rest.iter().copied().fold(f64::MIN, f64::max);
    let width = greatest - rest.iter().copied().fold(f64::MAX, f64::min);
    let way: f64 = rest.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum();
    width > FAR * floor && way >= REPEATED * width
}

/// How much longer the way beside the line is than its width, at least: there and back seven times. So many changes of level
/// are not all alike by where the steps of the method fall.
const REPEATED: f64 = 14.0;

/// The slope of a lasting trend, if there is one. However the whole is divided into blocks, their
/// means must rise (or fall) throughout, with no step between them much smaller than the others;
/// the whole rise must be well above the scatter; and the least and the greatest values must rise
/// with the means. An oscillation sampled at another phase in every block changes its means by
/// less, and its extremes not at all or in opposite directions.
fn trend(intervals: &[Stretch]) -> Option<f64> {
    let mean = |part: &[Stretch]| average(part, |s| s.mean);
    let lasting = BLOCKS.iter().all(|&count| {
        let means: Vec<f64> = blocks(intervals, count).map(mean).collect();
        let rise = means[count - 1] - means[0];
        let even = 1.0 / (count - 1) as f64;
        means.windows(2).all(|pair| (pair[1] - pair[0]) / rise > LEAST_SHARE * even)
    });
    let quarters: Vec<&[Stretch]> = blocks(intervals, 4).collect();
    let (first, last) = (quarters[0], quarters[3]);
    let rise = mean(last) - mean(first);
    let along = |extreme: fn(&Stretch) -> f64| {
        (average(last, extreme) - average(first, extreme)) / rise > ALONG
    };
    let (slope, scatter) = line(intervals);
    let clear = rise.abs() > SIGNIFICANCE * scatter / (first.len() as f64).sqrt()
        && rise.abs() > LEAST_RISE * swing(intervals)
        && along(|s| s.least)
        && along(|s| s.greatest);
    (lasting && clear).then_some(slope)
}

/// The numbers of blocks into which a history is divided: coprime, so that no period fits both.
const BLOCKS: [usize; 2] = [4, 5];

/// The least contribution of each step between blocks, relative to that of a linear rise: a rise
/// with the square root of time still has 0.67 of that at its end.
const LEAST_SHARE: f64 = 0.36;

/// The part of an oscillation by which its mean may seem to rise, because it is sampled at another
/// phase in each block.
const LEAST_RISE: f64 = 0.01;

/// The part of a rise of the means that the least and the greatest values must share.
const ALONG: f64 = 0.2;

/// Divides a history into `count` parts of equal length; the last ones may be left over.
fn blocks(intervals: &[Stretch], count: usize) -> impl Iterator<Item = &[Stretch]> {
    intervals.chunks_exact(intervals.len() / count).take(count)
}

fn average(part: &[Stretch], of: impl Fn(&Stretch) -> f64) -> f64 {
    part.iter().map(of).sum::<f64>() / part.len() as f64
}

/// The amplitude of a quantity within a quarter: the median of the four, one of which may contain a
/// jump.
fn swing(intervals: &[Stretch]) -> f64 {
    let wide = |part: &[Stretch]| {
        let greatest = part.iter().map(|s| s.greatest).fold(f64::MIN, f64::max);
        greatest - part.iter().map(|s| s.least).fold(f64::MAX, f64::min)
    };
    let mut swings: Vec<f64> = blocks(intervals, 4).map(wide).collect();
    swings.sort_by(f64::total_cmp);
    f64::midpoint(swings[1], swings[2])
}

/// The number of standard errors of a quarter's mean that a trend must exceed.
const SIGNIFICANCE: f64 = 6.0;

/// The mean rate of change of a quantity that has left one level for another: the means of the
/// first and the last quarter differ by more than the oscillation within a quarter. This detects an
/// uneven loss, or a permanent jump.
fn departure(intervals: &[Stretch], floor: f64) -> Option<f64> {
    let quarter = intervals.len() / 4;
    let swing = swing(intervals);
    let mean = |part: &[Stretch]| average(part, |s| s.mean);
    let (first, last) = (&intervals[..quarter], &intervals[intervals.len() - quarter..]);
    let moved = mean(last) - mean(first);
    let between = last[0].start - first[0].start;
    (moved.abs() > LEAVE * swing && moved.abs() > FAR * floor).then_some(moved / between)
}

/// The least departure in multiples of the rounding floor, since a random walk of rounding also
/// ends away from its beginning.
const FAR: f64 = 8.0;

/// The least departure in amplitudes. A steady loss departs by three of them, the uneven losses of
/// chaotic motion under a Runge–Kutta method by 1.4 to 5, and the energy under a symplectic method
/// by less than 0.7.
const LEAVE: f64 = 1.2;

/// The mean rate of change of a quantity that left its value within the first quarter and has not
/// returned: afterwards it is farther from its reference than it oscillates.
fn early_departure(intervals: &[Stretch], floor: f64) -> Option<f64> {
    let later = &intervals[intervals.len() / 4..];
    let greatest = later.iter().map(|s| s.greatest).fold(f64::MIN, f64::max);
    let least = later.iter().map(|s| s.least).fold(f64::MAX, f64::min);
    let moved = average(later, |s| s.mean);
    let between = later[later.len() - 1].start - intervals[0].start;
    // a random walk of rounding has a swing of its own
    let has_left = moved.abs() > LEAVE * (greatest - least) && moved.abs() > floor;
    has_left.then_some(moved / between)
}

/// The slope of the straight line through the means, and the root mean square of the residuals.
fn line(intervals: &[Stretch]) -> (f64, f64) {
    let n = intervals.len() as f64;
    let time = intervals.iter().map(Stretch::middle).sum::<f64>() / n;
    let mean = intervals.iter().map(|s| s.mean).sum::<f64>() / n;
    let (mut across, mut along) = (0.0, 0.0);
    for s in intervals {
        across += (s.middle() - time) * (s.mean - mean);
        along += math::powi(s.middle() - time, 2);
    }
    let slope = if along > 0.0 { across / along } else { 0.0 };
    let rest = |s: &Stretch| math::powi(s.mean - mean - slope * (s.middle() - time), 2);
    (slope, (intervals.iter().map(rest).sum::<f64>() / n).sqrt())
}

/// How the mean square difference of two values grows with the time between them: as its power 0
/// (level), 1 (random walk) or 2 (trend).
fn growth(intervals: &[Stretch]) -> Growth {
    let spread = |lag: usize| {
        let pairs = intervals.iter().zip(&intervals[lag..]);
        let squares: f64 = pairs.map(|(a, b)| math::powi(b.mean - a.mean, 2)).sum();
        squares / (intervals.len() - lag) as f64
    };
    let (short, long) = (intervals.len().div_ceil(64), intervals.len() / 8);
    let (near, far) = (spread(short), spread(long));
    if near == 0.0 {
        return if far == 0.0 { Growth::Level } else { Growth::Faster };
    }
    let power = math::ln(far / near) / math::ln(long as f64 / short as f64);
    match power {
        ..0.5 => Growth::Level,
        0.5..1.5 => Growth::Root,
        _ => Growth::Faster,
    }
}
