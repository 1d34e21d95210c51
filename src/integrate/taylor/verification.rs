//! Verification of a step: whether the law within it is that of its series.
//!
//! A series shows what the law does only where its terms at the origin do not vanish beside others. From where a force is zero to all
//! digits a steep wall ahead has none: about u = 0 the series of u^100 has no term below the hundredth, and 1e-45/x² is nothing
//! beside x² until its pole is near. Where a step could pass such a place it is divided into parts, so that everything narrow in
//! the law is resolved in each of them (`system::Enclosure`), and the rates at the end of each part are compared with the slopes of
//! the series there. A step ends before the first part in which they differ.
//!
//! In: a series, a step. Out: how much of it may be taken. Never here: what limits a step that the series shows.

use super::super::roots::value_and_slope;
use super::Taylor;
use crate::num::{DoubleDouble, Interval, math};
use crate::system::{BatchSeries, Enclosure, MotionError, MotionErrorKind, Series, Side, State};

/// The deviation of a rate over a part of a step, relative to the largest term of the slope of its series, that is rounding of the
/// series in any case.
const ROUNDING: f64 = 1e-13;

/// The part of a number by which it may change unseen.
const UNSEEN: f64 = 1e-17;

/// The same part, below which a power needs no resolution.
const NOTHING: f64 = 1e-18;

/// The part of a number to which it is known after many steps.
const KNOWN: f64 = 1e-16;

/// What is smaller has underflowed.
const FAINT: f64 = 1e-290;

/// The last part of a step is looked at before its end, which may lie on a kink.
const NEAR_THE_END: f64 = 0.98;

/// Parts of a step are not divided where they are shorter than this part of it, with the lowest orders in double-double and in
/// `f64`.
const FINEST: (f64, f64) = (1e-30, 1e-15);

/// Where a part is divided: not in the middle, where zeros lie by symmetry.
const DIVISION: f64 = 0.487_138_691;

/// The maximal number of enclosures for one step. If they show no contradiction, there is none.
const ENCLOSURES: u32 = 2_000;

/// What is divided by may fall to this part of what it is at the beginning, and a pole of a tangent come as near, before a step is
/// verified.
const NEAR: f64 = 0.1;

/// The number of pieces of a step in which what is divided by is bounded.
const PIECES: u32 = 16;

/// Beside a pole the rates change a number by so many times itself in the time to it.
const POLE: f64 = 1e3;

/// The largest number of times that the beginning of a step is halved.
const HALVINGS: u32 = 60;

/// A part of a step, in the unit of time of its series.
type StepPart = (DoubleDouble, DoubleDouble);

impl Taylor {
    /// Whether a step of this size may pass what its series does not show.
    pub(super) fn may_hide(&self, x: f64) -> bool {
        if self.series.sides().iter().any(|side| matches!(side, Side::Between | Side::Level)) {
            // rounding decides on which side of the kink the law is evaluated
            return false;
        }
        if self.series.is_steep() {
            return true;
        }
        self.series.divisors().any(|u| may_vanish(&u.iter().copied(), x))
            || self.series.tangents().any(|(u, zero)| may_meet_pole(u.iter().copied(), zero, x))
    }

    /// The part of a step before the law contradicts the series; 1 where it does not.
    ///
    /// Enclosures only say where to evaluate the law. What ends a step is the law at a point of it; where none is found the step
    /// is taken.
    pub(super) fn agreeing_part(&mut self, after: DoubleDouble) -> Result<f64, MotionError> {
        let whole = after / DoubleDouble::from(self.series.scale());
        if !self.history.may_be_shortened() {
            return Ok(1.0);
        }
        let (mut end, mut enclosures) = (whole, ENCLOSURES);
        for _ in 0..HALVINGS {
            match self.first_contradiction(end, &mut enclosures)? {
                None => return Ok(if end == whole { 1.0 } else { (end / whole).high }),
                Some((begin, stop)) if begin.high > 0.0 => {
                    let width = (stop - begin).high * self.series.scale();
                    self.history.narrow = Some(width.abs());
                    return Ok((begin / whole).high);
                }
                Some((_, stop)) => {
                    self.history.narrow = Some((stop.high * self.series.scale()).abs());
                    end = stop * 0.5;
                }
            }
        }
        // rounding contradicts the series however short the step is
        self.history.narrow = None;
        Ok(1.0)
    }

    /// The first part of a step of this size in which the law is found not to be that of the series.
    fn first_contradiction(
        &mut self,
        end: DoubleDouble,
        enclosures: &mut u32,
    ) -> Result<Option<StepPart>, MotionError> {
        let from = self.state.clone();
        let found = self.search_contradiction(end, enclosures);
        self.state = from;
        found
    }

