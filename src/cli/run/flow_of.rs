//! `--flow-of NAME|EXPR`: the state carried along the flow of a generator in place of the motion.
//!
//! In: a derived system, the initial values, the option. Out: the system whose law is the generator, and the same state.
//! Never here: rows.

use crate::cli::assignment;
use crate::cli::error::CommandError;
use crate::cli::stderr;
use crate::experiment::Derived;
use crate::mechanics::{GeneratorFlow, flow_of};
use crate::model::WrittenExpr;
use crate::printable;
use crate::system::{Form, InitialOverride};

/// A system that moves along the flow of a generator.
pub(super) struct CarriedSystem {
    pub(super) derived: Derived,
    pub(super) columns: Vec<WrittenExpr>,
    pub(super) given: Vec<InitialOverride>,
}

/// Puts the generator in place of the law of motion.
pub(super) fn carried(
    derived: Derived,
    columns: &[WrittenExpr],
    written: &str,
    parameters: &[f64],
    given: &[InitialOverride],
) -> Result<CarriedSystem, CommandError> {
    let Derived { model, mut equations } = derived;
    let written = written.trim();
    let named = model.generators.iter().find(|generator| generator.name == written);
    let generator = match named {
        Some(generator) => generator.expression,
        None => assignment::expression(&model, &mut equations.pool, written, "--flow-of")?,
    };
    let could_not = |why: String| {
        CommandError::CouldNot(format!("--flow-of {}: {why}", printable::quoted(written)))
    };
    if equations.pool.depends(generator, model.symbols.action) {
        let why = "the action is an integral along the motion, not a function of its state";
        return Err(CommandError::WrongUse(format!(
            "--flow-of {}: {why}",
            printable::quoted(written)
        )));
    }
    let time = model.run.start;
    let before = Derived { model, equations: equations.clone() };
    let given = start(&before, parameters, given).map_err(could_not)?;
    let model = before.model;
    let moved = flow_of(&model, &mut equations, (written, generator), columns, time);
    let GeneratorFlow { mut model, equations, columns, left_out } =
        moved.map_err(|why| could_not(why.to_string()))?;
    for (name, why) in left_out {
        stderr::report(&format!("`{name}` has no column along this flow: {why}"));
    }
    // what suits the motion need not suit the generator
    "auto".clone_into(&mut model.run.method);
    model.run.method_place = None;
    model.run.step = None;
    Ok(CarriedSystem { derived: Derived { model, equations }, columns, given })
}

/// The initial state as coordinates and momenta, or variables.
fn start(
    derived: &Derived,
    parameters: &[f64],
    given: &[InitialOverride],
) -> Result<Vec<InitialOverride>, String> {
    let system = derived.compile(&[]).map_err(|why| why.to_string())?;
    let time = derived.model.run.start;
    let state = system.initial(time, parameters, given).map_err(|why| why.to_string())?;
    let n = system.degrees();
    if system.form() == Form::Variables {
        return Ok((0..n).map(|i| InitialOverride::Position(i, state.values[i])).collect());
    }
    let state =
        system.convert(&state, Form::Momentum, parameters).map_err(|why| why.to_string())?;
    let positions = (0..n).map(|i| InitialOverride::Position(i, state.values[i]));
    let momenta = (0..n).map(|i| InitialOverride::Momentum(i, state.values[n + i]));
    Ok(positions.chain(momenta).collect())
}
