//! Impulses and events, as written.

use toml::Spanned;
use toml::de::DeValue;

use super::system::formulas;
use super::table::Table;
use super::{Formula, NamedFormula, value};
use crate::diagnostic::{Diagnostic, SourceRange};

pub(in crate::preset) struct DraftImpulse {
    pub(in crate::preset) name: Option<Spanned<String>>,
    pub(in crate::preset) at: Vec<Formula>,
    pub(in crate::preset) every: Option<Formula>,
    /// The jumps by name; `None` if they could not be read.
    pub(in crate::preset) change: Option<Vec<NamedFormula>>,
    pub(in crate::preset) about: String,
    pub(in crate::preset) place: SourceRange,
}

pub(in crate::preset) struct DraftEvent {
    pub(in crate::preset) name: Option<Spanned<String>>,
    pub(in crate::preset) when: Option<Formula>,
    pub(in crate::preset) direction: Option<Spanned<String>>,
    pub(in crate::preset) action: Option<Spanned<String>>,
    pub(in crate::preset) place: SourceRange,
}

pub(super) fn impulses(top: &mut Table<'_>) -> Vec<DraftImpulse> {
    top.each("impulses", "this impulse", impulse)
}

fn impulse(table: &mut Table<'_>) -> DraftImpulse {
    let name = table.name();
    let at = table.take("at");
    let every = table.take("every");
    if let (Some((at, _)), Some((every, _))) = (&at, &every) {
        let diagnostic = Diagnostic::error(every.clone(), "`at` and `every` exclude each other");
        let diagnostic = diagnostic.with_also(at.clone(), "the times are given here");
        table.diagnostics.push(diagnostic.with_help("write two impulses"));
    }
    let at = at.map_or(Vec::new(), |(_, found)| match found.get_ref() {
        DeValue::Array(items) => {
            if items.is_empty() {
                table.diagnostics.push(Diagnostic::error(found.span(), "this list is empty"));
            }
            items
                .iter()
                .filter_map(|v| value::formula(v, "a time in `at`", table.diagnostics))
                .collect()
        }
        _ => value::formula(found, "`at`", table.diagnostics).into_iter().collect(),
    });
    let every = every.and_then(|(_, found)| value::formula(found, "`every`", table.diagnostics));
    let change = table.take("change");
    let change = change.and_then(|(place, found)| {
        let shape = "change = { p_x = \"...\" }";
        let changes = Table::of(found, "`change`", place, shape, table.diagnostics)?;
        if changes.entries().next().is_none() {
            let diagnostic = Diagnostic::error(found.span(), "this impulse changes nothing");
            table.diagnostics.push(diagnostic.with_help(format!("write {shape}")));
        }
        Some(formulas(&changes, "the change of"))
    });
    let about = table.line("about");
    DraftImpulse { name, at, every, change, about, place: table.place.clone() }
}

pub(super) fn events(top: &mut Table<'_>) -> Vec<DraftEvent> {
    top.each("events", "this event", |table| DraftEvent {
        name: table.name(),
        when: table.formula("when"),
        direction: table.text("direction"),
        action: table.text("action"),
        place: table.place.clone(),
    })
}
