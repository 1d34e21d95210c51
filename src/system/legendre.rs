//! Between velocities and momenta, by Newton's method: p = ∂L/∂q̇ solved for q̇, or q̇ = ∂H/∂p
//! solved for p. Where the relation is linear the first step is the last.

use std::sync::Arc;

use super::motion::Writer;
use super::program::{Program, Singular};
use super::solve::Factored;
use super::state::Form;
use super::value::Values;
use crate::expr::{Double, Expr, Symbol};
use crate::mechanics::Flow;

/// How often a step may be halved, and how many steps there may be.
const HALVINGS: u32 = 60;
const STEPS: u32 = 100;

/// The relation's program: of a state in the native form, the other rates, then the matrix of
/// their derivatives with respect to the native ones.
pub(super) fn program(writer: &mut Writer<'_>) -> Result<Arc<Program>, Symbol> {
    let equations = writer.equations;
    let (rates, matrix): (Vec<Expr>, Vec<Expr>) = match &equations.flow {
        Flow::Lagrange { mass, .. } => {
            (equations.momenta.clone(), mass.iter().flatten().copied().collect())
        }
        Flow::Poisson { .. } => (Vec::new(), Vec::new()),
        Flow::Hamilton { velocities, .. } => {
            let mut matrix = Vec::new();
            for &v in velocities {
                for c in &equations.coordinates {
                    matrix.push(writer.pool.derivative(v, c.momentum));
                }
            }
            (velocities.clone(), matrix)
        }
    };
    let mut lowering = writer.on_native_state();
    let mut outputs = lowering.lower_all(&rates);
    outputs.extend(lowering.lower_all(&matrix));
    lowering.finish(outputs)
}

/// Why no solution was found.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Unsolved {
    /// The matrix of derivatives is singular.
    Singular,
    /// The iteration does not come to rest.
    NotConverging,
}

impl From<Singular> for Unsolved {
    fn from(_: Singular) -> Unsolved {
        Unsolved::Singular
    }
}

/// The relation between velocities and momenta of one system, at one set of parameters.
#[derive(Clone, Debug)]
pub(super) struct Legendre {
    native: Form,
    values: Values<Double>,
    degrees: usize,
    /// (q, native rates).
    state: Vec<Double>,
}

impl Legendre {
    pub(super) fn new(program: Arc<Program>, native: Form) -> Legendre {
        let degrees = program.inputs() / 2;
        let state = vec![Double::ZERO; 2 * degrees];
        Legendre { native, values: Values::new(program), degrees, state }
    }

    pub(super) fn set_parameters(&mut self, parameters: &[Double]) {
        self.values.set_parameters(parameters);
    }

    /// The form that is solved for.
    pub(super) fn native(&self) -> Form {
        self.native
    }

    /// The other rates of a state (q, native rates), into `out`.
    pub(super) fn other_rates(
        &mut self,
        time: Double,
        state: &[Double],
        out: &mut [Double],
    ) -> Result<(), Unsolved> {
        self.values.evaluate(time, &state[..2 * self.degrees])?;
        for (i, x) in out[..self.degrees].iter_mut().enumerate() {
            *x = self.values.output(i);
        }
        Ok(())
    }

    /// Changes the native rates of `state` at the indices where `targets` has a value until the
    /// other rates there have that value. What stands in `state` is the first guess; where it
    /// does not lead to a solution, rest is tried.
    pub(super) fn solve(
        &mut self,
        time: Double,
        state: &mut [Double],
        targets: &[Option<Double>],
    ) -> Result<(), Unsolved> {
        let n = self.degrees;
        let unknown: Vec<usize> = (0..n).filter(|&i| targets[i].is_some()).collect();
        self.state.copy_from_slice(&state[..2 * n]);
        let mut found = self.iterate(time, targets, &unknown);
        if found.is_err() {
            self.state.copy_from_slice(&state[..2 * n]);
            for &i in &unknown {
                self.state[n + i] = Double::ZERO;
            }
            found = self.iterate(time, targets, &unknown);
        }
        found?;
        state[n..2 * n].copy_from_slice(&self.state[n..]);
        Ok(())
    }

    fn iterate(
        &mut self,
        time: Double,
        targets: &[Option<Double>],
        unknown: &[usize],
    ) -> Result<(), Unsolved> {
        let n = self.degrees;
        let mut factored = Factored::new(unknown.len());
        let mut step = vec![Double::ZERO; unknown.len()];
        let mut residual = self.residual(time, targets, unknown, &mut step)?;
        let mut last_change = f64::INFINITY;
        for _ in 0..STEPS {
            let values = &self.values;
            let regular = factored.factor(|i, j| values.output(n + unknown[i] * n + unknown[j]));
            if !regular {
                return Err(Unsolved::Singular);
            }
            factored.solve(&mut step);
            let before: Vec<Double> = unknown.iter().map(|&i| self.state[n + i]).collect();
            let mut size = 1.0;
            let mut next = vec![Double::ZERO; unknown.len()];
            let mut change = 0.0_f64;
            for halving in 0..=HALVINGS {
                change = 0.0;
                for (k, &i) in unknown.iter().enumerate() {
                    self.state[n + i] = before[k] + step[k] * size;
                    let scale = before[k].high.abs().max(self.state[n + i].high.abs());
                    if step[k].high != 0.0 {
                        change = change.max((step[k].high * size).abs() / scale);
                    }
                }
                let new = self.residual(time, targets, unknown, &mut next)?;
                if new <= residual || new == 0.0 || (change < 1e-20 && new.is_finite()) {
                    residual = new;
                    break;
                }
                if halving == HALVINGS {
                    return Err(Unsolved::NotConverging);
                }
                size *= 0.5;
            }
            // at rest: the correction is beyond all digits shown, or no longer shrinks there
            if residual == 0.0 || change < 1e-26 || (change < 1e-18 && change >= last_change) {
                return Ok(());
            }
            last_change = change;
            step.copy_from_slice(&next);
        }
        Err(Unsolved::NotConverging)
    }

    /// target − value where there is a target, into `out`; gives its greatest relative size.
    fn residual(
        &mut self,
        time: Double,
        targets: &[Option<Double>],
        unknown: &[usize],
        out: &mut [Double],
    ) -> Result<f64, Unsolved> {
        self.values.evaluate(time, &self.state)?;
        let mut size = 0.0_f64;
        for (x, &i) in out.iter_mut().zip(unknown) {
            *x = targets[i].unwrap_or(Double::ZERO) - self.values.output(i);
            let part = x.high.abs();
            size = if part.is_finite() { size.max(part) } else { f64::INFINITY };
        }
        Ok(size)
    }
}
