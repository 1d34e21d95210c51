//! The adjustable values of the lab.
//!
//! In: a model and the newest snapshot. Out: the description of a value, and the value one step further.
//! Never here: the list on the screen, or the command that sets a value.

use super::value::{nice_step, step};
use super::{Lab, ValueId, ValueInfo};
use crate::expr::Expr;
use crate::mechanics::Valuation;
use crate::model::RangeSpacing;
use crate::num::rounded;
use crate::system::{ChannelKind, Form, InitialOverride};

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
                let ramped = model.ramped.functions().any(|(symbol, _)| symbol == p.symbol);
                Some(ValueInfo {
                    ramped,
                    follows: None,
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
                    ramped: false,
                    name: info.name.clone(),
                    shown: info.unicode.clone(),
                    unit,
                    about: format!("initial {what}; a change restarts the motion"),
                    range: None,
                    follows: self.followed_by(index),
                })
            }
        }
    }

    /// What an initial value is in the file, if parameters stand in it and nobody has changed it.
    fn followed_by(&self, index: usize) -> Option<Expr> {
        let model = &self.loaded.model;
        let count = model.coordinates.len();
        let coordinate = model.coordinates.get(index % count.max(1))?;
        let of_file = if index < count { coordinate.initial } else { coordinate.initial_rate };
        let follows = model.parameters.iter().any(|p| model.pool.depends(of_file, p.symbol));
        let is_changed = |given: &InitialOverride| match *given {
            InitialOverride::Position(place, _) => place == index,
            InitialOverride::Velocity(place, _) | InitialOverride::Momentum(place, _) => {
                place + count == index
            }
        };
        let given =
            self.snapshot.as_ref().is_some_and(|seen| seen.setup.overrides.iter().any(is_changed));
        (follows && !given).then_some(of_file)
    }

    /// The initial values as the lab lists them: of a Lagrangian system velocities in place of momenta, so that what was
    /// set stays when a parameter changes. Momenta without velocities at these parameters stay momenta.
    pub(super) fn as_listed(&self, given: Vec<InitialOverride>) -> Vec<InitialOverride> {
        let system = &self.loaded.system;
        let has_momentum = given.iter().any(|one| matches!(one, InitialOverride::Momentum(..)));
        if system.form() != Form::Velocity || !has_momentum {
            return given;
        }
        let parameters: Option<Vec<f64>> = (0..self.count(ValueId::Parameter))
            .map(|index| self.value(ValueId::Parameter(index)))
            .collect();
        let start = self.loaded.model.run.start;
        let all = self.given_with(&given);
        let state = parameters.and_then(|values| system.initial(start, &values, &all).ok());
        let Some(state) = state else { return given };
        let velocity = |i: usize| state.values.get(system.degrees() + i).copied();
        let listed = |one: InitialOverride| match one {
            InitialOverride::Momentum(i, _) => {
                velocity(i).map_or(one, |v| InitialOverride::Velocity(i, v))
            }
            InitialOverride::Position(..) | InitialOverride::Velocity(..) => one,
        };
        given.into_iter().map(listed).collect()
    }

    /// Returns the value: the one requested last, until the experiment confirms it.
    pub fn value(&self, target: ValueId) -> Option<f64> {
        self.pending.value(target).or_else(|| self.fact(target))
    }

    /// Returns the value as it is now: of a parameter that changes with the time that of its function; what keys change is
    /// its value before the first ramp.
    pub fn current_value(&self, target: ValueId) -> Option<f64> {
        let own = self.value(target)?;
        let ValueId::Parameter(index) = target else { return Some(own) };
        let values: Option<Vec<f64>> = (0..self.count(ValueId::Parameter))
            .map(|i| self.value(ValueId::Parameter(i)))
            .collect();
        let time = self.snapshot.as_ref()?.time;
        self.ramped_value(index, time, &values?).or(Some(own))
    }

    /// Returns the value of a parameter that changes with the time, if this one does, from the values before the first ramp.
    pub fn ramped_value(&self, index: usize, time: f64, before: &[f64]) -> Option<f64> {
        let model = &self.loaded.model;
        let symbol = model.parameters.get(index)?.symbol;
        let (_, function) = model.ramped.functions().find(|(ramped, _)| *ramped == symbol)?;
        let known = model.parameters.iter().map(|p| p.symbol).zip(before.iter().copied());
        let at = Valuation::default().with(known).with([(model.symbols.time, time)]);
        Some(at.value(&model.pool, function))
    }

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
            Some((min, max, RangeSpacing::Log)) if min > 0.0 => rounded(value, 3).clamp(min, max),
            Some((min, max, _)) => {
                let fine = nice_step((max - min) / 200.0);
                rounded((value / fine).round() * fine, 12).clamp(min, max)
            }
            None => value,
        }
    }
}
