//! The onset of motion against dry friction in more than one direction.
//!
//! A force that turns while it grows beyond static friction accelerates the body as v ≈ a τ²/2, and
//! friction −μ v/|v| holds the direction of so small a velocity with the rate μ/|v|. The formal power
//! series of the motion in the time τ since then is asymptotic, so no Taylor series starts there, and
//! those soon after are short. The polynomial that satisfies the equations of motion at the points
//! τ = h (1 − cos(iπ/s))/2, i = 1 … s, is as close to that series as anything is. Its equations are
//! solved by Newton's method, because friction is too stiff for iterating.
//!
//! In: the state at rest in which static friction is just exceeded, or one before a motion touches rest, a step, the
//! accelerations of a motion that begins at each of the points. Out: the polynomial, or nothing if it was not found.
//! What rest is, and when it ends, is never asked here. Source: E. Hairer, G. Wanner, Solving
//! Ordinary Differential Equations II, IV.8; the points: L. N. Trefethen, Spectral Methods in MATLAB, ch. 6.

use nalgebra::{DMatrix, DVector};

use crate::num::{DoubleDouble, math};
use crate::system::{ExactRates, MotionError, MotionErrorKind, State};

/// The number of points; five points of Gauss integrate its polynomials exactly.
const STAGES: usize = 10;

const ITERATIONS: u32 = 30;

/// A correction below this part of the velocities is the last.
const SETTLED: f64 = 1e-15;

/// A correction that no longer shrinks is the last as well, below this part of the velocities.
const ROUNDING: f64 = 1e-11;

/// The tolerated difference between two such polynomials, relative to the velocity at the end, and the
/// parts of the shorter one at which they are compared, none but the last a point of either.
const AGREEMENT: f64 = 1e-14;
const COMPARED: [f64; 4] = [0.23, 0.61, 0.87, 1.0];

/// The part of the velocity by which it is varied for a derivative, and that part of the others by which
/// a component that is zero is varied.
const VARIED: f64 = 1e-8;
const LEAST: f64 = 1e-6;

/// Gauss's five points on [−1, 1], and their weights.
pub(super) const POINTS: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.906_179_845_938_664, 0.236_926_885_056_189_08),
];

/// The beginning of a motion, as a polynomial in time.
#[derive(Debug)]
pub(super) struct Onset {
    from: State,
    /// What the velocities or momenta are at rest, from which small ones are measured.
    rest: Vec<DoubleDouble>,
    step: f64,
    /// The rates of all numbers at the points, one row for each point.
    rates: Vec<Vec<f64>>,
}

/// The points, as parts of a step.
pub(super) fn points() -> [f64; STAGES] {
    std::array::from_fn(|i| {
        let half = math::sin(std::f64::consts::PI * (i + 1) as f64 / (2 * STAGES) as f64);
        half * half
    })
}

/// The integrals of the Lagrange polynomials of the points from 0 to `end`.
fn weights(end: f64) -> [f64; STAGES] {
    let points = points();
    let mut weights = [0.0; STAGES];
    for (place, weight) in POINTS {
        let x = 0.5 * end * (1.0 + place);
        for (j, sum) in weights.iter_mut().enumerate() {
            let others = points.iter().enumerate().filter(|(m, _)| *m != j);
            let lagrange: f64 = others.map(|(_, c)| (x - c) / (points[j] - c)).product();
            *sum += 0.5 * end * weight * lagrange;
        }
    }
    weights
}

