//! The stages of an implicit Runge–Kutta method side by side, a stage in each lane.
//!
//! In: a tableau, the rates, a state, a step. Out: the state after the step that [`Implicit`](super::implicit::Implicit)
//! computes stage by stage, to the last bit. Never here: programs that cannot be written as a list, numbers that leave
//! the range of `f64`, iterations that do not converge: these are detected and left to the stages one by one.

use super::convergence::{
    MOVING, PASSES_PER_ROUND, RESUMES, ROUNDINGS, SMALL, bound_after, size_of,
};
use super::tableau::Tableau;
use crate::num::{Analytic, Batch, BatchDouble, Kernel, vectorized};
use crate::system::{Rates, STAGES, StageRates, Stages, State};

/// As many numbers are moved side by side at the end of a step.
const CHUNK: usize = 4;

/// All stages of one method and system. Lanes without a stage repeat the first.
#[derive(Clone)]
pub(super) struct StageLanes {
    rates: StageRates,
    /// The index in a state of each number that moves, and of the others.
    places: Vec<usize>,
    others: Vec<usize>,
    /// Whether stages may be evaluated side by side at these parameters.
    suits: bool,
    nodes: Stages,
    /// The columns of a, exactly.
    matrix: Vec<BatchDouble<STAGES>>,
    weights: Vec<BatchDouble<CHUNK>>,
    /// The columns of the extrapolation to the next step.
    onward: Vec<Stages>,
    /// Of the numbers that move, those that stay as they are at the stages of a partitioned method.
    stays: Vec<bool>,
    iteration: Vec<Iteration>,
    /// The slopes of the step before.
    before: Vec<Stages>,
    /// The largest movement of any number, in units of its size, in the last two passes.
    largest: [f64; 2],
}

/// What the iteration remembers of one number.
#[derive(Clone, Copy)]
struct Iteration {
    /// The movement in the last pass and in the one before, in turn.
    moved: [Stages; 2],
    /// The movement up to which the number has come to rest; negative where it has not.
    resting: Stages,
}

/// At first no movement is as large as two passes before.
const AT_FIRST: Iteration =
    Iteration { moved: [Batch([f64::INFINITY; STAGES]); 2], resting: Batch([MOVING; STAGES]) };

impl StageLanes {
    /// `None` where there are too many stages, and where the rates cannot be written as a list.
    pub(super) fn new(rates: &Rates, tableau: &Tableau, stays: &[bool]) -> Option<StageLanes> {
        let stages = tableau.nodes.len();
        let rates = rates.of_stages(stages)?;
        let stage = |lane: usize| if lane < stages { lane } else { 0 };
        let column = |j: usize| BatchDouble::each(|lane| tableau.matrix[stage(lane)][j]);
        let onward = |j: usize| Batch(std::array::from_fn(|lane| tableau.onward[stage(lane)][j]));
        let places = rates.places().to_vec();
        Some(StageLanes {
            suits: false,
            others: (0..stays.len()).filter(|i| !places.contains(i)).collect(),
            nodes: Batch(std::array::from_fn(|lane| tableau.nodes[stage(lane)].high)),
            matrix: (0..stages).map(column).collect(),
            weights: tableau.weights.iter().map(|&b| BatchDouble::splat(b)).collect(),
            onward: (0..stages).map(onward).collect(),
            stays: places.iter().map(|&i| stays[i]).collect(),
            iteration: vec![AT_FIRST; places.len()],
            before: vec![Stages::ZERO; places.len()],
            places,
            largest: [f64::INFINITY; 2],
            rates,
        })
    }

    /// Sets the parameters to those of `rates`.
    pub(super) fn set_parameters(&mut self, rates: &Rates) {
        self.suits = self.rates.set_parameters(rates);
    }

    /// Whether stages may be evaluated side by side.
    pub(super) fn suit(&self) -> bool {
        self.suits
    }

    /// Writes the slopes of the step before, one stage after the other.
    pub(super) fn write_slopes_before(&self, out: &mut [f64]) {
        let n = out.len() / self.matrix.len();
        for (stage, out) in out.chunks_exact_mut(n).enumerate() {
            for (&i, slope) in self.places.iter().zip(&self.before) {
                out[i] = slope.0[stage];
            }
        }
    }

