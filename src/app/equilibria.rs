//! Equilibria in the lab: the search as a job, the list of what it found, and motions that begin there or along a mode.
//!
//! In: keys, the outcome of the job. Out: effects, a list. Never here: the search.

use std::sync::Arc;

use super::{
    App, Asker, Choice, Choosing, Effect, Item, Lab, Menu, Notification, Overlay, Page, UnderWay,
};
use crate::dynamics::Equilibrium;
use crate::instrument::{
    Answer, FoundEquilibria, classes, described, described_mode, equilibria_search, start_along,
    start_at,
};
use crate::job::{Job, Outcome, Share};

impl App {
    /// Lists the equilibria, searches for them first, or stops searching.
    pub(super) fn find_equilibria(&mut self) -> Vec<Effect> {
        let Some(lab) = &mut self.lab else { return Vec::new() };
        if lab.searches.equilibria.under_way.take().is_some() {
            self.notifications.show(Notification::info("The search for equilibria was stopped."));
            return vec![Effect::StopComputing(Asker::Equilibria)];
        }
        let Some(present) = lab.present() else { return Vec::new() };
        if !present.equilibria.is_empty() {
            return self.list_equilibria();
        }
        let search = equilibria_search(&present);
        let job =
            Job::new("equilibria", move |progress| Answer::new(search(progress).map(Arc::new)));
        let computation = self.jobs.request(Asker::Equilibria, job);
        if let Some(lab) = &mut self.lab {
            lab.searches.equilibria.under_way = Some(UnderWay::new(&computation));
        }
        self.notifications
            .show(Notification::info("Searching for equilibria; F again stops the search."));
        vec![Effect::Compute(computation)]
    }

    /// Takes in what the search has found. Returns `None` if the ticket is not the search's.
    pub(super) fn take_equilibria(
        &mut self,
        ticket: u64,
        outcome: &Outcome<Answer>,
    ) -> Option<Vec<Effect>> {
        let search = &mut self.lab.as_mut()?.searches.equilibria;
        search.under_way.take_if(|job| job.ticket == ticket)?;
        self.notifications.dismiss();
        let found = match outcome {
            Outcome::Cancelled => return Some(Vec::new()),
            Outcome::Failed(sentence) => return Some(self.fail(sentence.clone())),
            Outcome::Done(answer) => answer.of::<Result<Arc<FoundEquilibria>, String>>()?,
        };
        Some(match found {
            Err(why) => self.fail(format!("Equilibria cannot be searched for here: {why}.")),
            Ok(found) if found.found.is_empty() => {
                self.notify("There is no equilibrium near the current state.")
            }
            Ok(found) => {
                search.found = Some(Arc::clone(found));
                if !found.is_complete {
                    self.notify("The search ended after this many equilibria: there may be more.");
                }
                // what is being typed or read is not covered
                if self.overlay.is_none() { self.list_equilibria() } else { Vec::new() }
            }
        })
    }

    pub(super) fn equilibria_progressed(&mut self, ticket: u64, share: Share) {
        let Some(lab) = &mut self.lab else { return };
        let Some(job) = &mut lab.searches.equilibria.under_way else { return };
        job.reach(ticket, share);
        if let Some(status) = job.status() {
            let text = format!("{status} F stops the search.");
            self.notifications.show(Notification::info(text));
        }
    }

    fn list_equilibria(&mut self) -> Vec<Effect> {
        let Some(lab) = &self.lab else { return Vec::new() };
        let Some(present) = lab.present() else { return Vec::new() };
        let mut items = Vec::new();
        for (index, one) in present.equilibria.iter().enumerate() {
            let (label, about) = described(present.physics, one);
            items.push(Item::plain(label, about, Choice::Equilibrium(index)));
            for mode in 0..one.modes.len() {
                let label = format!("  mode {}", described_mode(present.physics, one, mode));
                let about = "start along it".to_owned();
                items.push(Item::plain(label, about, Choice::Mode(index, mode)));
            }
        }
        let periods =
            lab.searches.equilibria.found.as_ref().map_or(&[][..], |found| &found.periods);
        let title = match classes(present.physics, periods) {
            Some(classes) => {
                format!("Equilibria, {classes}: Enter starts there")
            }
            None => "Equilibria: Enter starts there".to_owned(),
        };
        let menu = Menu::new(title, Choosing::Equilibrium, items);
        self.overlay = Some(Overlay::Menu(menu));
        Vec::new()
    }

    /// Begins the motion at an equilibrium, or along one of its modes.
    pub(super) fn begin_at_equilibrium(
        &mut self,
        index: usize,
        mode: Option<usize>,
    ) -> Vec<Effect> {
        if self.page != Page::Lab {
            self.go(Page::Lab);
        }
        let Some(lab) = &mut self.lab else { return Vec::new() };
        let given = lab.present().and_then(|present| {
            let one = present.equilibria.get(index)?;
            Some(match mode {
                None => start_at(present.physics, one),
                Some(mode) => start_along(&present, one, mode),
            })
        });
        given.map_or_else(Vec::new, |given| lab.start(&given))
    }
}

impl Lab {
    pub(super) fn equilibria_at(&self, parameters: &[f64]) -> &[Equilibrium] {
        let found = self.searches.equilibria.found.as_ref();
        let found = found.filter(|found| found.parameters == parameters);
        found.map_or(&[], |found| &found.found)
    }
}
