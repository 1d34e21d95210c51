//! What to think of a quantity that should not change (the notes' invariants, and what a method
//! makes of them): at the rounding floor, swinging within bounds, or drifting away.
//!
//! In: the [`History`] of its relative drift. Out: a [`Verdict`]. Never here: where the values
//! come from, or the law of a quantity that the physics itself changes.

use super::history::{History, Stretch};
use crate::expr::portable;

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
    /// The verdict in one word or two, for reports: `exact`, `bounded`, `secular`,
    /// `broken by the physics`, `open`.
    pub fn word(&self) -> &'static str {
        match self {
            Verdict::Open => "open",
            Verdict::Exact(_) => "exact",
            Verdict::Bounded => "bounded",
            Verdict::Secular(_) => "secular",
            Verdict::Broken(_) => "broken by the physics",
        }
    }

    /// The verdict on a history of relative drifts (signed, 0 at the reference). `floor` is the
    /// relative drift that rounding alone may cause, see [`rounding_floor`].
    ///
    /// A swing that has not yet turned looks like a trend: the verdict on a short history may
    /// change as it grows longer.
    pub fn of(drifts: &History, floor: f64) -> Verdict {
        let stretches = drifts.stretches();
        if stretches.len() < FEWEST {
            return Verdict::Open;
        }
        // the last stretch may hold few values; its mean would count too much
        let whole = &stretches[..stretches.len() - 1];
        if drifts.peak() <= floor {
            return Verdict::Exact(growth(whole));
        }
        match trend(whole).or_else(|| departure(whole, floor)) {
            Some(slope) => Verdict::Secular(slope),
            None => Verdict::Bounded,
        }
    }
}

/// Fewer stretches than this say nothing.
const FEWEST: usize = 17;

/// The relative drift that rounding alone explains after this many steps: a random walk of a few
/// units in the last place, four standard deviations wide.
pub fn rounding_floor(steps: u64) -> f64 {
    f64::EPSILON * (16.0 + 4.0 * (steps as f64).sqrt())
}

/// The slope of a trend that lasts: the means of the four quarters rise (or fall) throughout, no
/// step between them much smaller than the others, and the whole is well above the scatter.
fn trend(stretches: &[Stretch]) -> Option<f64> {
    let quarter = stretches.len() / 4;
    let means: Vec<f64> = (0..4)
        .map(|i| stretches[i * quarter..(i + 1) * quarter].iter().map(|s| s.mean).sum::<f64>())
        .map(|sum| sum / quarter as f64)
        .collect();
    let rise = means[3] - means[0];
    let lasting = means.windows(2).all(|pair| (pair[1] - pair[0]) / rise > LEAST_SHARE);
    let (slope, scatter) = line(stretches);
    let clear = rise.abs() > CLEARANCE * scatter / (quarter as f64).sqrt();
    (lasting && clear).then_some(slope)
}

/// What each step between quarters must contribute to the whole rise: an even rise gives 0.33, one
/// with the square root of time still 0.24 at its end.
const LEAST_SHARE: f64 = 0.12;

/// How many standard errors of a quarter's mean a trend must exceed.
const CLEARANCE: f64 = 6.0;

/// The mean rate of a level that was left for another: the means of the first and the last quarter lie farther apart
/// than what swings within a quarter. So it is with an uneven loss, or a jump that stays.
fn departure(stretches: &[Stretch], floor: f64) -> Option<f64> {
    let quarter = stretches.len() / 4;
    let mut swings: Vec<f64> = stretches
        .chunks_exact(quarter)
        .map(|part| {
            let greatest = part.iter().map(|s| s.greatest).fold(f64::MIN, f64::max);
            greatest - part.iter().map(|s| s.least).fold(f64::MAX, f64::min)
        })
        .collect();
    swings.sort_by(f64::total_cmp);
    // one quarter may hold the jump itself
    let swing = f64::midpoint(swings[1], swings[2]);
    let mean = |part: &[Stretch]| part.iter().map(|s| s.mean).sum::<f64>() / part.len() as f64;
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
        along += portable::powi(s.middle() - time, 2);
    }
    let slope = if along > 0.0 { across / along } else { 0.0 };
    let rest = |s: &Stretch| portable::powi(s.mean - mean - slope * (s.middle() - time), 2);
    (slope, (stretches.iter().map(rest).sum::<f64>() / n).sqrt())
}

/// How the mean square difference of two values grows with the time between them: as its power
/// 0 (level), 1 (random walk) or 2 (trend).
fn growth(stretches: &[Stretch]) -> Growth {
    let spread = |lag: usize| {
        let pairs = stretches.iter().zip(&stretches[lag..]);
        let squares: f64 = pairs.map(|(a, b)| portable::powi(b.mean - a.mean, 2)).sum();
        squares / (stretches.len() - lag) as f64
    };
    let (short, long) = (stretches.len().div_ceil(64), stretches.len() / 8);
    let (near, far) = (spread(short), spread(long));
    if near == 0.0 {
        return if far == 0.0 { Growth::Level } else { Growth::Faster };
    }
    let power = portable::ln(far / near) / portable::ln(long as f64 / short as f64);
    match power {
        ..0.5 => Growth::Level,
        0.5..1.5 => Growth::Root,
        _ => Growth::Faster,
    }
}
