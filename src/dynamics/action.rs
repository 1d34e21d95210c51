//! The action ∫ L dt of paths, and its first and second derivatives.
//!
//! In: a system with its Lagrangian, a path. Out: numbers. Never here: which paths.

use nalgebra::{DMatrix, DVector};

use super::error::DynamicsError;
use super::lobatto::Lobatto;

use crate::cancel::Cancel;
use crate::expr::{Expr, Pool, Symbol};
use crate::mechanics::{Equations, body_constants};
use crate::model::Model;
use crate::num::{DoubleDouble, gauss};
use crate::system::{Evaluator, Program};

/// The operations that searches for a path may take beside the first: some seconds.
const BUDGET: f64 = 1e10;

/// A sum is no more than rounding up to this part of the size of its terms.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// An integral over parts is settled once halving them changes no more than this part of its terms.
const SETTLED: f64 = 4e-15;

/// The most parts of an integral across corners that are halved.
const MOST_PARTS: usize = 8192;

/// A Lagrangian at fixed parameters, as a function of (t, q, q̇).
pub struct Lagrangian {
    degrees: usize,
    values: Evaluator<f64>,
    /// By q, by q̇, and by the time.
    first: Evaluator<f64>,
    second: Evaluator<f64>,
    pub(super) timed: bool,
    start: f64,
    /// The number of kinks of its values.
    switches: usize,
    cancel: Cancel,
    /// What its expansions took, see [`Lagrangian::work`], and when a search ends.
    work: f64,
    most_work: f64,
    /// The operations that a search may take which begins elsewhere than at the straight line.
    pub budget: f64,
}

/// A path: q and q̇ at a time from its beginning.
pub trait Path {
    /// q, then q̇.
    fn at(&mut self, time: f64) -> Vec<f64>;
}

impl<F: FnMut(f64) -> Vec<f64>> Path for F {
    fn at(&mut self, time: f64) -> Vec<f64> {
        self(time)
    }
}

/// Functions of the time and these inputs at fixed parameters.
pub(super) fn compiled(
    pool: &mut Pool,
    (model, parameters): (&Model, &[f64]),
    inputs: &[Symbol],
    outputs: &[Expr],
) -> Result<Evaluator<f64>, DynamicsError> {
    let given = model.parameters.iter().zip(parameters).map(|(p, &value)| (p.symbol, value));
    let named = given.chain(body_constants(model, parameters));
    let (symbols, values): (Vec<Symbol>, Vec<DoubleDouble>) =
        named.map(|(symbol, value)| (symbol, DoubleDouble::from_decimal(value))).unzip();
    let program = Program::compile(pool, &symbols, model.symbols.time, inputs, outputs)
        .map_err(|_| unsuited("the law has no value where it is used"))?;
    let mut evaluator = Evaluator::new(program);
    evaluator.set_parameters(&values);
    Ok(evaluator)
}

/// The action of a path on nodes with its derivatives by the inner nodes.
pub(super) struct ActionExpansion {
    pub(super) action: f64,
    pub(super) gradient: DVector<f64>,
    pub(super) hessian: DMatrix<f64>,
    /// The mean of the largest entry of ∂²L/∂q̇².
    pub(super) inertia: f64,
}

pub(super) fn unsuited(why: &str) -> DynamicsError {
    DynamicsError::Unsuited(why.to_owned())
}

impl Lagrangian {
    /// The Lagrangian of a model; of a Hamiltonian system by the inverse Legendre transform.
    ///
    /// # Errors
    /// Returns an error if there is none, or the system is subject to constraints.
    pub fn of(
        model: &Model,
        equations: &mut Equations,
        parameters: &[f64],
    ) -> Result<Lagrangian, DynamicsError> {
        if model.is_poisson() {
            return Err(unsuited("variables given by their brackets have no Lagrangian"));
        }
        if !model.constraints.is_empty() {
            return Err(unsuited(
                "a path subject to constraints is not varied freely: choose coordinates that need none",
            ));
        }
        let lagrangian = equations
            .lagrangian()
            .clone()
            .map_err(|why| unsuited(&format!("there is no Lagrangian: {why}")))?;
        let n = model.coordinates.len();
        let positions = model.coordinates.iter().map(|c| c.position);
        let inputs: Vec<Symbol> =
            positions.chain(model.coordinates.iter().map(|c| c.velocity)).collect();
        let timed = equations.pool.depends(lagrangian, model.symbols.time);
        let pool = &mut equations.pool;
        let mut slopes: Vec<Expr> =
            inputs.iter().map(|&s| pool.derivative(lagrangian, s)).collect();
        let mut curvatures = Vec::new();
        for (i, &slope) in slopes.iter().enumerate() {
            for &s in &inputs[..=i] {
                curvatures.push(pool.derivative(slope, s));
            }
        }
        slopes.push(pool.derivative(lagrangian, model.symbols.time));
        let mut program = |outputs: &[Expr]| compiled(pool, (model, parameters), &inputs, outputs);
        let values = program(&[lagrangian])?;
        Ok(Lagrangian {
            degrees: n,
            switches: values.switches(),
            values,
            first: program(&slopes)?,
            second: program(&curvatures)?,
            timed,
            start: model.run.start,
            cancel: Cancel::new(),
            work: 0.0,
            most_work: f64::INFINITY,
            budget: BUDGET,
        })
    }

