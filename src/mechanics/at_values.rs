//! Whether a quantity that changes in general is constant at some values of the parameters, as an energy is where a
//! drive has amplitude 0 or a damper the constant 0.
//!
//! In: the rates of which it is made, and values. Out: the parameters whose values make it constant. Never here: a motion.

use std::collections::HashMap;

use super::equations::{Conserved, Equations, Reason};
use super::impulse_change::is_changed_by_impulse;
use super::valuation::Valuation;
use crate::expr::{Expr, Pool, Symbol, Zero};
use crate::model::Model;
use crate::num::{Number, math};

/// The number of points at which rates are evaluated before a proof is tried.
const POINTS: u64 = 3;

/// A rate up to this part of its terms may be zero.
const ROUNDING: f64 = 1e-9;

/// The greatest number of parameters that are named.
const MOST_NAMED: usize = 3;

/// Says at which values of these parameters something is constant.
pub fn constant_at(pool: &Pool, parameters: &[Symbol], values: &Valuation) -> String {
    if parameters.len() > MOST_NAMED {
        return "constant at these parameters".to_owned();
    }
    let value = |&s: &Symbol| format!("{} = {}", pool.symbol_info(s).unicode, values.at(s));
    let given: Vec<String> = parameters.iter().map(value).collect();
    format!("constant at {}", given.join(", "))
}

impl Equations {
    /// Adds the energy to what is conserved, if it is at these values of the parameters and not at all of them.
    pub fn note_energy_conserved_at(&mut self, model: &Model, values: &Valuation) {
        if self.conserved.iter().any(|known| known.name == "energy") {
            return;
        }
        let Some(parameters) = self.energy_conserved_at(values) else { return };
        let mut reason = Reason::AtValues(constant_at(&self.pool, &parameters, values));
        let expression = self.energy;
        if is_changed_by_impulse(self, model, expression) {
            reason = Reason::BetweenImpulses(Box::new(reason));
        }
        self.conserved.push(Conserved { name: "energy".to_owned(), expression, reason });
    }

    /// The parameters at whose present values the energy is conserved, although it is not at all of their values, and L
    /// (or H) has no step; `None` where that is not proved.
    pub fn energy_conserved_at(&self, values: &Valuation) -> Option<Vec<Symbol>> {
        let rate = self.energy_rate;
        if !self.law_jumps() {
            return vanishing_at(&self.pool, &[rate], values);
        }
        if !may_vanish(&self.pool, rate, values) {
            return None;
        }
        first_of(&self.pool, &[rate, self.law], values, |given| {
            let mut here = self.clone();
            here.law = at(&mut here.pool, self.law, given);
            let rate = at(&mut here.pool, rate, given);
            !here.law_jumps() && here.pool.is_zero(rate) == Zero::Proved
        })
    }
}

/// The parameters at whose present values all of these rates vanish; `None` where that is not proved.
pub fn vanishing_at(pool: &Pool, rates: &[Expr], values: &Valuation) -> Option<Vec<Symbol>> {
    if !rates.iter().all(|&rate| may_vanish(pool, rate, values)) {
        return None;
    }
    first_of(pool, rates, values, |given| {
        let mut here = pool.clone();
        rates.iter().all(|&rate| {
            let rate = at(&mut here, rate, given);
            here.is_zero(rate) == Zero::Proved
        })
    })
}

/// Of each expression whether it is 0, or free of a symbol if one is given, where the parameters are that are 0 at these values.
pub fn absent_at(pool: &Pool, parts: &[(Expr, Option<Symbol>)], values: &Valuation) -> Vec<bool> {
    let mut zeros: Vec<Symbol> = parts.iter().flat_map(|&(e, _)| pool.symbols_of(e)).collect();
    zeros.retain(|&s| values.at(s) == 0.0);
    if zeros.is_empty() {
        return vec![false; parts.len()];
    }
    let mut here = pool.clone();
    let zero = Number::Real(0.0).canonical();
    let given = zeros.into_iter().map(|s| (s, zero)).collect();
    let is_absent = |&(e, of): &(Expr, Option<Symbol>)| {
        let e = at(&mut here, e, &given);
        match of {
            Some(symbol) => !here.depends(e, symbol),
            None => here.is_zero(e) == Zero::Proved,
        }
    };
    parts.iter().map(is_absent).collect()
}

