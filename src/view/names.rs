//! Names beside points of a plot.
//!
//! In: layers, the frame of a plot. Out: cells. Never here: what has a name.

use unicode_width::UnicodeWidthStr;

use super::canvas::Canvas;
use super::plot::PlotFrame;
use super::theme::Role;
use crate::instrument::{Layer, Level};

/// Writes each name beside its point: to the right, or to the left where it would leave the plot; a name for which there is no
/// room beside those before it is left out.
pub(super) fn draw(canvas: &mut Canvas<'_>, frame: &PlotFrame, layers: &[(Level, Layer)]) {
    let mut written: Vec<(u16, u16, u16)> = Vec::new();
    for (_, layer) in layers {
        let Layer::Name(at, name, _) = layer else { continue };
        let Some(cell) = frame.cell(*at) else { continue };
        let name = canvas.text(name);
        let width = u16::try_from(name.width()).unwrap_or(u16::MAX);
        let right = cell.x.saturating_add(2);
        let left = cell.x.checked_sub(width.saturating_add(1));
        let inside = |x: &u16| *x >= frame.area.x && x.saturating_add(width) <= frame.area.right();
        let free = |x: &u16| {
            let apart = |&(from, to, row): &(u16, u16, u16)| {
                row != cell.y || *x > to || x.saturating_add(width) < from
            };
            written.iter().all(apart)
        };
        let place = [Some(right), left].into_iter().flatten().find(|x| inside(x) && free(x));
        let Some(x) = place else { continue };
        written.push((x, x.saturating_add(width), cell.y));
        let style = canvas.style(Role::Title);
        canvas.write(ratatui::layout::Position { x, y: cell.y }, width, &name, style);
    }
}
