//! A moment of a motion, by names: what it takes to go on from there elsewhere, in another session or in a system
//! that was rebuilt from a changed file.
//!
//! In: a model and a [`Snapshot`] of its motion. Out: plain data to be kept, and an experiment that has taken it up.
//! Never here: files; what the screen shows of it.
//!
//! What the file says itself is not part of a moment: only what was changed since. So a value changed in the file wins
//! over the one that was there before, and a value turned by hand is kept.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::gauges::Gauges;
use super::{Experiment, Setup, Snapshot, Status, Trail};
use crate::integrate::Settings;
use crate::model::Model;
use crate::system::{Channel, ChannelKind, Failure, Form, InitialOverride, State, System};

/// A motion that is on its constraints to this part of their terms may be taken up as it is.
const KEPT_WITHIN: f64 = 1e-9;

/// A moment of a motion.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize)]
pub struct Checkpoint {
    /// The parameters that differ from the file's.
    #[serde(default)]
    pub parameters: Vec<Changed>,
    /// The initial values that take the place of the file's: `theta`, `theta'`, `p_theta`.
    #[serde(default)]
    pub initial: Vec<Named>,
    /// The method, if another than the file's was chosen.
    pub method: Option<String>,
    /// The step, if it was typed.
    pub step: Option<f64>,
    /// The tolerance, if it was typed.
    pub tolerance: Option<f64>,
    /// Simulated seconds per second, if other than the file's; infinite means flat out.
    pub speed: Option<f64>,
    /// Whether time ran.
    pub running: bool,
    /// Where the motion was; `None` where it had not begun.
    pub present: Option<MotionState>,
    /// What was recorded before. No file has it: it is far longer than all else, and made anew where it is wanted.
    #[serde(skip)]
    pub past: Option<Past>,
}

/// Rows recorded of a motion, and the names of their channels.
#[derive(Clone, PartialEq)]
pub struct Past {
    names: Vec<String>,
    trail: Trail,
}

/// A parameter that was changed.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Changed {
    /// Its name.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// The file's value at that time.
    pub of_file: f64,
}

/// A number and its name.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Named {
    /// The name.
    pub name: String,
    /// The number.
    pub value: f64,
}

/// Where a motion was.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct MotionState {
    /// When.
    pub time: f64,
    /// What rounding cut off the time.
    pub time_carry: f64,
    /// What the second part of `state` is: `velocity`, `momentum` or `variables`.
    pub form: Form,
    /// The names of the coordinates, in the order of the state.
    pub coordinates: Vec<String>,
    /// Every number of the state, and what rounding cut off it.
    pub state: Vec<[f64; 2]>,
    /// Coordinates, velocities and momenta as they were seen.
    pub seen: Vec<Named>,
    /// The constraints that were let go.
    pub released: Vec<String>,
    /// The event that had ended the motion.
    pub ended: Option<String>,
    /// The steps taken since the last restart.
    pub steps: u64,
    /// What the gauges measured from.
    pub references: Vec<Reference>,
}

/// What a gauge measured from.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Reference {
    /// The gauge's name.
    pub name: String,
    /// What it showed.
    pub value: f64,
    /// What it measured from, and when that was taken.
    pub from: f64,
    /// When that was taken.
    pub since: f64,
    /// The greatest drift.
    pub max_drift: f64,
    /// What its value was then, before any impulse; as `from` where it is not reported.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub initial: Option<f64>,
    /// What drift is relative to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale: Option<f64>,
    /// The greatest distance, which is the greatest drift times that.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub farthest: Option<f64>,
    /// Since when the drift is more than it may be.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub left: Option<f64>,
}

impl Checkpoint {
    /// The moment that a snapshot shows of the motion of a model's system.
    pub fn of(model: &Model, system: &System, snapshot: &Snapshot) -> Checkpoint {
        let setup = &snapshot.setup;
        let of_file = Setup::of(model);
        let parameters = model.parameters.iter().zip(&setup.parameters);
        let parameters = parameters
            .filter(|(p, value)| p.value.to_bits() != value.to_bits())
            .map(|(p, &value)| Changed { name: p.name.clone(), value, of_file: p.value });
        Checkpoint {
            parameters: parameters.collect(),
            initial: setup.given.iter().filter_map(|given| named(model, *given)).collect(),
            method: (setup.method != of_file.method).then(|| setup.method.clone()),
            step: setup.settings.step.filter(|_| setup.settings.step != of_file.settings.step),
            tolerance: setup
                .settings
                .tolerance
                .filter(|_| setup.settings.tolerance != of_file.settings.tolerance),
            speed: (setup.speed != of_file.speed).then_some(setup.speed),
            running: snapshot.status == Status::Running,
            present: MotionState::of(model, system, snapshot),
            past: None,
        }
    }

