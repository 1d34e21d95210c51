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

use super::invariant_monitor::{InvariantMonitor, Subject};
use crate::analysis::{Errors, Verdict};
use crate::experiment::{Gauge, Reference};
use crate::expr::{Expr, Pool, Symbol};
use crate::mechanics::{Equations, HamiltonJacobi, Valuation};
use crate::model::Model;
use crate::system::TermWatch;

/// p and ∂S/∂q are the same number if they differ by less than this part of their size.
const SAME: f64 = 1e-6;

/// Where p is less than this part of the greatest that it was, both branches have nearly the same, and nothing is compared.
const NEAR: f64 = 1e-2;

/// The gauges of one complete integral.
#[derive(Clone, Debug, Default)]
pub(super) struct IntegrationConstants {
    pool: Option<Box<Pool>>,
    /// p − ∂S/∂q of each coordinate, with the greatest size that its terms had.
    relations: Vec<(Expr, f64)>,
    /// α…, then β….
    alpha: Vec<InvariantMonitor>,
    beta: Vec<InvariantMonitor>,
    /// Since when the motion is on the branch of S; `None` if it is not.
    on_branch: Option<f64>,
    since: f64,
    constants: Valuation,
}

/// The value of a gauge, with its rounding error in units of ε and whether it underflows.
type Valued = (f64, (f64, bool));

impl IntegrationConstants {
    /// Those of the complete integral of a file that can be written as functions of (q, p, t), but for an α of which
    /// a name is `gauged` already.
    pub(super) fn of(model: &Model, equations: &Equations, gauged: &[String]) -> Self {
        let Some(integral) = &model.complete_integral else { return Self::default() };
        let known = &equations.supplements.new_variables;
        let all = integral.constants.iter().map(|constant| {
            let of = |symbol: Symbol| known.iter().find(|(s, _)| *s == symbol).map(|(_, e)| *e);
            Some((constant, of(constant.symbol)?, of(constant.conjugate)?))
        });
        let Some(all) = all.collect::<Option<Vec<_>>>() else { return Self::default() };
        let mut own = equations.clone();
        let proved = HamiltonJacobi::of(model, &mut own).is_some_and(|found| found.complete);
        let mut pool = own.pool;
        let map = all.iter().map(|&(constant, alpha, _)| (constant.symbol, alpha)).collect();
        let relations = model.coordinates.iter().map(|c| {
            let slope = pool.derivative(integral.function, c.position);
            let slope = pool.substitute(slope, &map);
            let momentum = pool.variable(c.momentum);
            (pool.sub(momentum, slope), 0.0)
        });
        let relations = relations.collect();
        let monitor = |place: usize, symbol: Symbol, expression: Expr, reason: &str| {
            let info = pool.symbol_info(symbol);
            InvariantMonitor::new(Subject {
                name: info.name.clone(),
                shown: info.unicode.clone(),
                reason: reason.to_owned(),
                proved,
                broken: None,
                channel: place,
                quantity: None,
                expression,
            })
        };
        let is_new = |symbol: Symbol| {
            let info = pool.symbol_info(symbol);
            !gauged.contains(&info.name) && !gauged.contains(&info.unicode)
        };
        let new = all.iter().filter(|(constant, ..)| is_new(constant.symbol)).enumerate();
        let alpha = new
            .map(|(i, &(constant, alpha, _))| {
                monitor(i, constant.symbol, alpha, "constant of the complete integral S")
            })
            .collect();
        let beta = all
            .iter()
            .enumerate()
            .map(|(i, &(constant, _, beta))| {
                let name = &pool.symbol_info(constant.symbol).unicode;
                monitor(i, constant.conjugate, beta, &format!("∂S/∂{name}, while p = ∂S/∂q"))
            })
            .collect();
        Self { relations, alpha, beta, pool: Some(Box::new(pool)), ..Self::default() }
    }

    /// Takes the current values as the reference.
    pub(super) fn refer(
        &mut self,
        (time, values): (f64, &[f64]),
        terms: &TermWatch,
        constants: &Valuation,
        places: &[(Symbol, usize)],
    ) {
        if self.beta.is_empty() {
            return;
        }
        self.constants = constants.clone();
        (self.since, self.on_branch) = (time, None);
        self.relations.iter_mut().for_each(|(_, size)| *size = 0.0);
        let known = self.values(&self.alpha, (time, values), places);
        refer(&mut self.alpha, &known, time, terms);
        // also where the motion is not on the branch of S yet
        let known = self.values(&self.beta, (time, values), places);
        refer(&mut self.beta, &known, time, terms);
        self.follow_branch((time, values), terms, places);
    }

    /// Continues from saved references, those of gauges that show the same number: β from where the motion came to its branch.
    pub(super) fn restore(
        &mut self,
        known: &dyn Fn(&str, f64) -> Option<Reference>,
        now: (f64, &[f64]),
        places: &[(Symbol, usize)],
    ) {
        for of_alpha in [true, false] {
            let monitors = if of_alpha { &self.alpha } else { &self.beta };
            let values = self.values(monitors, now, places);
            let monitors = if of_alpha { &mut self.alpha } else { &mut self.beta };
            for (monitor, (value, _)) in monitors.iter_mut().zip(values) {
                let Some(reference) = known(&monitor.name, value) else { continue };
                monitor.restore(&reference, now.0);
                match &mut self.on_branch {
                    Some(since) if !of_alpha => *since = reference.since,
                    _ => self.since = reference.since,
                }
            }
        }
    }

