//! What to think of a quantity that should not change (the notes' invariants, and what a method
//! makes of them): at the rounding floor, swinging within bounds, drifting away, or lost.
//!
//! In: the [`History`] of its distance from the reference. Out: a [`Verdict`]. Never here: where the values
//! come from, or the law of a quantity that the physics itself changes.

use super::history::{History, Stretch};
use crate::num::math;

/// What to think of a drift.
#[derive(Clone, PartialEq, Debug)]
pub enum Verdict {
    /// Too short a motion to tell.
    Open,
    /// At the rounding floor; how the rest grows.
    Exact(Growth),
    /// Swings without trend, as a symplectic method's energy does.
    Bounded,
    /// Grows with time, or has left its value for good: the method is eating the invariant. The drift per unit of
    /// time.
    Secular(f64),
    /// Left its value by more than a tenth of what moves: nothing of it is left, whatever shape that has.
    Lost,
    /// Not conserved, by the physics; the law for its change, in Unicode mathematics.
    Broken(String),
}

/// How a drift at the rounding floor grows.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Growth {
    /// Not at all.
    Level,
    /// Like a random walk, with the square root of time: the best that rounding allows (Brouwer,
    /// *On the accumulation of errors in numerical integration*, Astron. J. 46, 1937).
    Root,
    /// Faster: rounding errors that do not average out.
    Faster,
}

impl Verdict {
    /// The verdict in one word or two, for reports: `exact`, `bounded`, `secular`, `lost`,
    /// `broken by the physics`, `open`.
    pub fn word(&self) -> &'static str {
        match self {
            Verdict::Open => "open",
            Verdict::Exact(_) => "exact",
            Verdict::Bounded => "bounded",
            Verdict::Secular(_) => "secular",
            Verdict::Lost => "lost",
            Verdict::Broken(_) => "broken by the physics",
        }
    }

    /// The verdict on a history of distances (signed, 0 at the reference), the `greatest` of which may be known from
    /// more looks than the history has. `floor` is the distance that rounding alone may cause, see [`rounding_floor`].
    ///
    /// A swing that has not yet turned looks like a trend: the verdict on a short history may
    /// change as it grows longer.
    pub fn of(distances: &History, greatest: f64, floor: f64) -> Verdict {
        let stretches = distances.stretches();
        if stretches.len() < FEWEST {
            return Verdict::Open;
        }
        // the last stretch may hold few values; its mean would count too much
        let whole = &stretches[..stretches.len() - 1];
        if greatest.max(distances.peak()) <= floor {
            return Verdict::Exact(growth(whole));
        }
        match trend(whole).or_else(|| departure(whole, floor)) {
            Some(slope) => Verdict::Secular(slope),
            None => Verdict::Bounded,
        }
    }
}

/// A drift beyond this part of what moves leaves nothing of a quantity.
pub const LOST: f64 = 0.1;

/// A drift beyond this part of what moves is told to whoever runs the motion.
pub const LEFT: f64 = 1e-6;

/// Fewer stretches than this say nothing.
const FEWEST: usize = 17;

/// The relative drift that rounding alone explains after this many steps: a random walk of a few
/// units in the last place, four standard deviations wide.
pub fn rounding_floor(steps: u64) -> f64 {
    f64::EPSILON * (16.0 + 4.0 * (steps as f64).sqrt())
}

/// The slope of a trend that lasts: however the whole is cut into blocks, the means of these rise (or fall) throughout,
/// no step between them much smaller than the others; the whole is well above the scatter; and the least and the
/// greatest values rise with the means. A swing that is met at another phase in every block moves its means by less,
/// and its extremes not at all or against each other.
fn trend(stretches: &[Stretch]) -> Option<f64> {
    let mean = |part: &[Stretch]| average(part, |s| s.mean);
    let lasting = BLOCKS.iter().all(|&count| {
        let means: Vec<f64> = blocks(stretches, count).map(mean).collect();
        let rise = means[count - 1] - means[0];
        let even = 1.0 / (count - 1) as f64;
        means.windows(2).all(|pair| (pair[1] - pair[0]) / rise > LEAST_SHARE * even)
    });
    let quarters: Vec<&[Stretch]> = blocks(stretches, 4).collect();
    let (first, last) = (quarters[0], quarters[3]);
    let rise = mean(last) - mean(first);
    let along = |extreme: fn(&Stretch) -> f64| {
        (average(last, extreme) - average(first, extreme)) / rise > ALONG
    };
    let (slope, scatter) = line(stretches);
    let clear = rise.abs() > CLEARANCE * scatter / (first.len() as f64).sqrt()
        && rise.abs() > LEAST_RISE * swing(stretches)
        && along(|s| s.least)
        && along(|s| s.greatest);
    (lasting && clear).then_some(slope)
}