    /// The same with what a snapshot of that system has recorded.
    #[must_use]
    pub fn with_past(self, system: &System, snapshot: &Snapshot) -> Checkpoint {
        let names = system.channels().iter().map(|channel| channel.name.clone()).collect();
        Checkpoint { past: Some(Past { names, trail: snapshot.trail.clone() }), ..self }
    }
}

/// A past is long; commands that carry it are reported in a line.
impl fmt::Debug for Past {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Past of {} rows", self.trail.len())
    }
}

impl Past {
    /// Makes one of its rows before a time a row of these channels; what one of them was not recorded of is not a number.
    fn row(&self, channels: &[Channel], time: f64) -> impl Fn(&[f64]) -> Option<Vec<f64>> {
        // where several have a name, the first is the first, and so on
        let place = |(at, channel): (usize, &Channel)| {
            let earlier = channels[..at].iter().filter(|other| other.name == channel.name).count();
            let mut places = (0..self.names.len()).filter(|&i| self.names[i] == channel.name);
            places.nth(earlier)
        };
        let places: Vec<Option<usize>> = channels.iter().enumerate().map(place).collect();
        move |row| {
            let value = |place: &Option<usize>| place.and_then(|i| row.get(i + 1).copied());
            let values = places.iter().map(|place| value(place).unwrap_or(f64::NAN));
            (row[0] < time).then(|| std::iter::once(row[0]).chain(values).collect())
        }
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
            max_drift: gauge.max_drift,
            initial: Some(gauge.initial),
            scale: Some(gauge.scale),
            farthest: Some(gauge.farthest),
            left: gauge.left,
        };
        Some(MotionState {
            time: state.time,
            time_carry: state.time_carry,
            form: state.form,
            coordinates: names.collect(),
            state: state.values.iter().zip(&state.carry).map(|(&v, &c)| [v, c]).collect(),
            seen: seen(system, snapshot),
            released: released.map(|c| c.name.clone()).collect(),
            ended: match &snapshot.status {
                Status::Ended(event) => Some(event.clone()),
                _ => None,
            },
            steps: snapshot.method.steps,
            references: snapshot.gauges.iter().map(reference).collect(),
        })
    }

    fn exact(&self) -> State {
        State {
            time: self.time,
            time_carry: self.time_carry,
            form: self.form,
            values: self.state.iter().map(|[value, _]| *value).collect(),
            carry: self.state.iter().map(|[_, carry]| *carry).collect(),
        }
    }

    /// Whether its numbers are those of a state of this system.
    fn fits(&self, model: &Model, system: &System) -> bool {
        let names = model.coordinates.iter().map(|c| &c.name);
        let poisson = self.form == Form::Variables;
        names.eq(&self.coordinates)
            && self.state.len() == system.state_len()
            && poisson == (system.form() == Form::Variables)
    }
}

/// Every coordinate, velocity and momentum that has a number, by name.
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

/// An initial value by its name in expressions.
fn named(model: &Model, given: InitialOverride) -> Option<Named> {
    let (index, value) = match given {
        InitialOverride::Position(i, x)
        | InitialOverride::Velocity(i, x)
        | InitialOverride::Momentum(i, x) => (i, x),
    };
    let name = &model.coordinates.get(index)?.name;
    let name = match given {
        InitialOverride::Position(..) => name.clone(),
        InitialOverride::Velocity(..) => format!("{name}'"),
        InitialOverride::Momentum(..) => format!("p_{name}"),
    };
    Some(Named { name, value })
}

/// The initial value of a name, if the model has it.
fn given(model: &Model, named: &Named) -> Option<InitialOverride> {
    let place = |name: &str| model.coordinates.iter().position(|c| c.name == name);
    let (name, value) = (named.name.as_str(), named.value);
    if let Some(i) = place(name) {
        return Some(InitialOverride::Position(i, value));
    }
    if model.is_poisson() {
        return None;
    }
    if let Some(i) = name.strip_suffix('\'').and_then(place) {
        return Some(InitialOverride::Velocity(i, value));
    }
    let i = name.strip_prefix("p_").and_then(place)?;
    Some(InitialOverride::Momentum(i, value))
}

impl Experiment {
    /// Goes on from a moment of this system or of one of similar names. What has no place here is reported in a notice.
    pub fn restore(&mut self, moment: &Checkpoint) {
        self.taken_up = true;
        let mut lost = self.take_setup(moment);
        self.running = moment.running;
        let told = std::mem::take(&mut self.notices);
        self.restart();
        self.notices = told;
        if let Some(present) = &moment.present {
            lost.extend(
                present.released.iter().filter(|name| self.constraint(name).is_none()).cloned(),
            );
            match self.take_present(present) {
                Ok(()) => self.recall(moment.past.as_ref(), present),
                Err(why) => {
                    self.restart();
                    self.tell(format!("the motion begins anew: {why}"));
                }
            }
        }
        if !lost.is_empty() {
            self.tell(format!("no longer there: {}", lost.join(", ")));
        }
    }

