//! A jet whose orders above the lowest are computed by something else.
//!
//! In: a jet. Out: what it would do, and its numbers at order 0. Never here: how orders are computed.

use super::{Coefficient, Jet};
use crate::num::Real;
use crate::system::program::{Program, Register};
use crate::system::schedule::Schedule;
use crate::system::solve::Factored;

/// What is known of a jet before any number.
#[derive(Clone, Copy)]
pub(in crate::system) struct JetPlan<'a> {
    pub(in crate::system) program: &'a Program,
    pub(in crate::system) schedule: &'a Schedule,
    /// The registers that are read as whole series, each with its place among these.
    pub(in crate::system) copies: &'a [(Register, u32)],
    /// The number of registers and slopes.
    pub(in crate::system) values: usize,
    /// The number of orders.
    pub(in crate::system) stride: usize,
    /// The length of all such series together.
    pub(in crate::system) series: usize,
}

impl<R: Coefficient> Jet<R> {
    pub(in crate::system) fn plan(&self) -> JetPlan<'_> {
        JetPlan {
            program: &self.program,
            schedule: &self.schedule,
            copies: &self.tables.index.copies,
            values: self.tables.width,
            stride: self.tables.stride,
            series: self.tables.series.len(),
        }
    }

    /// The registers and slopes at order 0.
    pub(in crate::system) fn values(&self) -> &[R] {
        &self.tables.rows[..self.tables.width]
    }

    /// The same, and all series that are read whole.
    pub(in crate::system) fn values_and_series(&mut self) -> (&[R], &mut [R]) {
        let tables = &mut self.tables;
        (&tables.rows[..tables.width], &mut tables.series)
    }
}

impl<R: Real> Jet<R> {
    /// Copies what was evaluated at order 0 from a jet of the same program in another precision, and the matrices that it has
    /// factored.
    pub(in crate::system) fn take_over_values<S: Real>(&mut self, other: &Jet<S>) {
        let (own, other) = (&mut self.tables, &other.tables);
        let fixed = &self.program.fixed[..];
        for ((x, y), &is_fixed) in own.rows.iter_mut().zip(&other.rows).zip(fixed) {
            // without a branch, so that several are copied at once
            let taken = R::of(y.double());
            *x = if is_fixed { *x } else { taken };
        }
        for &(register, place) in &own.index.copies {
            if !fixed[register as usize] {
                own.series[place as usize * own.stride] = own.rows[register as usize];
            }
        }
        for (own, other) in own.blocks.iter_mut().zip(&other.blocks) {
            own.take_over(other);
        }
    }

    /// The matrices that were factored at order 0.
    pub(in crate::system) fn factored(&self) -> &[Factored<R>] {
        &self.tables.blocks
    }
}
