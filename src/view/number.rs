//! Numbers for people: few digits, a steady width, a true minus sign and raised exponents.
//!
//! In: any `f64`. Out: short text, in ASCII if [`Glyphs`] require it. Never here: machine formats, which are
//! shortest round-trip decimals and belong to the command line.

use super::glyphs::{Glyphs, TextWidth};

/// Formats a changing value: always `significant` digits (1 to 17), so that its width changes only with its magnitude.
///
/// Examples: `0.1235`, `12.35`, `12346`, `1.235×10⁻¹²`. Zero, the infinities and NaN have forms of their own.
pub fn readable(value: f64, significant: usize, glyphs: Glyphs) -> String {
    format(value, significant, glyphs, false)
}

/// Formats a changing value in a column: like [`readable`], with as many of the digits as fit.
pub fn fitted(value: f64, significant: usize, width: usize, glyphs: Glyphs) -> String {
    let texts = (1..=significant.max(1)).rev().map(|digits| readable(value, digits, glyphs));
    // A power of ten leaves room for few digits; `2e-15` is shorter than `2×10⁻¹⁵`.
    let short = signed(format!("{value:.0e}"), glyphs);
    texts.chain([short]).find(|text| text.width() <= width).unwrap_or_else(|| "#".repeat(width))
}

/// Formats a constant value: like [`readable`], without trailing zeros (`1`, not `1.000`).
pub fn brief(value: f64, significant: usize, glyphs: Glyphs) -> String {
    format(value, significant, glyphs, true)
}

/// Formats a constant value in a column: like [`brief`], with as many of the digits as fit.
pub fn brief_in(value: f64, significant: usize, width: usize, glyphs: Glyphs) -> String {
    let mut texts = (1..=significant.max(1)).rev().map(|digits| brief(value, digits, glyphs));
    texts.find(|text| text.width() <= width).unwrap_or_else(|| fitted(value, 1, width, glyphs))
}

/// Formats the size of an error: two digits and a power of ten (`3.1×10⁻¹⁶`); an exact zero is `0`.
pub fn drift(value: f64, glyphs: Glyphs) -> String {
    drift_in(value, usize::MAX, glyphs)
}

/// Formats the size of an error in a column: like [`drift`], with one digit if two do not fit.
pub fn drift_in(value: f64, width: usize, glyphs: Glyphs) -> String {
    if value.is_nan() {
        return "unknown".to_owned();
    }
    if value == 0.0 || !value.is_finite() {
        return format(value, 2, glyphs, false);
    }
    let written = |digits: usize| {
        let text = format!("{value:.digits$e}");
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        times_power(mantissa, exponent.parse().unwrap_or(0), glyphs)
    };
    Some(written(1)).filter(|text| text.width() <= width).unwrap_or_else(|| written(0))
}

/// Replaces the hyphen before a number in a text by the minus sign of these glyphs.
pub fn with_minus_signs(text: &str, glyphs: Glyphs) -> String {
    if glyphs.is_ascii() {
        return text.to_owned();
    }
    let mut before = ' ';
    let mut characters = text.chars().peekable();
    let mut out = String::with_capacity(text.len());
    while let Some(character) = characters.next() {
        let number = characters.peek().is_some_and(char::is_ascii_digit);
        let joins = before.is_alphanumeric();
        out.push(if character == '-' && number && !joins { '−' } else { character });
        before = character;
    }
    out
}

/// Replaces the exponents of numbers in a text by powers of ten as these glyphs have them: `3e−16` by `3×10⁻¹⁶`.
pub fn with_powers(text: &str, glyphs: Glyphs) -> String {
    if glyphs.is_ascii() {
        return text.to_owned();
    }
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find('e') {
        let (before, after) = (&rest[..at], &rest[at + 1..]);
        let sign = after.chars().next().filter(|c| matches!(c, '-' | '−'));
        let digits = &after[sign.map_or(0, char::len_utf8)..];
        let count = digits.chars().take_while(char::is_ascii_digit).count();
        let ends = !digits[count..].starts_with(|c: char| c.is_alphanumeric() || c == '_');
        let word = before.rsplit(|c: char| !c.is_alphanumeric() && c != '.').next().unwrap_or("");
        let mantissa = !word.is_empty() && word.chars().all(|c| c.is_ascii_digit() || c == '.');
        let exponent = digits[..count].parse::<i32>().ok().filter(|_| mantissa && ends);
        out.push_str(before);
        if let Some(exponent) = exponent {
            out.push_str(&power(if sign.is_some() { -exponent } else { exponent }, glyphs));
            rest = &digits[count..];
        } else {
            out.push('e');
            rest = after;
        }
    }
    out + rest
}

/// Formats a power of ten as a factor: `×10⁻³`, or `x1e-3`.
pub fn power(exponent: i32, glyphs: Glyphs) -> String {
    if glyphs.is_ascii() { format!("x1e{exponent}") } else { format!("×10{}", raised(exponent)) }
}

/// Formats an integer in superscripts.
pub fn raised(number: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let plain = number.to_string();
    plain.chars().map(|c| c.to_digit(10).map_or('⁻', |digit| DIGITS[digit as usize])).collect()
}

/// Replaces the hyphen by the minus sign of these glyphs.
pub fn signed(text: String, glyphs: Glyphs) -> String {
    if glyphs.is_ascii() { text } else { text.replace('-', "−") }
}

fn format(value: f64, significant: usize, glyphs: Glyphs, trim: bool) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        let text = if value.is_nan() { "NaN".to_owned() } else { format!("{value}") };
        return signed(text.replace("inf", glyphs.pick("∞", "inf")), glyphs);
    }
    let significant = significant.clamp(1, 17);
    // The value is rounded first, because 9.9996 to four digits is 10.00, of another magnitude.
    let scientific = format!("{value:.*e}", significant - 1);
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let most = (significant as i32 - 1).max(4);
    if (-3..=most).contains(&exponent) {
        let decimals = (significant as i32 - 1 - exponent).max(0) as usize;
        let text = format!("{value:.decimals$}");
        return signed(if trim { trimmed(&text).to_owned() } else { text }, glyphs);
    }
    times_power(if trim { trimmed(mantissa) } else { mantissa }, exponent, glyphs)
}

/// Joins a mantissa and a power of ten, unless that is 1.
fn times_power(mantissa: &str, exponent: i32, glyphs: Glyphs) -> String {
    if exponent == 0 {
        signed(mantissa.to_owned(), glyphs)
    } else if glyphs.is_ascii() {
        format!("{mantissa}e{exponent}")
    } else {
        signed(mantissa.to_owned(), glyphs) + &power(exponent, glyphs)
    }
}

/// Removes trailing zeros after the decimal point.
fn trimmed(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}
