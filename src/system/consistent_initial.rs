//! The initial velocities of a constrained motion: those the file gives, those it omits, and those
//! that follow from given momenta.
//!
//! In: what is known of each velocity. Out: all velocities. Never here: coordinates, which are
//! always given.

use super::conditions::Conditions;
use super::constraint_programs::GIVEN_WITHIN;
use super::legendre::LegendreError;
use super::value::Evaluator;
use crate::num::{DoubleDouble, math};

/// A pivot smaller than this, relative to its equation, counts as zero.
const SMALLEST_PIVOT: f64 = 1e-10;

/// The maximal number of corrections, and of halvings of one correction.
const CORRECTIONS: usize = 60;
const HALVINGS: u32 = 60;

#[derive(Clone, Copy, Debug)]
pub(super) enum KnownVelocity {
    /// Its value, which the state contains.
    InitialOverride,
    /// Nothing; the constraints determine it.
    LeftOut,
    /// The momentum conjugate to it.
    Momentum(DoubleDouble),
}

/// Why there is no consistent initial state.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum InconsistentStart {
    /// The given values violate this constraint by this part of its terms.
    Missed(usize, f64),
    /// The constraints do not determine these velocities.
    Free(Vec<usize>),
    /// The given values contradict the constraints.
    Contradiction,
    /// No velocities were found for the given momenta.
    LegendreError(LegendreError),
}

/// Finds the velocities that are not given. `conditions` must have been evaluated at the
/// coordinates.
pub(super) fn begin(
    conditions: &Conditions,
    momenta: &mut Evaluator<DoubleDouble>,
    time: DoubleDouble,
    state: &mut [DoubleDouble],
    known: &[KnownVelocity],
) -> Result<(), InconsistentStart> {
    let n = known.len();
    let unknown: Vec<usize> =
        (0..n).filter(|&i| !matches!(known[i], KnownVelocity::InitialOverride)).collect();
    let mut problem = InitialVelocityProblem { conditions, momenta, time, known, unknown };
    let (missing, _) = problem.missing(state)?;
    let (_, free) = problem.step(&missing);
    if !free.is_empty() {
        return Err(InconsistentStart::Free(free));
    }
    let mut last = f64::INFINITY;
    for _ in 0..CORRECTIONS {
        let (missing, size) = problem.missing(state)?;
        if size <= 1e-29 || (size < 1e-20 && size >= 0.5 * last) || problem.unknown.is_empty() {
            break;
        }
        if problem.is_linear() && last.is_finite() && size >= last {
            break;
        }
        last = size;
        let (step, _) = problem.step(&missing);
        let before = state.to_vec();
        for halving in 0..=HALVINGS {
            let part = math::powi(0.5, halving as i32);
            for (&i, &x) in problem.unknown.iter().zip(&step) {
                state[n + i] = before[n + i] + x * part;
            }
            let better = problem.missing(state).is_ok_and(|(_, new)| new < size || new < 1e-20);
            // an equation that cannot be satisfied is reported below, by its name
            if better || problem.is_linear() {
                break;
            }
            if halving == HALVINGS {
                let equations = conditions.count() + problem.targets().len();
                return Err(if equations > problem.unknown.len() {
                    InconsistentStart::Contradiction
                } else {
                    InconsistentStart::LegendreError(LegendreError::NotConverging)
                });
            }
        }
    }
    for k in 0..conditions.count() {
        let residual = conditions.velocity(k, &state[n..2 * n]).missed();
        if residual.is_nan() || residual > GIVEN_WITHIN {
            return Err(InconsistentStart::Missed(k, residual));
        }
    }
    Ok(())
}

struct InitialVelocityProblem<'a> {
    conditions: &'a Conditions,
    momenta: &'a mut Evaluator<DoubleDouble>,
    time: DoubleDouble,
    known: &'a [KnownVelocity],
    unknown: Vec<usize>,
}

