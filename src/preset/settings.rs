//! A file of nothing but keys with plain values, as a configuration is: read with the same care and complained of in
//! the same words as a preset.
//!
//! In: a [`Document`] and the keys it may have. Out: the values as written, each in its place. Never here: what a key
//! is for.

use toml::de::DeValue;

use super::draft::Table;
use super::toml_errors;
use crate::diagnostic::Document;
use crate::diagnostic::SourceRange;
use crate::diagnostic::{Diagnostic, Diagnostics};

/// One key of the file and what stands at it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Entry {
    /// The key.
    pub key: &'static str,
    /// Where its value stands, as bytes of the file.
    pub place: SourceRange,
    /// Its value.
    pub value: Plain,
}

/// A value without parts.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Plain {
    /// A text in quotes.
    Text(String),
    /// A number, as it is written.
    Number(String),
    /// `true` or `false`.
    Flag(bool),
    /// Anything else, by what it is called: "a list".
    Other(&'static str),
}

impl Document {
    /// Reads a file that may have these keys and no other, `called` being how complaints name it: what could be read,
    /// and every slip of TOML and every unknown key.
    pub fn settings(
        &self,
        called: &str,
        keys: &'static [&'static str],
    ) -> (Vec<Entry>, Vec<Diagnostic>) {
        if let Some(mistake) = self.unreadable() {
            return (Vec::new(), vec![mistake.clone()]);
        }
        let mut mistakes = Diagnostics::default();
        let file = toml_errors::parse(&self.text, &mut mistakes);
        let mut entries = Vec::new();
        if !mistakes.lost_track() {
            let mut table = Table::new(called, 0..0, file.get_ref());
            for &key in keys {
                if let Some((_, value)) = table.take(key) {
                    entries.push(Entry { key, place: value.span(), value: plain(value.get_ref()) });
                }
            }
            table.finish(&mut mistakes);
        }
        let mistakes = mistakes.into_list();
        // nothing more is said of a value that is no TOML
        entries.retain(|entry| !mistakes.iter().any(|m| m.place == entry.place));
        (entries, mistakes)
    }
}

fn plain(value: &DeValue<'_>) -> Plain {
    match value {
        DeValue::String(text) => Plain::Text(text.to_string()),
        DeValue::Integer(number) => Plain::Number(number.as_str().to_owned()),
        DeValue::Float(number) => Plain::Number(number.as_str().to_owned()),
        DeValue::Boolean(flag) => Plain::Flag(*flag),
        other => Plain::Other(super::draft::kind(other)),
    }
}
