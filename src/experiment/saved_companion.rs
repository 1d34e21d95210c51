//! A motion beside the main one by names, to the last bit, to be restored elsewhere.
//!
//! In: a companion of a snapshot. Out: plain data, and the companion again, in another experiment of a system with the same
//! names. Never here: the main motion (`checkpoint`).

use serde::{Deserialize, Serialize};

use super::companion_motion::CompanionMotion;
use super::companions::MOST_COMPANIONS;
use super::exact_state::{exact_numbers, exact_state};
use super::named::{Named, given, named};
use super::recorder::NUMBERS;
use super::setup::choose_method;
use super::{Companion, CompanionOrigin, Experiment};
use crate::integrate::Settings;
use crate::model::Model;
use crate::system::{Form, InitialOverride, State};

/// A motion beside the main one.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct SavedCompanion {
    /// As it is counted in the lab, from 1.
    pub number: usize,
    /// What it is.
    pub origin: OriginKind,
    /// The initial values that override the file's, of a start or a pinned run.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub initial: Vec<Named>,
    /// How far each coordinate of a neighbour was displaced.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub displaced: Vec<f64>,
    /// The parameters of a pinned run.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub parameters: Vec<Named>,
    /// The method of a pinned run, and of any other that has chosen its step.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub method: Option<String>,
    /// Its step, if it was set.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step: Option<f64>,
    /// The step that its method has chosen, if all steps are equal and none was set.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fixed_step: Option<f64>,
    /// The constraints that were released.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub released: Vec<String>,
    /// Its tolerance, if it was set.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// Where it is: the time and its carried rounding error.
    pub time: [f64; 2],
    /// The meaning of the second half of `state`.
    pub form: Form,
    /// Each number of its state with its carried rounding error; empty if it had come to an end.
    pub state: Vec<[f64; 2]>,
}

/// What a companion is.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum OriginKind {
    /// Another start.
    Start,
    /// A motion that began close beside the main one.
    Neighbour,
    /// A pinned run.
    Pinned,
}

impl SavedCompanion {
    /// A companion by names; `None` for one that belongs to the main motion itself.
    pub(super) fn of(model: &Model, one: &Companion) -> Option<SavedCompanion> {
        let (origin, given, displaced) = match &one.origin {
            CompanionOrigin::Start(given) => (OriginKind::Start, given.as_slice(), Vec::new()),
            CompanionOrigin::Neighbour(displaced) => {
                (OriginKind::Neighbour, &[][..], displaced.clone())
            }
            CompanionOrigin::Pinned(given) => (OriginKind::Pinned, given.as_slice(), Vec::new()),
            CompanionOrigin::Before => return None,
        };
        let pinned = origin == OriginKind::Pinned;
        let parameters = model.parameters.iter().zip(one.parameters.iter());
        let parameters =
            parameters.map(|(p, &value)| Named { name: p.name.clone(), value }).collect();
        let released = one.released.iter().filter_map(|&k| model.constraints.get(k));
        let chosen_step = one.fixed_step.filter(|_| one.settings.step.is_none());
        let continues = one.message.is_none() && one.state.is_finite();
        Some(SavedCompanion {
            number: one.number,
            origin,
            initial: given.iter().filter_map(|given| named(model, *given)).collect(),
            displaced,
            parameters: if pinned { parameters } else { Vec::new() },
            method: (pinned || chosen_step.is_some()).then(|| one.method.to_owned()),
            step: one.settings.step.filter(|_| pinned),
            fixed_step: chosen_step,
            released: released.map(|constraint| constraint.name.clone()).collect(),
            tolerance: one.settings.tolerance.filter(|_| pinned),
            time: [one.state.time, one.state.time_carry],
            form: one.state.form,
            state: if continues { exact_numbers(&one.state) } else { Vec::new() },
        })
    }

    fn state(&self) -> State {
        exact_state(self.time, self.form, &self.state)
    }
}

impl Experiment {
    /// Puts these companions in place of those there are; `exactly` if the coordinates are the same. Returns the names of
    /// what could not be restored.
    pub(super) fn restore_companions(
        &mut self,
        saved: &[SavedCompanion],
        exactly: bool,
    ) -> Vec<String> {
        self.companions.clear();
        let mut lost = Vec::new();
        for one in saved.iter().take(MOST_COMPANIONS) {
            let taken = self.companions.all.iter().any(|other| other.number == one.number);
            let known = (1..=MOST_COMPANIONS).contains(&one.number) && !taken;
            let motion = known.then(|| self.companion_of(one)).flatten();
            let Some(mut motion) = motion else {
                lost.push(format!("motion {}", one.number));
                continue;
            };
            let state = one.state();
            let system = self.motion.whole();
            let poisson = state.form == Form::Variables;
            let fits = exactly
                && state.values.len() == system.state_len()
                && state.is_finite()
                && poisson == (system.form() == Form::Variables);
            let released = one.released.iter().map(|name| self.constraint(name));
            let released: Option<Vec<usize>> = released.collect();
            if let Some(released) = released.filter(|_| fits) {
                let step = one.fixed_step.filter(|_| motion.may_have_chosen(one.method.as_deref()));
                motion.begin_underway((&state, step), (self.setup.start, &released));
            } else {
                motion.begin(self.origin_state(&motion));
            }
            self.companions.all.push(motion);
        }
        lost
    }

    fn companion_of(&mut self, one: &SavedCompanion) -> Option<CompanionMotion> {
        let initial: Vec<InitialOverride> =
            one.initial.iter().map(|named| given(&self.model, named)).collect::<Option<_>>()?;
        let degrees = self.system().degrees();
        let origin = match one.origin {
            OriginKind::Start => CompanionOrigin::Start(initial),
            OriginKind::Neighbour if one.displaced.len() == degrees => {
                CompanionOrigin::Neighbour(one.displaced.clone())
            }
            OriginKind::Neighbour => return None,
            OriginKind::Pinned => CompanionOrigin::Pinned(initial),
        };
        let mut parameters = self.setup.parameters.clone();
        for named in &one.parameters {
            let place = self.model.parameters.iter().position(|p| p.name == named.name)?;
            parameters[place] = named.value;
        }
        let system = self.motion.whole().clone();
        let (method, settings) = match &one.method {
            Some(name) if one.origin == OriginKind::Pinned => (
                choose_method(&system, name).ok()?,
                Settings { step: one.step, tolerance: one.tolerance },
            ),
            _ => (self.motion.method(), self.motion.settings()),
        };
        self.name_variables();
        let numbers = NUMBERS / MOST_COMPANIONS;
        CompanionMotion::new(
            &system,
            (method, settings),
            (one.number, origin),
            &parameters,
            numbers,
        )
        .ok()
    }
}