    fn search_contradiction(
        &mut self,
        end: DoubleDouble,
        enclosures: &mut u32,
    ) -> Result<Option<StepPart>, MotionError> {
        let sizes = self.sizes_within(end.high);
        let mut open = self.whole(end, &sizes);
        while let Some((begin, stop)) = open.pop() {
            if self.divides((begin, stop), end, &sizes, enclosures) {
                let middle = begin + (stop - begin) * DIVISION;
                open.push((middle, stop));
                open.push((begin, middle));
                continue;
            }
            let width = (stop - begin).high;
            let at = if open.is_empty() { begin + (stop - begin) * NEAR_THE_END } else { stop };
            if self.contradicts((at, width), &sizes)? {
                return Ok(Some((begin, stop)));
            }
        }
        Ok(None)
    }

    /// All of a step, as the only part that is still to be looked at. What is not even resolved at its beginning is asked for
    /// nowhere in it.
    fn whole(&mut self, end: DoubleDouble, sizes: &[f64]) -> Vec<StepPart> {
        self.enclosure.ask_all();
        if !self.resolves((DoubleDouble::ZERO, end), sizes) {
            self.resolves((DoubleDouble::ZERO, DoubleDouble::ZERO), sizes);
            self.enclosure.give_up();
        }
        vec![(DoubleDouble::ZERO, end)]
    }

    /// Whether a part of a step is to be divided.
    fn divides(
        &mut self,
        (begin, stop): StepPart,
        end: DoubleDouble,
        sizes: &[f64],
        enclosures: &mut u32,
    ) -> bool {
        let finest = end.high * if self.exact { FINEST.0 } else { FINEST.1 };
        if *enclosures == 0 || (stop - begin).high <= finest {
            return false;
        }
        *enclosures -= 1;
        !self.resolves((begin, stop), sizes)
    }

    /// Whether the series leads to a pole of the law within a step of this size, where the rates change what they change by many
    /// times itself in less than the time to it.
    pub(super) fn meets_pole(&mut self, x: f64) -> Result<bool, MotionError> {
        if !self.series.divisors().any(|u| may_vanish(&u.iter().copied(), x)) {
            return Ok(false);
        }
        let from = self.state.clone();
        let found = self.search_pole(DoubleDouble::from(x));
        self.state = from;
        found
    }

    fn search_pole(&mut self, end: DoubleDouble) -> Result<bool, MotionError> {
        let (sizes, scale) = (self.sizes_within(end.high), self.series.scale());
        let (mut open, mut enclosures) = (self.whole(end, &sizes), ENCLOSURES);
        while let Some((begin, stop)) = open.pop() {
            if self.divides((begin, stop), end, &sizes, &mut enclosures) {
                let middle = begin + (stop - begin) * DIVISION;
                open.push((middle, stop));
                open.push((begin, middle));
                continue;
            }
            self.series.state_after(stop * scale, &mut self.state);
            match self.evaluate_rates() {
                Err(error) if error.kind == MotionErrorKind::Cancelled => return Err(error),
                Err(_) => {}
                Ok(()) => {
                    let time = ((stop - begin).high * scale).abs();
                    let grows = |i: usize| self.rates.rate(i).high.abs() * time > POLE * sizes[i];
                    if (0..sizes.len()).any(grows) {
                        return Ok(true);
                    }
                }
            }
        }
        Ok(false)
    }

    /// The largest terms of the numbers that move within a step of this size.
    fn sizes_within(&self, x: f64) -> Vec<f64> {
        (0..self.rates.moving()).map(|i| largest_term(&self.series, i, x)).collect()
    }

    /// Whether everything narrow in the law is resolved in a part of the step.
    fn resolves(&mut self, (begin, stop): StepPart, sizes: &[f64]) -> bool {
        let (scale, middle) = (self.series.scale(), (begin + stop) * 0.5);
        let half = 0.5 * (stop - begin).high;
        self.series.state_after(middle * scale, &mut self.state);
        let (series, state) = (&self.series, &self.state);
        let around = |x: f64, by: f64| Interval::between(x - by, x + by, 1.0);
        let [first, last] = [begin, stop].map(|x| series.time() + x * scale);
        let time = Interval::of(first).hull(Interval::of(last));
        let numbers = (0..self.system.driven_len()).map(|i| {
            let spread = spread(series.coefficients(i), middle.high, half) * series.unit(i);
            around(state.values[i], spread)
        });
        self.enclosure.enclose(time, numbers);
        let width = (stop - begin).high * scale.abs();
        let harmless = sizes.iter().map(|size| (NOTHING * size).max(FAINT) / width);
        self.enclosure.is_resolved(harmless)
    }

