//! Points, directions and triples of angles: lists of expressions, as written.

use toml::Spanned;
use toml::de::DeValue;

use super::table::Table;
use super::value::Value;
use super::{Formula, value};
use crate::diagnostic::{Diagnostic, Diagnostics};

/// Two or three expressions, with their common range.
pub(in crate::preset) type Formulas = Spanned<Vec<Formula>>;

/// A required point; the third component is optional.
pub(super) fn point(table: &mut Table<'_>, key: &'static str) -> Option<Formulas> {
    let help = format!("write {key} = [\"x\", \"y\", \"z\"]");
    let (_, found) = table.require(key, &help)?;
    entries(found, key, 2, table.diagnostics)
}

/// An optional point or direction; its third component is also optional.
pub(super) fn optional_point(table: &mut Table<'_>, key: &'static str) -> Option<Formulas> {
    let (_, found) = table.take(key)?;
    entries(found, key, 2, table.diagnostics)
}

/// Three expressions.
pub(super) fn triple(table: &mut Table<'_>, key: &'static str) -> Option<Formulas> {
    let (_, found) = table.take(key)?;
    entries(found, key, 3, table.diagnostics)
}

/// A list of `least` to three expressions.
fn entries(
    found: &Value<'_>,
    key: &str,
    least: usize,
    diagnostics: &Diagnostics,
) -> Option<Formulas> {
    let items = match found.get_ref() {
        DeValue::Array(items) if (least..=3).contains(&items.len()) => items,
        other => {
            let is = match other {
                DeValue::Array(items) => format!("a list of {}", items.len()),
                other => value::kind(other).to_owned(),
            };
            let many = if least == 3 { "three" } else { "two or three" };
            let message = format!("`{key}` must be a list of {many} expressions, not {is}");
            diagnostics.push(Diagnostic::error(found.span(), message));
            return None;
        }
    };
    let called = if least == 3 { format!("an entry of `{key}`") } else { COORDINATE.to_owned() };
    let formulas: Vec<Formula> =
        items.iter().filter_map(|item| value::formula(item, &called, diagnostics)).collect();
    (formulas.len() == items.len()).then(|| Formulas::new(found.span(), formulas))
}

const COORDINATE: &str = "a coordinate of a point";
