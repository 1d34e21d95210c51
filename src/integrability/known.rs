//! The constants of the motion that are already known: those of the equations, and those found on the way.
//!
//! In: the equations' conserved quantities. Out: functions of the state, without time, with their degree in the
//! momenta. Never here: the search.

use std::collections::HashMap;

use super::evaluator::Evaluator;
use super::law::Law;
use crate::expr::{Expr, Node, Pool, Symbol};
use crate::mechanics::{Equations, in_phase_space};

/// A constant of the motion that the equations already have.
#[derive(Clone, Debug)]
pub struct Known {
    /// Its name: `energy`, `p_phi`, an observable's name.
    pub name: String,
    /// As a function of the state in which the search is made.
    pub expression: Expr,
    /// With the parameters' values put in.
    pub(super) here: Expr,
    /// Its degree in the momenta, or in the variables of a Poisson system.
    pub degree: u32,
}

/// The proved constants of the motion that the equations have, as functions of the law's variables.
pub(super) fn of(
    equations: &mut Equations,
    law: &Law,
    values: &HashMap<Symbol, Expr>,
) -> Vec<Known> {
    let mut all: Vec<Known> = Vec::new();
    for conserved in equations.conserved.clone() {
        if !conserved.reason.is_proved() {
            continue;
        }
        let opened = if law.hamiltonian {
            match in_phase_space(equations, conserved.expression) {
                Ok(e) => e,
                Err(_) => continue,
            }
        } else {
            equations.open(conserved.expression)
        };
        let pool = &mut equations.pool;
        let here = pool.substitute(opened, values);
        let foreign = |s: &Symbol| !law.variables.contains(s);
        if pool.symbols_of(here).iter().any(foreign) || pool.symbols_of(here).is_empty() {
            continue;
        }
        // something whose values cannot be had modulo a prime cannot be compared
        if Evaluator::new(pool, &[here], &law.moving()).is_err()
            || all.iter().any(|k| k.here == here)
        {
            continue;
        }
        let moving = if law.positions == 0 { &law.variables[..] } else { law.momenta() };
        let degree = degree(pool, here, moving).max(1);
        all.push(Known { name: conserved.name, expression: opened, here, degree });
    }
    all
}

/// The degree of a function in some symbols, as it is written; a function that is no polynomial in them counts as of
/// degree 2.
pub(super) fn degree(pool: &Pool, e: Expr, symbols: &[Symbol]) -> u32 {
    let mut known: HashMap<Expr, u32> = HashMap::new();
    for part in pool.reachable(&[e]) {
        let degree = match pool.node(part) {
            Node::Symbol(s) => u32::from(symbols.contains(s)),
            Node::Sum(_, parts) => parts.iter().map(|(_, t)| known[t]).max().unwrap_or(0),
            Node::Product(_, factors) => factors
                .iter()
                .map(|(base, n)| match (known[base], n.as_integer()) {
                    (0, _) => 0,
                    (degree, Some(n)) if n > 0 => degree * n.unsigned_abs() as u32,
                    _ => 2,
                })
                .sum(),
            node => 2 * u32::from(node.parts().iter().any(|p| known[p] > 0)),
        };
        known.insert(part, degree);
    }
    known[&e]
}

/// Some functions, and all their products up to a degree, each as a list of their indices; no more than `most`.
pub(super) fn products(degrees: &[u32], up_to: u32, most: usize) -> Vec<Vec<usize>> {
    let mut all: Vec<(Vec<usize>, u32)> = Vec::new();
    let mut begin = 0;
    // one that is no polynomial may lie in an ansatz of any degree
    all.extend((0..degrees.len()).map(|i| (vec![i], degrees[i])));
    while begin < all.len() && all.len() < most {
        let end = all.len();
        for k in begin..end {
            let (factors, degree) = all[k].clone();
            for i in factors[factors.len() - 1]..degrees.len() {
                if degree + degrees[i] <= up_to && all.len() < most {
                    let mut longer = factors.clone();
                    longer.push(i);
                    all.push((longer, degree + degrees[i]));
                }
            }
        }
        begin = end;
    }
    all.into_iter().map(|(factors, _)| factors).collect()
}
