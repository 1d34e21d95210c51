//! Changes to the lab: each is made, recorded, and can be undone.
//!
//! In: new values, methods, settings and pictures. Out: commands, and the pending values until the experiment shows
//! them. Never here: which key triggers a change, or how the history is stored.

use super::earlier_window::EarlierWindow;
use super::history::Change;
use super::{App, Effect, Lab, Loaded, Pane, ValueId};
use crate::experiment::{Checkpoint, Command, Snapshot, Status, with_override};
use crate::instrument::Plot;
use crate::integrate::Settings;
use crate::num::significant;
use crate::system::InitialOverride;

/// A side of a change: the state before it, or after it.
#[derive(Clone, Copy)]
enum ChangeSide {
    Before,
    After,
}

impl App {
    /// Sets a value as the user would: it is selected in its list, and the change can be undone. Setting an initial
    /// value restarts the motion even if the value is the same.
    pub fn give(&mut self, target: ValueId, value: f64) -> Vec<Effect> {
        let Some(lab) = &mut self.lab else { return Vec::new() };
        match target {
            ValueId::Parameter(index) => lab.selection.parameter = index,
            ValueId::Initial(index) => lab.selection.initial = index,
        }
        let mut effects = lab.change(target, value);
        if effects.is_empty() {
            effects.push(Effect::Execute(match target {
                ValueId::Parameter(index) => Command::Parameter { index, value },
                ValueId::Initial(index) => Command::Initial { index, value },
            }));
        }
        let shown = self.notifications.shown.clone();
        self.forget_past_motion(shown.as_ref(), &effects);
        effects
    }

    /// Groups all changes from now until [`App::end_group`] into one.
    pub fn begin_group(&mut self) {
        if let Some(lab) = &mut self.lab {
            lab.history.begin_group();
        }
    }
}

