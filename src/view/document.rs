//! A page of text: headings, paragraphs and labelled formulas, wrapped and scrolled.
//!
//! In: blocks of text. Out: rows, and how many of them lie beyond the screen. Never here: what the text says.

use ratatui::layout::{Position, Rect};
use ratatui::style::Style;
use unicode_width::UnicodeWidthStr;

use super::canvas::{Canvas, Span, columns, row};
use super::theme::Role;
use super::wrap::{formula, words};
use crate::app::Drawn;

/// Lines longer than this are hard to read.
const MEASURE: u16 = 110;

/// A page of text in the making.
#[derive(Default)]
pub(super) struct Document {
    blocks: Vec<Block>,
}

enum Block {
    Heading(String),
    Words(Role, String),
    Formula { label: String, body: String, remark: String },
    Row(Vec<(Role, String)>),
    Line(String),
    Gap,
}

impl Document {
    /// A heading, with space above it.
    pub(super) fn heading(&mut self, text: &str) {
        if !self.blocks.is_empty() {
            self.blocks.push(Block::Gap);
        }
        self.blocks.push(Block::Heading(text.to_owned()));
    }

    /// A paragraph.
    pub(super) fn words(&mut self, role: Role, text: impl Into<String>) {
        self.blocks.push(Block::Words(role, text.into()));
    }

    /// `label = body`, and a remark after it.
    pub(super) fn formula(&mut self, label: &str, body: String, remark: &str) {
        self.blocks.push(Block::Formula {
            label: label.to_owned(),
            body,
            remark: remark.to_owned(),
        });
    }

    /// Pieces in one row, which is not wrapped.
    pub(super) fn row(&mut self, pieces: Vec<(Role, String)>) {
        self.blocks.push(Block::Row(pieces));
    }

    /// A line by itself, wrapped if it must be.
    pub(super) fn line(&mut self, text: &str) {
        self.blocks.push(Block::Line(text.to_owned()));
    }

    /// An empty row.
    pub(super) fn gap(&mut self) {
        self.blocks.push(Block::Gap);
    }

    /// Draws the rows from `scroll` on, as far as the area goes.
    pub(super) fn draw(self, canvas: &mut Canvas<'_>, area: Rect, scroll: u16) -> Drawn {
        let width = area.width.saturating_sub(3).min(MEASURE);
        let lines = self.lines(canvas, width.into());
        let rows = usize::from(area.height);
        let beyond = lines.len().saturating_sub(rows);
        let first = usize::from(scroll).min(beyond);
        for (index, line) in lines.iter().skip(first).take(rows).enumerate() {
            canvas.spans(columns(row(area, index), 1, width + 1), line);
        }
        scroll_bar(canvas, area, first, lines.len());
        let beyond = beyond.min(usize::from(u16::MAX)) as u16;
        Drawn { beyond, rows: area.height, ..Drawn::default() }
    }

    /// Draws the screenful of rows in which a line stands, the cursor at its beginning. Rows turn by whole screenfuls,
    /// so that they keep still while they are read.
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

    /// The width of the column of labels under a heading.
    fn widest_label(&self, canvas: &Canvas<'_>, heading: usize, most: usize) -> usize {
        let section = self.blocks[heading..].iter().enumerate();
        let section = section.take_while(|(i, b)| *i == 0 || !matches!(b, Block::Heading(_)));
        let label = |block: &Block| match block {
            Block::Formula { label, .. } => canvas.text(label).width(),
            _ => 0,
        };
        section.map(|(_, block)| label(block)).max().unwrap_or(0).min(most)
    }

    fn lines(&self, canvas: &Canvas<'_>, width: usize) -> Vec<Vec<Span>> {
        let mut widest = 0;
        let mut lines = Vec::new();
        for (place, block) in self.blocks.iter().enumerate() {
            if place == 0 || matches!(block, Block::Heading(_)) {
                widest = self.widest_label(canvas, place, width / 3);
            }
            match block {
                Block::Gap => lines.push(Vec::new()),
                Block::Heading(text) => lines.push(vec![canvas.span(Role::Title, text)]),
                Block::Words(role, text) => {
                    let text = canvas.text(text);
                    let wrapped = words(&text, width.saturating_sub(2));
                    lines.extend(wrapped.into_iter().map(|line| {
                        vec![("  ".to_owned(), Style::new()), (line, canvas.style(*role))]
                    }));
                }
                Block::Formula { label, body, remark } => {
                    let (label, body) = (canvas.text(label), canvas.text(body));
                    let margin = widest + 5;
                    let broken = formula(&body, width.saturating_sub(margin), 2);
                    let last = broken.len() - 1;
                    for (i, line) in broken.into_iter().enumerate() {
                        let gap = " ".repeat(widest.saturating_sub(label.width()));
                        let head =
                            if i == 0 { format!("  {gap}{label}") } else { " ".repeat(widest + 2) };
                        let sign = if i == 0 { " = " } else { "   " };
                        let used = margin + line.width();
                        let mut spans = vec![
                            (head, canvas.style(Role::Accent)),
                            (sign.to_owned(), canvas.style(Role::Dim)),
                            (line, canvas.style(Role::Text)),
                        ];
                        let remark_text = canvas.text(remark);
                        if i == last
                            && !remark.is_empty()
                            && used + 3 + remark_text.width() <= width
                        {
                            spans.push((format!("   {remark_text}"), canvas.style(Role::Dim)));
                            lines.push(spans);
                        } else {
                            lines.push(spans);
                            if i == last && !remark.is_empty() {
                                let wrapped = words(&remark_text, width.saturating_sub(margin));
                                let indent = " ".repeat(margin);
                                lines.extend(wrapped.into_iter().map(|line| {
                                    vec![(format!("{indent}{line}"), canvas.style(Role::Dim))]
                                }));
                            }
                        }
                    }
                }
                Block::Line(text) => {
                    let wrapped = words(&canvas.text(text), width);
                    lines.extend(
                        wrapped.into_iter().map(|line| vec![(line, canvas.style(Role::Text))]),
                    );
                }
                Block::Row(pieces) => {
                    lines.push(pieces.iter().map(|(role, t)| canvas.span(*role, t)).collect());
                }
            }
        }
        lines
    }
}

/// A bar at the right edge that shows which part of the rows is in view, if not all of them are.
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
            canvas.look.glyphs.pick("┃", "#")
        } else {
            canvas.look.glyphs.pick("│", "|")
        };
        canvas.left(row(column, index), if inside { Role::Dim } else { Role::Border }, symbol);
    }
}
