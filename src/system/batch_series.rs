//! The Taylor series of several orbits at once, each from its own state, at its own time, in its own
//! unit and with its own parameters.
//!
//! In: a state and parameters for each lane. Out: the coefficients that a [`Series`](super::Series)
//! in `f64` of that orbit alone has, to the last bit; NaN where it has none. Never here: systems with
//! kinks, roots, constraints, events or impulses, whose orbits part from each other.

use std::sync::Arc;

use super::batch_states::BatchStates;
use super::compiled::System;
use super::growth::{Halt, SeriesBuilder, SeriesClock};
use super::jet::Jet;
use super::machine_code::CompiledGrowth;
use super::program::Op;
use super::series::unit_below;
use super::state::State;
use super::underflow;
use crate::expr::FunctionId;
use crate::num::{
    Analytic, BATCH, Batch, BatchDouble, DoubleDouble, Kernel, Polynomial, ScalarLanes, tail,
    tails, vectorized,
};

/// The series of all numbers of the states of several orbits.
#[derive(Clone, Debug)]
pub struct BatchSeries {
    system: System,
    builder: SeriesBuilder<Batch>,
    /// The machine code that computes its orders, if there is any.
    code: CompiledGrowth,
    /// What depends on the parameters of one lane alone is computed here.
    single: Jet<f64>,
    origins: BatchStates,
    /// Zero in the lanes where no number at the origin is so small that products may underflow.
    small: Batch,
    scale: Batch,
    /// The coefficients of one number of one lane, gathered.
    gathered: Vec<f64>,
}

impl System {
    /// Allocates series of several orbits, up to an order. There are none where an orbit may take
    /// another course than its neighbours: with kinks, roots or powers that leave their branch,
    /// constraints, events, impulses.
    pub fn batch_series(&self, order: usize) -> Option<BatchSeries> {
        let program = &self.motion().native;
        let alone = |&r: &u32| {
            matches!(program.ops[r as usize], Op::Select { .. } | Op::ParametricPower(..))
        };
        let smooth = program.switches() == 0 && program.guards.is_empty() && !program.steep;
        let alike = !program.body.iter().any(alone) && !self.has_branches();
        if !(smooth && alike && self.is_undisturbed()) {
            return None;
        }
        let (inputs, len) = (self.driven_len(), self.state_len());
        let jet = Jet::without_outputs(Arc::clone(program), order);
        Some(BatchSeries {
            system: self.clone(),
            single: Jet::like(&jet, 0),
            builder: SeriesBuilder::new(jet, inputs, len),
            code: CompiledGrowth::new((!self.interpreted).then_some(&self.motion().code)),
            origins: BatchStates::new(self.form(), len),
            small: Batch::ZERO,
            scale: Batch::ONE,
            gathered: Vec::with_capacity(order),
        })
    }
}

impl System {
    /// Whether nothing acts on a motion but its law, and nothing is watched.
    pub(super) fn is_undisturbed(&self) -> bool {
        self.constraints() == 0
            && self.attitude_place().is_none()
            && !self.locates_events()
            && self.discontinuities().impulses.is_empty()
    }
}

impl BatchSeries {
    /// Sets the parameters of a lane. Returns false if its numbers may leave the range of `f64`, so
    /// that the orbit must be followed by itself.
    #[must_use]
    pub fn set_parameters(&mut self, lane: usize, parameters: &[DoubleDouble]) -> bool {
        self.single.set_parameters(parameters);
        self.builder.jet.take_parameters(lane, &self.single);
        let value = |register: u32| self.single.value(register);
        !underflow::may_count(&self.system.motion().native, parameters, value)
    }

    /// Chooses the unit of time of a lane: the power of two below `step`, negative for a step back.
    #[inline]
    pub fn set_scale(&mut self, lane: usize, step: f64) {
        self.scale.0[lane] = unit_below(step);
    }

    /// The units of time.
    #[inline]
    pub fn scale(&self) -> Batch {
        self.scale
    }

