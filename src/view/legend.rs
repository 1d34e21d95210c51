//! What an instrument writes into its plot: a few lines, beside the axes where the pane is wide, else into their upper left
//! corner.
//!
//! In: the lines, the area. Out: cells. Never here: what the lines say.

use ratatui::layout::{Constraint, Layout, Rect};
use unicode_width::UnicodeWidthStr;

use super::canvas::Canvas;
use super::theme::Role;
use super::{RenderStyle, wrap};
use crate::instrument::{Layer, Level};

/// An area this wide has room beside its axes.
const WIDE: u16 = 64;

/// Parts a wide area into one for the axes and one for the lines, so that these cover nothing.
pub(super) fn beside(
    area: Rect,
    layers: &[(Level, Layer)],
    look: &RenderStyle,
) -> (Rect, Option<Rect>) {
    let width = |line: &String| look.glyphs.text(line).width();
    let widest = layers.iter().filter_map(|(_, layer)| match layer {
        Layer::Legend(lines) => lines.iter().map(width).max(),
        _ => None,
    });
    match widest.max() {
        Some(widest) if area.width >= WIDE => {
            let wanted = u16::try_from(widest + 2).unwrap_or(u16::MAX).min(area.width / 2);
            let parts = [Constraint::Min(0), Constraint::Length(wanted)];
            let [axes, lines] = Layout::horizontal(parts).areas(area);
            (axes, Some(lines))
        }
        _ => (area, None),
    }
}

/// Writes lines from the top, wrapped, as far as there is room for them.
pub(super) fn draw(canvas: &mut Canvas<'_>, area: Rect, lines: &[String]) {
    let look = canvas.look;
    let room = usize::from(area.width).saturating_sub(2);
    let wrapped = lines.iter().flat_map(|line| wrap::words(&look.glyphs.text(line), room.max(1)));
    for (y, line) in (area.y..area.bottom()).zip(wrapped) {
        let line = format!("{line} ");
        canvas.buffer.set_stringn(area.x + 1, y, line, room, look.theme[Role::Text]);
    }
}
