//! The smart-case rule of searches: small letters also match capital ones, unless the pattern has a capital letter.
//!
//! In: a text and a pattern. Out: letters to be compared. Never here: where a match is looked for.

/// The letters of a text as a search for `pattern` compares them: as they are if `pattern` has a capital letter, else small.
pub fn smart_case(text: &str, pattern: &str) -> Vec<char> {
    let is_exact = pattern.chars().any(char::is_uppercase);
    let letter = |c: char| if is_exact { c } else { c.to_lowercase().next().unwrap_or(c) };
    text.chars().map(letter).collect()
}
