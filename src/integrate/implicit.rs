//! Implicit Runge–Kutta methods in canonical form, whose stages are solved for by iteration.
//!
//! Y_i = y + h Σ_j a_ij f(t + c_i h, Y_j) is solved by iteration, and y moves by h Σ_j b_j f(Y_j).
//! In a partitioned method the momenta alone move to the stages, and all else stays at y.
//!
//! - The iteration starts from the extrapolated polynomial of the step before.
//! - It ends at [rounding](super::convergence).
//! - The last pass uses all digits of the coefficients, and sums are compensated, for the same
//!   reason: energy then performs a random walk.
//!
//! In: a tableau, a system. Out: a scheme of fixed step. Never here: the rows of the table.
//!
//! Sources: E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration, II.1.3, VI.1.1,
//! VIII.6; E. Hairer, R. McLachlan, A. Razakarivony, BIT Numerical Mathematics 48 (2008) 231.

use super::convergence::{
    MOVING, PASSES, PASSES_PER_ROUND, RESUMES, ROUNDINGS, SMALL, bound_after, size_of,
};
use super::fixed::Scheme;
use super::method::{Method, MethodError};
use super::roundoff;
use super::stage_lanes::StageLanes;
use super::tableau::Tableau;
use crate::num::{DoubleDouble, Kernel, vectorized};
use crate::system::{Form, MotionError, MotionErrorKind, Rates, State, System};

/// Checks that the method has the properties it is chosen for.
pub(super) fn fits(method: &Method, system: &System) -> Result<(), MethodError> {
    if system.constraints() > 0 {
        let reason = "the motion is subject to constraints, and would no longer be symplectic";
        return Err(MethodError { method: method.name, reason: reason.to_owned() });
    }
    Ok(())
}

#[derive(Clone)]
pub(super) struct Implicit {
    rates: Rates,
    tableau: Tableau,
    /// The numbers that stay as they are at the stages of a partitioned method.
    stays: Vec<bool>,
    /// The slopes at the stages, one stage after the other; before a step those of the step before, if `contiguous`.
    slopes: Vec<f64>,
    contiguous: bool,
    stages: Vec<f64>,
    /// The movement of each number in the last pass, and in the one before.
    moves: Vec<f64>,
    moves_before: Vec<f64>,
    /// The movement up to which each number has come to rest; negative where it has not.
    resting: Vec<f64>,
    /// The largest movement of any number, in units of its size, in the last two passes.
    largest: [f64; 2],
    /// The effect of rounding on each rate, computed on demand.
    noise: Vec<f64>,
    sizes: Vec<f64>,
    scratch: Vec<f64>,
    /// The stages side by side, where they may be, and whether the last step was taken there.
    lanes: Option<Box<StageLanes>>,
    in_lanes: bool,
}

impl Implicit {
    pub(super) fn new(system: &System, tableau: Tableau) -> Implicit {
        Implicit::with_staying(system, tableau, vec![false; system.state_len()])
    }

    fn with_staying(system: &System, tableau: Tableau, stays: Vec<bool>) -> Implicit {
        let (s, n) = (tableau.nodes.len(), system.state_len());
        let zeros = vec![0.0; s * n];
        let rates = system.canonical_rates();
        Implicit {
            lanes: StageLanes::new(&rates, &tableau, &stays).map(Box::new),
            in_lanes: false,
            rates,
            tableau,
            stays,
            slopes: zeros.clone(),
            contiguous: false,
            stages: zeros.clone(),
            moves: zeros.clone(),
            moves_before: zeros.clone(),
            resting: vec![MOVING; s * n],
            largest: [f64::INFINITY; 2],
            noise: vec![0.0; n],
            sizes: vec![0.0; n],
            scratch: zeros,
        }
    }

    /// The same, partitioned: the momenta, and those of tangent vectors, alone move to the stages.
    pub(super) fn partitioned(system: &System, tableau: Tableau) -> Implicit {
        let mut stays = vec![true; system.state_len()];
        let (degrees, moving) = (system.degrees(), system.moving());
        let vectors = (0..system.tangents()).map(|vector| system.tangent_place(vector));
        for first in std::iter::once(0).chain(vectors) {
            stays[first + degrees..first + moving].fill(false);
        }
        Implicit::with_staying(system, tableau, stays)
    }

    /// The initial slopes: the extrapolated polynomial of the last step, or else the slope at the
    /// beginning.
    fn guess(&mut self, state: &State) -> Result<(), MotionError> {
        let n = state.values.len();
        if !self.contiguous {
            for slope in self.slopes.chunks_exact_mut(n) {
                self.rates.evaluate(state.time, &state.values, slope)?;
            }
            return Ok(());
        }
        for (weights, guess) in self.tableau.onward.iter().zip(self.scratch.chunks_exact_mut(n)) {
            combine(weights.iter().copied(), &self.slopes, guess);
        }
        std::mem::swap(&mut self.slopes, &mut self.scratch);
        Ok(())
    }

