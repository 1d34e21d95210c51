//! The errors of a system's motion, in the names of its file and with the place where they occur.
//!
//! In: what failed, and the numbers of the state. Out: a [`MotionError`]. Never here: what is done about it.

use super::error::{MotionError, MotionErrorKind};
use super::legendre::LegendreError;
use super::program::{Program, Singular};
use super::{Form, State, System};
use crate::num::DoubleDouble;

impl System {
    /// Checks that every number of a state is finite.
    ///
    /// # Errors
    /// Returns an error that names the first number that is not finite.
    pub fn check_finite(&self, state: &State) -> Result<(), MotionError> {
        match state.values.iter().position(|x| !x.is_finite()) {
            None => Ok(()),
            Some(i) => {
                let name = MotionErrorKind::NotFinite(self.name_of(i, state.form));
                Err(self.error(name, state.time, &state.values))
            }
        }
    }

    /// The display name of a number of a state.
    pub(super) fn name_of(&self, i: usize, form: Form) -> String {
        let n = self.degrees();
        let channel = match form {
            Form::Momentum if i >= n => i + n,
            _ => i,
        };
        if i < self.moving() {
            self.channels()[channel].shown.clone()
        } else if (self.motion_len()..self.driven_len()).contains(&i) {
            "a derivative of the motion".to_owned()
        } else {
            "an integral".to_owned()
        }
    }

    /// An error at a state, reported with its coordinates.
    pub fn error(&self, kind: MotionErrorKind, time: f64, values: &[f64]) -> MotionError {
        let named = self.channels().iter().zip(values).take(self.degrees().min(4));
        let place = named.map(|(c, &x)| (c.shown.clone(), x)).filter(|(_, x)| x.is_finite());
        MotionError { time, kind, place: place.collect() }
    }

    /// The error for a singular matrix, reported with the coordinates and rates the matrix depends on.
    pub(super) fn singular(
        &self,
        program: &Program,
        singular: Singular,
        time: f64,
        values: &[f64],
    ) -> MotionError {
        let known = self.moving().min(values.len());
        let named = program.inputs_of(singular).iter().filter(|&&i| i < known);
        let place = named.map(|&i| (self.name_of(i, self.form()), values[i]));
        let is_constrained = self.constraints() > 0;
        let kind = if is_constrained {
            MotionErrorKind::SingularConstraints(None)
        } else {
            MotionErrorKind::SingularMass
        };
        MotionError { time, kind, place: place.take(4).collect() }
    }

    /// The error for given momenta (or velocities) that do not determine the initial rates.
    pub(super) fn several(
        &self,
        time: f64,
        solutions: &[Vec<DoubleDouble>],
        targets: &[Option<DoubleDouble>],
    ) -> MotionError {
        let n = self.degrees();
        let unknown: Vec<usize> = (0..n).filter(|&i| targets[i].is_some()).collect();
        let first = if self.form() == Form::Momentum { 2 * n } else { n };
        let described = |solution: &Vec<DoubleDouble>| {
            let rate = |&i: &usize| {
                format!("{} = {}", self.channels()[first + i].name, solution[n + i].high)
            };
            unknown.iter().map(rate).collect::<Vec<_>>().join(", ")
        };
        let kind = MotionErrorKind::SeveralStarts(solutions.iter().map(described).collect());
        MotionError { time, kind, place: Vec::new() }
    }

    /// The error for momenta that do not determine the velocities.
    pub(super) fn without_momenta(&self) -> MotionErrorKind {
        if self.constraints() > 0 { MotionErrorKind::NoMass } else { MotionErrorKind::SingularMass }
    }

    /// The error for a relation between velocities and momenta that could not be solved.
    pub(super) fn unsolved(
        &self,
        why: LegendreError,
        time: f64,
        numbers: &[DoubleDouble],
    ) -> MotionError {
        let kind = match why {
            LegendreError::Singular => self.without_momenta(),
            LegendreError::NotConverging => MotionErrorKind::NoVelocities,
        };
        let values: Vec<f64> = numbers.iter().map(|x| x.high).collect();
        self.error(kind, time, &values)
    }
}
