//! States of a motion converted from the native form again and again, at one set of parameters.
//!
//! In: states of the native form, or of the wanted one, with tangent vectors. Out: what [`System::convert`] has for them, to the last bit, or one of
//! their vectors alone. Never here: conversions to the native form, which may have several results.

use super::compiled::System;
use super::legendre::Legendre;
use super::variational::TangentConversion;
use super::{Form, MotionError, State};

/// Converts states of the native form to another, and leaves those as they are that have it.
pub struct Converter {
    system: System,
    form: Form,
    legendre: Legendre,
    tangents: Option<TangentConversion>,
}

impl System {
    /// Prepares conversions of states from the native form to another.
    pub fn converter(&self, form: Form, parameters: &[f64]) -> Converter {
        Converter {
            system: self.clone(),
            form,
            legendre: self.legendre(&self.inputs(parameters)),
            tangents: self.tangent_conversion(parameters),
        }
    }
}

impl Converter {
    /// The same state in the other form, with all its tangent vectors.
    ///
    /// # Errors
    /// Returns an error where the state has no such form.
    pub fn convert(&mut self, state: &State) -> Result<State, MotionError> {
        let mut found = self.system.convert_by(&mut self.legendre, state, self.form, None)?;
        if state.form == self.form {
            return Ok(found);
        }
        if let Some(tangents) = &mut self.tangents {
            tangents.convert(&self.system, state, &mut found, 0..self.system.tangents())?;
        }
        Ok(found)
    }

    /// One of the tangent vectors of a state in the other form.
    ///
    /// # Errors
    /// Returns an error where the state has no such form.
    pub fn tangent<'a>(
        &mut self,
        state: &'a mut State,
        vector: usize,
    ) -> Result<&'a [f64], MotionError> {
        let first = self.system.tangent_place(vector);
        if let Some(tangents) = self.tangents.as_mut().filter(|_| state.form != self.form) {
            let from = state.clone();
            tangents.convert(&self.system, &from, state, vector..vector + 1)?;
        }
        Ok(&state.values[first..first + self.system.moving()])
    }
}
