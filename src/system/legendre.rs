//! The Legendre transformation by Newton's method: p = ∂L/∂q̇ solved for q̇, or q̇ = ∂H/∂p solved
//! for p. If the relation is linear, the first step solves it; if it is not one-to-one, several
//! solutions belong to the same momenta.
//!
//! The residual of an equation is measured relative to the size of its terms, so that a velocity of
//! exactly zero is found like any other.

use std::sync::Arc;

use super::program::{Program, Singular};
use super::rhs::ProgramBuilder;
use super::solve::Factored;
use super::state::Form;
use super::value::Evaluator;
use crate::expr::{Expr, Symbol};
use crate::mechanics::Flow;
use crate::num::{DoubleDouble, math};

/// The maximal number of halvings of a step, and of steps.
const HALVINGS: u32 = 60;
const STEPS: u32 = 100;

/// The number of halvings where little is to be tried.
const FEW_HALVINGS: u32 = 8;

/// A residual this small relative to the terms is rounding in double-double …
const ROUNDING: f64 = 1e-29;

/// … and so is one this small that no step reduces.
const STUBBORN: f64 = 1e-20;

/// A larger residual is never a solution, however small the last step was: the iteration is stuck
/// at a fold of the relation.
const SETTLED: f64 = 1e-15;

/// If the first step leaves at most this part of the residual, it leads to the solution nearest to
/// the guess: the relation is nearly linear between them.
const TAME: f64 = 0.25;

/// A single solution is searched for between this power of two and its inverse.
const FARTHEST: i32 = 64;

/// The numbers of parts into which the path to a solution is divided if it is too long for one
/// step.
const PARTS: [u32; 3] = [4, 16, 64];

/// Two solutions whose numbers differ by less than this part of their size are equal.
const ALIKE: f64 = 1e-8;

/// The starting points of the search for other solutions: the first one with one of its numbers
/// multiplied by these factors.
const ELSEWHERE: [f64; 10] = [-1.0, 0.5, -0.5, 2.0, -2.0, 0.1, -0.1, 10.0, -10.0, 0.0];

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
    /// The matrix of derivatives is singular.
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
    newton: Newton,
    /// Whether solutions are searched for near the guess only.
    pub(super) near_only: bool,
}

/// What an iteration needs, kept for the next: a landscape takes thousands.
#[derive(Clone, Debug)]
struct Newton {
    factored: Factored<DoubleDouble>,
    /// The sizes of the terms, at the beginning and at the end of a step, never at a distant trial point.
    scales: [Vec<f64>; 2],
    step: Vec<DoubleDouble>,
    missed: Vec<DoubleDouble>,
    next: Vec<DoubleDouble>,
    before: Vec<DoubleDouble>,
}

impl Newton {
    fn new(unknown: usize) -> Newton {
        let zeros = vec![DoubleDouble::ZERO; unknown];
        Newton {
            factored: Factored::new(unknown),
            scales: [vec![0.0; unknown], vec![0.0; unknown]],
            step: zeros.clone(),
            missed: zeros.clone(),
            next: zeros.clone(),
            before: zeros,
        }
    }
}

impl Legendre {
    pub(super) fn new(program: Arc<Program>, native: Form) -> Legendre {
        let degrees = program.inputs() / 2;
        let state = vec![DoubleDouble::ZERO; 2 * degrees];
        let values = Evaluator::new(program);
        Legendre { native, values, degrees, state, newton: Newton::new(degrees), near_only: false }
    }

    pub(super) fn set_parameters(&mut self, parameters: &[DoubleDouble]) {
        self.values.set_parameters(parameters);
    }

    /// The form that is solved for.
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

    /// Changes the native rates of `state`, at the indices where `targets` has a value, until the
    /// other rates there have that value. The values in `state` are the first guess; if that does
    /// not lead to a solution, zero rates are tried.
    pub(super) fn solve(
        &mut self,
        time: DoubleDouble,
        state: &mut [DoubleDouble],
        targets: &[Option<DoubleDouble>],
    ) -> Result<(), LegendreError> {
        let n = self.degrees;
        let unknown: Vec<usize> = (0..n).filter(|&i| targets[i].is_some()).collect();
        self.state.copy_from_slice(&state[..2 * n]);
        let mut found = self.iterate(time, targets, &unknown);
        if found.is_err() && !self.near_only {
            self.state.copy_from_slice(&state[..2 * n]);
            for &i in &unknown {
                self.state[n + i] = DoubleDouble::ZERO;
            }
            found = self.iterate(time, targets, &unknown);
        }
        if let (Err(LegendreError::NotConverging | LegendreError::Singular), [only], false) =
            (&found, &unknown[..], self.near_only)
        {
            // what is wrong at the guess explains more than a search that found nothing
            found = self.between_signs(time, state, targets, *only).or(found);
        }
        found?;
        state[n..2 * n].copy_from_slice(&self.state[n..]);
        Ok(())
    }

