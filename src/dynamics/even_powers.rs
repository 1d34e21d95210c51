//! A potential whose form shows that it has one strict minimum, however flat: a sum of even powers of linear functions with positive
//! coefficients, as V = x⁴.
//!
//! All its terms are least where these functions vanish. If they vanish at one place, V is larger everywhere else, and a rest there is
//! stable (J.-L. Lagrange, G. Dirichlet); as V grows along every line from there, nothing else is an equilibrium.
//!
//! In: equations, the values of the parameters. Out: whether V, or H, is such a sum. Never here: where the place is.

use std::collections::HashMap;

use nalgebra::{DMatrix, DVector};

use super::linear::least_squares;
use crate::expr::{Expr, Node, Pool, Symbol};
use crate::mechanics::{Equations, Flow};
use crate::model::Model;
use crate::num::Number;

/// Functions depend on each other, or vanish together, to this part of their size.
const ROUNDING: f64 = 1e-12;

/// Whether V of a Lagrangian, that is its energy at rest, or H, is a sum of even powers at these parameters that is least at one place.
pub(super) fn has_one_strict_minimum(
    model: &Model,
    equations: &Equations,
    parameters: &[f64],
) -> bool {
    let mut pool = equations.pool.clone();
    let mut values: HashMap<Symbol, Expr> = model
        .parameters
        .iter()
        .zip(parameters)
        .map(|(parameter, &value)| (parameter.symbol, pool.number(Number::Real(value).canonical())))
        .collect();
    let mut variables: Vec<Symbol> = equations.coordinates.iter().map(|c| c.position).collect();
    match equations.flow {
        Flow::Lagrange { .. } => {
            values.extend(equations.coordinates.iter().map(|c| (c.velocity, Expr::ZERO)));
        }
        Flow::Hamilton { .. } => variables.extend(equations.coordinates.iter().map(|c| c.momentum)),
        Flow::Poisson { .. } => return false,
    }
    let energy = pool.substitute(equations.energy, &values);
    let Some(bases) = bases(&pool, energy) else { return false };
    let rows: Option<Vec<_>> =
        bases.into_iter().map(|base| linear(&mut pool, base, &variables)).collect();
    rows.is_some_and(|rows| vanish_at_one_place(&rows, variables.len()))
}

/// The bases of the even powers of which a function is a sum with positive coefficients.
fn bases(pool: &Pool, function: Expr) -> Option<Vec<Expr>> {
    let terms: Vec<(Number, Expr)> = match pool.node(function) {
        Node::Sum(_, terms) => terms.to_vec(),
        Node::Product(..) => vec![(Number::ONE, function)],
        _ => return None,
    };
    let base = |(coefficient, term): (Number, Expr)| match pool.node(term) {
        Node::Product(own, factors) => {
            let (base, exponent) = *factors.first()?;
            let is_even = exponent.as_integer().is_some_and(|n| n > 0 && n % 2 == 0);
            let is_positive = coefficient.value() * own.value() > 0.0;
            (factors.len() == 1 && is_even && is_positive).then_some(base)
        }
        _ => None,
    };
    terms.into_iter().map(base).collect()
}

/// The slopes of a linear function, and its value where all variables are 0.
fn linear(pool: &mut Pool, function: Expr, variables: &[Symbol]) -> Option<(Vec<f64>, f64)> {
    let number = |pool: &Pool, e: Expr| pool.as_number(e).map(Number::value);
    let mut slopes = Vec::new();
    for &variable in variables {
        let slope = pool.derivative(function, variable);
        slopes.push(number(pool, slope)?);
    }
    let zero = variables.iter().map(|&variable| (variable, Expr::ZERO)).collect();
    let value = pool.substitute(function, &zero);
    Some((slopes, number(pool, value)?))
}

/// Whether linear functions vanish together at one place and no other.
fn vanish_at_one_place(functions: &[(Vec<f64>, f64)], count: usize) -> bool {
    let sizes: Vec<f64> = functions
        .iter()
        .map(|(slopes, _)| slopes.iter().fold(0.0_f64, |size, x| size.max(x.abs())))
        .collect();
    if functions.len() < count || sizes.contains(&0.0) {
        return false;
    }
    let matrix = DMatrix::from_fn(functions.len(), count, |i, j| functions[i].0[j] / sizes[i]);
    let right = DVector::from_fn(functions.len(), |i, _| -functions[i].1 / sizes[i]);
    let singular = matrix.singular_values();
    if singular.min() <= ROUNDING * singular.max() {
        return false;
    }
    let Some(place) = least_squares(&matrix, &right, 0.0) else { return false };
    let size = right.amax().max(place.amax());
    (&matrix * place - right).amax() <= ROUNDING * size
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The smaller singular value of the rows (1, 0) and (1, e) is e/2 of the larger one.
    #[test]
    fn functions_depend_on_each_other_up_to_a_part_of_1e_12() {
        let meet = |e: f64| vanish_at_one_place(&[(vec![1.0, 0.0], 0.0), (vec![1.0, e], 0.0)], 2);
        assert!(meet(2.2e-12) && !meet(1.8e-12));
    }

    /// 1 + x and 1 + e + x miss each other by e/2.
    #[test]
    fn functions_vanish_together_up_to_a_part_of_1e_12() {
        let meet = |e: f64| vanish_at_one_place(&[(vec![1.0], 1.0), (vec![1.0], 1.0 + e)], 1);
        assert!(meet(1.8e-12) && !meet(2.2e-12));
    }
}
