//! One table of the file while it is read: keys are asked for by name, and what nobody asked for
//! is a mistake.

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use super::{Formula, TOP_LEVEL, value};
use crate::diagnostic::nearest;
use crate::diagnostic::{Diagnostic, Diagnostics, SourceRange};

/// A value of TOML with its span.
pub(in crate::preset) type Value<'d> = Spanned<DeValue<'d>>;

/// A table that is being read.
pub(in crate::preset) struct Table<'d> {
    /// What messages call it: `[run]`, `the coordinate x`.
    pub(super) called: String,
    /// Where it stands.
    pub(super) place: SourceRange,
    entries: &'d DeTable<'d>,
    asked: Vec<&'static str>,
    passed: Vec<&'static str>,
    absent: Vec<(&'static str, Diagnostic)>,
}

impl<'d> Table<'d> {
    pub(in crate::preset) fn new(
        called: impl Into<String>,
        place: SourceRange,
        entries: &'d DeTable<'d>,
    ) -> Table<'d> {
        let (asked, passed, absent) = (Vec::new(), Vec::new(), Vec::new());
        Table { called: called.into(), place, entries, asked, passed, absent }
    }

    /// A value as a table; a complaint where it is none. `shape` shows how it is written.
    pub(super) fn of(
        value: &'d Value<'d>,
        called: impl Into<String>,
        place: SourceRange,
        shape: &str,
        mistakes: &mut Diagnostics,
    ) -> Option<Table<'d>> {
        let called = called.into();
        match value.get_ref() {
            DeValue::Table(entries) => Some(Table::new(called, place, entries)),
            other => {
                let message = format!("{called} must be a table, not {}", value::kind(other));
                let mistake = Diagnostic::error(value.span(), message);
                mistakes.push(mistake.with_help(format!("write {shape}")));
                None
            }
        }
    }

    /// Whether a key stands here, whatever its value.
    pub(super) fn has(&self, key: &str) -> bool {
        self.entries.get(key).is_some()
    }

    /// A key's place and value.
    pub(in crate::preset) fn take(
        &mut self,
        key: &'static str,
    ) -> Option<(SourceRange, &'d Value<'d>)> {
        self.asked.push(key);
        let (written, value) = self.entries.get_key_value(key)?;
        Some((written.span(), value))
    }

    /// A key that has to be there.
    pub(super) fn require(
        &mut self,
        key: &'static str,
        help: &str,
    ) -> Option<(SourceRange, &'d Value<'d>)> {
        let found = self.take(key);
        if found.is_none() {
            let message = format!("{} has no `{key}`", self.called);
            let mistake = Diagnostic::error(self.place.clone(), message);
            self.lacks(key, mistake.with_help(help));
        }
        found
    }

    /// Takes note that a key is missing; told at the end, unless it is there misspelt.
    pub(super) fn lacks(&mut self, key: &'static str, mistake: Diagnostic) {
        self.absent.push((key, mistake));
    }

    /// A text.
    pub(super) fn text(
        &mut self,
        key: &'static str,
        mistakes: &mut Diagnostics,
    ) -> Option<Spanned<String>> {
        let (_, found) = self.take(key)?;
        value::text(found, &format!("`{key}`"), mistakes)
    }

    /// A text to be shown on one line, or nothing.
    pub(super) fn line(&mut self, key: &'static str, mistakes: &mut Diagnostics) -> String {
        let text = self.text(key, mistakes);
        text.and_then(|text| value::one_line(&text, mistakes)).unwrap_or_default()
    }

    /// The name of an entry, which has to be there; messages call the entry by it from then on.
    pub(super) fn name(&mut self, mistakes: &mut Diagnostics) -> Option<Spanned<String>> {
        let (_, found) = self.require("name", "write name = \"...\"")?;
        let name = value::text(found, "`name`", mistakes)?;
        let shown = name.get_ref().trim();
        if shown.is_empty() || shown.chars().any(char::is_control) {
            let kind = self.called.replacen("this ", "", 1);
            let article = if kind.starts_with(['e', 'i', 'o', 'a']) { "an" } else { "a" };
            let message = format!("{article} {kind} needs a name that can be shown");
            mistakes.push(Diagnostic::error(name.span(), message));
            return None;
        }
        self.called = format!("{} `{shown}`", self.called.replacen("this", "the", 1));
        Some(Spanned::new(name.span(), shown.to_owned()))
    }

    /// A finite number.
    pub(super) fn number(
        &mut self,
        key: &'static str,
        mistakes: &mut Diagnostics,
    ) -> Option<Spanned<f64>> {
        let (_, found) = self.take(key)?;
        value::number(found, &format!("`{key}`"), mistakes)
    }

    /// A number or an expression in quotes.
    pub(super) fn formula(
        &mut self,
        key: &'static str,
        mistakes: &mut Diagnostics,
    ) -> Option<Formula> {
        let (_, found) = self.take(key)?;
        value::formula(found, &format!("`{key}`"), mistakes)
    }

    /// `true` or `false`.
    pub(super) fn flag(
        &mut self,
        key: &'static str,
        mistakes: &mut Diagnostics,
    ) -> Option<Spanned<bool>> {
        let (_, found) = self.take(key)?;
        value::flag(found, &format!("`{key}`"), mistakes)
    }

    /// The items of a list, none where the key is left out.
    pub(super) fn list(
        &mut self,
        key: &'static str,
        mistakes: &mut Diagnostics,
    ) -> &'d [Value<'d>] {
        match self.take(key) {
            None => &[],
            Some((_, found)) => {
                let items: Option<&DeArray<'d>> = value::list(found, &format!("`{key}`"), mistakes);
                items.map_or(&[], |items| items)
            }
        }
    }

    /// A table of its own, `[key]`.
    pub(super) fn table(
        &mut self,
        key: &'static str,
        mistakes: &mut Diagnostics,
    ) -> Option<Table<'d>> {
        let (place, found) = self.take(key)?;
        Table::of(found, format!("[{key}]"), place, &format!("[{key}]"), mistakes)
    }

    /// Tables of one kind, `[[key]]` each; messages call each one `called`.
    pub(super) fn tables(
        &mut self,
        key: &'static str,
        called: &str,
        mistakes: &mut Diagnostics,
    ) -> Vec<Table<'d>> {
        let Some((place, found)) = self.take(key) else { return Vec::new() };
        let head = format!("[[{key}]]");
        match found.get_ref() {
            DeValue::Array(items) => items
                .iter()
                .filter_map(|item| Table::of(item, called, item.span(), &head, mistakes))
                .collect(),
            other => {
                let is = value::kind(other);
                let message = format!("`{key}` must be a list of tables, not {is}");
                let help = format!("head each one with {head}, in double brackets");
                mistakes.push(Diagnostic::error(place, message).with_help(help));
                Vec::new()
            }
        }
    }

    /// Keys of which all is said.
    pub(super) fn pass_over(&mut self, keys: &[&'static str]) {
        self.passed.extend(keys);
    }

    /// The entries in order, where the keys are names of the file's own.
    pub(super) fn entries(&self) -> impl Iterator<Item = (Spanned<String>, &'d Value<'d>)> {
        self.entries
            .iter()
            .map(|(key, value)| (Spanned::new(key.span(), key.get_ref().to_string()), value))
    }

    /// Complains of every key that nobody asked for, and of those that are missing.
    pub(in crate::preset) fn finish(mut self, mistakes: &mut Diagnostics) {
        for (key, value) in self.entries {
            let name: &str = key.get_ref();
            if self.asked.contains(&name) || self.passed.contains(&name) {
                continue;
            }
            let tables = match value.get_ref() {
                DeValue::Table(_) => true,
                DeValue::Array(items) => items.iter().any(|item| item.get_ref().is_table()),
                _ => false,
            };
            let what = if tables { "table" } else { "key" };
            let message = format!("unknown {what} `{name}` in {}", self.called);
            let help = if let Some(near) = nearest(name, self.asked.iter().copied()) {
                self.absent.retain(|(key, _)| *key != near);
                format!("did you mean `{near}`?")
            } else if TOP_LEVEL.contains(&name) && !self.place.is_empty() {
                format!("`{name}` belongs at the top of the file, before the first [table]")
            } else {
                let mut known: Vec<&str> = self.asked.clone();
                known.dedup();
                format!("the keys here are {}", known.join(", "))
            };
            mistakes.push(Diagnostic::error(key.span(), message).with_help(help));
        }
        for (key, mistake) in self.absent {
            mistakes.missing(key, mistake);
        }
    }
}
