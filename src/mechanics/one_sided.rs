//! Where a quantity is conserved on one side of a kink only.
//!
//! In: an observable that is not known to be conserved, and on which sides of the kinks of its rate, and of its own jumps, a
//! motion stays. Out: those sides on which its rate is proved to vanish while elsewhere it has a value, or beyond which the
//! observable jumps. Never here: the motion.

use std::collections::HashMap;

use super::equations::Equations;
use crate::expr::{Expr, Symbol, Zero};
use crate::model::Model;
use crate::num::Number;

/// The most kinks that are examined, in all combinations of their sides.
const MOST: usize = 16;

/// The kinks of a rate of change and the jumps of its observable.
#[derive(Clone, Debug)]
pub struct OneSided {
    /// The rate at the file's values of the parameters.
    rate: Expr,
    observable: Expr,
    kinks: Vec<Expr>,
    /// The kinks of the observable, some of which may be jumps.
    jumps: Vec<Expr>,
}

impl OneSided {
    /// The kinks and jumps of an observable, written as observables are; `None` if there are none, if the rate is not known in
    /// closed form, or if there are constraints, which a value of the rate says nothing about.
    pub fn of(model: &Model, equations: &mut Equations, observable: Expr) -> Option<OneSided> {
        if !equations.constraints.is_empty() {
            return None;
        }
        let rate = equations.rate_of(observable)?;
        let rate = equations.pool.simplify(rate);
        let observable = equations.open(observable);
        let moving = equations.moving();
        let pool = &mut equations.pool;
        let values = model.parameters.iter().filter_map(|p| {
            let value = Number::Real(p.value).canonical();
            value.is_finite().then_some((p.symbol, value))
        });
        let values: Vec<(Symbol, Number)> = values.collect();
        let values: HashMap<Symbol, Expr> =
            values.into_iter().map(|(s, n)| (s, pool.number(n))).collect();
        let rate = pool.substitute(rate, &values);
        let (rate, mut kinks) = pool.switches(rate);
        let observable = pool.substitute(observable, &values);
        // a sign is also a quotient, as x/|x|
        let (observable, mut jumps) = pool.switches(observable);
        if kinks.len() + jumps.len() > MOST {
            return None;
        }
        // no motion comes to another side of what is conserved
        let mut is_crossed = |&e: &Expr| {
            equations.pool.depends_on_any(e, &moving)
                && equations.is_conserved(e) != Some(Zero::Proved)
        };
        kinks.retain(&mut is_crossed);
        jumps.retain(&mut is_crossed);
        let any = !(kinks.is_empty() && jumps.is_empty());
        any.then_some(OneSided { rate, observable, kinks, jumps })
    }

    /// The functions that change their signs where it has kinks or jumps.
    pub fn switches(&self) -> Vec<Expr> {
        let jumps = self.jumps.iter().filter(|e| !self.kinks.contains(e));
        self.kinks.iter().chain(jumps).copied().collect()
    }

    /// The sides among those on which a motion `stayed` that it is conserved on, while beyond them it is not; empty if
    /// that is not known. The second of a pair is whether the first is positive. What does not move has the values `at`.
    pub fn sides(
        &self,
        equations: &mut Equations,
        stayed: &[(Expr, bool)],
        at: &dyn Fn(Symbol) -> f64,
    ) -> Vec<(Expr, bool)> {
        let moving = equations.moving();
        let pool = &mut equations.pool;
        let among = |switches: &[Expr]| -> Vec<(Expr, bool)> {
            switches.iter().filter_map(|e| stayed.iter().find(|(s, _)| s == e).copied()).collect()
        };
        let mut sides = among(&self.kinks);
        if !sides.is_empty()
            && pool.vanishes_on_sides(self.rate, &sides)
            && pool.has_value_beyond_kinks(self.rate, &self.kinks, &moving, at)
        {
            for side in sides.clone() {
                let fewer: Vec<(Expr, bool)> =
                    sides.iter().copied().filter(|&one| one != side).collect();
                if pool.vanishes_on_sides(self.rate, &fewer) {
                    sides = fewer;
                }
            }
            return sides;
        }
        let jumps = among(&self.jumps);
        let jump = |&(e, _): &(Expr, bool)| pool.jumps_at(self.observable, e, &moving, at);
        jumps.into_iter().filter(jump).collect()
    }
}
