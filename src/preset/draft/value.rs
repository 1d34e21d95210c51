//! Converts one value of TOML to the expected kind, or reports its actual kind.

use toml::Spanned;
use toml::de::{DeArray, DeValue};

use super::Formula;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{Allowed, Model, Scope};
use crate::preset::number_help::number_with_unit;
use crate::printable::is_steering;

pub(in crate::preset) type Value<'d> = Spanned<DeValue<'d>>;

pub(in crate::preset) fn kind(value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::String(_) => "a text in quotes",
        DeValue::Integer(_) | DeValue::Float(_) => "a number",
        DeValue::Boolean(_) => "true or false",
        DeValue::Datetime(_) => "a date",
        DeValue::Array(_) => "a list",
        DeValue::Table(_) => "a table",
    }
}

/// What was read, or nothing and a diagnostic that a value is of the wrong kind.
fn of_kind<T>(
    read: Option<T>,
    value: &Value<'_>,
    (called, wanted): (&str, &str),
    diagnostics: &Diagnostics,
) -> Option<T> {
    if read.is_none() {
        let message = format!("{called} must be {wanted}, not {}", kind(value.get_ref()));
        diagnostics.push(Diagnostic::error(value.span(), message));
    }
    read
}

pub(super) fn text(
    value: &Value<'_>,
    called: &str,
    diagnostics: &Diagnostics,
) -> Option<Spanned<String>> {
    let text = value.get_ref().as_str().map(|text| Spanned::new(value.span(), text.to_owned()));
    of_kind(text, value, (called, "a text in quotes"), diagnostics)
}

/// `true` or `false`.
pub(super) fn flag(
    value: &Value<'_>,
    called: &str,
    diagnostics: &Diagnostics,
) -> Option<Spanned<bool>> {
    let flag = value.get_ref().as_bool().map(|flag| Spanned::new(value.span(), flag));
    of_kind(flag, value, (called, "true or false"), diagnostics)
}

pub(super) fn list<'d>(
    value: &'d Value<'d>,
    called: &str,
    diagnostics: &Diagnostics,
) -> Option<&'d DeArray<'d>> {
    of_kind(value.get_ref().as_array(), value, (called, "a list in [ ]"), diagnostics)
}

/// A finite number.
pub(super) fn number(
    value: &Value<'_>,
    called: &str,
    diagnostics: &Diagnostics,
) -> Option<Spanned<f64>> {
    let digits = match value.get_ref() {
        DeValue::Integer(_) | DeValue::Float(_) => digits(value, called, diagnostics)?,
        DeValue::String(text) => {
            let message = format!("{called} must be a number, not a text in quotes");
            let help = if text.parse::<f64>().is_ok() {
                "remove the quotes"
            } else {
                "write its value in digits, without quotes"
            };
            diagnostics.push(Diagnostic::error(value.span(), message).with_help(help));
            return None;
        }
        _ => of_kind(None, value, (called, "a number"), diagnostics)?,
    };
    digits.parse().ok().map(|number| Spanned::new(value.span(), number))
}

/// A finite number, or an expression of numbers in quotes: `"2*pi"`.
pub(super) fn constant(
    value: &Value<'_>,
    called: &str,
    diagnostics: &Diagnostics,
) -> Option<Spanned<f64>> {
    let DeValue::String(text) = value.get_ref() else {
        return number(value, called, diagnostics);
    };
    let mut nothing = Model::new("");
    let mut scope = Scope::new(&nothing, Allowed::Parameters, "a number");
    let read = scope.read(&mut nothing.pool, text).filter(|_| scope.diagnostics.is_empty());
    diagnostics.note_plain(value.span(), scope.plain.take());
    let found = read.map(|e| nothing.pool.evaluate(e, &|_| f64::NAN));
    let Some(found) = found.filter(|x| x.is_finite()) else {
        let message = format!("{called} must be a finite number, or an expression of numbers");
        let help = number_with_unit(text).unwrap_or_else(|| {
            "write 2.5 or \"2*pi\"; what follows from other parameters belongs in [definitions]"
                .to_owned()
        });
        diagnostics.push(Diagnostic::error(value.span(), message).with_help(help));
        return None;
    };
    Some(Spanned::new(value.span(), found))
}

/// A number or an expression in quotes.
pub(super) fn formula(
    value: &Value<'_>,
    called: &str,
    diagnostics: &Diagnostics,
) -> Option<Formula> {
    let written = match value.get_ref() {
        DeValue::String(text) => text.to_string(),
        DeValue::Integer(_) | DeValue::Float(_) => digits(value, called, diagnostics)?,
        _ => of_kind(None, value, (called, "a number or an expression in quotes"), diagnostics)?,
    };
    Some(Formula::new(value.span(), written))
}

/// The decimal digits of a TOML number, as expressions write them.
fn digits(value: &Value<'_>, called: &str, diagnostics: &Diagnostics) -> Option<String> {
    let written = match value.get_ref() {
        DeValue::Integer(integer) if integer.radix() == 10 => Some(integer.as_str().to_owned()),
        DeValue::Integer(integer) => {
            i64::from_str_radix(integer.as_str(), integer.radix()).ok().map(|n| n.to_string())
        }
        DeValue::Float(float) => Some(float.as_str().to_owned()),
        _ => None,
    };
    let written = written.map(|digits| digits.trim_start_matches('+').to_owned());
    match written.filter(|digits| digits.parse::<f64>().is_ok_and(f64::is_finite)) {
        Some(digits) => Some(digits),
        None => {
            let message = format!("{called} must be a finite number");
            diagnostics.push(Diagnostic::error(value.span(), message));
            None
        }
    }
}

/// A text for display on one line, without terminal control characters.
pub(super) fn one_line(text: &Spanned<String>, diagnostics: &Diagnostics) -> Option<String> {
    shown(text, |_| false, diagnostics).map(|text| text.trim().to_owned())
}

/// A text for display on several lines.
pub(super) fn lines(text: &Spanned<String>, diagnostics: &Diagnostics) -> Option<String> {
    shown(text, |c| matches!(c, '\n' | '\r' | '\t'), diagnostics)
        .map(|text| text.trim().replace("\r\n", "\n").replace('\t', "    "))
}

fn shown<'t>(
    text: &'t Spanned<String>,
    allowed: impl Fn(char) -> bool,
    diagnostics: &Diagnostics,
) -> Option<&'t str> {
    match text.get_ref().chars().find(|&c| is_steering(c) && !allowed(c)) {
        None => Some(text.get_ref()),
        Some(c) => {
            let message = format!("the character U+{:04X} may not be used in a text", c as u32);
            let help = match c {
                '\n' | '\r' => Some("this text stands on one line; \"notes\" may be longer"),
                '\t' => Some("use spaces"),
                _ => None,
            };
            let mut diagnostic = Diagnostic::error(text.span(), message);
            diagnostic.help = help.map(str::to_owned);
            diagnostics.push(diagnostic);
            None
        }
    }
}
