//! Functions of the time that are given on the command line: paths, and variations of them.
//!
//! In: assignments `NAME=EXPR`. Out: [`PathFunctions`]. Never here: actions.

use super::assignment::Assignment;
use super::error::CommandError;
use crate::expr::{Expr, Pool, Symbol};
use crate::mechanics::{Equations, Valuation};
use crate::model::{Allowed, Model, Scope};
use crate::printable;

/// Functions of the time, one for each coordinate, with their first two derivatives.
pub(super) struct PathFunctions {
    time: Symbol,
    pub(super) values: [Vec<Expr>; 3],
}

impl PathFunctions {
    /// Their derivatives of an order, 0 to 2, at a time from the beginning.
    pub(super) fn at(&self, pool: &Pool, constants: &Valuation, t: f64, order: usize) -> Vec<f64> {
        let point = constants.clone().with([(self.time, t)]);
        self.values[order].iter().map(|&e| point.value(pool, e)).collect()
    }

    /// q and q̇ at a time from the beginning.
    pub(super) fn state(&self, pool: &Pool, constants: &Valuation, t: f64) -> Vec<f64> {
        [self.at(pool, constants, t, 0), self.at(pool, constants, t, 1)].concat()
    }

    /// Reads functions of the time, one for each coordinate; `None` if there are none.
    pub(super) fn read(
        model: &Model,
        equations: &mut Equations,
        given: &[Assignment],
        option: &str,
    ) -> Result<Option<PathFunctions>, CommandError> {
        if given.is_empty() {
            return Ok(None);
        }
        let wrong = |why: String| CommandError::WrongUse(format!("{option}: {why}"));
        let mut first: Vec<Option<Expr>> = vec![None; model.coordinates.len()];
        for assignment in given {
            let (name, text) = (assignment.name(), assignment.text());
            let Some(i) = model.coordinate(name) else {
                let names: Vec<&str> = model.coordinates.iter().map(|c| c.name.as_str()).collect();
                let name = printable::quoted(name);
                return Err(wrong(format!(
                    "unknown coordinate `{name}`; there are {}",
                    names.join(", ")
                )));
            };
            if first[i].is_some() {
                return Err(wrong(format!("`{name}` is given twice: keep one of them")));
            }
            let mut scope = Scope::new(model, Allowed::Configuration, "a path");
            let read = scope.read(&mut equations.pool, text);
            let diagnostic = scope.diagnostics.first().map(|diagnostic| diagnostic.message.clone());
            let e = read.ok_or_else(|| {
                let why = diagnostic.unwrap_or_else(|| "it cannot be read".to_owned());
                wrong(format!("{}: {}", printable::quoted(text), printable::line(&why)))
            })?;
            let moving: Vec<_> = model.coordinates.iter().map(|c| c.position).collect();
            if equations.pool.depends_on_any(e, &moving) {
                let why = "a path is a function of t and parameters";
                return Err(wrong(format!("{}: {why}", printable::quoted(text))));
            }
            first[i] = Some(e);
        }
        if option != "--vary"
            && let Some(i) = first.iter().position(Option::is_none)
        {
            return Err(wrong(format!("`{}` is missing", model.coordinates[i].name)));
        }
        // what is not varied stays
        let first: Vec<Expr> = first.into_iter().map(|e| e.unwrap_or(Expr::ZERO)).collect();
        let pool = &mut equations.pool;
        let slope = |pool: &mut Pool, all: &[Expr]| -> Vec<Expr> {
            all.iter().map(|&e| pool.derivative(e, model.symbols.time)).collect()
        };
        let second = slope(pool, &first);
        let third = slope(pool, &second);
        Ok(Some(PathFunctions { time: model.symbols.time, values: [first, second, third] }))
    }
}

pub(super) fn is_momentum(model: &Model, name: &str) -> bool {
    name.strip_prefix("p_")
        .is_some_and(|of| model.coordinate(name).is_none() && model.coordinate(of).is_some())
}

/// The same with the names of the coordinates that momenta belong to.
pub(super) fn of_coordinates(momenta: &[Assignment]) -> Vec<Assignment> {
    let renamed = |one: &Assignment| {
        let of = one.name().strip_prefix("p_").unwrap_or(one.name());
        Assignment::of(of, one.text())
    };
    momenta.iter().map(renamed).collect()
}