impl Onset {
    /// Finds the polynomial over a step from a state; `static_friction` is the one at rest, with as many velocities or momenta
    /// as `degrees`. `accelerations` are those with which a motion would begin at each of the points.
    pub(super) fn new(
        rates: &mut ExactRates,
        (from, still): (&State, &State),
        degrees: usize,
        step: f64,
        accelerations: &[Vec<f64>],
    ) -> Result<Option<Onset>, MotionError> {
        let len = from.values.len();
        let mut stages = vec![vec![0.0; len]; STAGES];
        for (stage, found) in stages.iter_mut().zip(accelerations) {
            stage[degrees..2 * degrees].copy_from_slice(found);
        }
        let rest = (degrees..2 * degrees).map(|i| still.exact(i)).collect();
        let mut onset = Onset { from: from.clone(), rest, step, rates: stages };
        let inner = points().map(weights);
        let mut before = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let Some(moved) = onset.correct(rates, degrees, &inner)? else { return Ok(None) };
            if moved <= SETTLED || (moved <= ROUNDING && moved >= before) {
                let settled = onset.take_rates(rates, degrees, &inner)?;
                return Ok(settled.then_some(onset));
            }
            before = moved;
        }
        Ok(None)
    }

    /// One Newton correction of the accelerations at the points, and the other rates there. Returns
    /// the greatest change of an acceleration or a velocity, relative to the greatest of its kind.
    fn correct(
        &mut self,
        rates: &mut ExactRates,
        degrees: usize,
        inner: &[[f64; STAGES]; STAGES],
    ) -> Result<Option<f64>, MotionError> {
        let size = STAGES * degrees;
        let (mut matrix, mut defect) = (DMatrix::identity(size, size), DVector::zeros(size));
        let mut found = self.rates.clone();
        for (s, weights) in inner.iter().enumerate() {
            let (time, numbers) = self.place(points()[s], weights);
            if !evaluate(rates, time, &numbers)? {
                return Ok(None);
            }
            for (i, x) in found[s].iter_mut().enumerate() {
                *x = rates.rate(i).high;
            }
            let there: Vec<DoubleDouble> = (degrees..2 * degrees).map(|i| rates.rate(i)).collect();
            for (i, &rate) in there.iter().enumerate() {
                let slope = self.rates[s][degrees + i];
                defect[s * degrees + i] = (rate - DoubleDouble::from(slope)).high;
            }
            let velocity = |i: usize| (numbers[degrees + i] - self.rest[i]).high;
            let fastest = (0..degrees).fold(0.0_f64, |m, i| m.max(velocity(i).abs()));
            for j in 0..degrees {
                let varied = VARIED * velocity(j).abs().max(LEAST * fastest);
                let mut beside = numbers.clone();
                beside[degrees + j] = beside[degrees + j] + DoubleDouble::from(varied);
                if !evaluate(rates, time, &beside)? {
                    return Ok(None);
                }
                for (i, &before) in there.iter().enumerate() {
                    let slope = (rates.rate(degrees + i) - before).high / varied;
                    for (k, weight) in weights.iter().enumerate() {
                        let column = k * degrees + j;
                        matrix[(s * degrees + i, column)] -= slope * self.step * weight;
                    }
                }
            }
        }
        let Some(change) = matrix.lu().solve(&defect) else { return Ok(None) };
        // the places follow the velocities: they are not settled before these are
        let mut moved = 0.0_f64;
        for i in 0..degrees {
            let largest = found.iter().fold(0.0_f64, |m, row| m.max(row[i].abs()));
            let changes = self.rates.iter().zip(&found).map(|(own, row)| (own[i] - row[i]).abs());
            let most = changes.fold(0.0_f64, |m, x| if x.is_nan() { x } else { m.max(x) });
            if !most.is_finite() {
                return Ok(None);
            }
            if most > 0.0 {
                moved = moved.max(most / largest.max(most));
            }
        }
        for i in 0..degrees {
            let slope = |s: usize| self.rates[s][degrees + i];
            let largest = (0..STAGES).fold(0.0_f64, |m, s| m.max(slope(s).abs()));
            let changes = (0..STAGES).map(|s| change[s * degrees + i].abs());
            let most = changes.fold(0.0_f64, |m, x| if x.is_nan() { x } else { m.max(x) });
            if !most.is_finite() {
                return Ok(None);
            }
            if most > 0.0 {
                moved = moved.max(most / largest.max(most));
            }
        }
        for (s, (own, found)) in self.rates.iter_mut().zip(found).enumerate() {
            for (i, (own, found)) in own.iter_mut().zip(found).enumerate() {
                let place = i.checked_sub(degrees).filter(|&i| i < degrees);
                *own = place.map_or(found, |i| *own + change[s * degrees + i]);
            }
        }
        Ok(Some(moved))
    }

    /// Takes the rates that are not accelerations at the points found. Returns whether all are finite.
    fn take_rates(
        &mut self,
        rates: &mut ExactRates,
        degrees: usize,
        inner: &[[f64; STAGES]; STAGES],
    ) -> Result<bool, MotionError> {
        for (s, weights) in inner.iter().enumerate() {
            let (time, numbers) = self.place(points()[s], weights);
            if !evaluate(rates, time, &numbers)? {
                return Ok(false);
            }
            for (i, x) in self.rates[s].iter_mut().enumerate() {
                if !(degrees..2 * degrees).contains(&i) {
                    *x = rates.rate(i).high;
                }
            }
        }
        Ok(self.rates.iter().flatten().all(|x| x.is_finite()))
    }

    /// The time and the numbers at a part of the step, whose integrals are these.
    fn place(&self, part: f64, weights: &[f64; STAGES]) -> (DoubleDouble, Vec<DoubleDouble>) {
        let time = self.from.exact_time() + DoubleDouble::product(self.step, part);
        let sum = |i: usize| -> f64 { self.rates.iter().zip(weights).map(|(k, w)| k[i] * w).sum() };
        let numbers = (0..self.from.values.len())
            .map(|i| self.from.exact(i) + DoubleDouble::product(self.step, sum(i)))
            .collect();
        (time, numbers)
    }

    /// Whether a polynomial over half the step is the same there.
    pub(super) fn agrees(&self, half: &Onset, degrees: usize) -> bool {
        let velocities = degrees..2 * degrees;
        let (_, end) = self.place(1.0, &weights(1.0));
        let speed = |i: usize| (end[i] - self.from.exact(i)).high.abs();
        let fastest = velocities.clone().fold(0.0_f64, |m, i| m.max(speed(i)));
        COMPARED.iter().all(|&part| {
            let (_, here) = self.place(0.5 * part, &weights(0.5 * part));
            let (_, there) = half.place(part, &weights(part));
            velocities.clone().all(|i| (here[i] - there[i]).high.abs() <= AGREEMENT * fastest)
        })
    }

    /// The time at which the polynomial begins.
    pub(super) fn begin(&self) -> DoubleDouble {
        self.from.exact_time()
    }

    /// The time up to which it holds.
    pub(super) fn end(&self) -> DoubleDouble {
        self.begin() + DoubleDouble::from(self.step)
    }

    pub(super) fn at(&self, time: DoubleDouble) -> State {
        let part = ((time - self.begin()).high / self.step).clamp(0.0, 1.0);
        let (_, numbers) = self.place(part, &weights(part));
        let mut state = self.from.clone();
        for (i, &x) in numbers.iter().enumerate() {
            state.set(i, x);
        }
        (state.time, state.time_carry) = (time.high, time.low);
        state
    }
}

