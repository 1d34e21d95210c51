//! The units in which equilibria are searched for.
//!
//! In: a start. Out: a number for each variable, by which it counts as one. Never here: the search.

use std::f64::consts::TAU;

use super::phase_space::PhaseSpace;
use super::vector_field::VectorField;
use crate::system::{Form, State};

/// A coordinate whose start is smaller or larger than 1 by no more than a factor 1000 has the unit 1, any
/// other one the size of its start, and one that starts at 0 that of the largest of the others. Where all
/// start at 0 it is the distance over which the force along a coordinate changes its power law; the unit of
/// one in which the law is periodic is its period over 2π. The units of momenta follow.
const ORDINARY_SIZES: std::ops::RangeInclusive<f64> = 1e-3..=1e3;

/// A force is evaluated at each power of ten between these for the distance over which it changes its law.
const FARTHEST: f64 = 1e31;
const NEAREST: f64 = 1e-30;

/// A power law is another one from this difference of the powers on.
const ANOTHER_POWER: f64 = 0.5;

/// Where nothing pulls at the start, the forces beside it are the measure: so many units along each coordinate.
const BESIDE: f64 = 0.3;

/// A stiffness counts from this part of the largest work on, over a unit of each coordinate.
const PULLS: f64 = 1e-12;

/// The units of the coordinates, or of the variables of brackets, at a start.
pub(super) fn coordinate_units(space: &PhaseSpace, start: &[f64]) -> Vec<f64> {
    let ordinary = |x: f64| ORDINARY_SIZES.contains(&x);
    let lengths = (0..start.len()).filter(|&i| space.turns()[i].is_none());
    let largest = lengths.map(|i| start[i].abs()).fold(0.0, f64::max);
    let own = |(i, x): (usize, &f64)| match (space.turns()[i], x.abs()) {
        (Some(period), _) => period / TAU,
        (None, size) => match if size == 0.0 { largest } else { size } {
            size if size == 0.0 || ordinary(size) => 1.0,
            size => size,
        },
    };
    start.iter().enumerate().map(own).collect()
}

/// The distance from 0 over which the force along a coordinate changes its power law, at the largest scale at which it does; `None`
/// if it has one power at all distances.
fn reach_of_force(
    field: &mut VectorField,
    (time, variables): (f64, &[f64]),
    (i, degrees): (usize, usize),
) -> Option<f64> {
    let mut there = variables.to_vec();
    let mut farther: Option<f64> = None;
    let mut place = FARTHEST;
    while place > NEAREST {
        place /= 10.0;
        there[i] = place;
        if field.evaluate(time, &there).is_err() {
            continue;
        }
        let (force, slope) = (field.rate()[degrees + i], field.derivative()[(degrees + i, i)]);
        let power = slope * there[i] / force;
        if !power.is_finite() {
            continue;
        }
        if farther.is_some_and(|farther| (farther - power).abs() > ANOTHER_POWER) {
            return Some(place * 10.0_f64.sqrt());
        }
        farther = Some(power);
    }
    None
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
    let here = (start.time, variables);
    let lengths = (0..degrees).filter(|&i| space.turns()[i].is_none());
    let resting: Vec<usize> = lengths.filter(|i| !space.cyclic().contains(i)).collect();
    if resting.iter().all(|&i| variables[i] == 0.0) {
        for i in resting {
            let reach = reach_of_force(field, here, (i, degrees));
            if let Some(reach) = reach.filter(|reach| !ORDINARY_SIZES.contains(reach)) {
                units[i] = reach;
            }
        }
    }
    units.resize(2 * degrees, 1.0);
    let mut beside = variables.to_vec();
    (0..degrees).for_each(|i| beside[i] += BESIDE * units[i]);
    for place in [variables, &beside] {
        if field.evaluate(start.time, place).is_ok() && momentum_units(field, &mut units) {
            break;
        }
    }
    units
}

/// Sets the units of the momenta by the forces at a place. Returns whether anything pulls there.
fn momentum_units(field: &VectorField, units: &mut [f64]) -> bool {
    let degrees = units.len() / 2;
    let (rate, derivative) = (field.rate(), field.derivative());
    // what pulls on no coordinate but for rounding, as on a pendulum that is level, is no measure
    let pull = |i: usize| derivative[(degrees + i, i)].abs() * units[i] * units[i];
    let given = |i: usize| rate[degrees + i].abs() * units[i];
    let pulls: Vec<f64> = (0..degrees).map(pull).collect();
    let given: Vec<f64> = (0..degrees).map(given).collect();
    let largest = pulls.iter().chain(&given).copied().fold(0.0, f64::max);
    for i in 0..degrees {
        let mobility = derivative[(i, degrees + i)].abs();
        // where nothing pulls, the momentum that the force gives on that way, or that of the energy of others
        let work = [pulls[i], given[i]].into_iter().find(|work| *work > PULLS * largest);
        // the square of a momentum's unit over its mass is compared with forces: no unit is ordinary by itself
        let unit = (work.unwrap_or(largest) / mobility).sqrt();
        if unit.is_finite() && unit > 0.0 {
            units[degrees + i] = unit;
        }
    }
    largest > 0.0
}
