//! The nearest pane of an action: where an action chosen by name goes when no pane that it is for has the focus.
//!
//! In: the context of an action, the lab. Out: the pane, and the changed focus. Never here: which actions there are.

use super::keymap::KeyContext;
use super::{Action, App, Effect, Lab, Notification, Page, Pane};
use crate::instrument::{Plot, Sight};

impl App {
    /// Returns the pane of the lab for which an action of this context is meant, if there is one.
    pub fn nearest(&self, context: KeyContext) -> Option<Pane> {
        let lab = self.lab.as_ref().filter(|_| self.page != Page::Picker)?;
        match context {
            KeyContext::Lab => Some(lab.focus.pane),
            KeyContext::Space => lab.nearest_plot(true),
            KeyContext::Plot => lab.nearest_plot(false),
            KeyContext::Values => Some(Pane::Parameters),
            KeyContext::Gauges => Some(Pane::Gauges),
            _ => None,
        }
    }

    /// Focuses the nearest pane of this context and carries out an action there.
    pub(super) fn handle_action_in(&mut self, context: KeyContext, action: Action) -> Vec<Effect> {
        let Some(pane) = self.nearest(context) else { return Vec::new() };
        let before = self.lab.as_ref().map(|lab| lab.focus.pane);
        self.go(Page::Lab);
        let Some(lab) = &mut self.lab else { return Vec::new() };
        lab.focus.pane = pane;
        let name = lab.spoken(pane);
        self.notifications.dismiss();
        let effects = self.handle_action(action);
        // What the action itself reports is more important.
        if before != Some(pane) && self.notifications.shown.is_none() {
            self.notifications.show(Notification::info(format!("The focus moved to {name}.")));
        }
        effects
    }
}

impl App {
    /// Shows or hides the cursor of the focused plot; elsewhere goes to that of the nearest one.
    pub(super) fn toggle_cursor(&mut self) -> Vec<Effect> {
        let focused = self.lab.as_ref().map(|lab| lab.focus.pane);
        let near = self.nearest(KeyContext::Plot);
        let shown = match (near, &self.lab) {
            (Some(Pane::Plot(i)), Some(lab)) => lab.plots.get(i).and_then(Plot::viewport),
            _ => None,
        };
        let shown = shown.filter(|viewport| viewport.cursor.is_some());
        match near {
            None => self.notify("No plot here has a cursor: v on a pane chooses one."),
            near if near == focused => self.with_viewport(|viewport| {
                let middle = viewport.cursor.is_none().then_some([0.5; 2]);
                viewport.put_cursor(middle);
            }),
            Some(_) => {
                let mut effects = self.handle_action_in(KeyContext::Plot, Action::Cursor);
                // one that was shown stays
                effects.extend(self.with_viewport(|viewport| {
                    *viewport = shown.unwrap_or(*viewport);
                }));
                effects
            }
        }
    }
}

/// Pictures chosen by name.
impl App {
    /// Shows the offer of this index in the nearest plot, or in that of the motion if there is no other.
    pub(super) fn show_nearest(&mut self, index: usize) -> Vec<Effect> {
        let pane = self.nearest(KeyContext::Plot).or_else(|| self.nearest(KeyContext::Space));
        let Some(Pane::Plot(plot)) = pane else { return Vec::new() };
        self.go(Page::Lab);
        if let Some(lab) = &mut self.lab {
            lab.focus.pane = Pane::Plot(plot);
        }
        self.take_offer(plot, index)
    }
}

/// What a picture has instead of what it shows.
impl App {
    /// Lets the nearest transformation move the point, or the coordinates again, or the nearest action show its next
    /// principle, a diagram its next number. The focus stays.
    pub(super) fn other_way(&mut self) -> Vec<Effect> {
        let Some(lab) = &mut self.lab else { return Vec::new() };
        let Some(index) = lab.with_other_way() else {
            return self
                .notify("Q does nothing here: it is for transformations, actions and diagrams.");
        };
        lab.redraw(index, |plot, _| {
            if !plot.kind.properties().is_transformed() {
                plot.kind = plot.kind.properties().other.unwrap_or(plot.kind);
            } else if let Some(viewport) = plot.viewport_mut() {
                viewport.active = !viewport.active;
            }
            // its coordinates were those of other quantities
            if let Some(viewport) = plot.viewport_mut() {
                viewport.cursor_at = None;
            }
        });
        Vec::new()
    }

