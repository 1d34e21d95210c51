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
    /// The name of its largest entry of |M 𝕁 Mᵀ − 𝕁|.
    pub(in crate::preset) residual: Option<Spanned<String>>,
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
    /// The range of the table.
    pub(in crate::preset) place: SourceRange,
}

pub(super) fn transformations(
    top: &mut Table<'_>,
    diagnostics: &mut Diagnostics,
) -> Vec<DraftTransformation> {
    let tables = top.tables("transformations", "this transformation", diagnostics);
    tables.into_iter().map(|table| transformation(table, diagnostics)).collect()
}

fn transformation(mut table: Table<'_>, diagnostics: &mut Diagnostics) -> DraftTransformation {
    let name = table.name(diagnostics);
    let kind = table.text("kind", diagnostics);
    let types = names(&mut table, "types", "a type", diagnostics);
    let of = names(&mut table, "of", "a transformation", diagnostics);
    let function = table.formula("F", diagnostics);
    let [positions, momenta] = ["Q", "P"].map(|key| named(&mut table, key, diagnostics));
    let new = names(&mut table, "new", "a new variable", diagnostics);
    let residual = table.text("residual", diagnostics);
    let place = table.place.clone();
    table.finish(diagnostics);
    DraftTransformation {
        name,
        kind,
        types,
        of,
        function,
        positions,
        momenta,
        new,
        residual,
        place,
    }
}

/// A list of texts.
fn names(
    table: &mut Table<'_>,
    key: &'static str,
    called: &str,
    diagnostics: &mut Diagnostics,
) -> Vec<Spanned<String>> {
    let items = table.list(key, diagnostics).iter();
    items.filter_map(|item| value::text(item, called, diagnostics)).collect()
}

/// A table of new variables with their expressions.
fn named(
    table: &mut Table<'_>,
    key: &'static str,
    diagnostics: &mut Diagnostics,
) -> Option<Vec<NamedFormula>> {
    let (place, found) = table.take(key)?;
    let shape = format!("{key} = {{ {key} = \"...\" }}");
    let inner = Table::of(found, format!("`{key}`"), place, &shape, diagnostics)?;
    Some(formulas(&inner, "the new variable", diagnostics))
}

pub(super) fn generators(
    top: &mut Table<'_>,
    diagnostics: &mut Diagnostics,
) -> Vec<DraftGenerator> {
    let mut all = Vec::new();
    for mut table in top.tables("generators", "this generator", diagnostics) {
        all.push(DraftGenerator {
            name: table.name(diagnostics),
            function: table.formula("G", diagnostics),
            place: table.place.clone(),
        });
        table.finish(diagnostics);
    }
    all
}

pub(super) fn integral(
    top: &mut Table<'_>,
    diagnostics: &mut Diagnostics,
) -> Option<DraftIntegral> {
    let mut table = top.table("hamilton_jacobi", diagnostics)?;
    let function = table.formula("S", diagnostics);
    let constants = names(&mut table, "constants", "a constant", diagnostics);
    let place = table.place.clone();
    table.finish(diagnostics);
    Some(DraftIntegral { function, constants, place })
}
