//! The canvas: text, rows and frames on a buffer, in the characters this terminal can show.
//!
//! In: areas, and text that may contain any characters. Out: cells. Never here: the content of the text.

use std::borrow::Cow;

use ratatui::buffer::{Buffer, Cell as ScreenCell};
use ratatui::layout::{Margin, Position, Rect};
use ratatui::style::{Modifier, Style};
use ratatui::symbols::border;
use ratatui::widgets::{Clear, Widget};
use unicode_width::UnicodeWidthChar;

use super::RenderStyle;
use super::cache::FrameCache;
use super::colour::ColourDepth;
use super::cursor_reading::CursorReading;
use super::glyphs::TextWidth;
use super::plot::PlotFrame;
use super::region::ScreenRegion;
use super::theme::Role;
use super::wrap::shortened;
use crate::app::HitTarget;

/// A buffer and the style in which to draw on it.
pub(super) struct Canvas<'a> {
    pub(super) buffer: &'a mut Buffer,
    pub(super) style: &'a RenderStyle,
    /// The regions for the mouse, if they are collected; later ones lie over earlier ones.
    pub(super) regions: Option<Vec<(Rect, ScreenRegion)>>,
    /// The masses of the picture drawn last that can be dragged: where each is, its index among the shapes, and the frame.
    pub(super) masses: Vec<(Rect, usize, PlotFrame)>,
    pub(super) cursor: Option<Position>,
    /// Where the cursor of the focused plot is.
    pub(super) reading: Option<CursorReading>,
    /// The place of the moving point on the focused plot.
    pub(super) moving: Option<[f64; 2]>,
    /// Whether the list with the focus says what its selected value means.
    pub(super) explained: bool,
    /// What is cached from the last frame.
    pub(super) cache: FrameCache,
    /// Whether what is drawn stands beside what has the keys: no pane of it looks focused.
    pub(super) beside: bool,
}

/// A styled piece of a row.
pub(super) type StyledText = (String, Style);

impl<'a> Canvas<'a> {
    /// Creates a canvas that draws on `buffer`.
    pub(super) fn over(buffer: &'a mut Buffer, style: &'a RenderStyle) -> Self {
        Self {
            buffer,
            style,
            regions: None,
            masses: Vec::new(),
            cursor: None,
            reading: None,
            moving: None,
            explained: false,
            cache: FrameCache::default(),
            beside: false,
        }
    }
}

