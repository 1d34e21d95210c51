//! `name=value` on the command line: parameters, initial values, and extra columns.

use std::str::FromStr;

use crate::diagnostic::nearest;
use crate::diagnostic::{Diagnostic, report};
use crate::expr::{Expr, Pool, spell};
use crate::integrate::ACCURACIES;
use crate::mechanics::{Valuation, body_constants};
use crate::model::{Allowed, Model, Scope, WrittenExpr};
use crate::num::Number;
use crate::system::InitialOverride;

use super::error::CommandError;
use super::stderr;
use crate::printable;

/// A name and its value, both as written.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Assignment {
    name: String,
    value: String,
}

impl FromStr for Assignment {
    type Err = String;

    fn from_str(text: &str) -> Result<Assignment, String> {
        let (name, value) = text.split_once('=').ok_or("write it as name=value")?;
        let (name, value) = (name_in_letters(name), value.trim().to_owned());
        if name.is_empty() || value.is_empty() {
            return Err("write it as name=value".to_owned());
        }
        Ok(Assignment { name, value })
    }
}

impl Assignment {
    /// An assignment out of a table.
    pub(super) fn of(name: &str, value: &str) -> Assignment {
        Assignment { name: name.to_owned(), value: value.to_owned() }
    }

    /// What is assigned, as it is written.
    pub(super) fn text(&self) -> &str {
        &self.value
    }

    pub(super) fn name(&self) -> &str {
        &self.name
    }
}

/// A name as files write it, for one as the screen shows it: `theta'` for `θ′`.
pub(super) fn name_in_letters(name: &str) -> String {
    let name = name.trim();
    let spelt = spell(name);
    let is_name = spelt.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '\'');
    if is_name { spelt } else { name.to_owned() }
}

/// The greatest length of an error message that quotes an invalid value.
const LONGEST_REASON: usize = 300;

/// Reads a tolerance: a number, or the name of an accuracy.
pub(super) fn tolerance(text: &str) -> Result<f64, String> {
    match ACCURACIES.iter().find(|(name, ..)| *name == text) {
        Some(&(_, tolerance)) => Ok(tolerance),
        None => number(text).map_err(|why| format!("{why}; `fast` and `exact` are names for two")),
    }
}

/// Reads a number on the command line, which may be written as in a file: `3*pi/4`.
pub(super) fn number(text: &str) -> Result<f64, String> {
    let text = text.trim();
    let value = match text.parse::<f64>() {
        Ok(value) => value,
        Err(_) => {
            let mut nothing = Model::new("");
            let mut scope = Scope::new(&nothing, Allowed::Parameters, "a number");
            let read = scope.read(&mut nothing.pool, text);
            let e = read.ok_or_else(|| first_error(&scope))?;
            nothing.pool.evaluate(e, &|_| f64::NAN)
        }
    };
    if value.is_finite() { Ok(value) } else { Err("it is not finite".to_owned()) }
}

/// Reads a time in seconds on the command line that may be spent.
pub(super) fn seconds(text: &str) -> Result<f64, String> {
    match number(text)? {
        seconds if seconds < 0.0 => Err("a time cannot be negative".to_owned()),
        seconds => Ok(seconds),
    }
}

/// A reader of whole numbers on the command line.
pub(super) fn whole<T: TryFrom<u64> + 'static>(
    least: u64,
    most: u64,
) -> impl Fn(&str) -> Result<T, String> + Clone + Send + Sync + 'static {
    move |text| {
        let number = text.trim().parse::<u64>().ok();
        let number = number.filter(|number| (least..=most).contains(number));
        let number = number.and_then(|number| T::try_from(number).ok());
        number.ok_or_else(|| format!("not a whole number from {least} to {most}"))
    }
}

fn first_error(scope: &Scope) -> String {
    let Some(diagnostic) = scope.diagnostics.first() else {
        return "it is not a number".to_owned();
    };
    // the command line has no tables to add anything to
    let help = diagnostic.help.iter().filter(|help| !help.contains('['));
    let parts = std::iter::once(&diagnostic.message).chain(help);
    let parts = parts.map(|part| printable::shortened(part, LONGEST_REASON));
    printable::line(&parts.collect::<Vec<_>>().join("; ")).into_owned()
}

/// The parameters: the file's values, with those set by the user.
pub(super) fn parameters(model: &Model, set: &[Assignment]) -> Result<Vec<f64>, CommandError> {
    let mut values = model.parameter_values();
    refuse_twice("--set", set)?;
    for assignment in set {
        let name = assignment.name.as_str();
        let index = parameter(model, name)?;
        values[index] = number(&assignment.value).map_err(|why| wrong(assignment, &why))?;
    }
    Ok(values)
}

