//! The canvas: text, rows and frames on a buffer, in the characters this terminal has.
//!
//! In: text that may hold any letters, areas. Out: cells. Never here: what the text says.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Style;
use ratatui::symbols::border;
use ratatui::widgets::{Block, Clear, Widget};
use unicode_width::UnicodeWidthStr;

use super::RenderStyle;
use super::colour::ColourDepth;
use super::hit_test::Region;
use super::theme::Role;
use crate::app::HitTarget;
use crate::printable;

/// A buffer and how things look on it.
pub(super) struct Canvas<'a> {
    pub(super) buffer: &'a mut Buffer,
    pub(super) look: &'a RenderStyle,
    /// What lies where, for the mouse, while it is asked for; the later lies over the earlier.
    pub(super) regions: Option<Vec<(Rect, Region)>>,
    /// Where the terminal's cursor belongs.
    pub(super) cursor: Option<Position>,
}

/// A piece of a row.
pub(super) type Span = (String, Style);

impl<'a> Canvas<'a> {
    /// A buffer to be drawn on, and how things look there.
    pub(super) fn over(buffer: &'a mut Buffer, look: &'a RenderStyle) -> Self {
        Self { buffer, look, regions: None, cursor: None }
    }
}

impl Canvas<'_> {
    /// The style of a role.
    pub(super) fn style(&self, role: Role) -> Style {
        self.look.theme[role]
    }

    /// Text as this terminal may show it, without what would steer it.
    pub(super) fn text(&self, text: &str) -> String {
        self.look.glyphs.text(&printable::line(text)).into_owned()
    }

    /// A piece of a row in the style of a role.
    pub(super) fn span(&self, role: Role, text: impl AsRef<str>) -> Span {
        (self.text(text.as_ref()), self.style(role))
    }

    /// Writes text from a place on, cut with an ellipsis where there are more than `width` columns of it. Returns
    /// how many columns it took.
    pub(super) fn write(&mut self, at: Position, width: u16, text: &str, style: Style) -> u16 {
        let text = self.text(text);
        let text = clipped(&text, width.into(), self.look.glyphs.pick("…", "~"));
        let inside = self.buffer.area.contains(at);
        let room = width.min(self.buffer.area.right().saturating_sub(at.x));
        if inside {
            self.buffer.set_stringn(at.x, at.y, &text, room.into(), style);
        }
        text.width() as u16
    }

    /// Writes in the columns of a row, from its left end.
    pub(super) fn left(&mut self, row: Rect, role: Role, text: &str) -> u16 {
        let style = self.style(role);
        if row.is_empty() { 0 } else { self.write(row.as_position(), row.width, text, style) }
    }

    /// Writes in the columns of a row, up to its right end.
    pub(super) fn right(&mut self, row: Rect, role: Role, text: &str) -> u16 {
        let width = (self.text(text).width() as u16).min(row.width);
        let area = Rect { x: row.right() - width, width, ..row };
        self.left(area, role, text)
    }

    /// Writes pieces one after the other; where they do not fit, a mark stands for what is left out.
    pub(super) fn spans(&mut self, row: Rect, spans: &[Span]) -> u16 {
        let wide = |text: &str| self.look.glyphs.text(text).width();
        let all: usize = spans.iter().map(|(text, _)| wide(text)).sum();
        let padding = spans.last().map_or(0, |(text, _)| wide(text) - wide(text.trim_end()));
        let mark = self.look.glyphs.pick("…", "~");
        let cut = all.saturating_sub(padding) > usize::from(row.width);
        let room = if cut { row.width.saturating_sub(1) } else { row.width };
        let mut used = 0;
        for (text, style) in spans {
            if row.is_empty() || used >= room {
                break;
            }
            let at = Position::new(row.x + used, row.y);
            let text = self.look.glyphs.text(text);
            let text = clipped(&text, usize::from(room - used), "");
            used += self.write(at, room - used, &text, *style);
        }
        if let (true, false, Some((_, style))) = (cut, row.is_empty(), spans.last()) {
            used += self.write(Position::new(row.x + used, row.y), 1, mark, *style);
        }
        used
    }

    /// A frame with pieces of a title in its upper border; returns what is inside.
    pub(super) fn pane(&mut self, area: Rect, title: &[Span], focused: bool) -> Rect {
        let role = if focused { Role::Focus } else { Role::Border };
        // Without colour a heavier line shows where the keys go.
        let heavy = focused && self.look.theme.depth() == ColourDepth::None;
        let set = match (heavy, self.look.glyphs.is_ascii()) {
            (false, _) => self.look.glyphs.border(),
            (true, false) => border::THICK,
            (true, true) => border::Set {
                horizontal_top: "=",
                horizontal_bottom: "=",
                ..self.look.glyphs.border()
            },
        };
        let block = Block::bordered().border_set(set);
        let inner = block.inner(area);
        block.border_style(self.style(role)).render(area, self.buffer);
        if area.width > 6 && area.height > 0 {
            let row = Rect { x: area.x + 2, width: area.width - 4, height: 1, ..area };
            let gap = (" ".to_owned(), Style::new());
            // Pieces after the first are shown whole or not at all.
            let mut used = self.spans(row, std::slice::from_ref(&gap));
            for (index, piece) in title.iter().enumerate() {
                if index > 0
                    && usize::from(used) + piece.0.trim_end().width() + 1 > row.width.into()
                {
                    break;
                }
                used += self.spans(columns(row, used, row.width), std::slice::from_ref(piece));
            }
            self.spans(columns(row, used, row.width), &[gap]);
        }
        inner
    }

    /// Blanks an area for something that lies over what was there.
    pub(super) fn clear(&mut self, area: Rect) {
        Clear.render(area, self.buffer);
        self.region(area, Region::Blank);
    }

    /// The terminal's cursor belongs here.
    pub(super) fn point(&mut self, at: Position) {
        self.cursor = Some(at).filter(|at| self.buffer.area.contains(*at));
    }

    /// Says what an area is for the mouse.
    pub(super) fn region(&mut self, area: Rect, region: Region) {
        if let Some(regions) = self.regions.as_mut().filter(|_| !area.is_empty()) {
            regions.push((area, region));
        }
    }

    /// Says that an area is one spot.
    pub(super) fn spot(&mut self, area: Rect, spot: HitTarget) {
        self.region(area, Region::Plain(spot));
    }

    /// Gives a whole row a style, keeping its text.
    pub(super) fn tint(&mut self, row: Rect, role: Role) {
        let style = self.style(role);
        self.buffer.set_style(row.intersection(self.buffer.area), style);
    }
}

