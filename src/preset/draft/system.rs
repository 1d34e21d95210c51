//! Coordinates, parameters, definitions and the law of motion, as written.

use toml::Spanned;
use toml::de::DeValue;

use super::table::{Table, Value};
use super::{Formula, Mistake, Mistakes, Place, value};

/// A name with its expression, if there is one that can be read.
pub(in crate::preset) type NamedFormula = (Spanned<String>, Option<Formula>);

/// A coordinate as written.
pub(in crate::preset) struct DraftCoordinate {
    pub(in crate::preset) name: Spanned<String>,
    pub(in crate::preset) symbol: String,
    pub(in crate::preset) unit: String,
    pub(in crate::preset) initial: Option<Formula>,
    /// The key's place and the value.
    pub(in crate::preset) velocity: Option<(Place, Formula)>,
    /// The key's place and the value.
    pub(in crate::preset) momentum: Option<(Place, Formula)>,
    pub(in crate::preset) period: Option<Formula>,
}

/// A parameter as written.
pub(in crate::preset) struct DraftParameter {
    pub(in crate::preset) name: Spanned<String>,
    pub(in crate::preset) value: Option<Spanned<f64>>,
    pub(in crate::preset) min: Option<Spanned<f64>>,
    pub(in crate::preset) max: Option<Spanned<f64>>,
    pub(in crate::preset) scale: Option<Spanned<String>>,
    pub(in crate::preset) unit: String,
    pub(in crate::preset) symbol: String,
    pub(in crate::preset) about: String,
}

/// A law of motion as written.
pub(in crate::preset) struct DraftMechanics {
    /// Which table it is.
    pub(in crate::preset) law: Law,
    /// Where the table's name stands.
    pub(in crate::preset) place: Place,
    /// L or H.
    pub(in crate::preset) function: Option<Formula>,
    /// Rayleigh's function.
    pub(in crate::preset) dissipation: Option<Formula>,
    /// Coordinate and force.
    pub(in crate::preset) forces: Vec<NamedFormula>,
}

/// The tables that give a law of motion.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(in crate::preset) enum Law {
    Lagrangian,
    Hamiltonian,
}

pub(super) fn coordinates(top: &mut Table<'_>, mistakes: &mut Mistakes) -> Vec<DraftCoordinate> {
    let Some(table) = top.table("coordinates", mistakes) else {
        if !top.has("coordinates") && !top.has("variables") {
            let missing = Mistake::error(0..0, "the file has no coordinates");
            let help = "write [coordinates], and below it x = { initial = 1.0 }";
            top.lacks("coordinates", missing.with_help(help));
        }
        return Vec::new();
    };
    if table.entries().next().is_none() {
        let missing = Mistake::error(table.place.clone(), "there is no coordinate here");
        mistakes.missing("coordinates", missing.with_help("write x = { initial = 1.0 }"));
    }
    table.entries().map(|(name, entry)| coordinate(name, entry, mistakes)).collect()
}

fn coordinate<'d>(
    name: Spanned<String>,
    entry: &'d Value<'d>,
    mistakes: &mut Mistakes,
) -> DraftCoordinate {
    let called = format!("the coordinate `{}`", name.get_ref());
    let shape = format!("{} = {{ initial = ... }}", name.get_ref());
    let table = Table::of(entry, called, name.span(), &shape, mistakes);
    let mut coordinate = DraftCoordinate {
        name,
        initial: None,
        velocity: None,
        momentum: None,
        symbol: String::new(),
        unit: String::new(),
        period: None,
    };
    let Some(mut table) = table else { return coordinate };
    let initial = table.require("initial", "give its value at the start");
    coordinate.initial = initial.and_then(|(_, v)| value::formula(v, "`initial`", mistakes));
    let mut rate = |key| {
        let (place, found) = table.take(key)?;
        value::formula(found, &format!("`{key}`"), mistakes).map(|f| (place, f))
    };
    (coordinate.velocity, coordinate.momentum) = (rate("velocity"), rate("momentum"));
    coordinate.symbol = symbol(&mut table, mistakes);
    coordinate.unit = table.line("unit", mistakes);
    coordinate.period = table.formula("period", mistakes);
    table.finish(mistakes);
    coordinate
}

