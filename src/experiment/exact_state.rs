//! The numbers of a state as plain data, each with its carried rounding error.
//!
//! In: a state, or its numbers and time. Out: the other. Never here: what is saved beside it.

use crate::system::{Form, State};

/// The numbers of a state, each with its carried rounding error.
pub(super) fn exact_numbers(state: &State) -> Vec<[f64; 2]> {
    state.values.iter().zip(&state.carry).map(|(&value, &carry)| [value, carry]).collect()
}

pub(super) fn exact_state([time, time_carry]: [f64; 2], form: Form, numbers: &[[f64; 2]]) -> State {
    let (values, carry) = numbers.iter().map(|&[value, carry]| (value, carry)).unzip();
    State { time, time_carry, form, values, carry }
}
