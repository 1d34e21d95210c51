//! The nearest pane of an action: where an action chosen by name goes when no pane that it is for has the focus.
//!
//! In: the place of an action, the lab. Out: the pane, and the changed focus. Never here: which actions there are.

use super::keymap::Place;
use super::{Action, App, Effect, Lab, Notification, Page, Pane};

impl App {
    /// Returns the pane of the lab for which an action of this place is meant, if there is one.
    pub fn nearest(&self, place: Place) -> Option<Pane> {
        let lab = self.lab.as_ref().filter(|_| self.page != Page::Picker)?;
        match place {
            Place::Lab => Some(lab.focus),
            Place::Space => lab.nearest_plot(true),
            Place::Plot => lab.nearest_plot(false),
            Place::Values => Some(Pane::Parameters),
            Place::Gauges => Some(Pane::Gauges),
            _ => None,
        }
    }

    /// Focuses the nearest pane of this place and carries out an action there.
    pub(super) fn perform_at(&mut self, place: Place, action: Action) -> Vec<Effect> {
        let Some(pane) = self.nearest(place) else { return Vec::new() };
        let before = self.lab.as_ref().map(|lab| lab.focus);
        self.go(Page::Lab);
        let Some(lab) = &mut self.lab else { return Vec::new() };
        lab.focus = pane;
        let name = lab.titled(pane);
        self.notice = None;
        let effects = self.perform(action);
        // What the action itself reports is more important.
        if before != Some(pane) && self.notice.is_none() {
            self.notice = Some(Notification::info(format!("The focus moved to {name}.")));
        }
        effects
    }
}

impl Lab {
    /// The picture focused last if it is of the kind, or else the first one after the focus.
    fn nearest_plot(&self, scene: bool) -> Option<Pane> {
        let fits = |index: &usize| {
            self.plots.get(*index).is_some_and(|plot| plot.kind.is_scene() == scene)
        };
        let first = (0..self.plots.len()).find(fits);
        self.front.filter(fits).or(first).map(Pane::Plot)
    }
}
