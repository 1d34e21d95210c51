//! The rows into which the blocks of a page are wrapped.
//!
//! In: blocks of text, a width. Out: rows of spans. Never here: which of them are on the screen.

use ratatui::style::Style;
use unicode_width::UnicodeWidthStr;

use super::{TextBlock, TextPage};
use crate::view::canvas::{Canvas, StyledText};
use crate::view::clauses::clauses;
use crate::view::emphasis::{Styles, marked, spans};
use crate::view::primes::with_primes;
use crate::view::theme::Role;
use crate::view::wrap::{formula_beside, words};

/// The indent of the further lines of a formula whose terms would not be whole beside its label, in a pane narrower than this;
/// on a page they stand right of the sign.
const HANGING: usize = 4;
const NARROW: usize = 56;

/// Columns of an item's label, of a name, at least and at most, and of a number; on narrow pages, the columns left for a unit.
const LABEL: usize = 20;
const NAME: usize = 30;
const WIDEST_NAME: usize = 48;
const NUMBER: usize = 20;
const MARGIN: usize = 8;

impl TextPage {
    /// The width of the column of labels under a heading.
    fn widest_label(&self, canvas: &Canvas<'_>, heading: usize, most: usize) -> usize {
        let section = self.blocks[heading..].iter().enumerate();
        let section = section.take_while(|(i, b)| *i == 0 || !matches!(b, TextBlock::Heading(_)));
        let label = |block: &TextBlock| match block {
            TextBlock::Formula { label, .. } => canvas.text(label).width(),
            _ => 0,
        };
        section.map(|(_, block)| label(block)).max().unwrap_or(0).min(most)
    }

    /// The width of the column of names: that of the widest, if numbers and units have room beside it.
    fn widest_name(&self, canvas: &Canvas<'_>, width: usize) -> usize {
        let name = |block: &TextBlock| match block {
            TextBlock::Value { name, .. } => canvas.text(name).width(),
            _ => 0,
        };
        let widest = self.blocks.iter().map(name).max().unwrap_or(0);
        widest.min(width.saturating_sub(2 + NUMBER + 2 * MARGIN).min(WIDEST_NAME)).max(NAME)
    }

    pub(super) fn lines(&self, canvas: &Canvas<'_>, width: usize) -> Vec<Vec<StyledText>> {
        let mut widest = 0;
        let name_width = self.widest_name(canvas, width);
        let mut lines = Vec::new();
        for (place, block) in self.blocks.iter().enumerate() {
            if place == 0 || matches!(block, TextBlock::Heading(_)) {
                widest = self.widest_label(canvas, place, width / 3);
            }
            match block {
                TextBlock::Gap => lines.push(Vec::new()),
                TextBlock::Heading(text) => lines.push(vec![canvas.span(Role::Title, text)]),
                TextBlock::Words(role, text) => {
                    let text = canvas.text(text);
                    let wrapped = words(&text, width.saturating_sub(2));
                    lines.extend(wrapped.into_iter().map(|line| {
                        vec![("  ".to_owned(), Style::new()), (line, canvas.style(*role))]
                    }));
                }
                TextBlock::Notes(role, text) => {
                    let text = marked(&canvas.text(&with_primes(text)));
                    let [plain, emphasis, typed] =
                        [*role, Role::Text, Role::Accent].map(|role| canvas.style(role));
                    let emphasis = match role {
                        Role::Text => canvas.style(Role::Title),
                        _ => emphasis,
                    };
                    let wrapped = words(&text, width.saturating_sub(2));
                    let styled = spans(wrapped, Styles { plain, emphasis, typed });
                    lines.extend(styled.into_iter().map(|mut line| {
                        line.insert(0, ("  ".to_owned(), Style::new()));
                        line
                    }));
                }
                TextBlock::Formula { label, body, remark } => {
                    let (label, body) = (canvas.text(label), canvas.text(body));
                    let margin = widest + 5;
                    let least = if width < NARROW { HANGING } else { margin };
                    let broken = formula_beside(&body, width, margin, [margin + 2, least]);
                    let last = broken.len() - 1;
                    for (i, line) in broken.into_iter().enumerate() {
                        let gap = " ".repeat(widest.saturating_sub(label.width()));
                        let (head, sign) = if i == 0 {
                            (format!("  {gap}{label}"), " = ")
                        } else {
                            Default::default()
                        };
                        let used = if i == 0 { margin } else { 0 } + line.width();
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
                                let wrapped = clauses(&remark_text, width.saturating_sub(margin));
                                let indent = " ".repeat(margin);
                                lines.extend(wrapped.into_iter().map(|line| {
                                    vec![(format!("{indent}{line}"), canvas.style(Role::Dim))]
                                }));
                            }
                        }
                    }
                }
                TextBlock::Line(text) => {
                    let wrapped = words(&canvas.text(text), width);
                    lines.extend(
                        wrapped.into_iter().map(|line| vec![(line, canvas.style(Role::Text))]),
                    );
                }
                TextBlock::Item { label, text } => lines.extend(item(canvas, width, label, text)),
                TextBlock::Value { name, value, unit, rest } => {
                    let rest: Vec<StyledText> =
                        rest.iter().map(|(r, t)| canvas.span(*r, t)).collect();
                    let widths = [width, name_width];
                    lines.extend(self::value(canvas, widths, [name, value, unit], rest));
                }
                TextBlock::Row(pieces) => {
                    lines.push(pieces.iter().map(|(role, t)| canvas.span(*role, t)).collect());
                }
            }
        }
        lines
    }
}

