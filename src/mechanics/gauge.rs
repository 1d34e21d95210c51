//! Whether two Lagrangians differ by a total derivative, so that they have the same equations of motion.
//!
//! In: L₁ and L₂. Out: whether L₁ − L₂ = df/dt, proved or refuted, and f where it is found. Never here: what else acts.
//! Source: *The Principles of Dynamics*, § 1.4; L. D. Landau and E. M. Lifshitz, *Mechanics*, § 2.

use std::collections::HashMap;

use super::equations::Equations;
use super::potential::potential;
use crate::expr::{Expr, Symbol, Zero};

/// The difference of two Lagrangians, and whether it is a total time derivative.
#[derive(Clone, Debug)]
pub struct GaugeDifference {
    /// L₁ − L₂.
    pub difference: Expr,
    /// Whether it is a total derivative: its Euler–Lagrange expressions vanish identically. `None` where neither answer is
    /// proved.
    pub total_derivative: Option<bool>,
    /// f with L₁ − L₂ = df/dt, where it is found.
    pub function: Option<Expr>,
}

impl Equations {
    /// Compares two functions of (q, q̇, t) as Lagrangians.
    pub fn gauge(&mut self, first: Expr, second: Expr) -> GaugeDifference {
        let difference = self.pool.sub(first, second);
        let difference = self.pool.simplify(difference);
        let coordinates = self.coordinates.clone();
        let time = self.symbols.time;
        let pool = &mut self.pool;
        let mut along = vec![(time, Expr::ONE)];
        for c in &coordinates {
            along.push((c.position, pool.variable(c.velocity)));
            along.push((c.velocity, pool.variable(c.acceleration)));
        }
        let mut answer = Some(true);
        for c in &coordinates {
            let momentum = pool.derivative(difference, c.velocity);
            let rate = pool.derivation(momentum, &along);
            let slope = pool.derivative(difference, c.position);
            let expression = pool.sub(rate, slope);
            match pool.is_zero(expression) {
                Zero::Proved => {}
                Zero::No => {
                    answer = Some(false);
                    break;
                }
                Zero::Numerically | Zero::Unknown => answer = None,
            }
        }
        let moving: Vec<Symbol> =
            coordinates.iter().flat_map(|c| [c.position, c.velocity]).chain([time]).collect();
        if answer == Some(true) && pool.may_have_kink(difference, &moving) {
            // proved on each side of the kinks only
            answer = None;
        }
        let function = (answer == Some(true)).then(|| self.function_of(difference)).flatten();
        GaugeDifference { difference, total_derivative: answer, function }
    }

    /// f with df/dt = e, for an e that is linear in the velocities.
    fn function_of(&mut self, e: Expr) -> Option<Expr> {
        let coordinates = self.coordinates.clone();
        let pool = &mut self.pool;
        let mut form: Vec<Expr> = Vec::new();
        let mut variables: Vec<Symbol> = Vec::new();
        for c in &coordinates {
            let slope = pool.derivative(e, c.velocity);
            form.push(pool.simplify(slope));
            variables.push(c.position);
        }
        let rest: HashMap<Symbol, Expr> =
            coordinates.iter().map(|c| (c.velocity, Expr::ZERO)).collect();
        // a slope that is written with velocities does not depend on them
        form = form.into_iter().map(|a| pool.substitute(a, &rest)).collect();
        form.push(pool.substitute(e, &rest));
        variables.push(self.symbols.time);
        let found = potential(pool, &form, &variables)?;
        let mut along = vec![(self.symbols.time, Expr::ONE)];
        for c in &coordinates {
            along.push((c.position, pool.variable(c.velocity)));
        }
        let rate = pool.derivation(found, &along);
        let difference = pool.sub(rate, e);
        (pool.is_zero(difference) == Zero::Proved).then_some(found)
    }
}
