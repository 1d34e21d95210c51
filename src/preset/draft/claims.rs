//! The observables and the file's claims, as written.

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
    pub(in crate::preset) steps: Vec<DraftStep>,
    pub(in crate::preset) invariants: Option<Spanned<f64>>,
    pub(in crate::preset) degree: Option<Spanned<f64>>,
}

/// The time of an expected occurrence, as written.
pub(in crate::preset) struct DraftOccurrence {
    pub(in crate::preset) name: Option<Spanned<String>>,
    pub(in crate::preset) nth: Option<Spanned<f64>>,
    pub(in crate::preset) at: Option<Spanned<f64>>,
    pub(in crate::preset) within: Option<Spanned<f64>>,
    pub(in crate::preset) source: String,
    /// The range of the entry.
    pub(in crate::preset) place: SourceRange,
}

/// An expected number of occurrences, as written.
pub(in crate::preset) struct DraftCount {
    pub(in crate::preset) name: Option<Spanned<String>>,
    pub(in crate::preset) until: Option<Spanned<f64>>,
    pub(in crate::preset) is: Option<Spanned<f64>>,
    pub(in crate::preset) source: String,
    /// The range of the entry.
    pub(in crate::preset) place: SourceRange,
}

/// The expected value of a bracket, as written.
pub(in crate::preset) struct DraftBracketClaim {
    pub(in crate::preset) f: Option<Formula>,
    pub(in crate::preset) g: Option<Formula>,
    pub(in crate::preset) is: Option<Formula>,
    pub(in crate::preset) source: String,
    /// The range of the entry.
    pub(in crate::preset) place: SourceRange,
}

/// A transformation that is expected to be a step of a method, as written.
pub(in crate::preset) struct DraftStep {
    pub(in crate::preset) transformation: Option<Spanned<String>>,
    pub(in crate::preset) method: Option<Spanned<String>>,
    pub(in crate::preset) step: Option<Formula>,
    pub(in crate::preset) within: Option<Spanned<f64>>,
    pub(in crate::preset) source: String,
    /// The range of the entry.
    pub(in crate::preset) place: SourceRange,
}

/// An expected value, as written.
pub(in crate::preset) struct DraftValue {
    pub(in crate::preset) name: String,
    pub(in crate::preset) expression: Option<Formula>,
    pub(in crate::preset) at: Option<Spanned<f64>>,
    pub(in crate::preset) is: Option<Spanned<f64>>,
    pub(in crate::preset) within: Option<Spanned<f64>>,
    pub(in crate::preset) source: String,
    /// The range of the entry.
    pub(in crate::preset) place: SourceRange,
}

pub(super) fn observables(top: &mut Table<'_>, mistakes: &mut Diagnostics) -> Vec<DraftObservable> {
    let mut all = Vec::new();
    for mut table in top.tables("observables", "this observable", mistakes) {
        all.push(DraftObservable {
            name: table.text("name", mistakes),
            expression: table.formula("expression", mistakes),
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
    let (value, event) =
        ("{ expression = \"...\", at = 1.0, is = 2.0 }", "{ name = \"...\", at = 1.0 }");
    let count = "{ name = \"...\", until = 10.0, is = 3 }";
    let bracket = "{ f = \"...\", g = \"...\", is = \"...\" }";
    let values = table.items("values", ("this expected value", value), mistakes);
    let events = table.items("events", ("this expected event", event), mistakes);
    let counts = table.items("count", ("this expected count", count), mistakes);
    let brackets = table.items("brackets", ("this expected bracket", bracket), mistakes);
    let step = "{ transformation = \"...\", method = \"symplectic-euler\", step = \"h\" }";
    let steps = table.items("steps", ("this expected step", step), mistakes);
    let invariants = table.number("invariants", mistakes);
    let degree = table.number("degree", mistakes);
    table.finish(mistakes);
    DraftExpect {
        conserves,
        values: values.into_iter().map(|entry| expected(entry, mistakes)).collect(),
        events: events.into_iter().map(|entry| occurrence(entry, mistakes)).collect(),
        counts: counts.into_iter().map(|entry| self::count(entry, mistakes)).collect(),
        brackets: brackets.into_iter().map(|entry| self::bracket(entry, mistakes)).collect(),
        steps: steps.into_iter().map(|entry| self::step(entry, mistakes)).collect(),
        invariants,
        degree,
    }
}

fn step(mut table: Table<'_>, mistakes: &mut Diagnostics) -> DraftStep {
    let claim = DraftStep {
        transformation: table.text("transformation", mistakes),
        method: table.text("method", mistakes),
        step: table.formula("step", mistakes),
        within: table.number("within", mistakes),
        source: table.line("source", mistakes),
        place: table.place.clone(),
    };
    table.finish(mistakes);
    claim
}

fn occurrence(mut table: Table<'_>, mistakes: &mut Diagnostics) -> DraftOccurrence {
    let name = table.name(mistakes);
    let claim = DraftOccurrence {
        name,
        nth: table.number("nth", mistakes),
        at: table.number("at", mistakes),
        within: table.number("within", mistakes),
        source: table.line("source", mistakes),
        place: table.place.clone(),
    };
    table.finish(mistakes);
    claim
}

fn count(mut table: Table<'_>, mistakes: &mut Diagnostics) -> DraftCount {
    let name = table.name(mistakes);
    let claim = DraftCount {
        name,
        until: table.number("until", mistakes),
        is: table.number("is", mistakes),
        source: table.line("source", mistakes),
        place: table.place.clone(),
    };
    table.finish(mistakes);
    claim
}

fn bracket(mut table: Table<'_>, mistakes: &mut Diagnostics) -> DraftBracketClaim {
    let [f, g, is] = ["f", "g", "is"].map(|key| table.formula(key, mistakes));
    let source = table.line("source", mistakes);
    let place = table.place.clone();
    table.finish(mistakes);
    DraftBracketClaim { f, g, is, source, place }
}

fn expected(mut table: Table<'_>, mistakes: &mut Diagnostics) -> DraftValue {
    let name = table.line("name", mistakes);
    let value = DraftValue {
        name,
        expression: table.formula("expression", mistakes),
        at: table.number("at", mistakes),
        is: table.number("is", mistakes),
        within: table.number("within", mistakes),
        source: table.line("source", mistakes),
        place: table.place.clone(),
    };
    table.finish(mistakes);
    value
}
