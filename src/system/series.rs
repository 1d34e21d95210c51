//! The Taylor series of a motion at a state.
//!
//! The lowest orders are built in double-double on request: they make up nearly all of a step, so
//! its rounding errors vanish, while the many higher orders cost only `f64`. Time is counted from
//! the origin in units of a power of two near the step's size, so that no coefficient overflows or
//! underflows on any time scale.

mod functions;

use std::sync::Arc;

use super::compiled::System;
use super::error::{MotionError, MotionErrorKind};
use super::growth::{Halt, SeriesBuilder, SeriesClock};
use super::jet::{Jet, Side};
use super::machine_code::CompiledGrowth;
use super::program::{Program, Register};
use super::state::State;
use super::state_sum::{SeriesList, StateSum};
use super::step_series::StepSeries;
use super::underflow;
use crate::num::{
    Analytic, DoubleDouble, ExtendedRange, FourLaneKernel, FourLanes, Real, all_finite,
    in_four_lanes,
};

/// The series of all numbers of a state, in the native form of its system.
#[derive(Clone, Debug)]
pub struct Series {
    system: System,
    /// The lowest orders, if they are built in double-double.
    low: Option<SeriesBuilder<DoubleDouble>>,
    high: SeriesBuilder<f64>,
    /// The machine code that computes its orders, if there is any.
    code: CompiledGrowth,
    /// All orders in a wider range, once they were needed.
    wide: Option<Box<SeriesBuilder<ExtendedRange>>>,
    /// Whether all orders are copies of those.
    has_left_range: bool,
    parameters: Vec<DoubleDouble>,
    underflow_may_count: bool,
    /// The state at the origin, in these units.
    origin: Vec<DoubleDouble>,
    /// The unit of each number's coefficients, a power of two: 1, except where they would be too small to
    /// keep their digits.
    units: Vec<f64>,
    time: DoubleDouble,
    scale: f64,
    sides: Vec<Side>,
}

impl System {
    /// Allocates series up to an order; orders up to `exact` are in double-double (none for zero).
    pub fn series(&self, order: usize, exact: usize) -> Series {
        let program = &self.motion().native;
        let (inputs, len) = (self.driven_len(), self.state_len());
        let high = Jet::without_outputs(Arc::clone(program), order);
        let low = (exact > 0).then(|| SeriesBuilder::new(Jet::like(&high, exact), inputs, len));
        Series {
            system: self.clone(),
            low,
            high: SeriesBuilder::new(high, inputs, len),
            code: CompiledGrowth::new((!self.interpreted).then_some(&self.motion().code)),
            wide: None,
            has_left_range: false,
            parameters: Vec::new(),
            underflow_may_count: underflow::may_count(program, &[], |_| 0.0),
            origin: vec![DoubleDouble::ZERO; len],
            units: vec![1.0; len],
            time: DoubleDouble::ZERO,
            scale: 1.0,
            sides: vec![Side::Positive; program.switches()],
        }
    }
}

impl Series {
    /// Takes other values, in the order of the model, for all evaluations to come.
    pub fn set_parameters(&mut self, parameters: &[DoubleDouble]) {
        if let Some(low) = &mut self.low {
            low.jet.set_parameters(parameters);
        }
        self.high.jet.set_parameters(parameters);
        self.wide = None;
        self.parameters = parameters.to_vec();
        let program = &self.system.motion().native;
        let value = |r: Register| self.high.jet.value(r);
        self.underflow_may_count = underflow::may_count(program, parameters, value);
    }

    /// The highest order.
    pub fn order(&self) -> usize {
        self.high.order
    }

    /// Whether the last series was computed by machine code.
    pub fn is_compiled(&self) -> bool {
        self.code.has_grown()
    }

    /// Says how many series are expected to follow the next one: many are worth machine code soon.
    pub fn expect(&mut self, count: f64) {
        self.code.expect(count);
    }

    /// The length of a state.
    #[expect(clippy::len_without_is_empty, reason = "a state is never empty")]
    pub fn len(&self) -> usize {
        self.origin.len()
    }

