//! The constraints compiled: their rows, their functions, and the sizes that residuals are measured by.
//!
//! In: the constraints of the equations. Out: programs of (q, t). A constraint on the velocities that is holonomic has an
//! f too: df = g ω. Never here: states.

use std::sync::Arc;

use super::program::Program;
use super::rhs::ProgramBuilder;
use crate::expr::{Expr, FunctionId, Node, Pool, Symbol};
use crate::mechanics::Holonomy;
use crate::num::{Number, gcd};

/// The number of values of each constraint beside its entries of A: A₀, f, g, a turn of f, and the jumps of f.
pub(super) const VALUES: usize = 4 + JUMPS;

/// The tolerance of a constraint for given values, relative to the size of its terms.
pub(super) const GIVEN_WITHIN: f64 = 1e-9;

/// The most angles without a common measure that are followed in a constraint.
pub(super) const JUMPS: usize = 3;

/// The most parts in which the common divisor of several jumps divides one of them. By decimal ratios such as 2 and 0.142859 it
/// is so small that any residual would be near a multiple of it, and the constraint would not be kept.
const MOST_PARTS: i64 = 100;

#[derive(Clone, Debug)]
pub(super) struct ConstraintPrograms {
    /// A, A₀, f and g of each constraint, by how much f jumps where any angle in it begins a new turn, and if there is no such
    /// number by how much it does for each angle.
    pub(super) values: Arc<Program>,
    /// For each of these values the size of its terms, then its sensitivity to its inputs, Σ |s
    /// ∂/∂s|.
    pub(super) sizes: Arc<Program>,
    /// The constraints on the velocities that have an f.
    pub(super) integrated: Vec<bool>,
    /// The constraints that were written as f(q, t) = 0.
    pub(super) holonomic: Vec<bool>,
}

impl ConstraintPrograms {
    pub(super) fn of(builder: &mut ProgramBuilder<'_>) -> Result<ConstraintPrograms, Symbol> {
        let mut values = Vec::new();
        let (mut integrated, mut holonomic) = (Vec::new(), Vec::new());
        for (k, row) in builder.equations.constraints.iter().enumerate() {
            values.extend_from_slice(&row.row);
            values.push(row.rate);
            let known = integral(builder, k);
            integrated.push(known.is_some());
            holonomic.push(row.position.is_some());
            let (f, g) = known.unwrap_or((row.position.unwrap_or(Expr::ZERO), Expr::ONE));
            let (turn, mut jumps) = turn(builder, f);
            jumps.resize(JUMPS, Expr::ZERO);
            values.extend([f, g, turn]);
            values.extend(jumps);
        }
        let pool = &mut builder.pool;
        let sizes = values.iter().flat_map(|&e| [pool.magnitude(e), pool.size_of_inputs(e)]);
        let sizes: Vec<Expr> = sizes.collect();
        let (values, sizes) = (program(builder, &values)?, program(builder, &sizes)?);
        Ok(ConstraintPrograms { values, sizes, integrated, holonomic })
    }
}

/// f and g of a constraint on the velocities that is holonomic by itself, whatever the parameters.
fn integral(builder: &mut ProgramBuilder<'_>, k: usize) -> Option<(Expr, Expr)> {
    let equations = builder.equations;
    let Holonomy::Holonomic { constant: Some(f), together: false, at_these_parameters: false } =
        *equations.supplements.holonomy.get(k)?
    else {
        return None;
    };
    let pool = &mut builder.pool;
    let mut moving: Vec<Symbol> = equations.coordinates.iter().map(|c| c.position).collect();
    moving.push(equations.symbols.time);
    if !is_entire(pool, f, &moving) {
        return None;
    }
    let (mut along, mut square) = (Vec::new(), Vec::new());
    for (c, &a) in equations.coordinates.iter().zip(&equations.constraints[k].row) {
        let slope = pool.derivative(f, c.position);
        along.push(pool.mul(slope, a));
        square.push(pool.powi(a, 2));
    }
    let (along, square) = (pool.sum(&along), pool.sum(&square));
    let g = pool.div(along, square);
    Some((f, pool.simplify(g)))
}

