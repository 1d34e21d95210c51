//! What follows from a law of motion as one JSON object. The keys are the contract with other
//! programs; every expression is in the syntax of preset files.

use serde_json::{Map, Value, json};

use crate::expr::Expr;
use crate::mechanics::{Equations, Flow};
use crate::model::Model;

pub(super) fn write(model: &Model, equations: &Equations) -> String {
    let text = |e: &Expr| Value::String(equations.pool.text(*e));
    let list = |all: &[Expr]| Value::Array(all.iter().map(text).collect());
    let names = model.coordinates.iter().map(|c| c.name.as_str());
    let name = |i: usize| model.coordinates[i].name.clone();
    let mut why = Vec::new();

    let momenta: Map<String, Value> = (0..equations.momenta.len())
        .map(|i| (format!("p_{}", name(i)), text(&equations.momenta[i])))
        .collect();
    let solved = match &equations.solved {
        Ok(rates) => rate_names(model).into_iter().zip(rates.iter().map(text)).collect(),
        Err(reason) => {
            why.push(format!("equations: {reason}"));
            Value::Null
        }
    };
    let (mass_matrix, right_hand_side) = match &equations.flow {
        Flow::Lagrange { mass, force, .. } => {
            (mass.iter().map(|row| list(row)).collect(), list(force))
        }
        Flow::Hamilton { velocities, momentum_rates } => {
            (Value::Null, list(&[velocities.as_slice(), momentum_rates].concat()))
        }
        Flow::Poisson { rates } => (Value::Null, list(rates)),
    };
    let hamiltonian = match &equations.hamiltonian {
        Ok(h) => text(h),
        Err(reason) => {
            why.push(format!("hamiltonian: {reason}"));
            Value::Null
        }
    };
    let conserved: Vec<Value> = equations
        .conserved
        .iter()
        .map(|c| {
            json!({
                "name": c.name,
                "expression": text(&c.expression),
                "reason": c.reason.to_string(),
            })
        })
        .collect();
    let mut object = json!({
        "phaselab": env!("CARGO_PKG_VERSION"),
        "title": model.info.title,
        "coordinates": names.collect::<Vec<_>>(),
        "momenta": momenta,
        "equations": solved,
        "mass_matrix": mass_matrix,
        "right_hand_side": right_hand_side,
        "hamiltonian": hamiltonian,
        "energy": text(&equations.energy),
        "energy_rate": text(&equations.energy_rate),
        "cyclic": equations.cyclic.iter().map(|&i| name(i)).collect::<Vec<_>>(),
        "conserved": conserved,
        "constraints": [],
        "transformations": [],
    });
    if !why.is_empty() {
        object["why"] = Value::String(why.join("; "));
    }
    format!("{object:#}\n")
}

/// What [`Equations::solved`] gives the rate of: `x''`, or `x'` then `p_x'`.
fn rate_names(model: &Model) -> Vec<String> {
    let names = model.coordinates.iter().map(|c| &c.name);
    if model.is_lagrangian() {
        return names.map(|name| format!("{name}''")).collect();
    }
    let velocities = names.clone().map(|name| format!("{name}'"));
    velocities.chain(names.map(|name| format!("p_{name}'"))).collect()
}
