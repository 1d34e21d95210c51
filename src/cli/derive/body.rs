//! The body of a file in numbers, at the file's parameters.

use crate::mechanics::{Equations, RigidBody, body_values, matrix, principal};
use crate::model::{BodyNames, Model};
use crate::num::DoubleDouble;

/// What a body is.
pub(super) struct Numbers<'a> {
    pub(super) names: BodyNames,
    pub(super) whole: &'a RigidBody,
    pub(super) mass: f64,
    pub(super) centre: [f64; 3],
    pub(super) inertia: [[f64; 3]; 3],
    pub(super) moments: [f64; 3],
    /// One a row, in the order of the moments.
    pub(super) axes: [[f64; 3]; 3],
}

impl<'a> Numbers<'a> {
    /// Those of the file's body, if it has one.
    pub(super) fn of(model: &Model, equations: &'a Equations) -> Option<Numbers<'a>> {
        let (names, whole) = (model.body.as_ref()?.names, equations.beside.body.as_ref()?);
        let parameters = model.parameter_values();
        let values = body_values(model, &equations.pool, Some(whole), &parameters);
        let value = |symbol| {
            let found = values.iter().find(|(s, _)| *s == symbol);
            found.map_or(f64::NAN, |(_, value)| *value)
        };
        let inertia = names.inertia.map(value);
        let (_, axes) = principal(&inertia.map(DoubleDouble::from));
        Some(Numbers {
            names,
            whole,
            mass: value(names.mass),
            centre: names.centre.map(value),
            inertia: matrix(&inertia),
            moments: names.principal.map(value),
            axes,
        })
    }
}