impl Lab {
    /// Returns the method's name: the one requested last, until the experiment confirms it.
    pub(super) fn method(&self) -> Option<&'static str> {
        self.pending.method.or(self.snapshot.as_ref().map(|s| s.method.name))
    }

    fn settings(&self) -> Option<Settings> {
        self.pending.settings.or(self.snapshot.as_ref().map(|s| s.setup.settings))
    }

    fn given(&self) -> Vec<InitialOverride> {
        let fact = || self.snapshot.as_ref().map_or(Vec::new(), |s| s.setup.overrides.clone());
        self.pending.given.clone().unwrap_or_else(fact)
    }

    pub(super) fn change(&mut self, target: ValueId, to: f64) -> Vec<Effect> {
        let Some(from) = self.value(target).filter(|from| *from != to) else { return Vec::new() };
        let numbers = [from, to];
        match target {
            ValueId::Parameter(index) => {
                let steps_on = self.history.steps_on(index);
                self.note(Change::Parameter { index, numbers });
                self.pending.set_value(target, to);
                vec![Effect::Execute(if steps_on {
                    Command::MoveParameter { index, value: to }
                } else {
                    Command::Parameter { index, value: to }
                })]
            }
            ValueId::Initial(index) => {
                let before = self.given();
                let after = with_override(&self.loaded.system, &before, index, to);
                self.note(Change::Initial { index, numbers, given: [before, after.clone()] });
                self.pending.set_value(target, to);
                self.pending.given = Some(after);
                vec![Effect::Execute(Command::Initial { index, value: to })]
            }
        }
    }

    /// Starts the motion with several initial values at once.
    pub(super) fn start(&mut self, values: &[InitialOverride]) -> Vec<Effect> {
        let window_before = self.earlier_window.clone();
        self.keep_windows();
        self.start_in_window(values, window_before)
    }

    /// Does so in the window that the pictures have now, given the ranges that they kept before.
    pub(super) fn start_in_window(
        &mut self,
        values: &[InitialOverride],
        window_before: EarlierWindow,
    ) -> Vec<Effect> {
        let after = self.given_with(values);
        let given = [self.given(), after.clone()];
        let windows = [window_before, self.earlier_window.clone()];
        self.note(Change::Start { given, windows });
        vec![self.begin_with(after)]
    }

    /// Starts the motion where a flow has led.
    pub(super) fn start_carried(&mut self, after: Vec<InitialOverride>) -> Vec<Effect> {
        self.note(Change::Flow([self.given(), after.clone()]));
        self.keep_windows();
        vec![self.begin_with(after)]
    }

    /// Returns the initial values that differ from the file's, with these in place of theirs.
    pub(super) fn given_with(&self, values: &[InitialOverride]) -> Vec<InitialOverride> {
        let before = self.given();
        let replaced = |old: &&InitialOverride| values.iter().any(|new| place(new) == place(old));
        let unchanged = before.iter().filter(|old| !replaced(old)).copied();
        unchanged.chain(values.iter().copied()).collect()
    }

    /// Restores all values of the file.
    pub(super) fn full_reset(&mut self) -> Vec<Effect> {
        let parameters = (0..self.count(ValueId::Parameter)).map(ValueId::Parameter);
        let parameters = parameters.filter_map(|target| self.value(target)).collect();
        self.note(Change::FullReset { parameters, given: self.given() });
        vec![self.give_back()]
    }

    pub(super) fn integrate_by(&mut self, name: &'static str) -> Vec<Effect> {
        match self.method() {
            // Switching to the same method would only restart its statistics.
            Some(before) if before == name => return Vec::new(),
            Some(before) => self.note(Change::Method([before, name])),
            None => {}
        }
        self.pending.method = Some(name);
        vec![Effect::Execute(Command::Method(name.to_owned()))]
    }

    pub(super) fn step_by(&mut self, step: f64) -> Vec<Effect> {
        self.change_settings(|settings| settings.step = Some(step));
        vec![Effect::Execute(Command::StepSize(step))]
    }

    pub(super) fn tolerate(&mut self, tolerance: f64) -> Vec<Effect> {
        self.change_settings(|settings| settings.tolerance = Some(tolerance));
        vec![Effect::Execute(Command::Tolerance(tolerance))]
    }

    fn change_settings(&mut self, change: impl FnOnce(&mut Settings)) {
        let Some(before) = self.settings() else { return };
        let mut after = before;
        change(&mut after);
        if after != before {
            self.note(Change::Settings([before, after]));
        }
        self.pending.settings = Some(after);
    }

    pub(super) fn redraw(&mut self, index: usize, change: impl FnOnce(&mut Plot, &super::Loaded)) {
        let Some(plot) = self.plots.get_mut(index) else { return };
        let before = plot.clone();
        change(plot, &self.loaded);
        if *plot == before {
            return;
        }
        let plots = Box::new([before, plot.clone()]);
        self.note(Change::Plot { index, plots });
        self.answers.stale = true;
    }

    /// Undoes the last change and returns its description. Returns `None` if there is none.
    pub(super) fn undo(&mut self) -> Option<(Vec<Effect>, String)> {
        let now = self.checkpoint();
        let (change, motion) = self.history.undo(now)?;
        Some(self.go_to_side("undone", (change, motion), ChangeSide::Before))
    }

    /// Redoes the change undone last and returns its description. Returns `None` if there is none.
    pub(super) fn redo(&mut self) -> Option<(Vec<Effect>, String)> {
        let now = self.checkpoint();
        let (change, motion) = self.history.redo(now)?;
        Some(self.go_to_side("redone", (change, motion), ChangeSide::After))
    }

    /// Applies one side of a change, and brings back the motion that was there then.
    fn go_to_side(
        &mut self,
        verb: &str,
        (change, motion): (Change, Option<Box<Checkpoint>>),
        side: ChangeSide,
    ) -> (Vec<Effect>, String) {
        let mut label = format!("{verb}: {}", self.words(&change, side));
        let mut effects = self.carry_out(change, side);
        // motions beside this one, and a run that is gone back over, belong to the motion of now
        let is_alone = |seen: &Snapshot| seen.companions.is_empty() && !seen.backwards;
        if let Some(mut motion) = motion.filter(|_| self.seen().is_some_and(is_alone)) {
            // whether time runs, and how fast, is no part of the change
            if let Some(seen) = self.seen() {
                motion.running = seen.status == Status::Running
                    || !matches!(seen.status, Status::Paused) && motion.running;
                let of_file = self.loaded.model.run.speed;
                motion.speed = Some(seen.speed).filter(|speed| *speed != of_file);
            }
            if let Some(present) =
                motion.present.as_ref().filter(|now| now.time != self.loaded.model.run.start)
            {
                label += &format!(", the motion of t = {}", crate::num::short(present.time));
            }
            effects.retain(
                |effect| !matches!(effect, Effect::Execute(command) if command.sets_values()),
            );
            self.restoration.forget_rebuild();
            self.restoration.begin((*motion).clone(), None);
            effects.push(Effect::Execute(Command::Restore(motion)));
        }
        (effects, label)
    }

    /// Records a change, and the motion before it if that becomes another one.
    fn note(&mut self, change: Change) {
        let of_motion = change.is_of_motion();
        if self.history.note(change)
            && of_motion
            && let Some(before) = self.checkpoint()
        {
            self.history.keep_motion(before);
        }
    }

    /// Returns the motion now, as it will be once everything requested is done.
    pub(super) fn checkpoint(&self) -> Option<Checkpoint> {
        let Loaded { model, system, .. } = &self.loaded;
        let seen = self.seen()?;
        let awaited = self.restoration.checkpoint();
        let of_seen = || Checkpoint::of(model, system, seen).with_past(system, seen);
        let mut now = awaited.cloned().unwrap_or_else(of_seen);
        let value = |index| self.value(ValueId::Parameter(index));
        let values = (0..model.parameters.len()).map(|i| value(i).unwrap_or(seen.parameters[i]));
        now.set_parameters(model, values);
        if let (Some(given), None) = (&self.pending.given, awaited) {
            now.start_with(model, given);
        }
        Some(now)
    }

    /// Describes the transition to one side of a change: `g 9.81 → 3.2`.
    fn words(&self, change: &Change, side: ChangeSide) -> String {
        let named = |target| {
            self.value_info(target).map_or_else(String::new, |value_info| value_info.shown)
        };
        let went = |what: &str, [from, to]: [String; 2]| format!("{what} {from} → {to}");
        match change {
            Change::Parameter { index, numbers } => {
                went(&named(ValueId::Parameter(*index)), side.way(*numbers).map(short))
            }
            Change::Initial { index, numbers, .. } => {
                let name = format!("initial {}", named(ValueId::Initial(*index)));
                went(&name, side.way(*numbers).map(short))
            }
            Change::Start { .. } => "the initial values".to_owned(),
            Change::Flow(_) => "the flow".to_owned(),
            Change::FullReset { .. } => "the reset to the file's values".to_owned(),
            Change::Plot { index, .. } => {
                format!("the view of {}", self.name_of(Pane::Plot(*index)))
            }
            Change::Method(names) => went("method", side.way(*names).map(str::to_owned)),
            Change::Settings(settings) => {
                let [before, after] = side.way(*settings);
                let number = |v: Option<f64>| v.map_or_else(|| "by itself".to_owned(), short);
                if before.step == after.step {
                    went("tolerance", [before.tolerance, after.tolerance].map(number))
                } else {
                    went("step", [before.step, after.step].map(number))
                }
            }
            Change::Together(changes) => {
                let each: Vec<String> = changes.iter().map(|one| self.words(one, side)).collect();
                each.join(", ")
            }
        }
    }

    /// Applies one side of a change, and shows the pane in which it is visible.
    fn carry_out(&mut self, change: Change, side: ChangeSide) -> Vec<Effect> {
        match change {
            Change::Parameter { index, numbers } => {
                self.choose(ValueId::Parameter(index));
                vec![self.set_parameter(index, side.of(numbers))]
            }
            Change::Initial { index, numbers, given } => {
                self.choose(ValueId::Initial(index));
                self.keep_windows();
                let effect = self.begin_with(side.of(given));
                self.pending.set_value(ValueId::Initial(index), side.of(numbers));
                vec![effect]
            }
            Change::Start { given, windows } => {
                self.earlier_window = side.of(windows);
                vec![self.begin_with(side.of(given))]
            }
            Change::Flow(given) => {
                self.keep_windows();
                vec![self.begin_with(side.of(given))]
            }
            Change::FullReset { parameters, given } => match side {
                ChangeSide::After => vec![self.give_back()],
                ChangeSide::Before => {
                    let mut effects = Vec::new();
                    for (index, value) in parameters.into_iter().enumerate() {
                        if self.value(ValueId::Parameter(index)) != Some(value) {
                            effects.push(self.set_parameter(index, value));
                        }
                    }
                    self.keep_windows();
                    effects.push(self.begin_with(given));
                    effects
                }
            },
            Change::Plot { index, plots } => {
                if let Some(plot) = self.plots.get_mut(index) {
                    *plot = side.of(*plots);
                    self.focus.pane = Pane::Plot(index);
                }
                self.answers.stale = true;
                Vec::new()
            }
            Change::Method(names) => {
                let name = side.of(names);
                self.pending.method = Some(name);
                vec![Effect::Execute(Command::Method(name.to_owned()))]
            }
            Change::Settings(settings) => {
                let settings = side.of(settings);
                self.pending.settings = Some(settings);
                vec![Effect::Execute(Command::Settings(settings))]
            }
            Change::Together(mut changes) => {
                if matches!(side, ChangeSide::Before) {
                    changes.reverse();
                }
                changes.into_iter().flat_map(|change| self.carry_out(change, side)).collect()
            }
        }
    }

    fn set_parameter(&mut self, index: usize, value: f64) -> Effect {
        self.pending.set_value(ValueId::Parameter(index), value);
        Effect::Execute(Command::Parameter { index, value })
    }

    /// Starts the motion with these in place of the file's values.
    fn begin_with(&mut self, given: Vec<InitialOverride>) -> Effect {
        // The experiment reports the resulting other initial values.
        self.pending.values.retain(|(target, _)| matches!(target, ValueId::Parameter(_)));
        self.pending.given = Some(given.clone());
        Effect::Execute(Command::Start(given))
    }

    /// Restores all values of the file.
    fn give_back(&mut self) -> Effect {
        self.pending.values.clear();
        let parameters = self.loaded.model.parameter_values().into_iter().enumerate();
        let values = parameters.map(|(index, value)| (ValueId::Parameter(index), value));
        self.pending.values.extend(values);
        self.pending.given = Some(Vec::new());
        Effect::Execute(Command::FullReset)
    }
}

/// Returns the index of the coordinate, and whether its rate or momentum is given.
fn place(given: &InitialOverride) -> (usize, bool) {
    match given {
        InitialOverride::Position(i, _) => (*i, false),
        InitialOverride::Velocity(i, _) | InitialOverride::Momentum(i, _) => (*i, true),
    }
}

/// Formats a number with at most six digits.
fn short(value: f64) -> String {
    significant(value, 6, 1e-4..1e7)
}

impl ChangeSide {
    /// Orders a pair so that it leads to this side.
    fn way<T>(self, [before, after]: [T; 2]) -> [T; 2] {
        match self {
            Self::Before => [after, before],
            Self::After => [before, after],
        }
    }

    fn of<T>(self, [before, after]: [T; 2]) -> T {
        match self {
            Self::Before => before,
            Self::After => after,
        }
    }
}
