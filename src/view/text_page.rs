//! A page of text: headings, paragraphs and labelled formulas, wrapped and scrolled.
//!
//! In: blocks of text. Out: rows, and how many of them lie beyond the screen. Never here: the content of the text.

mod layout;

use ratatui::layout::{Position, Rect};

use super::canvas::{Canvas, StyledText, columns, row};
use super::page_search::{mark, matches};
use super::theme::Role;
use crate::app::Drawn;

/// The greatest line length that is easy to read.
const MEASURE: u16 = 110;

/// The width from which a long page has two columns, and the gap between them.
const TWO_COLUMNS: u16 = 160;
const BETWEEN: u16 = 2;

/// The rows above a match that is in view.
const ABOVE: usize = 2;

#[derive(Default)]
pub(super) struct TextPage {
    blocks: Vec<TextBlock>,
    /// Whether two columns are of equal length, even if one has room for everything.
    balanced: bool,
    /// The heading with which the rows that are drawn begin, where the page has it: its last place.
    from: Option<&'static str>,
    /// The words that are searched for, and the number of the match to be in view, if one is.
    pattern: (String, Option<usize>),
}

enum TextBlock {
    Heading(String),
    Words(Role, String),
    Notes(Role, String),
    Formula { label: String, body: String, remark: String },
    Row(Vec<(Role, String)>),
    Item { label: String, text: String },
    Value { name: String, value: String, unit: String, rest: Vec<(Role, String)> },
    Line(String),
    Gap,
}

impl TextPage {
    pub(super) fn heading(&mut self, text: &str) {
        if !self.blocks.is_empty() {
            self.blocks.push(TextBlock::Gap);
        }
        self.blocks.push(TextBlock::Heading(text.to_owned()));
    }

    pub(super) fn words(&mut self, role: Role, text: impl Into<String>) {
        self.blocks.push(TextBlock::Words(role, text.into()));
    }

    /// Adds a paragraph of a file's notes, with its emphasis.
    pub(super) fn notes(&mut self, role: Role, text: &str) {
        self.blocks.push(TextBlock::Notes(role, text.to_owned()));
    }

    /// Adds `label = body` and a remark after it.
    pub(super) fn formula(&mut self, label: &str, body: String, remark: &str) {
        self.blocks.push(TextBlock::Formula {
            label: label.to_owned(),
            body,
            remark: remark.to_owned(),
        });
    }

    /// Adds spans in one row, which is not wrapped.
    pub(super) fn row(&mut self, pieces: Vec<(Role, String)>) {
        self.blocks.push(TextBlock::Row(pieces));
    }

    /// Adds a label and a text beside it, wrapped with a hanging indent.
    pub(super) fn item(&mut self, label: &str, text: &str) {
        self.blocks.push(TextBlock::Item { label: label.to_owned(), text: text.to_owned() });
    }

    /// Adds a name, a number aligned with those of other names, its unit, and further spans. Narrow pages put the number
    /// below a long name.
    pub(super) fn value(&mut self, name: &str, value: &str, unit: &str, rest: Vec<(Role, String)>) {
        let (name, value, unit) = (name.to_owned(), value.to_owned(), unit.to_owned());
        self.blocks.push(TextBlock::Value { name, value, unit, rest });
    }

    /// Adds a single line, wrapped if necessary.
    pub(super) fn line(&mut self, text: &str) {
        self.blocks.push(TextBlock::Line(text.to_owned()));
    }

    /// Adds an empty row.
    pub(super) fn gap(&mut self) {
        self.blocks.push(TextBlock::Gap);
    }

    /// The same page with two columns wherever it is wide enough, of equal length as far as its sections allow.
    pub(super) fn balanced(self) -> Self {
        Self { balanced: true, ..self }
    }

    /// The same page, drawn from a section on, if there is one.
    pub(super) fn from(self, heading: Option<&'static str>) -> Self {
        Self { from: heading, ..self }
    }

    /// The same page, with some words marked, and a match of them in view.
    pub(super) fn searched(self, words: String, place: Option<usize>) -> Self {
        Self { pattern: (words, place), ..self }
    }

    /// The row at which the section to be in view begins, or a few above the match to be in view.
    fn section(&self, canvas: &Canvas<'_>, lines: &[Vec<StyledText>]) -> Option<u16> {
        let (words, place) = &self.pattern;
        if let Some(place) = place {
            let found = matches(lines, words);
            let row = found.get((*place).min(found.len().saturating_sub(1)))?;
            return Some(row.saturating_sub(ABOVE).min(usize::from(u16::MAX)) as u16);
        }
        let heading = canvas.span(Role::Title, self.from?);
        let row = lines.iter().rposition(|line| matches!(&line[..], [only] if *only == heading))?;
        Some(row.min(usize::from(u16::MAX)) as u16)
    }

    /// Draws the rows from `scroll` on.
    pub(super) fn draw(self, canvas: &mut Canvas<'_>, area: Rect, scroll: u16) -> Drawn {
        let rows = self.wrapped(canvas, area.width);
        draw_rows(canvas, area, scroll, &rows)
    }