    /// Begins at these states in the lanes that go, and stays as it is in the others.
    pub fn set_states(&mut self, states: &BatchStates, going: &[bool; BATCH]) {
        vectorized(Origins { series: self, states, going });
    }

    /// The highest order.
    pub fn order(&self) -> usize {
        self.builder.order
    }

    /// The times at the origins, in `f64`.
    pub(super) fn start(&self) -> Batch {
        self.origins.times()
    }

    /// Whether no number at the origin of a lane is so small that products may underflow.
    #[inline]
    pub fn keeps_digits(&self, lane: usize) -> bool {
        self.small.0[lane] == 0.0
    }

    /// The time at the origin of a lane.
    #[inline]
    pub fn time(&self, lane: usize) -> DoubleDouble {
        self.origins.time(lane)
    }

    /// Builds all series. Returns false if the computation was cancelled.
    #[must_use]
    pub fn build(&mut self) -> bool {
        let clock = SeriesClock { time: self.start(), scale: self.scale };
        if self.system.cancel().is_cancelled() {
            return false;
        }
        if matches!(self.code.grow_all(&mut self.builder, clock), Ok(true)) {
            return true;
        }
        match self.builder.grow_plainly(0, clock, self.system.cancel()) {
            Ok(()) | Err(Halt::Singular(_) | Halt::Sticks) => true,
            Err(Halt::Cancelled) => false,
        }
    }

    /// Whether the last series were computed by machine code.
    pub fn is_compiled(&self) -> bool {
        self.code.has_grown()
    }

    /// The number of numbers of a state.
    #[expect(clippy::len_without_is_empty, reason = "a state is never empty")]
    pub fn len(&self) -> usize {
        self.origins.high.len()
    }

    /// The number of coordinates, rates and auxiliary numbers; the integrals follow them.
    pub fn inputs(&self) -> usize {
        self.system.motion_len()
    }

    /// All coefficients of a number.
    pub fn coefficients(&self, i: usize) -> &[Batch] {
        self.builder.series(i)
    }

    /// The series of the arguments of functions.
    pub fn arguments(&self) -> impl Iterator<Item = (FunctionId, &[Batch])> {
        self.builder.jet.arguments()
    }

    /// The high negative powers c/u^n: n, c, and the series of u.
    pub fn steep_poles(&self) -> impl Iterator<Item = (Batch, Batch, &[Batch])> {
        self.builder.jet.steep_poles()
    }

    /// The series of what is divided by.
    pub fn divisors(&self) -> impl Iterator<Item = &[Batch]> {
        self.builder.jet.divisors()
    }

    /// The series of the arguments of tangents, each with what is to be taken from it to have the pole at π/2.
    pub fn tangents(&self) -> impl Iterator<Item = (&[Batch], f64)> {
        self.builder.jet.tangents()
    }

    /// Writes the states at times after the origins into `out`, in the lanes that are moving, by the
    /// polynomials.
    pub fn states_after(
        &mut self,
        after: &[DoubleDouble; BATCH],
        moving: &[bool; BATCH],
        out: &mut BatchStates,
    ) {
        vectorized(States { series: self, after, moving, out });
    }

    /// Writes the state of one lane at a time `after` its origin into `out`.
    pub fn state_after(&mut self, lane: usize, after: DoubleDouble, out: &mut State) {
        let x = after * self.scale.0[lane].recip();
        for i in 0..self.len() {
            self.gather(i, lane);
            let low = &[self.origin(i, lane)][..];
            let tail = tail(ScalarLanes, &self.gathered, x.high);
            let polynomial = Polynomial { low, high: &self.gathered, x };
            out.set(i, polynomial.with_tail::<_, false>(ScalarLanes, tail));
        }
        let time = self.time(lane) + after;
        (out.time, out.time_carry) = (time.high, time.low);
    }

    /// A number of a lane at its origin.
    fn origin(&self, i: usize, lane: usize) -> DoubleDouble {
        DoubleDouble { high: self.origins.high[i].0[lane], low: self.origins.low[i].0[lane] }
    }

