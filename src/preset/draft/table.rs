//! A reader of one table of the file. Keys are requested by name, and a key that was never requested is an error.

use toml::Spanned;
use toml::de::{DeArray, DeString, DeTable, DeValue};

use super::value::Value;
use super::{Formula, TOP_LEVEL, value};
use crate::diagnostic::nearest;
use crate::diagnostic::{Diagnostic, Diagnostics, SourceRange};
use crate::preset::schema::{Key, SchemaTable, ValueKind};

/// The functions of a law of motion, and their tables.
const LAWS: [(&str, &str); 3] =
    [("L", "[lagrangian]"), ("H", "[hamiltonian]"), ("dissipation", "[lagrangian]")];

pub(in crate::preset) struct Table<'d> {
    /// Its name in messages: `[run]`, `the coordinate x`.
    pub(super) called: String,
    pub(super) place: SourceRange,
    entries: &'d DeTable<'d>,
    pub(super) diagnostics: &'d Diagnostics,
    /// Its description in the schema; `None` if only its reader knows the keys.
    section: Option<&'static SchemaTable>,
    /// The kind of entry, if kinds have different keys.
    kind: Option<&'static str>,
    asked: Vec<&'static str>,
    passed: Vec<&'static str>,
    absent: Vec<(&'static str, Diagnostic)>,
}