/// By how much an f jumps where angles of points in it begin new turns: the greatest number of which the jumps of all are
/// multiples. Zero where there is no angle, or no such number that tells a turn from a residual ([`MOST_PARTS`]): then the jump
/// of each angle, if there are not too many. There the motion continues, since the slopes of f are continuous.
fn turn(builder: &mut ProgramBuilder<'_>, f: Expr) -> (Expr, Vec<Expr>) {
    let equations = builder.equations;
    let pool = &mut builder.pool;
    let mut moving: Vec<Symbol> = equations.coordinates.iter().map(|c| c.position).collect();
    moving.push(equations.symbols.time);
    let varying = pool.reachable(&[f]).into_iter().filter(|&e| pool.depends_on_any(e, &moving));
    let half_turns = |e: Expr| match pool.node(e) {
        Node::Call(FunctionId::Atan2, _) => Some((e, 2)),
        // that of a finite argument makes no turn
        Node::Call(FunctionId::Atan, arguments) => {
            let finite = arguments.iter().all(|&argument| is_entire(pool, argument, &moving));
            (!finite).then_some((e, 1))
        }
        _ => None,
    };
    let angles: Vec<(Expr, i64)> = varying.filter_map(half_turns).collect();
    let (mut function, mut symbols) = (f, Vec::new());
    for (k, &(angle, _)) in angles.iter().enumerate() {
        let symbol = pool.symbol(&format!("the angle {k} of a constraint"));
        let variable = pool.variable(symbol);
        function = pool.replace(function, angle, variable);
        symbols.push(symbol);
    }
    let changing = [&moving[..], &symbols].concat();
    let mut jumps: Vec<Expr> = Vec::new();
    for (&symbol, &(_, half_turns)) in symbols.iter().zip(&angles) {
        let slope = pool.derivative(function, symbol);
        // an angle within another one has no slope
        if slope == Expr::ZERO || pool.depends_on_any(slope, &changing) {
            return (Expr::ZERO, Vec::new());
        }
        jumps.push(pool.monomial(Number::integer(half_turns), &[(slope, Number::ONE)]));
    }
    let pi = pool.pi();
    if let Some((unit, multiple)) = common_measure(pool, &jumps) {
        let multiple = pool.number(multiple);
        return (pool.product(&[unit, multiple, pi]), Vec::new());
    }
    if jumps.len() > JUMPS {
        return (Expr::ZERO, Vec::new());
    }
    (Expr::ZERO, jumps.into_iter().map(|jump| pool.mul(jump, pi)).collect())
}

/// An expression and the rational multiple of it that is the greatest number of which all are multiples; `None` if there are
/// none, or no such number that is not small beside one of them.
fn common_measure(pool: &mut Pool, jumps: &[Expr]) -> Option<(Expr, Number)> {
    let (&unit, others) = jumps.split_first()?;
    let (mut multiple, mut ratios) = (Number::ONE, vec![Number::ONE]);
    for &jump in others {
        let ratio = pool.div(jump, unit);
        let ratio = pool.simplify(ratio);
        let Some(Number::Rational(n, d)) = pool.as_number(ratio) else { return None };
        let Number::Rational(m, e) = multiple else { return None };
        let [n, d, m, e] = [n, d, m, e].map(i128::from);
        let divisor = gcd((n * e).unsigned_abs(), (m * d).unsigned_abs());
        multiple = Number::ratio(divisor as i128, d * e);
        ratios.push(Number::ratio(n, d));
    }
    let most = multiple * Number::integer(MOST_PARTS);
    ratios.iter().all(|ratio| ratio.abs() <= most).then_some((unit, multiple))
}

/// Whether an expression is smooth everywhere and has one value: an angle of a point jumps, and a
/// quotient has a pole, where the constraint on the velocities has neither.
fn is_entire(pool: &Pool, f: Expr, moving: &[Symbol]) -> bool {
    let varies = |e: Expr| pool.depends_on_any(e, moving);
    pool.reachable(&[f]).into_iter().filter(|&e| varies(e)).all(|e| match pool.node(e) {
        Node::Product(_, factors) => {
            let whole = |n: Number| n.as_integer().is_some_and(|n| n >= 0);
            factors.iter().all(|&(base, n)| !varies(base) || whole(n))
        }
        Node::Call(function, _) => matches!(
            function,
            FunctionId::Sin
                | FunctionId::Cos
                | FunctionId::Exp
                | FunctionId::Sinh
                | FunctionId::Cosh
                | FunctionId::Tanh
        ),
        Node::Power(..) => false,
        Node::Number(_) | Node::Pi | Node::Symbol(_) | Node::Sum(..) => true,
    })
}

fn program(builder: &mut ProgramBuilder<'_>, outputs: &[Expr]) -> Result<Arc<Program>, Symbol> {
    let equations = builder.equations;
    let mut lowering = builder.lowering();
    for c in &equations.coordinates {
        let register = lowering.input();
        lowering.bind(c.position, register);
    }
    let outputs = lowering.lower_all(outputs);
    lowering.finish(outputs)
}
