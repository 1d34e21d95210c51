//! What a change of time and coordinates is called: a shift, a translation, a rotation, a boost, a dilation.
//!
//! In: ξ and η. Out: a name, where it has one; else what it changes. Never here: whether it is a symmetry.

use crate::expr::{Expr, Pool, Symbol, Zero};

/// What a symmetry is called.
pub(super) fn name_of(
    pool: &mut Pool,
    time: Symbol,
    positions: &[Symbol],
    xi: Expr,
    eta: &[Expr],
) -> String {
    let mut moving = positions.to_vec();
    moving.push(time);
    let constant = |pool: &Pool, e: Expr| !pool.depends_on_any(e, &moving);
    let still = eta.iter().all(|&e| e == Expr::ZERO);
    let of_time = |pool: &Pool, e: Expr| !pool.depends_on_any(e, positions);
    let name = if still && constant(pool, xi) {
        "time shift"
    } else if xi == Expr::ZERO && eta.iter().all(|&e| constant(pool, e)) {
        "translation"
    } else if xi == Expr::ZERO && eta.iter().all(|&e| of_time(pool, e)) {
        // η = v t + c
        let rates: Vec<Expr> = eta.iter().map(|&e| pool.derivative(e, time)).collect();
        if rates.iter().all(|&e| constant(pool, e)) {
            "boost"
        } else {
            "translation that depends on the time"
        }
    } else if xi == Expr::ZERO {
        let matrix: Vec<Vec<Expr>> = eta
            .iter()
            .map(|&e| positions.iter().map(|&q| pool.derivative(e, q)).collect())
            .collect();
        let linear = matrix.iter().flatten().all(|&e| constant(pool, e))
            && eta.iter().all(|&e| !pool.depends(e, time));
        if !linear {
            "transformation of the coordinates"
        } else if is_antisymmetric(pool, &matrix) {
            "rotation"
        } else {
            "linear transformation of the coordinates"
        }
    } else {
        let rate = pool.derivative(xi, time);
        let shrinks = |pool: &mut Pool, q: Symbol, e: Expr| {
            // η = a(t) q
            let q_slope = pool.derivative(e, q);
            let along = pool.variable(q);
            let along = pool.mul(q_slope, along);
            let rest = pool.sub(e, along);
            of_time(pool, q_slope) && (rest == Expr::ZERO || pool.is_zero(rest) == Zero::Proved)
        };
        let mut each = positions.iter().zip(eta);
        let scaled = of_time(pool, xi) && each.all(|(&q, &e)| shrinks(pool, q, e));
        let bend = pool.derivative(rate, time);
        if scaled && constant(pool, rate) && eta.iter().all(|&e| !pool.depends(e, time)) {
            "dilation"
        } else if scaled && bend != Expr::ZERO && constant(pool, bend) {
            "conformal transformation"
        } else {
            "transformation of time and coordinates"
        }
    };
    name.to_owned()
}

/// Whether A + Aᵀ = 0 is proved, so that exp(A) turns the coordinates.
fn is_antisymmetric(pool: &mut Pool, matrix: &[Vec<Expr>]) -> bool {
    (0..matrix.len()).all(|i| {
        (0..=i).all(|j| {
            let sum = pool.add(matrix[i][j], matrix[j][i]);
            sum == Expr::ZERO || pool.is_zero(sum) == Zero::Proved
        })
    })
}
