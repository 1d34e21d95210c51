//! The smart-case rule of searches: small letters also match capital ones, unless what is sought has a capital letter.
//!
//! In: a text, and what is sought. Out: letters to be compared. Never here: where a match is looked for.

/// The letters of a text as a search for `sought` compares them: as they are if `sought` has a capital letter, else small.
pub fn smart_case(text: &str, sought: &str) -> Vec<char> {
    let is_exact = sought.chars().any(char::is_uppercase);
    let letter = |c: char| if is_exact { c } else { c.to_lowercase().next().unwrap_or(c) };
    text.chars().map(letter).collect()
}
