//! Adjustable values: parameters and initial values, their ranges and steps.
//!
//! In: a model and the newest snapshot. Out: the description of a value, and the value one step further.
//! Never here: the list on the screen, or the command that sets a value.

use super::Lab;
use crate::model::Scale;
use crate::num::math;
use crate::system::ChannelKind;

/// One value that can be changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ValueId {
    /// The parameter of this index.
    Parameter(usize),
    /// The initial value of this index: coordinates first, then velocities or momenta.
    Initial(usize),
}

/// The description of a value.
#[derive(Clone, Debug, PartialEq)]
pub struct ValueInfo {
    /// The name as written: `theta0`.
    pub name: String,
    /// The name as shown: `θ₀`.
    pub shown: String,
    /// The unit, empty if unknown.
    pub unit: String,
    /// What it means, in words.
    pub about: String,
    /// The range of its slider, if it has one.
    pub range: Option<(f64, f64, Scale)>,
}

impl Lab {
    /// Returns the number of parameters, or of initial values.
    pub fn count(&self, kind: fn(usize) -> ValueId) -> usize {
        match kind(0) {
            ValueId::Parameter(_) => self.loaded.model.parameters.len(),
            ValueId::Initial(_) => self.loaded.model.moving(),
        }
    }

    /// Returns the description of a value, or `None` if the value does not exist.
    pub fn value_info(&self, target: ValueId) -> Option<ValueInfo> {
        let model = &self.loaded.model;
        match target {
            ValueId::Parameter(index) => {
                let p = model.parameters.get(index)?;
                Some(ValueInfo {
                    name: p.name.clone(),
                    shown: p.shown.clone(),
                    unit: p.unit.clone(),
                    about: p.about.clone(),
                    range: Some((p.min, p.max, p.scale)),
                })
            }
            ValueId::Initial(index) => {
                let count = model.coordinates.len();
                let c = model.coordinates.get(index % count.max(1))?;
                let (symbol, what) = match (index / count, model.is_lagrangian()) {
                    (0, _) if model.is_poisson() => (c.position, "value"),
                    (0, _) => (c.position, "coordinate"),
                    (1, true) => (c.velocity, "velocity"),
                    (1, false) => (c.momentum, "momentum"),
                    _ => return None,
                };
                let info = model.pool.symbol_info(symbol);
                let unit = match what {
                    "velocity" if !c.unit.is_empty() => match model.time_unit() {
                        "" => String::new(),
                        time => format!("{}/{time}", c.unit),
                    },
                    "momentum" => {
                        let kind = ChannelKind::Momentum(index % count.max(1));
                        let channels = self.loaded.system.channels();
                        let channel = channels.iter().find(|channel| channel.kind == kind);
                        channel.map_or_else(String::new, |channel| channel.unit.clone())
                    }
                    _ => c.unit.clone(),
                };
                Some(ValueInfo {
                    name: info.name.clone(),
                    shown: info.unicode.clone(),
                    unit,
                    about: format!("initial {what}; a change starts the motion again"),
                    range: None,
                })
            }
        }
    }

    /// Returns the value: the one requested last, until the experiment confirms it.
    pub fn value(&self, target: ValueId) -> Option<f64> {
        if let Some((_, requested)) = self.pending.iter().find(|(t, _)| *t == target) {
            return Some(*requested);
        }
        self.fact(target)
    }

    /// Returns the value that the experiment has.
    pub(super) fn fact(&self, target: ValueId) -> Option<f64> {
        let snapshot = self.snapshot.as_ref()?;
        match target {
            ValueId::Parameter(index) => snapshot.parameters.get(index).copied(),
            ValueId::Initial(index) => snapshot.initial.get(index).copied(),
        }
    }

    /// Returns the value one fine or coarse step up (+1) or down (−1), within its range.
    pub fn stepped(&self, target: ValueId, sign: i8, coarse: bool) -> Option<f64> {
        let value = self.value(target)?;
        let range = self.value_info(target)?.range;
        Some(step(value, range, f64::from(sign), if coarse { 10.0 } else { 1.0 }))
    }
}

impl Lab {
    /// Rounds a value to what stepping could reach: a whole number of fine steps within its range, whose ends are
    /// exact.
    pub(super) fn rounded(&self, target: ValueId, value: f64) -> f64 {
        match self.value_info(target).and_then(|value_info| value_info.range) {
            Some((min, max, _)) if value <= min || value >= max => value.clamp(min, max),
            Some((min, max, Scale::Log)) if min > 0.0 => significant(value, 3).clamp(min, max),
            Some((min, max, _)) => {
                let fine = nice_step((max - min) / 200.0);
                significant((value / fine).round() * fine, 12).clamp(min, max)
            }
            None => value,
        }
    }
}

/// Moves a value by `sign · times` fine steps. About 200 of them make up the range or, without one, the value's
/// magnitude, which counts as at least 1.
fn step(value: f64, range: Option<(f64, f64, Scale)>, sign: f64, times: f64) -> f64 {
    match range {
        Some((min, max, Scale::Log)) if min > 0.0 && value > 0.0 => {
            let factor = math::powf(max / min, times / 200.0);
            let moved = significant(value * math::powf(factor, sign), 4);
            within(moved, value, min, max)
        }
        Some((min, max, _)) => {
            let fine = nice_step((max - min) / 200.0);
            within(significant(value + sign * times * fine, 12), value, min, max)
        }
        None => {
            let fine = nice_step(value.abs().max(1.0) / 200.0);
            significant(value + sign * times * fine, 12)
        }
    }
}

/// Clamps `moved` to the range; a typed value beyond the range may come nearer to it, but never moves farther away.
fn within(moved: f64, value: f64, min: f64, max: f64) -> f64 {
    moved.clamp(min.min(value), max.max(value))
}

/// Returns the nearest of 1, 2, 5 times a power of ten that exceeds `length` by at most a half.
fn nice_step(length: f64) -> f64 {
    if !length.is_finite() || length <= 0.0 {
        return 1.0;
    }
    let power = math::powf(10.0, math::log10(length).floor());
    let digit = [1.0, 2.0, 5.0, 10.0].into_iter().rfind(|d| d * power <= length * 1.5);
    significant(digit.unwrap_or(1.0) * power, 3)
}

/// Rounds a value to this many significant digits, so that repeated steps accumulate no rounding noise.
fn significant(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits - 1).parse().unwrap_or(value)
}
