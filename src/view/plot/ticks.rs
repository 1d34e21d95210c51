//! Ticks: which values of an axis are marked, and the fewest digits that distinguish them.
//!
//! In: a [`Scale`] and the number of ticks that fit. Out: values with labels, and a common power of ten for the
//! axis title. Never here: cells.

use std::f64::consts::PI;

use super::scale::{Scale, ScaleKind};
use crate::num::math;
use crate::view::glyphs::Glyphs;
use crate::view::number::{raised, signed};

/// A marked value.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// The value, in the units of the axis.
    pub value: f64,
    /// The label, to be multiplied by the common power of ten.
    pub label: String,
}

/// The ticks of an axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ticks {
    /// In ascending order, all within the range.
    pub marks: Vec<Tick>,
    /// The power of ten taken out of all labels.
    pub exponent: i32,
}

impl Ticks {
    /// Returns at most `most` ticks of a scale.
    pub fn of(scale: &Scale, most: usize, glyphs: Glyphs) -> Self {
        let special = match scale.kind {
            ScaleKind::Linear => None,
            ScaleKind::Angle => angles(scale, most, glyphs),
            ScaleKind::Log => decades(scale, most, glyphs),
        };
        special.unwrap_or_else(|| evenly(scale.lo, scale.hi, most, glyphs))
    }
}

/// A range for data between `lo` and `hi`: padded by about a twentieth and extended to round numbers, so that it does
/// not change while the data grow a little. Padding never extends data of one sign across zero.
pub fn nice_range(lo: f64, hi: f64) -> (f64, f64) {
    let Scale { lo: low, hi: high, .. } = Scale::linear(lo, hi);
    let half = high / 2.0 - low / 2.0;
    let Some(step) = TickStep::at_least(half / 5.0) else { return (low, high) };
    let step = step.value();
    let round = |value: f64, out: fn(f64) -> f64| {
        let rounded = out(value / step) * step;
        if rounded.is_finite() { rounded } else { value }
    };
    let down = round(low - half * 0.1, f64::floor);
    let up = round(high + half * 0.1, f64::ceil);
    let down = if low >= 0.0 { down.max(0.0) } else { down };
    let up = if high <= 0.0 { up.min(0.0) } else { up };
    let range = Scale::linear(down, up);
    (range.lo.min(low), range.hi.max(high))
}

/// A step of 1, 2 or 5 times a power of ten.
#[derive(Clone, Copy)]
struct TickStep {
    digit: i64,
    exponent: i32,
}

impl TickStep {
    /// The least such step not below `length`.
    fn at_least(length: f64) -> Option<Self> {
        if !length.is_finite() || length <= 0.0 {
            return None;
        }
        let exponent = math::log10(length).floor() as i32;
        let steps = [-1, 0, 1]
            .into_iter()
            .flat_map(|e| [1, 2, 5].map(|digit| Self { digit, exponent: exponent + e }));
        steps.into_iter().find(|step| step.value() >= length * (1.0 - 1e-12))
    }

    /// The next larger step.
    fn next(self) -> Self {
        match self.digit {
            1 => Self { digit: 2, ..self },
            2 => Self { digit: 5, ..self },
            _ => Self { digit: 1, exponent: self.exponent + 1 },
        }
    }

    fn previous(self) -> Self {
        match self.digit {
            5 => Self { digit: 2, ..self },
            2 => Self { digit: 1, ..self },
            _ => Self { digit: 5, exponent: self.exponent - 1 },
        }
    }

    fn value(self) -> f64 {
        self.times(1)
    }

    /// `count` steps, rounded once if the power of ten is exact.
    fn times(self, count: i64) -> f64 {
        let number = (count * self.digit) as f64;
        match self.exponent {
            0.. => number * math::powi(10.0, self.exponent),
            -300..0 => number / math::powi(10.0, -self.exponent),
            _ => number / 1e300 / math::powi(10.0, -300 - self.exponent),
        }
    }
}

fn evenly(lo: f64, hi: f64, most: usize, glyphs: Glyphs) -> Ticks {
    if most == 0 {
        return Ticks::default();
    }
    let span = |step: TickStep| ((lo / step.value()).ceil(), (hi / step.value()).floor());
    let Some(mut step) = TickStep::at_least((hi / 2.0 - lo / 2.0) / most as f64 * 2.0) else {
        return Ticks::default();
    };
    let (mut first, mut last) = span(step);
    while last - first + 1.0 > most as f64 {
        step = step.next();
        (first, last) = span(step);
    }
    // A coarse step may leave only one tick in the range, which does not show its scale. Then the ticks of a finer
    // step are used: every one, or every second or third.
    let fewest = most.min(2) as f64;
    while last - first + 1.0 < fewest && first.abs() < 1e15 {
        step = step.previous();
        (first, last) = span(step);
    }
    let stride = ((last - first) / (most as f64 - 1.0).max(0.5)).ceil().max(1.0);
    let through_zero = -(-first / stride).floor() * stride;
    if first <= 0.0 && last >= 0.0 && last - through_zero >= stride * (fewest - 1.0) {
        first = through_zero;
    }
    // A range far from zero in very small steps would need more digits than an `f64` has.
    if first.abs().max(last.abs()) > 1e15 {
        return Ticks::default();
    }
    let largest = step.times(first.abs().max(last.abs()) as i64);
    let exponent = common_exponent(lo.abs().max(hi.abs()), largest, step.exponent);
    let marks = (first as i64..=last as i64)
        .step_by(stride as usize)
        .map(|count| (count, step.times(count)))
        .filter(|(_, value)| (lo..=hi).contains(value))
        .map(|(count, value)| Tick {
            value,
            label: signed(decimal(count * step.digit, step.exponent - exponent), glyphs),
        })
        .collect();
    Ticks { marks, exponent }
}

