//! The gauges of one motion: which quantities should be constant and why, what they were at the
//! reference, and how far they have drifted since.
//!
//! In: what follows from the law of motion, and the values of the channels at even times. Out:
//! [`Gauge`]s. Never here: how the values were computed.

use std::sync::Arc;

use super::Gauge;
use super::law::EnergyLaw;
use crate::analysis::{History, Stretch, Verdict, rounding_floor};
use crate::expr::{Expr, Symbol};
use crate::mechanics::Equations;
use crate::model::Model;
use crate::system::{ChannelKind, System};

/// All gauges of one system.
#[derive(Clone, Debug)]
pub(super) struct Gauges {
    equations: Arc<Equations>,
    needles: Vec<Needle>,
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
    reference: f64,
    /// The greatest size of its terms seen since the reference.
    size: f64,
    /// The greatest distance from the reference since then.
    farthest: f64,
    /// The distances, with their signs.
    distances: History,
}

impl Gauges {
    /// The gauges of what `equations` finds conserved in `model`; where the energy is not, the
    /// energy with the law of its change, and the energy ledger, which is constant by that law.
    pub(super) fn new(model: &Model, equations: &Arc<Equations>, system: &System) -> Gauges {
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
            add("energy ledger", reason, None, ChannelKind::Ledger, equations.energy);
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
        let equations = Arc::clone(equations);
        Gauges { equations, needles, places, reference_time: 0.0, reference_steps: 0, samples: 0 }
    }

    /// Takes the present values as the reference.
    pub(super) fn refer(&mut self, now: &Present<'_>) {
        self.reference_time = now.time;
        self.reference_steps = now.steps;
        self.samples = 0;
        for needle in &mut self.needles {
            needle.refer(now.values);
        }
        self.measure(now);
        self.sample(now);
    }

    /// Takes note of the values at one of the evenly spaced times.
    pub(super) fn sample(&mut self, now: &Present<'_>) {
        self.look(now);
        self.samples += 1;
        // sizes change slowly, and cost more than all else
        if self.samples.is_power_of_two() || self.samples.is_multiple_of(16) {
            self.measure(now);
        }
        for needle in &mut self.needles {
            needle.distances.push(now.time, now.values[needle.channel] - needle.reference);
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
    }

    /// What they show.
    pub(super) fn show(&self, now: &Present<'_>) -> Arc<[Gauge]> {
        let floor = rounding_floor(now.steps.saturating_sub(self.reference_steps));
        let show = |needle: &Needle| needle.show(now.values, self.reference_time, floor);
        self.needles.iter().map(show).collect()
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
            if size.is_finite() {
                needle.size = needle.size.max(size);
            }
        }
    }
}

/// What the gauges look at.
pub(super) struct Present<'a> {
    pub(super) time: f64,
    pub(super) steps: u64,
    /// Every channel's value.
    pub(super) values: &'a [f64],
    pub(super) action: f64,
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
            reference: f64::NAN,
            size: 0.0,
            farthest: 0.0,
            distances: History::new(),
        }
    }

    fn refer(&mut self, values: &[f64]) {
        self.reference = values[self.channel];
        self.size = self.reference.abs();
        self.farthest = 0.0;
        self.distances = History::new();
    }

    fn show(&self, values: &[f64], reference_time: f64, floor: f64) -> Gauge {
        let value = values[self.channel];
        let verdict = match &self.broken {
            Some(law) => Verdict::Broken(law.clone()),
            None => match Verdict::of(&self.distances, floor * self.size) {
                Verdict::Secular(slope) => Verdict::Secular(slope / self.size),
                other => other,
            },
        };
        let history = self.distances.stretches().iter().map(Stretch::peak);
        Gauge {
            name: self.name.clone(),
            shown: self.shown.clone(),
            reason: self.reason.clone(),
            value,
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
        if distance == 0.0 { 0.0 } else { distance / self.size }
    }
}
