//! A state of motion, and what a user may say of the first one.

use serde::{Deserialize, Serialize};

use crate::num::DoubleDouble;

/// Which rates a state holds beside its coordinates.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Form {
    /// (q, q̇): what a Lagrangian is a function of.
    Velocity,
    /// (q, p): what a Hamiltonian is a function of.
    Momentum,
    /// x alone: variables that are given by their brackets.
    Variables,
}

/// Where a motion is. Every number of it is a sum of two: `values[i] + carry[i]`, the second one
/// what rounding has cut off the first, so that a long motion gathers no rounding errors in its
/// sums. Who only looks needs `values`.
#[derive(Clone, PartialEq, Debug)]
pub struct State {
    /// When.
    pub time: f64,
    /// What rounding cut off the time.
    pub time_carry: f64,
    /// What the second part of `values` is.
    pub form: Form,
    /// The coordinates, then their velocities or momenta, then numbers carried along beside the
    /// motion, then its quadratures: the action ∫ L dt, and the work ∫ (dh/dt) dt of the energy ledger.
    pub values: Vec<f64>,
    /// What rounding cut off.
    pub carry: Vec<f64>,
}

impl State {
    /// An exact state.
    pub fn new(time: f64, form: Form, values: Vec<f64>) -> State {
        let carry = vec![0.0; values.len()];
        State { time, time_carry: 0.0, form, values, carry }
    }

    /// Takes over another state; allocates only where that one is longer.
    pub fn copy_from(&mut self, other: &State) {
        self.time = other.time;
        self.time_carry = other.time_carry;
        self.form = other.form;
        self.values.clone_from(&other.values);
        self.carry.clone_from(&other.carry);
    }

    /// The time with what was cut off.
    pub fn exact_time(&self) -> DoubleDouble {
        DoubleDouble { high: self.time, low: self.time_carry }
    }

    /// A number of the state with what was cut off.
    pub fn exact(&self, i: usize) -> DoubleDouble {
        DoubleDouble { high: self.values[i], low: self.carry[i] }
    }

    /// Sets a number of the state.
    pub fn set(&mut self, i: usize, x: DoubleDouble) {
        (self.values[i], self.carry[i]) = (x.high, x.low);
    }

    /// Whether every number is finite.
    pub fn is_finite(&self) -> bool {
        self.time.is_finite() && self.values.iter().all(|x| x.is_finite())
    }
}

/// An initial value that takes the place of the file's.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum InitialOverride {
    /// The coordinate of this index.
    Position(usize, f64),
    /// Its velocity; in a Hamiltonian system the momentum that goes with it is solved for.
    Velocity(usize, f64),
    /// Its momentum; in a Lagrangian system the velocity that goes with it is solved for.
    Momentum(usize, f64),
}