    /// Sets the slopes of a step before that was taken stage by stage, one stage after the other.
    pub(super) fn set_slopes_before(&mut self, slopes: &[f64]) {
        let n = slopes.len() / self.matrix.len();
        for (&i, before) in self.places.iter().zip(&mut self.before) {
            *before = Stages::splat(slopes[i]);
            for (stage, slopes) in slopes.chunks_exact(n).enumerate() {
                before.0[stage] = slopes[i];
            }
        }
    }

    /// Keeps the slopes of a step before that was taken side by side.
    pub(super) fn keep_slopes(&mut self) {
        let (_, slopes) = self.rates.moving();
        self.before.copy_from_slice(slopes);
    }

    /// Begins a step: the stages from the slopes of the step before if this one is `contiguous`, or else from the slope
    /// at its beginning.
    pub(super) fn begin(&mut self, step: f64, state: &State, contiguous: bool) {
        vectorized(BeginStep { lanes: self, step, state, contiguous });
    }

    /// Performs passes from the `first` one on, of which at most [`PASSES_PER_ROUND`]. Returns whether all numbers have converged.
    pub(super) fn passes(&mut self, first: usize, step: f64, state: &State, noise: &[f64]) -> bool {
        vectorized(Passes { lanes: self, first, step, state, noise })
    }

    /// Ends a step with all digits of the coefficients. Returns false, with the state unchanged, where a number is not
    /// finite.
    pub(super) fn end(&mut self, step: f64, state: &mut State) -> bool {
        vectorized(EndStep { lanes: self, step, state })
    }

    /// Whether all stages and their slopes are finite.
    pub(super) fn are_finite(&mut self) -> bool {
        self.rates.are_finite()
    }

    /// Writes the first stage and its slopes, of the numbers that move.
    pub(super) fn write_first_stage(&mut self, stage: &mut [f64], slopes: &mut [f64]) {
        let (numbers, rates) = self.rates.moving();
        for ((&i, x), rate) in self.places.iter().zip(numbers).zip(rates) {
            (stage[i], slopes[i]) = (x.0[0], rate.0[0]);
        }
    }
}

/// The stages of a number from Σ a f.
#[inline(always)]
fn stages_of(sum: Stages, step: f64, state: &State, i: usize) -> Stages {
    (sum * step + state.carry[i]) + state.values[i]
}

/// Σ w f, over the stages: each column times the slope of its stage.
#[inline(always)]
fn combine<T>(columns: &[T], weights: impl Fn(&T) -> Stages, slopes: Stages) -> Stages {
    let mut sum = weights(&columns[0]) * slopes.0[0];
    for j in 1..columns.len() {
        sum = sum + weights(&columns[j]) * slopes.0[j];
    }
    sum
}

#[inline(always)]
fn leading(column: &BatchDouble<STAGES>) -> Stages {
    column.high
}

struct BeginStep<'a> {
    lanes: &'a mut StageLanes,
    step: f64,
    state: &'a State,
    contiguous: bool,
}

impl Kernel for BeginStep<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let BeginStep { lanes, step, state, contiguous } = self;
        let StageLanes { rates, places, others, matrix, onward, stays, before, .. } = lanes;
        if !contiguous {
            rates.set_times(Stages::splat(state.time));
            for &i in places.iter().chain(others.iter()) {
                rates.set_number(i, Stages::splat(state.values[i]));
            }
            rates.evaluate();
        }
        rates.set_times(lanes.nodes * step + state.time);
        for &i in others.iter() {
            rates.set_number(i, Stages::splat(state.values[i] + state.carry[i]));
        }
        let (numbers, slopes) = rates.moving();
        for (k, &i) in places.iter().enumerate() {
            numbers[k] = if stays[k] {
                Stages::splat(state.values[i])
            } else {
                let slope = if contiguous {
                    combine(onward, |column| *column, before[k])
                } else {
                    slopes[k]
                };
                stages_of(combine(matrix, leading, slope), step, state, i)
            };
        }
        lanes.iteration.fill(AT_FIRST);
        lanes.largest = [f64::INFINITY; 2];
    }
}

