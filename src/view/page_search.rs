//! The search in a page of text: the line in which it is typed, and its matches.
//!
//! In: rows of a page, words. Out: cells, and which rows match. Never here: the page, or which match is meant.

use ratatui::layout::Rect;
use unicode_width::UnicodeWidthStr;

use super::canvas::{Canvas, Span, columns, row};
use super::theme::Role;
use crate::app::{PageSearch, smart_case};

/// Where some words stand in a row: the places of their first letters, counted in letters.
fn places(line: &[Span], words: &str) -> Vec<usize> {
    if words.is_empty() {
        return Vec::new();
    }
    let text: String = line.iter().map(|(text, _)| text.as_str()).collect();
    let (text, sought) = (smart_case(&text, words), smart_case(words, words));
    text.windows(sought.len()).enumerate().filter(|(_, w)| *w == sought).map(|(at, _)| at).collect()
}

/// The rows in which some words stand.
pub(super) fn matches(lines: &[Vec<Span>], words: &str) -> Vec<usize> {
    let has = |(_, line): &(usize, &Vec<Span>)| !places(line, words).is_empty();
    lines.iter().enumerate().filter(has).map(|(index, _)| index).collect()
}

/// Marks some words in a row that was drawn at this place.
pub(super) fn mark(canvas: &mut Canvas<'_>, at: Rect, line: &[Span], words: &str) {
    let text: String = line.iter().map(|(text, _)| text.as_str()).collect();
    let wide = |count: usize| text.chars().take(count).collect::<String>().width() as u16;
    let length = words.chars().count();
    for place in places(line, words) {
        let (from, to) = (wide(place), wide(place + length));
        canvas.tint(columns(at, from, to - from), Role::Selected);
    }
}

/// The columns kept for the number of matches.
const COUNT: u16 = 12;

/// Draws the line of the search in the first row of an area, with the number of matches, and returns the words.
pub(super) fn line(canvas: &mut Canvas<'_>, area: Rect, search: &PageSearch) -> String {
    let field = columns(row(area, 0), 1, area.width.saturating_sub(2));
    let used = canvas.left(field, Role::Accent, "/ ");
    let place = columns(field, used, field.width);
    let room = usize::from(place.width.saturating_sub(1 + COUNT));
    let skipped = search.input.visual_scroll(room);
    let text: String = search.input.value().chars().skip(skipped).take(room).collect();
    canvas.left(place, Role::Text, &text);
    if search.typing {
        let cursor = search.input.visual_cursor().saturating_sub(skipped).min(room) as u16;
        canvas.point(columns(place, cursor, 1).as_position());
    }
    search.input.value().trim().to_owned()
}

/// Says at the end of that line which match is in view.
pub(super) fn count(canvas: &mut Canvas<'_>, area: Rect, (place, count): (usize, usize)) {
    let said = match count {
        0 => "no match".to_owned(),
        count => format!("{} of {count}", place.min(count - 1) + 1),
    };
    let field = columns(row(area, 0), 1, area.width.saturating_sub(2));
    canvas.right(field, Role::Dim, &said);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_capital_letter_matches_itself_only() {
        let span = |text: &str| (text.to_owned(), ratatui::style::Style::new());
        let lines = vec![
            vec![span("The La"), span("grangian")],
            vec![span("a lagrangian")],
            vec![span("H")],
        ];
        assert_eq!(matches(&lines, "lagr"), [0, 1]);
        assert_eq!(matches(&lines, "Lagr"), [0]);
        assert_eq!(matches(&lines, "h"), [0, 2]);
        assert_eq!(matches(&lines, ""), [0_usize; 0]);
    }
}
