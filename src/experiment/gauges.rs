//! The gauges of one motion: which quantities should be constant and why, what they were at the
//! reference, and how far they have drifted since.
//!
//! In: what follows from the law of motion, and the values of the channels at even times. Out:
//! [`Gauge`]s. Never here: how the values were computed.

use std::collections::HashMap;
use std::sync::Arc;

use super::attitude::Attitude;
use super::law::{EnergyLaw, LONGEST};
use super::residual::Residual;
use super::{Gauge, Reference};
use crate::analysis::{History, Stretch, Verdict, rounding_floor};
use crate::expr::{Expr, Symbol};
use crate::mechanics::{Equations, casimir_rate};
use crate::model::{Mechanics, Model};
use crate::system::{ChannelKind, System};

/// The gauge that is constant by the law of the energy's change.
const LEDGER: &str = "energy ledger";

/// A value is kept but for rounding while its drift is below this: half of all digits.
const KEPT: f64 = 1e-8;

/// Sizes are measured at every so many samples.
const MEASURED: u64 = 16;

/// Where a motion begins near rest its terms grow from almost nothing: a drift that is as small as this beside the terms
/// that are there now is no harm either.
const SMALL: f64 = 1e-6;

/// All gauges of one system.
#[derive(Clone, Debug)]
pub(super) struct Gauges {
    equations: Arc<Equations>,
    needles: Vec<Needle>,
    residuals: Vec<Residual>,
    attitude: Option<Attitude>,
    /// For each symbol an expression of the state may hold: its channel.
    places: Vec<(Symbol, usize)>,
    reference_time: f64,
    reference_steps: u64,
    samples: u64,
}

/// One gauge's own memory.
#[derive(Clone, Debug)]
struct Needle {
    name: String,
    shown: String,
    reason: String,
    /// Why it is not constant, where it is not.
    broken: Option<String>,
    channel: usize,
    /// What its size is measured by.
    expression: Expr,
    /// Whether its reference jumps with a blow.
    jumps: bool,
    /// Its value when the reference was taken.
    initial: f64,
    /// What distances are measured from: the initial value, and what blows have added to it.
    reference: f64,
    /// The greatest size of its terms seen since the reference: what rounding is relative to.
    size: f64,
    /// The same, as long as the value was kept but for rounding: what drift is relative to. The size of what a method
    /// has ruined measures nothing.
    scale: f64,
    /// The greatest distance from the reference since then.
    farthest: f64,
    /// What it was at the last blow, which makes other terms of the old ones.
    settled: f64,
    /// The distances, with their signs.
    distances: History,
}

impl Gauges {
    /// The gauges of what `equations` finds conserved in `model`; where the energy is not, the
    /// energy with the law of its change, and the energy ledger, which is constant by that law.
    pub(super) fn new(model: &Model, equations: &Arc<Equations>, system: &System) -> Gauges {
        let equations = &Arc::new(with_energy_opened(equations));
        let find = |kind: ChannelKind| system.channels().iter().position(|c| c.kind == kind);
        let mut needles = Vec::new();
        let mut add = |name: &str, reason: String, broken, kind, expression| {
            let Some(channel) = find(kind) else { return };
            let shown = system.channels()[channel].shown.clone();
            needles.push(Needle::new(name, shown, reason, broken, channel, expression));
        };
        if !equations.conserved.iter().any(|c| c.name == "energy") {
            let law = EnergyLaw::of(model, equations);
            add("energy", law.cause, Some(law.rate), ChannelKind::Energy, equations.energy);
            let reason = "E less the work done on it".to_owned();
            add(LEDGER, reason, None, ChannelKind::Ledger, equations.energy);
        } else if !model.impulses.is_empty() {
            let reason = "E less what the blows gave".to_owned();
            add(LEDGER, reason, None, ChannelKind::Ledger, equations.energy);
        }
        for (i, conserved) in equations.conserved.iter().enumerate() {
            let kind = if conserved.name == "energy" {
                ChannelKind::Energy
            } else {
                ChannelKind::Conserved(i)
            };
            let reason = conserved.reason.to_string();
            add(&conserved.name, reason, None, kind, conserved.expression);
        }
        for (i, (name, casimir, law)) in changing_casimirs(model, equations) {
            let reason = "Casimir; a force acts".to_owned();
            add(&name, reason, Some(law), ChannelKind::Casimir(i), casimir);
        }
        // the energy first, whatever else there is
        needles.sort_by_key(|needle| needle.channel != find(ChannelKind::Energy).unwrap_or(0));
        let mut places = Vec::new();
        for (i, c) in equations.coordinates.iter().enumerate() {
            for (symbol, kind) in [
                (c.position, ChannelKind::Position(i)),
                (c.velocity, ChannelKind::Velocity(i)),
                (c.momentum, ChannelKind::Momentum(i)),
            ] {
                places.extend(find(kind).map(|channel| (symbol, channel)));
            }
        }
        places.extend(find(ChannelKind::Energy).map(|channel| (equations.symbols.energy, channel)));
        for (i, symbol) in equations.beside.attitude_symbols.iter().flatten().flatten().enumerate()
        {
            places.extend(find(ChannelKind::Attitude(i)).map(|channel| (*symbol, channel)));
        }
        let residuals = Residual::all(model, equations, system);
        let attitude = Attitude::of(system);
        let equations = Arc::clone(equations);
        Gauges {
            equations,
            needles,
            residuals,
            attitude,
            places,
            reference_time: 0.0,
            reference_steps: 0,
            samples: 0,
        }
    }

