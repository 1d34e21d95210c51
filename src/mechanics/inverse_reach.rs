//! Whether an inverse that is written down solves the map wherever it has a value, or near the start alone, as that of
//! x + max(0, x − 50) does that was found at x = 1.
//!
//! In: a map whose new variables are written down, and its inverse. Out: whether the map leads from the inverse of an image to that
//! image again, at points near the start and far from it. Never here: which of several branches is meant; each is a solution
//! wherever it has a value, as −√Q is one of Q = x².

use super::canonical::{LEADS_BACK, PhaseMap};
use super::equations::Equations;
use super::isolate::Solution;
use super::sampling::{FAR_POINTS, POINTS};
use super::valuation::Valuation;
use crate::expr::Symbol;
use crate::model::Model;

/// An image is moved by these parts of it to see whether the inverse is known there.
const NUDGES: [f64; 6] = [1e-12, -1e-12, 3e-12, -3e-12, 7e-12, -7e-12];

/// An inverse that moves by more than this part of itself has terms that cancel, as those of ln(Q + √(Q² + 1)) do for Q far below
/// 0: what it fails by is rounding.
const MOVES: f64 = 1e-9;

fn are_close(values: &[(Symbol, f64)], beside: &[(Symbol, f64)]) -> bool {
    let mut pairs = values.iter().zip(beside);
    pairs.all(|((_, one), (_, other))| (one - other).abs() <= MOVES * one.abs().max(other.abs()))
}

impl PhaseMap {
    /// Whether an inverse fails at the image of a point. Of a map whose new variables are not written down nothing is said.
    pub(super) fn is_inverse_local(
        &self,
        model: &Model,
        equations: &Equations,
        inverse: &Solution,
    ) -> bool {
        let Some(forwards) = &self.forwards else { return false };
        let pool = &equations.pool;
        let values = |of: &Solution, at: &Valuation| -> Vec<(Symbol, f64)> {
            of.iter().map(|&(symbol, e)| (symbol, at.value(pool, e))).collect()
        };
        let near = (0..POINTS as u64).map(|n| Valuation::near_start(model, equations, n));
        let far = (0..FAR_POINTS).map(|n| Valuation::far_from_start(model, equations, n));
        near.chain(far).any(|point| {
            let image = values(forwards, &point);
            let old = values(inverse, &point.clone().with(image.iter().copied()));
            let is_known = NUDGES.iter().all(|nudge| {
                let beside = image.iter().map(|&(symbol, value)| (symbol, value * (1.0 + nudge)));
                are_close(&old, &values(inverse, &point.clone().with(beside)))
            });
            if !is_known || !image.iter().chain(&old).all(|(_, value)| value.is_finite()) {
                return false;
            }
            let back = point.with(old);
            forwards.iter().zip(&image).any(|(&(_, e), &(_, expected))| {
                back.value(pool, e).is_finite() && !back.agrees(pool, e, expected, LEADS_BACK)
            })
        })
    }
}