    /// Gathers the coefficients above the first of a number of a lane.
    fn gather(&mut self, i: usize, lane: usize) {
        self.gathered.clear();
        self.gathered.extend(self.builder.series(i)[1..].iter().map(|c| c.0[lane]));
    }
}

/// `tail · x + origin` in each lane, with twice the digits: what [`Polynomial`] has for a single term
/// of low order.
#[inline(always)]
fn plus_origin<const FUSED: bool>(
    tail: Batch,
    x: Batch,
    (high, low): (Batch, Batch),
) -> (Batch, Batch) {
    let (product, lost) = tail.product_with_error::<FUSED>(x);
    let (sum, left) = product.sum_with_error(high);
    // the errors of the terms above are zero
    sum.sum_with_error(Batch::ZERO * x + (lost + left + low))
}

/// The origins of all lanes that go.
struct Origins<'a> {
    series: &'a mut BatchSeries,
    states: &'a BatchStates,
    going: &'a [bool; BATCH],
}

impl Kernel for Origins<'_> {
    type Output = ();
    const OF_SEVERAL: bool = true;

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let Origins { series, states, going } = self;
        let mask = mask_of(*going);
        let mut small = Batch::ZERO;
        for i in 0..series.len() {
            let high = mask.where_equal(1.0, states.high[i], series.origins.high[i]);
            series.origins.high[i] = high;
            series.origins.low[i] = mask.where_equal(1.0, states.low[i], series.origins.low[i]);
            *series.builder.origin_mut(i) = high;
            for lane in 0..BATCH {
                small.0[lane] += if underflow::is_small(high.0[lane]) { 1.0 } else { 0.0 };
            }
        }
        series.small = small;
        for lane in (0..BATCH).filter(|&lane| going[lane]) {
            series.origins.times[lane] = states.times[lane];
        }
    }
}

/// One in the lanes where something holds, else zero.
#[inline(always)]
fn mask_of(holds: [bool; BATCH]) -> Batch {
    let mut mask = Batch::ZERO;
    for lane in 0..BATCH {
        mask.0[lane] = if holds[lane] { 1.0 } else { 0.0 };
    }
    mask
}

/// The states of all lanes at times of their own.
struct States<'a> {
    series: &'a mut BatchSeries,
    after: &'a [DoubleDouble; BATCH],
    moving: &'a [bool; BATCH],
    out: &'a mut BatchStates,
}

impl Kernel for States<'_> {
    type Output = ();
    const OF_SEVERAL: bool = true;

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let States { series, after, moving, out } = self;
        let mask = mask_of(*moving);
        let mut x = BatchDouble::ZERO;
        // mostly times are numbers of one part
        let mut lows = 0.0;
        for lane in 0..BATCH {
            // a power of two
            let inverse = series.scale.0[lane].recip();
            (x.high.0[lane], x.low.0[lane]) =
                (after[lane].high * inverse, after[lane].low * inverse);
            lows += x.low.0[lane].abs();
        }
        for i in 0..series.len() {
            let tail = tails(&series.builder.series(i)[1..], x.high);
            let origin = (series.origins.high[i], series.origins.low[i]);
            let (high, low) = plus_origin::<FUSED>(tail, x.high, origin);
            out.high[i] = mask.where_equal(1.0, high, out.high[i]);
            out.low[i] = mask.where_equal(1.0, low, out.low[i]);
            if lows == 0.0 {
                continue;
            }
            for lane in (0..BATCH).filter(|&lane| moving[lane] && x.low.0[lane] != 0.0) {
                series.gather(i, lane);
                let low = &[series.origin(i, lane)][..];
                let polynomial = Polynomial { low, high: &series.gathered, x: x.lane(lane) };
                let sum = polynomial.with_tail::<_, FUSED>(ScalarLanes, tail.0[lane]);
                (out.high[i].0[lane], out.low[i].0[lane]) = (sum.high, sum.low);
            }
        }
        for lane in (0..BATCH).filter(|&lane| moving[lane]) {
            out.times[lane] = series.time(lane) + after[lane];
        }
    }
}