    /// Takes the present values as the reference.
    pub(super) fn refer(&mut self, now: &Present<'_>) {
        self.reference_time = now.time;
        self.reference_steps = now.steps;
        self.samples = 0;
        for needle in &mut self.needles {
            needle.refer(now.values);
        }
        self.residuals.iter_mut().for_each(|residual| residual.refer(now.time));
        self.attitude.iter_mut().for_each(|attitude| attitude.refer(now.time));
        self.measure(now);
        self.sample(now);
    }

    /// Measures from where other gauges of the same names measured from, where these show the same values as those did.
    pub(super) fn restore(&mut self, references: &[Reference]) {
        let known = |needle: &Needle| {
            let value = needle.reference.to_bits();
            references.iter().find(|r| r.name == needle.name && r.value.to_bits() == value)
        };
        let Some(since) = self.needles.iter().find_map(known).map(|r| r.since) else { return };
        self.reference_time = since;
        self.reference_steps = 0;
        // the sizes are known; they are measured again when it is their turn
        self.samples = MEASURED;
        for needle in &mut self.needles {
            if let Some(reference) = known(needle) {
                needle.reference = reference.from;
                needle.initial = reference.initial.unwrap_or(reference.from);
                needle.size = needle.size.max(reference.from.abs());
                needle.scale = reference.scale.unwrap_or(needle.scale.max(reference.from.abs()));
                needle.size = needle.size.max(needle.scale);
                needle.farthest = reference.farthest.unwrap_or(reference.max_drift * needle.scale);
            }
        }
    }

    /// A blow has led from some values to others: the references jump with them, so that drift is
    /// told from what the blow gave. The energy ledger knows that by its own law.
    pub(super) fn shift(&mut self, before: &[f64], after: &[f64]) {
        for needle in self.needles.iter_mut().filter(|needle| needle.jumps) {
            let jump = after[needle.channel] - before[needle.channel];
            if jump.is_finite() {
                needle.reference += jump;
                needle.settled = needle.farthest;
            }
        }
    }

    /// Takes note of the values at one of the evenly spaced times.
    pub(super) fn sample(&mut self, now: &Present<'_>) {
        self.look(now);
        self.samples += 1;
        // sizes change slowly, and cost more than all else
        if self.samples.is_power_of_two() || self.samples.is_multiple_of(MEASURED) {
            self.measure(now);
        }
        for needle in &mut self.needles {
            needle.distances.push(now.time, now.values[needle.channel] - needle.reference);
        }
        for residual in &mut self.residuals {
            residual.sample(now.time, now.residuals);
        }
        if let Some(attitude) = &mut self.attitude {
            attitude.sample(now.time, now.values);
        }
    }

    /// Takes note of the values at any other time.
    pub(super) fn look(&mut self, now: &Present<'_>) {
        for needle in &mut self.needles {
            let distance = (now.values[needle.channel] - needle.reference).abs();
            if distance > needle.farthest {
                needle.farthest = distance;
            }
        }
        for residual in &mut self.residuals {
            residual.look(now.residuals);
        }
        if let Some(attitude) = &mut self.attitude {
            attitude.look(now.values);
        }
    }

    /// What they show.
    pub(super) fn show(&self, now: &Present<'_>) -> Arc<[Gauge]> {
        let floor = rounding_floor(now.steps.saturating_sub(self.reference_steps));
        let show = |needle: &Needle| needle.show(now.values, self.reference_time, floor);
        let attitude = self.attitude.iter().map(|attitude| attitude.show(now.values));
        let held = self.residuals.iter().enumerate().map(|(k, residual)| {
            residual.show(now.values, now.residuals, now.system.is_released(k))
        });
        self.needles.iter().map(show).chain(held).chain(attitude).collect()
    }

