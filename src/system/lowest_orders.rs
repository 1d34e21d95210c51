//! The lowest orders of a series, with twice the digits of `f64`.
//!
//! In: the origin and the sides of switches. Out: coefficients, those of all orders in `f64` begun with them, sums. Never here:
//! machine code, the orders above.
//!
//! Where nothing is compared with zero, pair arithmetic has these digits with less work. On kinks a number that terms
//! balance must be zero to the last digit of the number, not of the terms: there they are double-doubles.

use super::growth::{Halt, SeriesBuilder, SeriesClock};
use super::jet::{Jet, Side};
use super::state_sum::{SeriesList, StateSum};
use crate::cancel::Cancel;
use crate::num::{DoubleDouble, ExtendedRange, FloatPair, Real, in_four_lanes, polynomial};
use crate::system::State;

#[derive(Clone, Debug)]
pub(super) enum LowestOrders {
    Pairs(SeriesBuilder<FloatPair>),
    Doubles(SeriesBuilder<DoubleDouble>),
}

/// Calls the same function of both.
macro_rules! of_either {
    ($own:expr, $low:ident => $call:expr) => {
        match $own {
            LowestOrders::Pairs($low) => $call,
            LowestOrders::Doubles($low) => $call,
        }
    };
}

impl LowestOrders {
    /// Room for orders up to one, beside the jet of all orders, for the numbers that the rates depend on and all of a state.
    pub(super) fn new(
        high: &Jet<f64>,
        order: usize,
        (inputs, len): (usize, usize),
    ) -> LowestOrders {
        if high.switches() > 0 {
            LowestOrders::Doubles(SeriesBuilder::new(Jet::like(high, order), inputs, len))
        } else {
            LowestOrders::Pairs(SeriesBuilder::new(Jet::like(high, order), inputs, len))
        }
    }

    pub(super) fn set_parameters(&mut self, parameters: &[DoubleDouble]) {
        of_either!(self, low => low.jet.set_parameters(parameters));
    }

    /// Copies all orders known in a wider range: [`SeriesBuilder::copy`].
    pub(super) fn copy(&mut self, wide: &SeriesBuilder<ExtendedRange>, units: &[f64]) {
        of_either!(self, low => low.copy(wide, units));
    }

    pub(super) fn begin(&mut self, origin: &[DoubleDouble], sides: &[Side]) {
        of_either!(self, low => low.begin(origin, sides));
    }

    /// Whether no switch is kept at zero.
    pub(super) fn is_free(&self) -> bool {
        of_either!(self, low => low.kept.is_empty())
    }

    /// Computes these orders and copies them into the series of all. Returns the highest order that is known there.
    pub(super) fn grow_into(
        &mut self,
        high: &mut SeriesBuilder<f64>,
        clock: (DoubleDouble, f64),
        cancel: &Cancel,
    ) -> Result<usize, Halt> {
        of_either!(self, low => grow_into(low, high, clock, cancel))
    }

    /// The value of a switch at a time after the origin, from all its coefficients in `f64`.
    pub(super) fn switch_after(&self, i: usize, all: &[f64], x: DoubleDouble) -> DoubleDouble {
        of_either!(self, low => polynomial(&low.jet.switch(i)[..low.order], &all[low.order..], x))
    }

    /// The same of a register.
    pub(super) fn register_after(&self, r: u32, all: &[f64], x: DoubleDouble) -> DoubleDouble {
        of_either!(self, low => polynomial(&low.jet.series(r)[..low.order], &all[low.order..], x))
    }

    /// Writes the state at a time after the origin: [`StateSum`].
    pub(super) fn sum_up(
        &self,
        high: SeriesList<'_, f64>,
        units: &[f64],
        x: DoubleDouble,
        out: &mut State,
    ) {
        of_either!(self, builder => {
            let (low, known) = (builder.list(), builder.known_orders());
            in_four_lanes(StateSum { low, known, high, units, x, out });
        });
    }
}

fn grow_into<R: Real>(
    low: &mut SeriesBuilder<R>,
    high: &mut SeriesBuilder<f64>,
    (time, scale): (DoubleDouble, f64),
    cancel: &Cancel,
) -> Result<usize, Halt> {
    low.grow(0, SeriesClock::new(time, scale), cancel)?;
    high.take_over(low)?;
    Ok(if low.kept.is_empty() { low.order } else { low.order + 1 - low.depth })
}
