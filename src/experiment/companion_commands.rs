//! What commands do to the motions beside the main one: adding, pinning, and what follows from changes of the main one.
//!
//! In: commands. Out: an experiment with other companions, or a notice why not. Never here: how they are carried along.

use super::advance::HORIZON;
use super::companion_motion::{CompanionChange, CompanionMotion};
use super::companions::MOST_COMPANIONS;
use super::recorder::NUMBERS;
use super::{CompanionOrigin, Experiment};
use crate::num::DoubleDouble;
use crate::system::{ChannelKind, Form, InitialOverride, State, System};

/// How far a neighbour is displaced in each coordinate, as a part of the greatest value of the coordinate so far.
const DISPLACED: f64 = 1e-8;

/// The channels of the canonical variables of a system, or of the variables of its brackets.
pub(super) fn canonical(system: &System) -> Vec<usize> {
    let wanted = |kind: ChannelKind| match kind {
        ChannelKind::Position(_) => true,
        ChannelKind::Momentum(_) => system.form() != Form::Variables,
        _ => false,
    };
    let channels = system.channels().iter().enumerate();
    channels.filter(|(_, c)| wanted(c.kind)).map(|(i, _)| i).collect()
}

/// What commands do to them.
impl Experiment {
    /// Adds a motion from the initial values with these in place of the file's.
    pub(super) fn add_start(&mut self, given: Vec<InitialOverride>) {
        let Some(mut one) = self.companion(CompanionOrigin::Start(given)) else { return };
        one.begin(self.origin_state(&one));
        self.catch_up(&mut one);
        self.companions.all.push(one);
    }

    /// Adds a motion that begins beside the main one.
    pub(super) fn add_neighbour(&mut self) {
        if !self.motion.has_begun() {
            return;
        }
        if self.system().constraints() > 0 {
            return self.notify(
                "a neighbour needs independent coordinates: constraints tie these together"
                    .to_owned(),
            );
        }
        let bounds = self.recorder.bounds();
        let n = self.system().degrees();
        let kinds = self.system().channels().iter().map(|c| c.kind);
        let mut sizes = vec![0.0; n];
        for (kind, (least, greatest)) in kinds.zip(bounds.iter()) {
            if let ChannelKind::Position(i) = kind {
                sizes[i] = least.abs().max(greatest.abs());
            }
        }
        // a coordinate that has always been zero is as large as the others
        let largest = sizes.iter().copied().fold(0.0, f64::max);
        let largest = if largest > 0.0 { largest } else { 1.0 };
        let displaced = |size: &f64| DISPLACED * if *size > 0.0 { *size } else { largest };
        let origin = CompanionOrigin::Neighbour(sizes.iter().map(displaced).collect());
        let Some(mut one) = self.companion(origin) else { return };
        let state = Self::beside(&one.origin, self.motion.state());
        let step = Some(self.motion.step_size().abs());
        one.begin_underway((&state, step), (self.setup.start, &[]));
        one.expect(self.companions.due(self.time(), self.motion.values()));
        self.companions.all.push(one);
    }

    /// Keeps the current run, with all its values, beside whatever follows.
    pub(super) fn pin(&mut self) {
        if !self.motion.has_begun() || self.run.error.is_some() {
            return self.notify("there is no motion to pin".to_owned());
        }
        let Some(mut one) = self.companion(CompanionOrigin::Pinned(self.setup.overrides.clone()))
        else {
            return;
        };
        let underway = (self.setup.start, &self.motion.released()[..]);
        let step = Some(self.motion.step_size().abs());
        one.begin_underway((self.motion.state(), step), underway);
        one.precede(&self.recorder.trail());
        self.companions.all.push(one);
    }