    /// Measures the size of every gauge's terms.
    fn measure(&mut self, now: &Present<'_>) {
        let equations = &self.equations;
        let at = |symbol: Symbol| {
            let place = self.places.iter().find(|(s, _)| *s == symbol);
            match place {
                Some(&(_, channel)) => now.values[channel],
                None if symbol == equations.symbols.time => now.time,
                None if symbol == equations.symbols.action => now.action,
                None => (now.parameter)(symbol),
            }
        };
        for needle in &mut self.needles {
            let (_, size) = equations.pool.evaluate_with_size(needle.expression, &at);
            // where its terms cannot be told apart, the value itself is the measure
            let size = if size.is_finite() { size } else { now.values[needle.channel].abs() };
            if size.is_finite() {
                needle.grow(size);
            }
        }
    }
}

/// The same with the energy opened in what is conserved: the size of an invariant's terms is that of the terms of the
/// energy in it, which may nearly cancel.
fn with_energy_opened(equations: &Equations) -> Equations {
    let mut equations = equations.clone();
    let energy = HashMap::from([(equations.symbols.energy, equations.energy)]);
    for i in 0..equations.conserved.len() {
        let e = equations.conserved[i].expression;
        equations.conserved[i].expression = equations.pool.substitute(e, &energy);
    }
    equations
}

/// The Casimirs that forces change: which, its name, itself and the law of its change.
fn changing_casimirs(model: &Model, equations: &Equations) -> Vec<(usize, (String, Expr, String))> {
    let Mechanics::Poisson { casimirs, forces, .. } = &model.mechanics else { return Vec::new() };
    let mut equations = equations.clone();
    let mut changing = Vec::new();
    for (i, (name, casimir, _)) in casimirs.iter().enumerate() {
        let rate = casimir_rate(&mut equations, *casimir, forces);
        if rate != Expr::ZERO {
            let rate = equations.pool.unicode(rate);
            let rate = if rate.chars().count() > LONGEST { "∇C·f".to_owned() } else { rate };
            changing.push((i, (name.clone(), *casimir, format!("dC/dt = {rate}"))));
        }
    }
    changing
}

/// What the gauges look at.
pub(super) struct Present<'a> {
    pub(super) time: f64,
    pub(super) steps: u64,
    /// Every channel's value.
    pub(super) values: &'a [f64],
    /// How far the motion is from keeping each constraint: in position and in velocity.
    pub(super) residuals: &'a [[f64; 2]],
    pub(super) action: f64,
    pub(super) system: &'a System,
    /// The value of a parameter's symbol.
    pub(super) parameter: &'a dyn Fn(Symbol) -> f64,
}

impl Needle {
    fn new(
        name: &str,
        shown: String,
        reason: String,
        broken: Option<String>,
        channel: usize,
        expression: Expr,
    ) -> Needle {
        Needle {
            name: name.to_owned(),
            shown,
            reason,
            broken,
            channel,
            expression,
            jumps: name != LEDGER,
            initial: f64::NAN,
            reference: f64::NAN,
            size: 0.0,
            scale: 0.0,
            farthest: 0.0,
            settled: 0.0,
            distances: History::new(),
        }
    }

    fn refer(&mut self, values: &[f64]) {
        self.initial = values[self.channel];
        self.reference = self.initial;
        self.size = self.reference.abs();
        self.scale = self.size;
        self.farthest = 0.0;
        self.settled = 0.0;
        self.distances = History::new();
    }

    /// Its terms have been as large as this.
    fn grow(&mut self, size: f64) {
        self.size = self.size.max(size);
        let since = self.farthest - self.settled;
        if self.scale == 0.0 || since <= KEPT * self.scale || since <= SMALL * size {
            self.scale = self.scale.max(size);
        }
    }

    fn show(&self, values: &[f64], reference_time: f64, floor: f64) -> Gauge {
        let value = values[self.channel];
        let verdict = match &self.broken {
            Some(law) => Verdict::Broken(law.clone()),
            None => match Verdict::of(&self.distances, floor * self.size) {
                Verdict::Secular(slope) => Verdict::Secular(slope / self.scale),
                other => other,
            },
        };
        let history = self.distances.stretches().iter().map(Stretch::peak);
        Gauge {
            name: self.name.clone(),
            shown: self.shown.clone(),
            reason: self.reason.clone(),
            value,
            initial: self.initial,
            scale: self.scale,
            farthest: self.farthest,
            reference: self.reference,
            reference_time,
            drift: self.relative((value - self.reference).abs()),
            max_drift: self.relative(self.farthest),
            history: history.map(|peak| self.relative(peak) as f32).collect(),
            verdict,
        }
    }

    /// A distance over the size of the terms.
    fn relative(&self, distance: f64) -> f64 {
        if distance == 0.0 || self.scale == 0.0 { 0.0 } else { distance / self.scale }
    }
}
