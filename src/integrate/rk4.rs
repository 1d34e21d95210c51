//! The classic Runge–Kutta method of order 4, for comparison.
//!
//! k₁ = f(t, y), k₂ = f(t + h/2, y + h/2 k₁), k₃ = f(t + h/2, y + h/2 k₂), k₄ = f(t + h, y + h k₃),
//! and y moves by h/6 (k₁ + 2 k₂ + 2 k₃ + k₄).
//!
//! Source: E. Hairer, S. P. Nørsett, G. Wanner, Solving Ordinary Differential Equations I,
//! table II.1.2.

use super::fixed::{FixedStep, Scheme, add};
use super::method::{Method, Preserves, Stepping};
use super::stability::Modes;
use crate::num::math;
use crate::system::{Form, KinkSides, MotionError, Rates, State, System};

pub(super) const METHOD: Method = Method {
    name: "rk4",
    title: "Runge–Kutta",
    order: Some(4),
    stepping: Stepping::Fixed,
    preserves: Preserves::Nothing,
    locates_kinks: false,
    stays_within_steps: true,
    needs: "",
    about: "The classic method of order 4, for comparison: accurate for a while, but it gains or \
            loses energy steadily. Hairer, Nørsett & Wanner, Solving Ordinary Differential \
            Equations I, table II.1.2.",
    fits: |_| Ok(()),
    leapfrogs: Vec::new,
    make: |system, settings| {
        Ok(Box::new(FixedStep::new(METHOD.name, system, settings, RungeKutta::new(system))?))
    },
};

/// For each stage: its time as a part of the step, reached by the rates of the stage before, and
/// its weight in sixths.
pub(super) const STAGES: [(f64, f64); 4] = [(0.0, 1.0), (0.5, 2.0), (0.5, 2.0), (1.0, 1.0)];

#[derive(Clone)]
pub(super) struct RungeKutta {
    rates: Rates,
    numbers: Vec<f64>,
    slope: Vec<f64>,
    /// Six times the mean slope, and then the mean slope.
    sum: Vec<f64>,
}

impl RungeKutta {
    pub(super) fn new(system: &System) -> RungeKutta {
        let zeros = vec![0.0; system.state_len()];
        let rates = system.native_rates();
        RungeKutta { rates, numbers: zeros.clone(), slope: zeros.clone(), sum: zeros }
    }
}

impl Scheme for RungeKutta {
    fn form(&self) -> Form {
        self.rates.form()
    }

    fn begin(&mut self, parameters: &[f64]) {
        self.rates.set_parameters(parameters);
    }

    fn advance(&mut self, step: f64, state: &mut State) -> Result<(), MotionError> {
        self.slope.fill(0.0);
        self.sum.fill(0.0);
        for (part, weight) in STAGES {
            let size = part * step;
            for (i, x) in self.numbers.iter_mut().enumerate() {
                *x = state.values[i] + (state.carry[i] + size * self.slope[i]);
            }
            self.rates.evaluate(state.time + size, &self.numbers, &mut self.slope)?;
            for (sum, slope) in self.sum.iter_mut().zip(&self.slope) {
                *sum += weight * slope;
            }
        }
        for x in &mut self.sum {
            *x /= 6.0;
        }
        add(state, step, &self.sum);
        Ok(())
    }

    fn modes(&self) -> Option<Modes<'_>> {
        Some(Modes { growth: |_, z| growth(z), weights: &[], harmless: 0.0 })
    }

    fn rates(&mut self, time: f64, numbers: &[f64], out: &mut [f64]) -> Result<(), MotionError> {
        self.rates.evaluate(time, numbers, out)
    }

    fn sides(&mut self) -> Vec<KinkSides> {
        vec![self.rates.sides()]
    }
}

/// |1 + z + z²/2 + z³/6 + z⁴/24|.
fn growth([re, im]: [f64; 2]) -> f64 {
    let (mut a, mut b) = (1.0, 0.0);
    for k in [4.0, 3.0, 2.0, 1.0] {
        (a, b) = (1.0 + (re * a - im * b) / k, (re * b + im * a) / k);
    }
    math::hypot(a, b)
}
