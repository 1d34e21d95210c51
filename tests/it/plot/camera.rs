//! The camera: face on, rotated, and always with the picture in view.

use std::f64::consts::{FRAC_PI_2, PI};

use phaselab::view::plot::{Bounds, Camera, Extent};
use proptest::prelude::*;
use ratatui::layout::Rect;

/// From the front, a little from the right and from above, z up.
pub(super) const IN_SPACE: Camera = Camera { yaw: PI / 6.0, pitch: PI / 9.0, ..Camera::FACE_ON };

fn close(found: [f64; 3], expected: [f64; 3]) {
    let near = found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12);
    assert!(near, "{found:?} is not {expected:?}");
}

#[test]
fn a_plane_system_is_seen_face_on_with_y_up() {
    close(Camera::FACE_ON.project([1.0, 2.0, 3.0]), [1.0, 2.0, 3.0]);
}

#[test]
fn from_the_front_z_is_up_and_what_is_behind_is_deeper() {
    let front = Camera { yaw: 0.0, pitch: 0.0, ..IN_SPACE };
    close(front.project([1.0, 0.0, 0.0]), [1.0, 0.0, 0.0]);
    close(front.project([0.0, 0.0, 1.0]), [0.0, 1.0, 0.0]);
    close(front.project([0.0, 1.0, 0.0]), [0.0, 0.0, -1.0]);
    let side = Camera { yaw: FRAC_PI_2, ..front };
    close(side.project([0.0, 1.0, 0.0]), [1.0, 0.0, 0.0]);
    close(side.project([1.0, 0.0, 0.0]), [0.0, 0.0, 1.0]);
}

#[test]
fn perspective_makes_near_things_larger_and_is_safe_behind_the_eye() {
    let camera = Camera { yaw: 0.0, pitch: 0.0, distance: Some(10.0), ..IN_SPACE };
    let [near, ..] = camera.project([1.0, -2.0, 0.0]);
    let [far, ..] = camera.project([1.0, 2.0, 0.0]);
    assert!((near - 1.25).abs() < 1e-12 && (far - 10.0 / 12.0).abs() < 1e-12);
    assert_eq!(camera.project([1.0, -50.0, 0.0])[0], 10.0);
}

#[test]
fn zoom_magnifies_and_pan_moves_the_picture() {
    let area = Rect::new(0, 0, 40, 20);
    let bounds = Bounds::around([[-1.0, -1.0, 0.0], [1.0, 1.0, 0.0]]);
    let plain = Camera::FACE_ON.frame(&bounds, area);
    let near = Camera { zoom: 2.0, ..Camera::FACE_ON }.frame(&bounds, area);
    assert!(((plain.x.hi - plain.x.lo) / (near.x.hi - near.x.lo) - 2.0).abs() < 1e-12);
    let moved = Camera { pan: [0.25, 0.0], ..Camera::FACE_ON }.frame(&bounds, area);
    let column = |frame: phaselab::view::plot::PlotFrame| frame.cell([0.01, 0.01]).unwrap().x;
    assert_eq!(column(moved), column(plain) + 10, "a quarter of 40 columns to the right");
}

/// How much of its area an outline with these extents fills, across and upwards.
fn filled(camera: Camera, extents: &[Extent], points: &[[f64; 3]], area: Rect) -> [f64; 2] {
    let frame = camera.frame_around(extents, area);
    let seen: Vec<_> = points.iter().map(|point| camera.project(*point)).collect();
    let across = seen.iter().map(|[x, _, _]| frame.x.fraction(*x));
    let up = seen.iter().map(|[_, y, _]| frame.y.fraction(*y));
    let span = |part: Vec<f64>| {
        let [low, high] =
            [part.iter().copied().reduce(f64::min), part.iter().copied().reduce(f64::max)];
        high.unwrap() - low.unwrap()
    };
    [span(across.collect()), span(up.collect())]
}

#[test]
fn a_scene_fills_its_area_in_one_direction_from_everywhere() {
    // A slanted rod: the box around it in space is far larger than what is seen of it.
    let ends = [[0.0, 0.0, 0.0], [2.0, 1.0, 3.0]];
    let rod = ends.map(|point| Extent { low: point, high: point, radius: 0.0, hull: None });
    for (wide, high) in [(40, 20), (80, 12), (20, 40)] {
        for turn in 0..24 {
            let camera = Camera { yaw: IN_SPACE.yaw + f64::from(turn) * PI / 12.0, ..IN_SPACE };
            let [x, y] = filled(camera, &rod, &ends, Rect::new(0, 0, wide, high));
            assert!((x.max(y) * 1.05 - 1.0).abs() < 1e-9, "{wide}×{high}, {turn}: {x} by {y}");
        }
    }
}

#[test]
fn a_ball_is_as_large_from_everywhere_and_whole() {
    let ball = [Extent { low: [1.0, 2.0, 3.0], high: [1.0, 2.0, 3.0], radius: 0.5, hull: None }];
    let area = Rect::new(0, 0, 40, 20);
    for turn in 0..24 {
        let (yaw, pitch) = (f64::from(turn) * PI / 12.0, f64::from(turn) / 24.0);
        let camera = Camera { yaw, pitch: (IN_SPACE.pitch + pitch).min(FRAC_PI_2), ..IN_SPACE };
        let frame = camera.frame_around(&ball, area);
        let [x, y, _] = camera.project([1.0, 2.0, 3.0]);
        assert!((frame.x.hi - frame.x.lo - 1.05).abs() < 1e-12);
        assert!(
            (frame.x.fraction(x) - 0.5).abs() < 1e-9 && (frame.y.fraction(y) - 0.5).abs() < 1e-9
        );
    }
}

proptest! {
    #[test]
    fn a_box_fits_its_frame_from_everywhere_with_equal_units(
        low in prop::array::uniform3(-10.0..0.0_f64),
        size in prop::array::uniform3(0.0..10.0_f64),
        yaw in -PI..PI,
        pitch in -FRAC_PI_2..FRAC_PI_2,
        wide in 1_u16..200,
        high in 1_u16..100,
    ) {
        let high_corner = std::array::from_fn(|i| low[i] + size[i]);
        let bounds = Bounds::around([low, high_corner]);
        let camera = Camera { yaw, pitch, ..IN_SPACE };
        let frame = camera.frame(&bounds, Rect::new(0, 0, wide, high));
        for corner in 0..8 {
            let point = std::array::from_fn(|i| if corner >> i & 1 == 0 { low[i] } else { high_corner[i] });
            let [x, y, _] = camera.project(point);
            prop_assert!((0.0..=1.0).contains(&frame.x.fraction(x)));
            prop_assert!((0.0..=1.0).contains(&frame.y.fraction(y)));
        }
        let unit = (frame.x.hi - frame.x.lo) / f64::from(wide);
        let up = (frame.y.hi - frame.y.lo) / (2.0 * f64::from(high));
        prop_assert!((unit / up - 1.0).abs() < 1e-9);
    }

    #[test]
    fn a_turn_keeps_lengths(point in prop::array::uniform3(-5.0..5.0_f64), yaw in -PI..PI, pitch in -1.5..1.5_f64) {
        let seen = Camera { yaw, pitch, ..IN_SPACE }.project(point);
        let length = |p: [f64; 3]| p.iter().map(|v| v * v).sum::<f64>();
        prop_assert!((length(seen) - length(point)).abs() < 1e-12 * (1.0 + length(point)));
    }
}
