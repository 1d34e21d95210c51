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
    top.each("observables", "this observable", |table| DraftObservable {
        name: table.text("name"),
        expression: table.formula("expression"),
        conserved: table.flag("conserved"),
        unit: table.line("unit"),
    })
}

pub(super) fn expect(top: &mut Table<'_>) -> DraftExpect {
    let Some(table) = top.table("expect") else { return DraftExpect::default() };
    table.read(|table| DraftExpect {
        conserves: table
            .list("conserves")
            .iter()
            .filter_map(|item| value::text(item, "what is conserved", table.diagnostics))
            .collect(),
        values: table.items(
            "values",
            ("this expected value", "{ expression = \"...\", at = 1.0, is = 2.0 }"),
            expected,
        ),
        events: table.items(
            "events",
            ("this expected event", "{ name = \"...\", at = 1.0 }"),
            occurrence,
        ),
        counts: table.items(
            "count",
            ("this expected count", "{ name = \"...\", until = 10.0, is = 3 }"),
            count,
        ),
        brackets: table.items(
            "brackets",
            ("this expected bracket", "{ f = \"...\", g = \"...\", is = \"...\" }"),
            bracket,
        ),
        steps: table.items(
            "steps",
            (
                "this expected step",
                "{ transformation = \"...\", method = \"symplectic-euler\", step = \"h\" }",
            ),
            step,
        ),
        invariants: table.number("invariants"),
        degree: table.number("degree"),
    })
}

fn step(table: &mut Table<'_>) -> DraftStep {
    DraftStep {
        transformation: table.text("transformation"),
        method: table.text("method"),
        step: table.formula("step"),
        within: table.number("within"),
        source: table.line("source"),
        place: table.place.clone(),
    }
}

fn occurrence(table: &mut Table<'_>) -> DraftOccurrence {
    DraftOccurrence {
        name: table.name(),
        nth: table.number("nth"),
        at: table.number("at"),
        within: table.number("within"),
        source: table.line("source"),
        place: table.place.clone(),
    }
}

fn count(table: &mut Table<'_>) -> DraftCount {
    DraftCount {
        name: table.name(),
        until: table.number("until"),
        is: table.number("is"),
        source: table.line("source"),
        place: table.place.clone(),
    }
}

fn bracket(table: &mut Table<'_>) -> DraftBracketClaim {
    DraftBracketClaim {
        f: table.formula("f"),
        g: table.formula("g"),
        is: table.formula("is"),
        source: table.line("source"),
        place: table.place.clone(),
    }
}

fn expected(table: &mut Table<'_>) -> DraftValue {
    DraftValue {
        name: table.line("name"),
        expression: table.formula("expression"),
        at: table.number("at"),
        is: table.number("is"),
        within: table.number("within"),
        source: table.line("source"),
        place: table.place.clone(),
    }
}
