//! The first root of a polynomial, with a guarantee.

use phaselab::integrate::first_crossing;

/// The coefficients of `sign · Π (x − r)`.
fn with_roots(roots: &[f64], sign: f64) -> Vec<f64> {
    roots.iter().fold(vec![sign], |c, r| {
        let mut longer = vec![0.0; c.len() + 1];
        for (i, c) in c.iter().enumerate() {
            longer[i + 1] += c;
            longer[i] -= r * c;
        }
        longer
    })
}

fn check(roots: &[f64], sign: f64, end: f64, expected: Option<f64>) {
    let found = first_crossing(&with_roots(roots, sign), end);
    match (found, expected) {
        // near a second root, rounding of the coefficients moves the first
        (Some(a), Some(b)) => assert!((a - b).abs() < 1e-9 * b, "{roots:?}: {a} and {b}"),
        (a, b) => assert_eq!(a, b, "{roots:?}"),
    }
}

#[test]
fn the_first_of_several_is_found() {
    check(&[0.25], -1.0, 1.0, Some(0.25));
    check(&[0.25], -1.0, 0.2, None);
    check(&[0.7, 0.3], 1.0, 1.0, Some(0.3));
    check(&[0.3, 0.300001, 0.9], -1.0, 1.0, Some(0.3));
    check(&[1e-9, 0.5, 0.6, 0.7], 1.0, 1.0, Some(1e-9));
    check(&[3.0, 7.0, 11.0], -1.0, 10.0, Some(3.0));
}

#[test]
fn a_touch_is_not_a_crossing() {
    check(&[0.5, 0.5], 1.0, 1.0, None);
    check(&[0.5, 0.5, 0.75], -1.0, 1.0, Some(0.75));
    check(&[-0.5, -2.0], 1.0, 1.0, None);
}

#[test]
fn a_pair_of_roots_within_one_step_is_not_overlooked() {
    // below zero for a millionth of the interval only
    check(&[0.4, 0.400_001], 1.0, 1.0, Some(0.4));
}

#[test]
fn high_degrees_are_no_trouble() {
    // sin(20 x + 1) cut off at order 60 crosses first at (π − 1)/20
    let mut c = Vec::new();
    let mut factor = 1.0;
    for k in 0..61 {
        let derivative = [1.0_f64.sin(), 1.0_f64.cos(), -1.0_f64.sin(), -1.0_f64.cos()][k % 4];
        c.push(derivative * factor);
        factor *= 20.0 / (k + 1) as f64;
    }
    let found = first_crossing(&c, 0.6).expect("it crosses");
    assert!((found - (std::f64::consts::PI - 1.0) / 20.0).abs() < 1e-14);
    assert_eq!(first_crossing(&c, 0.1), None);
}

/// Newton's iteration from the far end of an interval halves the distance at first, and there may be hundreds of halvings.
#[test]
fn a_root_is_found_at_the_beginning_of_any_interval() {
    for end in [1e3, 1e30, 1e88, 1e150] {
        let found = first_crossing(&[20.0, 0.0, -0.5], end).expect("it falls");
        assert!((found / 40.0_f64.sqrt() - 1.0).abs() < 1e-15, "{end:e}: {found:e}");
    }
}
