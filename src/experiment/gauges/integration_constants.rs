//! Gauges of the constants α of a complete integral S of the Hamilton–Jacobi equation, and of their conjugates β = ∂S/∂α.
//!
//! S is one branch of its roots: β is a constant of the motion where p = ∂S/∂q, and elsewhere the constant belongs to the other
//! branch. Each time the motion comes back to the branch, as an oscillator does after every swing, β is compared with what it is
//! then, as an angle that S knows up to turns only is another number.
//!
//! In: α and β as functions of (q, p, t), and the values of the channels at some times. Out: [`Gauge`]s. Never here: how they are
//! found (`mechanics::hamilton_jacobi`).
//! Source: *The Principles of Dynamics*, § 3.5.

use std::sync::Arc;

use super::formula_monitors::{ChannelValues, FormulaMonitors, MonitoredFormula};
use super::invariant_monitor::{ChangeLaw, ChangeRate};
use crate::analysis::{Errors, Verdict};
use crate::experiment::{Gauge, Reference};
use crate::expr::{Expr, Pool, Symbol, Zero};
use crate::mechanics::{Equations, HamiltonJacobi, Valuation, is_changed_by_impulse};
use crate::model::Model;
use crate::system::TermWatch;

/// p and ∂S/∂q are the same number if they differ by less than this part of their size.
const SAME: f64 = 1e-6;

/// Where p is less than this part of the greatest that it was, both branches have nearly the same, and nothing is compared.
const NEAR: f64 = 1e-2;

/// The gauges of one complete integral.
#[derive(Clone, Debug, Default)]
pub(super) struct IntegrationConstants {
    pool: Arc<Pool>,
    /// p − ∂S/∂q of each coordinate, with the greatest size that its terms had.
    relations: Vec<(Expr, f64)>,
    alpha: FormulaMonitors,
    /// The reference is that of the last return to the branch of S.
    beta: FormulaMonitors,
    is_on_branch: bool,
    constants: Valuation,
}

impl IntegrationConstants {
    /// Those of the complete integral of a file that can be written as functions of (q, p, t), but for an α of which
    /// a name is `gauged` already.
    pub(super) fn of(model: &Model, equations: &Equations, gauged: &[String]) -> Self {
        let Some(integral) = &model.complete_integral else { return Self::default() };
        let known = &equations.supplements.maps.new_variables;
        let all = integral.constants.iter().map(|constant| {
            let of = |symbol: Symbol| known.iter().find(|(s, _)| *s == symbol).map(|(_, e)| *e);
            Some((constant, of(constant.symbol)?, of(constant.conjugate)?))
        });
        let Some(all) = all.collect::<Option<Vec<_>>>() else { return Self::default() };
        let mut own = equations.clone();
        let proved = HamiltonJacobi::of(model, &mut own).is_some_and(|found| found.complete);
        let mut pool = std::mem::take(&mut own.pool);
        let map = all.iter().map(|&(constant, alpha, _)| (constant.symbol, alpha)).collect();
        let mut relations = Vec::new();
        for c in &model.coordinates {
            let slope = pool.derivative(integral.function, c.position);
            let slope = pool.substitute(slope, &map);
            let momentum = pool.variable(c.momentum);
            let relation = pool.sub(momentum, slope);
            // where α is the momentum itself, S has one branch
            if pool.is_zero(relation) != Zero::Proved {
                relations.push((relation, 0.0));
            }
        }
        let broken = acting(model).map(|cause| {
            let acting = model.mechanics.forces().iter().copied();
            let rate = ChangeRate::All(acting.chain([model.mechanics.dissipation()]).collect());
            ChangeLaw { shown: format!("S leaves {cause} out"), rate }
        });
        own.pool = pool;
        let mut formula = |symbol: Symbol, expression: Expr, reason: String| {
            let jumps = is_changed_by_impulse(&mut own, model, expression);
            let between = if jumps { ", between impulses" } else { "" };
            let info = own.pool.symbol_info(symbol);
            let (name, shown) = (info.name.clone(), info.unicode.clone());
            let (reason, broken) = (format!("{reason}{between}"), broken.clone());
            MonitoredFormula { name, shown, reason, proved, broken, expression }
        };
        let is_new = |symbol: Symbol| {
            let info = equations.pool.symbol_info(symbol);
            !gauged.contains(&info.name) && !gauged.contains(&info.unicode)
        };
        let alpha = all.iter().filter(|(constant, ..)| is_new(constant.symbol));
        let alpha = alpha.map(|&(constant, alpha, _)| {
            formula(constant.symbol, alpha, "constant of the complete integral S".to_owned())
        });
        let alpha: Vec<MonitoredFormula> = alpha.collect();
        let beta = all.iter().map(|&(constant, _, beta)| {
            let name = &equations.pool.symbol_info(constant.symbol).unicode;
            formula(constant.conjugate, beta, format!("∂S/∂{name}, while p = ∂S/∂q"))
        });
        let beta: Vec<MonitoredFormula> = beta.collect();
        let pool = Arc::new(own.pool);
        let [alpha, beta] =
            [alpha, beta].map(|formulas| FormulaMonitors::new(Arc::clone(&pool), formulas));
        Self { pool, relations, alpha, beta, ..Self::default() }
    }

