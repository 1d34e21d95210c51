//! States of a motion, one after the other, in the form of their system.
//!
//! In: states of either form. Out: the same in the native form, or the inputs of a program on them. Velocities that momenta
//! alone do not determine are searched for near those of the state before. Never here: tangent vectors.

use std::borrow::Cow;
use std::sync::Arc;

use super::legendre::Legendre;
use super::{MotionError, State, System};
use crate::num::{DoubleDouble, Real};

/// Converts the states of one motion at one set of parameters.
#[derive(Clone, Debug)]
pub(super) struct NativeStates {
    system: System,
    parameters: Vec<f64>,
    pub(super) legendre: Legendre,
    /// The last state, if momenta alone do not determine it.
    last: Option<State>,
}

impl NativeStates {
    /// A conversion whose parameters must be set before it is used.
    pub(super) fn new(system: &System) -> NativeStates {
        NativeStates {
            legendre: Legendre::new(Arc::clone(&system.shared.legendre), system.form()),
            system: system.clone(),
            parameters: Vec::new(),
            last: None,
        }
    }

    /// Sets the parameters, of which `inputs` are all values of the [system](System::inputs).
    pub(super) fn set_parameters(&mut self, parameters: &[f64], inputs: &[DoubleDouble]) {
        self.parameters.clear();
        self.parameters.extend_from_slice(parameters);
        self.legendre.set_parameters(inputs);
    }

    pub(super) fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    /// A state in the native form.
    pub(super) fn of<'s>(&mut self, state: &'s State) -> Result<Cow<'s, State>, MotionError> {
        let form = self.system.form();
        let branches = self.system.has_branches();
        let native = if state.form == form {
            Cow::Borrowed(state)
        } else if branches && self.last.is_none() {
            Cow::Owned(self.system.convert(state, form, &self.parameters)?)
        } else {
            let near = self.last.as_ref();
            Cow::Owned(self.system.convert_by(&mut self.legendre, state, form, near)?)
        };
        if branches {
            self.last = Some(native.clone().into_owned());
        }
        Ok(native)
    }

    /// Writes a state in the native form, then action and work, into the first of `inputs`.
    pub(super) fn write<R: Real>(
        &mut self,
        state: &State,
        inputs: &mut [R],
    ) -> Result<(), MotionError> {
        if state.form == self.system.form() && !self.system.has_branches() {
            self.system.inputs_of(state, inputs);
        } else {
            let native = self.of(state)?;
            self.system.inputs_of(&native, inputs);
        }
        Ok(())
    }
}