    /// The number of coordinates, rates and auxiliary numbers; the components of tangent vectors
    /// and the integrals carried along follow them.
    pub fn inputs(&self) -> usize {
        self.system.motion_len()
    }

    /// The number of switching surfaces of the motion.
    pub fn switches(&self) -> usize {
        self.sides.len()
    }

    /// The branches taken, one for each switch.
    pub fn sides(&self) -> &[Side] {
        &self.sides
    }

    /// Chooses the branch at a switch for the next series.
    pub fn set_side(&mut self, switch: usize, side: Side) {
        self.sides[switch] = side;
    }

    /// The unit of time of the coefficients.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// Chooses the unit of time of the next series: the power of two below `step`, negative for a
    /// step back in time.
    pub fn set_scale(&mut self, step: f64) {
        self.scale = unit_below(step);
    }

    /// The time of the origin.
    pub fn time(&self) -> DoubleDouble {
        self.time
    }

    /// Builds the series at a state of the native form.
    ///
    /// # Errors
    /// Returns an error if a matrix is singular at the state, no velocities belong to its momenta, or the system is cancelled.
    pub fn build(&mut self, state: &State) -> Result<(), MotionError> {
        self.time = state.exact_time();
        let count = self.origin.len();
        let (values, carry) = (&state.values[..count], &state.carry[..count]);
        for i in 0..count {
            self.origin[i] = DoubleDouble { high: values[i], low: carry[i] };
        }
        match self.grow() {
            Ok(()) => Ok(()),
            Err(Halt::Singular(singular)) => {
                let program: &Program = &self.system.motion().native;
                Err(self.system.singular(program, singular, state.time, &state.values))
            }
            Err(Halt::Sticks) => {
                Err(self.system.error(MotionErrorKind::Sticks, state.time, &state.values))
            }
            Err(Halt::Cancelled) => {
                Err(self.system.error(MotionErrorKind::Cancelled, state.time, &state.values))
            }
        }
    }

    /// Builds the orders. If a number leaves the range of `f64`, all orders are rebuilt in a wider
    /// one.
    fn grow(&mut self) -> Result<(), Halt> {
        if std::mem::take(&mut self.has_left_range) {
            self.units.fill(1.0);
        }
        let small = self.origin.iter().any(|x| underflow::is_small(x.high));
        match self.grow_in_range() {
            Ok(()) if self.sees_finite() && !self.underflows(small) => Ok(()),
            Err(Halt::Cancelled) => Err(Halt::Cancelled),
            _ => {
                self.has_left_range = true;
                self.grow_extended()
            }
        }
    }

    /// Whether all coefficients of the state and of the switches are finite.
    fn sees_finite(&self) -> bool {
        in_four_lanes(Finite(self))
    }

    /// Whether all coefficients of the state and of the switches are finite. Those that were copied from a wider range may not
    /// be.
    pub fn is_finite(&self) -> bool {
        !self.has_left_range || self.sees_finite()
    }

    /// Whether digits were lost to underflow, where some numbers of the state may be small.
    fn underflows(&self, small: bool) -> bool {
        let value = |r: Register| self.high.jet.value(r);
        let loses = |i: usize| {
            let size = largest(self.coefficients(i).iter().copied());
            size > 0.0 && size < underflow::LEAST_LEADING
        };
        (small || self.underflow_may_count)
            && underflow::occurred(&self.system.motion().native, value)
            || small && (0..self.len()).any(loses)
    }

    fn grow_extended(&mut self) -> Result<(), Halt> {
        let clock = SeriesClock::new(self.time, self.scale);
        let (inputs, len, order) = (self.high.inputs, self.len(), self.high.order);
        let wide = self.wide.get_or_insert_with(|| {
            let jet = Jet::like(&self.high.jet, order);
            let mut wide = Box::new(SeriesBuilder::new(jet, inputs, len));
            wide.jet.set_parameters(&self.parameters);
            wide
        });
        wide.begin(&self.origin, &self.sides);
        wide.grow(0, clock, self.system.cancel())?;
        if !self.sides.is_empty() {
            wide.watch(clock)?;
        }
        for (i, unit) in self.units.iter_mut().enumerate() {
            let size = largest(wide.series(i).iter().map(|c| c.value()));
            if size < underflow::LEAST_LEADING && size > 0.0 {
                *unit = power_of_two_below(size);
                self.origin[i] = self.origin[i].scaled(unit.recip());
            }
        }
        if let Some(low) = &mut self.low {
            low.copy(wide, &self.units);
        }
        self.high.copy(wide, &self.units);
        Ok(())
    }

