//! Constraints as numbers: how far a state is from keeping them, and which of them are independent.
//!
//! In: a state (q, q̇). Out: residuals of f(q, t) and A q̇ + A₀, each beside the size of its
//! terms. Never here: what is done about them; that is in `kept`.

use std::sync::Arc;

use super::motion::Writer;
use super::program::Program;
use super::solve::Factored;
use super::value::Values;
use crate::expr::{Double, Expr, Symbol};

/// A row whose part independent of the rows before it is smaller than this, measured by the row,
/// says nothing new.
const INDEPENDENT: f64 = 1e-9;

/// The program of (q, t): of each constraint A, A₀ and f, then the sizes of their terms.
pub(super) fn program(writer: &mut Writer<'_>) -> Result<Arc<Program>, Symbol> {
    let mut outputs = Vec::new();
    for row in &writer.equations.constraints {
        let mut values = row.row.clone();
        values.push(row.rate);
        values.push(row.position.unwrap_or(Expr::ZERO));
        outputs.extend_from_slice(&values);
        outputs.extend(values.into_iter().map(|e| writer.pool.size_of_terms(e)));
    }
    let equations = writer.equations;
    let mut lowering = writer.lowering();
    for c in &equations.coordinates {
        let register = lowering.input();
        lowering.bind(c.position, register);
    }
    let outputs = lowering.lower_all(&outputs);
    lowering.finish(outputs)
}

/// A residual, and the size of the terms it is the sum of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Residual {
    pub(super) value: Double,
    pub(super) size: f64,
}

impl Residual {
    /// The residual measured by its terms; zero where there are none.
    pub(super) fn relative(self) -> f64 {
        if self.value.high == 0.0 { 0.0 } else { (self.value.high / self.size).abs() }
    }
}

/// The constraints of one system at one set of parameters.
#[derive(Clone, Debug)]
pub(super) struct Conditions {
    values: Values<Double>,
    degrees: usize,
    count: usize,
}

impl Conditions {
    pub(super) fn new(program: Arc<Program>, count: usize) -> Conditions {
        let degrees = program.inputs();
        Conditions { values: Values::new(program), degrees, count }
    }

    pub(super) fn set_parameters(&mut self, parameters: &[Double]) {
        self.values.set_parameters(parameters);
    }

    /// How many coordinates there are.
    pub(super) fn degrees(&self) -> usize {
        self.degrees
    }

    /// How many constraints there are.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// Looks at a time and coordinates; all else is told of these.
    pub(super) fn look(&mut self, time: Double, positions: &[Double]) {
        // the program holds no equations to be solved, so it cannot meet a singular matrix
        let _regular = self.values.evaluate(time, &positions[..self.degrees]);
    }

    fn output(&self, constraint: usize, place: usize) -> Double {
        self.values.output(constraint * 2 * (self.degrees + 2) + place)
    }

    /// The size of the terms of what stands at this place.
    fn size(&self, constraint: usize, place: usize) -> f64 {
        self.output(constraint, self.degrees + 2 + place).high
    }

    /// A of one constraint and one coordinate.
    pub(super) fn entry(&self, constraint: usize, coordinate: usize) -> Double {
        self.output(constraint, coordinate)
    }

    /// A₀ of one constraint.
    pub(super) fn rate(&self, constraint: usize) -> Double {
        self.output(constraint, self.degrees)
    }

    /// f of a holonomic constraint, zero of others.
    pub(super) fn position(&self, constraint: usize) -> Residual {
        let value = self.output(constraint, self.degrees + 1);
        Residual { value, size: self.size(constraint, self.degrees + 1) }
    }

    /// A q̇ + A₀.
    pub(super) fn velocity(&self, constraint: usize, velocities: &[Double]) -> Residual {
        let mut value = self.output(constraint, self.degrees);
        let mut size = self.size(constraint, self.degrees);
        for (i, &v) in velocities.iter().enumerate() {
            value = value + self.entry(constraint, i) * v;
            size += self.size(constraint, i) * v.high.abs();
        }
        Residual { value, size }
    }

    /// The multipliers of least norm of all `active` constraints that do what those of the `held`
    /// ones do: λ = B (BᵀB)⁻¹ G ν, as in `hold`.
    pub(super) fn least(
        &self,
        active: &[bool],
        held: &[bool],
        held_only: Vec<Double>,
    ) -> Vec<Double> {
        if active == held {
            return held_only;
        }
        let rows = |which: &[bool]| (0..self.count).filter(|&k| which[k]).collect::<Vec<_>>();
        let (all, independent) = (rows(active), rows(held));
        let product = |a: usize, b: usize| {
            let terms = (0..self.degrees).map(|i| self.entry(a, i) * self.entry(b, i));
            terms.fold(Double::ZERO, |sum, x| sum + x)
        };
        let sum = |terms: &mut dyn Iterator<Item = Double>| terms.fold(Double::ZERO, |s, x| s + x);
        let b: Vec<Vec<Double>> =
            all.iter().map(|&k| independent.iter().map(|&j| product(k, j)).collect()).collect();
        let force =
            |&j: &usize| sum(&mut independent.iter().map(|&k| product(j, k) * held_only[k]));
        let mut weights: Vec<Double> = independent.iter().map(force).collect();
        let mut factored = Factored::new(independent.len());
        if !factored.factor(|i, j| sum(&mut b.iter().map(|row| row[i] * row[j]))) {
            return held_only;
        }
        factored.solve(&mut weights);
        let mut least = vec![Double::ZERO; self.count];
        for (&k, row) in all.iter().zip(&b) {
            least[k] = sum(&mut row.iter().zip(&weights).map(|(&x, &w)| x * w));
        }
        least
    }

    /// Which of the `active` constraints are independent of those before them, by Gram and
    /// Schmidt's construction.
    pub(super) fn independent(&self, active: &[bool]) -> Vec<bool> {
        let mut basis: Vec<Vec<f64>> = Vec::new();
        let mut chosen = vec![false; self.count];
        for k in (0..self.count).filter(|&k| active[k]) {
            let row: Vec<f64> = (0..self.degrees).map(|i| self.entry(k, i).high).collect();
            let size = norm(&row);
            let mut rest = row;
            // twice is enough (Golub & Van Loan, Matrix Computations, 5.2.9)
            for other in basis.iter().chain(&basis) {
                let part: f64 = rest.iter().zip(other).map(|(x, y)| x * y).sum();
                rest.iter_mut().zip(other).for_each(|(x, y)| *x -= part * y);
            }
            let left = norm(&rest);
            // a row of zeros is a singular place, not a repetition
            chosen[k] = size == 0.0 || left > INDEPENDENT * size || !size.is_finite();
            if left > 0.0 && chosen[k] {
                basis.push(rest.iter().map(|x| x / left).collect());
            }
        }
        chosen
    }
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}
