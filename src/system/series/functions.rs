//! The series of what a law is made of: its switches, guards, arguments and divisors.
//!
//! In: series that were built. Out: coefficients, lowest order first. Never here: the numbers of the state.

use super::Series;
use crate::expr::FunctionId;
use crate::num::{DoubleDouble, ExtendedRange, polynomial};
use crate::system::program::Register;

impl Series {
    /// All coefficients of a switch.
    pub fn switch(&self, i: usize) -> &[f64] {
        &self.high.jet.switch(i)[..=self.high.order]
    }

    /// The value of a switch at a time after the origin, in the unit of the series, as exact as the
    /// lowest orders are.
    pub fn switch_after(&self, i: usize, x: DoubleDouble) -> DoubleDouble {
        let exact = self.low.as_ref().map_or(&[][..], |low| &low.jet.switch(i)[..low.order]);
        polynomial(exact, &self.switch(i)[exact.len()..], x)
    }

    /// Whether the law has powers so high that the series may end before their first term.
    pub fn is_steep(&self) -> bool {
        self.system.motion().native.steep
    }

    /// The number of functions whose branch a motion may leave.
    pub fn guards(&self) -> usize {
        self.system.motion().native.guards.len()
    }

    /// Whether the series of such a function passes zero where its branch is left.
    pub fn guard_passes(&self, i: usize) -> bool {
        self.system.motion().native.guards[i].passes
    }

    /// The known coefficients of such a function.
    pub fn guard(&self, i: usize) -> &[f64] {
        let register = self.system.motion().native.guards[i].value;
        &self.high.jet.series(register)[..self.high.order]
    }

    /// Whether it has branches: a power whose exponent a parameter gives may be whole.
    pub fn guard_has_branches(&self, i: usize) -> bool {
        self.system.motion().native.guards[i].has_branches(|r| self.high.jet.value(r))
    }

    /// The coefficients of its argument, where it is a root or a power that is not steep.
    pub fn guard_argument(&self, i: usize) -> Option<&[f64]> {
        let value = |r: Register| self.high.jet.value(r);
        let register = self.system.motion().native.guards[i].argument(value)?;
        Some(&self.high.jet.series(register)[..self.high.order])
    }

    /// The coefficients of its argument, where that is a root's or a power's through whose zero a motion may continue.
    pub fn guard_under(&self, i: usize) -> Option<&[f64]> {
        let value = |r: Register| self.high.jet.value(r);
        let register = self.system.motion().native.guards[i].under(value)?;
        Some(&self.high.jet.series(register)[..self.high.order])
    }

    /// Its value at a time after the origin, in the unit of the series, as exact as the lowest
    /// orders are.
    pub fn guard_after(&self, i: usize, x: DoubleDouble) -> DoubleDouble {
        let register = self.system.motion().native.guards[i].value;
        let exact = self.low.as_ref().map_or(&[][..], |low| &low.jet.series(register)[..low.order]);
        polynomial(exact, &self.guard(i)[exact.len()..], x)
    }

    /// The number of the state that a switch is equal to, if any.
    pub fn switch_number(&self, i: usize) -> Option<usize> {
        self.system.motion().native.switch_input(i)
    }

    /// All coefficients of the weight at a switch whose side is [`Side::Between`](crate::system::Side::Between), one order fewer
    /// than the others.
    pub fn weight(&self, i: usize) -> &[f64] {
        &self.high.jet.weight(i)[..self.high.order]
    }

    /// The series of the arguments of functions; beyond the range of `f64` in a wider one, too.
    pub fn arguments(
        &self,
    ) -> impl Iterator<Item = (FunctionId, &[f64], Option<&[ExtendedRange]>)> {
        let wide = self.wide.as_ref().filter(|_| self.has_left_range);
        let mut wide = wide.map(|wide| wide.jet.arguments());
        self.high.jet.arguments().map(move |(function, u)| {
            (function, u, wide.as_mut().and_then(Iterator::next).map(|(_, wide)| wide))
        })
    }

    /// The high negative powers c/u^n: n, c, the series of u.
    pub fn steep_poles(&self) -> impl Iterator<Item = (f64, f64, &[f64])> {
        self.high.jet.steep_poles()
    }

    /// The series of what is divided by.
    pub fn divisors(&self) -> impl Iterator<Item = &[f64]> {
        self.high.jet.divisors()
    }

    /// The series of the arguments of tangents, each with what is to be taken from it to have the pole at π/2.
    pub fn tangents(&self) -> impl Iterator<Item = (&[f64], f64)> {
        self.high.jet.tangents()
    }
}