    /// This Lagrangian for paths that begin at this time instead of the start of the file.
    #[must_use]
    pub fn beginning_at(self, start: f64) -> Lagrangian {
        Lagrangian { start, ..self }
    }

    /// This Lagrangian with a token that ends its searches soon after it is set.
    #[must_use]
    pub fn with_cancel(self, cancel: Cancel) -> Lagrangian {
        Lagrangian { cancel, ..self }
    }

    /// A search that ends when it has taken the budget.
    pub(super) fn within_budget<T>(&mut self, search: impl FnOnce(&mut Lagrangian) -> T) -> T {
        self.most_work = self.work + self.budget;
        let outcome = search(self);
        self.most_work = f64::INFINITY;
        outcome
    }

    /// Whether a search has to end: it is cancelled, or has taken its budget.
    pub(super) fn is_over(&self) -> bool {
        self.is_cancelled() || self.work > self.most_work
    }

    /// Whether searches are to end.
    pub fn is_cancelled(&self) -> bool {
        self.cancel.is_cancelled()
    }

    /// The number of coordinates.
    pub fn degrees(&self) -> usize {
        self.degrees
    }

    /// The operations that the expansions along all paths so far took, each with the evaluations of L's derivatives at the nodes, their
    /// sums and the elimination of the unknowns.
    pub fn work(&self) -> f64 {
        self.work
    }

    pub(super) fn has_switches(&self) -> bool {
        self.switches > 0
    }

    /// On which side of each kink it is at a time from the beginning of a path.
    pub(super) fn switches(&mut self, time: f64, state: &[f64]) -> Vec<bool> {
        // where L has no value there is no side
        let known = self.values.evaluate(self.start + time, state).is_ok();
        (0..self.switches).map(|i| known && self.values.switch(i) > 0.0).collect()
    }

    /// L at a time from the beginning of a path.
    pub(super) fn value(&mut self, time: f64, state: &[f64]) -> f64 {
        match self.values.evaluate(self.start + time, state) {
            Ok(()) => self.values.output(0),
            Err(_) => f64::NAN,
        }
    }

    /// ∂L/∂q of a coordinate.
    pub(super) fn force(&mut self, time: f64, state: &[f64], coordinate: usize) -> f64 {
        self.slope(time, state, coordinate)
    }

    /// ∂L/∂t.
    pub(super) fn explicit_rate(&mut self, time: f64, state: &[f64]) -> f64 {
        self.slope(time, state, 2 * self.degrees)
    }

    fn slope(&mut self, time: f64, state: &[f64], index: usize) -> f64 {
        match self.first.evaluate(self.start + time, state) {
            Ok(()) => self.first.output(index),
            Err(_) => f64::NAN,
        }
    }

    /// ∂L/∂q̇.
    pub fn momenta(&mut self, time: f64, state: &[f64]) -> Vec<f64> {
        let n = self.degrees;
        match self.first.evaluate(self.start + time, state) {
            Ok(()) => (n..2 * n).map(|i| self.first.output(i)).collect(),
            Err(_) => vec![f64::NAN; n],
        }
    }

    /// Jacobi's h = Σ q̇ ∂L/∂q̇ − L.
    pub fn energy(&mut self, time: f64, state: &[f64]) -> f64 {
        let momenta = self.momenta(time, state);
        let product: f64 = momenta.iter().zip(&state[self.degrees..]).map(|(p, v)| p * v).sum();
        product - self.value(time, state)
    }

    /// ∫ L dt along a path of a duration, by Gauss's rule on parts that are halved until nothing
    /// changes.
    ///
    /// # Errors
    /// Returns an error if L is not finite on the path, or the integral does not settle.
    pub fn action(&mut self, path: &mut dyn Path, duration: f64) -> Result<f64, DynamicsError> {
        self.integral(path, duration, &mut Lagrangian::value)
    }

    /// The integral of a function of (t, state) along a path, by the same rule.
    pub(super) fn integral(
        &mut self,
        path: &mut dyn Path,
        duration: f64,
        integrand: &mut dyn FnMut(&mut Lagrangian, f64, &[f64]) -> f64,
    ) -> Result<f64, DynamicsError> {
        let rule = gauss(12);
        let mut before = f64::NAN;
        let mut parts = 2;
        while parts <= 4096 {
            let width = duration / f64::from(parts);
            let (mut sum, mut lost, mut size) = (0.0_f64, 0.0_f64, 0.0_f64);
            for part in 0..parts {
                for &(x, weight) in &rule {
                    let time = width * (f64::from(part) + x);
                    let state = path.at(time);
                    let term = width * weight * integrand(self, time, &state);
                    size += term.abs();
                    // compensated, so that many parts lose no digits
                    let corrected = term - lost;
                    let total = sum + corrected;
                    lost = (total - sum) - corrected;
                    sum = total;
                }
            }
            if !sum.is_finite() {
                return Err(unsuited("L is not finite on this path"));
            }
            if (sum - before).abs() <= SETTLED * size {
                // terms that cancel leave their rounding
                return Ok(if sum.abs() <= ROUNDING * size { 0.0 } else { sum });
            }
            before = sum;
            parts *= 2;
        }
        Err(unsuited(
            "the integral along this path does not settle: what is integrated is not smooth",
        ))
    }