    /// Puts what was recorded before the present, where the coordinates are the same.
    fn recall(&mut self, past: Option<&Past>, present: &MotionState) {
        let own = self.model.coordinates.iter();
        let same = own.len() == present.coordinates.len()
            && own.clone().all(|c| present.coordinates.contains(&c.name));
        if let Some(past) = past.filter(|_| same) {
            let row = past.row(self.motion.system().channels(), present.time);
            self.recorder.precede(&past.trail, row);
        }
    }

    /// Takes what was changed; returns the names that there are no longer.
    fn take_setup(&mut self, moment: &Checkpoint) -> Vec<String> {
        let mut lost = Vec::new();
        let Setup { start, end, .. } = self.setup;
        let mut setup = Setup { start, end, ..Setup::of(&self.model) };
        for changed in &moment.parameters {
            match self.model.parameters.iter().position(|p| p.name == changed.name) {
                None => lost.push(changed.name.clone()),
                Some(i) if setup.parameters[i].to_bits() == changed.of_file.to_bits() => {
                    setup.parameters[i] = changed.value;
                }
                Some(_) => {}
            }
        }
        for named in &moment.initial {
            match given(&self.model, named) {
                Some(given) => setup.given.push(given),
                None => lost.push(named.name.clone()),
            }
        }
        setup.speed = moment.speed.filter(|s| *s > 0.0).unwrap_or(setup.speed);
        let settings = Settings {
            step: moment.step.or(setup.settings.step),
            tolerance: moment.tolerance.or(setup.settings.tolerance),
        };
        let wanted = moment.method.as_ref().unwrap_or(&setup.method).clone();
        let changed = wanted != self.setup.method || settings != self.setup.settings;
        // a method that is refused leaves the one that runs, with its settings
        self.setup =
            Setup { method: self.setup.method.clone(), settings: self.setup.settings, ..setup };
        if changed {
            self.take_method(&wanted, settings);
        }
        lost
    }

    /// Puts the present where it was: to the last bit where the system has the same state, else as far as names agree.
    fn take_present(&mut self, present: &MotionState) -> Result<(), Failure> {
        let exact = present.fits(&self.model, self.system()) && self.take_exactly(present);
        if !exact {
            let state = self.state_of(present)?;
            self.motion.begin(&state, &self.setup.parameters)?;
        }
        self.fault = None;
        self.motion.set_steps(present.steps);
        self.recorder.restart(present.time);
        self.gauge(Gauges::refer);
        if exact {
            self.gauge(|gauges, now| gauges.restore(&present.references, now));
            let model = std::sync::Arc::clone(&self.model);
            let same = |name: &&String| model.events.iter().any(|e| e.name == **name);
            self.ended = present.ended.as_ref().filter(same).cloned();
        }
        self.record();
        Ok(())
    }

    /// Takes up the state as it is; `false` where it is none that this system can be in.
    fn take_exactly(&mut self, present: &MotionState) -> bool {
        let released: Vec<usize> =
            present.released.iter().filter_map(|name| self.constraint(name)).collect();
        let Setup { parameters, start, .. } = &self.setup;
        let taken = self.motion.restore(&present.exact(), parameters, *start, &released);
        let kept = |(k, residual): (usize, &[f64; 2])| {
            released.contains(&k) || residual.iter().all(|r| *r <= KEPT_WITHIN)
        };
        taken.is_ok() && self.motion.residuals().iter().enumerate().all(kept)
    }

    fn constraint(&self, name: &str) -> Option<usize> {
        self.model.constraints.iter().position(|c| c.name == name)
    }

    /// The state with the same coordinates and velocities (for a Hamiltonian: momenta), where there are such.
    fn state_of(&self, present: &MotionState) -> Result<State, Failure> {
        let poisson = self.model.is_poisson();
        let fits = |given: &InitialOverride| match given {
            InitialOverride::Position(..) => true,
            InitialOverride::Velocity(..) => self.model.is_lagrangian(),
            InitialOverride::Momentum(..) => !self.model.is_lagrangian() && !poisson,
        };
        let given: Vec<InitialOverride> = present
            .seen
            .iter()
            .filter_map(|named| given(&self.model, named))
            .filter(fits)
            .collect();
        self.motion.whole().initial(present.time, &self.setup.parameters, &given)
    }
}