impl Canvas<'_> {
    pub(super) fn style(&self, role: Role) -> Style {
        self.style.theme[role]
    }

    /// Returns the text as this terminal can show it, without control characters.
    pub(super) fn text(&self, text: &str) -> String {
        self.style.shown(text).into_owned()
    }

    pub(super) fn span(&self, role: Role, text: impl AsRef<str>) -> StyledText {
        (self.text(text.as_ref()), self.style(role))
    }

    /// Writes text from a position on, and cuts it with an ellipsis if it is wider than `width` columns. Returns the
    /// number of columns written.
    pub(super) fn write(&mut self, at: Position, width: u16, text: &str, style: Style) -> u16 {
        let screen = self.style;
        let room = width.min(self.buffer.area.right().saturating_sub(at.x));
        if let Some(wide) = screen.columns(text).filter(|wide| *wide <= width.into()) {
            if self.buffer.area.contains(at) {
                self.put_letters(at, text, room, style);
            }
            return wide as u16;
        }
        let text = screen.shown(text);
        let (text, wide) = match text.width() {
            wide if wide <= width.into() => (text, wide),
            _ => {
                let short = shortened(&text, width.into(), screen.glyphs.pick("…", "~"));
                let wide = short.width();
                (Cow::Owned(short), wide)
            }
        };
        if self.buffer.area.contains(at) {
            self.put(at, &text, room, style);
        }
        wide as u16
    }

    /// Puts text into the cells of a row, at most `room` of them.
    fn put(&mut self, at: Position, text: &str, room: u16, style: Style) {
        if !text.chars().all(fills_a_cell) {
            self.buffer.set_stringn(at.x, at.y, text, room.into(), style);
            return;
        }
        self.put_letters(at, text, room, style);
    }

    /// Puts characters that fill one cell each into the cells of a row, at most `room` of them.
    fn put_letters(&mut self, at: Position, text: &str, room: u16, style: Style) {
        let from = self.buffer.index_of(at.x, at.y);
        let cells = &mut self.buffer.content[from..from + usize::from(room)];
        for (cell, letter) in cells.iter_mut().zip(text.chars()) {
            cell.set_char(letter).set_style(style);
        }
    }

    pub(super) fn left(&mut self, row: Rect, role: Role, text: &str) -> u16 {
        let style = self.style(role);
        if row.is_empty() { 0 } else { self.write(row.as_position(), row.width, text, style) }
    }

    pub(super) fn right(&mut self, row: Rect, role: Role, text: &str) -> u16 {
        let width = (self.text(text).width() as u16).min(row.width);
        let area = Rect { x: row.right() - width, width, ..row };
        self.left(area, role, text)
    }

    /// Says in the lower border of a frame how many of its rows are out of sight.
    pub(super) fn out_of_sight(&mut self, frame: Rect, above: usize, below: usize) {
        if above + below == 0 || frame.width < 16 || frame.height == 0 {
            return;
        }
        let glyphs = self.style.glyphs;
        let part = |count: usize, arrow: &str| (count > 0).then(|| format!("+{count} {arrow}"));
        let parts = [part(above, glyphs.pick("↑", "up")), part(below, glyphs.pick("↓", "down"))];
        let text: Vec<String> = parts.into_iter().flatten().collect();
        let border = row(frame, usize::from(frame.height - 1));
        let place = columns(border, 2, border.width.saturating_sub(4));
        self.right(place, Role::Dim, &format!(" {} ", text.join(" ")));
    }

    /// Writes spans one after the other; an ellipsis replaces those that do not fit.
    pub(super) fn spans(&mut self, row: Rect, spans: &[StyledText]) -> u16 {
        let screen = self.style;
        let texts = spans.iter().map(|(text, style)| (screen.shown(text), *style));
        let texts: Vec<(Cow<'_, str>, Style)> = texts.collect();
        let all: usize = texts.iter().map(|(text, _)| text.width()).sum();
        let padding = texts.last().map_or(0, |(text, _)| text.len() - text.trim_end().len());
        let mark = screen.glyphs.pick("…", "~");
        let cut = all.saturating_sub(padding) > usize::from(row.width);
        let room = if cut { row.width.saturating_sub(1) } else { row.width };
        let mut used = 0;
        for (text, style) in &texts {
            if row.is_empty() || used >= room {
                break;
            }
            let at = Position::new(row.x + used, row.y);
            let wide = text.width();
            if wide <= usize::from(room - used) {
                used += self.write(at, room - used, text, *style);
            } else {
                let short = shortened(text, usize::from(room - used), "");
                used += self.write(at, room - used, &short, *style);
                break;
            }
        }
        if let (true, false, Some((_, style))) = (cut, row.is_empty(), spans.last()) {
            // what it stands for is no match of a search, whatever the last letter is
            let style = style.remove_modifier(Modifier::UNDERLINED);
            used += self.write(Position::new(row.x + used, row.y), 1, mark, style);
        }
        used
    }

    /// Draws a frame with title spans in its upper border, and returns the area inside.
    pub(super) fn pane(&mut self, area: Rect, title: &[StyledText], focused: bool) -> Rect {
        let focused = focused && !self.beside;
        let role = if focused { Role::Focus } else { Role::Border };
        // Without colour, a heavier line marks the focus.
        let heavy = focused && self.style.theme.depth() == ColourDepth::None;
        let set = match (heavy, self.style.glyphs.is_ascii()) {
            (false, _) => self.style.glyphs.border(),
            (true, false) => border::THICK,
            (true, true) => border::Set {
                horizontal_top: "=",
                horizontal_bottom: "=",
                ..self.style.glyphs.border()
            },
        };
        self.outline(area, set, self.style(role));
        if area.width > 6 && area.height > 0 {
            let row = Rect { x: area.x + 2, width: area.width - 4, height: 1, ..area };
            let gap = (" ".to_owned(), Style::new());
            // Spans after the first are shown whole or not at all.
            let mut used = self.spans(row, std::slice::from_ref(&gap));
            for (index, piece) in title.iter().enumerate() {
                // A line between two titles is not left without the second.
                let second = title.get(index + 1).filter(|_| ["│", "|"].contains(&piece.0.trim()));
                let wide = second.map_or_else(
                    || piece.0.trim_end().width(),
                    |second| piece.0.width() + second.0.trim_end().width(),
                );
                if index > 0 && usize::from(used) + wide + 1 > row.width.into() {
                    break;
                }
                used += self.spans(columns(row, used, row.width), std::slice::from_ref(piece));
            }
            self.spans(columns(row, used, row.width), &[gap]);
        }
        area.inner(Margin::new(1, 1))
    }

    /// Draws the border of an area; the cells inside are not touched, and nothing of it lies beyond the screen.
    fn outline(&mut self, area: Rect, set: border::Set<'_>, style: Style) {
        let area = area.intersection(self.buffer.area);
        if area.is_empty() {
            return;
        }
        let (right, bottom) = (area.right() - 1, area.bottom() - 1);
        let [mut row, mut column] = [0, 1].map(|_| ScreenCell::default());
        for (y, symbol) in [(area.y, set.horizontal_top), (bottom, set.horizontal_bottom)] {
            row.set_symbol(symbol);
            let from = self.buffer.index_of(area.x, y);
            for cell in &mut self.buffer.content[from..from + usize::from(area.width)] {
                copy_symbol(&row, cell, style);
            }
        }
        for (x, symbol) in [(area.x, set.vertical_left), (right, set.vertical_right)] {
            column.set_symbol(symbol);
            for y in area.y..=bottom {
                copy_symbol(&column, &mut self.buffer[(x, y)], style);
            }
        }
        let mut put = |x: u16, y: u16, symbol: &str| {
            self.buffer[(x, y)].set_symbol(symbol).set_style(style);
        };
        put(area.x, area.y, set.top_left);
        put(right, area.y, set.top_right);
        put(area.x, bottom, set.bottom_left);
        put(right, bottom, set.bottom_right);
    }

    /// Makes an area blank; clicks still reach what lies below.
    pub(super) fn blank(&mut self, area: Rect) {
        Clear.render(area, self.buffer);
    }

    pub(super) fn clear(&mut self, area: Rect) {
        Clear.render(area, self.buffer);
        self.region(area, ScreenRegion::Blank);
    }

    /// Draws an overlay of this size in the middle of an area, with a title, and returns it and the area for its text.
    pub(super) fn dialog(
        &mut self,
        area: Rect,
        (width, height): (u16, u16),
        title: StyledText,
    ) -> (Rect, Rect) {
        let place = Rect {
            x: area.x + (area.width - width) / 2,
            y: area.y + (area.height - height) / 2,
            width,
            height,
        };
        self.clear(place);
        let inner = self.pane(place, &[title], true);
        (place, columns(inner, 1, inner.width.saturating_sub(2)))
    }

    /// Places the terminal's cursor.
    pub(super) fn point(&mut self, at: Position) {
        self.cursor = Some(at).filter(|at| self.buffer.area.contains(*at));
    }

    pub(super) fn region(&mut self, area: Rect, region: ScreenRegion) {
        if let Some(regions) = self.regions.as_mut().filter(|_| !area.is_empty()) {
            regions.push((area, region));
        }
    }

    pub(super) fn target(&mut self, area: Rect, target: HitTarget) {
        self.region(area, ScreenRegion::Plain(target));
    }

    /// Styles a whole row and leaves its text unchanged.
    pub(super) fn tint(&mut self, row: Rect, role: Role) {
        let style = self.style(role);
        self.buffer.set_style(row.intersection(self.buffer.area), style);
    }
}

