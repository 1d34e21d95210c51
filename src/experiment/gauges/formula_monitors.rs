//! Gauges of quantities that no channel has: formulas, which are evaluated from the channels as they are.
//!
//! In: formulas, and the values of the channels at some times. Out: [`Gauge`]s. Never here: how the formulas were found.

use std::sync::Arc;

use super::invariant_monitor::{ChangeLaw, InvariantMonitor, MonitoredInvariant};
use crate::analysis::Errors;
use crate::experiment::{FoundConstant, Gauge, Reference};
use crate::expr::{Expr, Pool, Symbol};
use crate::mechanics::{Equations, Valuation};
use crate::model::{Allowed, Model, Scope};
use crate::system::TermWatch;

/// The monitors of some formulas, with one reference time.
#[derive(Clone, Debug, Default)]
pub(super) struct FormulaMonitors {
    pool: Arc<Pool>,
    monitors: Vec<InvariantMonitor>,
    constants: Valuation,
    since: f64,
}

pub(super) struct MonitoredFormula {
    pub(super) name: String,
    pub(super) shown: String,
    pub(super) reason: String,
    pub(super) proved: bool,
    /// Why it is not constant, if it is known not to be.
    pub(super) broken: Option<ChangeLaw>,
    pub(super) expression: Expr,
}

#[derive(Clone, Copy)]
pub(super) struct ChannelValues<'a> {
    pub(super) time: f64,
    pub(super) values: &'a [f64],
    /// The channel of each symbol that a formula may contain.
    pub(super) places: &'a [(Symbol, usize)],
}

impl ChannelValues<'_> {
    /// The value of a symbol: that of its channel, the time, or a constant.
    pub(super) fn of(&self, symbol: Symbol, pool: &Pool, constants: &Valuation) -> f64 {
        match self.places.iter().find(|(s, _)| *s == symbol) {
            Some(&(_, channel)) => self.values[channel],
            None if pool.symbol_info(symbol).name == "t" => self.time,
            None => constants.at(symbol),
        }
    }
}

struct FormulaValues {
    values: Vec<f64>,
    /// The rounding error of each, in units of ε, and whether it underflows.
    errors: Vec<(f64, bool)>,
}

impl FormulaMonitors {
    /// The monitors of formulas in `pool`, without a reference.
    pub(super) fn new(
        pool: Arc<Pool>,
        formulas: impl IntoIterator<Item = MonitoredFormula>,
    ) -> Self {
        let monitor = |(place, formula): (usize, MonitoredFormula)| {
            let MonitoredFormula { name, shown, reason, proved, broken, expression } = formula;
            InvariantMonitor::new(MonitoredInvariant {
                name,
                shown,
                reason,
                proved,
                broken,
                channel: place,
                quantity: None,
                expression,
            })
        };
        let monitors = formulas.into_iter().enumerate().map(monitor).collect();
        Self { pool, monitors, ..Self::default() }
    }

    /// Those of the constants of the motion that were found while it runs, as far as their formulas can be read.
    pub(super) fn of_found(found: &[FoundConstant], model: &Model, equations: &Equations) -> Self {
        let mut pool = equations.pool.clone();
        let formula = |constant: &FoundConstant| {
            let mut scope = Scope::new(model, Allowed::Observable, "a constant of the motion");
            let expression = scope.read(&mut pool, &constant.expression)?;
            let FoundConstant { name, shown, reason, proved, .. } = constant.clone();
            Some(MonitoredFormula { name, shown, reason, proved, broken: None, expression })
        };
        let formulas: Vec<MonitoredFormula> = found.iter().filter_map(formula).collect();
        Self::new(Arc::new(pool), formulas)
    }

    pub(super) fn is_empty(&self) -> bool {
        self.monitors.is_empty()
    }

    fn values(&self, at: ChannelValues<'_>) -> FormulaValues {
        let pool = &*self.pool;
        let value = |symbol: Symbol| at.of(symbol, pool, &self.constants);
        let of = |monitor: &InvariantMonitor| {
            let (number, error) = pool.evaluate_with_error(monitor.invariant.expression, &value);
            let underflows =
                error < f64::MIN_POSITIVE && pool.underflows(monitor.invariant.expression, &value);
            (number, (error, underflows))
        };
        let (values, errors) = self.monitors.iter().map(of).unzip();
        FormulaValues { values, errors }
    }

    /// Takes the current values as the reference, under these values of the parameters.
    pub(super) fn refer(
        &mut self,
        at: ChannelValues<'_>,
        terms: &TermWatch,
        constants: &Valuation,
    ) {
        if self.is_empty() {
            return;
        }
        self.constants = constants.clone();
        self.since = at.time;
        let known = self.values(at);
        for (monitor, (error, underflows)) in self.monitors.iter_mut().zip(known.errors) {
            monitor.take_parameters(&self.pool, constants, || None);
            monitor.refer(at.time, &known.values, terms);
            monitor.measure(error, underflows);
        }
    }

    /// Continues from saved references, those of gauges that show the same number.
    pub(super) fn restore(
        &mut self,
        known: &dyn Fn(&str, f64) -> Option<Reference>,
        now: ChannelValues<'_>,
    ) {
        let FormulaValues { values, .. } = self.values(now);
        for (monitor, value) in self.monitors.iter_mut().zip(values) {
            let Some(reference) = known(&monitor.invariant.name, value) else { continue };
            monitor.restore(&reference, now.time);
            self.since = reference.since;
        }
    }

    /// Shifts the references by the jump of an impulse.
    pub(super) fn shift(&mut self, before: ChannelValues<'_>, after: ChannelValues<'_>) {
        let [before, after] = [before, after].map(|at| self.values(at).values);
        self.monitors.iter_mut().for_each(|monitor| monitor.shift(&before, &after));
    }

    /// Records the values at a time; those of a sample in the history as well.
    pub(super) fn observe(
        &mut self,
        at: ChannelValues<'_>,
        terms: &TermWatch,
        floor: f64,
        is_sample: bool,
    ) {
        let FormulaValues { values, errors } = self.values(at);
        for (monitor, (error, underflows)) in self.monitors.iter_mut().zip(errors) {
            monitor.measure(error, underflows);
            if is_sample {
                monitor.sample(at.time, &values, terms, floor);
            } else {
                monitor.observe(at.time, &values, terms, floor);
            }
        }
    }

    pub(super) fn show(&self, now: ChannelValues<'_>, floor: f64, errors: Errors) -> Vec<Gauge> {
        let FormulaValues { values, .. } = self.values(now);
        let show = |monitor: &InvariantMonitor| {
            monitor.show(&values, self.since, (floor, errors), false, &|_| None)
        };
        self.monitors.iter().map(show).collect()
    }
}
