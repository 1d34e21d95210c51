//! Gauges of constants of the motion that were found while it runs; they are evaluated from the channels as they are.
//!
//! In: formulas, and the values of the channels at some times. Out: [`Gauge`]s. Never here: how they were found.

use super::invariant_monitor::{InvariantMonitor, Subject};
use crate::analysis::Errors;
use crate::experiment::{FoundConstant, Gauge};
use crate::expr::{Expr, Pool, Symbol};
use crate::mechanics::{Equations, Valuation};
use crate::model::{Allowed, Model, Scope};
use crate::system::TermWatch;

/// The constants of the motion that are followed.
#[derive(Clone, Debug, Default)]
pub(super) struct Followed {
    pool: Option<Box<Pool>>,
    monitors: Vec<InvariantMonitor>,
    constants: Valuation,
    since: f64,
}

impl Followed {
    /// Those among the formulas that can be read.
    pub(super) fn of(found: &[FoundConstant], model: &Model, equations: &Equations) -> Followed {
        let mut pool = equations.pool.clone();
        let mut monitors: Vec<InvariantMonitor> = Vec::new();
        for constant in found {
            let mut scope = Scope::new(model, Allowed::Observable, "a constant of the motion");
            let Some(expression) = scope.read(&mut pool, &constant.expression) else { continue };
            monitors.push(InvariantMonitor::new(Subject {
                name: constant.name.clone(),
                shown: constant.shown.clone(),
                reason: constant.reason.clone(),
                proved: constant.proved,
                broken: None,
                channel: monitors.len(),
                quantity: None,
                expression,
            }));
        }
        Followed { pool: Some(Box::new(pool)), monitors, ..Followed::default() }
    }

    /// Each value, with its rounding error in units of ε and whether it underflows.
    fn values(
        &self,
        time: f64,
        values: &[f64],
        places: &[(Symbol, usize)],
    ) -> Vec<(f64, (f64, bool))> {
        let Some(pool) = &self.pool else { return Vec::new() };
        let at = |symbol: Symbol| match places.iter().find(|(s, _)| *s == symbol) {
            Some(&(_, channel)) => values[channel],
            None if pool.symbol_info(symbol).name == "t" => time,
            None => self.constants.at(symbol),
        };
        let of = |e: Expr| {
            let (value, error) = pool.evaluate_with_error(e, &at);
            (value, (error, error < f64::MIN_POSITIVE && pool.underflows(e, &at)))
        };
        self.monitors.iter().map(|monitor| of(monitor.expression)).collect()
    }

    /// Takes the current values as the reference.
    pub(super) fn refer(
        &mut self,
        (time, values): (f64, &[f64]),
        terms: &TermWatch,
        constants: &Valuation,
        places: &[(Symbol, usize)],
    ) {
        if self.monitors.is_empty() {
            return;
        }
        self.constants = constants.clone();
        self.since = time;
        let (values, errors) = self.split(time, values, places);
        for (monitor, (error, underflows)) in self.monitors.iter_mut().zip(errors) {
            monitor.refer(time, &values, terms);
            monitor.measure(error, underflows);
        }
    }

    fn split(
        &self,
        time: f64,
        values: &[f64],
        places: &[(Symbol, usize)],
    ) -> (Vec<f64>, Vec<(f64, bool)>) {
        self.values(time, values, places).into_iter().unzip()
    }

    /// Shifts the references by the jump of an impulse at a time.
    pub(super) fn shift(
        &mut self,
        time: f64,
        before: &[f64],
        after: &[f64],
        places: &[(Symbol, usize)],
    ) {
        let (before, _) = self.split(time, before, places);
        let (after, _) = self.split(time, after, places);
        self.monitors.iter_mut().for_each(|monitor| monitor.shift(&before, &after));
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
        let (values, errors) = self.split(time, values, places);
        for (monitor, (error, underflows)) in self.monitors.iter_mut().zip(errors) {
            monitor.measure(error, underflows);
            if is_sample {
                monitor.sample(time, &values, terms, floor);
            } else {
                monitor.look(time, &values, terms, floor);
            }
        }
    }

    /// The gauges as shown.
    pub(super) fn show(
        &self,
        (time, values): (f64, &[f64]),
        floor: f64,
        places: &[(Symbol, usize)],
        errors: Errors,
    ) -> Vec<Gauge> {
        let (values, _) = self.split(time, values, places);
        let show = |monitor: &InvariantMonitor| monitor.show(&values, self.since, floor, errors);
        self.monitors.iter().map(show).collect()
    }
}
