//! What is to be watched and what the file claims of itself, as written.

use toml::Spanned;

use super::table::Table;
use super::{Formula, value};
use crate::diagnostic::{Diagnostics, SourceRange};

/// An observable as written.
pub(in crate::preset) struct DraftObservable {
    pub(in crate::preset) name: Option<Spanned<String>>,
    pub(in crate::preset) expression: Option<Formula>,
    pub(in crate::preset) conserved: Option<Spanned<bool>>,
}

/// The claims as written.
#[derive(Default)]
pub(in crate::preset) struct DraftExpect {
    pub(in crate::preset) conserves: Vec<Spanned<String>>,
    pub(in crate::preset) values: Vec<DraftValue>,
    pub(in crate::preset) events: Vec<DraftOccurrence>,
    pub(in crate::preset) counts: Vec<DraftCount>,
    pub(in crate::preset) brackets: Vec<DraftBracketClaim>,
}

/// When something is to happen, as written.
pub(in crate::preset) struct DraftOccurrence {
    pub(in crate::preset) name: Option<Spanned<String>>,
    pub(in crate::preset) nth: Option<Spanned<f64>>,
    pub(in crate::preset) at: Option<Spanned<f64>>,
    pub(in crate::preset) within: Option<Spanned<f64>>,
    pub(in crate::preset) source: String,
    /// Where it stands.
    pub(in crate::preset) place: SourceRange,
}

/// How often something is to happen, as written.
pub(in crate::preset) struct DraftCount {
    pub(in crate::preset) name: Option<Spanned<String>>,
    pub(in crate::preset) until: Option<Spanned<f64>>,
    pub(in crate::preset) is: Option<Spanned<f64>>,
    pub(in crate::preset) source: String,
    /// Where it stands.
    pub(in crate::preset) place: SourceRange,
}

/// What a bracket is to be, as written.
pub(in crate::preset) struct DraftBracketClaim {
    pub(in crate::preset) f: Option<Formula>,
    pub(in crate::preset) g: Option<Formula>,
    pub(in crate::preset) is: Option<Formula>,
    pub(in crate::preset) source: String,
    /// Where it stands.
    pub(in crate::preset) place: SourceRange,
}

/// A value claimed, as written.
pub(in crate::preset) struct DraftValue {
    pub(in crate::preset) name: String,
    pub(in crate::preset) expression: Option<Formula>,
    pub(in crate::preset) at: Option<Spanned<f64>>,
    pub(in crate::preset) is: Option<Spanned<f64>>,
    pub(in crate::preset) within: Option<Spanned<f64>>,
    pub(in crate::preset) source: String,
    /// Where it stands.
    pub(in crate::preset) place: SourceRange,
}

pub(super) fn observables(top: &mut Table<'_>, mistakes: &mut Diagnostics) -> Vec<DraftObservable> {
    let mut all = Vec::new();
    for mut table in top.tables("observables", "this observable", mistakes) {
        let name = table.require("name", "write name = \"...\"");
        let expression = table.require("expression", "write expression = \"...\"");
        all.push(DraftObservable {
            name: name.and_then(|(_, v)| value::text(v, "`name`", mistakes)),
            expression: expression.and_then(|(_, v)| value::formula(v, "`expression`", mistakes)),
            conserved: table.flag("conserved", mistakes),
        });
        table.finish(mistakes);
    }
    all
}

pub(super) fn expect(top: &mut Table<'_>, mistakes: &mut Diagnostics) -> DraftExpect {
    let Some(mut table) = top.table("expect", mistakes) else { return DraftExpect::default() };
    let conserves = table
        .list("conserves", mistakes)
        .iter()
        .filter_map(|item| value::text(item, "what is conserved", mistakes))
        .collect();
    let mut values = Vec::new();
    for item in table.list("values", mistakes) {
        let shape = "{ expression = \"...\", at = 1.0, is = 2.0 }";
        let entry = Table::of(item, "this expected value", item.span(), shape, mistakes);
        values.extend(entry.map(|entry| expected(entry, mistakes)));
    }
    let events = entries(&mut table, "events", "this expected event", mistakes, occurrence);
    let counts = entries(&mut table, "count", "this expected count", mistakes, count);
    let brackets = entries(&mut table, "brackets", "this expected bracket", mistakes, bracket);
    table.finish(mistakes);
    DraftExpect { conserves, values, events, counts, brackets }
}

/// A list of claims of one kind.
fn entries<T>(
    table: &mut Table<'_>,
    key: &'static str,
    called: &str,
    mistakes: &mut Diagnostics,
    read: fn(Table<'_>, &mut Diagnostics) -> T,
) -> Vec<T> {
    let shape = match key {
        "events" => "{ name = \"...\", at = 1.0 }",
        "count" => "{ name = \"...\", until = 10.0, is = 3 }",
        _ => "{ f = \"...\", g = \"...\", is = \"...\" }",
    };
    let mut all = Vec::new();
    for item in table.list(key, mistakes) {
        let entry = Table::of(item, called, item.span(), shape, mistakes);
        all.extend(entry.map(|entry| read(entry, mistakes)));
    }
    all
}

fn occurrence(mut table: Table<'_>, mistakes: &mut Diagnostics) -> DraftOccurrence {
    let name = table.name(mistakes);
    let at = table.require("at", "give the time: at = 1.0");
    let claim = DraftOccurrence {
        name,
        nth: table.number("nth", mistakes),
        at: at.and_then(|(_, v)| value::number(v, "`at`", mistakes)),
        within: table.number("within", mistakes),
        source: table.line("source", mistakes),
        place: table.place.clone(),
    };
    table.finish(mistakes);
    claim
}

fn count(mut table: Table<'_>, mistakes: &mut Diagnostics) -> DraftCount {
    let name = table.name(mistakes);
    let until = table.require("until", "give the time: until = 10.0");
    let is = table.require("is", "give the number: is = 3");
    let claim = DraftCount {
        name,
        until: until.and_then(|(_, v)| value::number(v, "`until`", mistakes)),
        is: is.and_then(|(_, v)| value::number(v, "`is`", mistakes)),
        source: table.line("source", mistakes),
        place: table.place.clone(),
    };
    table.finish(mistakes);
    claim
}

fn bracket(mut table: Table<'_>, mistakes: &mut Diagnostics) -> DraftBracketClaim {
    let mut side = |key, mistakes: &mut Diagnostics| {
        let (_, found) = table.require(key, &format!("write {key} = \"...\""))?;
        value::formula(found, &format!("`{key}`"), mistakes)
    };
    let (f, g, is) = (side("f", mistakes), side("g", mistakes), side("is", mistakes));
    let source = table.line("source", mistakes);
    let place = table.place.clone();
    table.finish(mistakes);
    DraftBracketClaim { f, g, is, source, place }
}

fn expected(mut table: Table<'_>, mistakes: &mut Diagnostics) -> DraftValue {
    let name = table.line("name", mistakes);
    let expression = table.require("expression", "write expression = \"...\"");
    let at = table.require("at", "give the time: at = 1.0");
    let is = table.require("is", "give the number: is = 2.0");
    let value = DraftValue {
        name,
        expression: expression.and_then(|(_, v)| value::formula(v, "`expression`", mistakes)),
        at: at.and_then(|(_, v)| value::number(v, "`at`", mistakes)),
        is: is.and_then(|(_, v)| value::number(v, "`is`", mistakes)),
        within: table.number("within", mistakes),
        source: table.line("source", mistakes),
        place: table.place.clone(),
    };
    table.finish(mistakes);
    value
}
