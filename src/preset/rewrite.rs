//! Rewrites a file with other values and preserves everything else as its author wrote it, comments included.
//!
//! In: a text, values by name. Out: a text. Never here: which values; whether the new text is valid.

use std::ops::Range;

use serde::{Deserialize, Serialize};
use toml_edit::{
    Array, ArrayOfTables, Document, DocumentMut, InlineTable, Item, Table, TableLike, TomlError,
    Value, value,
};

/// The values to write into a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rewrite {
    /// The time of the initial values.
    pub start: Option<f64>,
    /// The changed initial values of coordinates or variables.
    pub initial: Vec<InitialValue>,
    /// The initial Euler angles, for a body whose attitude is integrated.
    pub attitude: Option<[f64; 3]>,
    /// Their new values, by name.
    pub parameters: Vec<(String, f64)>,
    /// Its name, if it is to be another one.
    pub method: Option<String>,
    /// The numbers of `[run]`: `step`, `tolerance`, `speed`.
    pub run: Vec<(&'static str, f64)>,
}

/// The initial value of a coordinate or variable.
#[derive(Clone, Debug, PartialEq)]
pub struct InitialValue {
    /// The name of the coordinate or variable.
    pub name: String,
    /// Where it begins.
    pub value: f64,
    /// The key `velocity` or `momentum` and its value; a variable has neither.
    pub rate: Option<(&'static str, f64)>,
}

impl Rewrite {
    /// Writes the values into a text.
    ///
    /// # Errors
    /// Returns an error if the text is not valid TOML.
    pub fn of(&self, text: &str) -> Result<String, TomlError> {
        let mut file: DocumentMut = text.parse()?;
        for state in &self.initial {
            let table = ["coordinates", "variables"].into_iter().find(|t| file.contains_key(t));
            let Some(all) = table.and_then(|t| file.get_mut(t)?.as_table_like_mut()) else {
                continue;
            };
            let entry = all.entry(&state.name).or_insert(Item::None);
            let entry = table_in(entry, "initial");
            set(entry, "initial", state.value);
            if let Some((key, rate)) = state.rate {
                set(entry, key, rate);
            }
        }
        for (name, number) in &self.parameters {
            let Some(all) = file.get_mut("parameters").and_then(Item::as_table_like_mut) else {
                continue;
            };
            match all.get_mut(name).and_then(Item::as_table_like_mut) {
                Some(table) => set(table, "value", *number),
                None => set(all, name, *number),
            }
        }
        if let (Some(angles), Some(attitude)) =
            (self.attitude, file.get_mut("attitude").and_then(Item::as_table_like_mut))
        {
            attitude
                .insert("start", value(angles.map(|a| a.to_string()).iter().collect::<Array>()));
        }
        let run =
            self.start.map(|start| ("start", start)).into_iter().chain(self.run.iter().copied());
        for (key, number) in run {
            set(run_table(&mut file), key, number);
        }
        if let Some(method) = &self.method {
            run_table(&mut file).insert("method", value(method.as_str()));
        }
        Ok(file.to_string())
    }

