//! What follows from a law of motion as one JSON object. The keys are the contract with other
//! programs; every expression is in the syntax of preset files.

use serde_json::{Map, Value, json};

use super::body::Numbers;
use crate::expr::Expr;
use crate::mechanics::{Classed, Equations, Flow, casimir_rate, widened, with_reactions};
use crate::model::{Action, Direction, Event, Impulse, Mechanics, Model};

pub(super) fn write(model: &Model, equations: &Equations, classes: &[Classed]) -> String {
    let mut pool = equations.pool.clone();
    let forces = match &equations.flow {
        Flow::Lagrange { force, .. } => with_reactions(&mut pool, &equations.constraints, force),
        Flow::Hamilton { .. } | Flow::Poisson { .. } => Vec::new(),
    };
    let text = |e: &Expr| Value::String(pool.text(*e));
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
        Flow::Lagrange { mass, .. } => (mass.iter().map(|row| list(row)).collect(), list(&forces)),
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
    let observables: Vec<Value> = classes
        .iter()
        .map(|c| {
            let rate = c.rate.as_ref().map_or(Value::Null, text);
            json!({ "name": c.name, "class": c.class.to_string(), "rate": rate })
        })
        .collect();
    let mut object = json!({
        "phaselab": env!("CARGO_PKG_VERSION"),
        "title": model.info.title,
        "coordinates": names.collect::<Vec<_>>(),
        "not_below_zero": list(&widened(model, equations)),
        "momenta": momenta,
        "equations": solved,
        "mass_matrix": mass_matrix,
        "right_hand_side": right_hand_side,
        "hamiltonian": hamiltonian,
        "energy": text(&equations.energy),
        "energy_rate": text(&equations.energy_rate),
        "cyclic": equations.cyclic.iter().map(|&i| name(i)).collect::<Vec<_>>(),
        "conserved": conserved,
        "observables": observables,
        "constraints": constraints(model, equations),
        "impulses": impulses(model),
        "events": events(model),
        "transformations": [],
    });
    if let Some(body) = Numbers::of(model, equations) {
        let name = |symbol| equations.pool.symbol_info(symbol).name.clone();
        let whole = body.whole;
        let named = [(body.names.mass, whole.mass)].into_iter();
        let named = named.chain(body.names.centre.into_iter().zip(whole.centre));
        let named = named.chain(body.names.inertia.into_iter().zip(whole.inertia));
        let expressions: Map<String, Value> =
            named.map(|(symbol, e)| (name(symbol), text(&e))).collect();
        object["body"] = json!({
            "mass": body.mass,
            "centre_of_mass": body.centre,
            "inertia": body.inertia,
            "principal_moments": body.moments,
            "axes": body.axes,
            "expressions": expressions,
        });
    }
    if let Mechanics::Poisson { casimirs, forces, .. } = &model.mechanics {
        let mut equations = equations.clone();
        let brackets = model.mechanics.brackets().into_iter();
        object["variables"] = object["coordinates"].clone();
        object["brackets"] =
            brackets.map(|(i, j, e)| json!([name(i), name(j), equations.pool.text(e)])).collect();
        object["casimirs"] = casimirs
            .iter()
            .map(|(name, e, _)| {
                let rate = casimir_rate(&mut equations, *e, forces);
                let text = |e| equations.pool.text(e);
                json!({ "name": name, "expression": text(*e), "rate": text(rate) })
            })
            .collect();
    }
    if !why.is_empty() {
        object["why"] = Value::String(why.join("; "));
    }
    format!("{object:#}\n")
}

/// Each constraint, Σ coefficient · x' + rate = 0, with its multiplier: its name, and its value
/// where it is known in closed form. The force on x is λ times the coefficient of x.
fn constraints(model: &Model, equations: &Equations) -> Vec<Value> {
    let text = |e: Expr| Value::String(equations.pool.text(e));
    let all = model.constraints.iter().zip(&equations.constraints).enumerate();
    all.map(|(k, (constraint, row))| {
        let named = model.coordinates.iter().zip(&row.row);
        let coefficients: Map<String, Value> =
            named.map(|(c, &a)| (c.name.clone(), text(a))).collect();
        let solved = equations.multipliers.as_ref().ok().map(|solved| text(solved[k]));
        json!({
            "name": constraint.name,
            "expression": text(constraint.expression),
            "holonomic": row.position.is_some(),
            "coefficients": coefficients,
            "rate": text(row.rate),
            "multiplier": equations.pool.symbol_info(row.multiplier).name,
            "lambda": solved,
        })
    })
    .collect()
}

/// Each impulse with what it adds to momenta (or variables), and when.
fn impulses(model: &Model) -> Vec<Value> {
    let text = |e: Expr| Value::String(model.pool.text(e));
    let object = |impulse: &Impulse| {
        let changes = model.coordinates.iter().zip(&impulse.change);
        let changes: Map<String, Value> = changes
            .filter(|(_, e)| **e != Expr::ZERO)
            .map(|(c, &e)| {
                let lead = if model.is_poisson() { "" } else { "p_" };
                (format!("{lead}{}", c.name), text(e))
            })
            .collect();
        json!({
            "name": impulse.name,
            "change": changes,
            "at": impulse.times.iter().map(|&e| text(e)).collect::<Vec<_>>(),
            "every": impulse.period.map(text),
        })
    };
    model.impulses.iter().map(object).collect()
}

fn events(model: &Model) -> Vec<Value> {
    let object = |event: &Event| {
        let direction = match event.direction {
            Direction::Rising => "rising",
            Direction::Falling => "falling",
            Direction::Either => "either",
        };
        let action = match event.action {
            Action::Mark => "mark".to_owned(),
            Action::Stop => "stop".to_owned(),
            Action::Release(k) => format!("release:{}", model.constraints[k].name),
            Action::Impulse(k) => format!("impulse:{}", model.impulses[k].name),
        };
        json!({
            "name": event.name,
            "when": model.pool.text(event.when),
            "direction": direction,
            "action": action,
        })
    };
    model.events.iter().map(object).collect()
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
