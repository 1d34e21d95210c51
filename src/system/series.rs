//! The Taylor series of a motion at a state.
//!
//! The lowest orders are built in double-double where that is asked for: they make up nearly all
//! of a step, so its rounding errors vanish, while the many higher orders cost only `f64`. Time
//! is counted from the origin in units of a power of two near the step's size, so that no
//! coefficient over- or underflows, be the motion an electron's or a galaxy's.

use std::sync::Arc;

use super::compiled::System;
use super::error::{MotionError, MotionErrorKind};
use super::jet::{Jet, Side};
use super::program::{Program, Singular};
use super::solve::Factored;
use super::state::State;
use crate::cancel::Cancel;
use crate::expr::FunctionId;
use crate::num::{DoubleDouble, ExtendedRange, Real, math};

/// The series of all numbers of a state, in the native form of its system.
#[derive(Clone, Debug)]
pub struct Series {
    system: System,
    /// The lowest orders, where they are built in double-double.
    low: Option<SeriesBuilder<DoubleDouble>>,
    high: SeriesBuilder<f64>,
    /// Both at once in a wider range, once it was needed.
    wide: Option<Box<SeriesBuilder<ExtendedRange>>>,
    parameters: Vec<DoubleDouble>,
    /// The state it starts from.
    origin: Vec<DoubleDouble>,
    time: DoubleDouble,
    scale: f64,
    sides: Vec<Side>,
}

impl System {
    /// Room for series up to an order; orders up to `exact` in double-double (none for zero).
    pub fn series(&self, order: usize, exact: usize) -> Series {
        let program = &self.motion().native;
        let (inputs, len) = (self.driven_len(), self.state_len());
        let low = (exact > 0).then(|| SeriesBuilder::new(Arc::clone(program), inputs, len, exact));
        Series {
            system: self.clone(),
            low,
            high: SeriesBuilder::new(Arc::clone(program), inputs, len, order),
            wide: None,
            parameters: Vec::new(),
            origin: vec![DoubleDouble::ZERO; len],
            time: DoubleDouble::ZERO,
            scale: 1.0,
            sides: vec![Side::Positive; program.switches()],
        }
    }
}

impl Series {
    /// Sets the parameters.
    pub fn set_parameters(&mut self, parameters: &[DoubleDouble]) {
        if let Some(low) = &mut self.low {
            low.jet.set_parameters(parameters);
        }
        self.high.jet.set_parameters(parameters);
        self.wide = None;
        self.parameters = parameters.to_vec();
    }

    /// The highest order.
    pub fn order(&self) -> usize {
        self.high.order
    }

    /// How many numbers a state has.
    #[expect(clippy::len_without_is_empty, reason = "a state is never empty")]
    pub fn len(&self) -> usize {
        self.origin.len()
    }

    /// How many coordinates and rates there are; the integrals carried along come after them.
    pub fn inputs(&self) -> usize {
        self.high.inputs
    }

    /// How many switching surfaces the motion has.
    pub fn switches(&self) -> usize {
        self.sides.len()
    }

    /// The branches taken, one for each switch.
    pub fn sides(&self) -> &[Side] {
        &self.sides
    }

    /// Chooses the branch at a switch for the series to be built next.
    pub fn set_side(&mut self, switch: usize, side: Side) {
        self.sides[switch] = side;
    }

    /// The unit of time of the coefficients.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// Chooses the unit of time of the coefficients to be built next: the power of two below
    /// `step`, negative for a step back in time.
    pub fn set_scale(&mut self, step: f64) {
        let exponent = math::log2(step.abs()).floor().clamp(-1000.0, 1000.0);
        self.scale = math::powi(2.0, exponent as i32).copysign(step);
    }

    /// The time of the origin.
    pub fn time(&self) -> DoubleDouble {
        self.time
    }

    /// Builds the series at a state of the native form.
    pub fn build(&mut self, state: &State) -> Result<(), MotionError> {
        self.time = state.exact_time();
        for (i, x) in self.origin.iter_mut().enumerate() {
            *x = state.exact(i);
        }
        match self.grow() {
            Ok(()) => Ok(()),
            Err(Halt::Singular(singular)) => {
                let program: &Program = &self.system.motion().native;
                Err(self.system.singular(program, singular, state.time, &state.values))
            }
            Err(Halt::Sticks) => {
                Err(self.system.fault(MotionErrorKind::Sticks, state.time, &state.values))
            }
            Err(Halt::Cancelled) => {
                Err(self.system.fault(MotionErrorKind::Cancelled, state.time, &state.values))
            }
        }
    }