    /// Removes the expectations at these ranges; returns `None` if there are none.
    ///
    /// # Errors
    /// Returns an error if the text is not valid TOML.
    pub fn without_expectations(
        text: &str,
        places: &[Range<usize>],
    ) -> Result<Option<String>, TomlError> {
        let at = |span: Option<Range<usize>>| {
            span.is_some_and(|span| places.iter().any(|place| span.contains(&place.start)))
        };
        let parsed = Document::parse(text)?;
        let lists = parsed.get(EXPECT).and_then(Item::as_table_like).map(TableLike::iter);
        let mut wrong: Vec<(String, usize)> = Vec::new();
        for (key, list) in lists.into_iter().flatten() {
            let found = |(index, there): (usize, bool)| there.then(|| (key.to_owned(), index));
            match list {
                Item::Value(Value::Array(list)) => {
                    let there = list.iter().map(|entry| at(entry.span()));
                    wrong.extend(there.enumerate().filter_map(found));
                }
                Item::ArrayOfTables(list) => {
                    let there = list.iter().map(|entry| at(entry.span()));
                    wrong.extend(there.enumerate().filter_map(found));
                }
                _ => {}
            }
        }
        if wrong.is_empty() {
            return Ok(None);
        }
        let mut file: DocumentMut = text.parse()?;
        let Some(expect) = file.get_mut(EXPECT).and_then(Item::as_table_like_mut) else {
            return Ok(None);
        };
        for (key, index) in wrong.iter().rev() {
            let left = match expect.get_mut(key) {
                Some(Item::Value(Value::Array(list))) => {
                    list.remove(*index);
                    list.len()
                }
                Some(Item::ArrayOfTables(list)) => {
                    list.remove(*index);
                    list.len()
                }
                _ => continue,
            };
            if left == 0 {
                expect.remove(key);
            }
        }
        if expect.is_empty() {
            file.remove(EXPECT);
        }
        Ok(Some(file.to_string()))
    }
}

/// A ramp to be written into a file.
#[derive(Clone, Debug, PartialEq)]
pub struct NewRamp {
    /// The one that is to change with the time.
    pub parameter: String,
    /// Its value at the end.
    pub to: f64,
    /// When it begins.
    pub start: f64,
    /// How long it takes.
    pub duration: f64,
    /// The name of its form.
    pub form: &'static str,
}

impl NewRamp {
    /// A text with the ramp behind those that it has, and with the parameter among its observables. What the file claims of a
    /// motion without the ramp is left out.
    ///
    /// # Errors
    /// Returns an error if the text is not valid TOML.
    pub fn added_to(&self, text: &str) -> Result<String, TomlError> {
        let mut file: DocumentMut = text.parse()?;
        let mut ramp = Table::new();
        ramp.insert("parameter", value(self.parameter.as_str()));
        for (key, number) in [("to", self.to), ("start", self.start), ("duration", self.duration)] {
            ramp.insert(key, value(number));
        }
        ramp.insert("form", value(self.form));
        push(&mut file, "ramps", ramp);
        file.remove(EXPECT);
        let mut known = false;
        let name = format!("{} now", self.parameter);
        if let Some(Item::ArrayOfTables(all)) = file.get_mut("observables") {
            for observable in all.iter_mut() {
                observable.remove("conserved");
                known |= observable.get("name").and_then(Item::as_str) == Some(name.as_str());
            }
        }
        if !known {
            let mut observable = Table::new();
            observable.insert("name", value(name));
            observable.insert("expression", value(self.parameter.as_str()));
            push(&mut file, "observables", observable);
        }
        Ok(file.to_string())
    }
}

/// An observable to be added to a text.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct NewObservable {
    /// What it is to be called.
    pub name: String,
    /// What it is.
    pub expression: String,
}

impl NewObservable {
    /// A text with the observable behind those that it has.
    ///
    /// # Errors
    /// Returns an error if the text is not valid TOML.
    pub fn added_to(&self, text: &str) -> Result<String, TomlError> {
        let mut file: DocumentMut = text.parse()?;
        let mut observable = Table::new();
        observable.insert("name", value(self.name.as_str()));
        observable.insert("expression", value(self.expression.as_str()));
        push(&mut file, "observables", observable);
        Ok(file.to_string())
    }

    /// A text with the observable at its end, so that every place in it stays what it is, where that can be; else behind those
    /// that it has, and the text itself if it is not valid TOML.
    pub fn behind(&self, text: &str) -> String {
        let quoted = |words: &str| value(words).to_string();
        let (name, expression) = (quoted(&self.name), quoted(&self.expression));
        let longer =
            format!("{text}\n\n[[observables]]\nname = {name}\nexpression = {expression}\n");
        if longer.parse::<DocumentMut>().is_ok() {
            return longer;
        }
        self.added_to(text).unwrap_or_else(|_| text.to_owned())
    }
}

/// Adds a table to a list of tables, whichever way that is written.
pub(super) fn push(file: &mut DocumentMut, key: &str, table: Table) {
    match file.entry(key).or_insert(Item::ArrayOfTables(ArrayOfTables::new())) {
        Item::Value(Value::Array(list)) => list.push(table.into_inline_table()),
        Item::ArrayOfTables(list) => list.push(table),
        // what is no list is an error, which is reported
        _ => {}
    }
}

const EXPECT: &str = "expect";

/// The table at an entry; a plain value is moved to this key of a new table.
fn table_in<'a>(entry: &'a mut Item, key: &str) -> &'a mut dyn TableLike {
    if !entry.is_table_like() {
        let mut table = InlineTable::new();
        if let Item::Value(old) = std::mem::take(entry) {
            table.insert(key, old);
        }
        *entry = value(table);
    }
    match entry {
        Item::Table(table) => table,
        Item::Value(Value::InlineTable(table)) => table,
        _ => unreachable!("it was made a table"),
    }
}

fn run_table(file: &mut DocumentMut) -> &mut dyn TableLike {
    table_in(file.entry("run").or_insert(Item::Table(Table::new())), "method")
}

/// Sets a number and preserves the whitespace and comments around it.
fn set(table: &mut dyn TableLike, key: &str, number: f64) {
    let decor = table.get(key).and_then(Item::as_value).map(|old| old.decor().clone());
    let mut new = Value::from(number);
    if let Some(decor) = decor {
        *new.decor_mut() = decor;
    }
    table.insert(key, Item::Value(new));
}