impl InitialVelocityProblem<'_> {
    /// The coordinates whose momenta are given, with these momenta.
    fn targets(&self) -> Vec<(usize, DoubleDouble)> {
        let target = |(i, known): (usize, &KnownVelocity)| match known {
            KnownVelocity::Momentum(p) => Some((i, *p)),
            KnownVelocity::InitialOverride | KnownVelocity::LeftOut => None,
        };
        self.known.iter().enumerate().filter_map(target).collect()
    }

    fn is_linear(&self) -> bool {
        self.targets().is_empty()
    }

    /// The residual of each equation, constraints first, and the largest one relative to its terms.
    fn missing(
        &mut self,
        state: &[DoubleDouble],
    ) -> Result<(Vec<DoubleDouble>, f64), InconsistentStart> {
        let n = self.known.len();
        let evaluated = self.momenta.evaluate(self.time, state);
        let targets = self.targets();
        if !targets.is_empty() {
            evaluated.map_err(|why| InconsistentStart::LegendreError(why.into()))?;
        }
        let mut missing = Vec::new();
        let mut size = 0.0_f64;
        for k in 0..self.conditions.count() {
            let residual = self.conditions.velocity(k, &state[n..2 * n]);
            size = size.max(residual.relative());
            missing.push(-residual.value);
        }
        for (i, target) in targets {
            let p = self.momenta.output(i);
            let value = target - p;
            let rates =
                (0..n).map(|j| (self.momenta.output(n + i * n + j) * state[n + j]).high.abs());
            let terms = p.high.abs() + target.high.abs() + rates.sum::<f64>();
            let part = if value.high == 0.0 { 0.0 } else { value.high.abs() / terms };
            size = if part.is_finite() { size.max(part) } else { f64::INFINITY };
            missing.push(value);
        }
        Ok((missing, size))
    }

    /// The step of the unknown velocities that satisfies the equations as far as possible, and the
    /// coordinates whose velocities remain undetermined. Uses elimination with the largest
    /// remaining entry as pivot (Golub & Van Loan, Matrix Computations, 3.4.8).
    fn step(&self, missing: &[DoubleDouble]) -> (Vec<DoubleDouble>, Vec<usize>) {
        let n = self.known.len();
        let mut rows: Vec<Vec<DoubleDouble>> = Vec::new();
        for k in 0..self.conditions.count() {
            rows.push(self.unknown.iter().map(|&i| self.conditions.entry(k, i)).collect());
        }
        for (i, _) in self.targets() {
            rows.push(self.unknown.iter().map(|&j| self.momenta.output(n + i * n + j)).collect());
        }
        let mut right = missing.to_vec();
        let scales: Vec<f64> =
            rows.iter().map(|row| row.iter().map(|x| x.high.abs()).fold(0.0, f64::max)).collect();
        let mut pivots: Vec<(usize, usize)> = Vec::new();
        loop {
            let mut best: Option<(f64, usize, usize)> = None;
            for (r, row) in rows.iter().enumerate() {
                if pivots.iter().any(|p| p.0 == r) || scales[r] == 0.0 {
                    continue;
                }
                for (c, x) in row.iter().enumerate() {
                    let size = x.high.abs() / scales[r];
                    let free = !pivots.iter().any(|p| p.1 == c);
                    if free && size > best.map_or(SMALLEST_PIVOT, |b| b.0) {
                        best = Some((size, r, c));
                    }
                }
            }
            let Some((_, r, c)) = best else { break };
            for other in 0..rows.len() {
                if other == r || pivots.iter().any(|p| p.0 == other) {
                    continue;
                }
                let factor = rows[other][c] / rows[r][c];
                for j in 0..self.unknown.len() {
                    let product = factor * rows[r][j];
                    rows[other][j] = rows[other][j] - product;
                }
                rows[other][c] = DoubleDouble::ZERO;
                right[other] = right[other] - factor * right[r];
            }
            pivots.push((r, c));
        }
        let mut x = vec![DoubleDouble::ZERO; self.unknown.len()];
        for (place, &(r, c)) in pivots.iter().enumerate().rev() {
            let later = pivots[place + 1..].iter();
            let sum = later.fold(right[r], |sum, &(_, j)| sum - rows[r][j] * x[j]);
            x[c] = sum / rows[r][c];
        }
        let is_free = |c: &usize| !pivots.iter().any(|p| p.1 == *c);
        let free = (0..self.unknown.len()).filter(is_free).map(|c| self.unknown[c]).collect();
        (x, free)
    }
}