    /// Takes the current values as the reference, also where the motion is not on the branch of S yet.
    pub(super) fn refer(
        &mut self,
        at: ChannelValues<'_>,
        terms: &TermWatch,
        constants: &Valuation,
    ) {
        if self.beta.is_empty() {
            return;
        }
        self.constants = constants.clone();
        self.is_on_branch = false;
        self.relations.iter_mut().for_each(|(_, size)| *size = 0.0);
        self.alpha.refer(at, terms, constants);
        self.beta.refer(at, terms, constants);
        self.follow_branch(at, terms);
    }

    /// Continues from saved references, those of gauges that show the same number: β from where the motion came to its branch.
    pub(super) fn restore(
        &mut self,
        known: &dyn Fn(&str, f64) -> Option<Reference>,
        now: ChannelValues<'_>,
    ) {
        self.alpha.restore(known, now);
        self.beta.restore(known, now);
    }

    /// Records the values at a time; those of a sample in the history as well.
    pub(super) fn observe(
        &mut self,
        at: ChannelValues<'_>,
        terms: &TermWatch,
        floor: f64,
        is_sample: bool,
    ) {
        if self.beta.is_empty() {
            return;
        }
        self.alpha.observe(at, terms, floor, is_sample);
        if self.follow_branch(at, terms) {
            self.beta.observe(at, terms, floor, is_sample);
        }
    }

    /// After an impulse the constants are others.
    pub(super) fn shift(&mut self, before: ChannelValues<'_>, after: ChannelValues<'_>) {
        self.alpha.shift(before, after);
        self.is_on_branch = false;
    }

    /// The gauges as shown. On another branch of S, where the constant is another function, β has no drift.
    pub(super) fn show(&self, now: ChannelValues<'_>, floor: f64, errors: Errors) -> Vec<Gauge> {
        let mut gauges = self.alpha.show(now, floor, errors);
        let beta = self.beta.show(now, floor, errors).into_iter().map(|gauge| {
            if self.is_on_branch {
                return gauge;
            }
            Gauge {
                proved: false,
                verdict: Verdict::OtherBranch,
                left: None,
                drift: f64::NAN,
                max_drift: f64::NAN,
                // what was seen is that of the constant of this branch
                history: Arc::default(),
                ..gauge
            }
        });
        gauges.extend(beta);
        gauges
    }

    /// Whether β can be compared with its reference, which is taken where the motion comes to the branch of S.
    fn follow_branch(&mut self, at: ChannelValues<'_>, terms: &TermWatch) -> bool {
        let value = |symbol: Symbol| at.of(symbol, &self.pool, &self.constants);
        let (mut is_on, mut is_near) = (true, false);
        for (relation, greatest) in &mut self.relations {
            let (value, size) = self.pool.evaluate_with_size(*relation, &value);
            *greatest = greatest.max(size);
            is_near |= are_branches_near(size, *greatest);
            // not a number where S has no slope
            is_on &= is_same(value, size);
        }
        if is_near {
            return false;
        }
        if is_on && !self.is_on_branch {
            self.beta.refer(at, terms, &self.constants);
        }
        self.is_on_branch = is_on;
        is_on
    }
}

/// What acts beside the function whose Hamilton–Jacobi equation S solves.
fn acting(model: &Model) -> Option<&'static str> {
    let friction = model.mechanics.dissipation() != Expr::ZERO;
    let forced = model.mechanics.forces().iter().any(|&force| force != Expr::ZERO);
    match (friction, forced) {
        (true, true) => Some("friction and the forces"),
        (true, false) => Some("friction"),
        (false, true) => Some("the forces"),
        (false, false) => None,
    }
}

/// Whether p, of which the terms have this size, is so small beside the greatest that both branches of S have nearly the same.
fn are_branches_near(size: f64, greatest: f64) -> bool {
    size <= NEAR * greatest
}

/// Whether p − ∂S/∂q vanishes beside its terms.
fn is_same(difference: f64, size: f64) -> bool {
    difference.abs() <= SAME * size
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_momentum_is_the_slope_of_s_to_a_millionth_and_nothing_is_compared_below_a_hundredth() {
        assert!(is_same(-1.9e-6, 2.0) && !is_same(-2.1e-6, 2.0));
        assert!(!is_same(f64::NAN, 2.0));
        assert!(are_branches_near(0.019, 2.0) && !are_branches_near(0.021, 2.0));
    }
}
