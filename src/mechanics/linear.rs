//! Symbolic solution of A x = b for the matrices of mechanics.
//!
//! Elimination uses the simplest pivot first (a constant on the diagonal before anything variable)
//! and simplifies every entry. It gives up as soon as an entry is too long to be read.

use super::equations::CLOSED_FORM_LIMIT;
use super::equations::NoClosedForm;
use crate::expr::{Expr, Pool, Zero};
use crate::num::Number;

/// The solution of A x = b.
pub(super) struct LinearSolution {
    /// x, if it is short enough to be read.
    pub(super) x: Result<Vec<Expr>, NoClosedForm>,
    /// b̃_k and d_k of b·A⁻¹b = Σ b̃_k²/d_k for symmetric A, the sum of squares that elimination
    /// leaves; `None` if a pivot was not on the diagonal.
    pub(super) squares: Option<Vec<(Expr, Expr)>>,
}

/// Solves A x = b.
///
/// # Errors
/// Returns an error if A is singular, or an entry grows beyond [`CLOSED_FORM_LIMIT`] nodes.
pub(super) fn solve(
    pool: &mut Pool,
    a: &[Vec<Expr>],
    b: &[Expr],
) -> Result<LinearSolution, NoClosedForm> {
    let n = b.len();
    let mut a = a.to_vec();
    let mut b = b.to_vec();
    let mut rows: Vec<usize> = (0..n).collect();
    let mut columns: Vec<usize> = (0..n).collect();
    let mut pivots: Vec<(usize, usize)> = Vec::new();
    while !rows.is_empty() {
        let (r, c) = pivot(pool, &a, &rows, &columns)
            .ok_or_else(|| NoClosedForm("the matrix is singular".to_owned()))?;
        rows.retain(|&i| i != r);
        columns.retain(|&j| j != c);
        pivots.push((r, c));
        for &i in &rows {
            if a[i][c] == Expr::ZERO {
                continue;
            }
            let factor = pool.div(a[i][c], a[r][c]);
            for &j in &columns {
                a[i][j] = reduced(pool, a[i][j], factor, a[r][j])?;
            }
            b[i] = reduced(pool, b[i], factor, b[r])?;
        }
    }
    let x = substitute_back(pool, &a, &b, &pivots);
    let diagonal = pivots.iter().all(|&(r, c)| r == c);
    let squares = diagonal.then(|| pivots.iter().map(|&(r, _)| (b[r], a[r][r])).collect());
    Ok(LinearSolution { x, squares })
}

/// Solves for x from the triangular system that elimination leaves.
fn substitute_back(
    pool: &mut Pool,
    a: &[Vec<Expr>],
    b: &[Expr],
    pivots: &[(usize, usize)],
) -> Result<Vec<Expr>, NoClosedForm> {
    let mut x = vec![Expr::ZERO; b.len()];
    for (k, &(r, c)) in pivots.iter().enumerate().rev() {
        let mut terms = vec![(Number::ONE, b[r])];
        for &(_, later) in &pivots[k + 1..] {
            terms.push((Number::MINUS_ONE, pool.mul(a[r][later], x[later])));
        }
        let above = pool.linear(Number::ZERO, &terms);
        let above = bounded(pool, above)?;
        let quotient = pool.div(above, a[r][c]);
        x[c] = bounded(pool, quotient)?;
    }
    Ok(x)
}

/// `entry − factor · other`, simplified.
fn reduced(pool: &mut Pool, entry: Expr, factor: Expr, other: Expr) -> Result<Expr, NoClosedForm> {
    if other == Expr::ZERO {
        return Ok(entry);
    }
    let product = pool.mul(factor, other);
    let difference = pool.sub(entry, product);
    bounded(pool, difference)
}

fn bounded(pool: &mut Pool, e: Expr) -> Result<Expr, NoClosedForm> {
    let simpler = if pool.weight(e) > CLOSED_FORM_LIMIT { e } else { pool.simplify(e) };
    if pool.weight(simpler) > CLOSED_FORM_LIMIT {
        return Err(NoClosedForm(format!(
            "the solved form has more than {CLOSED_FORM_LIMIT} nodes"
        )));
    }
    Ok(simpler)
}

/// The simplest nonvanishing entry; entries on the diagonal take precedence.
fn pivot(
    pool: &mut Pool,
    a: &[Vec<Expr>],
    rows: &[usize],
    columns: &[usize],
) -> Option<(usize, usize)> {
    let mut candidates: Vec<(bool, u64, usize, usize)> = Vec::new();
    for &i in rows {
        for &j in columns {
            if a[i][j] != Expr::ZERO {
                candidates.push((i != j, pool.weight(a[i][j]), i, j));
            }
        }
    }
    candidates.sort_unstable();
    let mut doubtful = None;
    for (_, _, i, j) in candidates {
        match pool.is_zero(a[i][j]) {
            Zero::No => return Some((i, j)),
            // it is not known whether its values are 0
            Zero::Unknown => doubtful = doubtful.or(Some((i, j))),
            Zero::Numerically | Zero::Proved => {}
        }
    }
    doubtful
}
