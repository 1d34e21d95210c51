//! The pane in which a lesson speaks: below the lab, so that it covers nothing that moves.
//!
//! In: a title, paragraphs, the keys that hold. Out: cells. Never here: what is right, or what a key does.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use unicode_width::UnicodeWidthStr;

use super::RenderStyle;
use super::canvas::{Canvas, columns, row};
use super::number::{with_minus_signs, with_powers};
use super::primes::with_primes;
use super::theme::Role;
use super::wrap::words;

/// What a lesson says at one moment.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Speech {
    /// The title of the lesson.
    pub title: String,
    /// How far the lesson is, as `3/12`.
    pub place: String,
    /// What is said.
    pub paragraphs: Vec<Paragraph>,
    /// The keys that hold.
    pub keys: String,
    /// Whether they are the lesson's own, and not those of the lab above.
    pub focused: bool,
}

/// A paragraph and its kind.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Paragraph {
    /// What it is.
    pub kind: ParagraphKind,
    /// Its words, without the mark of its kind.
    pub text: String,
}

/// What a paragraph is. Each kind has a mark or words of its own, so that none needs colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParagraphKind {
    /// Ordinary text.
    Text,
    /// Something beside the point: a number, a committed answer.
    Quiet,
    /// One of the answers to choose from.
    Option,
    /// The selected option, or where the cursor of a plot is.
    Selected,
    /// The line being typed, as it is.
    Typed,
    /// A right answer.
    Right,
    /// A wrong answer.
    Wrong,
}

/// Columns of the frame and of the margins, and of the mark before a paragraph.
const MARGINS: u16 = 4;
const MARK: u16 = 2;

/// The number of rows that paragraphs take on a screen of this width, with the frame.
pub fn rows(paragraphs: &[Paragraph], width: u16) -> u16 {
    let room = room(width);
    let lines: usize = paragraphs.iter().map(|paragraph| words(&paragraph.text, room).len()).sum();
    (lines + 2).min(usize::from(u16::MAX)) as u16
}

fn room(width: u16) -> usize {
    usize::from(width.saturating_sub(MARGINS + MARK)).max(1)
}

/// The keys that fit in a width: the last but one go first.
fn fitting(keys: &str, room: usize) -> String {
    let mut parts: Vec<&str> = keys.split(BETWEEN).collect();
    let width = |parts: &[&str]| parts.join(BETWEEN).width();
    while width(&parts) > room && parts.len() > 2 {
        parts.remove(parts.len() - 2);
    }
    parts.join(BETWEEN)
}

/// What stands between two keys.
const BETWEEN: &str = " · ";

/// Draws the pane.
pub fn draw(style: &RenderStyle, speech: &Speech, area: Rect, buffer: &mut Buffer) {
    let mut canvas = Canvas::over(buffer, style);
    canvas.clear(area);
    let title = [
        canvas.span(Role::Title, &speech.title),
        canvas.span(Role::Dim, format!("  {}", speech.place)),
    ];
    let inner = canvas.pane(area, &title, speech.focused);
    let below = Rect { y: area.bottom().saturating_sub(1), height: area.height.min(1), ..area };
    let below = columns(below, 2, below.width.saturating_sub(4));
    let keys = fitting(&speech.keys, usize::from(below.width).saturating_sub(2));
    canvas.right(below, Role::Accent, &format!(" {keys} "));
    let needed = rows(&speech.paragraphs, area.width);
    if needed > area.height {
        let short = format!(
            "This needs {needed} rows in {} columns; the window has {}.",
            area.width, area.height
        );
        for (index, line) in words(&short, room(area.width)).iter().enumerate() {
            if index < inner.height.into() {
                canvas.left(columns(row(inner, index), 1, inner.width), Role::Warn, line);
            }
        }
        return;
    }
    let mut used = 0;
    for Paragraph { kind, text } in &speech.paragraphs {
        let (role, mark) = match kind {
            ParagraphKind::Text => (Role::Text, ""),
            ParagraphKind::Quiet => (Role::Dim, ""),
            ParagraphKind::Option => (Role::Text, ""),
            ParagraphKind::Selected | ParagraphKind::Typed => {
                (Role::Accent, style.glyphs.pick("›", ">"))
            }
            ParagraphKind::Right => (Role::Good, style.glyphs.pick("✓", "+")),
            ParagraphKind::Wrong => (Role::Bad, style.glyphs.pick("✗", "x")),
        };
        let text = match kind {
            ParagraphKind::Typed => text.clone(),
            _ => with_powers(&with_minus_signs(text, style.glyphs), style.glyphs),
        };
        let text = canvas.text(&with_primes(&text));
        for (index, line) in words(&text, room(area.width)).iter().enumerate() {
            let row = row(inner, used);
            if index == 0 {
                canvas.left(columns(row, 1, MARK), role, mark);
            }
            canvas.left(columns(row, 1 + MARK, row.width), role, line);
            used += 1;
        }
    }
}
