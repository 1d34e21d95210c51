//! Coordinates or variables, parameters and definitions, as written.

use toml::Spanned;
use toml::de::DeValue;

use super::table::Table;
use super::value::Value;
use super::{Formula, value};
use crate::diagnostic::{Diagnostic, Diagnostics, SourceRange};
use crate::preset::schema::{COORDINATE, PARAMETER, VARIABLE};

/// A name with its expression, if that could be read.
pub(in crate::preset) type NamedFormula = (Spanned<String>, Option<Formula>);

pub(in crate::preset) struct DraftCoordinate {
    pub(in crate::preset) name: Spanned<String>,
    pub(in crate::preset) symbol: String,
    pub(in crate::preset) unit: String,
    pub(in crate::preset) initial: Option<Formula>,
    /// The range of the key, and the value.
    pub(in crate::preset) velocity: Option<(SourceRange, Formula)>,
    /// The range of the key, and the value.
    pub(in crate::preset) momentum: Option<(SourceRange, Formula)>,
    pub(in crate::preset) period: Option<Formula>,
}

impl DraftCoordinate {
    /// A coordinate of which only the name is read.
    fn unread(name: Spanned<String>) -> DraftCoordinate {
        DraftCoordinate {
            name,
            initial: None,
            velocity: None,
            momentum: None,
            symbol: String::new(),
            unit: String::new(),
            period: None,
        }
    }
}

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

/// A parameter's way to another value as written.
pub(in crate::preset) struct DraftRamp {
    pub(in crate::preset) parameter: Option<Spanned<String>>,
    pub(in crate::preset) to: Option<Formula>,
    pub(in crate::preset) start: Option<Formula>,
    pub(in crate::preset) duration: Option<Formula>,
    pub(in crate::preset) form: Option<Spanned<String>>,
}

/// The coordinates and variables as written; a file may have both tables by error.
pub(in crate::preset) struct DraftMoving {
    /// The coordinates or variables in order.
    pub(in crate::preset) all: Vec<DraftCoordinate>,
    /// The range of `[coordinates]`.
    pub(in crate::preset) coordinates: Option<SourceRange>,
    /// The range of `[variables]`.
    pub(in crate::preset) variables: Option<SourceRange>,
}

pub(super) fn moving(top: &mut Table<'_>) -> DraftMoving {
    let mut moving = DraftMoving { all: Vec::new(), coordinates: None, variables: None };
    if !top.has("coordinates") && !top.has("variables") {
        let key = if top.has("poisson") { "variables" } else { "coordinates" };
        let missing = Diagnostic::error(0..0, format!("the file has no {key}"));
        let help = format!("write [{key}], and below it x = 1.0");
        top.lacks(key, missing.with_help(help));
    }
    let tables = ["coordinates", "variables"].map(|key| {
        let table = top.table(key)?;
        if table.entries().next().is_none() {
            let what = key.trim_end_matches('s');
            let message = format!("there is no {what} here");
            let missing = Diagnostic::error(table.place.clone(), message);
            top.diagnostics.missing(key, missing.with_help("write x = 1.0"));
        }
        Some(table)
    });
    let [coordinates, variables] = tables;
    if let Some(table) = coordinates {
        moving.all.extend(table.entries().map(|one| coordinate(one, false, top.diagnostics)));
        moving.coordinates = Some(table.place);
    }
    if let Some(table) = variables {
        moving.all.extend(table.entries().map(|one| coordinate(one, true, top.diagnostics)));
        moving.variables = Some(table.place);
    }
    moving
}

/// A coordinate, or a variable of brackets: its initial value alone, or a table. A variable has no rate of its own.
fn coordinate<'d>(
    (name, entry): (Spanned<String>, &'d Value<'d>),
    is_variable: bool,
    diagnostics: &Diagnostics,
) -> DraftCoordinate {
    let (what, section) =
        if is_variable { ("variable", &VARIABLE) } else { ("coordinate", &COORDINATE) };
    let called = format!("the {what} `{}`", name.get_ref());
    let mut coordinate = DraftCoordinate::unread(name);
    let DeValue::Table(entries) = entry.get_ref() else {
        coordinate.initial = value::formula(entry, &called, diagnostics);
        return coordinate;
    };
    let mut table = Table::new(called, coordinate.name.span(), entries, diagnostics).with(section);
    coordinate.initial = table.formula("initial");
    if is_variable {
        for (key, _) in table.entries() {
            if let rate @ ("velocity" | "momentum") = key.get_ref().as_str() {
                let message = format!("a variable has no `{rate}`");
                let help = "its rate of change follows from H and the brackets";
                diagnostics.push(Diagnostic::error(key.span(), message).with_help(help));
            }
        }
        table.pass_over(&["velocity", "momentum"]);
    } else {
        let mut rate = |key| {
            let (place, found) = table.take(key)?;
            value::formula(found, &format!("`{key}`"), diagnostics).map(|f| (place, f))
        };
        (coordinate.velocity, coordinate.momentum) = (rate("velocity"), rate("momentum"));
    }
    coordinate.symbol = symbol(&mut table);
    coordinate.unit = table.line("unit");
    coordinate.period = table.formula("period");
    table.finish();
    coordinate
}

/// The display symbol of a name; empty if the file gives none.
fn symbol(table: &mut Table<'_>) -> String {
    let Some(text) = table.text("symbol") else { return String::new() };
    if text.get_ref().trim().is_empty() {
        table.diagnostics.push(Diagnostic::error(text.span(), "the symbol is empty"));
    }
    value::one_line(&text, table.diagnostics).unwrap_or_default()
}

pub(super) fn parameters(top: &mut Table<'_>) -> Vec<DraftParameter> {
    let Some(table) = top.table("parameters") else { return Vec::new() };
    table.entries().map(|(name, entry)| parameter(name, entry, top.diagnostics)).collect()
}

fn parameter<'d>(
    name: Spanned<String>,
    entry: &'d Value<'d>,
    diagnostics: &Diagnostics,
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
            let mut table =
                Table::new(called, parameter.name.span(), entries, diagnostics).with(&PARAMETER);
            let found = table.take("value");
            parameter.value = found.and_then(|(_, v)| value::constant(v, "`value`", diagnostics));
            parameter.min = table.number("min");
            parameter.max = table.number("max");
            parameter.scale = table.text("scale");
            parameter.unit = table.line("unit");
            parameter.symbol = symbol(&mut table);
            parameter.about = table.line("about");
            table.finish();
        }
        _ => parameter.value = value::constant(entry, &called, diagnostics),
    }
    parameter
}

pub(super) fn ramps(top: &mut Table<'_>) -> Vec<DraftRamp> {
    top.each("ramps", "this ramp", |table| DraftRamp {
        parameter: table.text("parameter"),
        to: table.formula("to"),
        start: table.formula("start"),
        duration: table.formula("duration"),
        form: table.text("form"),
    })
}

pub(super) fn definitions(top: &mut Table<'_>) -> Vec<NamedFormula> {
    let Some(table) = top.table("definitions") else { return Vec::new() };
    formulas(&table, "the definition")
}

/// A table of names and expressions.
pub(super) fn formulas(table: &Table<'_>, called: &str) -> Vec<NamedFormula> {
    table
        .entries()
        .map(|(name, entry)| {
            let called = format!("{called} `{}`", name.get_ref());
            let formula = value::formula(entry, &called, table.diagnostics);
            (name, formula)
        })
        .collect()
}
