//! States that satisfy their constraints: projected after a step, after an impulse, or at the
//! start.
//!
//! In: a state (q, q̇) near one that satisfies f(q, t) = 0 and A q̇ + A₀ = 0, or target momenta.
//! Out: the state, and the reactions. Never here: which constraints are enforced, motion in time.

use super::conditions::{Conditions, Residual};
use super::legendre::LegendreError;
use super::solve::Factored;
use super::value::Evaluator;
use crate::num::DoubleDouble;

/// The maximal number of corrections, and of halvings of one correction.
const CORRECTIONS: usize = 60;
const HALVINGS: u32 = 60;

/// A residual this small relative to its terms is rounding in double-double.
const ROUNDING: f64 = 1e-30;

/// So is a residual this small that no correction reduces: the terms may themselves be differences
/// of larger ones.
const STAGNATION: f64 = 1e-22;

/// The projection of one system's states onto its constraints, at one set of parameters.
#[derive(Clone, Debug)]
pub(super) struct Projection {
    conditions: Conditions,
    /// The momenta, then M, as functions of (q, q̇).
    momenta: Evaluator<DoubleDouble>,
    degrees: usize,
    enforced: Vec<bool>,
}

/// Why a state could not be projected onto its constraints.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum ProjectionError {
    /// The constraints and the mass matrix together are singular.
    Singular,
    /// No state nearby satisfies this constraint.
    Lost(usize),
    /// This constraint was redundant at the start and contradicts the others here.
    Contradicts(usize),
}

impl Projection {
    pub(super) fn new(
        conditions: Conditions,
        momenta: Evaluator<DoubleDouble>,
        enforced: &[bool],
    ) -> Projection {
        Projection {
            degrees: conditions.degrees(),
            conditions,
            momenta,
            enforced: enforced.to_vec(),
        }
    }

    pub(super) fn set_parameters(&mut self, parameters: &[DoubleDouble]) {
        self.conditions.set_parameters(parameters);
        self.momenta.set_parameters(parameters);
    }

    pub(super) fn conditions(&mut self) -> &mut Conditions {
        &mut self.conditions
    }

    fn rows(&self) -> Vec<usize> {
        (0..self.enforced.len()).filter(|&k| self.enforced[k]).collect()
    }

    /// Moves a state (q, q̇) by the least amount, measured by the mass matrix, until positions and
    /// velocities satisfy the constraints to rounding: δq = M⁻¹Aᵀμ (not Baumgarte stabilisation,
    /// which changes the motion).
    pub(super) fn project(
        &mut self,
        time: DoubleDouble,
        state: &mut [DoubleDouble],
    ) -> Result<(), ProjectionError> {
        let n = self.degrees;
        self.correct(time, state, |projection, k, _| projection.conditions.position(k), 0)?;
        let velocity = |projection: &Projection, k: usize, state: &[DoubleDouble]| {
            projection.conditions.velocity(k, &state[n..2 * n])
        };
        self.correct(time, state, velocity, n)
    }

    /// Corrects the numbers of `state` from `first` on until the residuals of the enforced
    /// constraints are rounding.
    fn correct(
        &mut self,
        time: DoubleDouble,
        state: &mut [DoubleDouble],
        residual: impl Fn(&Projection, usize, &[DoubleDouble]) -> Residual,
        first: usize,
    ) -> Result<(), ProjectionError> {
        let n = self.degrees;
        let rows = self.rows();
        let mut factored = Factored::new(n + rows.len());
        let mut last = f64::INFINITY;
        for _ in 0..CORRECTIONS {
            self.conditions.observe(time, state);
            let worst = rows.iter().map(|&k| (residual(self, k, state).relative(), k));
            let (size, worst) = worst.fold(
                (0.0, 0),
                |a: (f64, usize), b| {
                    if b.0 > a.0 || b.0.is_nan() { b } else { a }
                },
            );
            if is_rounding(size, last) {
                return Ok(());
            }
            if size.is_nan() || size > 1e6 * last {
                return Err(ProjectionError::Lost(worst));
            }
            last = size;
            if self.momenta.evaluate(time, state).is_err() || !self.factor(&rows, &mut factored) {
                return Err(ProjectionError::Singular);
            }
            let mut step = vec![DoubleDouble::ZERO; n + rows.len()];
            for (j, &k) in rows.iter().enumerate() {
                step[n + j] = -residual(self, k, state).value;
            }
            factored.solve(&mut step);
            for i in 0..n {
                state[first + i] = state[first + i] + step[i];
            }
        }
        let lost = rows.iter().copied().find(|&k| residual(self, k, state).relative() > STAGNATION);
        lost.map_or(Ok(()), |k| Err(ProjectionError::Lost(k)))
    }

    /// Factors the matrix of M x − Aᵀμ, A x at the last state evaluated.
    fn factor(&self, rows: &[usize], factored: &mut Factored<DoubleDouble>) -> bool {
        let n = self.degrees;
        factored.factor(|i, j| match (i < n, j < n) {
            (true, true) => self.momenta.output(n + i * n + j),
            (true, false) => -self.conditions.entry(rows[j - n], i),
            (false, true) => self.conditions.entry(rows[i - n], j),
            (false, false) => DoubleDouble::ZERO,
        })
    }