impl<'d> Table<'d> {
    pub(in crate::preset) fn new(
        called: impl Into<String>,
        place: SourceRange,
        entries: &'d DeTable<'d>,
        diagnostics: &'d Diagnostics,
    ) -> Table<'d> {
        let (asked, passed, absent) = (Vec::new(), Vec::new(), Vec::new());
        let called = called.into();
        Table {
            called,
            place,
            entries,
            diagnostics,
            section: None,
            kind: None,
            asked,
            passed,
            absent,
        }
    }

    /// Attaches the schema's description of the table.
    pub(super) fn with(self, section: &'static SchemaTable) -> Table<'d> {
        Table { section: Some(section), ..self }
    }

    /// Sets the kind of the entry, which restricts its keys.
    pub(super) fn is_of_kind(&mut self, kind: &'static str) {
        self.kind = Some(kind);
    }

    /// The schema's description of a key.
    fn row(&self, key: &str) -> Option<&'static Key> {
        let mut rows = self.section?.keys.iter();
        rows.find(|row| row.name == key && self.allows(row))
    }

    fn allows(&self, row: &Key) -> bool {
        self.kind.is_none_or(|kind| row.only.allows(kind))
    }

    /// Whether the schema gives a key the kind that its reader expects.
    fn agrees(&self, key: &str, fits: impl Fn(ValueKind) -> bool) -> bool {
        self.section.is_none() || self.row(key).is_some_and(|row| fits(row.kind))
    }

    /// Reads a value as a table and reports any other value. `shape` shows how the table is written.
    pub(super) fn of(
        value: &'d Value<'d>,
        called: impl Into<String>,
        place: SourceRange,
        shape: &str,
        diagnostics: &'d Diagnostics,
    ) -> Option<Table<'d>> {
        let called = called.into();
        match value.get_ref() {
            DeValue::Table(entries) => Some(Table::new(called, place, entries, diagnostics)),
            other => {
                let message = format!("{called} must be a table, not {}", value::kind(other));
                let diagnostic = Diagnostic::error(value.span(), message);
                diagnostics.push(diagnostic.with_help(format!("write {shape}")));
                None
            }
        }
    }

    /// Whether the key exists, whatever its value.
    pub(super) fn has(&self, key: &'static str) -> bool {
        self.entries.get(key).is_some() || self.misspelt(key).is_some()
    }

    /// The table whose unknown name is reported as a misspelling of this key. It is read as the one that is meant, so that its
    /// names are not unknown as well.
    fn misspelt(&self, key: &'static str) -> Option<(&'d Spanned<DeString<'d>>, &'d Value<'d>)> {
        let known = || self.section.into_iter().flat_map(|section| section.keys.iter());
        let is_meant = |name: &str| {
            known().all(|row| row.name != name)
                && nearest(name, known().map(|row| row.name)) == Some(key)
        };
        let fits = |value: &Value<'_>| match self.row(key).map(|row| row.kind) {
            Some(ValueKind::Tables(_)) => is_table(value) && !value.get_ref().is_table(),
            Some(ValueKind::Table(_) | ValueKind::Named(_) | ValueKind::Names) => {
                value.get_ref().is_table()
            }
            _ => false,
        };
        let mut entries = self.entries.iter();
        entries.find(|(name, value)| fits(value) && is_meant(name.get_ref()))
    }

    /// The range of a key and its value. A key that the schema requires is reported if it is missing.
    pub(in crate::preset) fn take(
        &mut self,
        key: &'static str,
    ) -> Option<(SourceRange, &'d Value<'d>)> {
        debug_assert!(self.agrees(key, |_| true), "the format has no `{key}` in {}", self.called);
        self.asked.push(key);
        let found = self.entries.get_key_value(key).or_else(|| self.misspelt(key));
        if found.is_none()
            && let Some(help) = self.row(key).and_then(|row| row.missing)
        {
            self.lacks_key(key, help);
        }
        found.map(|(written, value)| (written.span(), value))
    }

    pub(super) fn lacks_key(&mut self, key: &'static str, help: &str) {
        let message = format!("{} has no `{key}`", self.called);
        let diagnostic = Diagnostic::error(self.place.clone(), message);
        self.lacks(key, diagnostic.with_help(help));
    }

    /// A key that is required in this case.
    pub(super) fn require(
        &mut self,
        key: &'static str,
        help: &str,
    ) -> Option<(SourceRange, &'d Value<'d>)> {
        let found = self.take(key);
        if found.is_none() {
            self.lacks_key(key, help);
        }
        found
    }

    /// Notes that a key is missing. It is reported at the end, unless it turns out to be misspelled.
    pub(super) fn lacks(&mut self, key: &'static str, diagnostic: Diagnostic) {
        self.absent.push((key, diagnostic));
    }

    /// The value of a key that the schema has as one of this kind.
    fn value<T>(
        &mut self,
        key: &'static str,
        fits: impl Fn(ValueKind) -> bool,
        read: fn(&Value<'d>, &str, &Diagnostics) -> Option<T>,
    ) -> Option<T> {
        debug_assert!(self.agrees(key, fits), "{key} is of another kind in the schema");
        let (_, found) = self.take(key)?;
        read(found, &format!("`{key}`"), self.diagnostics)
    }

    pub(super) fn text(&mut self, key: &'static str) -> Option<Spanned<String>> {
        self.value(key, |kind| matches!(kind, ValueKind::Text), value::text)
    }

    /// A text for display on one line; empty if it is missing.
    pub(super) fn line(&mut self, key: &'static str) -> String {
        let text = self.text(key);
        text.and_then(|text| value::one_line(&text, self.diagnostics)).unwrap_or_default()
    }

    /// The required name of an entry, by which messages call the entry from then on.
    pub(super) fn name(&mut self) -> Option<Spanned<String>> {
        let (_, found) = self.take("name")?;
        let name = value::text(found, "`name`", self.diagnostics)?;
        let shown = name.get_ref().trim();
        if shown.is_empty() || shown.chars().any(char::is_control) {
            let kind = self.called.replacen("this ", "", 1);
            let article = if kind.starts_with(['e', 'i', 'o', 'a']) { "an" } else { "a" };
            let message = format!("{article} {kind} needs a name that can be shown");
            self.diagnostics.push(Diagnostic::error(name.span(), message));
            return None;
        }
        self.called = format!("{} `{shown}`", self.called.replacen("this", "the", 1));
        Some(Spanned::new(name.span(), shown.to_owned()))
    }

    /// A finite number.
    pub(super) fn number(&mut self, key: &'static str) -> Option<Spanned<f64>> {
        self.value(key, |kind| matches!(kind, ValueKind::Number), value::number)
    }

    /// A number or an expression in quotes.
    pub(super) fn formula(&mut self, key: &'static str) -> Option<Formula> {
        self.value(key, |kind| matches!(kind, ValueKind::Formula), value::formula)
    }

    /// `true` or `false`.
    pub(super) fn flag(&mut self, key: &'static str) -> Option<Spanned<bool>> {
        self.value(key, |kind| matches!(kind, ValueKind::Flag), value::flag)
    }

    /// The items of a list; empty if the key is missing.
    pub(super) fn list(&mut self, key: &'static str) -> &'d [Value<'d>] {
        match self.take(key) {
            None => &[],
            Some((_, found)) => {
                let items: Option<&DeArray<'d>> =
                    value::list(found, &format!("`{key}`"), self.diagnostics);
                items.map_or(&[], |items| items)
            }
        }
    }

    /// A subtable, `[key]`.
    pub(super) fn table(&mut self, key: &'static str) -> Option<Table<'d>> {
        let (place, found) = self.take(key)?;
        let shape = format!("[{key}] on a line of its own, and its entries below it");
        let table = Table::of(found, format!("[{key}]"), place, &shape, self.diagnostics)?;
        Some(match self.row(key).map(|row| row.kind) {
            Some(ValueKind::Table(section)) => table.with(section),
            _ => table,
        })
    }

    /// Reads the entries of a list of tables. `shape` shows how each is written; messages call it `called`.
    pub(super) fn items<T>(
        &mut self,
        key: &'static str,
        (called, shape): (&str, &str),
        read: impl Fn(&mut Table<'d>) -> T,
    ) -> Vec<T> {
        let section = self.row(key).and_then(|row| row.kind.section());
        let items = self.list(key).iter();
        let tables =
            items.filter_map(|item| Table::of(item, called, item.span(), shape, self.diagnostics));
        let tables: Vec<Table<'d>> = tables.map(|table| Table { section, ..table }).collect();
        tables.into_iter().map(|table| table.read(&read)).collect()
    }

    /// Reads the tables of one kind, one `[[key]]` each; messages call each one `called`.
    pub(super) fn each<T>(
        &mut self,
        key: &'static str,
        called: &str,
        read: impl Fn(&mut Table<'d>) -> T,
    ) -> Vec<T> {
        self.tables(key, called).into_iter().map(|table| table.read(&read)).collect()
    }

    /// Tables of one kind, one `[[key]]` each; messages call each one `called`.
    pub(super) fn tables(&mut self, key: &'static str, called: &str) -> Vec<Table<'d>> {
        let Some((place, found)) = self.take(key) else { return Vec::new() };
        let head = format!("[[{key}]]");
        let section = match self.row(key).map(|row| row.kind) {
            Some(ValueKind::Tables(section)) => Some(section),
            _ => None,
        };
        match found.get_ref() {
            DeValue::Array(items) => items
                .iter()
                .filter_map(|item| Table::of(item, called, item.span(), &head, self.diagnostics))
                .map(|table| Table { section, ..table })
                .collect(),
            other => {
                let is = value::kind(other);
                let message = format!("`{key}` must be a list of tables, not {is}");
                let help = format!("head each one with {head}, in double brackets");
                self.diagnostics.push(Diagnostic::error(place, message).with_help(help));
                Vec::new()
            }
        }
    }

    /// Marks keys as read, because they are already reported.
    pub(super) fn pass_over(&mut self, keys: &[&'static str]) {
        self.passed.extend(keys);
    }

    /// The entries in order, if the keys are names chosen by the file.
    pub(super) fn entries(&self) -> impl Iterator<Item = (Spanned<String>, &'d Value<'d>)> {
        self.entries
            .iter()
            .map(|(key, value)| (Spanned::new(key.span(), key.get_ref().to_string()), value))
    }

    /// Reads the table to its end.
    pub(super) fn read<T>(mut self, read: impl FnOnce(&mut Table<'d>) -> T) -> T {
        let found = read(&mut self);
        self.finish();
        found
    }

    /// Reports every unknown key and every missing one, once all allowed keys have been read.
    pub(in crate::preset) fn finish(self) {
        let read = |name: &str| self.asked.contains(&name) || self.passed.contains(&name);
        let unread = self
            .entries
            .keys()
            .find(|key| self.row(key.get_ref()).is_some() && !read(key.get_ref()));
        debug_assert!(unread.is_none(), "nobody reads {unread:?} in {}", self.called);
        self.finish_unread();
    }

    /// Like [`finish`](Table::finish), for a table whose reading was abandoned.
    pub(super) fn finish_unread(mut self) {
        let mut known: Vec<&'static str> = match self.section {
            Some(section) => {
                let rows = section.keys.iter().filter(|row| self.allows(row));
                rows.map(|row| row.name).collect()
            }
            None => self.asked.clone(),
        };
        known.dedup();
        for (key, value) in self.entries {
            let name: &str = key.get_ref();
            if known.contains(&name) || self.passed.contains(&name) {
                continue;
            }
            let what = if is_table(value) { "table" } else { "key" };
            let message = format!("unknown {what} `{name}` in {}", self.called);
            let help = if name.bytes().all(|b| b.is_ascii_digit()) {
                "a decimal fraction is written with a point, as 1.5".to_owned()
            } else if let Some(near) = nearest(name, known.iter().copied()) {
                self.absent.retain(|(key, _)| *key != near);
                format!("did you mean `{near}`?")
            } else if TOP_LEVEL.contains(&name) && !self.place.is_empty() {
                format!("`{name}` belongs at the top of the file, before the first [table]")
            } else if let Some((_, law)) = LAWS.iter().find(|(function, _)| *function == name) {
                format!("`{name}` belongs in {law}")
            } else if LAWS.iter().any(|(_, law)| *law == self.called) {
                let keys = known.join(", ");
                format!("the keys here are {keys}; other names are defined in [definitions]")
            } else {
                format!("the keys here are {}", known.join(", "))
            };
            self.diagnostics.push(Diagnostic::error(key.span(), message).with_help(help));
        }
        for (key, diagnostic) in self.absent {
            self.diagnostics.missing(key, diagnostic);
        }
    }
}

/// Whether a value is a table or a list of some.
fn is_table(value: &Value<'_>) -> bool {
    match value.get_ref() {
        DeValue::Table(_) => true,
        DeValue::Array(items) => items.iter().any(|item| item.get_ref().is_table()),
        _ => false,
    }
}
