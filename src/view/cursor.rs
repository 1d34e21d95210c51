//! The cursor on a plot, and the coordinates of its cell.
//!
//! In: a frame and a viewport. Out: cells. Never here: the plotted data.

use ratatui::layout::{Position, Rect};
use unicode_width::UnicodeWidthStr;

use super::canvas::{Canvas, row};
use super::marks::Marks;
use super::number::readable;
use super::plot::PlotFrame;
use super::theme::Role;
use crate::instrument::Viewport;

/// Draws the cursor, if there is one, and in the upper right corner, or a row below what is written there, its coordinates and what happened. Returns
/// the coordinates.
pub(super) fn draw(
    canvas: &mut Canvas<'_>,
    area: Rect,
    frame: &PlotFrame,
    (viewport, marks): (Viewport, &Marks<'_>),
) -> Option<[f64; 2]> {
    let [right, up] = viewport.cursor?;
    if frame.area.is_empty() {
        return None;
    }
    let place = |fraction: f64, count: u16| ((fraction * f64::from(count)) as u16).min(count - 1);
    let at = Position::new(
        frame.area.x + place(right, frame.area.width),
        frame.area.y + place(1.0 - up, frame.area.height),
    );
    let glyphs = canvas.look.glyphs;
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
    let [x, y] = frame.at(at);
    let what = marks.at(frame, at).map_or_else(String::new, |name| format!("{name}: "));
    let reading = format!(" {what}{}, {} ", readable(x, 4, glyphs), readable(y, 4, glyphs));
    // It covers no word above the axes.
    let wide = (canvas.text(&reading).width() as u16).min(area.width);
    let [top, below] = [0, 1].map(|index| row(area, index));
    let free = |x: u16| canvas.buffer[(x, top.y)].symbol().trim().is_empty();
    let above = below.is_empty() || (top.right() - wide..top.right()).all(free);
    canvas.right(if above { top } else { below }, Role::Focus, &reading);
    Some([x, y])
}