struct Passes<'a> {
    lanes: &'a mut StageLanes,
    first: usize,
    step: f64,
    state: &'a State,
    noise: &'a [f64],
}

impl Kernel for Passes<'_> {
    /// Whether all numbers have converged.
    type Output = bool;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> bool {
        let Passes { lanes, first, step, state, noise } = self;
        let StageLanes { rates, places, matrix, stays, iteration, .. } = lanes;
        let least = Stages::splat(size_of(0.0));
        for count in first..first + PASSES_PER_ROUND {
            rates.evaluate();
            let (numbers, slopes) = rates.moving();
            let (mut least_bound, mut largest) = (Stages::splat(f64::INFINITY), Stages::ZERO);
            for k in 0..places.len() {
                let (i, number) = (places[k], &mut numbers[k]);
                let old = *number;
                if !stays[k] {
                    *number = stages_of(combine(matrix, leading, slopes[k]), step, state, i);
                }
                let moved = (*number - old).abs();
                let size = number.abs().larger((slopes[k] * step).abs()).larger(least);
                let small = size * SMALL + ROUNDINGS * step.abs() * noise[i];
                let Iteration { moved: before, resting } = &mut iteration[k];
                let before = &mut before[count % 2];
                for lane in 0..STAGES {
                    resting.0[lane] = bound_after(
                        resting.0[lane],
                        moved.0[lane],
                        before.0[lane],
                        small.0[lane],
                        size.0[lane],
                    );
                }
                *before = moved;
                least_bound = least_bound.smaller(*resting);
                largest = largest.larger(moved / (size + f64::MIN_POSITIVE));
            }
            let mut most = 0.0;
            for lane in 0..STAGES {
                most = if largest.0[lane] > most { largest.0[lane] } else { most };
            }
            let largest = most;
            let level = largest >= lanes.largest[0] || largest <= RESUMES * f64::EPSILON;
            lanes.largest = [lanes.largest[1], largest];
            if level && least_bound.all_reach(Stages::ZERO) {
                return true;
            }
        }
        false
    }
}

struct EndStep<'a> {
    lanes: &'a mut StageLanes,
    step: f64,
    state: &'a mut State,
}

impl Kernel for EndStep<'_> {
    /// Whether all numbers are finite.
    type Output = bool;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> bool {
        let EndStep { lanes, step, state } = self;
        let StageLanes { rates, places, matrix, weights, stays, .. } = lanes;
        rates.evaluate();
        let (numbers, slopes) = rates.moving();
        for k in 0..places.len() {
            if stays[k] {
                continue;
            }
            let mut change = BatchDouble::ZERO;
            for j in 0..matrix.len() {
                change = change + matrix[j].times::<FUSED>(Batch::splat(slopes[k].0[j]));
            }
            let change = change.times::<FUSED>(Batch::splat(step));
            numbers[k] = (BatchDouble::splat(state.exact(places[k])) + change).high;
        }
        rates.evaluate();
        if !rates.are_finite() {
            return false;
        }
        let (_, slopes) = rates.moving();
        for (places, slopes) in places.chunks(CHUNK).zip(slopes.chunks(CHUNK)) {
            let mut change = BatchDouble::ZERO;
            for j in 0..weights.len() {
                let mut slope = Batch::ZERO;
                for lane in 0..slopes.len() {
                    slope.0[lane] = slopes[lane].0[j];
                }
                change = change + weights[j].times::<FUSED>(slope);
            }
            let change = change.times::<FUSED>(Batch::splat(step));
            let mut begin = BatchDouble::ZERO;
            for (lane, &i) in places.iter().enumerate() {
                (begin.high.0[lane], begin.low.0[lane]) = (state.values[i], state.carry[i]);
            }
            let end = begin + change;
            for (lane, &i) in places.iter().enumerate() {
                state.set(i, end.lane(lane));
            }
        }
        true
    }
}