/// The power of ten to take out of the labels of an axis that reaches to `size`; 0 for numbers of ordinary magnitude. Labels are
/// then whole multiples of the step, from 1 to 999; a step that is small beside the largest tick has decimals.
fn common_exponent(size: f64, largest: f64, of_step: i32) -> i32 {
    if (1e-2..1e5).contains(&size) || largest == 0.0 {
        return 0;
    }
    of_step.max(math::log10(largest).floor() as i32 - 2)
}

/// Formats `number` × 10^`exponent` in full; zero needs no decimals.
fn decimal(number: i64, exponent: i32) -> String {
    let digits = number.unsigned_abs().to_string();
    let sign = if number < 0 { "-" } else { "" };
    if number == 0 {
        return "0".to_owned();
    }
    if exponent >= 0 {
        return format!("{sign}{digits}{}", "0".repeat(exponent as usize));
    }
    let decimals = exponent.unsigned_abs() as usize;
    let padded = format!("{digits:0>width$}", width = decimals + 1);
    let (whole, part) = padded.split_at(padded.len() - decimals);
    format!("{sign}{whole}.{part}")
}

/// Fractions of π, or `None` if the range is so small or so large that plain numbers are clearer.
fn angles(scale: &Scale, most: usize, glyphs: Glyphs) -> Option<Ticks> {
    // Numerator and denominator of the step.
    const STEPS: [(i64, i64); 9] =
        [(1, 8), (1, 4), (1, 2), (1, 1), (2, 1), (5, 1), (10, 1), (20, 1), (50, 1)];
    if scale.hi - scale.lo < PI / 4.0 {
        return None;
    }
    // Ends given as multiples of π differ from their ticks by rounding.
    let slack = (scale.hi - scale.lo) * 1e-9;
    STEPS.into_iter().find_map(|(over, under)| {
        let step = PI * over as f64 / under as f64;
        let first = ((scale.lo - slack) / step).ceil();
        let last = ((scale.hi + slack) / step).floor();
        if last - first + 1.0 > most as f64 {
            return None;
        }
        let mark = |count: i64| Tick {
            value: (count as f64 * step).clamp(scale.lo, scale.hi),
            label: of_pi(count * over, under, glyphs),
        };
        Some(Ticks { marks: (first as i64..=last as i64).map(mark).collect(), exponent: 0 })
    })
}

/// Formats `over`/`under` × π in lowest terms; `under` is a power of two.
fn of_pi(mut over: i64, mut under: i64, glyphs: Glyphs) -> String {
    while under > 1 && over % 2 == 0 {
        (over, under) = (over / 2, under / 2);
    }
    let pi = glyphs.pick("π", "pi");
    let factor = match over {
        0 => return "0".to_owned(),
        1 => pi.to_owned(),
        -1 => format!("-{pi}"),
        _ => format!("{over}{pi}"),
    };
    signed(if under == 1 { factor } else { format!("{factor}/{under}") }, glyphs)
}

/// Powers of ten, or 1, 2, 5 within few decades; `None` below one decade, for which linear steps are better.
fn decades(scale: &Scale, most: usize, glyphs: Glyphs) -> Option<Ticks> {
    let (low, high) = (math::log10(scale.lo) - 1e-9, math::log10(scale.hi) + 1e-9);
    let (first, last) = (low.ceil() as i32, high.floor() as i32);
    if last <= first {
        return None;
    }
    let value = |digit: i64, exponent: i32| TickStep { digit, exponent }.value();
    let plain = first >= -3 && last <= 4;
    let label = |digit: i64, exponent: i32| match (plain, glyphs.is_ascii()) {
        (true, _) => decimal(digit, exponent),
        (false, true) => format!("{digit}e{exponent}"),
        (false, false) => format!("10{}", raised(exponent)),
    };
    let mark = |digit: i64, exponent: i32| Tick {
        value: value(digit, exponent).clamp(scale.lo, scale.hi),
        label: label(digit, exponent),
    };
    let fine: Vec<_> = (first - 1..=last)
        .flat_map(|exponent| [1, 2, 5].map(|digit| (digit, exponent)))
        .filter(|(digit, exponent)| {
            (low..=high).contains(&(math::log10(*digit as f64) + f64::from(*exponent)))
        })
        .collect();
    let marks: Vec<_> = if plain && fine.len() <= most {
        fine.into_iter().map(|(digit, exponent)| mark(digit, exponent)).collect()
    } else {
        let count = (last - first + 1) as usize;
        let stride = count.div_ceil(most.max(1)).max(1);
        // Exponents are counted from 10⁰, so that panning does not change the choice.
        (first..=last).filter(|e| e.rem_euclid(stride as i32) == 0).map(|e| mark(1, e)).collect()
    };
    (marks.len() <= most).then_some(Ticks { marks, exponent: 0 })
}
