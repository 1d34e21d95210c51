//! The Legendre transformation by Newton's method: p = ∂L/∂q̇ solved for q̇, or q̇ = ∂H/∂p solved
//! for p. If the relation is linear, the first step solves it; if it is not one-to-one, several
//! solutions belong to the same momenta.
//!
//! The residual of an equation is measured relative to the size of its terms, so that a velocity of
//! exactly zero is found like any other. Where the iteration does not converge so, the rounding of what
//! the terms are themselves sums of is taken out: a momentum may be nothing else, where M has terms that cancel.
//!
//! In: a relation, a guess. Out: the rates where the iteration from there ends. Never here: other guesses (`search`).

mod search;

use std::sync::Arc;

use super::program::{Program, Singular};
use super::rhs::ProgramBuilder;
use super::solve::Factored;
use super::state::Form;
use super::term_sizes;
use super::value::Evaluator;
use crate::expr::{Expr, Symbol};
use crate::mechanics::Flow;
use crate::num::DoubleDouble;

/// The maximal number of halvings of a step, and of steps.
const HALVINGS: u32 = 60;
const STEPS: u32 = 100;

/// The number of halvings where little is to be tried.
const FEW_HALVINGS: u32 = 8;

/// A residual this small relative to the terms is rounding in double-double.
const ROUNDING: f64 = 1e-29;

/// A residual this small that no step reduces is rounding as well.
const STAGNATION: f64 = 1e-20;

/// A larger residual is never a solution, however small the last step was: the iteration is stuck
/// at a fold of the relation.
const SETTLED: f64 = 1e-15;

/// A step this small relative to the numbers with which the iteration began moves nothing.
const NOTHING: f64 = 1e-26;

/// The program of the relation. It maps a state in the native form to the other rates, followed by
/// the matrix of their derivatives with respect to the native ones.
pub(super) fn program(builder: &mut ProgramBuilder<'_>) -> Result<Arc<Program>, Symbol> {
    let equations = builder.equations;
    let (rates, matrix): (Vec<Expr>, Vec<Expr>) = match &equations.flow {
        Flow::Lagrange { mass, .. } => {
            (equations.momenta.clone(), mass.iter().flatten().copied().collect())
        }
        Flow::Poisson { .. } => (Vec::new(), Vec::new()),
        Flow::Hamilton { velocities, .. } => {
            let mut matrix = Vec::new();
            for &v in velocities {
                for c in &equations.coordinates {
                    matrix.push(builder.pool.derivative(v, c.momentum));
                }
            }
            (velocities.clone(), matrix)
        }
    };
    let mut lowering = builder.on_native_state();
    let mut outputs = lowering.lower_all(&rates);
    outputs.extend(lowering.lower_all(&matrix));
    lowering.finish(outputs)
}

/// Why no solution was found.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum LegendreError {
    Singular,
    /// The iteration does not converge.
    NotConverging,
}

impl From<Singular> for LegendreError {
    fn from(_: Singular) -> LegendreError {
        LegendreError::Singular
    }
}

/// The relation between velocities and momenta of one system, at one set of parameters.
#[derive(Clone, Debug)]
pub(super) struct Legendre {
    native: Form,
    values: Evaluator<DoubleDouble>,
    degrees: usize,
    /// (q, native rates).
    state: Vec<DoubleDouble>,
    newton: NewtonWorkspace,
    /// The size of the terms of each register of the program, if their rounding is taken out of residuals.
    sizes: Option<Vec<f64>>,
    /// Whether solutions are searched for near the guess only.
    pub(super) near_only: bool,
}

/// What an iteration needs, kept for the next: a landscape takes thousands.
#[derive(Clone, Debug)]
struct NewtonWorkspace {
    factored: Factored<DoubleDouble>,
    /// The sizes of the terms, at the beginning and at the end of a step, never at a distant trial point.
    scales: [Vec<f64>; 2],
    /// The same where the iteration began.
    first_scales: Vec<f64>,
    step: Vec<DoubleDouble>,
    missed: Vec<DoubleDouble>,
    next: Vec<DoubleDouble>,
    before: Vec<DoubleDouble>,
    /// All rates where the iteration began.
    guess: Vec<DoubleDouble>,
}

impl NewtonWorkspace {
    fn new(unknown: usize, degrees: usize) -> NewtonWorkspace {
        let zeros = vec![DoubleDouble::ZERO; unknown];
        NewtonWorkspace {
            factored: Factored::new(unknown),
            scales: [vec![0.0; unknown], vec![0.0; unknown]],
            first_scales: vec![0.0; unknown],
            step: zeros.clone(),
            missed: zeros.clone(),
            next: zeros.clone(),
            before: zeros,
            guess: vec![DoubleDouble::ZERO; degrees],
        }
    }
}

