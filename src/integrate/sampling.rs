//! Crossings located on the dense output of a method without series, and where a series is not
//! usable.
//!
//! In: a motion that has taken a step, an interval of it on which the functions are simple. Out:
//! where each function crosses zero. Never here: which crossing counts first, and what follows from
//! it.
//!
//! A function is followed from sample to sample by its values and slopes (cubic interpolation).
//! Where it deviates from the interpolation, the piece is halved, so that neither functions that
//! change faster than the motion nor two zeros within one piece are missed.

use super::DenseOutput;
use super::clock::{DIGITS, spacing};
use super::located_event::Crossing;
use super::probe::Probe;
use crate::model::Direction;
use crate::num::{DoubleDouble, math};
use crate::system::MotionError;

/// The number of pieces into which an interval on which the functions are simple is divided at
/// first.
const PIECES: usize = 4;

/// The distance of a sample beyond the zero of a secant, relative to the distance to the zero.
const BEYOND: f64 = 1.01;

/// The tolerated deviation of a value from the interpolation, relative to its size.
const PREDICTED: f64 = 0.02;

/// The maximal number of halvings of a piece.
const HALVINGS: u32 = 14;

/// The part of a piece over which a slope is taken.
const SLOPE_OVER: f64 = 1e-5;

/// The distance beside a change of sign at which a function is sampled again, in multiples of the
/// distance of the times between which it lies.
const WIDENING: f64 = 4.0;

/// Values that differ by less than this part of them may be equal but for rounding.
const ROUNDING: f64 = 1e-13;

/// Beside a pole at the end of a step the function falls to this part of its value next to the pole.
const ONE_SIDED: f64 = 0.5;

/// Beside a pole the function falls by more than this factor over [`ASIDE`] times the distance, be it that of a small root.
const POLE_FALLS: f64 = 0.9;

/// The sign of a value below this part of those beside it is not trusted.
pub(super) const SIGNLESS: f64 = 1e-13;

/// A function has left its zero where its value is so many times that at the zero.
const CLEAR: f64 = 4.0;

/// It has left its zero only if its value also grows by this factor from each sample to the next.
const GROWS: f64 = 1.2;

#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    time: f64,
    value: f64,
    slope: f64,
}

impl Sample {
    pub(super) fn time(&self) -> f64 {
        self.time
    }
}

/// Follows the functions over one interval.
pub(super) struct Sampling<'a> {
    pub(super) probe: &'a mut Probe,
    pub(super) motion: &'a mut dyn DenseOutput,
    /// The beginning and end of the interval.
    pub(super) whole: (f64, f64),
    /// Whether nothing follows that would detect a crossing at its very end.
    pub(super) is_last: bool,
}

