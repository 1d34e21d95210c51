//! Highlighting: a text in which the letters that match a search are marked.
//!
//! In: a text and its match. Out: spans. Never here: the search itself.

use unicode_width::UnicodeWidthChar;

use super::canvas::{Canvas, StyledText};
use super::theme::Role;
use crate::app::FuzzyMatch;

/// Splits the text into spans and highlights those that match.
pub(super) fn found_in(
    canvas: &Canvas<'_>,
    text: &str,
    (fit, role): (&FuzzyMatch, Role),
) -> Vec<StyledText> {
    let mut spans: Vec<StyledText> = Vec::new();
    let mut last = None;
    for (place, letter) in text.chars().enumerate() {
        let found = fit.letters.binary_search(&place).is_ok();
        // A combining mark belongs to its letter.
        let combining = letter.width() == Some(0);
        if last != Some(found) && !combining || spans.is_empty() {
            let marked = canvas.style(Role::Accent).underlined();
            spans.push((String::new(), if found { marked } else { canvas.style(role) }));
            last = Some(found);
        }
        if let Some((text, _)) = spans.last_mut() {
            text.push(letter);
        }
    }
    spans.into_iter().map(|(text, style)| (canvas.text(&text), style)).collect()
}
