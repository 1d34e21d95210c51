//! Background jobs: those requested, those under way, and their results.
//!
//! In: what instruments and the prompt need. Out: [`Effect::Compute`], and the stored results. A result that is no
//! longer wanted is dropped, because its ticket is unknown. Never here: threads, or what is computed.

use std::sync::Arc;

use super::answers::{Answers, PlotJob};
use super::computation::Jobs;
use super::{App, AppEvent, Asker, Computation, Effect, Lab, Overlay, Page, Pane, UnderWay};
use crate::experiment::Command;
use crate::instrument::{Answer, Need, Plot, PlotContext, PlotTable, Present};
use crate::job::{Job, Outcome, Progress, Share};
use crate::mechanics::Equations;

/// A picture is computed in so many parts at most, where there is no background.
const PARTS: usize = 1024;

impl Lab {
    /// Returns the result computed for a plot.
    pub fn answer(&self, plot: &Plot) -> Option<&Answer> {
        self.answers.of(plot)?.answer.as_ref()
    }

    /// Returns what a plot is drawn from.
    pub fn context<'a>(&'a self, plot: &'a Plot, present: &'a Present<'a>) -> PlotContext<'a> {
        PlotContext { plot, present, answer: self.answer(plot) }
    }

    /// Returns the kind of the focused plot and what its job has computed, where that is a table.
    pub fn focused_table(&self) -> Option<(&'static str, PlotTable)> {
        let (_, plot) = self.focused_plot()?;
        let table = plot.kind.table(self.context(plot, &self.present()?))?;
        Some((plot.kind.name(), table))
    }

    /// Returns the job under way for a plot.
    pub fn under_way(&self, plot: &Plot) -> Option<&UnderWay> {
        self.answers.of(plot)?.under_way.as_ref()
    }

    /// Whether the values of the motion have not changed for a while.
    fn rests(&mut self) -> bool {
        let Some(present) = self.present() else { return false };
        let values = [present.parameters, present.initial].concat();
        self.answers.rest(values.into_iter())
    }

    /// Returns the jobs that plots need and that are not yet under way.
    fn needs(&mut self, jobs: &mut Jobs, rests: bool) -> Vec<Computation> {
        let mut waits = false;
        let mut entries = Vec::new();
        let mut wanted: Vec<Computation> = Vec::new();
        for (place, plot) in self.plots.iter().enumerate() {
            let Some(present) = self.present() else { return Vec::new() };
            let is_drawn = self.drawn.in_view.has(Pane::Plot(place));
            let entry = self.answers.of(plot);
            if entries.iter().any(|entry: &PlotJob| entry.is_of(plot)) {
                continue;
            }
            if let Some(entry) = entry.filter(|entry| entry.under_way.is_some()) {
                entries.push(PlotJob { is_drawn, ..entry.clone() });
                continue;
            }
            let answer = entry.and_then(|entry| entry.answer.clone());
            let under_way = match plot.kind.job(PlotContext {
                plot,
                present: &present,
                answer: answer.as_ref(),
            }) {
                Need::Nothing => continue,
                Need::Addition(_) if !jobs.in_background || !is_drawn => None,
                Need::WhileDrawn(_) if !is_drawn => None,
                Need::Valid => None,
                Need::AtRest(_) if !rests || !is_drawn => {
                    waits |= is_drawn;
                    None
                }
                Need::Job(job)
                | Need::AtRest(job)
                | Need::WhileDrawn(job)
                | Need::Addition(job) => {
                    let computation = jobs.request(Asker::Plot(place), job);
                    let under_way = UnderWay::new(&computation);
                    wanted.push(computation);
                    Some(under_way)
                }
            };
            let &Plot { kind, view, .. } = plot;
            let (columns, over) = (plot.columns.clone(), plot.over.clone());
            entries.push(PlotJob { kind, columns, view, over, answer, under_way, is_drawn });
        }
        self.answers.replace(entries);
        self.answers.waits = waits;
        wanted
    }
}

impl Lab {
    /// Returns the job that finds the closed forms of the equations, once for each system that came without them. The
    /// motion runs meanwhile, because it does not need them.
    fn ask_for_closed_forms(&mut self, jobs: &mut Jobs) -> Option<Computation> {
        let equations = &self.loaded.equations;
        if !equations.has_pending_forms() || self.derivations.closed_forms.is_some() {
            return None;
        }
        let equations = Arc::clone(equations);
        let job = Job::new("closed forms", move |progress| {
            let mut equations = Equations::clone(&equations);
            equations.pool.set_cancel(progress.token().clone());
            equations.find_closed_forms();
            Answer::new(Arc::new(equations))
        });
        let computation = jobs.request(Asker::Equations, job);
        self.derivations.closed_forms = Some(computation.ticket);
        Some(computation)
    }

