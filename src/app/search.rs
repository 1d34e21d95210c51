//! The search for constants of the motion in the lab: asked for by the page of equations, made in the background, and
//! its results followed by gauges.
//!
//! In: the loaded system, the parameters' values, the outcome of a job. Out: a job, the results, commands. Never here:
//! the search itself, or what the results look like.

use std::sync::Arc;
use std::time::Duration;

use super::computation::{Asker, Computation, Jobs};
use super::findings::{Findings, SearchUnderWay, followed, search};
use super::{App, Effect, EquationsSection, Lab, Page};
use crate::experiment::{Command, FoundConstant};
use crate::expr::Expr;
use crate::instrument::Answer;
use crate::integrability::Proof;
use crate::job::{Job, Outcome};

/// The time of the first search; each further one takes four times as long.
const BUDGET: Duration = Duration::from_secs(1);

/// The furthest that one can ask for.
const MOST: u32 = 3;

impl Lab {
    pub(super) fn wants_search(&mut self, jobs: &mut Jobs) -> Option<Computation> {
        let parameters = self.seen()?.parameters.to_vec();
        let search_state = &mut self.searches.constants;
        let known = search_state.outcome.as_ref().is_some_and(|(at, _)| *at == parameters);
        if known || search_state.under_way.is_some() || search_state.stopped {
            return None;
        }
        let in_background = jobs.in_background;
        let (model, equations) =
            (Arc::clone(&self.loaded.model), Arc::clone(&self.loaded.equations));
        let (further, at) = (search_state.further, parameters.clone());
        let job = Job::new("searching for constants of the motion", move |progress| {
            let (model, equations) = ((*model).clone(), (*equations).clone());
            Answer::new(search(model, equations, &at, further, progress, in_background))
        })
        .within(BUDGET * 4_u32.pow(further));
        let computation = jobs.request(Asker::Search, job);
        let ticket = computation.ticket;
        search_state.under_way =
            Some(SearchUnderWay { ticket, at: parameters, since: Duration::ZERO });
        Some(computation)
    }

    /// Takes in the outcome of the search, if it is wanted. Returns what gauges are to follow, if that
    /// changes.
    pub(super) fn take_search(
        &mut self,
        ticket: u64,
        outcome: &Outcome<Answer>,
    ) -> Option<Vec<Vec<FoundConstant>>> {
        let SearchUnderWay { at, .. } =
            self.searches.constants.under_way.take_if(|job| job.ticket == ticket)?;
        let Outcome::Done(answer) = outcome else {
            self.searches.constants.stopped = true;
            return Some(Vec::new());
        };
        let result = answer.of::<Result<Arc<Findings>, String>>()?.clone();
        let found = result.as_ref().map(|findings| followed(findings)).unwrap_or_default();
        self.searches.constants.outcome = Some((at, result));
        let before = std::mem::replace(&mut self.searches.constants.followed, !found.is_empty());
        let changes = before || !found.is_empty();
        Some(changes.then_some(found).into_iter().collect())
    }

    /// What was found for the parameters as they are now.
    pub fn findings(&self) -> Option<Result<&Findings, &str>> {
        let (at, result) = self.searches.constants.outcome.as_ref()?;
        let now = self.seen()?;
        (now.parameters[..] == at[..])
            .then(|| result.as_ref().map(|findings| &**findings).map_err(String::as_str))
    }

    /// The gauges that are to follow once the parameters have changed: what was proved for all their values.
    pub(super) fn forget_search(&mut self) -> Option<Vec<FoundConstant>> {
        let (at, result) = self.searches.constants.outcome.as_ref()?;
        if self.seen()?.parameters[..] == at[..] {
            return None;
        }
        let proved: Vec<FoundConstant> = result.as_ref().map_or_else(
            |_| Vec::new(),
            |findings| {
                let all = followed(findings).into_iter().zip(&findings.invariants.found);
                all.filter(|(_, c)| c.proof == Proof::Proved)
                    .map(|(constant, _)| constant)
                    .collect()
            },
        );
        self.searches.constants.outcome = None;
        self.searches.constants.stopped = false;
        std::mem::take(&mut self.searches.constants.followed).then_some(proved)
    }

    /// Every constant that has a flow, by its name.
    pub fn flows(&self) -> Vec<(String, Expr)> {
        let Some(Ok(findings)) = self.findings() else { return Vec::new() };
        if !findings.hamiltonian {
            return Vec::new();
        }
        let known = findings.invariants.known.iter().map(|k| k.expression);
        let all = known.chain(findings.invariants.found.iter().map(|c| c.expression));
        findings.names.iter().cloned().zip(all).collect()
    }
}

impl App {
    /// The search that the page shown needs, and the gauges that no longer hold.
    pub(super) fn request_search(&mut self, effects: &mut Vec<Effect>) {
        let shown = self.page == Page::Equations;
        let Some(lab) = &mut self.lab else { return };
        if let Some(proved) = lab.forget_search() {
            effects.push(Effect::Execute(Command::Follow(proved)));
        }
        if shown {
            effects.extend(lab.wants_search(&mut self.jobs).map(Effect::Compute));
        }
    }

    /// Searches further than before: to a higher degree, and for a longer time.
    pub(super) fn search_further(&mut self) -> Vec<Effect> {
        let Some(lab) = &mut self.lab else { return Vec::new() };
        if lab.searches.constants.under_way.is_some() {
            return self.notify("A search is running; Esc stops it.");
        }
        let fresh = self.page != Page::Equations && lab.findings().is_none();
        if !fresh && lab.searches.constants.outcome.is_some() {
            if lab.searches.constants.further == MOST {
                return self.notify("phaselab invariants --degree searches further than this.");
            }
            lab.searches.constants.further += 1;
            lab.searches.constants.outcome = None;
        }
        lab.searches.constants.stopped = false;
        if self.page != Page::Equations {
            self.go(Page::Equations);
        }
        self.text.section = Some(EquationsSection::Constants);
        Vec::new()
    }

    /// Opens or closes the table of brackets.
    pub(super) fn show_brackets(&mut self) -> Vec<Effect> {
        let Some(lab) = &mut self.lab else { return Vec::new() };
        lab.searches.constants.brackets = !lab.searches.constants.brackets;
        if self.page != Page::Equations {
            if let Some(lab) = &mut self.lab {
                lab.searches.constants.brackets = true;
            }
            self.go(Page::Equations);
        }
        let is_open = self.lab.as_ref().is_some_and(|lab| lab.searches.constants.brackets);
        self.text.section = is_open.then_some(EquationsSection::Brackets);
        Vec::new()
    }

    /// Ends the search under way. Returns whether there was one.
    pub(super) fn stop_search(&mut self) -> bool {
        let Some(lab) = &mut self.lab else { return false };
        let was = lab.searches.constants.under_way.take().is_some();
        lab.searches.constants.stopped |= was;
        was
    }
}