pub(super) fn parameter(model: &Model, name: &str) -> Result<usize, CommandError> {
    model.parameter(name).ok_or_else(|| {
        let names = model.parameters.iter().map(|p| p.name.as_str());
        unknown("parameter", name, &names.collect::<Vec<_>>())
    })
}

/// Refuses two values for the same name, because one would be lost.
fn refuse_twice(option: &str, set: &[Assignment]) -> Result<(), CommandError> {
    for (i, later) in set.iter().enumerate() {
        if let Some(first) = set[..i].iter().find(|first| first.name == later.name) {
            let [name, one, other] =
                [&first.name, &first.value, &later.value].map(|text| printable::quoted(text));
            let message =
                format!("{option} gives {name} twice, {one} and {other}: keep one of them");
            return Err(CommandError::WrongUse(message));
        }
    }
    Ok(())
}

/// The time of the initial values: `--init t=…`, otherwise the file's.
pub(super) fn start(
    model: &Model,
    parameters: &[f64],
    set: &[Assignment],
) -> Result<f64, CommandError> {
    match set.iter().rfind(|assignment| assignment.name == "t") {
        Some(assignment) => initial_value(model, parameters, assignment),
        None => Ok(model.run.start),
    }
}

/// The overrides of the file's initial values.
pub(super) fn initial(
    model: &Model,
    parameters: &[f64],
    set: &[Assignment],
) -> Result<Vec<InitialOverride>, CommandError> {
    given_by("--init", model, parameters, set)
}

/// The same given by another option.
pub(super) fn given_by(
    option: &str,
    model: &Model,
    parameters: &[f64],
    set: &[Assignment],
) -> Result<Vec<InitialOverride>, CommandError> {
    let mut all: Vec<InitialOverride> = Vec::new();
    refuse_twice(option, set)?;
    for assignment in set.iter().filter(|assignment| assignment.name != "t") {
        let value = initial_value(model, parameters, assignment)?;
        if let Some(name) = multiplied(model, &assignment.value) {
            stderr::report(&format!(
                "{option} {}={}: `{name}` is the parameter, not a unit, so this is {value:?}",
                printable::quoted(&assignment.name),
                printable::quoted(&assignment.value)
            ));
        }
        all.push(place(model, &assignment.name, value)?);
    }
    for (i, c) in model.coordinates.iter().enumerate() {
        let velocity =
            |g: &InitialOverride| matches!(*g, InitialOverride::Velocity(j, _) if j == i);
        let momentum =
            |g: &InitialOverride| matches!(*g, InitialOverride::Momentum(j, _) if j == i);
        if all.iter().any(velocity) && all.iter().any(momentum) {
            let name = &c.name;
            let message =
                format!("{option} gives both {name}' and p_{name}; one follows from the other");
            return Err(CommandError::WrongUse(message));
        }
    }
    Ok(all)
}

/// Sets a model's initial coordinates, which determine the constraints that are redundant.
pub(super) fn begin_at(model: &mut Model, given: &[InitialOverride]) {
    for given in given {
        if let &InitialOverride::Position(i, x) = given {
            model.coordinates[i].initial = model.pool.number(Number::Real(x).canonical());
        }
    }
}

/// The parameter that a number is multiplied with by standing before it, if it has the name of a unit.
fn multiplied<'a>(model: &Model, value: &'a str) -> Option<&'a str> {
    const UNITS: [&str; 12] = ["m", "s", "kg", "g", "km", "cm", "mm", "h", "N", "J", "rad", "deg"];
    let (number, name) = value.trim().split_once(' ')?;
    let name = name.trim();
    let is_product = numeral(number).is_some() && UNITS.contains(&name);
    is_product.then(|| model.parameter(name)).flatten().map(|_| name)
}

/// An initial value as an expression in parameters, as in a file.
fn initial_value(
    model: &Model,
    parameters: &[f64],
    assignment: &Assignment,
) -> Result<f64, CommandError> {
    if let Some(value) = numeral(&assignment.value) {
        return Ok(value);
    }
    let mut pool = model.pool.clone();
    let mut scope = Scope::new(model, Allowed::Parameters, "an initial value");
    let e = scope
        .read(&mut pool, &assignment.value)
        .ok_or_else(|| wrong(assignment, &first_error(&scope)))?;
    let body = body_constants(model, parameters);
    let value = Valuation::of_parameters(model, parameters).with(body).value(&pool, e);
    if value.is_finite() { Ok(value) } else { Err(wrong(assignment, "it is not finite")) }
}

/// The value of a text that is a number and nothing else, as nearly all of a table of starts are.
fn numeral(text: &str) -> Option<f64> {
    if text.starts_with('+') {
        return None;
    }
    let value = text.parse().ok().filter(|value: &f64| value.is_finite())?;
    // the negative of zero is zero, as in an expression
    Some(value + 0.0)
}

