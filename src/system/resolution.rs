//! Over what time the functions of the events are simple: how far ahead of a state their Taylor
//! series along the motion, cut off at a modest order, tell what they do.
//!
//! Looks that are no farther apart than that see every turn, be a function ever so much faster than
//! the motion. In: a state. Out: a length of time. Never here: zeros.
//!
//! The estimate is that of a step by Taylor series: À. Jorba, M. Zou, Experimental Mathematics 14
//! (2005) 99, section 3.

use std::sync::Arc;

use super::jet::{Jet, Side};
use super::observables;
use super::program::Program;
use super::rhs::ProgramBuilder;
use super::series::Series;
use super::{State, System};
use crate::expr::{Expr, FunctionId, Node, Symbol};
use crate::num::{DoubleDouble, math};

/// The order of the series.
const ORDER: usize = 12;

/// How many of the last orders are looked at: those of even and of odd functions vanish in turn.
const LAST: usize = 3;

/// The last terms may be this part of the largest one: a sine is then followed for half a turn.
const CUT_OFF: f64 = 1e-3;

/// The argument of an exponential may change by this, …
const FARTHEST_ARGUMENT: f64 = 3.0;

/// … or by this part of itself: far out in its tail nothing happens.
const PART_OF_ARGUMENT: f64 = 0.5;

/// How often another unit of time, or other branches at kinks, are tried.
const ATTEMPTS: u32 = 12;

/// The program of the functions whose series are looked at: those of the events, then the arguments
/// of the exponentials in them, which may vanish far away and not nearby.
pub(super) fn program(
    builder: &mut ProgramBuilder<'_>,
    functions: &[Option<Expr>],
) -> Result<Arc<Program>, Symbol> {
    let given: Vec<Expr> = functions.iter().flatten().copied().collect();
    let mut all = functions.to_vec();
    for part in builder.pool.reachable(&given) {
        match builder.pool.node(part) {
            Node::Call(
                FunctionId::Exp | FunctionId::Tanh | FunctionId::Sinh | FunctionId::Cosh,
                arguments,
            ) => all.extend(arguments.iter().map(|&u| Some(u))),
            Node::Power(_, exponent) => all.push(Some(*exponent)),
            _ => {}
        }
    }
    observables::program(builder, &all)
}

/// Estimates the resolution that the events of one system need.
#[derive(Clone, Debug)]
pub(super) struct Resolution {
    system: System,
    series: Series,
    jet: Jet<f64>,
    /// How many outputs are functions of events; the others are arguments.
    functions: usize,
    outputs: usize,
    /// The length found last, near which the next one is expected.
    last: Option<f64>,
}

impl Resolution {
    pub(super) fn new(system: &System, program: Arc<Program>, functions: usize) -> Resolution {
        Resolution {
            system: system.clone(),
            series: system.series(ORDER, 0),
            outputs: program.outputs(),
            jet: Jet::new(program, ORDER),
            functions,
            last: None,
        }
    }

    pub(super) fn set_parameters(&mut self, parameters: &[DoubleDouble]) {
        self.series.set_parameters(parameters);
        self.jet.set_parameters(parameters);
        self.last = None;
    }

    /// How far after a state, in the system's own form, all functions are simple; `None` where that
    /// cannot be reported. `near` is some length of time that is not far from the motion's own.
    pub(super) fn after(&mut self, state: &State, near: f64) -> Option<f64> {
        let mut unit = self.last.unwrap_or(near);
        for _ in 0..ATTEMPTS {
            if !(unit.is_finite() && unit > 0.0) {
                return None;
            }
            self.series.set_scale(unit);
            match self.expand(state) {
                Attempt::Length(length) => {
                    self.last = Some(length).filter(|length| length.is_finite());
                    return Some(length);
                }
                Attempt::OtherSides => {}
                Attempt::NotFinite => unit *= 1e-4,
            }
        }
        None
    }

    fn expand(&mut self, state: &State) -> Attempt {
        let built = self.series.build(state).is_ok();
        let mut turned = false;
        for i in 0..self.series.switches() {
            let side = side(self.series.switch(i));
            turned |= side != self.series.sides()[i];
            self.series.set_side(i, side);
        }
        if turned {
            return Attempt::OtherSides;
        }
        if !built || !self.grow(state.time) {
            return Attempt::NotFinite;
        }
        let switches = self.jet.switches();
        let mut turned = false;
        for i in 0..switches {
            let side = side(self.jet.switch(i));
            turned |= side != self.jet.side(i);
            self.jet.set_side(i, side);
        }
        if turned && !self.grow(state.time) {
            return Attempt::NotFinite;
        }
        let mut length = f64::INFINITY;
        for i in 0..self.outputs {
            let c: [f64; ORDER + 1] = std::array::from_fn(|k| self.jet.output(i, k));
            let own = if i < self.functions { simple(&c) } else { within_reach(&c) };
            length = length.min(own);
        }
        for i in 0..switches {
            length = length.min(simple(self.jet.switch(i)));
        }
        if length.is_nan() {
            return Attempt::NotFinite;
        }
        Attempt::Length(length * self.series.scale().abs())
    }