    /// Where something on the way leaves the range of `f64`, all is built once more in a wider one.
    fn grow(&mut self) -> Result<(), Halt> {
        match self.grow_in_range() {
            Ok(()) if self.is_finite() => Ok(()),
            Err(Halt::Cancelled) => Err(Halt::Cancelled),
            _ => self.grow_extended(),
        }
    }

    fn is_finite(&self) -> bool {
        let finite = |c: &[f64]| c.iter().all(|x| x.is_finite());
        (0..self.len()).all(|i| finite(self.coefficients(i)))
            && (0..self.switches()).all(|i| finite(self.switch(i)))
    }

    fn grow_extended(&mut self) -> Result<(), Halt> {
        let clock = Clock { time: self.time, scale: self.scale };
        let (inputs, len, order) = (self.high.inputs, self.len(), self.high.order);
        let program = &self.system.motion().native;
        let wide = self.wide.get_or_insert_with(|| {
            let mut wide = Box::new(SeriesBuilder::new(Arc::clone(program), inputs, len, order));
            wide.jet.set_parameters(&self.parameters);
            wide
        });
        wide.begin(&self.origin, &self.sides);
        for k in 0..order {
            wide.grow(k, clock, self.system.cancel())?;
        }
        if !self.sides.is_empty() {
            wide.watch(clock)?;
        }
        if let Some(low) = &mut self.low {
            low.copy(wide);
        }
        self.high.copy(wide);
        Ok(())
    }

    fn grow_in_range(&mut self) -> Result<(), Halt> {
        let mut first = 0;
        let clock = Clock { time: self.time, scale: self.scale };
        let cancel = self.system.cancel();
        if let Some(low) = &mut self.low {
            low.begin(&self.origin, &self.sides);
            for k in 0..low.order {
                low.grow(k, clock, cancel)?;
            }
            // a weight felt two orders later is not yet known at the last order
            first = if low.kept.is_empty() { low.order } else { low.order + 1 - low.depth };
            self.high.take_over(low)?;
        } else {
            self.high.begin(&self.origin, &self.sides);
        }
        for k in first..self.high.order {
            self.high.grow(k, clock, cancel)?;
        }
        if !self.sides.is_empty() {
            self.high.watch(clock)?;
        }
        Ok(())
    }

    /// A coefficient of a number of the state.
    pub fn coefficient(&self, i: usize, order: usize) -> f64 {
        self.high.series(i)[order]
    }

    /// All coefficients of a number of the state.
    pub fn coefficients(&self, i: usize) -> &[f64] {
        self.high.series(i)
    }

    /// All coefficients of a switch.
    pub fn switch(&self, i: usize) -> &[f64] {
        &self.high.jet.switch(i)[..=self.high.order]
    }

    /// The value of a switch at a time after the origin, in the unit of the series, as exact as
    /// the lowest orders are.
    pub fn switch_after(&self, i: usize, x: DoubleDouble) -> DoubleDouble {
        let exact = self.low.as_ref().map_or(&[][..], |low| &low.jet.switch(i)[..low.order]);
        sum(exact, &self.switch(i)[exact.len()..], x)
    }

    /// How many functions there are whose branch a motion may leave.
    pub fn guards(&self) -> usize {
        self.system.motion().native.guards.len()
    }

    /// Whether such a function's series passes zero where its branch is left.
    pub fn guard_passes(&self, i: usize) -> bool {
        self.system.motion().native.guards[i].passes
    }

    /// The coefficients of one, as far as they are known.
    pub fn guard(&self, i: usize) -> &[f64] {
        let register = self.system.motion().native.guards[i].value;
        &self.high.jet.series(register)[..self.high.order]
    }

    /// Those of what stands under its root.
    pub fn guard_under(&self, i: usize) -> Option<&[f64]> {
        let register = self.system.motion().native.guards[i].under?;
        Some(&self.high.jet.series(register)[..self.high.order])
    }

