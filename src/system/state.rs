//! A state of motion, and initial values that override the file's.

use serde::{Deserialize, Serialize};

use crate::num::DoubleDouble;

/// Which rates a state has beside its coordinates.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Form {
    /// (q, q̇), the variables of a Lagrangian.
    Velocity,
    /// (q, p), the variables of a Hamiltonian.
    Momentum,
    /// x alone, variables with given brackets.
    Variables,
}

/// A state of a motion. Every number of it is a sum of two: `values[i] + carry[i]`. The second is
/// what rounding cut off from the first, so that a long motion accumulates no rounding errors in
/// its sums. Reading `values` alone is enough for display.
#[derive(Clone, PartialEq, Debug)]
pub struct State {
    /// On the motion's clock, as an `f64`.
    pub time: f64,
    /// What rounding cut off from the time.
    pub time_carry: f64,
    /// Which rates the second part of `values` contains.
    pub form: Form,
    /// The coordinates, then their velocities or momenta, then auxiliary numbers, then tangent
    /// vectors, then the quadratures: the action ∫ L dt, and the work ∫ (dh/dt) dt of the energy balance.
    pub values: Vec<f64>,
    /// What rounding cut off from `values`.
    pub carry: Vec<f64>,
}

impl State {
    /// A state without carries.
    pub fn new(time: f64, form: Form, values: Vec<f64>) -> State {
        let carry = vec![0.0; values.len()];
        State { time, time_carry: 0.0, form, values, carry }
    }

    /// Copies another state; allocates only if that one is longer.
    pub fn copy_from(&mut self, other: &State) {
        self.time = other.time;
        self.time_carry = other.time_carry;
        self.form = other.form;
        self.values.clone_from(&other.values);
        self.carry.clone_from(&other.carry);
    }

    /// The time, including what was cut off.
    #[inline]
    pub fn exact_time(&self) -> DoubleDouble {
        DoubleDouble { high: self.time, low: self.time_carry }
    }

    /// Takes both parts of a time.
    #[inline]
    pub fn set_time(&mut self, time: DoubleDouble) {
        (self.time, self.time_carry) = (time.high, time.low);
    }

    /// A number of the state, including what was cut off.
    #[inline]
    pub fn exact(&self, i: usize) -> DoubleDouble {
        DoubleDouble { high: self.values[i], low: self.carry[i] }
    }

    /// Sets a number of the state.
    #[inline]
    pub fn set(&mut self, i: usize, x: DoubleDouble) {
        (self.values[i], self.carry[i]) = (x.high, x.low);
    }

    /// Sets all numbers; nothing of them was cut off.
    pub fn set_values(&mut self, values: impl Iterator<Item = f64>) {
        self.values.clear();
        self.values.extend(values);
        self.carry.clear();
        self.carry.resize(self.values.len(), 0.0);
    }

    /// Whether every number is finite.
    #[inline]
    pub fn is_finite(&self) -> bool {
        self.time.is_finite() && self.values.iter().all(|x| x.is_finite())
    }
}

/// An initial value that replaces the file's.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum InitialOverride {
    /// The coordinate of this index.
    Position(usize, f64),
    /// The velocity of this coordinate; a Hamiltonian system is solved for its momentum.
    Velocity(usize, f64),
    /// The momentum of this coordinate; a Lagrangian system is solved for its velocity.
    Momentum(usize, f64),
}

impl InitialOverride {
    /// The same initial value with another number.
    #[must_use]
    pub fn with_value(self, value: f64) -> InitialOverride {
        match self {
            InitialOverride::Position(i, _) => InitialOverride::Position(i, value),
            InitialOverride::Velocity(i, _) => InitialOverride::Velocity(i, value),
            InitialOverride::Momentum(i, _) => InitialOverride::Momentum(i, value),
        }
    }
}