    /// Records the values at a time; those of a sample in the history as well.
    pub(super) fn look(
        &mut self,
        (time, values): (f64, &[f64]),
        terms: &TermWatch,
        floor: f64,
        places: &[(Symbol, usize)],
        is_sample: bool,
    ) {
        if self.beta.is_empty() {
            return;
        }
        let now = (time, values);
        let known = self.values(&self.alpha, now, places);
        look(&mut self.alpha, &known, (time, terms, floor), is_sample);
        if self.follow_branch(now, terms, places) {
            let known = self.values(&self.beta, now, places);
            look(&mut self.beta, &known, (time, terms, floor), is_sample);
        }
    }

    /// After an impulse the constants are others.
    pub(super) fn shift(
        &mut self,
        time: f64,
        before: &[f64],
        after: &[f64],
        places: &[(Symbol, usize)],
    ) {
        let numbers = |values: &[f64]| -> Vec<f64> {
            let all = self.values(&self.alpha, (time, values), places);
            all.into_iter().map(|(value, _)| value).collect()
        };
        let (before, after) = (numbers(before), numbers(after));
        self.alpha.iter_mut().for_each(|monitor| monitor.shift(&before, &after));
        self.on_branch = None;
    }

    /// The gauges as shown.
    pub(super) fn show(
        &self,
        now: (f64, &[f64]),
        floor: f64,
        places: &[(Symbol, usize)],
        errors: Errors,
    ) -> Vec<Gauge> {
        let numbers = |all: &[InvariantMonitor]| -> Vec<f64> {
            self.values(all, now, places).into_iter().map(|(value, _)| value).collect()
        };
        let alpha = numbers(&self.alpha);
        let alpha =
            self.alpha.iter().map(|monitor| monitor.show(&alpha, self.since, floor, errors));
        let beta = numbers(&self.beta);
        let beta = self.beta.iter().map(|monitor| {
            let since = self.on_branch.unwrap_or(self.since);
            let gauge = monitor.show(&beta, since, floor, errors);
            if self.on_branch.is_some() {
                return gauge;
            }
            let law = "p is that of another branch of S".to_owned();
            let reason = "other branch".to_owned();
            let verdict = Verdict::Broken(law);
            // the drift that was seen is that of the constant of this branch
            let (unknown, history) = (f64::NAN, Arc::default());
            Gauge {
                reason,
                proved: false,
                verdict,
                drift: unknown,
                max_drift: unknown,
                left: None,
                history,
                ..gauge
            }
        });
        alpha.chain(beta).collect()
    }

    /// Whether β can be compared with its reference, which is taken where the motion comes to the branch of S.
    fn follow_branch(
        &mut self,
        (time, values): (f64, &[f64]),
        terms: &TermWatch,
        places: &[(Symbol, usize)],
    ) -> bool {
        let Some(pool) = &self.pool else { return false };
        let at = |symbol: Symbol| value_of(pool, symbol, (time, values), &self.constants, places);
        let (mut is_on, mut is_near) = (true, false);
        for (relation, greatest) in &mut self.relations {
            let (value, size) = pool.evaluate_with_size(*relation, &at);
            *greatest = greatest.max(size);
            is_near |= size <= NEAR * *greatest;
            // not a number where S has no slope
            is_on &= value.abs() <= SAME * size;
        }
        if is_near {
            return false;
        }
        if !is_on {
            self.on_branch = None;
        } else if self.on_branch.is_none() {
            self.on_branch = Some(time);
            let known = self.values(&self.beta, (time, values), places);
            refer(&mut self.beta, &known, time, terms);
        }
        is_on
    }

    fn values(
        &self,
        of: &[InvariantMonitor],
        now: (f64, &[f64]),
        places: &[(Symbol, usize)],
    ) -> Vec<Valued> {
        let Some(pool) = &self.pool else { return Vec::new() };
        let at = |symbol: Symbol| value_of(pool, symbol, now, &self.constants, places);
        let value = |e: Expr| {
            let (value, error) = pool.evaluate_with_error(e, &at);
            (value, (error, error < f64::MIN_POSITIVE && pool.underflows(e, &at)))
        };
        of.iter().map(|monitor| value(monitor.expression)).collect()
    }
}

fn value_of(
    pool: &Pool,
    symbol: Symbol,
    (time, values): (f64, &[f64]),
    constants: &Valuation,
    places: &[(Symbol, usize)],
) -> f64 {
    match places.iter().find(|(s, _)| *s == symbol) {
        Some(&(_, channel)) => values[channel],
        None if pool.symbol_info(symbol).name == "t" => time,
        None => constants.at(symbol),
    }
}

fn refer(monitors: &mut [InvariantMonitor], known: &[Valued], time: f64, terms: &TermWatch) {
    let values: Vec<f64> = known.iter().map(|(value, _)| *value).collect();
    for (monitor, &(_, (error, underflows))) in monitors.iter_mut().zip(known) {
        monitor.refer(time, &values, terms);
        monitor.measure(error, underflows);
    }
}

fn look(
    monitors: &mut [InvariantMonitor],
    known: &[Valued],
    (time, terms, floor): (f64, &TermWatch, f64),
    is_sample: bool,
) {
    let values: Vec<f64> = known.iter().map(|(value, _)| *value).collect();
    for (monitor, &(_, (error, underflows))) in monitors.iter_mut().zip(known) {
        monitor.measure(error, underflows);
        if is_sample {
            monitor.sample(time, &values, terms, floor);
        } else {
            monitor.look(time, &values, terms, floor);
        }
    }
}