impl Legendre {
    pub(super) fn new(program: Arc<Program>, native: Form) -> Legendre {
        let degrees = program.inputs() / 2;
        let state = vec![DoubleDouble::ZERO; 2 * degrees];
        let values = Evaluator::new(program);
        Legendre {
            native,
            values,
            degrees,
            state,
            newton: NewtonWorkspace::new(degrees, degrees),
            sizes: None,
            near_only: false,
        }
    }

    pub(super) fn set_parameters(&mut self, parameters: &[DoubleDouble]) {
        self.values.set_parameters(parameters);
    }

    pub(super) fn native(&self) -> Form {
        self.native
    }

    /// Writes the other rates of a state (q, native rates) into `out`.
    pub(super) fn other_rates(
        &mut self,
        time: DoubleDouble,
        state: &[DoubleDouble],
        out: &mut [DoubleDouble],
    ) -> Result<(), LegendreError> {
        self.values.evaluate(time, &state[..2 * self.degrees])?;
        for (i, x) in out[..self.degrees].iter_mut().enumerate() {
            *x = self.values.output(i);
        }
        Ok(())
    }

    /// For one degree of freedom and a relation that is linear, at a time and a coordinate: the other rate where the native one is
    /// zero, and its slope. `None` where they have no values, or nothing follows from them.
    pub(super) fn line(
        &mut self,
        (time, position): (DoubleDouble, DoubleDouble),
    ) -> Option<(DoubleDouble, DoubleDouble)> {
        self.values.evaluate(time, &[position, DoubleDouble::ZERO]).ok()?;
        let (at_rest, slope) = (self.values.output(0), self.values.output(1));
        (at_rest.is_finite() && slope.is_finite() && slope.high != 0.0).then_some((at_rest, slope))
    }

    /// Newton's iteration from the values in `self.state`. Returns the part of the residual that
    /// the first step left.
    fn iterate(
        &mut self,
        time: DoubleDouble,
        targets: &[Option<DoubleDouble>],
        unknown: &[usize],
    ) -> Result<f64, LegendreError> {
        let mut newton = std::mem::replace(&mut self.newton, NewtonWorkspace::new(0, 0));
        if newton.step.len() != unknown.len() {
            newton = NewtonWorkspace::new(unknown.len(), self.degrees);
        }
        newton.guess.copy_from_slice(&self.state[self.degrees..]);
        let mut outcome = self.iterate_with(&mut newton, time, targets, unknown);
        if outcome == Err(LegendreError::NotConverging) {
            self.state[self.degrees..].copy_from_slice(&newton.guess);
            self.sizes = Some(Vec::new());
            outcome = self.iterate_with(&mut newton, time, targets, unknown);
            self.sizes = None;
        }
        self.newton = newton;
        outcome
    }

