//! Transformations, generators and a complete integral, as written.

use toml::Spanned;

use super::system::formulas;
use super::table::Table;
use super::{Formula, NamedFormula, value};
use crate::diagnostic::{Diagnostics, SourceRange};

/// A transformation as written.
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
    /// The range of the entry.
    pub(in crate::preset) place: SourceRange,
}

/// A generator as written.
pub(in crate::preset) struct DraftGenerator {
    pub(in crate::preset) name: Option<Spanned<String>>,
    pub(in crate::preset) function: Option<Formula>,
    /// The range of the entry.
    pub(in crate::preset) place: SourceRange,
}

/// A complete integral as written.
pub(in crate::preset) struct DraftIntegral {
    pub(in crate::preset) function: Option<Formula>,
    pub(in crate::preset) constants: Vec<Spanned<String>>,
}

pub(super) fn transformations(
    top: &mut Table<'_>,
    mistakes: &mut Diagnostics,
) -> Vec<DraftTransformation> {
    let tables = top.tables("transformations", "this transformation", mistakes);
    tables.into_iter().map(|table| transformation(table, mistakes)).collect()
}

fn transformation(mut table: Table<'_>, mistakes: &mut Diagnostics) -> DraftTransformation {
    let name = table.name(mistakes);
    let kind = table.text("kind", mistakes);
    let types = names(&mut table, "types", "a type", mistakes);
    let of = names(&mut table, "of", "a transformation", mistakes);
    let function = table.formula("F", mistakes);
    let [positions, momenta] = ["Q", "P"].map(|key| named(&mut table, key, mistakes));
    let new = names(&mut table, "new", "a new variable", mistakes);
    let place = table.place.clone();
    table.finish(mistakes);
    DraftTransformation { name, kind, types, of, function, positions, momenta, new, place }
}

/// A list of texts.
fn names(
    table: &mut Table<'_>,
    key: &'static str,
    called: &str,
    mistakes: &mut Diagnostics,
) -> Vec<Spanned<String>> {
    let items = table.list(key, mistakes).iter();
    items.filter_map(|item| value::text(item, called, mistakes)).collect()
}

/// A table of new variables with their expressions.
fn named(
    table: &mut Table<'_>,
    key: &'static str,
    mistakes: &mut Diagnostics,
) -> Option<Vec<NamedFormula>> {
    let (place, found) = table.take(key)?;
    let shape = format!("{key} = {{ {key} = \"...\" }}");
    let inner = Table::of(found, format!("`{key}`"), place, &shape, mistakes)?;
    Some(formulas(&inner, "the new variable", mistakes))
}

pub(super) fn generators(top: &mut Table<'_>, mistakes: &mut Diagnostics) -> Vec<DraftGenerator> {
    let mut all = Vec::new();
    for mut table in top.tables("generators", "this generator", mistakes) {
        all.push(DraftGenerator {
            name: table.name(mistakes),
            function: table.formula("G", mistakes),
            place: table.place.clone(),
        });
        table.finish(mistakes);
    }
    all
}

pub(super) fn integral(top: &mut Table<'_>, mistakes: &mut Diagnostics) -> Option<DraftIntegral> {
    let mut table = top.table("hamilton_jacobi", mistakes)?;
    let function = table.formula("S", mistakes);
    let constants = names(&mut table, "constants", "a constant", mistakes);
    table.finish(mistakes);
    Some(DraftIntegral { function, constants })
}