    /// The solution nearest to the guess for a single unknown, at a change of sign of the residual.
    /// The search covers both sides of zero and of the guess, far and near.
    fn between_signs(
        &mut self,
        time: DoubleDouble,
        state: &[DoubleDouble],
        targets: &[Option<DoubleDouble>],
        i: usize,
    ) -> Result<f64, LegendreError> {
        let n = self.degrees;
        let guess = state[n + i].high;
        let far = (-FARTHEST..=FARTHEST).map(|k| math::powi(2.0, k));
        let mut places: Vec<f64> =
            far.flat_map(|x| [x, -x, guess + x, guess - x]).chain([0.0, guess]).collect();
        places.sort_by(f64::total_cmp);
        places.dedup();
        self.state.copy_from_slice(&state[..2 * n]);
        let missed = |own: &mut Legendre, x: f64| {
            own.state[n + i] = DoubleDouble::from(x);
            let mut out = [DoubleDouble::ZERO];
            own.missing(time, targets, &[i], &mut [0.0], &mut out).ok()?;
            Some(out[0].high).filter(|x| !x.is_nan())
        };
        let values: Vec<Option<f64>> = places.iter().map(|&x| missed(self, x)).collect();
        let mut pairs: Vec<[f64; 2]> = Vec::new();
        for (place, value) in places.windows(2).zip(values.windows(2)) {
            if let [Some(a), Some(b)] = value
                && (*a < 0.0) != (*b < 0.0)
            {
                pairs.push([place[0], place[1]]);
            }
        }
        let distance = |pair: &[f64; 2]| (0.5 * (pair[0] + pair[1]) - guess).abs();
        pairs.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
        for [mut a, mut b] in pairs {
            let Some(below) = missed(self, a).map(|x| x < 0.0) else { continue };
            for _ in 0..HALVINGS {
                let middle = 0.5 * (a + b);
                match missed(self, middle) {
                    Some(x) if (x < 0.0) == below => a = middle,
                    Some(_) => b = middle,
                    None => break,
                }
            }
            self.state[n + i] = DoubleDouble::from(0.5 * (a + b));
            // the sign also changes at a pole
            if let Ok(left) = self.iterate(time, targets, &[i]) {
                return Ok(left);
            }
        }
        Err(LegendreError::NotConverging)
    }

    /// The same, but along the branch of solutions on which the first guess lies, which must belong
    /// to momenta nearby. If the branch ends, there is no solution.
    pub(super) fn follow(
        &mut self,
        time: DoubleDouble,
        state: &mut [DoubleDouble],
        targets: &[Option<DoubleDouble>],
    ) -> Result<(), LegendreError> {
        let n = self.degrees;
        let unknown: Vec<usize> = (0..n).filter(|&i| targets[i].is_some()).collect();
        self.state.copy_from_slice(&state[..2 * n]);
        let direct = self.iterate(time, targets, &unknown);
        if !direct.as_ref().is_ok_and(|&left| left <= TAME) {
            self.go_in_parts(time, state, targets, &unknown)?;
        }
        state[n..2 * n].copy_from_slice(&self.state[n..]);
        Ok(())
    }

    /// Goes from the momenta of the guess to the target in ever smaller parts.
    fn go_in_parts(
        &mut self,
        time: DoubleDouble,
        guess: &[DoubleDouble],
        targets: &[Option<DoubleDouble>],
        unknown: &[usize],
    ) -> Result<(), LegendreError> {
        let n = self.degrees;
        self.values.evaluate(time, &guess[..2 * n])?;
        let begin: Vec<DoubleDouble> = (0..n).map(|i| self.values.output(i)).collect();
        let mut outcome = Err(LegendreError::NotConverging);
        for parts in PARTS {
            self.state.copy_from_slice(&guess[..2 * n]);
            for part in 1..=parts {
                let share = f64::from(part) / f64::from(parts);
                let between = |i: usize| targets[i].map(|p| begin[i] + (p - begin[i]) * share);
                let targets: Vec<_> = (0..n).map(between).collect();
                outcome = match self.iterate(time, &targets, unknown) {
                    Ok(left) if left <= TAME => Ok(()),
                    Ok(_) => Err(LegendreError::NotConverging),
                    Err(why) => Err(why),
                };
                if outcome.is_err() {
                    break;
                }
            }
            if outcome.is_ok() {
                break;
            }
        }
        outcome
    }