    /// Shows the vector field of the nearest phase portrait that has one, or hides it; says why the focused one has none.
    pub(super) fn toggle_field(&mut self) -> Vec<Effect> {
        let Some(lab) = &mut self.lab else { return Vec::new() };
        let focused =
            lab.focused_plot().filter(|(_, plot)| plot.kind.properties().has_vector_field);
        let focused = focused.map(|(index, _)| index);
        let Some(index) = focused.or_else(|| lab.with_vector_field()) else {
            return self.notify("No phase portrait here has a vector field; v chooses one.");
        };
        let plot = &lab.plots[index];
        if let Some(why) = plot.lacks_field(lab.loaded.physics()) {
            return self.notify(format!("This plane has no vector field: {why}."));
        }
        let shown = if plot.shows_field() { "hidden" } else { "shown" };
        let name = lab.spoken(Pane::Plot(index));
        let is_elsewhere = focused.is_none();
        // what is out of view comes to the front
        if !lab.drawn.in_view.has(Pane::Plot(index)) {
            lab.focus.choose(Pane::Plot(index));
        }
        lab.redraw(index, |plot, _| {
            if let Some(viewport) = plot.viewport_mut() {
                viewport.field = !viewport.field;
            }
        });
        if is_elsewhere {
            let comma = if name.contains(',') { "," } else { "" };
            let sentence = format!("The vector field of {name}{comma} is {shown}.");
            self.notifications.show(Notification::info(sentence));
        }
        Vec::new()
    }
}

impl Lab {
    /// The nearest picture of a transformation, of an action, or over a range.
    pub(super) fn with_other_way(&self) -> Option<usize> {
        self.nearest_fitting(|plot| {
            plot.kind.properties().is_transformed() || plot.kind.properties().other.is_some()
        })
    }

    /// The nearest phase portrait that has a vector field: one in view, if there is one.
    pub(super) fn with_vector_field(&self) -> Option<usize> {
        let physics = self.loaded.physics();
        let fits = |plot: &Plot| {
            plot.kind.properties().has_vector_field && plot.lacks_field(physics).is_none()
        };
        let is_seen = |index: &usize| self.drawn.in_view.has(Pane::Plot(*index));
        let seen =
            self.plots.iter().enumerate().filter(|(index, plot)| is_seen(index) && fits(plot));
        let nearest = self.nearest_fitting(fits);
        nearest.filter(is_seen).or(seen.map(|(index, _)| index).next()).or(nearest)
    }

    /// Whether the focused picture of a motion in space is seen otherwise than at the beginning.
    pub fn is_seen_otherwise(&self) -> bool {
        let sight = self.focused_plot().map(|(_, plot)| plot.sight);
        matches!(sight, Some(Sight::Camera(eye)) if eye.is_moved(&self.loaded.model))
    }

    /// The nearest picture of the kind.
    fn nearest_plot(&self, scene: bool) -> Option<Pane> {
        self.nearest_fitting(|plot| plot.kind.properties().is_scene == scene).map(Pane::Plot)
    }

    /// The focused picture if it fits, or else the one focused last, or else the first.
    fn nearest_fitting(&self, fits: impl Fn(&Plot) -> bool) -> Option<usize> {
        let fits = |index: &usize| self.plots.get(*index).is_some_and(&fits);
        let focused = self.focused_plot().map(|(index, _)| index);
        let first = (0..self.plots.len()).find(fits);
        focused.filter(fits).or(self.focus.recent.first().copied().filter(fits)).or(first)
    }
}
