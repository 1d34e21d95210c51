//! The arrows of a vector field, and its nullclines.
//!
//! In: a field, the frame of the axes. Out: a character for each arrow, dots for curves. Never here: rates.

use std::f64::consts::TAU;

use super::canvas::Canvas;
use super::glyphs::Glyphs;
use super::ink::pen;
use super::plot::scale::CELL_ASPECT;
use super::plot::{Pen, PlotFrame, Raster};
use super::theme::Role;
use crate::instrument::{Ink, Level, PlaneField};
use crate::num::math;

/// The cells from one arrow to the next, which look equally far apart in both directions.
const SPACING: [u16; 2] = [4, 2];

/// The step along the field, in parts of the axes, by which its direction on the screen is found.
const STEP: f64 = 1e-4;

/// Directions by eighths of a turn, from the right towards the top, and by quarters: the fonts of consoles lack the others, and in
/// ASCII a slash has no sense.
const EIGHTHS: [char; 8] = ['→', '↗', '↑', '↖', '←', '↙', '↓', '↘'];
const QUARTERS: [char; 4] = ['→', '↑', '←', '↓'];
const ASCII: [char; 4] = ['>', '^', '<', 'v'];

/// Draws an arrow at each place of an even grid: the direction alone.
pub(super) fn arrows(
    canvas: &Canvas<'_>,
    raster: &mut Raster,
    (frame, field): (&PlotFrame, &PlaneField),
    level: Level,
) {
    let glyphs = canvas.style.glyphs;
    let stroke = Pen::new(canvas.style(Role::Border), level);
    let mut rates = field.rates();
    let [across, down] = SPACING;
    let area = frame.area;
    let size = [f64::from(area.width), CELL_ASPECT * f64::from(area.height)];
    for row in (down / 2..area.height).step_by(down.into()) {
        for column in (across / 2..area.width).step_by(across.into()) {
            let share = [(column, area.width), (row, area.height)]
                .map(|(cell, count)| (f64::from(cell) + 0.5) / f64::from(count));
            let at = [frame.x.value(share[0]), frame.y.value(1.0 - share[1])];
            let direction = rates.at(at).and_then(|rate| direction(frame, at, rate, size));
            let Some([right, up]) = direction else { continue };
            let sign = arrow(glyphs, math::atan2(up, right));
            raster.character([column, row], sign, &stroke);
        }
    }
}

/// The arrow nearest to an angle, from the right towards the top.
fn arrow(glyphs: Glyphs, angle: f64) -> char {
    let signs: &[char] = match glyphs {
        Glyphs::Ascii => &ASCII,
        Glyphs::HalfBlock => &QUARTERS,
        _ => &EIGHTHS,
    };
    let part = (angle / TAU * signs.len() as f64).round() as i64;
    signs[part.rem_euclid(signs.len() as i64) as usize]
}

/// The direction of a rate on the screen, right and up, as a unit vector.
fn direction(frame: &PlotFrame, at: [f64; 2], rate: [f64; 2], size: [f64; 2]) -> Option<[f64; 2]> {
    let lengths = [frame.x.hi - frame.x.lo, frame.y.hi - frame.y.lo];
    let fastest = (rate[0] / lengths[0]).abs().max((rate[1] / lengths[1]).abs());
    let time = STEP / fastest;
    let scales = [frame.x, frame.y];
    // back and forth, because an axis may wrap at either side
    let moved = [0, 1].map(|k| {
        let place = |by: f64| scales[k].fraction(at[k] + by * time * rate[k]) * size[k];
        let change = [place(1.0) - place(0.0), place(0.0) - place(-1.0)];
        if change[0].abs() < change[1].abs() { change[0] } else { change[1] }
    });
    let length = math::hypot(moved[0], moved[1]);
    (length.is_finite() && length > 0.0).then(|| moved.map(|by| by / length))
}

/// Draws the curves on which each of the rates vanishes, in the colours of the curves of these indices.
pub(super) fn nullclines(
    canvas: &Canvas<'_>,
    raster: &mut Raster,
    (frame, field): (&PlotFrame, &PlaneField),
    curves: [usize; 2],
    level: Level,
) {
    let window = [[frame.x.lo, frame.x.hi], [frame.y.lo, frame.y.hi]];
    for (lines, index) in field.nullclines(window).into_iter().zip(curves) {
        let pen = match canvas.style.theme.series(index) {
            shade if shade.dash == super::theme::Dash::Full => {
                pen(canvas, Ink::Curve(index), level)
            }
            shade => Pen::shaded(shade, level),
        };
        for line in lines {
            raster.polyline(frame, line, &pen);
        }
    }
}
