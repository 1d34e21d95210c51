//! The impulses that the user triggers: which ones exist, and the list to choose from.
//!
//! In: the impulses and events of a model. Out: menus and commands. Never here: the effect of an impulse.

use super::{App, Choice, Choosing, Effect, Item, Lab, Menu, Overlay};
use crate::experiment::{Command, Status};
use crate::model::EventAction;

impl Lab {
    /// Returns the indices of the impulses that neither a time nor an event triggers.
    pub fn impulses(&self) -> Vec<usize> {
        let model = &self.loaded.model;
        let by_event = |index: usize| {
            model.events.iter().any(|event| event.action == EventAction::Impulse(index))
        };
        let waits = |index: &usize| {
            let impulse = &model.impulses[*index];
            impulse.times.is_empty() && impulse.period.is_none() && !by_event(*index)
        };
        (0..model.impulses.len()).filter(waits).collect()
    }

    pub(super) fn impulse_lines(&self) -> Vec<Item> {
        let line = |index: usize| {
            let impulse = &self.loaded.model.impulses[index];
            Item::plain(
                format!("impulse: {}", impulse.name),
                impulse.about.clone(),
                Choice::Impulse(index),
            )
        };
        self.impulses().into_iter().map(line).collect()
    }
}

impl App {
    /// Applies the only impulse there is, or asks which one to apply.
    pub(super) fn apply_one_impulse(&mut self) -> Vec<Effect> {
        let Some(lab) = &self.lab else { return Vec::new() };
        match lab.impulse_lines().as_slice() {
            [] if lab.loaded.model.impulses.is_empty() => {
                self.notify("This system has no impulses.")
            }
            [] => {
                self.notify("The impulses of this system act by themselves; none waits for a key.")
            }
            [Item { choice: Choice::Impulse(only), .. }] => self.apply_impulse(*only),
            lines => {
                let menu = Menu::new("Impulse", Choosing::Impulse, lines.to_vec());
                self.overlay = Some(Overlay::Menu(menu));
                Vec::new()
            }
        }
    }

    pub(super) fn apply_impulse(&mut self, index: usize) -> Vec<Effect> {
        match self.snapshot().map(|s| &s.status) {
            Some(Status::Ended(_)) => self.notify("The motion has ended; r restarts it."),
            Some(Status::Failed(_)) => self.fail("It cannot continue from here; r resets it."),
            _ => vec![Effect::Execute(Command::ApplyImpulse(index))],
        }
    }
}
