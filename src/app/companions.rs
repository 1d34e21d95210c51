//! Motions beside the main one: what keys and the mouse do to add and clear them.
//!
//! In: a point of a plot. Out: commands, and the pane that shows how motions part. Never here: how they are computed.

use super::{App, Effect, HitTarget, Lab, Page, Pane};
use crate::experiment::{Command, MOST_COMPANIONS};
use crate::instrument::{NoStart, Plot, named};

/// What is said where a point is no start.
const NO_START: &str = "No motion can start from a point of this plot: that takes a coordinate and its rate, or a section.";

impl App {
    /// Adds a motion that begins at the cursor of the focused plot.
    pub(super) fn add_start_here(&mut self) -> Vec<Effect> {
        let Some(lab) = &self.lab else { return Vec::new() };
        let Some((index, _)) = lab.focused_plot() else { return Vec::new() };
        match self.drawn.reading.filter(|_| lab.has_cursor()) {
            Some(at) => self.add_start_at(index, at),
            None => self.notify("A motion is added at the cursor; c puts one on the plot."),
        }
    }

    /// Adds a motion that begins where the mouse is.
    pub(super) fn add_start(&mut self, hit: HitTarget) -> Vec<Effect> {
        match hit {
            HitTarget::Plot { index, at, .. } if self.overlay.is_none() => {
                if let Some(lab) = &mut self.lab {
                    lab.focus.pane = Pane::Plot(index);
                }
                self.add_start_at(index, at)
            }
            _ => Vec::new(),
        }
    }

    fn add_start_at(&mut self, index: usize, at: [f64; 2]) -> Vec<Effect> {
        let Some(lab) = &mut self.lab else { return Vec::new() };
        match lab.beginning_at(index, at) {
            Ok(given) if lab.has_room() => {
                let given = lab.given_with(&given);
                vec![Effect::Execute(Command::AddStart(given))]
            }
            Ok(_) => self.notify(full()),
            Err(NoStart::Refused(why)) => self.fail(why),
            Err(NoStart::Nothing) => self.notify(NO_START),
        }
    }

    /// Adds a neighbour of the motion, and shows their separation.
    pub(super) fn add_neighbour(&mut self) -> Vec<Effect> {
        let Some(lab) = &mut self.lab else { return Vec::new() };
        if !lab.loaded.model.constraints.is_empty() {
            return self.notify(
                "A neighbour needs independent coordinates, and constraints tie these together.",
            );
        }
        if !lab.has_room() {
            return self.notify(full());
        }
        lab.show("separation");
        vec![Effect::Execute(Command::AddNeighbour)]
    }

    /// Shows the picture of a kind, on the page of the lab.
    pub(super) fn show_picture(&mut self, kind: &str) -> Vec<Effect> {
        if self.lab.as_mut().is_some_and(|lab| lab.show(kind)) && self.page != Page::Lab {
            self.go(Page::Lab);
        }
        Vec::new()
    }

    /// Shows the periodic orbit near the motion; where it is shown already, it is searched for near where the motion is now.
    pub(super) fn find_orbit(&mut self) -> Vec<Effect> {
        let kind = "orbit";
        let shown = self.lab.as_ref().and_then(|lab| lab.focused_plot());
        if shown.is_some_and(|(_, plot)| plot.kind.name() == kind) {
            return self.add_orbits();
        }
        self.show_picture(kind)
    }

    /// Removes all motions beside the main one.
    pub(super) fn clear_companions(&mut self) -> Vec<Effect> {
        match self.lab.as_ref().and_then(Lab::seen) {
            Some(seen) if seen.companions.is_empty() => {
                self.notify("There are no motions beside the main one.")
            }
            _ => vec![Effect::Execute(Command::ClearCompanions)],
        }
    }
}

fn full() -> String {
    format!("There can be at most {MOST_COMPANIONS} motions beside the main one; C clears them.")
}

impl Lab {
    fn has_room(&self) -> bool {
        self.seen().is_some_and(|seen| seen.companions.len() < MOST_COMPANIONS)
    }

    /// Focuses the picture of a kind, which is added if there is none. Returns whether there is such a kind.
    pub(super) fn show(&mut self, kind: &str) -> bool {
        let Some(kind) = named(kind) else { return false };
        let known = self.plots.iter().position(|plot| plot.kind == kind);
        let index = known.unwrap_or_else(|| {
            let physics = self.loaded.physics();
            let offer = kind.offers(physics).into_iter().next();
            let (columns, view) =
                offer.map_or((Vec::new(), None), |offer| (offer.columns, offer.view));
            self.plots.push(Plot::new(kind, (columns, view), physics.model).opened(physics));
            self.plots.len() - 1
        });
        self.focus.pane = Pane::Plot(index);
        self.answers.stale = true;
        true
    }
}