    /// The integral of a function that may have corners, such as the root of a square, to a part of its terms: only the parts
    /// that still change are halved.
    pub(super) fn integral_across_corners(
        &mut self,
        path: &mut dyn Path,
        duration: f64,
        settled: f64,
        integrand: &mut dyn FnMut(&mut Lagrangian, f64, &[f64]) -> f64,
    ) -> Result<f64, DynamicsError> {
        let rule = gauss(12);
        let mut over = |from: f64, width: f64| {
            let terms = rule.iter().map(|&(x, weight)| {
                let time = from + width * x;
                width * weight * integrand(self, time, &path.at(time))
            });
            terms.fold([0.0_f64, 0.0], |[sum, size], term| [sum + term, size + term.abs()])
        };
        let mut open = Vec::new();
        let mut size = 0.0;
        for part in 0..4 {
            let (width, part) = (0.25 * duration, f64::from(part));
            let [sum, of_part] = over(part * width, width);
            size += of_part;
            open.push((part * width, width, sum));
        }
        let (mut sum, mut parts) = (0.0, 0);
        while let Some((from, width, before)) = open.pop() {
            let half = 0.5 * width;
            let ([first, _], [second, _]) = (over(from, half), over(from + half, half));
            if !(first + second).is_finite() {
                return Err(unsuited("L is not finite on this path"));
            }
            if (first + second - before).abs() <= settled * size {
                sum += first + second;
            } else {
                open.extend([(from, half, first), (from + half, half, second)]);
            }
            parts += 1;
            if parts > MOST_PARTS {
                return Err(unsuited("the integral along this path does not settle"));
            }
        }
        Ok(sum)
    }

    /// The action of a path given at nodes, column by column, with its derivatives; `None` where it has none, or once a search
    /// is over.
    pub(super) fn expand(
        &mut self,
        rule: &Lobatto,
        path: &DMatrix<f64>,
        duration: f64,
    ) -> Option<ActionExpansion> {
        if self.is_over() {
            return None;
        }
        let (n, last) = (self.degrees, rule.nodes.len() - 1);
        let unknowns = (n * (last - 1)) as f64;
        let evaluators = [&self.values, &self.first, &self.second];
        let evaluation = evaluators.map(Evaluator::operations).iter().sum::<usize>() as f64;
        let nodes = rule.nodes.len() as f64;
        // of each node half of the second derivatives, of four products each
        self.work += nodes * evaluation + (2.0 * nodes + unknowns) * unknowns * unknowns;
        let rate = 2.0 / duration;
        let velocities = path * rule.derivative.transpose() * rate;
        let inner = last - 1;
        let mut gradient: DVector<f64> = DVector::zeros(n * inner);
        let mut hessian: DMatrix<f64> = DMatrix::zeros(n * inner, n * inner);
        let (mut action, mut inertia) = (0.0, 0.0);
        let mut state = vec![0.0; 2 * n];
        for k in 0..=last {
            if self.is_cancelled() {
                return None;
            }
            let time = 0.5 * duration * (1.0 + rule.nodes[k]);
            for a in 0..n {
                state[a] = path[(a, k)];
                state[n + a] = velocities[(a, k)];
            }
            let weight = 0.5 * duration * rule.weights[k];
            let value = self.value(time, &state);
            action += weight * value;
            self.first.evaluate(self.start + time, &state).ok()?;
            self.second.evaluate(self.start + time, &state).ok()?;
            let first = |i: usize| self.first.output(i);
            let second = |i: usize, j: usize| {
                let (i, j) = (i.max(j), i.min(j));
                self.second.output(i * (i + 1) / 2 + j)
            };
            inertia +=
                weight / duration * (0..n).map(|a| second(n + a, n + a).abs()).fold(0.0, f64::max);
            let slope = |j: usize| rate * rule.derivative[(k, j + 1)];
            for j in 0..inner {
                let own = f64::from(u8::from(j + 1 == k));
                for a in 0..n {
                    gradient[j * n + a] += weight * (own * first(a) + slope(j) * first(n + a));
                }
                for l in 0..=j {
                    let other = f64::from(u8::from(l + 1 == k));
                    for a in 0..n {
                        for b in 0..n {
                            hessian[(j * n + a, l * n + b)] += weight
                                * (own * other * second(a, b)
                                    + own * slope(l) * second(a, n + b)
                                    + slope(j) * other * second(n + a, b)
                                    + slope(j) * slope(l) * second(n + a, n + b));
                        }
                    }
                }
            }
        }
        hessian.fill_upper_triangle_with_lower_triangle();
        let finite = action.is_finite()
            && gradient.iter().chain(hessian.iter()).all(|x: &f64| x.is_finite());
        finite.then_some(ActionExpansion { action, gradient, hessian, inertia })
    }
}