    /// Takes in the equations with their closed forms. Returns whether they were wanted.
    fn take_closed_forms(&mut self, ticket: u64, outcome: &Outcome<Answer>) -> bool {
        if self.derivations.closed_forms != Some(ticket) {
            return false;
        }
        if let Outcome::Done(answer) = outcome
            && let Some(equations) = answer.of::<Arc<Equations>>()
        {
            self.loaded.equations = Arc::clone(equations);
        }
        true
    }
}

impl App {
    /// Requests the jobs that the pictures need now, or runs them at once if there is no background.
    pub(super) fn request_jobs(&mut self, effects: &mut Vec<Effect>) {
        let Some(lab) = &mut self.lab else { return };
        // Keys that change no picture cost nothing here.
        let stale = std::mem::take(&mut lab.answers.stale) | std::mem::take(&mut lab.answers.waits);
        // in the background a job that is no longer wanted is stopped
        let rests = self.jobs.in_background || stale && lab.rests();
        let wanted = if stale { lab.needs(&mut self.jobs, rests) } else { Vec::new() };
        effects.extend(wanted.into_iter().map(Effect::Compute));
        effects.extend(lab.ask_for_closed_forms(&mut self.jobs).map(Effect::Compute));
        if self.page == Page::Equations {
            effects.extend(lab.ask_for_further(&mut self.jobs).map(Effect::Compute));
        }
        self.request_search(effects);
        if self.jobs.in_background {
            return;
        }
        for _ in 0..PARTS {
            self.run_jobs(effects);
            let Some(lab) = self.lab.as_mut().filter(|lab| lab.answers.stale) else { return };
            lab.answers.stale = false;
            effects.extend(lab.needs(&mut self.jobs, rests).into_iter().map(Effect::Compute));
        }
    }

    /// Runs the requested jobs at once.
    fn run_jobs(&mut self, effects: &mut Vec<Effect>) {
        let (jobs, rest) = std::mem::take(effects)
            .into_iter()
            .partition(|effect| matches!(effect, Effect::Compute(_) | Effect::StopComputing(_)));
        *effects = rest;
        let jobs: Vec<Effect> = jobs;
        for effect in jobs {
            if let Effect::Compute(Computation { ticket, job, .. }) = effect {
                let outcome = job.run(&Progress::new());
                effects.extend(self.handle(AppEvent::Computed { ticket, outcome }));
            }
        }
    }

    /// Handles the outcome of a job. An outcome that is no longer wanted is dropped.
    pub(super) fn computed(&mut self, ticket: u64, outcome: Outcome<Answer>) -> Vec<Effect> {
        if let Some(found) = self.lab.as_mut().and_then(|lab| lab.take_search(ticket, &outcome)) {
            self.renew_flows();
            return match outcome {
                Outcome::Failed(sentence) => self.fail(sentence),
                _ => {
                    found.into_iter().map(|found| Effect::Execute(Command::Follow(found))).collect()
                }
            };
        }
        if let Some(effects) = self.carried(ticket, &outcome) {
            return effects;
        }
        if let Some(effects) = self.take_equilibria(ticket, &outcome) {
            return effects;
        }
        if let Some(effects) = self.take_symmetries(ticket, &outcome) {
            return effects;
        }
        let lab = self.lab.as_mut();
        let waited = match &mut self.overlay {
            Some(Overlay::Prompt(prompt)) if prompt.awaits(ticket) => {
                prompt.take(&outcome);
                true
            }
            _ => lab.is_some_and(|lab| {
                lab.answers.take(ticket, &outcome)
                    || lab.take_closed_forms(ticket, &outcome)
                    || lab.take_further(ticket, &outcome)
            }),
        };
        match outcome {
            Outcome::Failed(sentence) if waited => self.fail(sentence),
            _ => Vec::new(),
        }
    }

    pub(super) fn progressed(&mut self, ticket: u64, share: Share) {
        self.equilibria_progressed(ticket, share);
        let answers = self.lab.as_mut().map(|lab| &mut lab.answers);
        answers
            .into_iter()
            .flat_map(Answers::all_under_way)
            .for_each(|job| job.reach(ticket, share));
        if let Some(Overlay::Prompt(prompt)) = &mut self.overlay {
            prompt.under_way.iter_mut().for_each(|(_, job)| job.reach(ticket, share));
        }
    }
}
