//! What is to be watched and what the file claims of itself, as written.

use toml::Spanned;

use super::table::Table;
use super::{Formula, Mistakes, Place, value};

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
    pub(in crate::preset) place: Place,
}

pub(super) fn observables(top: &mut Table<'_>, mistakes: &mut Mistakes) -> Vec<DraftObservable> {
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

pub(super) fn expect(top: &mut Table<'_>, mistakes: &mut Mistakes) -> DraftExpect {
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
    table.finish(mistakes);
    DraftExpect { conserves, values }
}

fn expected(mut table: Table<'_>, mistakes: &mut Mistakes) -> DraftValue {
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
