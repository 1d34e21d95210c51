//! What a picture of many motions runs over, parameters and initial values, and what all of them have in common.
//!
//! In: a plot, the current state. Out: the range of each variation and the part of it that is seen, the conditions on which the
//! result depends, the start of the motion at given numbers. Never here: what is computed of it.

use std::sync::Arc;

use super::{Physics, Plot, Present};
use crate::dynamics::{Chaos, DynamicsError, LyapunovOrbit, PhaseSpace, lyapunov_of_all};
use crate::ensemble::Start;
use crate::integrate::{BatchPropagator, Method, Settings, Stepping, method_named};
use crate::mechanics::{Equations, Valuation};
use crate::model::{Model, Variation, View};
use crate::num::BATCH;
use crate::system::{ChannelKind, InitialOverride, System};

/// The tolerance of the method: a dot is a thousandth of the picture.
const TOLERANCE: f64 = 1e-10;

/// Of so many parameters and of so many initial values pictures are offered; `v` on any of them has its own.
const OFFERED: usize = 3;

/// What the motions of a picture depend on; parameters that are varied count as zero, initial values are left out.
#[derive(Clone, PartialEq)]
pub(super) struct VariedConditions {
    over: Vec<Variation>,
    /// The part of the range of each that is seen.
    pub(super) window: Vec<[f64; 2]>,
    parameters: Vec<f64>,
    overrides: Vec<InitialOverride>,
    method: &'static str,
    settings: Settings,
}

impl VariedConditions {
    /// Those of a plot, if what it runs over is there.
    pub(super) fn of(plot: &Plot, present: &Present<'_>) -> Option<Self> {
        let system = present.physics.system;
        let mut parameters = present.parameters.to_vec();
        // initial values of the file may follow a parameter; those that were set do not
        let of_file = system.initial_values(&parameters);
        let set = present.initial.iter().zip(&of_file).enumerate().filter(|(_, (x, own))| x != own);
        let overrides = set
            .filter(|(i, _)| !plot.over.contains(&Variation::Initial(*i)))
            .map(|(i, (&x, _))| system.initial_override(i, x))
            .collect();
        let mut window = Vec::new();
        for (axis, &over) in plot.over.iter().enumerate() {
            match over {
                Variation::Parameter(index) => *parameters.get_mut(index)? = 0.0,
                Variation::Initial(index) => drop(of_file.get(index)?),
            }
            window.push(seen(plot, present, axis)?);
        }
        let mut settings = present.settings;
        if method_named(present.method)?.stepping == Stepping::Adaptive {
            settings.tolerance = Some(settings.tolerance.unwrap_or(0.0).max(TOLERANCE));
        }
        let (over, method) = (plot.over.clone(), present.method);
        Some(Self { over, window, parameters, overrides, method, settings })
    }

    fn start(&self, physics: Physics<'_>, at: &[f64]) -> Start {
        let mut parameters = self.parameters.clone();
        let mut overrides = self.overrides.clone();
        for (&over, &x) in self.over.iter().zip(at) {
            match over {
                Variation::Parameter(index) => parameters[index] = x,
                Variation::Initial(index) => {
                    overrides.push(physics.system.initial_override(index, x));
                }
            }
        }
        Start { time: physics.model.run.start, parameters, overrides }
    }
}

/// The motions of a picture, as a job follows them.
pub(super) struct VariedMotions {
    pub(super) model: Arc<Model>,
    pub(super) equations: Arc<Equations>,
    pub(super) system: Arc<System>,
    /// The method, and its step or tolerance.
    pub(super) method: (&'static Method, Settings),
    pub(super) conditions: VariedConditions,
}

impl VariedMotions {
    /// Those of a plot, if what it runs over is there.
    pub(super) fn of(plot: &Plot, present: &Present<'_>) -> Option<Self> {
        let conditions = VariedConditions::of(plot, present)?;
        let Physics { model, equations, system } = present.physics;
        Some(Self {
            model: Arc::clone(model),
            equations: Arc::clone(equations),
            system: Arc::clone(system),
            method: (method_named(conditions.method)?, conditions.settings),
            conditions,
        })
    }

