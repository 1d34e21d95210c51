//! An experiment that resumes from a checkpoint.
//!
//! In: a checkpoint of this system, or of one with similar names. Out: the experiment in that state, and a sentence about what does
//! not apply here. Never here: what a checkpoint stores, how a past is computed once more (`rerun`).

use std::sync::Arc;

use super::Experiment;
use super::checkpoint::{Checkpoint, ChosenStep, MotionState};
use super::gauges::Gauges;
use super::named::given;
use super::rerun::Rerun;
use super::setup::Setup;
use crate::integrate::Settings;
use crate::system::{InitialOverride, MotionError, State};

/// A state is restored unchanged if its constraint residuals are within this fraction of the constraints' terms.
const RESIDUAL_LIMIT: f64 = 1e-9;

impl Experiment {
    /// Resumes from a checkpoint of this system or of one with similar names. Whatever does not apply here is
    /// reported in a notice.
    pub fn restore(&mut self, checkpoint: &Checkpoint) {
        self.run.restored = true;
        let mut lost = self.restore_setup(checkpoint);
        self.run.running = checkpoint.running;
        let notices = std::mem::take(&mut self.notices.sentences);
        self.companions.clear();
        self.restart();
        self.notices.sentences = notices;
        let present = checkpoint.present.as_ref();
        let same = present.is_some_and(|present| present.fits(&self.model, self.system()));
        let past = match present {
            // what has moved on, and whose past was not recorded elsewhere
            Some(present) if self.is_past_unknown(checkpoint, present) => {
                let notices = std::mem::take(&mut self.notices.sentences);
                let rerun = self.rerun(checkpoint, present);
                if !matches!(rerun, Rerun::Exact) {
                    self.restart();
                }
                self.notices.sentences = notices;
                Some(rerun)
            }
            _ => None,
        };
        lost.extend(self.restore_companions(&checkpoint.companions, same));
        if let Some(present) = &checkpoint.present {
            lost.extend(
                present.released.iter().filter(|name| self.constraint(name).is_none()).cloned(),
            );
            self.resume_at(checkpoint, present, past);
        }
        if !lost.is_empty() {
            self.notify(format!("no longer there: {}", lost.join(", ")));
        }
    }

    /// Whether the past of a state that is to be restored is neither recorded nor empty.
    fn is_past_unknown(&self, checkpoint: &Checkpoint, present: &MotionState) -> bool {
        checkpoint.past.is_none()
            && checkpoint.changed.is_none()
            && present.fits(&self.model, self.system())
            && (checkpoint.backwards || present.time > self.setup.start)
    }

    /// Resumes at a state, with its past if that is known.
    fn resume_at(&mut self, checkpoint: &Checkpoint, present: &MotionState, past: Option<Rerun>) {
        if let Some(Rerun::Exact) = past {
            self.motion.set_steps(present.steps);
            self.gauge(|gauges, now| gauges.restore(&present.references, now));
            return;
        }
        if let Err(why) = self.restore_state(present) {
            self.restart();
            self.notify(format!("the motion starts again: {why}"));
            return;
        }
        self.restore_change(checkpoint.changed.clone(), present);
        if checkpoint.backwards {
            self.continue_backwards();
        } else if let Some(past) = &checkpoint.past {
            self.restore_past(past, present.time, &present.coordinates);
        }
        match past {
            Some(Rerun::Near(known)) => {
                let row = |row: &[f64]| (row[0] < present.time).then(|| row.to_vec());
                self.recorder.precede(&known.trail, row);
                self.log = known.log;
            }
            Some(_) => self.notify("the past of this motion was not kept".to_owned()),
            None => {}
        }
    }

    /// Restores where the law was changed last: here, if it is another one than before.
    fn restore_change(&mut self, here: Option<String>, present: &MotionState) {
        self.changes.end_jump();
        match here {
            Some(what) => self.changed_here(what),
            None => {
                let saved = present.changed.as_ref();
                let change = saved.and_then(|saved| saved.of_system(self.system()));
                self.changes.last = change.map(Arc::new);
            }
        }
    }

