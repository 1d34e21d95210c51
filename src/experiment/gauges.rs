//! The gauges of one motion: which quantities should be constant and why, their reference values, and how far they
//! have drifted since.
//!
//! In: the consequences of the law of motion; the values of the channels at some times; the terms of the conserved
//! quantities after every step. Out: [`Gauge`]s. Never here: how the values are computed.

mod drift_record;
mod formula_monitors;
mod inputs;
mod integration_constants;
mod invariant_monitor;
mod mean;
mod monitors;
mod rest_watch;
mod seen_distances;

use std::sync::Arc;

use super::attitude_gauge::{ATTITUDE_GAUGE, AttitudeGauge};
use super::residual_gauge::ResidualGauge;
use super::{FoundConstant, Gauge, Reference};
use crate::analysis::{RoundedInput, rounding_floor};
use crate::expr::{Expr, Symbol};
use crate::mechanics::Equations;
use crate::model::Model;
use crate::num::BATCH;
use crate::system::{BatchTerms, System, TermSums, TermWatch};
use formula_monitors::{ChannelValues, FormulaMonitors};
pub(super) use inputs::GaugeInputs;
use integration_constants::IntegrationConstants;
use invariant_monitor::{InvariantMonitor, MonitoredStep};
use monitors::{monitors, with_energy_opened};
use rest_watch::RestWatch;
pub(super) use seen_distances::by_rounding_of_state;

/// Rounding errors are measured once per this many samples.
const MEASURED: u64 = 16;

/// A supposed invariant is contradicted if its drift exceeds that of the proved ones by this factor; a smaller drift
/// may be due to the method.
const CONTRADICTED: f64 = 100.0;

#[derive(Clone, Debug)]
pub(super) struct Gauges {
    equations: Arc<Equations>,
    monitors: Vec<InvariantMonitor>,
    /// Constants that were found while the motion runs.
    found: FormulaMonitors,
    integration: IntegrationConstants,
    residuals: Vec<ResidualGauge>,
    attitude: Option<AttitudeGauge>,
    rest: RestWatch,
    /// The channel of each symbol that a state expression may contain.
    places: Vec<(Symbol, usize)>,
    reference_time: f64,
    reference_steps: u64,
    samples: u64,
}

impl Gauges {
    /// Creates the gauges for what `equations` finds conserved in `model`. If the energy is not conserved, they
    /// include the energy with its law of change, and the energy balance, which is constant by that law.
    pub(super) fn new(model: &Model, equations: &Arc<Equations>, system: &System) -> Gauges {
        let mut equations = with_energy_opened(equations);
        let monitors = monitors(model, &mut equations, system);
        let equations = &equations;
        let names: Vec<String> =
            monitors.iter().map(|monitor| monitor.invariant.name.clone()).collect();
        Gauges {
            monitors,
            found: FormulaMonitors::default(),
            integration: IntegrationConstants::of(model, equations, &names),
            residuals: ResidualGauge::all(model, equations, system),
            attitude: AttitudeGauge::of(system),
            rest: RestWatch::new(system),
            places: system.symbol_channels(equations),
            equations: Arc::clone(equations),
            reference_time: 0.0,
            reference_steps: 0,
            samples: 0,
        }
    }

    pub(super) fn refer(&mut self, now: &GaugeInputs<'_>) {
        self.reference_time = now.time;
        self.reference_steps = now.steps;
        self.samples = 0;
        self.rest.begin(now.system, now.values);
        for monitor in &mut self.monitors {
            let (equations, values) = (&*self.equations, now.constants);
            let energy = || equations.energy_conserved_at(values);
            monitor.take_parameters(&equations.pool, values, energy);
            monitor.refer(now.time, now.values, now.terms);
        }
        self.refer_found(now);
        let at = now.channels(&self.places);
        self.integration.refer(at, now.terms, now.constants);
        self.residuals.iter_mut().for_each(|residual| residual.refer(now.time));
        self.attitude.iter_mut().for_each(|attitude| attitude.refer(now.time));
        // which measures errors as well
        self.sample(now, true);
    }

    /// Takes these constants of the motion in place of those followed before.
    pub(super) fn follow(&mut self, found: &[FoundConstant], model: &Model) {
        self.found = FormulaMonitors::of_found(found, model, &self.equations);
    }

    /// Takes the current values of the constants that were found as their reference.
    pub(super) fn refer_found(&mut self, now: &GaugeInputs<'_>) {
        let at = now.channels(&self.places);
        self.found.refer(at, now.terms, now.constants);
    }

    /// Continues from the references of gauges with the same names, where both show the same value.
    pub(super) fn restore(&mut self, references: &[Reference], now: &GaugeInputs<'_>) {
        let known = |name: &str, value: f64| {
            let same = |r: &&Reference| r.name == name && r.value.to_bits() == value.to_bits();
            references.iter().find(same)
        };
        for monitor in &mut self.monitors {
            if let Some(reference) =
                known(&monitor.invariant.name, now.values[monitor.invariant.channel])
            {
                self.reference_time = reference.since;
                self.reference_steps = 0;
                monitor.restore(reference, now.time);
            }
        }
        for residual in &mut self.residuals {
            if let Some(reference) = known(residual.name(), residual.now(now.residuals)) {
                residual.restore(reference);
            }
        }
        if let Some(attitude) = &mut self.attitude
            && let Some(reference) = known(ATTITUDE_GAUGE, attitude.now(now.values))
        {
            attitude.restore(reference);
        }
        let known = |name: &str, value: f64| known(name, value).cloned();
        let at = now.channels(&self.places);
        self.integration.restore(&known, at);
    }