    fn grow_in_range(&mut self) -> Result<(), Halt> {
        let (time, scale) = (self.time, self.scale);
        let clock = SeriesClock::new(time, scale);
        let cancel = self.system.cancel();
        let sliding = match &mut self.low {
            Some(low) => {
                low.begin(&self.origin, &self.sides);
                &low.sliding
            }
            None => {
                self.high.begin(&self.origin, &self.sides);
                &self.high.sliding
            }
        };
        if cancel.is_cancelled() {
            return Err(Halt::Cancelled);
        }
        if sliding.is_empty() && self.code.grow(&mut self.high, self.low.as_mut(), (time, scale))? {
            return Ok(());
        }
        let mut first = 0;
        if let Some(low) = &mut self.low {
            low.grow(0, SeriesClock::new(time, scale), cancel)?;
            first = if low.sliding.is_empty() { low.order } else { low.order + 1 - low.depth };
            self.high.take_over(low);
        }
        self.high.grow(first, clock, cancel)?;
        if !self.sides.is_empty() {
            self.high.watch(clock)?;
        }
        Ok(())
    }

    /// The unit of the coefficients of a number of the state.
    pub fn unit(&self, i: usize) -> f64 {
        self.units[i]
    }

    /// A coefficient of a number of the state, in its unit.
    pub fn coefficient(&self, i: usize, order: usize) -> f64 {
        self.high.series(i)[order]
    }

    /// All coefficients of a number of the state, in its unit.
    pub fn coefficients(&self, i: usize) -> &[f64] {
        self.high.series(i)
    }

    /// Writes the state at a time `after` the origin into `out`, by the polynomials.
    pub fn state_after(&self, after: DoubleDouble, out: &mut State) {
        let x = after.scaled(self.scale.recip());
        let (low, known) = match &self.low {
            Some(low) => (low.list(), low.known_orders()),
            None => (SeriesList { coefficients: &self.origin, stride: 1 }, 1),
        };
        let (high, units) = (self.high.list(), &self.units[..]);
        in_four_lanes(StateSum { low, known, high, units, x, out: &mut *out });
        let time = self.time + after;
        (out.time, out.time_carry) = (time.high, time.low);
    }
}

impl StepSeries for Series {
    fn order(&self) -> usize {
        self.high.order
    }

    fn count(&self) -> usize {
        self.origin.len()
    }

    fn time(&self) -> DoubleDouble {
        self.time
    }

    fn scale(&self) -> f64 {
        self.scale
    }

    fn unit(&self, i: usize) -> f64 {
        self.units[i]
    }

    fn coefficients(&self, i: usize) -> &[f64] {
        Series::coefficients(self, i)
    }
}

/// The power of two below the size of a step, with its sign; at least 2⁻⁹³⁰, whose inverse has all its
/// digits in double-double.
#[inline]
pub(super) fn unit_below(step: f64) -> f64 {
    let exponent = (step.abs().to_bits() >> 52).clamp(93, 2023);
    f64::from_bits(exponent << 52).copysign(step)
}

/// The power of two below a positive number, or the least number that has all its digits.
fn power_of_two_below(size: f64) -> f64 {
    let exponent = (size.to_bits() >> 52).max(1);
    f64::from_bits(exponent << 52)
}

/// The largest size of some numbers.
fn largest(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(0.0, |size, x| size.max(x.abs()))
}

/// The kernel of [`Series::sees_finite`].
struct Finite<'a>(&'a Series);

impl FourLaneKernel for Finite<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<L: FourLanes, const FUSED: bool>(self, lanes: L) -> bool {
        let Finite(series) = self;
        let mut finite = all_finite(lanes, series.high.coefficients());
        for i in 0..series.switches() {
            finite &= all_finite(lanes, series.switch(i));
        }
        finite
    }
}