    fn iterate_with(
        &mut self,
        newton: &mut NewtonWorkspace,
        time: DoubleDouble,
        targets: &[Option<DoubleDouble>],
        unknown: &[usize],
    ) -> Result<f64, LegendreError> {
        let n = self.degrees;
        let NewtonWorkspace {
            factored,
            scales: [scales, scales_there],
            first_scales,
            step,
            missed,
            next,
            before,
            guess: _,
        } = newton;
        let halvings = if self.near_only { FEW_HALVINGS } else { HALVINGS };
        self.missing(time, targets, unknown, scales, step)?;
        first_scales.copy_from_slice(scales);
        let sizes = unknown.iter().map(|&i| self.state[n + i].high.abs());
        let first_size = sizes.fold(0.0, f64::max);
        // a value that has come to nearly nothing is known to the digits of its terms, which the sizes of the terms do
        // not show: e^v − 1
        let is_nothing = |moved: f64, missed: &[DoubleDouble], first_scales: &[f64]| {
            moved <= NOTHING * first_size && largest(missed, first_scales) <= ROUNDING
        };
        let mut moved = f64::INFINITY;
        let mut left = None;
        let mut last_change = f64::INFINITY;
        for _ in 0..STEPS {
            let values = &self.values;
            let regular = factored.factor(|i, j| values.output(n + unknown[i] * n + unknown[j]));
            if !regular {
                return Err(LegendreError::Singular);
            }
            missed.copy_from_slice(step);
            factored.solve(step);
            for (x, &i) in before.iter_mut().zip(unknown) {
                *x = self.state[n + i];
            }
            let mut size = 1.0;
            let mut change = 0.0_f64;
            let (mut old, mut new) = (f64::INFINITY, f64::INFINITY);
            for halving in 0..=halvings {
                change = 0.0;
                for (k, &i) in unknown.iter().enumerate() {
                    self.state[n + i] = before[k] + step[k] * size;
                    let scale = before[k].high.abs().max(self.state[n + i].high.abs());
                    if step[k].high != 0.0 {
                        change = change.max((step[k].high * size).abs() / scale);
                    }
                }
                self.missing(time, targets, unknown, scales_there, next)?;
                (old, new) = (largest(missed, scales), largest(next, scales));
                let at_rounding = (halving == 0 && change < 1e-20) || old <= STAGNATION;
                if new <= old || new == 0.0 || (at_rounding && new.is_finite()) {
                    if halving > 0 {
                        left = Some(1.0);
                    }
                    break;
                }
                let whole = step.iter().fold(0.0_f64, |most, x| most.max(x.high.abs()));
                if is_nothing(whole, missed, first_scales) {
                    for (&x, &i) in before.iter().zip(unknown) {
                        self.state[n + i] = x;
                    }
                    return Ok(left.unwrap_or(0.0));
                }
                if halving == halvings {
                    return Err(LegendreError::NotConverging);
                }
                size *= 0.5;
            }
            left.get_or_insert(if old <= STAGNATION { 0.0 } else { new / old });
            std::mem::swap(scales, scales_there);
            new = largest(next, scales);
            // converged: the correction is below the precision of the result, or the residual stops
            // shrinking
            let no_more_missed = is_rounding(old, new);
            let settled =
                new <= SETTLED && (change < 1e-26 || (change < 1e-18 && change >= last_change));
            if new == 0.0 || no_more_missed || settled {
                return Ok(left.unwrap_or(0.0));
            }
            last_change = change;
            moved = step.iter().fold(0.0_f64, |most, x| most.max((x.high * size).abs()));
            step.copy_from_slice(next);
        }
        if is_nothing(moved, step, first_scales) {
            return Ok(left.unwrap_or(0.0));
        }
        Err(LegendreError::NotConverging)
    }

    /// Writes target − value, where there is a target, into `out`, and the size of the terms of
    /// each equation into `scales`.
    fn missing(
        &mut self,
        time: DoubleDouble,
        targets: &[Option<DoubleDouble>],
        unknown: &[usize],
        scales: &mut [f64],
        out: &mut [DoubleDouble],
    ) -> Result<(), LegendreError> {
        let n = self.degrees;
        self.values.evaluate(time, &self.state)?;
        if let Some(sizes) = &mut self.sizes {
            let values = &self.values;
            term_sizes::of(values.program(), |r| values.register(r).high, sizes);
        }
        for ((x, scale), &i) in out.iter_mut().zip(scales).zip(unknown) {
            let (target, value) = (targets[i].unwrap_or(DoubleDouble::ZERO), self.values.output(i));
            *x = target - value;
            let part = |j: usize| (self.values.output(n + i * n + j) * self.state[n + j]).high;
            let parts: f64 = (0..n).map(|j| part(j).abs()).sum();
            *scale = target.high.abs() + value.high.abs() + parts;
            // what the terms leave by their rounding is nothing that another velocity makes up for
            let size = |sizes: &Vec<f64>| sizes[self.values.program().outputs[i] as usize];
            if x.high.abs() <= ROUNDING * self.sizes.as_ref().map_or(0.0, size) {
                *x = DoubleDouble::ZERO;
            }
        }
        Ok(())
    }
}

/// The largest residual relative to the terms of its equation.
fn largest(missing: &[DoubleDouble], scales: &[f64]) -> f64 {
    let parts = missing.iter().zip(scales).map(|(x, &scale)| match x.high {
        0.0 => 0.0,
        x if x.is_finite() && scale > 0.0 => x.abs() / scale,
        _ => f64::INFINITY,
    });
    parts.fold(0.0, f64::max)
}

/// Whether what is left of a residual, relative to its terms, is rounding, after `old` was left before the
/// last step.
fn is_rounding(old: f64, new: f64) -> bool {
    old <= STAGNATION && (new <= ROUNDING || (new <= STAGNATION && new >= 0.5 * old))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_residual_is_rounding_where_a_step_leaves_it_tiny_or_as_small_as_it_was() {
        for (old, new, rounding) in [
            (0.9e-20, 0.9e-29, true),
            (0.9e-20, 1.1e-29, false),
            (0.9e-20, 0.5e-20, true),
            (0.9e-20, 0.4e-20, false),
            (1.1e-20, 1.1e-20, false),
            (1.1e-20, 0.0, false),
        ] {
            assert_eq!(is_rounding(old, new), rounding, "{new:e} after {old:e}");
        }
    }
}
