//! Symmetries of the equations of motion in the lab: the search as a job, the list of what it found, and the flow of one
//! applied to the state.
//!
//! In: keys, the outcome of the job. Out: effects, a list. Never here: the search, or how a flow is followed.

use std::sync::Arc;
use std::time::Duration;

use super::answers::FoundSymmetries;
use super::findings::searched_law;
use super::flow::FlowGenerator;
use super::{App, Asker, Choice, Choosing, Effect, Item, Lab, Menu, Notification, Overlay};
use crate::instrument::Answer;
use crate::integrability::{PointSymmetries, PointSymmetry, changed, point_symmetries, symmetries};
use crate::job::{Job, Outcome, Progress};
use crate::mechanics::Equations;
use crate::model::Model;

/// The time that a search may take.
const BUDGET: Duration = Duration::from_secs(10);

impl FoundSymmetries {
    /// Makes the search: Noether's first, so that they are known for what they are.
    fn search(
        model: Model,
        equations: Equations,
        parameters: Vec<f64>,
        progress: &Progress,
    ) -> Result<FoundSymmetries, String> {
        let (model, mut equations) = searched_law(model, equations, &parameters, progress)?;
        let is_over = || progress.is_cancelled() || progress.is_spent();
        let mut noether = symmetries(&model, &mut equations, &is_over).ok();
        let found = point_symmetries(&model, &mut equations, noether.as_mut(), &is_over);
        let PointSymmetries { found, unwritten, unfinished, .. } =
            found.map_err(|why| why.to_string())?;
        let missing = unwritten + unfinished;
        Ok(FoundSymmetries { model, equations, parameters, found, missing })
    }
}

impl Lab {
    /// Whether symmetries of its equations can be searched: accelerations that no constraint acts on.
    pub(super) fn may_have_symmetries(&self) -> bool {
        let model = &self.loaded.model;
        model.constraints.is_empty() && !model.is_poisson()
    }

    /// The symmetries that were found at the parameters' present values.
    fn found_symmetries(&self) -> Option<&Arc<FoundSymmetries>> {
        let now = self.seen()?;
        self.searches
            .symmetries
            .found
            .as_ref()
            .filter(|found| found.parameters[..] == now.parameters[..])
    }
}

impl App {
    /// Lists the symmetries, or searches for them first.
    pub(super) fn find_symmetries(&mut self) -> Vec<Effect> {
        let Some(lab) = &self.lab else { return Vec::new() };
        if lab.found_symmetries().is_some() {
            return self.list_symmetries();
        }
        let Some(snapshot) = lab.seen() else { return Vec::new() };
        let parameters = snapshot.parameters.to_vec();
        let (model, equations) = (Arc::clone(&lab.loaded.model), Arc::clone(&lab.loaded.equations));
        let job = Job::new("symmetries", move |progress| {
            let (model, equations) = ((*model).clone(), (*equations).clone());
            let found = FoundSymmetries::search(model, equations, parameters.clone(), progress);
            Answer::new(found.map(Arc::new))
        })
        .within(BUDGET);
        let computation = self.jobs.request(Asker::Symmetries, job);
        if let Some(lab) = &mut self.lab {
            lab.searches.symmetries.awaited = Some(computation.ticket);
        }
        self.notifications
            .show(Notification::info("Searching for symmetries of the equations of motion."));
        vec![Effect::Compute(computation)]
    }

    /// Takes in what the search has found. Returns `None` if the ticket is not the search's.
    pub(super) fn take_symmetries(
        &mut self,
        ticket: u64,
        outcome: &Outcome<Answer>,
    ) -> Option<Vec<Effect>> {
        let search = &mut self.lab.as_mut()?.searches.symmetries;
        search.awaited.take_if(|awaited| *awaited == ticket)?;
        self.notifications.dismiss();
        let found = match outcome {
            Outcome::Cancelled => return Some(Vec::new()),
            Outcome::Failed(sentence) => return Some(self.fail(sentence.clone())),
            Outcome::Done(answer) => answer.of::<Result<Arc<FoundSymmetries>, String>>()?,
        };
        Some(match found {
            Err(why) => self.fail(format!("Symmetries cannot be searched for here: {why}.")),
            Ok(found) if found.found.is_empty() && found.missing == 0 => {
                self.notify("The equations of motion have no symmetry among those searched.")
            }
            Ok(found) if found.found.is_empty() => self.notify(
                "The equations of motion have symmetries, but none that could be written down in the time of a search.",
            ),
            Ok(found) => {
                search.found = Some(Arc::clone(found));
                // what is being typed or read is not covered
                if self.overlay.is_none() { self.list_symmetries() } else { Vec::new() }
            }
        })
    }

    fn list_symmetries(&mut self) -> Vec<Effect> {
        let Some(found) = self.lab.as_ref().and_then(Lab::found_symmetries) else {
            return Vec::new();
        };
        let item = |(index, symmetry): (usize, &PointSymmetry)| {
            Item::plain(
                symmetry.name.clone(),
                changes(&found.equations, symmetry),
                Choice::Symmetry(index),
            )
        };
        let items = found.found.iter().enumerate().map(item).collect();
        let title = "Carry the state along the flow of a symmetry";
        let title = match found.missing {
            0 => title.to_owned(),
            missing => format!("{title} ({missing} more could not be written down)"),
        };
        self.overlay = Some(Overlay::Menu(Menu::new(title, Choosing::Flow, items)));
        Vec::new()
    }

    pub(super) fn follow_symmetry(&mut self, index: usize, epsilon: f64) -> Vec<Effect> {
        let Some(found) = self.lab.as_ref().and_then(Lab::found_symmetries) else {
            return Vec::new();
        };
        let Some(symmetry) = found.found.get(index) else { return Vec::new() };
        let generator = FlowGenerator::Symmetry(symmetry.time, symmetry.coordinates.clone());
        let law = (found.model.clone(), found.equations.clone());
        self.follow(generator, law, epsilon)
    }
}

/// What a symmetry changes: `t by 3 t, x by 2 x`.
fn changes(equations: &Equations, symmetry: &PointSymmetry) -> String {
    let pool = &equations.pool;
    let all = changed(equations, symmetry.time, &symmetry.coordinates);
    let all = all
        .map(|(symbol, e)| format!("{} by {}", pool.symbol_info(symbol).unicode, pool.unicode(e)));
    all.collect::<Vec<_>>().join(", ")
}