    /// A companion that has yet to begin, if there is room for it.
    fn companion(&mut self, origin: CompanionOrigin) -> Option<CompanionMotion> {
        if self.is_backwards() {
            self.notify("motions are added while time runs forwards".to_owned());
            return None;
        }
        let Some(number) = self.companions.number() else {
            self.notify(format!(
                "there can be at most {MOST_COMPANIONS} motions beside the main one"
            ));
            return None;
        };
        self.name_variables();
        let system = self.motion.whole().clone();
        let parameters = self.setup.parameters.clone();
        let method = (self.motion.method(), self.motion.settings());
        let numbers = NUMBERS / MOST_COMPANIONS;
        let sentence = origin.sentence(number);
        match CompanionMotion::new(&system, method, (number, origin), &parameters, numbers) {
            Ok(one) => {
                self.notify(sentence);
                Some(one)
            }
            Err(why) => {
                self.notify(why.to_string());
                None
            }
        }
    }

    /// Finds the variables in which distances are measured.
    pub(super) fn name_variables(&mut self) {
        let (system, parameters) = (self.motion.whole(), &self.setup.parameters);
        if self.companions.variables.is_empty() {
            self.companions.variables = canonical(system);
        }
        let periods = self.companions.variables.iter().map(|&i| system.period(i, parameters));
        self.companions.periods = periods.collect();
    }

    /// Where a companion begins when the main motion does.
    pub(super) fn origin_state(
        &self,
        one: &CompanionMotion,
    ) -> Result<State, crate::system::MotionError> {
        let start = self.setup.start;
        match &one.origin {
            CompanionOrigin::Start(given) | CompanionOrigin::Pinned(given) => {
                self.motion.whole().initial(start, &one.parameters, given)
            }
            CompanionOrigin::Neighbour(_) | CompanionOrigin::Before => {
                self.initial_state().map(|state| Self::beside(&one.origin, &state))
            }
        }
    }

    fn beside(origin: &CompanionOrigin, state: &State) -> State {
        let mut state = state.clone();
        if let CompanionOrigin::Neighbour(displaced) = origin {
            for (i, by) in displaced.iter().enumerate() {
                let moved = state.exact(i) + DoubleDouble::from_decimal(*by);
                state.set(i, moved);
            }
        }
        state
    }

    /// Lets a companion pass through the rows that the main motion already has.
    fn catch_up(&self, one: &mut CompanionMotion) {
        let trail = self.recorder.trail();
        for row in trail.rows() {
            one.expect(self.companions.due(row[0], &row[1..]));
        }
    }

    /// The main motion has begun again, and so do they.
    pub(super) fn restart_companions(&mut self) {
        let mut all = std::mem::take(&mut self.companions.all);
        for one in &mut all {
            if !matches!(one.origin, CompanionOrigin::Pinned(_)) {
                one.parameters.clone_from(&self.setup.parameters);
            }
            one.begin(self.origin_state(one));
            self.catch_up(one);
        }
        self.companions.all = all;
    }

    /// Lets all meet a change of the main motion where that is: those that were farther, as they are where it was carried back,
    /// go back, and those that are behind change once they are there. Of a pinned run nothing changes but the distances.
    pub(super) fn pass(&mut self, change: &CompanionChange) {
        let (time, start) = (self.time(), self.setup.start);
        for one in &mut self.companions.all {
            one.forget_rows_after(time);
            one.forget_distances_after(time);
            if !matches!(one.origin, CompanionOrigin::Pinned(_)) {
                one.go_back(time, start);
                one.expect_change(time, change.clone());
            }
        }
    }

    /// Whether a motion beside the main one has not reached its time.
    pub fn is_behind(&self) -> bool {
        !self.is_backwards() && self.companions.are_behind(self.time())
    }

    /// Advances the motions beside the main one to its time, in at most `budget` steps.
    pub(super) fn advance_companions(&mut self, budget: u64) {
        let ahead = HORIZON * self.setup.spacing;
        let time = self.time();
        if time.is_finite() && !self.is_backwards() {
            self.companions.advance(time, ahead, budget);
        }
    }
}
