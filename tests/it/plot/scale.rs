//! Scales and frames: round trips.

use std::f64::consts::PI;

use crate::nonempty;
use phaselab::view::glyphs::Glyphs;
use phaselab::view::plot::{PlotFrame, Scale};
use proptest::prelude::*;
use ratatui::layout::{Position, Rect};

#[test]
fn a_cells_middle_reads_back_as_the_cell() {
    let area = Rect::new(7, 3, 40, 11);
    let frames = [
        PlotFrame::new(Scale::linear(-2.0, 5.0), Scale::turn(), area),
        PlotFrame::new(Scale::log(1e-6, 1e3), Scale::linear(0.0, 1e-9), area),
    ];
    for frame in nonempty(frames) {
        for cell in nonempty(area.positions()) {
            assert_eq!(frame.cell(frame.at(cell)), Some(cell));
        }
    }
}

#[test]
fn the_readout_is_within_half_a_dot() {
    let area = Rect::new(0, 0, 40, 11);
    let frame = PlotFrame::new(Scale::linear(-2.0, 5.0), Scale::linear(0.0, 3.0), area);
    let (across, down) = Glyphs::Braille.dots();
    let [x, y] = frame.at(Position::new(10, 4));
    let dots = [
        frame.x.fraction(x) * 40.0 * f64::from(across),
        (1.0 - frame.y.fraction(y)) * 11.0 * f64::from(down),
    ];
    assert!((dots[0] - 21.0).abs() < 0.5 && (dots[1] - 18.0).abs() < 0.5, "{dots:?}");
}

#[test]
fn both_ends_of_a_range_are_on_the_screen() {
    let area = Rect::new(0, 0, 10, 10);
    let frame = PlotFrame::new(Scale::turn(), Scale::linear(0.0, 1.0), area);
    assert_eq!(frame.cell([-PI, 0.0]), Some(Position::new(0, 9)));
    assert_eq!(frame.cell([PI, 1.0]), Some(Position::new(9, 0)));
    assert_eq!(frame.cell([0.0, 1.01]), None);
    assert_eq!(frame.cell([0.0, f64::NAN]), None);
}

#[test]
fn an_angle_is_shown_once_a_turn() {
    let scale = Scale::turn();
    for turns in [-1000.0, -1.0, 0.0, 3.0] {
        assert!((scale.fraction(1.0 + turns * 2.0 * PI) - scale.fraction(1.0)).abs() < 1e-10);
    }
}

#[test]
fn zooming_keeps_the_value_under_the_cursor() {
    for scale in [Scale::linear(-3.0, 9.0), Scale::log(0.01, 1000.0)] {
        let zoomed = scale.zoomed(2.5, 0.3);
        assert!((zoomed.value(0.3) / scale.value(0.3) - 1.0).abs() < 1e-12);
        assert!(zoomed.fraction(scale.lo) < 0.0 && zoomed.fraction(scale.hi) > 1.0);
        let back = zoomed.zoomed(1.0 / 2.5, 0.3);
        assert!((back.lo - scale.lo).abs() < 1e-9 && (back.hi - scale.hi).abs() < 1e-9);
    }
}

#[test]
fn a_logarithmic_scale_has_no_place_for_what_is_not_positive() {
    let scale = Scale::log(-1.0, 100.0);
    assert!((scale.lo, scale.hi) == (0.1, 100.0));
    assert!(scale.fraction(0.0).is_nan() && scale.fraction(-5.0).is_nan());
    assert!((scale.fraction(1.0) - 1.0 / 3.0).abs() < 1e-12);
}

#[test]
fn equal_units_only_ever_widen_a_range() {
    let area = Rect::new(0, 0, 80, 20);
    let frame = PlotFrame::equal(Scale::linear(-1.0, 1.0), Scale::linear(-3.0, 3.0), area);
    assert_eq!((frame.y.lo, frame.y.hi), (-3.0, 3.0));
    assert_eq!((frame.x.lo, frame.x.hi), (-6.0, 6.0), "80 columns are twice as long as 20 rows");
}

proptest! {
    #[test]
    fn any_two_numbers_make_a_usable_range(lo in any::<f64>(), hi in any::<f64>(), at in 0.0..=1.0) {
        for scale in [Scale::linear(lo, hi), Scale::log(lo, hi)] {
            prop_assert!(scale.lo.is_finite() && scale.hi.is_finite() && scale.lo < scale.hi);
            let value = scale.value(at);
            prop_assert!(value.is_finite());
            prop_assert!((scale.fraction(value) - at).abs() < 1e-3, "{scale:?} {value}");
        }
    }
}