    /// Shifts the references by the jump of an impulse at a time, so that the jump does not count as drift. The energy balance
    /// accounts for impulses by its own law.
    pub(super) fn shift(&mut self, time: f64, before: &[f64], after: &[f64]) {
        self.monitors.iter_mut().for_each(|monitor| monitor.shift(before, after));
        let at = |values| ChannelValues { time, values, places: &self.places };
        self.found.shift(at(before), at(after));
        self.integration.shift(at(before), at(after));
    }

    /// Records the values at one of the evenly spaced times. If these are farther apart than the steps, they may
    /// always meet the motion at the same phase, so the histories are built from other samples.
    pub(super) fn sample(&mut self, now: &GaugeInputs<'_>, dense: bool) {
        self.samples += 1;
        // errors change slowly, and are the most expensive part
        if self.samples.is_power_of_two() || self.samples.is_multiple_of(MEASURED) {
            self.measure(now);
        }
        if dense {
            self.observe_on_the_way(now.time, now.steps, now.values, now.terms);
        } else {
            self.observe(now);
        }
        for residual in &mut self.residuals {
            residual.sample(now.time, now.residuals);
        }
        if let Some(attitude) = &mut self.attitude {
            attitude.sample(now.time, now.values);
        }
    }

    /// Records the values at any other time.
    pub(super) fn observe(&mut self, now: &GaugeInputs<'_>) {
        let floor = self.floor(now.steps);
        self.rest.observe(now.values);
        for monitor in &mut self.monitors {
            monitor.observe(now.time, now.values, now.terms, floor);
        }
        let at = now.channels(&self.places);
        self.found.observe(at, now.terms, floor, false);
        self.integration.observe(at, now.terms, floor, false);
        for residual in &mut self.residuals {
            residual.observe(now.residuals);
        }
        if let Some(attitude) = &mut self.attitude {
            attitude.observe(now.values);
        }
    }

    /// Records the values at an intermediate time.
    pub(super) fn observe_on_the_way(
        &mut self,
        time: f64,
        steps: u64,
        values: &[f64],
        terms: &TermWatch,
    ) {
        let floor = self.floor(steps);
        self.rest.observe(values);
        for monitor in &mut self.monitors {
            monitor.sample(time, values, terms, floor);
        }
        let at = ChannelValues { time, values, places: &self.places };
        self.found.observe(at, terms, floor, true);
        self.integration.observe(at, terms, floor, true);
    }

    /// Records the terms at the end of a step or within it.
    pub(super) fn step(&mut self, time: f64, steps: u64, terms: &TermWatch, dense: bool) {
        let end = MonitoredStep { time, floor: self.floor(steps), dense };
        self.monitors.iter_mut().for_each(|monitor| monitor.step(end, terms));
    }

    /// The monitors of quantities that have terms, by their places: the quantity, and what its terms were at rest.
    pub(super) fn summed(&self) -> impl Iterator<Item = (usize, usize, &[f64])> {
        fn summed((place, monitor): (usize, &InvariantMonitor)) -> Option<(usize, usize, &[f64])> {
            let (quantity, at_rest) = monitor.terms_at_rest()?;
            Some((place, quantity, at_rest))
        }
        self.monitors.iter().enumerate().filter_map(summed)
    }

    /// Records the sums over the terms at the end of a step for the monitors at these places. `by_state` says by how much rounding of
    /// the state changes a quantity.
    pub(super) fn step_with(
        &mut self,
        (time, steps): (f64, u64),
        sums: impl Iterator<Item = (usize, TermSums)>,
        work: f64,
        mut by_state: impl FnMut(usize) -> Option<(f64, RoundedInput)>,
    ) {
        let end = MonitoredStep { time, floor: self.floor(steps), dense: true };
        for (place, sums) in sums {
            self.monitors[place].step_with(end, (sums, work), &mut by_state);
        }
    }

    /// Records the terms at the ends of several steps or within them. Each is given by its time, the number of steps up to it,
    /// and whether rows lie within the step that it ends. `by_state` is as for one, of the state with this number.
    pub(super) fn steps(
        &mut self,
        ends: impl Iterator<Item = (f64, u64, bool)>,
        terms: &BatchTerms,
        by_state: &mut dyn FnMut(usize, usize) -> Option<(f64, RoundedInput)>,
    ) {
        let mut known = [MonitoredStep { time: 0.0, floor: 0.0, dense: false }; BATCH];
        let mut count = 0;
        for (end, (time, steps, dense)) in known.iter_mut().zip(ends) {
            *end = MonitoredStep { time, floor: self.floor(steps), dense };
            count += 1;
        }
        self.monitors
            .iter_mut()
            .for_each(|monitor| monitor.steps(terms, &known[..count], by_state));
    }

