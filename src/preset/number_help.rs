//! What to write in place of a number that has a unit behind it or a decimal comma.
//!
//! In: the text of a value. Out: the sentence of help. Never here: errors and their places.

/// What to write for a number with a unit behind it or with a decimal comma; `None` if the text is neither.
pub(super) fn number_with_unit(text: &str) -> Option<String> {
    let text = text.trim();
    let (number, unit) = text.split_at(number_end(text));
    let pointed = number.replacen(',', ".", 1);
    pointed.parse::<f64>().ok()?;
    // `2x^2` lacks a `*`
    let separated = unit.starts_with([' ', '°', '%']);
    let unit = unit.trim();
    match unit.chars().next() {
        None if number != pointed => Some(with_point(&pointed)),
        Some(_) if separated && ["°", "deg", "degree", "degrees"].contains(&unit) => {
            Some(format!("angles are in radians: \"{pointed}*pi/180\""))
        }
        Some(first) if separated && is_unit(unit, first) => {
            Some(format!("a unit has a key of its own: {{ value = {pointed}, unit = \"{unit}\" }}"))
        }
        _ => None,
    }
}

/// Where the number ends that a text begins with: digits, a point or a comma, an exponent.
fn number_end(text: &str) -> usize {
    let is_numeric = |c: char| c.is_ascii_digit() || ".,+-".contains(c);
    let end = text.find(|c| !is_numeric(c)).unwrap_or(text.len());
    let exponent = text[end..].strip_prefix(['e', 'E']).unwrap_or_default();
    let digits = exponent.strip_prefix(['+', '-']).unwrap_or(exponent);
    match digits.find(|c: char| !c.is_ascii_digit()).unwrap_or(digits.len()) {
        0 => end,
        count => text.len() - digits.len() + count,
    }
}

/// A unit is made of letters, powers and a fraction: `m/s^2`, `°`, `kg m²`.
fn is_unit(text: &str, first: char) -> bool {
    let one = first.is_alphabetic() && !text.starts_with("pi");
    (one || "°%".contains(first)) && !text.contains(['(', '*', '+', '"', '=', ','])
}

/// What to write for a number whose decimal comma is at this place of the text.
pub(super) fn decimal_comma(text: &str, comma: usize) -> Option<String> {
    let (before, after) = (text.get(..comma)?, text.get(comma..)?.strip_prefix(',')?);
    let is_digit = |c: char| c.is_ascii_digit();
    let whole = &before[before.trim_end_matches(is_digit).len()..];
    let fraction = &after[..after.len() - after.trim_start_matches(is_digit).len()];
    let is_number = !whole.is_empty() && !fraction.is_empty();
    is_number.then(|| with_point(&format!("{whole}.{fraction}")))
}

fn with_point(number: &str) -> String {
    format!("a decimal fraction is written with a point: {number}")
}