/// How a name is to be shown; empty where the file does not say.
fn symbol(table: &mut Table<'_>, mistakes: &mut Mistakes) -> String {
    let Some(text) = table.text("symbol", mistakes) else { return String::new() };
    if text.get_ref().trim().is_empty() {
        mistakes.push(Mistake::error(text.span(), "the symbol is empty"));
    }
    value::one_line(&text, mistakes).unwrap_or_default()
}

pub(super) fn parameters(top: &mut Table<'_>, mistakes: &mut Mistakes) -> Vec<DraftParameter> {
    let Some(table) = top.table("parameters", mistakes) else { return Vec::new() };
    table.entries().map(|(name, entry)| parameter(name, entry, mistakes)).collect()
}

fn parameter<'d>(
    name: Spanned<String>,
    entry: &'d Value<'d>,
    mistakes: &mut Mistakes,
) -> DraftParameter {
    let called = format!("the parameter `{}`", name.get_ref());
    let mut parameter = DraftParameter {
        name,
        value: None,
        min: None,
        max: None,
        scale: None,
        unit: String::new(),
        symbol: String::new(),
        about: String::new(),
    };
    match entry.get_ref() {
        DeValue::Table(entries) => {
            let mut table = Table::new(called, parameter.name.span(), entries);
            let found = table.require("value", "write { value = 1.0 }");
            parameter.value = found.and_then(|(_, v)| value::number(v, "`value`", mistakes));
            parameter.min = table.number("min", mistakes);
            parameter.max = table.number("max", mistakes);
            parameter.scale = table.text("scale", mistakes);
            parameter.unit = table.line("unit", mistakes);
            parameter.symbol = symbol(&mut table, mistakes);
            parameter.about = table.line("about", mistakes);
            table.finish(mistakes);
        }
        DeValue::String(_) => {
            let message = format!("{called} must be a number, not a text in quotes");
            let help = "what follows from other parameters stands in [definitions]";
            mistakes.push(Mistake::error(entry.span(), message).with_help(help));
        }
        _ => parameter.value = value::number(entry, &called, mistakes),
    }
    parameter
}

pub(super) fn definitions(top: &mut Table<'_>, mistakes: &mut Mistakes) -> Vec<NamedFormula> {
    let Some(table) = top.table("definitions", mistakes) else { return Vec::new() };
    formulas(&table, "the definition", mistakes)
}

/// A table of names with an expression each.
pub(super) fn formulas(
    table: &Table<'_>,
    called: &str,
    mistakes: &mut Mistakes,
) -> Vec<NamedFormula> {
    table
        .entries()
        .map(|(name, entry)| {
            let called = format!("{called} `{}`", name.get_ref());
            let formula = value::formula(entry, &called, mistakes);
            (name, formula)
        })
        .collect()
}

pub(super) fn mechanics(top: &mut Table<'_>, mistakes: &mut Mistakes) -> Vec<DraftMechanics> {
    let lagrangian = law(Law::Lagrangian, top, mistakes);
    let hamiltonian = law(Law::Hamiltonian, top, mistakes);
    if !["lagrangian", "hamiltonian", "poisson"].iter().any(|law| top.has(law)) {
        let missing = Mistake::error(0..0, "the file has no law of motion");
        let help = "write [lagrangian] with L = \"...\", or [hamiltonian] with H = \"...\"";
        top.lacks("lagrangian", missing.with_help(help));
    }
    lagrangian.into_iter().chain(hamiltonian).collect()
}

fn law(law: Law, top: &mut Table<'_>, mistakes: &mut Mistakes) -> Option<DraftMechanics> {
    let (table, key, example) = match law {
        Law::Lagrangian => ("lagrangian", "L", "L = \"T - V\""),
        Law::Hamiltonian => ("hamiltonian", "H", "H = \"T + V\""),
    };
    let mut table = top.table(table, mistakes)?;
    let found = table.require(key, &format!("write {example}"));
    let function = found.and_then(|(_, v)| value::formula(v, &format!("`{key}`"), mistakes));
    let mut dissipation = None;
    if law == Law::Lagrangian {
        dissipation = table.formula("dissipation", mistakes);
    }
    let forces = table.take("forces").and_then(|(place, found)| {
        let shape = "forces = { x = \"...\" }";
        Table::of(found, "`forces`", place, shape, mistakes)
    });
    let forces = forces.map_or(Vec::new(), |t| formulas(&t, "the force on", mistakes));
    let place = table.place.clone();
    table.finish(mistakes);
    Some(DraftMechanics { law, place, function, dissipation, forces })
}