    /// The velocities that satisfy the constraints and belong to the momenta `target` up to
    /// reactions: p(q, q̇) = target + AᵀΛ, A q̇ + A₀ = 0. The values in `state` are the first
    /// guess. Returns Λ of every constraint, zero if it is not enforced. Uses a damped Newton
    /// method, as the relation need not be linear.
    ///
    /// *The Principles of Dynamics*, § 1.3.3: Δ(∂L/∂q̇) = Q̂ + AᵀΛ̂.
    pub(super) fn impulse_outcome(
        &mut self,
        time: DoubleDouble,
        state: &mut [DoubleDouble],
        target: &[DoubleDouble],
    ) -> Result<Vec<DoubleDouble>, LegendreError> {
        let n = self.degrees;
        let rows = self.rows();
        self.conditions.observe(time, state);
        let mut factored = Factored::new(n + rows.len());
        let mut reactions = vec![DoubleDouble::ZERO; rows.len()];
        let mut numbers = state[..2 * n].to_vec();
        let (mut step, mut scales) = self.imbalance(time, &numbers, &reactions, target, &rows)?;
        let mut size = f64::INFINITY;
        for round in 0..CORRECTIONS {
            if !self.factor(&rows, &mut factored) {
                return Err(LegendreError::Singular);
            }
            factored.solve(&mut step);
            let (before, forces) = (numbers.clone(), reactions.clone());
            let last = size;
            let mut part = 1.0;
            for halving in 0..=HALVINGS {
                for i in 0..n {
                    numbers[n + i] = before[n + i] + step[i] * part;
                }
                for (j, x) in reactions.iter_mut().enumerate() {
                    *x = forces[j] + step[n + j] * part;
                }
                let found = self.imbalance(time, &numbers, &reactions, target, &rows);
                if let Ok((next, terms)) = found {
                    if round == 0 && terms.iter().all(|x| x.is_finite()) {
                        // from here on the scales include the terms before the impulse and after a
                        // whole step, since a body brought to rest has none in the end
                        scales.iter_mut().zip(terms).for_each(|(s, x)| *s = s.max(x));
                        let (first, _) = self.imbalance(time, &before, &forces, target, &rows)?;
                        size = size.min(merit(&first, &scales));
                        self.momenta.evaluate(time, &numbers)?;
                    }
                    let new = merit(&next, &scales);
                    if new < size || new <= STAGNATION {
                        (step, size) = (next, new);
                        break;
                    }
                }
                if halving == HALVINGS {
                    return Err(LegendreError::NotConverging);
                }
                part *= 0.5;
            }
            if is_rounding(size, last) {
                state[n..2 * n].copy_from_slice(&numbers[n..]);
                let mut all = vec![DoubleDouble::ZERO; self.enforced.len()];
                rows.iter().zip(reactions).for_each(|(&k, x)| all[k] = x);
                return Ok(all);
            }
        }
        Err(LegendreError::NotConverging)
    }

    /// The residual of each row, and the size of its terms.
    fn imbalance(
        &mut self,
        time: DoubleDouble,
        numbers: &[DoubleDouble],
        reactions: &[DoubleDouble],
        target: &[DoubleDouble],
        rows: &[usize],
    ) -> Result<(Vec<DoubleDouble>, Vec<f64>), LegendreError> {
        let n = self.degrees;
        self.momenta.evaluate(time, numbers)?;
        let mut missing = vec![DoubleDouble::ZERO; n + rows.len()];
        let mut sizes = vec![0.0; n + rows.len()];
        for i in 0..n {
            let p = self.momenta.output(i);
            let mut terms = p.high.abs() + target[i].high.abs();
            let mut value = target[i] - p;
            for (&k, &x) in rows.iter().zip(reactions) {
                let force = self.conditions.entry(k, i) * x;
                terms += force.high.abs();
                value = value + force;
            }
            // a momentum of zero is only as accurate as the rounding of its neighbours
            let rates = (0..n).map(|j| self.momenta.output(n + i * n + j) * numbers[n + j]);
            sizes[i] = terms + rates.map(|x| x.high.abs()).sum::<f64>();
            missing[i] = value;
        }
        for (j, &k) in rows.iter().enumerate() {
            let residual = self.conditions.velocity(k, &numbers[n..2 * n]);
            sizes[n + j] = residual.size;
            missing[n + j] = -residual.value;
        }
        Ok((missing, sizes))
    }
}

/// The root of the sum of squares of residuals relative to their scales. Newton's direction is a
/// descent direction for it, whatever the relation.
fn merit(missing: &[DoubleDouble], scales: &[f64]) -> f64 {
    let parts = missing.iter().zip(scales).map(|(x, &scale)| match x.high {
        0.0 => 0.0,
        x if scale > 0.0 => x / scale,
        _ => f64::INFINITY,
    });
    parts.map(|x| x * x).sum::<f64>().sqrt()
}

/// Whether what is left of a residual, relative to its terms, is rounding; `last` is what was left
/// before the last correction.
fn is_rounding(size: f64, last: f64) -> bool {
    size <= ROUNDING || (size <= STAGNATION && size >= 0.5 * last)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A residual relative to its terms can be as small as the rounding of a double-double, 1.2e-32, and
    /// where the terms are differences of numbers 1e9 times as large, 1e-23.
    #[test]
    fn a_residual_is_rounding_where_it_is_tiny_or_stays_small() {
        for (size, last, rounding) in [
            (0.9e-30, 1.0, true),
            (1.1e-30, 1.0, false),
            (0.9e-22, 1.7e-22, true),
            (0.9e-22, 1.9e-22, false),
            (1.1e-22, 1.1e-22, false),
            (f64::NAN, 1e-30, false),
        ] {
            assert_eq!(is_rounding(size, last), rounding, "{size:e} after {last:e}");
        }
    }
}
