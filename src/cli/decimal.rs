//! Numbers as text that reads back to the same bits, and times at exact decimals.

use std::fmt::Write as _;

use crate::num::Number;

/// The shortest decimal that reads back to the same `f64`: `0.1`, `2.0`, `1e-9`. Returns `None` if
/// the number is not finite.
pub(super) fn shortest(x: f64) -> Option<String> {
    x.is_finite().then(|| {
        let mut text = String::new();
        push_shortest(&mut text, x);
        text
    })
}

/// Appends [`shortest`]; nothing if the number is not finite.
pub(super) fn push_shortest(out: &mut String, x: f64) {
    if (1e-4..1e16).contains(&x.abs()) {
        // there the two agree, and this one is several times as fast
        out.push_str(ryu::Buffer::new().format_finite(x));
    } else if x.is_finite() {
        // writing to a String cannot fail
        let _ = write!(out, "{x:?}");
    }
}

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_is_the_shortest_that_reads_back() {
        let edges = [0.0, -0.0, 1.0, 0.1, 1e-4, 1e15, 1e16, 1e17, 1e-5, f64::MAX, 5e-324, 1e300];
        let around = edges.into_iter().flat_map(|x| [x, x.next_up(), x.next_down(), -x]);
        let mut seed = 7_u64;
        let random = (0..50_000).map(|k| {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            let any = f64::from_bits(seed);
            if k % 2 == 0 {
                any
            } else {
                (seed >> 20) as f64 / [1.0, 1e6, 1e12, 1e18][(seed % 4) as usize]
            }
        });
        for x in around.chain(random).filter(|x| x.is_finite()) {
            let (text, other) = (shortest(x).expect("finite"), format!("{x:?}"));
            assert_eq!(text.parse::<f64>().map(f64::to_bits), Ok(x.to_bits()), "{text}");
            // of two shortest decimals that are equally near, either may be taken
            assert_eq!(text.len(), other.len(), "{text} {other}");
        }
        for x in [0.0, -0.0, 1.0, 0.1, -2.5e-3, 1e15, 1e16, 1e-5, f64::MAX, 5e-324] {
            assert_eq!(shortest(x), Some(format!("{x:?}")));
        }
        assert_eq!((shortest(f64::NAN), shortest(f64::INFINITY)), (None, None));
    }
}