/// The rows of a label and its text.
fn item(canvas: &Canvas<'_>, width: usize, label: &str, text: &str) -> Vec<Vec<StyledText>> {
    let label = format!("  {}", canvas.text(label));
    let column = LABEL.min(width / 3);
    let wrapped = words(&canvas.text(text), width.saturating_sub(column));
    let indent = " ".repeat(column);
    let mut texts = wrapped.into_iter();
    let mut lines = Vec::new();
    if label.width() < column {
        let gap = " ".repeat(column - label.width());
        let head = canvas.span(Role::Accent, format!("{label}{gap}"));
        lines.push(vec![head, canvas.span(Role::Text, texts.next().unwrap_or_default())]);
    } else {
        lines.push(vec![canvas.span(Role::Accent, label)]);
    }
    lines.extend(texts.map(|line| vec![canvas.span(Role::Text, format!("{indent}{line}"))]));
    lines
}

/// The rows of a number between its name and its unit.
fn value(
    canvas: &Canvas<'_>,
    [width, name_width]: [usize; 2],
    [name, value, unit]: [&str; 3],
    rest: Vec<StyledText>,
) -> Vec<Vec<StyledText>> {
    let (name, unit) = (format!("  {}", canvas.text(name)), canvas.text(unit));
    let before = |value: &str| " ".repeat(NUMBER.saturating_sub(value.width()));
    let number = canvas.span(Role::Accent, format!("{}{value}", before(value)));
    let unit = canvas.span(Role::Dim, format!(" {unit}"));
    let tail: usize = unit.0.width() + rest.iter().map(|(text, _)| text.width()).sum::<usize>();
    let beside = 2 + name_width + NUMBER;
    if beside + tail <= width || beside + MARGIN <= width {
        // a long name takes the columns that the number leaves
        let gap = (name_width + 2).saturating_sub(name.width());
        let taken = (name.width() + gap).saturating_sub(name_width + 2);
        let padding = NUMBER.saturating_sub(value.width() + taken).max(usize::from(taken > 0));
        let number = canvas.span(Role::Accent, format!("{}{value}", " ".repeat(padding)));
        let head = canvas.span(Role::Text, format!("{name}{}", " ".repeat(gap)));
        let mut used = beside + unit.0.width();
        let mut lines = vec![vec![head, number, unit]];
        // What has no room stands below, whole.
        for (text, style) in rest {
            if lines.len() == 1 && used + text.trim_end().width() <= width {
                used += text.width();
                lines[0].push((text, style));
                continue;
            }
            let indent = " ".repeat(beside + 3);
            let wrapped = words(text.trim(), width.saturating_sub(indent.width()));
            lines.extend(wrapped.iter().map(|line| vec![(format!("{indent}{line}"), style)]));
        }
        return lines;
    }
    // The numbers are aligned here too.
    let column = width.saturating_sub(NUMBER + MARGIN);
    let gap = " ".repeat(column.saturating_sub(name.width()));
    let fits = name.width() + value.width() < column + NUMBER;
    let head = canvas.span(Role::Text, if fits { format!("{name}{gap}") } else { name.clone() });
    let mut lines = if fits {
        let room = column + NUMBER - name.width().max(column);
        let before = " ".repeat(room.saturating_sub(value.width()));
        vec![vec![head, canvas.span(Role::Accent, format!("{before}{value}")), unit]]
    } else {
        let gap = canvas.span(Role::Text, " ".repeat(column));
        vec![vec![head], vec![gap, number, unit]]
    };
    let rest: String = rest.into_iter().map(|(text, _)| text).collect();
    let rest = rest.split_whitespace().collect::<Vec<_>>().join(" ");
    if !rest.is_empty() {
        let wrapped = words(&rest, width.saturating_sub(4));
        lines
            .extend(wrapped.iter().map(|line| vec![canvas.span(Role::Dim, format!("    {line}"))]));
    }
    lines
}