/// Gives a cell the symbol of another one, which has no style, and a style over its own.
fn copy_symbol(from: &ScreenCell, to: &mut ScreenCell, style: Style) {
    let own = to.style();
    to.clone_from(from);
    to.set_style(own).set_style(style);
}

/// Returns as many groups of spans as fit, each whole or not at all; the first is always included.
pub(super) fn groups(groups: Vec<Vec<StyledText>>, room: usize) -> Vec<StyledText> {
    let mut spans: Vec<StyledText> = Vec::new();
    for group in groups {
        let before = spans.len();
        spans.extend(group);
        if before > 0 && wide(&spans) > room {
            spans.truncate(before);
            break;
        }
    }
    spans
}

/// The width of spans in columns, without trailing blanks.
pub(super) fn wide(spans: &[StyledText]) -> usize {
    let mut from_end = spans.iter().rev().map(|(text, _)| text.as_str());
    let last = from_end.find(|text| !text.trim_end().is_empty());
    last.map_or(0, |last| last.trim_end().width() + from_end.map(TextWidth::width).sum::<usize>())
}

/// The row `index` rows below the top of an area; empty if it is outside.
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

/// Whether a character fills one cell whatever stands beside it: Latin, Greek and Cyrillic letters, punctuation, symbols,
/// lines and dots of a width of one.
fn fills_a_cell(letter: char) -> bool {
    let alone =
        matches!(letter, '\u{a0}'..'\u{300}' | '\u{370}'..'\u{483}' | '\u{2010}'..'\u{2e80}');
    matches!(letter, ' '..='~') || alone && letter.width() == Some(1)
}