/// Into how many blocks a history is cut: numbers that share no divisor, so that no period fits both.
const BLOCKS: [usize; 2] = [4, 5];

/// What each step between blocks must contribute, of what it does in an even rise: one with the square root of time
/// still gives 0.67 of that at its end.
const LEAST_SHARE: f64 = 0.36;

/// The part of a swing that its mean may seem to rise by, because it is met at another phase in each block.
const LEAST_RISE: f64 = 0.01;

/// The part of a rise of the means that the least and the greatest values must take part in.
const ALONG: f64 = 0.2;

/// A history in so many parts of equal length; what is left over is at the end.
fn blocks(stretches: &[Stretch], count: usize) -> impl Iterator<Item = &[Stretch]> {
    stretches.chunks_exact(stretches.len() / count).take(count)
}

fn average(part: &[Stretch], of: impl Fn(&Stretch) -> f64) -> f64 {
    part.iter().map(of).sum::<f64>() / part.len() as f64
}

/// How far a quantity swings within a quarter: the median of the four, one of which may hold a jump.
fn swing(stretches: &[Stretch]) -> f64 {
    let wide = |part: &[Stretch]| {
        let greatest = part.iter().map(|s| s.greatest).fold(f64::MIN, f64::max);
        greatest - part.iter().map(|s| s.least).fold(f64::MAX, f64::min)
    };
    let mut swings: Vec<f64> = blocks(stretches, 4).map(wide).collect();
    swings.sort_by(f64::total_cmp);
    f64::midpoint(swings[1], swings[2])
}

/// How many standard errors of a quarter's mean a trend must exceed.
const CLEARANCE: f64 = 6.0;

/// The mean rate of a level that was left for another: the means of the first and the last quarter lie farther apart
/// than what swings within a quarter. So it is with an uneven loss, or a jump that stays.
fn departure(stretches: &[Stretch], floor: f64) -> Option<f64> {
    let quarter = stretches.len() / 4;
    let swing = swing(stretches);
    let mean = |part: &[Stretch]| average(part, |s| s.mean);
    let (first, last) = (&stretches[..quarter], &stretches[stretches.len() - quarter..]);
    let moved = mean(last) - mean(first);
    let between = last[0].start - first[0].start;
    (moved.abs() > LEAVE * swing && moved.abs() > FAR * floor).then_some(moved / between)
}

/// How far beyond what rounding may cause: a random walk of rounding, too, ends somewhere else than it began.
const FAR: f64 = 8.0;

/// How many swings a level that is left lies away. An even loss moves three of them, the uneven losses of chaotic motion
/// under a Runge–Kutta method 1.4 to 5; the energy under a symplectic method less than 0.7.
const LEAVE: f64 = 1.2;

/// The slope of the straight line through the means, and the root mean square of what is left.
fn line(stretches: &[Stretch]) -> (f64, f64) {
    let n = stretches.len() as f64;
    let time = stretches.iter().map(Stretch::middle).sum::<f64>() / n;
    let mean = stretches.iter().map(|s| s.mean).sum::<f64>() / n;
    let (mut across, mut along) = (0.0, 0.0);
    for s in stretches {
        across += (s.middle() - time) * (s.mean - mean);
        along += math::powi(s.middle() - time, 2);
    }
    let slope = if along > 0.0 { across / along } else { 0.0 };
    let rest = |s: &Stretch| math::powi(s.mean - mean - slope * (s.middle() - time), 2);
    (slope, (stretches.iter().map(rest).sum::<f64>() / n).sqrt())
}

/// How the mean square difference of two values grows with the time between them: as its power
/// 0 (level), 1 (random walk) or 2 (trend).
fn growth(stretches: &[Stretch]) -> Growth {
    let spread = |lag: usize| {
        let pairs = stretches.iter().zip(&stretches[lag..]);
        let squares: f64 = pairs.map(|(a, b)| math::powi(b.mean - a.mean, 2)).sum();
        squares / (stretches.len() - lag) as f64
    };
    let (short, long) = (stretches.len().div_ceil(64), stretches.len() / 8);
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
