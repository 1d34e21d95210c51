//! Constraints in the compiled programs: accelerations and multipliers as one system of linear
//! equations, with a switch for each constraint that may be released, and the multipliers of least
//! norm for redundant constraints.
//!
//! In: M, f and the constraints' rows as expressions. Out: registers. Never here: which constraints
//! are enforced; `conditions` decides that numerically.

use super::elimination::{EliminatedCoordinate, Elimination, eliminate};
use super::lower::Lowering;
use super::program::Register;
use crate::expr::{Expr, Pool, Symbol};
use crate::mechanics::{ConstraintRow, Equations, Flow};
use crate::num::Number;

/// The matrices of M q̈ − Aᵀν = f, A q̈ = γ, for the enforced constraints.
#[derive(Clone, Debug, Default)]
pub(super) struct ConstraintSystem {
    /// The switches of the constraints; empty if all constraints are always enforced.
    pub(super) switches: Vec<ConstraintSwitch>,
    /// The matrix of the whole system.
    matrix: Vec<Vec<Expr>>,
    /// γ, zero if a constraint is not enforced.
    bias: Vec<Expr>,
    least: Option<LeastNorm>,
    /// The coordinates that were eliminated from the matrix, in this order.
    elimination: Elimination,
}

/// Two numbers for each constraint, 1 or 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct ConstraintSwitch {
    /// Whether it is one of the independent, enforced constraints.
    pub(super) enforced: Symbol,
    /// Whether it has not been released.
    pub(super) active: Symbol,
}

/// The multipliers of least norm. If ν are those of the independent constraints, Aᵀλ = A_indᵀν has
/// the least solution λ = B (BᵀB)⁻¹ G ν, where B = A A_indᵀ and G = A_ind A_indᵀ (λ lies in the
/// range of A; Golub & Van Loan, Matrix Computations, 5.5).
#[derive(Clone, Debug)]
struct LeastNorm {
    b: Vec<Vec<Expr>>,
    normal: Vec<Vec<Expr>>,
    g: Vec<Vec<Expr>>,
}

impl ConstraintSystem {
    /// Builds the matrices. `switched` means that a constraint may be released or is redundant,
    /// `redundant` that some are redundant.
    pub(super) fn of(
        pool: &mut Pool,
        equations: &Equations,
        switched: bool,
        redundant: bool,
    ) -> ConstraintSystem {
        let rows = &equations.constraints;
        let switches: Vec<ConstraintSwitch> =
            if switched { rows.iter().map(|row| switch(pool, row)).collect() } else { Vec::new() };
        let state = |pool: &mut Pool, symbol: fn(&ConstraintSwitch) -> Symbol, i: usize| {
            switches.get(i).map_or(Expr::ONE, |s| pool.variable(symbol(s)))
        };
        let enforced: Vec<Expr> = (0..rows.len()).map(|i| state(pool, |s| s.enforced, i)).collect();
        let active: Vec<Expr> = (0..rows.len()).map(|i| state(pool, |s| s.active, i)).collect();
        let scaled = |pool: &mut Pool, factors: &[Expr]| -> Vec<Vec<Expr>> {
            let rows = rows.iter().zip(factors);
            rows.map(|(row, &h)| row.row.iter().map(|&a| pool.mul(h, a)).collect()).collect()
        };
        let a = scaled(pool, &enforced);
        let mut matrix = match &equations.flow {
            Flow::Lagrange { mass, .. } => mass.clone(),
            Flow::Hamilton { .. } | Flow::Poisson { .. } => Vec::new(),
        };
        for (i, row) in matrix.iter_mut().enumerate() {
            row.extend(a.iter().map(|a| pool.neg(a[i])));
        }
        let free: Vec<Expr> = enforced.iter().map(|&h| pool.sub(Expr::ONE, h)).collect();
        for (k, a) in a.iter().enumerate() {
            let rest = (0..rows.len()).map(|j| if j == k { free[k] } else { Expr::ZERO });
            matrix.push(a.iter().copied().chain(rest).collect());
        }
        let bias = rows.iter().zip(&enforced).map(|(row, &h)| pool.mul(h, row.bias)).collect();
        let least = redundant.then(|| {
            let active = scaled(pool, &active);
            let b = products(pool, &active, &a);
            let columns = transposed(&b);
            let mut normal = products(pool, &columns, &columns);
            for (k, row) in normal.iter_mut().enumerate() {
                row[k] = pool.add(row[k], free[k]);
            }
            LeastNorm { b, normal, g: products(pool, &a, &a) }
        });
        let elimination = if rows.is_empty() {
            let symbols = &equations.symbols;
            let coordinates = &equations.coordinates;
            let auxiliary = equations.supplements.auxiliary.iter().flat_map(|own| &own.symbols);
            let varying = coordinates.iter().flat_map(|c| [c.position, c.velocity]);
            let varying: Vec<Symbol> =
                varying.chain(auxiliary.copied()).chain([symbols.time]).collect();
            eliminate(pool, &mut matrix, varying)
        } else {
            Elimination::default()
        };
        ConstraintSystem { switches, matrix, bias, least, elimination }
    }

