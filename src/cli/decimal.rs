//! Times at exact decimals, and the sizes of errors.

use crate::num::Number;

/// An error or a residual to two digits; 0 where there is none.
pub(super) fn magnitude(x: f64) -> String {
    if x == 0.0 { "0".to_owned() } else { format!("{x:.1e}") }
}

/// The times `start, start + every, …` up to `until`. They are computed in exact decimals, so that
/// the third multiple of 0.1 is 0.3 and the last one is not lost to rounding.
pub(super) fn multiples(start: f64, every: f64, until: f64) -> impl Iterator<Item = f64> + Clone {
    let [first, gap, last] = [start, every, until].map(exact);
    let time = move |k: i64| (first + gap * Number::integer(k)).value();
    let wanted = ((last + -first).value() / gap.value()).round() as i64;
    // an interval that is not a short decimal is itself rounded, so its multiple may miss the end
    // slightly
    let close = (time(wanted) - until).abs() <= 4.0 * f64::EPSILON * until.abs();
    let count = if close || time(wanted) < until { wanted } else { wanted - 1 };
    (0..=count).map(move |k| if close && k == wanted { until } else { time(k) })
}

/// `count + 1` evenly spaced times from `start` to `until`, both included.
pub(super) fn divisions(start: f64, until: f64, count: u32) -> impl Iterator<Item = f64> + Clone {
    let (first, last) = (exact(start), exact(until));
    let length = last + -first;
    let time = move |k: u32| {
        let part = Number::ratio(i128::from(k), i128::from(count));
        if k == count { until } else { (first + length * part).value() }
    };
    (0..=count).map(time)
}

fn exact(x: f64) -> Number {
    Number::Real(x).canonical()
}
