//! The constraints, as written.

use toml::Spanned;

use super::Formula;
use super::table::Table;
use crate::diagnostic::SourceRange;

pub(in crate::preset) struct DraftConstraint {
    pub(in crate::preset) name: Option<Spanned<String>>,
    pub(in crate::preset) expression: Option<Formula>,
    pub(in crate::preset) unit: String,
    pub(in crate::preset) about: String,
    pub(in crate::preset) place: SourceRange,
}

pub(super) fn constraints(top: &mut Table<'_>) -> Vec<DraftConstraint> {
    top.each("constraints", "this constraint", |table| DraftConstraint {
        name: table.name(),
        expression: table.formula("expression"),
        unit: table.line("unit"),
        about: table.line("about"),
        place: table.place.clone(),
    })
}
