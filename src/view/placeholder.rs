//! What stands in a pane that has nothing to draw yet: a sentence in the middle, in place of empty axes.
//!
//! In: the sentence. Out: cells. Never here: what the sentence says.

use ratatui::layout::Rect;

use super::canvas::{Canvas, columns, row};
use super::clauses::clauses;
use super::number::with_powers;
use super::theme::Role;

/// The greatest width of its lines.
const WIDEST: u16 = 60;

/// Writes a sentence in the middle of an area.
pub(super) fn draw(canvas: &mut Canvas<'_>, area: Rect, sentence: &str) {
    let width = area.width.saturating_sub(4).min(WIDEST);
    let text = canvas.text(&with_powers(sentence, canvas.style.glyphs));
    let lines = clauses(&text, width.into());
    let above = usize::from(area.height).saturating_sub(lines.len()) / 2;
    let left = (area.width - width.min(area.width)) / 2;
    for (index, line) in lines.iter().take(area.height.into()).enumerate() {
        canvas.left(columns(row(area, above + index), left, width), Role::Dim, line);
    }
}
