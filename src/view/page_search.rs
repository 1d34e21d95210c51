//! The search in a page of text: the line in which it is typed, and its matches.
//!
//! In: rows of a page, words. Out: cells, and which rows match. Never here: the page, or which match is meant.

use std::ops::Range;

use ratatui::layout::Rect;
use unicode_width::UnicodeWidthStr;

use super::canvas::{Canvas, StyledText, columns, row};
use super::theme::Role;
use crate::app::{PageSearch, smart_case};
use crate::expr::{spelt, spelt_derivatives};

/// The characters of a text as they are compared, each in the letters in which it is spelt: `theta` and `θ` are the same, and so
/// are `x^2` and `x²`.
fn folded(text: &str, words: &str) -> Vec<Vec<char>> {
    let text: String = smart_case(text, words).into_iter().collect();
    spelt(&text)
}

/// The number of characters at the beginning of a text that make up some letters: no character is matched in part, so that `eta` is
/// not found in θ.
fn prefix(text: &[Vec<char>], mut letters: &[char]) -> Option<usize> {
    for (count, character) in text.iter().enumerate() {
        if letters.is_empty() {
            return Some(count);
        }
        letters = letters.strip_prefix(character.as_slice())?;
    }
    letters.is_empty().then_some(text.len())
}

/// Where some words stand in a row, counted in characters.
fn places(line: &[StyledText], words: &str) -> Vec<Range<usize>> {
    let row: String = line.iter().map(|(text, _)| text.as_str()).collect();
    let (text, pattern) = (folded(&row, words), folded(words, words).concat());
    if pattern.is_empty() {
        return Vec::new();
    }
    let here = |at: usize| Some(at..at + prefix(&text[at..], &pattern)?);
    let mut places: Vec<Range<usize>> = (0..text.len()).filter_map(here).collect();
    // ∂G/∂t is found as a fraction, and as the d_t G that ASCII has
    let is_typed = |spelling: &str| folded(spelling, words).concat().starts_with(&pattern);
    let derivatives = spelt_derivatives(&row).into_iter();
    places.extend(derivatives.filter(|(_, text)| is_typed(text)).map(|(place, _)| place));
    places
}

/// The rows in which some words stand.
pub(super) fn matches(lines: &[Vec<StyledText>], words: &str) -> Vec<usize> {
    let has = |(_, line): &(usize, &Vec<StyledText>)| !places(line, words).is_empty();
    lines.iter().enumerate().filter(has).map(|(index, _)| index).collect()
}

/// Marks some words in a row that was drawn at this place.
pub(super) fn mark(canvas: &mut Canvas<'_>, at: Rect, line: &[StyledText], words: &str) {
    let text: String = line.iter().map(|(text, _)| text.as_str()).collect();
    let wide = |count: usize| text.chars().take(count).collect::<String>().width() as u16;
    for place in places(line, words) {
        let (from, to) = (wide(place.start), wide(place.end));
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
    let found = match count {
        0 => "no match".to_owned(),
        count => format!("{} of {count}", place.min(count - 1) + 1),
    };
    let field = columns(row(area, 0), 1, area.width.saturating_sub(2));
    canvas.right(field, Role::Dim, &found);
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

    #[test]
    fn letters_that_keyboards_lack_are_found_as_they_are_spelt() {
        let row = |text: &str| vec![(text.to_owned(), ratatui::style::Style::new())];
        let found = |words: &str, text: &str| places(&row(text), words);
        // a list of one range would be taken for that of its numbers
        let only = |place: Range<usize>| vec![place];
        assert_eq!(found("theta", "l² θ″ = −g sin θ"), [3..4, 15..16]);
        assert_eq!(found("θ", "the angle theta"), only(10..15));
        assert_eq!(found("p_phi", "p_φ′ = 0"), only(0..3));
        assert_eq!(found("theta1'", "θ₁′"), only(0..3));
        assert_eq!(found("l^2 theta''", "l² θ″"), only(0..5));
        assert_eq!(found("Lambda", "λ and Λ"), only(6..7));
        assert_eq!(found("lambda", "λ and Λ"), [0..1, 6..7]);
        let none: [Range<usize>; 0] = [];
        assert_eq!(found("eta", "θ and β"), none, "a letter is not found in part");
        assert_eq!(found("the", "θ"), none);
        assert_eq!(found("?", "✦"), none, "what has no spelling is itself");
        assert_eq!(found("d_t", "E   ∂L/∂t = 0"), only(4..9));
        assert_eq!(found("d_t L", "E   ∂L/∂t = 0, dL/dt"), only(4..9));
        assert_eq!(found("dL/dt", "∂L/∂t = 0"), only(0..5));
        assert_eq!(found("d_p_theta", "∂H/∂p_θ"), only(0..7));
        assert_eq!(found("d_t", "∂L/∂q, d_θ"), none);
        for rate in ["θ′", "θ\u{307}"] {
            assert_eq!(found("theta'", rate), only(0..2));
        }
        assert_eq!(found("", "θ"), none);
    }
}
