//! Numbers as text that reads back to the same bits, and times at exact decimals.

use crate::num::Number;

/// The shortest decimal that reads back to the same `f64`: `0.1`, `2.0`, `1e-9`. Returns `None` if
/// the number is not finite.
pub(super) fn shortest(x: f64) -> Option<String> {
    x.is_finite().then(|| format!("{x:?}"))
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
