//! The generating functions that a map does not have: F1(q, Q) exists where det ∂Q/∂p is not zero, F2(q, P) where det ∂P/∂p is not, F3(p, Q)
//! where det ∂Q/∂q is not, F4(p, P) where det ∂P/∂q is not.
//!
//! In: a map at values of the parameters. Out: the types, one for all pairs, that it has at no point near the start. Never
//! here: the functions themselves (`generating`).
//! Source: *The Principles of Dynamics*, § 3.2.1.

use nalgebra::DMatrix;

use super::canonical::PhaseMap;
use super::equations::Equations;
use super::implicit_map::matrix_at;
use super::valuation::Valuation;
use crate::expr::Expr;
use crate::model::{GeneratingType, Model};

/// The points at which a determinant vanishes.
const POINTS: usize = 8;

/// A determinant vanishes if it is below this part of 1 once each row of M is measured by its greatest entry, each entry times
/// the size of its coordinate or momentum: then the units of old and new ones do not count.
const VANISHES: f64 = 1e-12;

impl PhaseMap {
    /// The types of which the determinant vanishes, each with what that is the determinant of.
    pub fn missing_functions(
        &self,
        model: &Model,
        equations: &Equations,
    ) -> Vec<(GeneratingType, String)> {
        let n = self.old.len() / 2;
        let tangents = self.tangents(model, equations);
        let sizes: Vec<f64> = (self.old.iter())
            .map(|&old| tangents.iter().map(|(at, _)| at.at(old).abs()).fold(0.0, f64::max))
            .map(|size| if size > 0.0 { size } else { 1.0 })
            .collect();
        let measured = |(_, mut matrix): (Valuation, DMatrix<f64>)| {
            for (mut column, size) in matrix.column_iter_mut().zip(&sizes) {
                column *= *size;
            }
            for mut row in matrix.row_iter_mut() {
                let greatest = row.amax();
                row /= if greatest > 0.0 { greatest } else { 1.0 };
            }
            matrix
        };
        let matrices: Vec<_> = tangents.into_iter().map(measured).collect();
        let vanishes = |of: &GeneratingType| {
            let row = if of.has_new_position() { 0 } else { n };
            let column = if of.has_position() { n } else { 0 };
            !matrices.is_empty()
                && matrices.iter().all(|matrix| {
                    let block = matrix.view((row, column), (n, n)).into_owned();
                    block.determinant().abs() <= VANISHES
                })
        };
        let named = |of: GeneratingType| {
            let new = if of.has_new_position() { 'Q' } else { 'P' };
            let old = if of.has_position() { 'p' } else { 'q' };
            let det = if n > 1 { "det " } else { "" };
            (of, format!("{det}∂{new}/∂{old}"))
        };
        GeneratingType::ALL.into_iter().filter(vanishes).map(named).collect()
    }

    /// M at points near the start. Where the map does not have the function either that it was given by, the relations of that
    /// hold at no point; what they were solved for is then the map that the other functions have.
    fn tangents(&self, model: &Model, equations: &Equations) -> Vec<(Valuation, DMatrix<f64>)> {
        let images = self.images(model, equations, POINTS).into_iter();
        let known = |at: Valuation| Some((self.tangent(&equations.pool, &at)?, at));
        let known: Vec<_> = images.filter_map(known).map(|(matrix, at)| (at, matrix)).collect();
        let Some(forwards) = self.forwards.as_ref().filter(|_| known.is_empty()) else {
            return known;
        };
        let mut pool = equations.pool.clone();
        let rows: Vec<Vec<Expr>> = forwards
            .iter()
            .map(|&(_, e)| self.old.iter().map(|&old| pool.derivative(e, old)).collect())
            .collect();
        let points = (0..POINTS as u64).map(|n| Valuation::near_start(model, equations, n));
        let all = points.map(|at| (matrix_at(&pool, &rows, &at), at));
        let finite = all.filter(|(matrix, _)| matrix.iter().all(|x| x.is_finite()));
        finite.map(|(matrix, at)| (at, matrix)).collect()
    }
}