/// Groups of pieces as far as they have room, each whole or not at all; the first is always there.
pub(super) fn groups(groups: Vec<Vec<Span>>, room: usize) -> Vec<Span> {
    let mut spans: Vec<Span> = Vec::new();
    for group in groups {
        let ends = [spans.as_slice(), &group].concat();
        if !spans.is_empty() && wide(&ends) > room {
            break;
        }
        spans = ends;
    }
    spans
}

/// The columns of pieces, without blanks at the end.
pub(super) fn wide(spans: &[Span]) -> usize {
    let text: String = spans.iter().map(|(text, _)| text.as_str()).collect();
    text.trim_end().width()
}

/// The row of an area that is `index` rows from its top; empty beyond it.
pub(super) fn row(area: Rect, index: usize) -> Rect {
    let index = index.min(usize::from(u16::MAX)) as u16;
    if index < area.height {
        Rect { y: area.y + index, height: 1, ..area }
    } else {
        Rect { y: area.bottom(), height: 0, ..area }
    }
}

/// The columns of an area from `from` on, at most `width` of them.
pub(super) fn columns(area: Rect, from: u16, width: u16) -> Rect {
    let from = from.min(area.width);
    Rect { x: area.x + from, width: width.min(area.width - from), ..area }
}

/// The text cut to so many columns, the mark in place of what is missing.
fn clipped(text: &str, width: usize, mark: &str) -> String {
    if text.width() <= width {
        return text.to_owned();
    }
    let room = width.saturating_sub(mark.width());
    let mut out = String::new();
    for character in text.chars() {
        let longer = format!("{out}{character}");
        if longer.width() > room {
            break;
        }
        out = longer;
    }
    if width >= mark.width() { out + mark } else { String::new() }
}