    fn physics(&self) -> Physics<'_> {
        Physics { model: &self.model, equations: &self.equations, system: &self.system }
    }

    pub(super) fn start(&self, at: &[f64]) -> Start {
        self.conditions.start(self.physics(), at)
    }

    /// The largest Lyapunov exponents of motions over a time; `system` may be cancelled. What a regular motion has of it
    /// falls off with the time it was followed, and counts as zero.
    pub(super) fn exponents(
        &self,
        system: &System,
        starts: &[Start],
        length: f64,
    ) -> Vec<Result<Option<f64>, String>> {
        let in_phase_space = |start: &Start| {
            let parameters = &start.parameters;
            let space =
                PhaseSpace::on_constraints((&self.model, &self.equations, system), parameters)?;
            let until = start.time + length;
            let start = start.state(system).and_then(|state| space.state(&state))?;
            Ok(LyapunovOrbit { space, start, until })
        };
        let mut orbits = Vec::new();
        let begun: Vec<Result<(), DynamicsError>> = starts
            .iter()
            .map(|start| in_phase_space(start).map(|orbit| orbits.push(orbit)))
            .collect();
        let mut found = lyapunov_of_all(&orbits, self.method).into_iter();
        let exponent = |begun: Result<(), DynamicsError>| {
            begun.map_err(|why| why.to_string())?;
            let Some(found) = found.next() else { return Ok(None) };
            let found = found.map_err(|why| why.to_string())?;
            let regular = found.verdict == Chaos::Regular;
            let seen = |&exponent: &f64| if regular { exponent.min(0.0) } else { exponent };
            Ok(found.exponents.first().map(seen))
        };
        begun.into_iter().map(exponent).collect()
    }

    /// How many motions one thread follows at a time to their exponents.
    pub(super) fn exponent_group(&self, system: &System) -> usize {
        let (method, settings) = self.method;
        match BatchPropagator::new(&system.without_marks(), method, settings) {
            Some(_) => BATCH,
            None => 1,
        }
    }
}

/// The parameters and initial values that pictures over one of them are offered of.
pub(super) fn offered(physics: Physics<'_>) -> impl Iterator<Item = Variation> {
    let parameters = (0..physics.model.parameters.len()).map(Variation::Parameter);
    let free = physics.model.constraints.is_empty();
    let initial = if free { physics.model.moving() } else { 0 };
    parameters.take(OFFERED).chain((0..initial.min(OFFERED)).map(Variation::Initial))
}

/// A number within half a period of zero: an angle is the same after a turn.
pub(super) fn within(x: f64, period: Option<f64>) -> f64 {
    period.map_or(x, |period| x - period * (x / period).round())
}

fn view<'a>(plot: &Plot, physics: Physics<'a>) -> Option<&'a View> {
    physics.model.views.get(plot.view?)
}

/// The channel of what is varied, if it is an initial value.
pub(super) fn channel(physics: Physics<'_>, over: Variation) -> Option<usize> {
    let Variation::Initial(index) = over else { return None };
    let degrees = physics.model.coordinates.len();
    physics.channel(match index.checked_sub(degrees) {
        None => ChannelKind::Position(index),
        Some(rate) if physics.model.is_lagrangian() => ChannelKind::Velocity(rate),
        Some(rate) => ChannelKind::Momentum(rate),
    })
}

/// The name of what is varied, as shown, and its unit.
pub(super) fn named(physics: Physics<'_>, over: Variation) -> (&str, &str) {
    let nothing = ("?", "");
    match over {
        Variation::Parameter(index) => {
            let parameter = physics.model.parameters.get(index);
            parameter.map_or(nothing, |p| (p.shown.as_str(), p.unit.as_str()))
        }
        Variation::Initial(_) => {
            let found = channel(physics, over).and_then(|k| physics.system.channels().get(k));
            found.map_or(nothing, |c| (c.shown.as_str(), c.unit.as_str()))
        }
    }
}