    /// Applies the changed settings and returns the names that no longer exist.
    fn restore_setup(&mut self, checkpoint: &Checkpoint) -> Vec<String> {
        let mut lost = Vec::new();
        let Setup { start, end, .. } = self.setup;
        let mut setup = Setup { start, end, ..Setup::of(&self.model) };
        for changed in &checkpoint.parameters {
            match self.model.parameters.iter().position(|p| p.name == changed.name) {
                None => lost.push(changed.name.clone()),
                Some(i) if setup.parameters[i].to_bits() == changed.of_file.to_bits() => {
                    setup.parameters[i] = changed.value;
                }
                Some(_) => {}
            }
        }
        for named in &checkpoint.initial {
            match given(&self.model, named) {
                Some(given) => setup.overrides.push(given),
                None => lost.push(named.name.clone()),
            }
        }
        setup.speed = checkpoint.speed.filter(|s| *s > 0.0).unwrap_or(setup.speed);
        let settings = Settings {
            step: checkpoint.step.or(setup.settings.step),
            tolerance: checkpoint.tolerance.or(setup.settings.tolerance),
        };
        let wanted = checkpoint.method.as_ref().unwrap_or(&setup.method).clone();
        let changed = wanted != self.setup.method || settings != self.setup.settings;
        // a method that is refused leaves the current one and its settings in place
        self.setup =
            Setup { method: self.setup.method.clone(), settings: self.setup.settings, ..setup };
        if changed {
            self.take_method(&wanted, settings);
        }
        lost
    }

    /// Restores the state: bit by bit if the system has the same state, otherwise as far as the names match.
    fn restore_state(&mut self, present: &MotionState) -> Result<(), MotionError> {
        let exact = present.fits(&self.model, self.system()) && self.restore_exactly(present);
        if !exact {
            let state = self.state_of(present)?;
            self.motion.begin(&state, &self.setup.parameters)?;
        }
        self.run.error = None;
        self.motion.set_steps(present.steps);
        self.recorder.restart(present.time);
        self.gauge(Gauges::refer);
        if exact {
            self.gauge(|gauges, now| gauges.restore(&present.references, now));
            let model = std::sync::Arc::clone(&self.model);
            let same = |name: &&String| model.events.iter().any(|e| e.name == **name);
            self.run.ended = present.ended.as_ref().filter(same).cloned();
        }
        self.record();
        Ok(())
    }

    /// Restores the exact state. Returns `false` if this system cannot be in that state.
    fn restore_exactly(&mut self, present: &MotionState) -> bool {
        let released: Vec<usize> =
            present.released.iter().filter_map(|name| self.constraint(name)).collect();
        let Setup { parameters, start, .. } = &self.setup;
        // under another method, or with a step that was set meanwhile, it is none of this motion
        let same = |chosen: &&ChosenStep| {
            chosen.method == self.motion.method().name && self.motion.settings().step.is_none()
        };
        let step = present.chosen_step.as_ref().filter(same).map(|chosen| chosen.size);
        let state = present.exact();
        let taken = self.motion.restore((&state, step), parameters, (*start, &released));
        let satisfied = |(k, residual): (usize, &[f64; 2])| {
            released.contains(&k) || residual.iter().all(|r| *r <= RESIDUAL_LIMIT)
        };
        taken.is_ok() && self.motion.residuals().iter().enumerate().all(satisfied)
    }

    pub(super) fn constraint(&self, name: &str) -> Option<usize> {
        self.model.constraints.iter().position(|c| c.name == name)
    }

    /// The state with the same coordinates and velocities (momenta for a Hamiltonian), if there is one.
    fn state_of(&self, present: &MotionState) -> Result<State, MotionError> {
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
        let system = self.motion.whole();
        let mut state = system.initial(present.time, &self.setup.parameters, &given)?;
        // the action continues from what it was, whichever law it follows from now on
        if let (Some(place), Some([value, carry])) = (system.action_place(), present.action) {
            (state.values[place], state.carry[place]) = (value, carry);
        }
        Ok(state)
    }
}
