//! The last change of the law on the way of a motion: of a parameter, of the text, or of the method, whose map is then another.
//!
//! In: what was changed, the state there. Out: [`LastChange`], which a checkpoint stores. Never here: how the law is changed
//! (`execute`, `checkpoint`), what is computed from there on.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::exact_state::{exact_numbers, exact_state};
use crate::system::{Form, State, System};

/// Where a motion continued under another law.
#[derive(Clone, PartialEq, Debug)]
pub struct LastChange {
    /// What was changed: the name of a parameter as it is shown, `the text`, or `the method`.
    pub what: String,
    /// The state from which the motion continued, and its time.
    pub state: Arc<State>,
}

/// The same as plain data.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct SavedChange {
    what: String,
    time: [f64; 2],
    form: Form,
    /// Each number of the state with its carried rounding error.
    state: Vec<[f64; 2]>,
}

impl SavedChange {
    /// A change, if its state is finite.
    pub(super) fn of(change: &LastChange) -> Option<SavedChange> {
        let LastChange { what, state } = change;
        state.is_finite().then(|| SavedChange {
            what: what.clone(),
            time: [state.time, state.time_carry],
            form: state.form,
            state: exact_numbers(state),
        })
    }

    /// The change, if this system has such states.
    pub(super) fn of_system(&self, system: &System) -> Option<LastChange> {
        let poisson = self.form == Form::Variables;
        let fits =
            self.state.len() == system.state_len() && poisson == (system.form() == Form::Variables);
        let state = || exact_state(self.time, self.form, &self.state);
        fits.then(|| LastChange { what: self.what.clone(), state: Arc::new(state()) })
    }
}
