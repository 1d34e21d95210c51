//! The root of a function of one number, where all that is known of it is a side or a slope.
//!
//! In: places, and questions about a place. Out: a place. Never here: functions known by their series, whose roots are isolated
//! first (`integrate::roots`), and unknowns that are several numbers.

/// The two places to which an interval shrinks by halves, at most so often, or until they are neighbours: `is_first` says of a
/// place whether it is on the side of the first end.
///
/// # Errors
/// Returns the error of a place that has no answer.
pub fn bisect<E>(
    [mut first, mut last]: [f64; 2],
    halvings: u32,
    mut is_first: impl FnMut(f64) -> Result<bool, E>,
) -> Result<[f64; 2], E> {
    for _ in 0..halvings {
        let middle = f64::midpoint(first, last);
        if middle == first || middle == last {
            break;
        }
        if is_first(middle)? { first = middle } else { last = middle }
    }
    Ok([first, last])
}

/// The halvings of an interval that lead from the largest number to the smallest, and on to the last digit of a root.
pub const ALL_HALVINGS: u32 = 2200;

/// The simple root near a number of the order of one, by Newton's method: `correction` is the value divided by the slope.
pub fn newton(mut x: f64, most: u32, mut correction: impl FnMut(f64) -> f64) -> f64 {
    for _ in 0..most {
        let change = correction(x);
        x -= change;
        if change.abs() < 1e-16 {
            break;
        }
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_lead_to_neighbours_on_both_sides_of_the_root_of_two() {
        for ends in [[0.0, 2.0], [2.0, 0.0]] {
            let below = |x: f64| x * x < 2.0;
            let found = bisect(ends, ALL_HALVINGS, |x| Ok::<_, ()>(below(x) == below(ends[0])));
            let [first, last] = found.expect("every place has an answer");
            assert_eq!(below(first), below(ends[0]));
            assert_ne!(below(last), below(ends[0]));
            assert_eq!(first.to_bits().abs_diff(last.to_bits()), 1);
        }
    }

    #[test]
    fn no_more_halves_are_taken_than_allowed_and_an_error_ends_it() {
        let mut asked = 0;
        let ends = bisect([0.0, 1.0], 3, |_| {
            asked += 1;
            Ok::<_, ()>(true)
        });
        assert_eq!((ends, asked), (Ok([0.875, 1.0]), 3));
        assert_eq!(bisect([0.0, 1.0], 3, |x| if x > 0.6 { Err(x) } else { Ok(true) }), Err(0.75));
    }

    #[test]
    fn newton_finds_a_root_to_the_last_digit_and_stops_where_there_is_none() {
        let root = newton(1.0, 50, |x| (x * x - 2.0) / (2.0 * x));
        assert!((root - std::f64::consts::SQRT_2).abs() <= f64::EPSILON, "{root}");
        let mut steps = 0;
        newton(0.5, 20, |x| {
            steps += 1;
            (x * x + 1.0) / (2.0 * x)
        });
        assert_eq!(steps, 20);
    }
}