    /// The rounding error that a value of size 1 may have gathered since the reference.
    fn floor(&self, steps: u64) -> f64 {
        rounding_floor(steps.saturating_sub(self.reference_steps))
    }

    pub(super) fn show(&self, now: &GaugeInputs<'_>) -> Arc<[Gauge]> {
        let floor = self.floor(now.steps);
        let is_at_rest =
            self.rest.is_in_place() && self.monitors.iter().any(InvariantMonitor::was_slow);
        let show = |monitor: &InvariantMonitor| {
            let of_state = |expression| self.change_by_rounding(expression, now);
            monitor.show(
                now.values,
                self.reference_time,
                (floor, now.errors),
                is_at_rest,
                &of_state,
            )
        };
        let mut shown: Vec<Gauge> = self.monitors.iter().map(show).collect();
        let at = now.channels(&self.places);
        shown.extend(self.found.show(at, floor, now.errors));
        shown.extend(self.integration.show(at, floor, now.errors));
        contradict(&mut shown);
        let attitude = self.attitude.iter().map(|attitude| attitude.show(now.values));
        let constraints = self.residuals.iter().enumerate().map(|(k, residual)| {
            residual.show(now.values, now.residuals, now.system.is_released(k))
        });
        shown.into_iter().chain(constraints).chain(attitude).collect()
    }

    /// By how much rounding of a state changes an expression, in units of ε, and the variable that changes it most.
    fn change_by_rounding(
        &self,
        expression: Expr,
        now: &GaugeInputs<'_>,
    ) -> Option<(f64, RoundedInput)> {
        let Equations { pool, symbols, .. } = &*self.equations;
        let at = |symbol: Symbol| now.value_of(symbol, &self.places, &self.equations);
        let inputs = self.places.iter().map(|&(symbol, _)| symbol).filter(|s| *s != symbols.energy);
        let errors = inputs.map(|input| (input, pool.error_by_input(expression, &at, input)));
        let errors: Vec<(Symbol, f64)> =
            errors.filter(|&(_, error)| error > 0.0 && error.is_finite()).collect();
        let &(input, _) = errors.iter().max_by(|(_, one), (_, other)| one.total_cmp(other))?;
        let value = at(input).abs();
        let name = pool.symbol_info(input).name.clone();
        let change = errors.iter().map(|(_, error)| error).sum();
        Some((change, RoundedInput { name, digits: value.next_up() - value }))
    }

    /// Measures the rounding error of every gauge's value.
    fn measure(&mut self, now: &GaugeInputs<'_>) {
        for k in 0..self.monitors.len() {
            // dear, and rarely needed
            if self.monitors[k].is_seen() {
                let change = self.change_by_rounding(self.monitors[k].invariant.expression, now);
                self.monitors[k].measure_state(change);
            }
        }
        let equations = &self.equations;
        let at = |symbol: Symbol| now.value_of(symbol, &self.places, equations);
        for monitor in &mut self.monitors {
            let (_, error) = equations.pool.evaluate_with_error(monitor.invariant.expression, &at);
            let underflows = error < f64::MIN_POSITIVE
                && equations.pool.underflows(monitor.invariant.expression, &at);
            // if the error of the terms is not finite, the value itself is the measure
            let value = now.values[monitor.invariant.channel].abs();
            let error = if error.is_finite() { error.max(value) } else { value };
            monitor.measure(error, underflows);
        }
    }
}

/// Marks an unproved invariant as contradicted if it drifts far more than the proved ones. Otherwise its drift is
/// attributed to the method.
fn contradict(gauges: &mut [Gauge]) {
    let proved = gauges.iter().filter(|gauge| gauge.proved).map(|gauge| gauge.max_drift);
    let proved = proved.fold(0.0, f64::max);
    for gauge in gauges.iter_mut().filter(|gauge| !gauge.proved && gauge.left.is_some()) {
        if gauge.max_drift > CONTRADICTED * proved {
            gauge.reason.push_str("; contradicted by the run");
        } else {
            gauge.left = None;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gauge(proved: bool, max_drift: f64) -> Gauge {
        let left = (max_drift > 1e-6).then_some(0.5);
        Gauge { proved, left, ..Gauge::drifted(max_drift) }
    }

    /// A drift a hundred times that of a proved invariant is not due to the method.
    #[test]
    fn what_is_supposed_is_contradicted_where_the_method_is_not_to_blame() {
        for (supposed, proved, contradicted) in
            [(1e-3, 0.99e-5, true), (1e-3, 1.01e-5, false), (2e-6, 0.0, true), (0.9e-6, 0.0, false)]
        {
            let mut gauges = [gauge(true, proved), gauge(false, supposed)];
            contradict(&mut gauges);
            let marked = gauges[1].reason == "stated by the file; contradicted by the run";
            assert_eq!(marked, contradicted, "{supposed} beside {proved}");
            assert_eq!(gauges[1].left.is_some(), contradicted, "{supposed} beside {proved}");
            assert_eq!(gauges[0].reason, "stated by the file");
        }
    }
}
