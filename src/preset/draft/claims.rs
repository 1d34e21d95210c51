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
    pub(in crate::preset) unit: String,
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

pub(super) fn observables(
    top: &mut Table<'_>,
    diagnostics: &mut Diagnostics,
) -> Vec<DraftObservable> {
    let mut all = Vec::new();
    for mut table in top.tables("observables", "this observable", diagnostics) {
        all.push(DraftObservable {
            name: table.text("name", diagnostics),
            expression: table.formula("expression", diagnostics),
            conserved: table.flag("conserved", diagnostics),
            unit: table.line("unit", diagnostics),
        });
        table.finish(diagnostics);
    }
    all
}

pub(super) fn expect(top: &mut Table<'_>, diagnostics: &mut Diagnostics) -> DraftExpect {
    let Some(mut table) = top.table("expect", diagnostics) else { return DraftExpect::default() };
    let conserves = table
        .list("conserves", diagnostics)
        .iter()
        .filter_map(|item| value::text(item, "what is conserved", diagnostics))
        .collect();
    let (value, event) =
        ("{ expression = \"...\", at = 1.0, is = 2.0 }", "{ name = \"...\", at = 1.0 }");
    let count = "{ name = \"...\", until = 10.0, is = 3 }";
    let bracket = "{ f = \"...\", g = \"...\", is = \"...\" }";
    let values = table.items("values", ("this expected value", value), diagnostics);
    let events = table.items("events", ("this expected event", event), diagnostics);
    let counts = table.items("count", ("this expected count", count), diagnostics);
    let brackets = table.items("brackets", ("this expected bracket", bracket), diagnostics);
    let step = "{ transformation = \"...\", method = \"symplectic-euler\", step = \"h\" }";
    let steps = table.items("steps", ("this expected step", step), diagnostics);
    let invariants = table.number("invariants", diagnostics);
    let degree = table.number("degree", diagnostics);
    table.finish(diagnostics);
    DraftExpect {
        conserves,
        values: values.into_iter().map(|entry| expected(entry, diagnostics)).collect(),
        events: events.into_iter().map(|entry| occurrence(entry, diagnostics)).collect(),
        counts: counts.into_iter().map(|entry| self::count(entry, diagnostics)).collect(),
        brackets: brackets.into_iter().map(|entry| self::bracket(entry, diagnostics)).collect(),
        steps: steps.into_iter().map(|entry| self::step(entry, diagnostics)).collect(),
        invariants,
        degree,
    }
}

fn step(mut table: Table<'_>, diagnostics: &mut Diagnostics) -> DraftStep {
    let claim = DraftStep {
        transformation: table.text("transformation", diagnostics),
        method: table.text("method", diagnostics),
        step: table.formula("step", diagnostics),
        within: table.number("within", diagnostics),
        source: table.line("source", diagnostics),
        place: table.place.clone(),
    };
    table.finish(diagnostics);
    claim
}

fn occurrence(mut table: Table<'_>, diagnostics: &mut Diagnostics) -> DraftOccurrence {
    let name = table.name(diagnostics);
    let claim = DraftOccurrence {
        name,
        nth: table.number("nth", diagnostics),
        at: table.number("at", diagnostics),
        within: table.number("within", diagnostics),
        source: table.line("source", diagnostics),
        place: table.place.clone(),
    };
    table.finish(diagnostics);
    claim
}

fn count(mut table: Table<'_>, diagnostics: &mut Diagnostics) -> DraftCount {
    let name = table.name(diagnostics);
    let claim = DraftCount {
        name,
        until: table.number("until", diagnostics),
        is: table.number("is", diagnostics),
        source: table.line("source", diagnostics),
        place: table.place.clone(),
    };
    table.finish(diagnostics);
    claim
}

fn bracket(mut table: Table<'_>, diagnostics: &mut Diagnostics) -> DraftBracketClaim {
    let [f, g, is] = ["f", "g", "is"].map(|key| table.formula(key, diagnostics));
    let source = table.line("source", diagnostics);
    let place = table.place.clone();
    table.finish(diagnostics);
    DraftBracketClaim { f, g, is, source, place }
}

fn expected(mut table: Table<'_>, diagnostics: &mut Diagnostics) -> DraftValue {
    let name = table.line("name", diagnostics);
    let value = DraftValue {
        name,
        expression: table.formula("expression", diagnostics),
        at: table.number("at", diagnostics),
        is: table.number("is", diagnostics),
        within: table.number("within", diagnostics),
        source: table.line("source", diagnostics),
        place: table.place.clone(),
    };
    table.finish(diagnostics);
    value
}