/// The first of two sets of parameters, those that are 0 and all, whose values suffice for something that depends on these
/// expressions.
fn first_of(
    pool: &Pool,
    expressions: &[Expr],
    values: &Valuation,
    suffices: impl Fn(&HashMap<Symbol, Number>) -> bool,
) -> Option<Vec<Symbol>> {
    let mut known: Vec<Symbol> = expressions.iter().flat_map(|&e| pool.symbols_of(e)).collect();
    known.retain(|&s| values.at(s).is_finite());
    known.sort_unstable();
    known.dedup();
    let zeros: Vec<Symbol> = known.iter().copied().filter(|&s| values.at(s) == 0.0).collect();
    let value = |&s: &Symbol| (s, Number::Real(values.at(s)).canonical());
    [zeros, known].into_iter().find(|given| suffices(&given.iter().map(value).collect()))
}

/// Whether a rate is 0 to rounding wherever it has a value, at points that are fixed: most rates are not, and then no proof is
/// tried.
fn may_vanish(pool: &Pool, rate: Expr, values: &Valuation) -> bool {
    let mut seen = 0;
    for n in 0..POINTS {
        let at = |s: Symbol| match values.at(s) {
            known if known.is_finite() => known,
            _ => {
                let turns = (s.index() as f64 + 1.0) * std::f64::consts::E + n as f64 * 0.7;
                0.3 + math::sin(turns).abs()
            }
        };
        let (value, size) = pool.evaluate_with_size(rate, &at);
        if value.abs() > ROUNDING * size {
            return false;
        }
        seen += u64::from(value.is_finite());
    }
    seen > 0 && !has_value_beyond_kinks(pool, rate, values)
}

/// Whether a rate surely has a value somewhere, as that of a ramp which begins later than at these points.
fn has_value_beyond_kinks(pool: &Pool, rate: Expr, values: &Valuation) -> bool {
    let mut here = pool.clone();
    let (rate, switches) = here.switches(rate);
    let mut moving = here.symbols_of(rate);
    moving.retain(|&s| !values.at(s).is_finite());
    here.has_value_beyond_kinks(rate, &switches, &moving, &|s| values.at(s))
}

/// An expression at these values.
fn at(pool: &mut Pool, e: Expr, values: &HashMap<Symbol, Number>) -> Expr {
    let values = values.iter().map(|(&s, &n)| (s, pool.number(n))).collect();
    pool.substitute(e, &values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::FunctionId;

    /// A rate c (min(max(t, 3), 4) − 3), which is zero until t = 3: no proof that it vanishes is tried, but at c = 0.
    #[test]
    fn a_rate_that_begins_late_does_not_vanish() {
        let mut pool = Pool::new();
        let [t, c] = ["t", "c"].map(|name| pool.symbol(name));
        let [time, factor] = [t, c].map(|s| pool.variable(s));
        let [three, four] = [3, 4].map(|n| pool.integer(n));
        let begun = pool.call(FunctionId::Max, &[time, three]);
        let ended = pool.call(FunctionId::Min, &[begun, four]);
        let late = pool.sub(ended, three);
        let rate = pool.mul(factor, late);
        let at = |value: f64| Valuation::default().with([(c, value)]);
        assert!(!may_vanish(&pool, rate, &at(1.0)));
        assert!(may_vanish(&pool, rate, &at(0.0)));
        assert_eq!(vanishing_at(&pool, &[rate], &at(0.0)), Some(vec![c]));
    }
}
