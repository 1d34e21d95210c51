//! The units in which equilibria are searched for.
//!
//! In: a start. Out: a number for each variable, by which it counts as one. Never here: the search.

use super::phase_space::{PhaseSpace, VectorField};
use crate::system::{Form, State};

/// A coordinate whose start is smaller or larger than 1 by no more than this factor has the unit 1, any
/// other one the size of its start, and one that starts at 0 that of the largest of the others; the
/// units of momenta follow.
const ORDINARY: f64 = 1e3;

/// A stiffness counts from this part of the largest work on, over a unit of each coordinate.
const PULLS: f64 = 1e-12;

/// The units of the coordinates, or of the variables of brackets, at a start.
pub(super) fn coordinate_units(space: &PhaseSpace, start: &[f64]) -> Vec<f64> {
    let ordinary = |x: f64| (1.0 / ORDINARY..=ORDINARY).contains(&x);
    let lengths = (0..start.len()).filter(|&i| space.turns()[i].is_none());
    let largest = lengths.map(|i| start[i].abs()).fold(0.0, f64::max);
    let own = |(i, x): (usize, &f64)| match x.abs() {
        _ if space.turns()[i].is_some() => 1.0,
        size => match if size == 0.0 { largest } else { size } {
            size if size == 0.0 || ordinary(size) => 1.0,
            size => size,
        },
    };
    start.iter().enumerate().map(own).collect()
}

/// The unit of each variable: that of a momentum makes the forces that move it as large, in one oscillation, as the
/// velocity that it causes.
pub(super) fn units(space: &PhaseSpace, start: &State, field: &mut VectorField) -> Vec<f64> {
    let variables = space.variables(start);
    let degrees = space.system().degrees();
    let mut units = coordinate_units(space, &variables[..degrees]);
    if space.form() != Form::Momentum {
        return units;
    }
    units.resize(2 * degrees, 1.0);
    if field.evaluate(start.time, variables).is_ok() {
        let derivative = field.derivative();
        // what pulls on no coordinate but for rounding, as on a pendulum that is level, is no measure
        let pull = |i: usize| derivative[(degrees + i, i)].abs() * units[i] * units[i];
        let given = |i: usize| field.rate()[degrees + i].abs() * units[i];
        let largest = (0..degrees).map(|i| pull(i).max(given(i))).fold(0.0, f64::max);
        let pulls: Vec<bool> = (0..degrees).map(|i| pull(i) > PULLS * largest).collect();
        for i in 0..degrees {
            let stiffness = derivative[(degrees + i, i)].abs();
            let mobility = derivative[(i, degrees + i)].abs();
            let impedance = (stiffness / mobility).sqrt();
            // where nothing pulls, the momentum that the force gives on that way
            let force = field.rate()[degrees + i].abs();
            let given = (force * units[i] / mobility).sqrt();
            let unit = if pulls[i] { impedance * units[i] } else { given };
            // the square of a momentum's unit over its mass is compared with forces: no unit is ordinary by itself
            if unit.is_finite() && unit > 0.0 {
                units[degrees + i] = unit;
            }
        }
    }
    units
}