    /// Whether the rates at a time are not those of the series, over a part of the step that is so wide. What has no value there, as
    /// 0/0 or what overflows, contradicts nothing.
    fn contradicts(
        &mut self,
        (at, width): (DoubleDouble, f64),
        sizes: &[f64],
    ) -> Result<bool, MotionError> {
        let scale = self.series.scale();
        self.series.state_after(at * scale, &mut self.state);
        match self.evaluate_rates() {
            Err(error) if error.kind == MotionErrorKind::Cancelled => return Err(error),
            Err(_) => return Ok(false),
            Ok(()) => {}
        }
        let (x, tolerance) = (at.high, self.tolerance);
        let mut rounding: Option<Vec<f64>> = None;
        for i in 0..self.series.inputs().min(self.rates.moving()) {
            let (series, unit) = (&self.series, self.series.unit(i));
            let coefficients = series.coefficients(i);
            let (_, slope) = value_and_slope(coefficients, x);
            let rate = self.rates.rate(i).high * scale / unit;
            let apart = (rate - slope).abs() * width;
            let shown = ROUNDING.max(tolerance) * largest_slope_term(coefficients, x) * width
                + UNSEEN.max(tolerance) * sizes[i] / unit;
            if apart <= shown || apart * unit < FAINT || !apart.is_finite() {
                continue;
            }
            let rounding = rounding.get_or_insert_with(|| {
                // what depends on more digits than are known of the motion is no evidence
                let errors = sizes.iter().map(|size| size * KNOWN.max(tolerance));
                rounding_at(&mut self.enclosure, &self.state, errors)
            });
            let by_rounding = rounding[i] * (scale / unit).abs() * width;
            if apart > shown + by_rounding {
                return Ok(true);
            }
        }
        Ok(false)
    }
}

/// The rounding of the rates at a state whose numbers have these errors.
fn rounding_at(
    enclosure: &mut Enclosure,
    state: &State,
    errors: impl Iterator<Item = f64>,
) -> Vec<f64> {
    enclosure
        .enclose(Interval::point(state.time), state.values.iter().map(|&x| Interval::point(x)));
    enclosure.rounding(errors).collect()
}

/// Whether a step of this size may pass a pole of the law of one of several orbits that its series does not show.
pub(super) fn may_hide_in_lane(series: &BatchSeries, lane: usize, x: f64) -> bool {
    series.divisors().any(|u| may_vanish(&u.iter().map(|c| c.0[lane]), x))
        || series.tangents().any(|(u, zero)| may_meet_pole(u.iter().map(|c| c.0[lane]), zero, x))
}

/// Whether a series may come near to zero within a step, by bounds of Horner's rule: for all of the step at once, and if that does
/// not tell, for pieces of it. The highest order is not known.
fn may_vanish(
    u: &(impl DoubleEndedIterator<Item = f64> + ExactSizeIterator + Clone),
    x: f64,
) -> bool {
    let orders = u.len() - 1;
    let first = u.clone().next().unwrap_or(0.0);
    let terms = || u.clone().take(orders).rev().map(|c| c * first.signum());
    let near = NEAR * first.abs();
    let least = terms().fold(0.0, |least: f64, c| c + least.min(0.0) * x);
    if least > near {
        return false;
    }
    let is_near = |k: u32| {
        let [a, b] = [k, k + 1].map(|k| x * f64::from(k) / f64::from(PIECES));
        let (low, _) = terms().fold((0.0_f64, 0.0_f64), |(low, high), c| {
            (c + (a * low).min(b * low), c + (a * high).max(b * high))
        });
        // a NaN is near
        low.is_nan() || low <= near
    };
    (0..PIECES).any(is_near)
}

/// Whether the argument of a tangent may come near to a pole within a step.
fn may_meet_pole(
    u: impl DoubleEndedIterator<Item = f64> + ExactSizeIterator + Clone,
    zero: f64,
    x: f64,
) -> bool {
    let room = to_pole(u.clone().next().unwrap_or(0.0) - zero);
    let orders = u.len() - 1;
    let excursion = u.take(orders).skip(1).rev().fold(0.0, |sum, c| (sum + c.abs()) * x);
    excursion >= (1.0 - NEAR) * room
}

/// How far an angle is from the nearest pole of the tangent.
fn to_pole(angle: f64) -> f64 {
    math::atan(1.0 / math::tan(angle)).abs()
}

/// The largest term of the series of a number within a step, in the units of states.
fn largest_term(series: &Series, i: usize, x: f64) -> f64 {
    let powers = std::iter::successors(Some(1.0), |power| Some(power * x));
    let terms = series.coefficients(i).iter().zip(powers).map(|(c, power)| (c * power).abs());
    terms.fold(0.0, f64::max) * series.unit(i)
}

/// The largest term of the slope of a series.
fn largest_slope_term(coefficients: &[f64], x: f64) -> f64 {
    let powers = std::iter::successors(Some(1.0), |power| Some(power * x));
    let terms = coefficients.iter().skip(1).zip(powers).zip(1..);
    terms.map(|((c, power), k): (_, u32)| (c * power * f64::from(k)).abs()).fold(0.0, f64::max)
}

/// The most by which a polynomial differs within so much of a place from its value there.
fn spread(coefficients: &[f64], middle: f64, half: f64) -> f64 {
    let mut shifted = [0.0; super::last_orders::ROOM];
    let degree = coefficients.iter().rposition(|&c| c != 0.0).unwrap_or(0);
    shifted[..=degree].copy_from_slice(&coefficients[..=degree]);
    for k in 0..=degree {
        for j in (k..degree).rev() {
            shifted[j] += middle * shifted[j + 1];
        }
    }
    (1..=degree).rev().fold(0.0, |sum, k| (sum + shifted[k].abs()) * half)
}