    /// Returns the accelerations and binds them and the multipliers to their symbols.
    pub(super) fn bind(
        &self,
        lowering: &mut Lowering<'_>,
        equations: &Equations,
        force: &[Expr],
    ) -> Vec<Register> {
        let (mut matrix, mut force) = (self.matrix.clone(), force.to_vec());
        self.elimination.transform(lowering.pool, &mut matrix, &mut force);
        let mut right = lowering.lower_all(&force);
        right.extend(lowering.lower_all(&self.bias));
        let mut accelerations = lowering.solve(&matrix, &right);
        for EliminatedCoordinate { place, couplings } in self.elimination.coordinates.iter().rev() {
            let (row, x): (Vec<Expr>, Vec<Register>) =
                couplings.iter().map(|&(i, a)| (a, accelerations[i])).unzip();
            let moved = lowering.inner_product(&row, &x);
            accelerations[*place] = lowering.difference(accelerations[*place], moved);
        }
        let independent = accelerations.split_off(force.len());
        let multipliers = match &self.least {
            None => independent,
            Some(least) => {
                let right = times(lowering, &least.g, &independent);
                let least_squares = lowering.solve(&least.normal, &right);
                times(lowering, &least.b, &least_squares)
            }
        };
        for (c, &a) in equations.coordinates.iter().zip(&accelerations) {
            lowering.bind(c.acceleration, a);
        }
        for (row, &l) in equations.constraints.iter().zip(&multipliers) {
            lowering.bind(row.multiplier, l);
        }
        accelerations
    }
}

fn switch(pool: &mut Pool, row: &ConstraintRow) -> ConstraintSwitch {
    let name = pool.symbol_info(row.multiplier).name.clone();
    // a name in a file cannot contain a space
    let [enforced, active] =
        ["enforced", "active"].map(|word| pool.symbol(&format!("{word} {name}")));
    ConstraintSwitch { enforced, active }
}

/// The inner products of the rows of two matrices.
fn products(pool: &mut Pool, a: &[Vec<Expr>], b: &[Vec<Expr>]) -> Vec<Vec<Expr>> {
    let mut product = |x: &[Expr], y: &[Expr]| {
        let terms: Vec<(Number, Expr)> =
            x.iter().zip(y).map(|(&x, &y)| (Number::ONE, pool.mul(x, y))).collect();
        pool.linear(Number::ZERO, &terms)
    };
    a.iter().map(|x| b.iter().map(|y| product(x, y)).collect()).collect()
}

fn transposed(a: &[Vec<Expr>]) -> Vec<Vec<Expr>> {
    (0..a.first().map_or(0, Vec::len)).map(|j| a.iter().map(|row| row[j]).collect()).collect()
}

/// The product of a matrix and a column of registers.
fn times(lowering: &mut Lowering<'_>, a: &[Vec<Expr>], x: &[Register]) -> Vec<Register> {
    a.iter().map(|row| lowering.inner_product(row, x)).collect()
}