    /// Draws the rows from `scroll` on, or from the section to be in view, in two columns where the area is wide and the
    /// page is longer than one.
    pub(super) fn draw_in_columns(self, canvas: &mut Canvas<'_>, area: Rect, scroll: u16) -> Drawn {
        let half = area.width.saturating_sub(BETWEEN) / 2;
        let height = usize::from(area.height);
        let whole = self.wrapped(canvas, area.width);
        if area.width < TWO_COLUMNS || whole.len() <= height && !self.balanced {
            let section = self.section(canvas, &whole);
            let drawn = draw_rows(canvas, area, section.unwrap_or(scroll), &whole);
            let first = usize::from(section.unwrap_or(scroll)).min(drawn.beyond.into());
            for (index, line) in whole.iter().skip(first).take(height).enumerate() {
                mark(canvas, columns(row(area, index), 1, area.width), line, &self.pattern.0);
            }
            let matches = matches(&whole, &self.pattern.0).len();
            return Drawn { scroll: section, matches, ..drawn };
        }
        let lines = self.wrapped(canvas, half);
        let beyond = lines.len().saturating_sub(2 * height);
        let section = self.section(canvas, &lines);
        let first = usize::from(section.unwrap_or(scroll)).min(beyond);
        // A page that fits is parted at a gap, so that no section is torn; the lower the better, or nearest the middle.
        let mut gaps = (lines.len().saturating_sub(height)..=height)
            .filter(|at| lines.get(*at).is_some_and(Vec::is_empty));
        let gap = if self.balanced {
            gaps.min_by_key(|at| (2 * at).abs_diff(lines.len()))
        } else {
            gaps.next_back()
        };
        let (split, skipped) = match gap.filter(|_| beyond == 0) {
            Some(gap) => (gap, 1),
            None => (height, 0),
        };
        let right = lines.iter().skip(first + split + skipped).take(height);
        for (index, line) in lines.iter().skip(first).take(split).enumerate() {
            let at = columns(row(area, index), 1, measure(half) + 1);
            canvas.spans(at, line);
            mark(canvas, at, line, &self.pattern.0);
        }
        for (index, line) in right.enumerate() {
            let at = columns(row(area, index), half + BETWEEN, measure(half) + 1);
            canvas.spans(at, line);
            mark(canvas, at, line, &self.pattern.0);
        }
        if beyond > 0 {
            scroll_bar(canvas, area, first, lines.len() - height);
        }
        let rows = area.height.saturating_mul(2);
        let beyond = beyond.min(usize::from(u16::MAX)) as u16;
        let matches = matches(&lines, &self.pattern.0).len();
        Drawn { beyond, rows, scroll: section, matches, ..Drawn::default() }
    }

    /// The rows of the page in an area of this width.
    pub(super) fn wrapped(&self, canvas: &Canvas<'_>, width: u16) -> Vec<Vec<StyledText>> {
        self.lines(canvas, measure(width).into())
    }

    /// Draws the screenful of rows that contains a line, with the cursor at its beginning. Rows are scrolled by whole
    /// screenfuls, so that they do not move while they are read.
    pub(super) fn read(self, canvas: &mut Canvas<'_>, area: Rect, line: usize) -> Drawn {
        let width = area.width.saturating_sub(2).min(MEASURE);
        let lines = self.lines(canvas, width.into());
        let rows = usize::from(area.height).max(1);
        let line = line.min(lines.len().saturating_sub(1));
        let first = line - line % rows;
        for (index, spans) in lines.iter().skip(first).take(rows).enumerate() {
            canvas.spans(columns(row(area, index), 1, width), spans);
        }
        canvas.point(Position::new(area.x + 1, area.y + (line - first) as u16));
        let beyond = lines.len().saturating_sub(rows);
        let shown = rows.min(lines.len());
        Drawn { beyond: beyond as u16, rows: shown as u16, ..Drawn::default() }
    }
}

/// Draws the rows of a page from `scroll` on.
pub(super) fn draw_rows(
    canvas: &mut Canvas<'_>,
    area: Rect,
    scroll: u16,
    lines: &[Vec<StyledText>],
) -> Drawn {
    let rows = usize::from(area.height);
    let beyond = lines.len().saturating_sub(rows);
    let first = usize::from(scroll).min(beyond);
    for (index, line) in lines.iter().skip(first).take(rows).enumerate() {
        canvas.spans(columns(row(area, index), 1, measure(area.width) + 1), line);
    }
    scroll_bar(canvas, area, first, lines.len());
    let beyond = beyond.min(usize::from(u16::MAX)) as u16;
    Drawn { beyond, rows: area.height, ..Drawn::default() }
}

/// The width of a page's rows in an area of this width.
pub(super) fn measure(width: u16) -> u16 {
    width.saturating_sub(3).min(MEASURE)
}

/// Draws a scroll bar at the right edge if not all rows are in view.
fn scroll_bar(canvas: &mut Canvas<'_>, area: Rect, first: usize, total: usize) {
    let rows = usize::from(area.height);
    if total <= rows || rows < 3 {
        return;
    }
    let long = (rows * rows / total).max(1);
    let start = first * (rows - long) / (total - rows);
    let column = columns(area, area.width.saturating_sub(1), 1);
    for index in 0..rows {
        let inside = (start..start + long).contains(&index);
        let symbol = if inside {
            canvas.style.glyphs.pick("┃", "#")
        } else {
            canvas.style.glyphs.pick("│", "|")
        };
        canvas.left(row(column, index), if inside { Role::Dim } else { Role::Border }, symbol);
    }
}
