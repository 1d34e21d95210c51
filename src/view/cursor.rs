//! The cursor on a plot, and the coordinates of its cell.
//!
//! In: a frame and a viewport. Out: cells. Never here: the plotted data.

use ratatui::layout::{Position, Rect};
use unicode_width::UnicodeWidthStr;

use super::canvas::{Canvas, row};
use super::cursor_reading::CursorReading;
use super::marks::Marks;
use super::number::readable;
use super::plot::PlotFrame;
use super::theme::Role;
use crate::instrument::Viewport;

/// Draws the cursor, if there is one and it is in the window, and in the upper right corner, or a row below what is written there,
/// its coordinates and what happened.
pub(super) fn draw(
    canvas: &mut Canvas<'_>,
    area: Rect,
    frame: &PlotFrame,
    (viewport, marks): (Viewport, &Marks<'_>),
) -> Option<CursorReading> {
    let place @ [right, up] = viewport.cursor?;
    if frame.area.is_empty() {
        return None;
    }
    let part = |fraction: f64, count: u16| ((fraction * f64::from(count)) as u16).min(count - 1);
    let put = Position::new(
        frame.area.x + part(right, frame.area.width),
        frame.area.y + part(1.0 - up, frame.area.height),
    );
    let (cell, at) = match viewport.cursor_at {
        Some(at) => (frame.cell(at), at),
        None => (Some(put), frame.at(put)),
    };
    if let Some(cell) = cell {
        draw_mark(canvas, frame, cell);
    }
    let glyphs = canvas.style.glyphs;
    let what = cell.and_then(|cell| marks.at(frame, cell));
    let what = what.map_or_else(String::new, |name| format!("{name}: "));
    let (wide, high) = frame.dots(glyphs);
    let [x, y] = frame.near_zero(at, [wide, high].map(|dots| HALF / f64::from(dots)));
    let reading = format!(" {what}{}, {} ", readable(x, 4, glyphs), readable(y, 4, glyphs));
    // It covers no word above the axes.
    let wide = (canvas.text(&reading).width() as u16).min(area.width);
    let [top, below] = [0, 1].map(|index| row(area, index));
    let free = |x: u16| canvas.buffer[(x, top.y)].symbol().trim().is_empty();
    let above = below.is_empty() || (top.right() - wide..top.right()).all(free);
    canvas.right(if above { top } else { below }, Role::Focus, &reading);
    // Steps of a key that are less than a cell add up.
    let stays = cell == Some(put);
    let place = if stays { place } else { place_of(frame, at, place) };
    Some(CursorReading { at, place })
}

const HALF: f64 = 0.5;

/// The place of a point in a frame, or at its edge if it is outside; the one before where the axes do not contain it at all.
fn place_of(frame: &PlotFrame, [x, y]: [f64; 2], before: [f64; 2]) -> [f64; 2] {
    let now = [frame.x.fraction(x), frame.y.fraction(y)];
    [0, 1].map(|k| if now[k].is_finite() { now[k].clamp(0.0, 1.0) } else { before[k] })
}

/// Draws the lines through a cell of a frame, and their crossing.
fn draw_mark(canvas: &mut Canvas<'_>, frame: &PlotFrame, at: Position) {
    let glyphs = canvas.style.glyphs;
    let style = canvas.style(Role::Focus);
    for x in frame.area.x..frame.area.right() {
        if canvas.buffer[(x, at.y)].symbol().trim().is_empty() {
            canvas.write(Position::new(x, at.y), 1, glyphs.pick("┈", "-"), style);
        }
    }
    for y in frame.area.y..frame.area.bottom() {
        if canvas.buffer[(at.x, y)].symbol().trim().is_empty() {
            canvas.write(Position::new(at.x, y), 1, glyphs.pick("┊", ":"), style);
        }
    }
    canvas.write(at, 1, glyphs.pick("┼", "+"), style);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::plot::Scale;

    /// In a frame of 40 columns and 10 rows of braille, half a dot is 1/160 of the width and 1/80 of the height.
    #[test]
    fn what_is_zero_to_half_a_dot_reads_zero() {
        let area = Rect::new(0, 0, 40, 10);
        let frame = PlotFrame::new(Scale::linear(-1.0, 1.0), Scale::linear(-2.0, 2.0), area);
        let (wide, high) = frame.dots(crate::view::glyphs::Glyphs::Braille);
        let half = [wide, high].map(|dots| HALF / f64::from(dots));
        assert_eq!(frame.near_zero([1e-17, -1e-17], half), [0.0, 0.0]);
        assert_eq!(frame.near_zero([0.0124, -0.0499], half), [0.0, 0.0]);
        assert_eq!(frame.near_zero([0.0126, -0.0501], half), [0.0126, -0.0501]);
        // a power of ten on a logarithmic axis is no zero, however small
        let frame = PlotFrame::new(Scale::log(1e-12, 1e-6), Scale::linear(0.0, 1.0), area);
        assert_eq!(frame.near_zero([1e-9, 0.5], half), [1e-9, 0.5]);
    }
}
