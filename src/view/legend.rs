//! What an instrument writes into its plot: a few lines, beside the axes where they take a third of the pane at most,
//! above them else, so that they cover nothing; in their upper left corner where there is no room for both.
//!
//! In: the lines, the area. Out: cells. Never here: what the lines say.

use ratatui::layout::{Constraint, Layout, Rect};
use unicode_width::UnicodeWidthStr;

use super::canvas::Canvas;
use super::clauses::clauses;
use super::theme::Role;
use super::{RenderStyle, number};
use crate::instrument::{Layer, Level};

/// An area this wide has room beside its axes, for lines in so many parts of it at most.
const WIDE: u16 = 64;
const PARTS: u16 = 3;

/// Axes have at least this height.
const LOW: u16 = 6;

/// Parts an area into one for the axes and one for the lines, so that these cover nothing.
pub(super) fn beside(
    area: Rect,
    layers: &[(Level, Layer)],
    look: &RenderStyle,
) -> (Rect, Option<Rect>) {
    let width = |line: &String| shown(line, look).width();
    let widest = layers.iter().filter_map(|(_, layer)| match layer {
        Layer::Legend(lines) => lines.iter().map(width).max(),
        _ => None,
    });
    let wanted = widest.max().map(|widest| u16::try_from(widest + 2).unwrap_or(u16::MAX));
    match wanted {
        Some(wanted) if area.width >= WIDE && wanted <= area.width / PARTS => {
            let parts = [Constraint::Min(0), Constraint::Length(wanted)];
            let [axes, lines] = Layout::horizontal(parts).areas(area);
            (axes, Some(lines))
        }
        Some(_) => {
            let wanted = u16::try_from(wrapped(area, layers, look)).unwrap_or(u16::MAX);
            let room = (area.height / 2).min(area.height.saturating_sub(LOW));
            let parts = [Constraint::Length(wanted.min(room)), Constraint::Min(0)];
            let [lines, axes] = Layout::vertical(parts).areas(area);
            if lines.height == 0 { (area, None) } else { (axes, Some(lines)) }
        }
        None => (area, None),
    }
}

/// The number of rows of all lines.
fn wrapped(area: Rect, layers: &[(Level, Layer)], look: &RenderStyle) -> usize {
    let lines = layers.iter().map(|(_, layer)| match layer {
        Layer::Legend(lines) => rows(area, lines, look).count(),
        _ => 0,
    });
    lines.sum()
}

/// The rows of some lines in the width of an area.
fn rows<'a>(
    area: Rect,
    lines: &'a [String],
    look: &'a RenderStyle,
) -> impl Iterator<Item = String> + 'a {
    let room = usize::from(area.width).saturating_sub(2).max(1);
    lines.iter().flat_map(move |line| clauses(&shown(line, look), room))
}

/// A line in the characters of this terminal, its numbers written as elsewhere.
fn shown(line: &str, look: &RenderStyle) -> String {
    look.glyphs.text(&number::with_powers(line, look.glyphs)).into_owned()
}

/// Writes lines from the top, wrapped, as far as there is room for them; where there is not, the last row says so.
pub(super) fn draw(canvas: &mut Canvas<'_>, area: Rect, lines: &[String]) {
    let look = canvas.look;
    let room = usize::from(area.width).saturating_sub(2);
    let mut rows = rows(area, lines, look).peekable();
    for y in area.y..area.bottom() {
        let Some(mut line) = rows.next() else { break };
        if y + 1 == area.bottom() && rows.peek().is_some() {
            let short: String = line.chars().take(room.saturating_sub(2)).collect();
            line = look.glyphs.text(&format!("{short} …")).into_owned();
        }
        let line = format!("{line} ");
        canvas.buffer.set_stringn(area.x + 1, y, line, room, look.theme[Role::Text]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::colour::ColourDepth;
    use crate::view::glyphs::Glyphs;
    use crate::view::theme::Theme;

    /// Lines beside the axes take a third of a plot at most; longer ones stand above, and the axes have its whole width.
    #[test]
    fn words_leave_the_axes_two_thirds() {
        let look = RenderStyle { theme: Theme::dark(ColourDepth::True), glyphs: Glyphs::Braille };
        for width in [30, 64, 90, 120] {
            for long in [10, 20, 29, 39, 60] {
                let area = Rect::new(5, 3, width, 20);
                let lines = vec!["a".repeat(long), "b".to_owned()];
                let (axes, words) = beside(area, &[(0, Layer::Legend(lines))], &look);
                let words = words.expect("words");
                assert!(axes.width >= width - width / 3, "{width} {long}: {axes:?}");
                assert_eq!(axes.intersection(words).area(), 0, "{width} {long}");
                let is_beside = words.height == area.height;
                assert_eq!(is_beside, width >= WIDE && long as u16 + 2 <= width / 3);
                assert!(is_beside || axes.width == width && axes.height >= 15, "{axes:?}");
            }
        }
    }
}
