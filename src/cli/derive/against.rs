//! `derive --against`: whether another Lagrangian gives the same motion because it differs by a total derivative.
//!
//! In: an expression, or a file with a Lagrangian. Out: the answer, and the function whose derivative the difference is.
//! Never here: the proof.

use std::path::Path;

use serde_json::{Value, json};

use super::super::assignment;
use super::super::error::CommandError;
use super::super::open;
use super::super::script::MathScript;
use crate::experiment::Derived;
use crate::expr::{Expr, Pool};
use crate::mechanics::{Equations, GaugeDifference};
use crate::model::Model;
use crate::num::Number;

/// The Lagrangian of the system compared with another.
pub(super) struct LagrangianComparison {
    given: String,
    gauge: GaugeDifference,
}

impl LagrangianComparison {
    pub(super) fn of(
        model: &Model,
        equations: &mut Equations,
        given: &str,
    ) -> Result<LagrangianComparison, CommandError> {
        let Ok(own) = equations.lagrangian().clone() else {
            let why = "--against: the system has no Lagrangian in closed form".to_owned();
            return Err(CommandError::CouldNot(why));
        };
        let is_file = Path::new(given).extension().is_some_and(|end| end == "toml")
            || crate::preset::find(given).is_ok();
        let text = if is_file { of_file(model, given)? } else { given.to_owned() };
        let other = assignment::expression(model, &mut equations.pool, &text, "--against")?;
        let mut allowed: Vec<_> =
            equations.coordinates.iter().flat_map(|c| [c.position, c.velocity]).collect();
        allowed.push(equations.symbols.time);
        allowed.extend(equations.supplements.constants.iter().map(|(s, _)| *s));
        let used = equations.pool.symbols_of(other);
        if let Some(&symbol) = used.iter().find(|s| !allowed.contains(s)) {
            let name = &equations.pool.symbol_info(symbol).name;
            return Err(CommandError::WrongUse(format!(
                "--against: `{name}` cannot be used in a Lagrangian; coordinates, velocities, t and \
                 parameters can"
            )));
        }
        let gauge = equations.gauge(own, other);
        Ok(LagrangianComparison { given: given.to_owned(), gauge })
    }

    pub(super) fn text(&self, pool: &Pool, script: MathScript) -> String {
        let math = |e: Expr| script.math(pool, e);
        let words = match (self.gauge.total_derivative, self.gauge.function) {
            (Some(true), Some(f)) => format!(
                "the same equations of motion, proved: the difference is the derivative of {}",
                math(f)
            ),
            (Some(true), None) => {
                "the same equations of motion, proved: the difference is a total derivative"
                    .to_owned()
            }
            (Some(false), _) => "the difference is not a total derivative, proved".to_owned(),
            (None, _) => "whether the difference is a total derivative is not known".to_owned(),
        };
        let difference = math(self.gauge.difference);
        let given = script.words(&self.given);
        format!("\nAgainst {given}\n  L less this = {difference}\n  {}\n", script.words(&words))
    }

    pub(super) fn latex(&self, pool: &Pool) -> String {
        let difference = pool.latex(self.gauge.difference);
        let right = match (self.gauge.total_derivative, self.gauge.function) {
            (Some(true), Some(f)) => {
                format!("{difference} = \\frac{{d}}{{dt}}\\left({}\\right)", pool.latex(f))
            }
            (Some(true), None) => format!("{difference} \\quad\\text{{(a total derivative)}}"),
            (Some(false), _) => format!("{difference} \\quad\\text{{(no total derivative)}}"),
            (None, _) => difference,
        };
        format!("\\begin{{align*}}\nL - L_2 &= {right}\n\\end{{align*}}\n")
    }

    pub(super) fn json(&self, pool: &Pool) -> Value {
        json!({
            "given": self.given,
            "difference": pool.text(self.gauge.difference),
            "total_derivative": self.gauge.total_derivative,
            "of": self.gauge.function.map(|f| pool.text(f)),
        })
    }
}

/// The Lagrangian of another file in the names of this one: parameters that both have are the same, others have their
/// values.
fn of_file(model: &Model, name: &str) -> Result<String, CommandError> {
    let document = open::find(name)?;
    let other = open::read(&document)?;
    let Derived { model: other, mut equations } = open::derive(&document, other)?;
    let names = |model: &Model| -> Vec<String> {
        let mut names: Vec<String> = model.coordinates.iter().map(|c| c.name.clone()).collect();
        names.sort();
        names
    };
    if names(model) != names(&other) {
        return Err(CommandError::WrongUse(format!(
            "--against: {name} has the coordinates {}, and this system {}",
            names(&other).join(", "),
            names(model).join(", ")
        )));
    }
    let Ok(lagrangian) = equations.lagrangian().clone() else {
        let why = format!("--against: {name} has no Lagrangian in closed form");
        return Err(CommandError::CouldNot(why));
    };
    let own = equations.supplements.constants.clone();
    let missing = own.into_iter().filter(|&(symbol, _)| {
        let name = &equations.pool.symbol_info(symbol).name;
        model.parameters.iter().all(|p| p.name != *name)
    });
    let missing: Vec<(_, Number)> = missing.collect();
    let pool = &mut equations.pool;
    let values = missing.into_iter().map(|(s, n)| (s, pool.number(n))).collect();
    let lagrangian = pool.substitute(lagrangian, &values);
    Ok(pool.text(lagrangian))
}
