//! The line below the screen of a demo: what is to be seen, and the keys just pressed.
//!
//! In: a sentence and the names of keys. Out: one row of cells. Never here: when it says what.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Modifier;
use unicode_width::UnicodeWidthStr;

use super::Look;
use super::canvas::{Canvas, columns};
use super::theme::Role;

/// What the line says.
#[derive(Clone, Copy, Debug)]
pub struct Caption<'a> {
    /// The sentence; empty for none.
    pub text: &'a str,
    /// The keys, the last pressed at the end.
    pub keys: &'a [String],
}

/// Draws the line over a blank row: the sentence at the left, keys as caps at the right. Keys give way to the sentence.
pub fn draw(look: &Look, caption: &Caption<'_>, row: Rect, buffer: &mut Buffer) {
    let mut canvas = Canvas::over(buffer, look);
    let mut used = 0;
    if !caption.text.is_empty() {
        used = canvas.left(columns(row, 1, 2), Role::Accent, look.glyphs.pick("▌", "|"));
        used += 2 + canvas.left(columns(row, used + 1, row.width), Role::Title, caption.text);
    }
    let mut right = row.width.saturating_sub(1);
    for key in caption.keys.iter().rev() {
        let cap = format!(" {key} ");
        let width = cap.width() as u16;
        if used + 2 + width > right {
            break;
        }
        let style = canvas.style(Role::Accent).add_modifier(Modifier::REVERSED);
        canvas.spans(columns(row, right - width, width), &[(cap, style)]);
        right -= width + 1;
    }
}
