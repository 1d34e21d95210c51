//! The period of a law that depends on time: of its drive, where time enters by sines and cosines of a t + b alone, of impulses at
//! equal intervals, and of surfaces that move and cause impulses.
//!
//! In: the equations, the parameters. Out: the common period, if there is one. Never here: orbits.

use crate::expr::{Expr, FunctionId, Node};
use crate::mechanics::{Equations, Flow, Valuation};
use crate::model::{EventAction, Model};
use crate::system::System;

/// The most turns of the slowest part of a drive in its common period.
const TURNS: u32 = 64;

/// A number of turns this close to a whole one is one.
const WHOLE: f64 = 1e-9;

/// The functions whose zeros let impulses act, and what these change.
pub(super) fn acts(model: &Model) -> Vec<Expr> {
    let acting = model.events.iter().filter_map(|event| match event.action {
        EventAction::Impulse(index) => Some((event.when, model.impulses.get(index)?)),
        _ => None,
    });
    acting.flat_map(|(when, impulse)| impulse.change.iter().copied().chain([when])).collect()
}

/// The period of the drive of a law of motion at these parameters; `None` if it has none.
pub(super) fn drive_period(
    model: &Model,
    equations: &Equations,
    system: &System,
    parameters: &[f64],
) -> Option<f64> {
    let mut pool = equations.pool.clone();
    let time = equations.symbols.time;
    let mut open: Vec<Expr> = match &equations.flow {
        Flow::Lagrange { mass, force, .. } => mass.iter().flatten().chain(force).copied().collect(),
        Flow::Hamilton { velocities, momentum_rates } => {
            velocities.iter().chain(momentum_rates).copied().collect()
        }
        Flow::Poisson { rates } => rates.clone(),
    };
    open.extend(acts(model));
    let values = Valuation::of_parameters(model, parameters);
    let mut seen = std::collections::HashSet::new();
    let mut rates: Vec<f64> = Vec::new();
    for schedule in system.schedule(parameters) {
        if !schedule.times.is_empty() {
            return None;
        }
        rates.extend(schedule.interval.map(|interval| std::f64::consts::TAU / interval.high));
    }
    while let Some(e) = open.pop() {
        if !pool.depends(e, time) || !seen.insert(e) {
            continue;
        }
        match pool.node(e).clone() {
            Node::Symbol(_) => return None,
            Node::Call(FunctionId::Sin | FunctionId::Cos, arguments) => {
                let slope = pool.derivative(*arguments.first()?, time);
                // a rate that depends on the motion, as in sin(x − ω t), is none where it does
                let rate = pool.evaluate(slope, &|symbol| {
                    if symbol == time { f64::NAN } else { values.at(symbol) }
                });
                let of_motion = equations
                    .coordinates
                    .iter()
                    .any(|c| pool.depends_on_any(slope, &[c.position, c.velocity, c.momentum]));
                if of_motion || !rate.is_finite() {
                    return None;
                }
                if rate != 0.0 {
                    rates.push(rate.abs());
                }
            }
            node => open.extend(node.parts()),
        }
    }
    let slowest = rates.iter().copied().fold(f64::INFINITY, f64::min);
    let whole = |turns: f64| (turns - turns.round()).abs() <= WHOLE * turns;
    let turn = std::f64::consts::TAU / slowest;
    let common = |count: &u32| rates.iter().all(|rate| whole(f64::from(*count) * rate / slowest));
    let count = (1..=TURNS).find(common).filter(|_| slowest.is_finite())?;
    Some(f64::from(count) * turn)
}