    /// Computes the stages from the slopes.
    fn place(&mut self, step: f64, state: &State) {
        let n = state.values.len();
        for (weights, stage) in self.tableau.matrix.iter().zip(self.stages.chunks_exact_mut(n)) {
            combine(weights.iter().map(|a| a.high), &self.slopes, stage);
            for (i, x) in stage.iter_mut().enumerate() {
                *x = if self.stays[i] {
                    state.exact(i).high
                } else {
                    state.values[i] + (state.carry[i] + step * *x)
                };
            }
        }
    }

    fn evaluate(&mut self, step: f64, state: &State) -> Result<(), MotionError> {
        let n = state.values.len();
        let stages = self.stages.chunks_exact(n).zip(self.slopes.chunks_exact_mut(n));
        for (c, (stage, slope)) in self.tableau.nodes.iter().zip(stages) {
            self.rates.evaluate(state.time + c.high * step, stage, slope)?;
        }
        Ok(())
    }

    /// Performs one pass. Returns whether all numbers have converged.
    fn pass(&mut self, count: usize, step: f64, state: &State) -> Result<bool, MotionError> {
        self.evaluate(step, state)?;
        self.scratch.copy_from_slice(&self.stages);
        self.place(step, state);
        std::mem::swap(&mut self.moves, &mut self.moves_before);
        let (rest, largest) = vectorized(Movements { scheme: self, count, step });
        let level = largest >= self.largest[0] || largest <= RESUMES * f64::EPSILON;
        self.largest = [self.largest[1], largest];
        Ok(rest && level)
    }

    /// Measures the effect of rounding on the rates at the first stage.
    fn estimate_roundoff(&mut self, step: f64, state: &State) {
        let n = state.values.len();
        let (stage, slope) = (&self.stages[..n], &self.slopes[..n]);
        for (i, size) in self.sizes.iter_mut().enumerate() {
            *size = state.values[i].abs().max(stage[i].abs()).max((step * slope[i]).abs());
        }
        let time = state.time + self.tableau.nodes[0].high * step;
        let place = roundoff::RatesPoint { time, numbers: stage, sizes: &self.sizes, step };
        if roundoff::measure(&mut self.rates, &place, &mut self.noise).is_err() {
            self.noise.fill(0.0);
        }
    }

    /// Takes a step with all stages side by side. Returns false, with the state unchanged, where they have to be computed
    /// one by one: where there are no lanes, where numbers are not finite, where the iteration does not converge.
    fn advance_in_lanes(&mut self, step: f64, state: &mut State) -> Result<bool, MotionError> {
        let Some(mut lanes) = self.lanes.take_if(|lanes| lanes.suit()) else { return Ok(false) };
        let outcome = self.advance_by(&mut lanes, step, state);
        self.contiguous &= outcome.is_ok();
        self.lanes = Some(lanes);
        outcome
    }

    fn advance_by(
        &mut self,
        lanes: &mut StageLanes,
        step: f64,
        state: &mut State,
    ) -> Result<bool, MotionError> {
        match (self.contiguous, self.in_lanes) {
            (true, true) => lanes.keep_slopes(),
            (true, false) => lanes.set_slopes_before(&self.slopes),
            (false, _) => {}
        }
        self.noise.fill(0.0);
        lanes.begin(step, state, self.contiguous);
        let n = state.values.len();
        for first in (0..PASSES).step_by(PASSES_PER_ROUND) {
            self.check_cancelled(state)?;
            if lanes.passes(first, step, state, &self.noise) {
                if !lanes.end(step, state) {
                    break;
                }
                (self.contiguous, self.in_lanes) = (true, true);
                return Ok(true);
            }
            if !lanes.are_finite() {
                break;
            }
            self.stages[..n].copy_from_slice(&state.values);
            lanes.write_first_stage(&mut self.stages[..n], &mut self.slopes[..n]);
            self.estimate_roundoff(step, state);
        }
        if self.contiguous {
            lanes.write_slopes_before(&mut self.slopes);
        }
        self.in_lanes = false;
        Ok(false)
    }

    fn check_cancelled(&self, state: &State) -> Result<(), MotionError> {
        if self.rates.system().cancel().is_cancelled() {
            let kind = MotionErrorKind::Cancelled;
            return Err(self.rates.system().error(kind, state.time, &state.values));
        }
        Ok(())
    }