/// Evaluates the rates; returns false where they have no value.
fn evaluate(
    rates: &mut ExactRates,
    time: DoubleDouble,
    numbers: &[DoubleDouble],
) -> Result<bool, MotionError> {
    match rates.evaluate(time, numbers) {
        Ok(()) => Ok(true),
        Err(error) if error.kind == MotionErrorKind::Cancelled => Err(error),
        Err(_) => Ok(false),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_polynomials_agree_to_1e_14_of_the_velocity_at_the_end() {
        // x'' = 1, and so much more over the first half: the velocities at its end differ by half of that
        let onset = |step: f64, acceleration: f64| Onset {
            from: State::new(0.0, crate::system::Form::Velocity, vec![0.0; 2]),
            rest: vec![DoubleDouble::ZERO],
            step,
            rates: vec![vec![0.0, acceleration]; STAGES],
        };
        for (more, agrees) in
            [(1.8e-14, true), (-1.8e-14, true), (2.2e-14, false), (-2.2e-14, false)]
        {
            let (whole, half) = (onset(1.0, 1.0), onset(0.5, 1.0 + more));
            assert_eq!(whole.agrees(&half, 1), agrees, "{more:e}");
        }
    }

    #[test]
    fn powers_up_to_the_ninth_are_integrated_exactly() {
        for power in 0..10 {
            for end in [0.3, 1.0] {
                let weights = weights(end);
                let sum: f64 =
                    points().iter().zip(weights).map(|(c, w)| w * math::powi(*c, power)).sum();
                let exact = math::powi(end, power + 1) / f64::from(power + 1);
                assert!((sum - exact).abs() < 1e-15, "∫ t^{power} to {end}: {sum}, not {exact}");
            }
        }
    }
}
