//! Transformations, generators and a complete integral, as written.

use toml::Spanned;

use super::system::formulas;
use super::table::Table;
use super::{Formula, NamedFormula, value};
use crate::diagnostic::SourceRange;

pub(in crate::preset) struct DraftTransformation {
    pub(in crate::preset) name: Option<Spanned<String>>,
    pub(in crate::preset) kind: Option<Spanned<String>>,
    pub(in crate::preset) types: Vec<Spanned<String>>,
    /// The transformations it is made of.
    pub(in crate::preset) of: Vec<Spanned<String>>,
    pub(in crate::preset) function: Option<Formula>,
    pub(in crate::preset) positions: Option<Vec<NamedFormula>>,
    pub(in crate::preset) momenta: Option<Vec<NamedFormula>>,
    pub(in crate::preset) new: Vec<Spanned<String>>,
    /// The name of its largest entry of |M 𝕁 Mᵀ − 𝕁|.
    pub(in crate::preset) residual: Option<Spanned<String>>,
    pub(in crate::preset) place: SourceRange,
}

pub(in crate::preset) struct DraftGenerator {
    pub(in crate::preset) name: Option<Spanned<String>>,
    pub(in crate::preset) function: Option<Formula>,
    pub(in crate::preset) place: SourceRange,
}

pub(in crate::preset) struct DraftIntegral {
    pub(in crate::preset) function: Option<Formula>,
    pub(in crate::preset) constants: Vec<Spanned<String>>,
    pub(in crate::preset) place: SourceRange,
}

pub(super) fn transformations(top: &mut Table<'_>) -> Vec<DraftTransformation> {
    top.each("transformations", "this transformation", |table| DraftTransformation {
        name: table.name(),
        kind: table.text("kind"),
        types: names(table, "types", "a type"),
        of: names(table, "of", "a transformation"),
        function: table.formula("F"),
        positions: named(table, "Q"),
        momenta: named(table, "P"),
        new: names(table, "new", "a new variable"),
        residual: table.text("residual"),
        place: table.place.clone(),
    })
}

/// A list of texts.
fn names(table: &mut Table<'_>, key: &'static str, called: &str) -> Vec<Spanned<String>> {
    let items = table.list(key).iter();
    items.filter_map(|item| value::text(item, called, table.diagnostics)).collect()
}

/// A table of new variables with their expressions.
fn named(table: &mut Table<'_>, key: &'static str) -> Option<Vec<NamedFormula>> {
    let (place, found) = table.take(key)?;
    let shape = format!("{key} = {{ {key} = \"...\" }}");
    let inner = Table::of(found, format!("`{key}`"), place, &shape, table.diagnostics)?;
    Some(formulas(&inner, "the new variable"))
}

pub(super) fn generators(top: &mut Table<'_>) -> Vec<DraftGenerator> {
    top.each("generators", "this generator", |table| DraftGenerator {
        name: table.name(),
        function: table.formula("G"),
        place: table.place.clone(),
    })
}

pub(super) fn integral(top: &mut Table<'_>) -> Option<DraftIntegral> {
    let table = top.table("hamilton_jacobi")?;
    Some(table.read(|table| DraftIntegral {
        function: table.formula("S"),
        constants: names(table, "constants", "a constant"),
        place: table.place.clone(),
    }))
}