    /// Its value at a time after the origin, in the unit of the series, as exact as the lowest
    /// orders are.
    pub fn guard_after(&self, i: usize, x: DoubleDouble) -> DoubleDouble {
        let register = self.system.motion().native.guards[i].value;
        let exact = self.low.as_ref().map_or(&[][..], |low| &low.jet.series(register)[..low.order]);
        sum(exact, &self.guard(i)[exact.len()..], x)
    }

    /// The number of the state that a switch is, if it is one.
    pub fn switch_number(&self, i: usize) -> Option<usize> {
        self.system.motion().native.switch_input(i)
    }

    /// All coefficients of the weight at a switch whose side is [`Side::Between`]; one order less
    /// than the others.
    pub fn weight(&self, i: usize) -> &[f64] {
        &self.high.jet.weight(i)[..self.high.order]
    }

    /// The series of the arguments of functions: how fast these change.
    pub fn arguments(&self) -> impl Iterator<Item = (FunctionId, &[f64])> {
        self.high.jet.arguments()
    }

    /// The state a time `after` the origin, by the polynomials.
    pub fn state_after(&self, after: DoubleDouble, out: &mut State) {
        let x = after * self.scale.recip();
        for i in 0..self.origin.len() {
            let exact = self.low.as_ref().map_or(&self.origin[i..=i], |low| low.series(i));
            out.set(i, sum(exact, &self.high.series(i)[exact.len()..], x));
        }
        let time = self.time + after;
        (out.time, out.time_carry) = (time.high, time.low);
    }
}

/// A polynomial by Horner's scheme: the terms of high order in `f64`, the low ones, which decide,
/// in double-double.
fn sum(low: &[DoubleDouble], high: &[f64], x: DoubleDouble) -> DoubleDouble {
    let tail = high.iter().rev().fold(0.0, |sum, &c| sum * x.high + c);
    low.iter().rev().fold(DoubleDouble::from(tail), |sum, &c| sum * x + c)
}

/// When the origin is, and the unit of time.
#[derive(Clone, Copy)]
struct Clock {
    time: DoubleDouble,
    scale: f64,
}

/// Why a series cannot be built.
enum Halt {
    Singular(Singular),
    /// No weights keep the switches at zero.
    Sticks,
    /// Somebody asked that it stop.
    Cancelled,
}

impl From<Singular> for Halt {
    fn from(singular: Singular) -> Halt {
        Halt::Singular(singular)
    }
}

/// The series in one precision, growing order by order.
#[derive(Clone, Debug)]
struct SeriesBuilder<R> {
    jet: Jet<R>,
    /// The highest order of the state's series.
    order: usize,
    inputs: usize,
    /// For each number of the state its coefficients, `order + 1` of them.
    state: Vec<R>,
    /// The switches that are kept at zero.
    kept: Vec<usize>,
    /// How many orders later these feel a weight: one where it acts on what they are made of, two
    /// where it acts on its rate of change.
    depth: usize,
}

impl<R: Real> SeriesBuilder<R> {
    fn new(program: Arc<Program>, inputs: usize, len: usize, order: usize) -> SeriesBuilder<R> {
        let state = vec![R::ZERO; len * (order + 1)];
        SeriesBuilder {
            jet: Jet::new(program, order),
            order,
            inputs,
            state,
            kept: Vec::new(),
            depth: 1,
        }
    }

    fn series(&self, i: usize) -> &[R] {
        &self.state[i * (self.order + 1)..][..=self.order]
    }

    fn len(&self) -> usize {
        self.state.len() / (self.order + 1)
    }

    fn begin(&mut self, origin: &[DoubleDouble], sides: &[Side]) {
        for (i, &x) in origin.iter().enumerate() {
            self.state[i * (self.order + 1)] = R::of(x);
        }
        self.kept.clear();
        for (switch, &side) in sides.iter().enumerate() {
            self.jet.set_side(switch, side);
            if side == Side::Between {
                self.kept.push(switch);
            }
        }
    }

    /// Takes over all orders known in another precision.
    fn take_over<S: Real>(&mut self, other: &SeriesBuilder<S>) -> Result<(), Singular> {
        for i in 0..self.len() {
            for (k, &c) in other.series(i).iter().enumerate() {
                self.state[i * (self.order + 1) + k] = R::of(c.double());
            }
        }
        self.kept.clone_from(&other.kept);
        self.depth = other.depth;
        self.jet.take_over(&other.jet, other.order)
    }