    /// Grows the series of the functions from those of the state; false where one is not finite.
    fn grow(&mut self, time: f64) -> bool {
        let driven_len = self.system.driven_len();
        let quadratures = self.series.len() - driven_len;
        let auxiliary = self.system.carries();
        for k in 0..=ORDER {
            for i in 0..driven_len {
                self.jet.set_input(i, k, self.series.coefficient(i, k));
            }
            let mut next = driven_len;
            for (place, auxiliary) in (driven_len..).zip(auxiliary) {
                let known = auxiliary && next < driven_len + quadratures;
                let c = if known { self.series.coefficient(next, k) } else { 0.0 };
                next += usize::from(known);
                self.jet.set_input(place, k, c);
            }
            if self.jet.advance(k, time, self.series.scale()).is_err() {
                return false;
            }
        }
        (0..self.outputs).all(|i| (0..=ORDER).all(|k| self.jet.output(i, k).is_finite()))
    }
}

/// What came of one attempt.
enum Attempt {
    Length(f64),
    /// At a kink another branch holds.
    OtherSides,
    /// Some coefficient is beyond all range.
    NotFinite,
}

/// The side of a switch just after the origin.
fn side(c: &[f64]) -> Side {
    match c.iter().find(|x| **x != 0.0) {
        Some(x) if *x < 0.0 => Side::Negative,
        _ => Side::Positive,
    }
}

/// How far a series cut off at its last order tells its function, in its own unit.
fn simple(c: &[f64]) -> f64 {
    let mut length = f64::INFINITY;
    for k in c.len() - LAST..c.len() {
        if c[k] == 0.0 {
            continue;
        }
        let to_term = |j: usize| {
            let ratio = CUT_OFF * (c[j] / c[k]).abs();
            math::powf(ratio, 1.0 / (k - j) as f64)
        };
        length = length.min((0..k).map(to_term).fold(0.0, f64::max));
    }
    length
}

/// How far the argument of an exponential stays where its value is of one kind.
fn within_reach(c: &[f64]) -> f64 {
    let bound = FARTHEST_ARGUMENT.max(PART_OF_ARGUMENT * c[0].abs());
    let terms = c.iter().enumerate().skip(1).filter(|(_, x)| **x != 0.0);
    let reach = terms.map(|(k, x)| math::powf(0.5 * bound / x.abs(), 1.0 / k as f64));
    reach.fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn factorial(k: usize) -> f64 {
        (1..=k).map(|i| i as f64).product()
    }

    #[test]
    fn a_sine_is_simple_for_about_half_a_turn_and_a_pole_is_kept_at_a_distance() {
        for speed in [1.0, 1e6, 1e-6] {
            let sine: [f64; ORDER + 1] = std::array::from_fn(|k| {
                let sign = [0.0, 1.0, 0.0, -1.0][k % 4];
                sign * math::powi(speed, k as i32) / factorial(k)
            });
            let turn = simple(&sine) * speed;
            assert!((2.5..4.5).contains(&turn), "{turn}");
            let pole: [f64; ORDER + 1] = std::array::from_fn(|k| math::powi(speed, k as i32));
            let part = simple(&pole) * speed;
            assert!((0.4..0.7).contains(&part), "{part}");
        }
        let mut line = [0.0; ORDER + 1];
        (line[0], line[1]) = (-5.0, 1.0);
        assert_eq!(simple(&line), f64::INFINITY);
    }

    #[test]
    fn the_tail_of_an_exponential_is_approached_in_ever_smaller_steps() {
        // the argument −a (t − 500)², seen from 0, from 250 and from 499
        for (from, most) in [(0.0, 250.0), (250.0, 125.0), (499.0, 1.0)] {
            let (a, d) = (1e4, from - 500.0);
            let c = [-a * d * d, -2.0 * a * d, -a];
            let reach = within_reach(&c);
            assert!(reach < most && reach > 0.05 * most, "{from}: {reach}");
        }
    }
}
