//! A checkpoint of a motion, stored by name: all that is needed to resume it elsewhere, in another session or in a
//! system rebuilt from a changed file.
//!
//! In: a model and a [`Snapshot`] of its motion. Out: plain data for saving. Never here: how an experiment
//! resumes from it (`restore`), files, what the screen shows of it.
//!
//! A checkpoint holds only what differs from the file. A value that has since changed in the file therefore replaces
//! the old one, and a value set by the user is preserved.

use serde::{Deserialize, Serialize};

use super::exact_state::{exact_numbers, exact_state};
use super::last_change::SavedChange;
use super::named::{Named, named};
use super::reference::Reference;
use super::{MethodFact, Past, SavedCompanion, Setup, Snapshot, Status};
use crate::integrate::{METHODS, Stepping};
use crate::model::Model;
use crate::system::{ChannelKind, Form, InitialOverride, State, System};

/// A checkpoint of a motion.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize)]
pub struct Checkpoint {
    /// The parameters that differ from the file's.
    #[serde(default)]
    pub parameters: Vec<Changed>,
    /// The initial values that override the file's: `theta`, `theta'`, `p_theta`.
    #[serde(default)]
    pub initial: Vec<Named>,
    /// The method, if it is not the file's.
    pub method: Option<String>,
    /// The step, if the user set it.
    pub step: Option<f64>,
    /// The tolerance, if the user set it.
    pub tolerance: Option<f64>,
    /// Simulated seconds per second, if not the file's; infinite for as fast as possible.
    pub speed: Option<f64>,
    /// Whether time was running.
    pub running: bool,
    /// Whether time ran backwards.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub backwards: bool,
    /// When time was reversed, if it ran backwards and all of the run until then is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub turned: Option<f64>,
    /// The state of the motion, or `None` if it had not begun.
    pub present: Option<MotionState>,
    /// The motions beside this one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub companions: Vec<SavedCompanion>,
    /// The recorded past. It is never saved, because it is far longer than the rest and can be recomputed.
    #[serde(skip)]
    pub past: Option<Past>,
    /// What of the law is another one from here on, if anything is.
    #[serde(skip)]
    pub changed: Option<String>,
}

/// A changed parameter.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Changed {
    /// The parameter's name.
    pub name: String,
    /// What it was changed to.
    pub value: f64,
    /// The file's value when the checkpoint was made.
    pub of_file: f64,
}

/// Where a motion is, to the last bit, by names.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct MotionState {
    /// The time, without what rounding cut off from it.
    pub time: f64,
    /// The rounding error carried with the time.
    pub time_carry: f64,
    /// The meaning of the second half of `state`: `velocity`, `momentum` or `variables`.
    pub form: Form,
    /// The action ∫ L dt since the start with its carried rounding error, if the state carries it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub action: Option<[f64; 2]>,
    /// The names of the coordinates, in the order of the state.
    pub coordinates: Vec<String>,
    /// Each number of the state with its carried rounding error.
    pub state: Vec<[f64; 2]>,
    /// The values of coordinates, velocities and momenta.
    pub seen: Vec<Named>,
    /// The released constraints.
    pub released: Vec<String>,
    /// The event that ended the motion, if any.
    pub ended: Option<String>,
    /// The number of steps since the last restart.
    pub steps: u64,
    /// The step that the method has chosen for equal steps.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chosen_step: Option<ChosenStep>,
    /// The references of the gauges.
    pub references: Vec<Reference>,
    /// Where the law was changed last, if it was since the start.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub changed: Option<SavedChange>,
}

/// A step that a method has chosen where none was set.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct ChosenStep {
    /// The name of the method.
    pub method: String,
    /// The step.
    pub size: f64,
}

impl ChosenStep {
    fn of(snapshot: &Snapshot) -> Option<ChosenStep> {
        let MethodFact { name, step, .. } = snapshot.method;
        let is_fixed = METHODS.iter().any(|m| m.name == name && m.stepping == Stepping::Fixed);
        let chosen = is_fixed && snapshot.setup.settings.step.is_none() && step != 0.0;
        chosen.then(|| ChosenStep { method: name.to_owned(), size: step.abs() })
    }
}

impl Checkpoint {
    /// Makes a checkpoint from a snapshot of a model's system.
    pub fn of(model: &Model, system: &System, snapshot: &Snapshot) -> Checkpoint {
        let setup = &snapshot.setup;
        let changed = snapshot.recorded.changed.as_deref();
        let begun = changed.map_or(setup.start, |change| change.state.time);
        let of_file = Setup::of(model);
        let mut checkpoint = Checkpoint {
            parameters: Vec::new(),
            initial: setup.overrides.iter().filter_map(|given| named(model, *given)).collect(),
            method: (setup.method != of_file.method).then(|| setup.method.clone()),
            step: setup.settings.step.filter(|_| setup.settings.step != of_file.settings.step),
            tolerance: setup
                .settings
                .tolerance
                .filter(|_| setup.settings.tolerance != of_file.settings.tolerance),
            speed: (setup.speed != of_file.speed).then_some(setup.speed),
            running: snapshot.status == Status::Running,
            backwards: snapshot.backwards,
            turned: snapshot
                .returned
                .as_ref()
                .filter(|run| snapshot.backwards && run.start == begun)
                .map(|run| run.turned),
            present: MotionState::of(model, system, snapshot),
            companions: snapshot
                .companions
                .iter()
                .filter_map(|one| SavedCompanion::of(model, one))
                .collect(),
            past: None,
            changed: None,
        };
        checkpoint.set_parameters(model, setup.parameters.iter().copied());
        checkpoint
    }