pub(super) fn names(physics: Physics<'_>, over: &[Variation]) -> String {
    let names: Vec<&str> = over.iter().map(|&one| named(physics, one).0).collect();
    names.join(" and ")
}

/// The parameters, and their values, that a point of the picture stands for.
pub(super) fn parameters_at(plot: &Plot, at: [f64; 2]) -> Vec<(usize, f64)> {
    let all = plot.over.iter().zip(at);
    let parameters = all.filter_map(|(&over, x)| match over {
        Variation::Parameter(index) => Some((index, x)),
        Variation::Initial(_) => None,
    });
    parameters.collect()
}

pub(super) fn written(physics: Physics<'_>, over: Variation) -> &str {
    match over {
        Variation::Parameter(index) => {
            physics.model.parameters.get(index).map_or("", |p| p.name.as_str())
        }
        Variation::Initial(_) => {
            let found = channel(physics, over).and_then(|k| physics.system.channels().get(k));
            found.map_or("", |c| c.name.as_str())
        }
    }
}

/// The name as shown, with the unit in brackets.
pub(super) fn with_unit(physics: Physics<'_>, over: Variation) -> String {
    match named(physics, over) {
        (name, "") => name.to_owned(),
        (name, unit) => format!("{name} [{unit}]"),
    }
}

/// What it is for the running motion.
pub(super) fn now(present: &Present<'_>, over: Variation) -> Option<f64> {
    match over {
        Variation::Parameter(index) => present.parameters.get(index).copied(),
        Variation::Initial(index) => present.initial.get(index).copied(),
    }
}

/// The ends that the file gives an axis of this picture.
pub(super) fn given(plot: &Plot, present: &Present<'_>, axis: usize) -> Option<[f64; 2]> {
    // the axes of another kind, whose surface it shares, are others
    let view = view(plot, present.physics).filter(|view| view.kind == plot.kind.name())?;
    ends(view, present, axis)
}

/// The ends that the file gives an axis of a view.
pub(super) fn ends(view: &View, present: &Present<'_>, axis: usize) -> Option<[f64; 2]> {
    let model = present.physics.model;
    let ends = view.ranges[axis]?;
    let known = Valuation::of_parameters(model, present.parameters);
    let [from, to] = ends.map(|end| known.value(&model.pool, end));
    (from.is_finite() && to.is_finite() && from < to).then_some([from, to])
}

/// The range of an axis: the view's, or a parameter's own; of an initial value a turn, or twice what the file has.
pub(super) fn range(plot: &Plot, present: &Present<'_>, axis: usize) -> Option<[f64; 2]> {
    let over = *plot.over.get(axis)?;
    let own = match over {
        Variation::Parameter(index) => {
            let parameter = present.physics.model.parameters.get(index)?;
            [parameter.min, parameter.max]
        }
        Variation::Initial(index) => {
            let system = present.physics.system;
            let turn = system.period(channel(present.physics, over)?, present.parameters);
            let value = *system.initial_values(present.parameters).get(index)?;
            let reach = turn.map_or(2.0 * value.abs(), |turn| 0.5 * turn.abs());
            let reach = if reach.is_normal() { reach } else { 1.0 };
            [-reach, reach]
        }
    };
    Some(given(plot, present, axis).unwrap_or(own))
}

fn seen(plot: &Plot, present: &Present<'_>, axis: usize) -> Option<[f64; 2]> {
    let [from, to] = range(plot, present, axis)?;
    let Some(viewport) = plot.viewport() else { return Some([from, to]) };
    let [low, high] = viewport.part(axis, [from, to]);
    let bounded = match plot.over[axis] {
        // beyond its own range a parameter may mean nothing
        Variation::Parameter(index) => {
            let own = present.physics.model.parameters.get(index)?;
            [low.max(from.min(own.min)), high.min(to.max(own.max))]
        }
        Variation::Initial(_) => [low, high],
    };
    Some(if bounded[0] < bounded[1] { bounded } else { [from, to] })
}