pub(super) fn place(
    model: &Model,
    name: &str,
    value: f64,
) -> Result<InitialOverride, CommandError> {
    let coordinate = |name: &str| model.coordinate(name);
    let plain = coordinate(name).map(|i| InitialOverride::Position(i, value));
    // variables of brackets have neither velocities nor momenta at their start
    let find = |name: &str| coordinate(name).filter(|_| !model.is_poisson());
    let primed = || Some(InitialOverride::Velocity(find(name.strip_suffix('\'')?)?, value));
    let momentum = || Some(InitialOverride::Momentum(find(name.strip_prefix("p_")?)?, value));
    plain.or_else(primed).or_else(momentum).ok_or_else(|| {
        let names = initial_names(model);
        unknown("initial value", name, &names.iter().map(String::as_str).collect::<Vec<_>>())
    })
}

fn initial_names(model: &Model) -> Vec<String> {
    let names = model.coordinates.iter();
    names
        .flat_map(|c| [c.name.clone(), format!("{}'", c.name), format!("p_{}", c.name)])
        .filter(|written| !model.is_poisson() || model.coordinate(written).is_some())
        .chain(["t".to_owned()])
        .collect()
}

/// Refuses a name that is neither a parameter nor an initial value.
pub(super) fn settable(model: &Model, name: &str) -> Result<(), CommandError> {
    if name == "t" || model.parameter(name).is_some() || place(model, name, 0.0).is_ok() {
        return Ok(());
    }
    let initial = initial_names(model);
    let parameters = model.parameters.iter().map(|parameter| parameter.name.as_str());
    let names: Vec<&str> = parameters.chain(initial.iter().map(String::as_str)).collect();
    Err(unknown("parameter or initial value", name, &names))
}

/// An extra column, `EXPR` or `NAME=EXPR`. `pool` is the pool of the equations.
pub(super) fn column(
    model: &Model,
    pool: &mut Pool,
    text: &str,
    called: &str,
) -> Result<WrittenExpr, CommandError> {
    let (name, written) = match text.split_once('=') {
        Some((name, expression)) => (name.trim(), expression.trim()),
        None => (text.trim(), text.trim()),
    };
    if name.is_empty() {
        let text = printable::quoted(text);
        return Err(CommandError::WrongUse(format!("{called} {text}: a name comes before the =")));
    }
    let expression = expression(model, pool, written, called)?;
    Ok(WrittenExpr { written: name.to_owned(), expression })
}

/// Parses an expression that may use whatever an observable may. `called` is its name in messages;
/// `pool` is the pool of the equations.
pub(super) fn expression(
    model: &Model,
    pool: &mut Pool,
    written: &str,
    called: &str,
) -> Result<Expr, CommandError> {
    read(Scope::new(model, Allowed::Observable, "an observable"), pool, written, called)
}

/// The same, with H as the energy if the file does not use that name.
pub(super) fn expression_with_energy(
    model: &Model,
    pool: &mut Pool,
    written: &str,
    called: &str,
) -> Result<Expr, CommandError> {
    let mut scope = Scope::new(model, Allowed::Observable, "an observable");
    let taken = model.parameter("H").is_some()
        || model.coordinate("H").is_some()
        || model.definitions.iter().any(|(name, _)| name == "H")
        || model.observables.iter().any(|o| o.name == "H");
    if !taken {
        scope.define("H", pool.variable(model.symbols.energy));
    }
    read(scope, pool, written, called)
}

pub(super) fn read(
    mut scope: Scope,
    pool: &mut Pool,
    written: &str,
    called: &str,
) -> Result<Expr, CommandError> {
    if let Some(e) = scope.read(pool, written) {
        return Ok(e);
    }
    let diagnostics: Vec<Diagnostic> = scope
        .diagnostics
        .into_iter()
        .map(|diagnostic| {
            let place = diagnostic.span.start..diagnostic.span.end;
            Diagnostic { help: diagnostic.help, ..Diagnostic::error(place, diagnostic.message) }
        })
        .collect();
    stderr::show(&report(written, called, &diagnostics, stderr::has_colour()));
    let written = printable::quoted(written);
    Err(CommandError::WrongUse(format!(
        "{called}: `{written}` is not an expression of this system"
    )))
}

fn wrong(assignment: &Assignment, why: &str) -> CommandError {
    let [name, value] = [&assignment.name, &assignment.value].map(|text| printable::quoted(text));
    CommandError::WrongUse(format!("{name}={value}: {why}"))
}

/// The error of a name that is none of these.
pub(super) fn unknown(kind: &str, name: &str, names: &[&str]) -> CommandError {
    let shown = printable::quoted(name);
    let help = match nearest(name, names.iter().copied()) {
        Some(near) => format!("did you mean `{near}`?"),
        None if names.is_empty() => "there are none".to_owned(),
        None => format!("there are {}", names.join(", ")),
    };
    CommandError::WrongUse(format!("unknown {kind} `{shown}`; {help}"))
}
