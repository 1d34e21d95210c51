//! The names of equilibria, as written.

use toml::Spanned;

use super::NamedFormula;
use super::system::formulas;
use super::table::Table;
use crate::diagnostic::{Diagnostic, SourceRange};

pub(in crate::preset) struct DraftEquilibrium {
    pub(in crate::preset) name: Option<Spanned<String>>,
    pub(in crate::preset) near: Vec<NamedFormula>,
    pub(in crate::preset) place: SourceRange,
}

pub(super) fn equilibria(top: &mut Table<'_>) -> Vec<DraftEquilibrium> {
    top.each("equilibria", "this equilibrium", |table| {
        let name = table.name();
        let mut near = Vec::new();
        if let Some((place, found)) = table.take("near") {
            let shape = "near = { x = \"...\" }";
            let inner = Table::of(found, "`near`".to_owned(), place, shape, table.diagnostics);
            near = inner.map_or(near, |inner| {
                let all = formulas(&inner, "the coordinate");
                if all.is_empty() {
                    let message = "`near` has no coordinate, so this may be any equilibrium";
                    let error = Diagnostic::error(inner.place.clone(), message);
                    table.diagnostics.push(error.with_help(format!("write {shape}")));
                }
                all
            });
        }
        DraftEquilibrium { name, near, place: table.place.clone() }
    })
}
