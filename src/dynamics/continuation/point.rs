//! A point of a family of periodic orbits.
//!
//! In: an orbit, and where on its family it lies. Out: what changes its sign at a bifurcation. Never here: how the next
//! point is found (`continuation`).

use nalgebra::{DMatrix, DVector};

use super::super::orbit::Orbit;
use crate::system::State;

/// An orbit closes up to 1e-11 of its size; the matrix may be off by so much, growing over a period.
const CLOSING: f64 = 1e-9;

/// Between two points whose tangents have at least this product a family is a cubic curve.
const STRAIGHT: f64 = 0.5;

#[derive(Clone)]
pub(in super::super) struct FamilyPoint {
    pub(super) state: State,
    pub(super) period: f64,
    pub(super) parameter: f64,
    /// The direction of the family, in (z, T, μ), for a step onwards.
    pub(in super::super) tangent: DVector<f64>,
    pub(in super::super) value: f64,
    pub(in super::super) orbit: Orbit,
    /// How often each variable with a period goes round in one: the same on all of the family.
    pub(super) rounds: Vec<i64>,
    /// In how many directions there are orbits beside it and beside all before it: one if they are isolated.
    pub(in super::super) directions: usize,
}

impl FamilyPoint {
    /// The change of (z, T, μ) to another point.
    pub(super) fn change(&self, to: &FamilyPoint) -> DVector<f64> {
        let n = self.tangent.len() - 2;
        DVector::from_fn(n + 2, |i, _| match i {
            i if i < n => (to.state.exact(i) - self.state.exact(i)).high,
            i if i == n => to.period - self.period,
            _ => to.parameter - self.parameter,
        })
    }

    /// The change of (z, T, μ) to a part of the way to a point a step onwards: the cubic polynomial with both points and
    /// their tangents, which goes evenly along this tangent; the tangent itself where the family bends too much.
    pub(super) fn part_way(&self, to: &FamilyPoint, step: f64, part: f64) -> DVector<f64> {
        let along = self.tangent.dot(&to.tangent);
        if along < STRAIGHT {
            return &self.tangent * (part * step);
        }
        let rest = part - 1.0;
        let (begin, end) = (part * rest * rest * step, part * part * rest * step / along);
        let whole = part * part * (3.0 - 2.0 * part);
        &self.tangent * begin + &to.tangent * end + self.change(to) * whole
    }

    /// What changes its sign at a period doubling: Π (μᵢ + 1) of the transverse multipliers; `None` where it is rounding.
    pub(super) fn doubling(&self) -> Option<f64> {
        self.determinant(1.0)
    }

    /// What changes its sign where a multiplier passes 1: Π (μᵢ − 1); `None` where it is rounding.
    pub(super) fn unit(&self) -> Option<f64> {
        self.determinant(-1.0)
    }

    /// det (M + x) of the transverse matrix, unless its sign is not known: an error ε of the matrix changes it by ε times
    /// the product of all its singular values but the least, at most, and for each of them.
    fn determinant(&self, x: f64) -> Option<f64> {
        let matrix = &self.orbit.transverse;
        let n = matrix.nrows();
        if n == 0 {
            // without directions across there is nothing to change
            return Some(1.0);
        }
        let shifted = matrix + DMatrix::identity(n, n) * x;
        let determinant = shifted.determinant();
        let values = shifted.singular_values();
        let others: f64 = values.iter().take(n - 1).product();
        let error = self.orbit.rounding.unwrap_or(0.0).max(CLOSING) * n as f64 * others;
        (determinant.abs() > error).then_some(determinant)
    }
}