impl Sampling<'_> {
    /// Samples all functions over the whole interval. `soonest` is the part of the time after which
    /// the first sample is taken, if an impulse has just been applied.
    pub(super) fn samples(
        &mut self,
        functions: usize,
        soonest: Option<f64>,
    ) -> Result<Vec<Vec<Sample>>, MotionError> {
        let (from, to) = self.whole;
        let mut samples: Vec<Vec<Sample>> = vec![Vec::new(); functions];
        let halvings = |soonest: f64| math::log2((to - from) / soonest).ceil() as i32;
        let early = soonest.map_or(0, halvings);
        let early = (3..early).rev().map(|k| math::powi(0.5, k));
        let parts = (0..=PIECES).map(|k| k as f64 / PIECES as f64);
        let mut parts: Vec<f64> = early.chain(parts).collect();
        parts.sort_by(f64::total_cmp);
        for part in parts {
            let time = if part == 1.0 { to } else { from + (to - from) * part };
            let width = (to - from) * part.max(1.0 / PIECES as f64);
            for (i, sample) in self.sample(time, width)?.into_iter().enumerate() {
                samples[i].push(sample);
            }
        }
        Ok(samples)
    }

    /// Samples all functions at a time within the interval; slopes are taken over a small part of
    /// `width`.
    fn sample(&mut self, time: f64, width: f64) -> Result<Vec<Sample>, MotionError> {
        let (from, to) = self.whole;
        let here = self.probe.at(self.motion, time)?.to_vec();
        // not so small that the last digit of time dominates
        let step = (width * SLOPE_OVER).max(1e-14 * time.abs());
        let beside = if time + step <= to { time + step } else { (time - step).max(from) };
        let there = self.probe.at(self.motion, beside)?;
        let samples = here.iter().zip(there).map(|(&value, &next)| {
            let slope = if beside == time { 0.0 } else { (next - value) / (beside - time) };
            Sample { time, value, slope }
        });
        Ok(samples.collect())
    }

    /// The crossings of one function, in order of time, up to the first that counts; those within the last digits of the `last`
    /// one are the same.
    pub(super) fn follow(
        &mut self,
        (event, direction): (usize, Direction),
        samples: &[Sample],
        known: &mut f64,
        last: f64,
    ) -> Result<Vec<Crossing>, MotionError> {
        let mut follower =
            SignFollower { event, direction, side: *known, known, last, found: Vec::new() };
        for pair in samples.windows(2) {
            if follower.side == 0.0 {
                follower.side = sign(pair[0], pair[1]);
                *follower.known = follower.side;
            }
            if self.piece(&mut follower, pair[0], pair[1], HALVINGS)? {
                break;
            }
        }
        if let (true, [.., before, last]) = (follower.side == 0.0, samples) {
            *follower.known = sign(*last, *before);
        }
        Ok(follower.found)
    }

    /// Follows a function over one piece. Returns true if a crossing that counts was found.
    fn piece(
        &mut self,
        follower: &mut SignFollower<'_>,
        a: Sample,
        b: Sample,
        halvings: u32,
    ) -> Result<bool, MotionError> {
        let time = 0.5 * (a.time + b.time);
        if time <= a.time || time >= b.time {
            return self.end(follower, a, b);
        }
        let width = b.time - a.time;
        let middle = self.sample(time, width)?[follower.event];
        let predicted = 0.5 * (a.value + b.value) + width * (a.slope - b.slope) / 8.0;
        let steep = 1.5 * (b.value - a.value) / width - 0.25 * (a.slope + b.slope);
        let size = a.value.abs().max(b.value.abs()).max(middle.value.abs());
        let off = (middle.value - predicted).abs().max((middle.slope - steep).abs() * width / 8.0);
        let surprise = off > PREDICTED * size;
        if surprise && halvings > 0 {
            return Ok(self.piece(follower, a, middle, halvings - 1)?
                || self.piece(follower, middle, b, halvings - 1)?);
        }
        Ok(self.turned(follower, a, middle)? || self.turned(follower, middle, b)?)
    }

    /// Handles a piece on which the function has at most one turning point, which is also sampled
    /// if it lies towards zero.
    fn turned(
        &mut self,
        follower: &mut SignFollower<'_>,
        a: Sample,
        b: Sample,
    ) -> Result<bool, MotionError> {
        let same_side = a.value * b.value > 0.0;
        let towards = a.value * a.slope < 0.0 && b.value * b.slope > 0.0;
        if !(same_side && towards) {
            return self.end(follower, a, b);
        }
        let (mut left, mut right) = (a, b);
        for _ in 0..60 {
            // the turning point of a function with these slopes
            let part = left.slope / (left.slope - right.slope);
            let time = left.time + (right.time - left.time) * part.clamp(0.05, 0.95);
            if time <= left.time || time >= right.time {
                break;
            }
            let width = right.time - left.time;
            let sample = self.sample(time, width)?[follower.event];
            if sample.value * a.value <= 0.0 {
                return Ok(self.end(follower, a, sample)? || self.end(follower, sample, b)?);
            }
            if sample.slope * a.value < 0.0 {
                left = sample;
            } else {
                right = sample;
            }
            let rest = (left.slope.abs() + right.slope.abs()) * (right.time - left.time);
            if rest < 1e-3 * sample.value.abs() {
                break;
            }
        }
        self.end(follower, a, b)
    }

    /// Handles a piece with at most one crossing, and records it.
    fn end(
        &mut self,
        follower: &mut SignFollower<'_>,
        a: Sample,
        b: Sample,
    ) -> Result<bool, MotionError> {
        let side = sign(b, a);
        let at_end = self.is_last && b.time == self.whole.1;
        if side == 0.0 && at_end && b.slope * follower.side < 0.0 {
            // it crosses at the very end of the step, which may be the time of an output row or an
            // impulse
            let crossing = Crossing::at(DoubleDouble::from_decimal(b.time), -follower.side);
            follower.side = -follower.side;
            follower.found.push(crossing);
            return Ok(crossing.counts(follower.direction));
        }
        if side == 0.0 || side == follower.side {
            return Ok(false);
        }
        if follower.side == 0.0 {
            follower.side = side;
            *follower.known = side;
            return Ok(false);
        }
        let is_same = |time: f64| (time - follower.last).abs() <= DIGITS * spacing(time);
        let from = if is_same(a.time) {
            self.between(follower.event, side, a.time, b.time)?
        } else {
            Some(a.time)
        };
        follower.side = side;
        let Some(from) = from else {
            *follower.known = side;
            return Ok(false);
        };
        let crossing = self.locate(follower.event, side, from, b.time)?;
        if is_same(crossing.exact.high) {
            return Ok(false);
        }
        follower.found.push(crossing);
        Ok(crossing.counts(follower.direction))
    }

    /// A time between that of the last crossing and a sample on this side of zero at which the function is on the other: the
    /// sign at the crossing itself is that of its rounding.
    fn between(
        &mut self,
        event: usize,
        side: f64,
        left: f64,
        right: f64,
    ) -> Result<Option<f64>, MotionError> {
        let mut distance = DIGITS * spacing(left);
        while left + distance < right {
            let time = left + distance;
            if self.probe.exactly(self.motion, event, time)?.high * side < 0.0 {
                return Ok(Some(time));
            }
            distance *= 2.0;
        }
        Ok(None)
    }

    /// The time of a crossing between two samples, after which the function is on `side`:
    /// bisection, mixed with secant steps kept inside (R. P. Brent, Algorithms for Minimization
    /// without Derivatives, ch. 4, has the reasons), down to neighbouring times, and a secant
    /// between these. If the function has a pole, there is no zero.
    fn locate(
        &mut self,
        event: usize,
        side: f64,
        mut left: f64,
        mut right: f64,
    ) -> Result<Crossing, MotionError> {
        let mut low = self.probe.exactly(self.motion, event, left)?;
        let mut high = self.probe.exactly(self.motion, event, right)?;
        if high.high * side < 0.0 && low.high * side < 0.0 {
            // beside a jump, which in double-double comes a digit later
            let next = right + spacing(right);
            let beside = self.probe.exactly(self.motion, event, next)?;
            let pole = self.is_pole(event, (right, high.high), (next, beside.high))?;
            return Ok(Crossing { exact: DoubleDouble::from_decimal(right), side, pole });
        }
        if low.high * side > 0.0 {
            if let Some(pole) = self.was_pole(event, side, (left, low.high))? {
                return Ok(Crossing { exact: DoubleDouble::from_decimal(left), side, pole });
            }
            // in double-double it has crossed already
            let next = (left + spacing(left)).min(right);
            let beside = self.probe.exactly(self.motion, event, next)?;
            let pole = self.is_pole(event, (left, low.high), (next, beside.high))?;
            return Ok(Crossing { exact: DoubleDouble::from_decimal(left), side, pole });
        }
        for round in 0..200 {
            let middle = 0.5 * (left + right);
            if middle <= left || middle >= right {
                break;
            }
            // a little beyond the secant's zero, so that the farther end also converges
            let part = low.high / (low.high - high.high);
            let digit = spacing(right.abs().max(left.abs()));
            let secant = if part < 0.5 {
                left + (right - left) * part * BEYOND + digit
            } else {
                right - (right - left) * (1.0 - part) * BEYOND - digit
            };
            let inside = secant > left && secant < right && round % 4 != 3;
            let time = if inside { secant } else { middle };
            let value = self.probe.exactly(self.motion, event, time)?;
            if value.high == 0.0 {
                return Ok(Crossing::at(DoubleDouble::from_decimal(time), side));
            }
            if value.high * side > 0.0 {
                (right, high) = (time, value);
            } else {
                (left, low) = (time, value);
            }
        }
        // where the function begins to exist on the other side it has no zero
        let begins = low.high.is_nan();
        let pole = begins || self.is_pole(event, (left, low.high), (right, high.high))?;
        // the samples were taken at exactly these times
        let (left, right) = (DoubleDouble::from_decimal(left), DoubleDouble::from_decimal(right));
        let part = low / (low - high);
        let exact = if part.is_finite() { left + (right - left) * part } else { left };
        Ok(Crossing { exact, side, pole })
    }

    /// Whether a function jumped just before a time at which it is on `side` already; `None` if it was there before as well.
    fn was_pole(
        &mut self,
        event: usize,
        side: f64,
        (right, high): (f64, f64),
    ) -> Result<Option<bool>, MotionError> {
        let (begin, _) = self.motion.interval();
        for digits in [1.0, 2.0, 4.0, 8.0, DIGITS] {
            let left = (right - digits * spacing(right)).max(begin);
            let low = self.probe.exactly(self.motion, event, left)?.high;
            if low * side < 0.0 {
                return self.is_pole(event, (left, low), (right, high)).map(Some);
            }
        }
        Ok(None)
    }

    /// Whether a function that changes its sign between two neighbouring times is smaller farther
    /// from them: beside a zero its size grows with distance, beside a pole it falls, and beside the cut of an angle. How
    /// far it must be sampled depends on how slowly an angle turns. Beside another jump through zero its size is finite: that
    /// is a crossing, whichever way it changes there.
    fn is_pole(
        &mut self,
        event: usize,
        (left, low): (f64, f64),
        (right, high): (f64, f64),
    ) -> Result<bool, MotionError> {
        let (begin, end) = self.motion.interval();
        let (begin, end) = (begin.min(self.whole.0), end.max(self.whole.1));
        let mut offset = WIDENING * (right - left);
        let have_cuts = self.probe.event_functions().have_cuts();
        loop {
            let (before, after) = ((left - offset).max(begin), (right + offset).min(end));
            let earlier = self.probe.exactly(self.motion, event, before)?.high.abs();
            let later = self.probe.exactly(self.motion, event, after)?.high.abs();
            if !have_cuts && before < left && after > right {
                return Ok(earlier < POLE_FALLS * low.abs() && later < POLE_FALLS * high.abs());
            }
            if before == left || after == right {
                // one side alone does not distinguish the cut of an angle from another jump
                return Ok(earlier < ONE_SIDED * low.abs() || later < ONE_SIDED * high.abs());
            }
            let differs = |a: f64, b: f64| (a - b).abs() > ROUNDING * b || a.is_nan();
            let is_clear = differs(earlier, low.abs()) && differs(later, high.abs());
            if is_clear || before == begin || after == end {
                return Ok(earlier < low.abs() && later < high.abs());
            }
            offset *= WIDENING;
        }
    }
}

