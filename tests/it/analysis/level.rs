//! Level curves: they lie on the level, close where they should, and never cross a NaN.

use phaselab::analysis::Grid;
use proptest::prelude::*;

/// Samples a function on a square from −2 to 2.
fn sampled(count: usize, f: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let at = |i: usize| -2.0 + 4.0 * i as f64 / (count - 1) as f64;
    (0..count).flat_map(|j| (0..count).map(move |i| (i, j))).map(|(i, j)| f(at(i), at(j))).collect()
}

fn curves(count: usize, values: &[f64], level: f64) -> Vec<Vec<[f64; 2]>> {
    let range = (count, [-2.0, 2.0]);
    Grid { x: range, y: range, values }.curves(level)
}

#[test]
fn a_circle_is_one_closed_curve_of_its_radius() {
    let values = sampled(41, |x, y| x * x + y * y);
    let found = curves(41, &values, 1.0);
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].first(), found[0].last());
    for [x, y] in &found[0] {
        // Linear interpolation of a parabola on cells of 0.1 has an error of at most h²/8 in the value.
        assert!((x * x + y * y - 1.0).abs() < 0.1 * 0.1 / 4.0, "{x} {y}");
    }
    let length: f64 =
        found[0].windows(2).map(|p| (p[1][0] - p[0][0]).hypot(p[1][1] - p[0][1])).sum();
    assert!((length - std::f64::consts::TAU).abs() < 0.02, "{length}");
}

#[test]
fn a_straight_level_is_one_open_curve_from_edge_to_edge() {
    let found = curves(9, &sampled(9, |x, y| x + 2.0 * y), 0.3);
    assert_eq!(found.len(), 1);
    let ends = [found[0][0], *found[0].last().unwrap()];
    assert!(ends.iter().all(|[x, _]| x.abs() == 2.0), "{ends:?}");
    assert!(found[0].iter().all(|[x, y]| (x + 2.0 * y - 0.3).abs() < 1e-12));
}

#[test]
fn a_saddle_has_two_branches_on_the_sides_of_its_sign() {
    let values = sampled(20, |x, y| x * y);
    for level in [0.01, -0.01] {
        let found = curves(20, &values, level);
        assert_eq!(found.len(), 2);
        for [x, y] in found.iter().flatten() {
            assert!(x * y * level > 0.0 || x.abs().min(y.abs()) < 0.12, "{x} {y}");
        }
    }
}

#[test]
fn what_is_not_finite_is_left_out() {
    let values = sampled(21, |x, y| if x > 0.0 { f64::NAN } else { x * x + y * y });
    let found = curves(21, &values, 1.0);
    assert_eq!(found.len(), 1);
    assert!(found[0].iter().all(|[x, _]| *x <= 1e-12));
    assert!(curves(21, &[], 1.0).is_empty());
    assert!(curves(5, &[f64::INFINITY; 25], 1.0).is_empty());
}

/// Curves of values in the corners of cells of side one, given row by row from the lowest.
fn curves_of<const N: usize>(rows: &[[f64; N]], level: f64) -> Vec<Vec<[f64; 2]>> {
    let ends = |count: usize| (count, [0.0, (count - 1) as f64]);
    let values = rows.as_flattened();
    Grid { x: ends(N), y: ends(rows.len()), values }.curves(level)
}

#[test]
fn a_saddle_is_resolved_by_the_mean_of_its_corners() {
    // the mean is 1/2: below it the low corners are cut off, above it the high ones
    let cell = [[1.0, 0.0], [0.0, 1.0]];
    let table = [
        (0.25, [[[0.75, 0.0], [1.0, 0.25]], [[0.25, 1.0], [0.0, 0.75]]]),
        (0.5, [[[0.5, 0.0], [1.0, 0.5]], [[0.5, 1.0], [0.0, 0.5]]]),
        (0.75, [[[0.0, 0.25], [0.25, 0.0]], [[1.0, 0.75], [0.75, 1.0]]]),
    ];
    for (level, expected) in table {
        assert_eq!(curves_of(&cell, level), expected, "{level}");
        // turned by a right angle, the other corners are high
        let turned = expected.map(|curve| curve.map(|[x, y]| [1.0 - x, y]));
        let sorted = |mut curves: Vec<Vec<[f64; 2]>>| {
            for curve in &mut curves {
                curve.sort_by(|a, b| a[0].total_cmp(&b[0]));
            }
            curves.sort_by(|a, b| a[0][0].total_cmp(&b[0][0]));
            curves
        };
        let turned = sorted(turned.iter().map(|curve| curve.to_vec()).collect());
        assert_eq!(sorted(curves_of(&[[0.0, 1.0], [1.0, 0.0]], level)), turned, "{level}");
    }
}

#[test]
fn a_cell_with_a_corner_that_is_not_finite_has_no_curve() {
    // the curve y = 1/2 without the cells that touch the corner
    let line = |from: f64, to: f64| vec![vec![[from, 0.5], [to, 0.5]]];
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let table = [
            ([[bad, 0.0, 0.0], [1.0, 1.0, 1.0]], line(2.0, 1.0)),
            ([[0.0, 0.0, 0.0], [bad, 1.0, 1.0]], line(2.0, 1.0)),
            ([[0.0, 0.0, bad], [1.0, 1.0, 1.0]], line(1.0, 0.0)),
            ([[0.0, 0.0, 0.0], [1.0, 1.0, bad]], line(1.0, 0.0)),
            ([[0.0, bad, 0.0], [1.0, 1.0, 1.0]], vec![]),
            ([[0.0, 0.0, 0.0], [1.0, bad, 1.0]], vec![]),
        ];
        for (rows, expected) in table {
            assert_eq!(curves_of(&rows, 0.5), expected, "{rows:?}");
        }
    }
}

#[test]
fn several_levels_at_once_have_the_curves_of_each() {
    let values =
        sampled(
            23,
            |x, y| {
                if x > 1.0 && y > 1.0 { f64::NAN } else { x.powi(3) - x + y * y * (1.0 - x) }
            },
        );
    let range = (23, [-2.0, 2.0]);
    let grid = Grid { x: range, y: range, values: &values };
    let levels = [-7.0, -0.5, -0.5, 0.0, 0.1, 0.4, 3.0, 40.0];
    let together = grid.curves_of_all(&levels);
    assert_eq!(together.len(), levels.len());
    for (level, curves) in levels.into_iter().zip(&together) {
        assert_eq!(*curves, grid.curves(level), "{level}");
    }
    let points: Vec<usize> = together.iter().map(|curves| curves.concat().len()).collect();
    assert!(points[1..7].iter().all(|&count| count > 10) && points[7] == 0, "{points:?}");
}

proptest! {
    #[test]
    fn any_values_give_points_inside_the_grid(
        values in prop::collection::vec(any::<f64>(), 0..60),
        level in any::<f64>(),
        wide in 0_usize..9,
        high in 0_usize..9,
    ) {
        let grid = Grid { x: (wide, [-1.0, 1.0]), y: (high, [0.0, 3.0]), values: &values };
        for [x, y] in grid.curves(level).into_iter().flatten() {
            prop_assert!((-1.0..=1.0).contains(&x) && (0.0..=3.0).contains(&y));
        }
    }
}