    /// Adds the trail that a snapshot of the same system has recorded.
    #[must_use]
    pub fn with_past(self, system: &System, snapshot: &Snapshot) -> Checkpoint {
        Checkpoint { past: Some(Past::of(system, snapshot)), ..self }
    }

    /// Replaces the parameters by these, in the model's order.
    pub fn set_parameters(&mut self, model: &Model, values: impl Iterator<Item = f64>) {
        let parameters = model.parameters.iter().zip(values);
        let changed = parameters.filter(|(p, value)| p.value.to_bits() != value.to_bits());
        let changed =
            changed.map(|(p, value)| Changed { name: p.name.clone(), value, of_file: p.value });
        self.parameters = changed.collect();
    }

    /// Replaces the motion by one that is about to begin with these in place of the file's initial values.
    pub fn start_with(&mut self, model: &Model, given: &[InitialOverride]) {
        self.initial = given.iter().filter_map(|given| named(model, *given)).collect();
        (self.present, self.past) = (None, None);
    }

    /// Lets the law be another one from here on, because this was changed.
    #[must_use]
    pub fn with_another_law(self, what: &str) -> Checkpoint {
        // a step suits the law for which it was chosen
        let present = self.present.map(|present| MotionState { chosen_step: None, ..present });
        let anew = |one| SavedCompanion { fixed_step: None, ..one };
        let companions = self.companions.into_iter().map(anew).collect();
        Checkpoint { changed: Some(what.to_owned()), present, companions, ..self }
    }
}

impl MotionState {
    fn of(model: &Model, system: &System, snapshot: &Snapshot) -> Option<MotionState> {
        let state = &snapshot.state;
        if state.values.is_empty() || !state.is_finite() {
            return None;
        }
        let names = model.coordinates.iter().map(|c| c.name.clone());
        let released = snapshot.released.iter().filter_map(|&k| model.constraints.get(k));
        let reference = |gauge: &super::Gauge| Reference {
            name: gauge.name.clone(),
            value: gauge.value,
            from: gauge.reference,
            since: gauge.reference_time,
            // where it is not known none has been seen
            max_drift: if gauge.max_drift.is_nan() { 0.0 } else { gauge.max_drift },
            initial: Some(gauge.initial),
            scale: Some(gauge.scale),
            farthest: Some(gauge.farthest),
            left: gauge.left,
        };
        Some(MotionState {
            time: state.time,
            time_carry: state.time_carry,
            form: state.form,
            action: system.action_place().map(|i| [state.values[i], state.carry[i]]),
            coordinates: names.collect(),
            state: exact_numbers(state),
            seen: seen(system, snapshot),
            released: released.map(|c| c.name.clone()).collect(),
            ended: match &snapshot.status {
                Status::Ended(event) => Some(event.clone()),
                _ => None,
            },
            steps: snapshot.method.steps,
            chosen_step: ChosenStep::of(snapshot),
            references: snapshot.gauges.iter().map(reference).collect(),
            changed: snapshot.recorded.changed.as_deref().and_then(SavedChange::of),
        })
    }

    pub(super) fn exact(&self) -> State {
        exact_state([self.time, self.time_carry], self.form, &self.state)
    }

    /// Whether the stored state has the shape of this system's state.
    pub(super) fn fits(&self, model: &Model, system: &System) -> bool {
        let names = model.coordinates.iter().map(|c| &c.name);
        let poisson = self.form == Form::Variables;
        names.eq(&self.coordinates)
            && self.state.len() == system.state_len()
            && self.action.is_some() == system.action_place().is_some()
            && poisson == (system.form() == Form::Variables)
    }
}

/// The finite coordinates, velocities and momenta, by name.
fn seen(system: &System, snapshot: &Snapshot) -> Vec<Named> {
    let moves = |kind| {
        matches!(
            kind,
            ChannelKind::Position(_) | ChannelKind::Velocity(_) | ChannelKind::Momentum(_)
        )
    };
    let channels = system.channels().iter().zip(snapshot.values.iter());
    channels
        .filter(|(channel, value)| moves(channel.kind) && value.is_finite())
        .map(|(channel, &value)| Named { name: channel.name.clone(), value })
        .collect()
}