    fn solve(&mut self, step: f64, state: &State) -> Result<(), MotionError> {
        self.noise.fill(0.0);
        self.resting.fill(MOVING);
        self.largest = [f64::INFINITY; 2];
        self.place(step, state);
        for count in 1..=PASSES {
            self.check_cancelled(state)?;
            match self.pass(count - 1, step, state) {
                Ok(true) => return Ok(()),
                Ok(false) => {}
                // a distant stage may lie where there are no rates
                Err(_) if count > 1 => break,
                Err(error) => return Err(error),
            }
            if count % PASSES_PER_ROUND == 0 {
                self.estimate_roundoff(step, state);
            }
            if self.stages.iter().any(|x| !x.is_finite()) {
                break;
            }
        }
        let n = state.values.len();
        self.rates.evaluate(state.time, &state.values, &mut self.slopes[..n])?;
        let system = self.rates.system();
        let mut here = state.clone();
        here.values.copy_from_slice(&self.slopes[..n]);
        system.check_finite(&here)?;
        Err(system.error(MotionErrorKind::NoConvergence(step), state.time, &state.values))
    }
}

impl Scheme for Implicit {
    fn form(&self) -> Form {
        self.rates.form()
    }

    fn begin(&mut self, parameters: &[f64]) {
        self.rates.set_parameters(parameters);
        if let Some(lanes) = &mut self.lanes {
            lanes.set_parameters(&self.rates);
        }
        self.contiguous = false;
    }

    fn forget(&mut self) {
        self.contiguous = false;
    }

    fn begin_near(&mut self, native: &State) {
        self.rates.begin_near(native);
    }

    fn continue_from(&mut self, other: &Implicit) {
        self.rates.continue_from(&other.rates);
    }

    fn rates(&mut self, time: f64, numbers: &[f64], out: &mut [f64]) -> Result<(), MotionError> {
        self.rates.evaluate(time, numbers, out)
    }

    fn advance(&mut self, step: f64, state: &mut State) -> Result<(), MotionError> {
        if self.advance_in_lanes(step, state)? {
            return Ok(());
        }
        self.guess(state)?;
        self.contiguous = false;
        self.solve(step, state)?;
        self.evaluate(step, state)?;
        let n = state.values.len();
        for (weights, stage) in self.tableau.matrix.iter().zip(self.stages.chunks_exact_mut(n)) {
            for (i, x) in stage.iter_mut().enumerate() {
                if !self.stays[i] {
                    let change = change(weights, &self.slopes, (i, n), step);
                    *x = (state.exact(i) + change).high;
                }
            }
        }
        self.evaluate(step, state)?;
        for i in 0..n {
            let change = change(&self.tableau.weights, &self.slopes, (i, n), step);
            state.set(i, state.exact(i) + change);
        }
        self.contiguous = true;
        Ok(())
    }
}

/// How far every number has moved in a pass.
struct Movements<'a> {
    scheme: &'a mut Implicit,
    /// The number of passes before.
    count: usize,
    step: f64,
}

impl Kernel for Movements<'_> {
    /// Whether all numbers rest, and the largest movement in units of a number's size.
    type Output = (bool, f64);

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> (bool, f64) {
        let Movements { scheme, count, step } = self;
        let n = scheme.noise.len();
        let (mut least_bound, mut largest) = (f64::INFINITY, 0.0_f64);
        for first in (0..scheme.stages.len()).step_by(n) {
            let of_stage = first..first + n;
            let stage = &scheme.stages[of_stage.clone()];
            let old = &scheme.scratch[of_stage.clone()];
            let slope = &scheme.slopes[of_stage.clone()];
            let before = &mut scheme.moves[of_stage.clone()];
            let resting = &mut scheme.resting[of_stage];
            let noise = &scheme.noise[..n];
            for i in 0..n {
                let moved = (stage[i] - old[i]).abs();
                let size = size_of(stage[i].abs().max((step * slope[i]).abs()));
                let small = SMALL * size + ROUNDINGS * step.abs() * noise[i];
                let earlier = if count >= 2 { before[i] } else { f64::INFINITY };
                resting[i] = bound_after(resting[i], moved, earlier, small, size);
                before[i] = moved;
                least_bound = least_bound.min(resting[i]);
                largest = largest.max(moved / (size + f64::MIN_POSITIVE));
            }
        }
        (least_bound >= 0.0, largest)
    }
}

/// Writes Σ w f of each number, over the stages.
fn combine(weights: impl Iterator<Item = f64>, slopes: &[f64], out: &mut [f64]) {
    for (j, (w, slopes)) in weights.zip(slopes.chunks_exact(out.len())).enumerate() {
        let products = slopes.iter().map(|slope| w * slope);
        if j == 0 {
            out.iter_mut().zip(products).for_each(|(x, product)| *x = product);
        } else {
            out.iter_mut().zip(products).for_each(|(x, product)| *x += product);
        }
    }
}

/// h Σ w f of one number of `n`, in double-double.
fn change(
    weights: &[DoubleDouble],
    slopes: &[f64],
    (i, n): (usize, usize),
    step: f64,
) -> DoubleDouble {
    let pairs = weights.iter().zip(slopes.chunks_exact(n));
    pairs.fold(DoubleDouble::ZERO, |sum, (&w, slope)| sum + w * slope[i]) * step
}