/// The samples of a function that was zero at the beginning, but for a `residual`, from the first one that shows to which
/// side it leaves: the values before are the rounding of the zero and of its time. What leaves with its first derivatives
/// zero as well is rounding below this part of its course.
pub(super) fn leaving(samples: &[Sample], [residual, part]: [f64; 2]) -> &[Sample] {
    let [first, soon, ..] = samples else { return samples };
    let moved = |sample: &Sample| sample.value - first.value;
    let farthest = samples.iter().map(moved).fold(0.0_f64, |most, x| most.max(x.abs()));
    let residual = residual.max(part * farthest);
    if first.value.abs() > moved(soon).abs().max(CLEAR * residual) {
        return samples;
    }
    let rounding = CLEAR * first.value.abs().max(residual);
    let leaves = |run: &[Sample]| {
        let (mut last, side) = (rounding, moved(&run[0]).signum());
        run.iter().map(moved).all(|moved| {
            let grows = moved * side > last;
            last = GROWS * moved.abs();
            grows
        })
    };
    let begin = samples[1..].windows(3).position(leaves).map_or(samples.len() - 1, |k| k + 1);
    &samples[begin..]
}

/// The progress of one function through an interval.
struct SignFollower<'a> {
    event: usize,
    direction: Direction,
    side: f64,
    /// The sign at the beginning of the interval, or when it was first known.
    known: &'a mut f64,
    /// When the function last crossed zero; NaN before it has.
    last: f64,
    found: Vec<Crossing>,
}

/// The side of zero a function is on; none if its value may be rounding, or if it has none. Beside a time at which it has no
/// value it has the sign of its own.
fn sign(here: Sample, beside: Sample) -> f64 {
    let value = here.value;
    let size = if beside.value.is_nan() { 0.0 } else { beside.value.abs() };
    if value.abs() > SIGNLESS * size { value.signum() } else { 0.0 }
}
