//! The law of motion, as written.

use toml::Spanned;
use toml::de::DeValue;

use super::system::formulas;
use super::table::Table;
use super::value::Value;
use super::{Formula, NamedFormula, value};
use crate::diagnostic::{Diagnostic, Diagnostics, SourceRange};

pub(in crate::preset) struct DraftMechanics {
    pub(in crate::preset) law: LawTable,
    /// The range of the table's name.
    pub(in crate::preset) place: SourceRange,
    /// L or H.
    pub(in crate::preset) function: Option<Formula>,
    pub(in crate::preset) dissipation: Option<Formula>,
    /// Coordinates and forces.
    pub(in crate::preset) forces: Vec<NamedFormula>,
    pub(in crate::preset) brackets: Vec<DraftBracket>,
    pub(in crate::preset) brackets_place: SourceRange,
    pub(in crate::preset) casimirs: Vec<NamedFormula>,
}

pub(in crate::preset) struct DraftBracket {
    /// The two variables.
    pub(in crate::preset) pair: [Spanned<String>; 2],
    pub(in crate::preset) value: Formula,
    pub(in crate::preset) place: SourceRange,
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub(in crate::preset) enum LawTable {
    Lagrangian,
    Hamiltonian,
    Poisson,
}

impl LawTable {
    pub(in crate::preset) fn table(self) -> &'static str {
        match self {
            LawTable::Lagrangian => "lagrangian",
            LawTable::Hamiltonian => "hamiltonian",
            LawTable::Poisson => "poisson",
        }
    }
}

pub(super) fn mechanics(top: &mut Table<'_>) -> Vec<DraftMechanics> {
    let laws = [LawTable::Lagrangian, LawTable::Hamiltonian, LawTable::Poisson];
    let given = laws.map(|one| law(one, top));
    if !laws.into_iter().any(|law| top.has(law.table())) {
        let missing = Diagnostic::error(0..0, "the file has no law of motion");
        let (key, help) = if top.has("variables") {
            ("poisson", "write [poisson] with H = \"...\" and brackets = [...]")
        } else {
            ("lagrangian", "write [lagrangian] with L = \"...\", or [hamiltonian] with H = \"...\"")
        };
        top.lacks(key, missing.with_help(help));
    }
    given.into_iter().flatten().collect()
}

fn law(law: LawTable, top: &mut Table<'_>) -> Option<DraftMechanics> {
    let mut table = top.table(law.table())?;
    let function = table.formula(if law == LawTable::Lagrangian { "L" } else { "H" });
    let mut dissipation = None;
    if law == LawTable::Lagrangian {
        dissipation = table.formula("dissipation");
    }
    let (mut brackets, mut brackets_place, mut casimirs) = (Vec::new(), 0..0, Vec::new());
    if law == LawTable::Poisson {
        if let Some((_, found)) = table.take("brackets") {
            brackets_place = found.span();
            let items = value::list(found, "`brackets`", top.diagnostics);
            brackets = items
                .map_or(&[][..], |items| items)
                .iter()
                .filter_map(|item| bracket(item, top.diagnostics))
                .collect();
        }
        casimirs = named(&mut table, "casimirs", "C", "the Casimir");
    }
    let forces = named(&mut table, "forces", "x", "the force on");
    let place = table.place.clone();
    table.finish();
    Some(DraftMechanics {
        law,
        place,
        function,
        dissipation,
        forces,
        brackets,
        brackets_place,
        casimirs,
    })
}

/// A table of names and expressions, at its own key.
fn named(
    table: &mut Table<'_>,
    key: &'static str,
    example: &str,
    called: &str,
) -> Vec<NamedFormula> {
    let Some((place, found)) = table.take(key) else { return Vec::new() };
    let shape = format!("{key} = {{ {example} = \"...\" }}");
    let table = Table::of(found, format!("`{key}`"), place, &shape, table.diagnostics);
    table.map_or(Vec::new(), |t| formulas(&t, called))
}

/// `["a", "b", "{a, b}"]`.
fn bracket(found: &Value<'_>, diagnostics: &Diagnostics) -> Option<DraftBracket> {
    let items = match found.get_ref() {
        DeValue::Array(items) if items.len() == 3 => items,
        other => {
            let is = match other {
                DeValue::Array(items) => format!("a list of {}", items.len()),
                other => value::kind(other).to_owned(),
            };
            let message = format!("a bracket must be a list of three, not {is}");
            let help = "two variables and their bracket: [\"a\", \"b\", \"{a, b}\"]";
            diagnostics.push(Diagnostic::error(found.span(), message).with_help(help));
            return None;
        }
    };
    let name = |item: &Value<'_>| value::text(item, "a variable of a bracket", diagnostics);
    let (first, second) = (name(&items[0]), name(&items[1]));
    let value = value::formula(&items[2], "a bracket", diagnostics);
    Some(DraftBracket { pair: [first?, second?], value: value?, place: found.span() })
}
