//! The caption below the screen of a demo: a sentence about what is shown, and the keys just pressed.
//!
//! In: a sentence and the names of keys. Out: one row of cells, or more if the sentence is too long. Never here:
//! the timing of captions.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Modifier;
use unicode_width::UnicodeWidthStr;

use super::RenderStyle;
use super::canvas::{Canvas, columns};
use super::theme::Role;

/// The content of a caption.
#[derive(Clone, Copy, Debug)]
pub struct Caption<'a> {
    /// The sentence; may be empty.
    pub text: &'a str,
    /// The keys, most recent last.
    pub keys: &'a [String],
}

/// Columns left free before and after the sentence.
const MARGINS: u16 = 4;

/// The number of rows a sentence takes on a screen of this width.
pub fn rows(text: &str, width: u16) -> u16 {
    lines(text, width).len() as u16
}

/// Breaks the sentence into lines between words; an empty sentence gives one line.
fn lines(text: &str, width: u16) -> Vec<String> {
    let room = usize::from(width.saturating_sub(MARGINS)).max(1);
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let line = lines.last_mut().map_or(0, |line| line.width());
        if line > 0 && line + 1 + word.width() > room {
            lines.push(String::new());
        }
        if let Some(line) = lines.last_mut() {
            let gap = if line.is_empty() { "" } else { " " };
            *line = format!("{line}{gap}{word}");
        }
    }
    lines
}

/// Draws the caption over blank rows: the sentence at the left, the keys as caps at the right of the last row. The
/// sentence has priority over the keys.
pub fn draw(style: &RenderStyle, caption: &Caption<'_>, area: Rect, buffer: &mut Buffer) {
    let mut canvas = Canvas::over(buffer, style);
    let (mut used, mut last) = (0, Rect { height: 1, ..area });
    if !caption.text.is_empty() {
        for (row, line) in area.rows().zip(lines(caption.text, area.width)) {
            used = canvas.left(columns(row, 1, 2), Role::Accent, style.glyphs.pick("▌", "|"));
            used += 2 + canvas.left(columns(row, used + 2, row.width), Role::Title, &line);
            last = row;
        }
    }
    let row = last;
    let mut right = row.width.saturating_sub(1);
    for key in caption.keys.iter().rev() {
        let cap = format!(" {} ", style.glyphs.text(key));
        let width = cap.width() as u16;
        if used + 2 + width > right {
            break;
        }
        let style = canvas.style(Role::Accent).add_modifier(Modifier::REVERSED);
        canvas.spans(columns(row, right - width, width), &[(cap, style)]);
        right -= width + 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sentences_are_broken_between_words() {
        assert_eq!(lines("from one degree", 80), ["from one degree"]);
        assert_eq!(lines("from one degree", 14), ["from one", "degree"]);
        assert_eq!(rows("", 80), 1);
        assert_eq!(rows("unbreakable", 6), 1);
    }
}
