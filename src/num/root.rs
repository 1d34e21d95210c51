//! The root or the least value of a function of one number that is known by its values, its side or its slope at a place.
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

/// The two places around a zero to which an interval shrinks, given with the function's values of opposite signs at its ends: by
/// secants whose value at an end that stays is halved (the Illinois algorithm: M. Dowell, P. Jarratt, BIT 11 (1971) 168), and
/// every fourth time by halves. It ends after so many rounds, where the ends are neighbours or as near as this part of the last
/// one, or at a place whose value is zero, which is returned twice.
///
/// # Errors
/// Returns the error of a place that has no value.
pub fn false_position<E>(
    [mut first, mut last]: [(f64, f64); 2],
    (rounds, close): (u32, f64),
    mut value: impl FnMut(f64) -> Result<f64, E>,
) -> Result<[f64; 2], E> {
    let mut stays = None;
    for round in 0..rounds {
        let middle = f64::midpoint(first.0, last.0);
        if middle <= first.0 || middle >= last.0 || last.0 - first.0 <= close * last.0.abs() {
            break;
        }
        let secant = first.0 - first.1 * (last.0 - first.0) / (last.1 - first.1);
        let is_inside = secant > first.0 && secant < last.0;
        let place = if is_inside && round % 4 != 3 { secant } else { middle };
        let found = value(place)?;
        if found == 0.0 {
            return Ok([place; 2]);
        }
        let is_first = (found > 0.0) == (first.1 > 0.0);
        let (moves, other) =
            if is_first { (&mut first, &mut last) } else { (&mut last, &mut first) };
        *moves = (place, found);
        if stays == Some(!is_first) {
            other.1 *= 0.5;
        }
        stays = Some(!is_first);
    }
    Ok([first.0, last.0])
}

/// The reciprocal of the golden ratio.
pub const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// The two places to which golden sections shrink an interval around the least value of a function in it (J. Kiefer, Proc. Amer.
/// Math. Soc. 4 (1953) 502).
///
/// # Errors
/// Returns the error of a place that has no value.
pub fn golden_section<E>(
    [mut low, mut high]: [f64; 2],
    sections: u32,
    mut value: impl FnMut(f64) -> Result<f64, E>,
) -> Result<[f64; 2], E> {
    let (mut a, mut b) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
    let (mut at_a, mut at_b) = (value(a)?, value(b)?);
    for _ in 0..sections {
        if at_a < at_b {
            (high, b, at_b) = (b, a, at_a);
            a = high - GOLDEN * (high - low);
            at_a = value(a)?;
        } else {
            (low, a, at_a) = (a, b, at_b);
            b = low + GOLDEN * (high - low);
            at_b = value(b)?;
        }
    }
    Ok([low, high])
}

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
    fn secants_lead_to_neighbours_around_the_root_of_two_faster_than_halves() {
        for sign in [1.0, -1.0] {
            let square = |x: f64| sign * (x * x - 2.0);
            let mut asked = 0;
            let ends = [(0.0, square(0.0)), (2.0, square(2.0))];
            let found = false_position(ends, (200, 0.0), |x| {
                asked += 1;
                Ok::<_, ()>(square(x))
            });
            let [first, last] = found.expect("every place has a value");
            assert!(first.to_bits().abs_diff(last.to_bits()) <= 1, "{first:e} {last:e}");
            assert!(square(first) * square(last) <= 0.0);
            assert!(asked < 20, "{asked}");
        }
    }

    #[test]
    fn secants_end_as_near_as_asked_at_a_zero_or_with_the_error_of_a_place() {
        let ends = [(1.0, -1.0), (2.0, 2.0)];
        let near = false_position(ends, (200, 0.1), |x| Ok::<_, ()>(x * x - 2.0));
        let [first, last] = near.expect("every place has a value");
        assert!(last - first <= 0.1 * last && first < last, "{first} {last}");
        assert_eq!(
            false_position([(0.0, -1.0), (2.0, 1.0)], (9, 0.0), |x| Ok::<_, ()>(x - 1.0)),
            Ok([1.0; 2])
        );
        assert_eq!(false_position(ends, (9, 0.0), Err), Err(4.0 / 3.0));
    }

    #[test]
    fn golden_sections_shrink_around_the_least_value() {
        let found = golden_section([0.0, 3.0], 30, |x| Ok::<_, ()>((x - 1.0) * (x - 1.0)));
        let [low, high] = found.expect("every place has a value");
        assert!(low <= 1.0 && 1.0 <= high && high - low < 1.8e-6, "{low} {high}");
        assert_eq!(
            golden_section([0.0, 1.0], 1, |x| if x < 0.5 { Err(x) } else { Ok(x) }),
            Err(1.0 - GOLDEN)
        );
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
