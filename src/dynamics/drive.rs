//! The period of a law in a coordinate, and that of a law that depends on time: of its drive, where time enters by sines and cosines of a t + b alone, of impulses at
//! equal intervals, and of surfaces that move and cause impulses.
//!
//! In: the equations, the parameters. Out: the common period, if there is one. Never here: orbits.

use super::periodicity::{common_period, law, turning_rates};
use crate::expr::Expr;
use crate::mechanics::{Equations, Valuation};
use crate::model::{EventAction, Model};
use crate::system::System;

/// The functions whose zeros let impulses act, and what these change.
pub(super) fn acts(model: &Model) -> Vec<Expr> {
    let acting = model.events.iter().filter_map(|event| match event.action {
        EventAction::Impulse(index) => Some((event.when, model.impulses.get(index)?)),
        _ => None,
    });
    acting.flat_map(|(when, impulse)| impulse.change.iter().copied().chain([when])).collect()
}

/// The period of the drive of a law of motion at these parameters; `None` if it has none.
pub fn drive_period(
    model: &Model,
    equations: &Equations,
    system: &System,
    parameters: &[f64],
) -> Option<f64> {
    let mut open = law(equations);
    open.extend(acts(model));
    let values = Valuation::of_parameters(model, parameters);
    let mut rates: Vec<f64> = Vec::new();
    for schedule in system.schedule(parameters) {
        if !schedule.times.is_empty() {
            return None;
        }
        rates.extend(schedule.interval.map(|interval| std::f64::consts::TAU / interval.high));
    }
    rates.extend(turning_rates(equations, open, (equations.symbols.time, &values))?);
    common_period(&rates)
}

/// The period of the law and of its energy in a coordinate of which the file gives none.
pub(super) fn coordinate_period(
    model: &Model,
    equations: &Equations,
    parameters: &[f64],
    coordinate: usize,
) -> Option<f64> {
    common_turn((model, equations), parameters, coordinate, Vec::new())
}

/// The period in a coordinate of the law, its energy and further expressions of its pool, where it enters by sines and cosines alone,
/// of a (q + b), that have a common one.
pub fn common_turn(
    (model, equations): (&Model, &Equations),
    parameters: &[f64],
    coordinate: usize,
    mut open: Vec<Expr>,
) -> Option<f64> {
    let symbol = equations.coordinates.get(coordinate)?.position;
    let values = Valuation::of_parameters(model, parameters);
    open.extend(law(equations));
    open.push(equations.energy);
    common_period(&turning_rates(equations, open, (symbol, &values))?)
}