    /// Returns all solutions that can be found if one is known, which is in `state` and comes
    /// first. The search starts far from it along one of the unknown numbers, and with the signs of
    /// all of them changed.
    pub(super) fn solutions(
        &mut self,
        time: DoubleDouble,
        state: &[DoubleDouble],
        targets: &[Option<DoubleDouble>],
    ) -> Vec<Vec<DoubleDouble>> {
        let n = self.degrees;
        let unknown: Vec<usize> = (0..n).filter(|&i| targets[i].is_some()).collect();
        let first = state[..2 * n].to_vec();
        let size = |x: &[DoubleDouble], i: usize| x[n + i].high.abs();
        let largest = unknown.iter().map(|&i| size(&first, i)).fold(0.0, f64::max);
        let largest = if largest > 0.0 { largest } else { 1.0 };
        let mut starts = Vec::new();
        for &i in &unknown {
            let own = if size(&first, i) > 0.0 { size(&first, i) } else { largest };
            for part in ELSEWHERE {
                let mut start = first.clone();
                start[n + i] = DoubleDouble::from(part * own);
                starts.push(start);
            }
        }
        let mut turned = first.clone();
        for &i in &unknown {
            turned[n + i] = -turned[n + i];
        }
        starts.push(turned);
        let mut found = vec![first];
        for start in starts {
            self.state.copy_from_slice(&start);
            if self.iterate(time, targets, &unknown).is_err() {
                continue;
            }
            let alike = |known: &Vec<DoubleDouble>| {
                unknown.iter().all(|&i| {
                    let apart = (known[n + i] - self.state[n + i]).high.abs();
                    apart <= ALIKE * size(known, i).max(size(&self.state, i)).max(ALIKE * largest)
                })
            };
            if !found.iter().any(alike) {
                found.push(self.state.clone());
            }
        }
        found
    }

    /// Newton's iteration from the values in `self.state`. Returns the part of the residual that
    /// the first step left.
    fn iterate(
        &mut self,
        time: DoubleDouble,
        targets: &[Option<DoubleDouble>],
        unknown: &[usize],
    ) -> Result<f64, LegendreError> {
        let mut newton = std::mem::replace(&mut self.newton, Newton::new(0));
        if newton.step.len() != unknown.len() {
            newton = Newton::new(unknown.len());
        }
        let outcome = self.iterate_with(&mut newton, time, targets, unknown);
        self.newton = newton;
        outcome
    }

    fn iterate_with(
        &mut self,
        newton: &mut Newton,
        time: DoubleDouble,
        targets: &[Option<DoubleDouble>],
        unknown: &[usize],
    ) -> Result<f64, LegendreError> {
        let n = self.degrees;
        let Newton { factored, scales: [scales, scales_there], step, missed, next, before } =
            newton;
        let halvings = if self.near_only { FEW_HALVINGS } else { HALVINGS };
        self.missing(time, targets, unknown, scales, step)?;
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
                let at_rounding = (halving == 0 && change < 1e-20) || old <= STUBBORN;
                if new <= old || new == 0.0 || (at_rounding && new.is_finite()) {
                    if halving > 0 {
                        left = Some(1.0);
                    }
                    break;
                }
                if halving == halvings {
                    return Err(LegendreError::NotConverging);
                }
                size *= 0.5;
            }
            left.get_or_insert(if old <= STUBBORN { 0.0 } else { new / old });
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
            step.copy_from_slice(next);
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
        for ((x, scale), &i) in out.iter_mut().zip(scales).zip(unknown) {
            let (target, value) = (targets[i].unwrap_or(DoubleDouble::ZERO), self.values.output(i));
            *x = target - value;
            let part = |j: usize| (self.values.output(n + i * n + j) * self.state[n + j]).high;
            let parts: f64 = (0..n).map(|j| part(j).abs()).sum();
            *scale = target.high.abs() + value.high.abs() + parts;
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
    old <= STUBBORN && (new <= ROUNDING || (new <= STUBBORN && new >= 0.5 * old))
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