    /// All orders that are known in a wider range, to be read and not to be continued.
    fn copy(&mut self, wide: &SeriesBuilder<ExtendedRange>) {
        for i in 0..self.len() {
            for k in 0..=self.order {
                self.state[i * (self.order + 1) + k] = R::of(wide.series(i)[k].double());
            }
        }
        self.jet.copy(&wide.jet, self.order + 1);
    }

    /// From order `k` of the state to order `k + 1`.
    fn grow(&mut self, k: usize, clock: Clock, cancel: &Cancel) -> Result<(), Halt> {
        if cancel.is_cancelled() {
            return Err(Halt::Cancelled);
        }
        self.extend(k, clock)?;
        if !self.kept.is_empty() {
            self.keep(k, clock)?;
            self.extend(k, clock)?;
        }
        Ok(())
    }

    fn extend(&mut self, k: usize, clock: Clock) -> Result<(), Singular> {
        let stride = self.order + 1;
        for i in 0..self.inputs {
            self.jet.set_input(i, k, self.state[i * stride + k]);
        }
        self.jet.advance(k, R::of(clock.time), clock.scale)?;
        for i in 0..self.len() {
            self.state[i * stride + k + 1] = self.jet.output(i, k) * clock.scale / (k + 1) as f64;
        }
        Ok(())
    }

    /// The highest order of everything but the state.
    fn watch(&mut self, clock: Clock) -> Result<(), Singular> {
        let k = self.order;
        for i in 0..self.inputs {
            self.jet.set_input(i, k, self.state[i * (k + 1) + k]);
        }
        for &switch in &self.kept {
            self.jet.set_weight(switch, k, R::ZERO);
        }
        self.jet.advance(k, R::of(clock.time), clock.scale)
    }

    /// Finds the coefficients of order `k` of the weights that make those of order `k + 1` of the
    /// kept switches vanish. These depend linearly on them.
    fn keep(&mut self, k: usize, clock: Clock) -> Result<(), Halt> {
        let kept = self.kept.clone();
        let n = kept.len();
        if k == 0 {
            self.depth = 1;
        }
        if k + self.depth > self.order {
            for &switch in &kept {
                self.jet.set_weight(switch, k, R::ZERO);
            }
            return Ok(());
        }
        let mut matrix = vec![R::ZERO; n * n];
        let mut factored = Factored::new(n);
        let rest = loop {
            let rest = self.probe(k, clock, &kept, None)?;
            for (j, &switch) in kept.iter().enumerate() {
                let moved = self.probe(k, clock, &kept, Some(switch))?;
                for i in 0..n {
                    matrix[i * n + j] = moved[i] - rest[i];
                }
            }
            if factored.factor(|i, j| matrix[i * n + j]) {
                break rest;
            }
            // at rest on the surface a force may hold them there
            let still = rest.iter().all(|x| x.value() == 0.0);
            if k > 0 || self.depth > 1 || !still {
                return Err(Halt::Sticks);
            }
            self.depth = 2;
        };
        let mut weights: Vec<R> = rest.iter().map(|&x| -x).collect();
        factored.solve(&mut weights);
        for (&switch, &w) in kept.iter().zip(&weights) {
            self.jet.set_weight(switch, k, w);
        }
        Ok(())
    }

    /// The kept switches `depth` orders on, where one weight of order `k` is 1 and the others 0.
    fn probe(
        &mut self,
        k: usize,
        clock: Clock,
        kept: &[usize],
        one: Option<usize>,
    ) -> Result<Vec<R>, Singular> {
        for &switch in kept {
            let weight = if one == Some(switch) { R::ONE } else { R::ZERO };
            self.jet.set_weight(switch, k, weight);
            for later in k + 1..=k + self.depth {
                self.jet.set_weight(switch, later, R::ZERO);
            }
        }
        let last = k + self.depth;
        for order in k..last {
            self.extend(order, clock)?;
            for i in 0..self.inputs {
                self.jet.set_input(i, order + 1, self.state[i * (self.order + 1) + order + 1]);
            }
        }
        self.jet.advance(last, R::of(clock.time), clock.scale)?;
        Ok(kept.iter().map(|&switch| self.jet.switch(switch)[last]).collect())
    }
}
