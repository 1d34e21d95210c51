//! The observables and the file's claims, as written.

use toml::Spanned;

use super::table::Table;
use super::{Formula, value};
use crate::diagnostic::SourceRange;

pub(in crate::preset) struct DraftObservable {
    pub(in crate::preset) name: Option<Spanned<String>>,
    pub(in crate::preset) expression: Option<Formula>,
    pub(in crate::preset) conserved: Option<Spanned<bool>>,
    pub(in crate::preset) unit: String,
}

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

pub(in crate::preset) struct DraftOccurrence {
    pub(in crate::preset) name: Option<Spanned<String>>,
    pub(in crate::preset) nth: Option<Spanned<f64>>,
    pub(in crate::preset) at: Option<Spanned<f64>>,
    pub(in crate::preset) within: Option<Spanned<f64>>,
    pub(in crate::preset) source: String,
    pub(in crate::preset) place: SourceRange,
}

/// An expected number of occurrences, as written.
pub(in crate::preset) struct DraftCount {
    pub(in crate::preset) name: Option<Spanned<String>>,
    pub(in crate::preset) until: Option<Spanned<f64>>,
    pub(in crate::preset) is: Option<Spanned<f64>>,
    pub(in crate::preset) source: String,
    pub(in crate::preset) place: SourceRange,
}

pub(in crate::preset) struct DraftBracketClaim {
    pub(in crate::preset) f: Option<Formula>,
    pub(in crate::preset) g: Option<Formula>,
    pub(in crate::preset) is: Option<Formula>,
    pub(in crate::preset) source: String,
    pub(in crate::preset) place: SourceRange,
}

/// A transformation that is expected to be a step of a method, as written.
pub(in crate::preset) struct DraftStep {
    pub(in crate::preset) transformation: Option<Spanned<String>>,
    pub(in crate::preset) method: Option<Spanned<String>>,
    pub(in crate::preset) step: Option<Formula>,
    pub(in crate::preset) within: Option<Spanned<f64>>,
    pub(in crate::preset) source: String,
    pub(in crate::preset) place: SourceRange,
}

pub(in crate::preset) struct DraftValue {
    pub(in crate::preset) name: String,
    pub(in crate::preset) expression: Option<Formula>,
    pub(in crate::preset) at: Option<Spanned<f64>>,
    pub(in crate::preset) is: Option<Spanned<f64>>,
    pub(in crate::preset) within: Option<Spanned<f64>>,
    pub(in crate::preset) source: String,
    pub(in crate::preset) place: SourceRange,
}

pub(super) fn observables(top: &mut Table<'_>) -> Vec<DraftObservable> {
    let mut all = Vec::new();
    for mut table in top.tables("observables", "this observable") {
        all.push(DraftObservable {
            name: table.text("name"),
            expression: table.formula("expression"),
            conserved: table.flag("conserved"),
            unit: table.line("unit"),
        });
        table.finish();
    }
    all
}

pub(super) fn expect(top: &mut Table<'_>) -> DraftExpect {
    let Some(mut table) = top.table("expect") else { return DraftExpect::default() };
    let conserves = table
        .list("conserves")
        .iter()
        .filter_map(|item| value::text(item, "what is conserved", top.diagnostics))
        .collect();
    let (value, event) =
        ("{ expression = \"...\", at = 1.0, is = 2.0 }", "{ name = \"...\", at = 1.0 }");
    let count = "{ name = \"...\", until = 10.0, is = 3 }";
    let bracket = "{ f = \"...\", g = \"...\", is = \"...\" }";
    let values = table.items("values", ("this expected value", value));
    let events = table.items("events", ("this expected event", event));
    let counts = table.items("count", ("this expected count", count));
    let brackets = table.items("brackets", ("this expected bracket", bracket));
    let step = "{ transformation = \"...\", method = \"symplectic-euler\", step = \"h\" }";
    let steps = table.items("steps", ("this expected step", step));
    let invariants = table.number("invariants");
    let degree = table.number("degree");
    table.finish();
    DraftExpect {
        conserves,
        values: values.into_iter().map(expected).collect(),
        events: events.into_iter().map(occurrence).collect(),
        counts: counts.into_iter().map(self::count).collect(),
        brackets: brackets.into_iter().map(self::bracket).collect(),
        steps: steps.into_iter().map(self::step).collect(),
        invariants,
        degree,
    }
}

fn step(mut table: Table<'_>) -> DraftStep {
    let claim = DraftStep {
        transformation: table.text("transformation"),
        method: table.text("method"),
        step: table.formula("step"),
        within: table.number("within"),
        source: table.line("source"),
        place: table.place.clone(),
    };
    table.finish();
    claim
}

fn occurrence(mut table: Table<'_>) -> DraftOccurrence {
    let name = table.name();
    let claim = DraftOccurrence {
        name,
        nth: table.number("nth"),
        at: table.number("at"),
        within: table.number("within"),
        source: table.line("source"),
        place: table.place.clone(),
    };
    table.finish();
    claim
}

fn count(mut table: Table<'_>) -> DraftCount {
    let name = table.name();
    let claim = DraftCount {
        name,
        until: table.number("until"),
        is: table.number("is"),
        source: table.line("source"),
        place: table.place.clone(),
    };
    table.finish();
    claim
}

fn bracket(mut table: Table<'_>) -> DraftBracketClaim {
    let [f, g, is] = ["f", "g", "is"].map(|key| table.formula(key));
    let source = table.line("source");
    let place = table.place.clone();
    table.finish();
    DraftBracketClaim { f, g, is, source, place }
}

fn expected(mut table: Table<'_>) -> DraftValue {
    let name = table.line("name");
    let value = DraftValue {
        name,
        expression: table.formula("expression"),
        at: table.number("at"),
        is: table.number("is"),
        within: table.number("within"),
        source: table.line("source"),
        place: table.place.clone(),
    };
    table.finish();
    value
}
