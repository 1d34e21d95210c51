//! The constants of the motion that are already known: those of the equations, and those found on the way.
//!
//! In: the equations' conserved quantities. Out: functions of the state, without time, with their degree in the
//! momenta. Never here: the search.

use std::collections::HashMap;

use super::evaluator::ResidueEvaluator;
use super::law::Law;
use crate::expr::{Expr, Node, Pool, Symbol, Zero};
use crate::mechanics::{Equations, Flow, in_phase_space};

/// A constant of the motion that the equations already have.
#[derive(Clone, Debug)]
pub struct KnownConstant {
    /// Its name: `energy`, `p_phi`, an observable's name.
    pub name: String,
    /// As a function of the state in which the search is made.
    pub expression: Expr,
    /// With the parameters' values put in.
    pub(super) here: Expr,
    /// Its degree in the momenta, or in the variables of a Poisson system.
    pub degree: u32,
    /// Whether it is a polynomial in the momenta, or in the variables of a Poisson system.
    pub(super) is_polynomial: bool,
}

/// The proved constants of the motion that the equations have, as functions of the law's variables.
pub(super) fn of(
    equations: &mut Equations,
    law: &Law,
    values: &HashMap<Symbol, Expr>,
) -> Vec<KnownConstant> {
    let mut all: Vec<KnownConstant> = Vec::new();
    for conserved in equations.conserved.clone() {
        if !conserved.reason.is_proved() {
            continue;
        }
        // H as it is read best, and not as E with the momenta put in
        let is_energy = conserved.expression == equations.energy
            && matches!(equations.flow, Flow::Lagrange { .. });
        let hamiltonian =
            (law.hamiltonian && is_energy).then(|| equations.hamiltonian().clone().ok()).flatten();
        let opened = if let Some(hamiltonian) = hamiltonian {
            hamiltonian
        } else if law.hamiltonian {
            match in_phase_space(equations, conserved.expression) {
                Ok(e) => e,
                Err(_) => continue,
            }
        } else {
            equations.open(conserved.expression)
        };
        let pool = &mut equations.pool;
        let opened = as_momentum(pool, law, opened);
        let here = pool.substitute(opened, values);
        let foreign = |s: &Symbol| !law.variables.contains(s);
        if pool.symbols_of(here).iter().any(foreign) || pool.symbols_of(here).is_empty() {
            continue;
        }
        // something whose values cannot be had modulo a prime cannot be compared
        if ResidueEvaluator::new(pool, &[here], &law.moving()).is_err()
            || all.iter().any(|k| k.here == here)
        {
            continue;
        }
        let moving = if law.positions == 0 { &law.variables[..] } else { law.momenta() };
        let (degree, is_polynomial) = degree(pool, here, moving);
        let degree = degree.max(1);
        all.push(KnownConstant {
            name: conserved.name,
            expression: opened,
            here,
            degree,
            is_polynomial,
        });
    }
    all
}

/// A function of phase space that is nothing but a momentum, as that momentum.
fn as_momentum(pool: &mut Pool, law: &Law, e: Expr) -> Expr {
    if !law.hamiltonian || matches!(pool.node(e), Node::Symbol(_)) {
        return e;
    }
    let symbols = pool.symbols_of(e);
    let momenta = law.momenta().iter().filter(|p| symbols.contains(*p)).copied();
    for p in momenta.collect::<Vec<_>>() {
        let p = pool.variable(p);
        let rest = pool.sub(e, p);
        if pool.is_zero(rest) == Zero::Proved {
            return p;
        }
    }
    e
}

/// The degree of a function in some symbols, as it is written, and whether it is a polynomial in them; a function that is
/// none counts as of degree 2.
pub(super) fn degree(pool: &Pool, e: Expr, symbols: &[Symbol]) -> (u32, bool) {
    let mut known: HashMap<Expr, (u32, bool)> = HashMap::new();
    for part in pool.reachable(&[e]) {
        let of = |e: &Expr| known[e];
        let degree = match pool.node(part) {
            Node::Symbol(s) => (u32::from(symbols.contains(s)), true),
            Node::Sum(_, parts) => parts
                .iter()
                .map(|(_, t)| of(t))
                .fold((0, true), |(n, all), (k, is)| (n.max(k), all && is)),
            Node::Product(_, factors) => factors
                .iter()
                .map(|(base, n)| match (of(base), n.as_integer()) {
                    ((0, is), _) => (0, is),
                    ((degree, is), Some(n)) if n > 0 => (degree * n.unsigned_abs() as u32, is),
                    _ => (2, false),
                })
                .fold((0, true), |(n, all), (k, is)| (n + k, all && is)),
            node if node.parts().iter().any(|p| of(p).0 > 0) => (2, false),
            _ => (0, true),
        };
        known.insert(part, degree);
    }
    known[&e]
}

/// How much higher than the degree of an ansatz the powers of a constant are that is no polynomial.
const MORE_POWERS: usize = 3;

/// Some functions, and all their products up to a degree, each as a list of their indices; no more than `most`. What is
/// no polynomial has degree 0: a few of its powers may lie in an ansatz of any degree.
pub(super) fn products(degrees: &[u32], up_to: u32, most: usize) -> Vec<Vec<usize>> {
    let mut all: Vec<(Vec<usize>, u32)> = Vec::new();
    let mut begin = 0;
    all.extend((0..degrees.len()).map(|i| (vec![i], degrees[i])));
    while begin < all.len() && all.len() < most {
        let end = all.len();
        for k in begin..end {
            let (factors, degree) = all[k].clone();
            for i in factors[factors.len() - 1]..degrees.len() {
                let power = factors.iter().filter(|&&k| k == i).count();
                let fits = degrees[i] > 0 || power < up_to as usize + MORE_POWERS;
                if fits && degree + degrees[i] <= up_to && all.len() < most {
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
