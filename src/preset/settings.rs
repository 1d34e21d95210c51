//! A flat file of keys with plain values, such as a configuration. It is read with the same care as a preset, and its
//! errors are reported in the same words.
//!
//! In: a [`Document`] and its allowed keys. Out: the values as written, each with its range. Never here: what a key
//! is for.

use toml::de::DeValue;

use super::draft::Table;
use super::toml_errors;
use crate::diagnostic::Document;
use crate::diagnostic::SourceRange;
use crate::diagnostic::{Diagnostic, Diagnostics};

/// A key of the file with its value.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Setting {
    /// As in the file: the part before `=`.
    pub key: &'static str,
    /// The byte range of its value in the file.
    pub place: SourceRange,
    /// What stands behind the `=`.
    pub value: PlainValue,
}

/// A plain value.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum PlainValue {
    /// A text in quotes.
    Text(String),
    /// A number as written.
    Number(String),
    /// `true` or `false`.
    Flag(bool),
    /// Anything else, by its name: "a list".
    Other(&'static str),
}

impl Document {
    /// Reads a file that may have only these keys. `called` is its name in messages. Returns the values that could be
    /// read, every TOML error and every unknown key.
    pub fn settings(&self, called: &str, keys: &[&'static str]) -> (Vec<Setting>, Vec<Diagnostic>) {
        if let Some(diagnostic) = self.unreadable() {
            return (Vec::new(), vec![diagnostic.clone()]);
        }
        let mut diagnostics = Diagnostics::default();
        let file = toml_errors::parse(&self.text, &mut diagnostics);
        let mut entries = Vec::new();
        if !diagnostics.lost_track() {
            let mut table = Table::new(called, 0..0, file.get_ref(), &diagnostics);
            for &key in keys {
                if let Some((_, value)) = table.take(key) {
                    entries.push(Setting {
                        key,
                        place: value.span(),
                        value: plain(value.get_ref()),
                    });
                }
            }
            table.finish();
        }
        let diagnostics = diagnostics.into_list();
        // a value that is not TOML is already reported
        entries.retain(|entry| !diagnostics.iter().any(|m| m.place == entry.place));
        (entries, diagnostics)
    }
}

fn plain(value: &DeValue<'_>) -> PlainValue {
    match value {
        DeValue::String(text) => PlainValue::Text(text.to_string()),
        DeValue::Integer(number) => PlainValue::Number(number.as_str().to_owned()),
        DeValue::Float(number) => PlainValue::Number(number.as_str().to_owned()),
        DeValue::Boolean(flag) => PlainValue::Flag(*flag),
        other => PlainValue::Other(super::draft::kind(other)),
    }
}
