//! The search for constants of the motion in the lab: asked for by the page of equations, made in the background, and
//! its results followed by gauges.
//!
//! In: the loaded system, the parameters' values, the outcome of a job. Out: a job, the results, commands. Never here:
//! the search itself, or what the results look like.

use std::cell::Cell;
use std::sync::Arc;
use std::time::Duration;

use super::side::{Asker, Computation, UnderWay};
use super::{App, Effect, Lab, Page};
use crate::experiment::{Command, FoundConstant};
use crate::expr::Expr;
use crate::instrument::Answer;
use crate::integrability::{
    Invariants, Limits, Proof, Relations, invariants, is_hamiltonian, relations, separates, summary,
};
use crate::job::{Job, Outcome, Progress};
use crate::mechanics::Equations;

/// The time of the first search; each further one takes four times as long.
const BUDGET: Duration = Duration::from_secs(1);

/// The greatest degree of the first search; each further one goes two beyond.
const DEGREE: u32 = 6;

/// Where there is no clock: how often the first search may ask whether it has to end.
const QUESTIONS: u64 = 1_500;

/// The greatest degree of the first search where there is no clock.
const DEGREE_WITHOUT_CLOCK: u32 = 4;

/// The furthest that one can ask for.
const MOST: u32 = 3;

/// What a search found, with everything that is said of it.
#[derive(Clone, Debug)]
pub struct Findings {
    /// The equations, in which the formulas stand.
    pub equations: Equations,
    /// The constants of the motion, and what was searched.
    pub invariants: Invariants,
    /// Their brackets, and the verdict.
    pub relations: Relations,
    /// The verdict in a line.
    pub summary: String,
    /// Whether Hamilton–Jacobi separates in the file's coordinates, where that is a question.
    pub separates: Option<bool>,
    /// Whether nothing but H acts, so that constants have brackets and flows.
    pub hamiltonian: bool,
    /// The names of all constants as shown, known first.
    pub names: Vec<String>,
}

/// The search of a lab.
#[derive(Clone, Debug, Default)]
pub struct Search {
    /// What was found, or why no search is made; for the parameters' values at that time.
    pub outcome: Option<(Vec<f64>, Result<Arc<Findings>, String>)>,
    /// Whether the table of brackets is open.
    pub brackets: bool,
    under_way: Option<(UnderWay, Vec<f64>)>,
    /// How often more was asked for.
    further: u32,
    /// Whether the last one was stopped by a person.
    stopped: bool,
    /// Whether gauges follow what was found.
    followed: bool,
}

impl Search {
    /// The name and progress of a search that has taken a while.
    pub fn status(&self) -> Option<String> {
        self.under_way.as_ref().and_then(|(job, _)| job.status())
    }

    /// Whether a search is being made.
    pub fn is_under_way(&self) -> bool {
        self.under_way.is_some()
    }

    /// Whether a person stopped the last one.
    pub fn was_stopped(&self) -> bool {
        self.stopped
    }

    pub(super) fn tick(&mut self, elapsed: Duration) {
        if let Some((job, _)) = &mut self.under_way {
            job.tick(elapsed);
        }
    }

    pub(super) fn reach(&mut self, ticket: u64, share: crate::job::Share) {
        if let Some((job, _)) = &mut self.under_way {
            job.reach(ticket, share);
        }
    }
}

/// The gauges for what was found: of what holds between impulses too, since their jumps are no drift.
fn followed(findings: &Findings) -> Vec<FoundConstant> {
    let known = findings.invariants.known.len();
    let pool = &findings.equations.pool;
    let found = findings.invariants.found.iter().enumerate();
    found
        .map(|(i, constant)| {
            let proof = match constant.proof {
                Proof::Proved => "proved",
                Proof::AtTheseParameters => "proved at these parameters",
                Proof::Unproved => "not proved",
            };
            let between = if constant.between_impulses { ", between impulses" } else { "" };
            FoundConstant {
                name: format!("I{}", i + 1),
                shown: findings.names[known + i].clone(),
                expression: pool.text(constant.expression),
                reason: format!("found at degree {}, {proof}{between}", constant.degree),
                proved: constant.proof != Proof::Unproved,
            }
        })
        .collect()
}

fn subscript(n: usize) -> String {
    let digit = |c: char| char::from_u32(0x2080 + c.to_digit(10).unwrap_or(0)).unwrap_or(c);
    n.to_string().chars().map(digit).collect()
}

/// Makes the search.
fn search(
    mut model: crate::model::Model,
    mut equations: Equations,
    parameters: &[f64],
    further: u32,
    progress: &Progress,
    has_clock: bool,
) -> Result<Arc<Findings>, String> {
    model.parameters.iter_mut().zip(parameters).for_each(|(p, &value)| p.value = value);
    equations.pool.set_cancel(progress.token().clone());
    if equations.has_pending_forms() {
        equations.find_closed_forms();
    }
    let first = if has_clock { DEGREE } else { DEGREE_WITHOUT_CLOCK };
    let asked = Cell::new(0_u64);
    let questions = QUESTIONS << (2 * further);
    let is_over = || {
        asked.set(asked.get() + 1);
        progress.is_cancelled() || progress.is_spent() || !has_clock && asked.get() > questions
    };
    let limits = Limits { degree: Some(first + 2 * further), is_over: &is_over };
    let invariants = invariants(&model, &mut equations, &limits).map_err(|why| why.to_string())?;
    let hamiltonian = is_hamiltonian(&model, &mut equations);
    let relations = relations(&model, &mut equations, &invariants, hamiltonian);
    let separates = separates(&model, &mut equations);
    let summary = summary(&invariants, &relations);
    let known = invariants.known.iter().map(|k| match k.name.as_str() {
        "energy" => "E".to_owned(),
        name => crate::expr::unicode_name(name).to_string(),
    });
    let found = (1..=invariants.found.len()).map(|n| format!("I{}", subscript(n)));
    let names = known.chain(found).collect();
    Ok(Arc::new(Findings {
        equations,
        invariants,
        relations,
        summary,
        separates,
        hamiltonian,
        names,
    }))
}

impl Lab {
    /// The job of a search that is wanted now.
    pub(super) fn wants_search(&mut self, tickets: &mut u64, aside: bool) -> Option<Computation> {
        let parameters = self.seen()?.parameters.to_vec();
        let search_state = &mut self.search;
        let known = search_state.outcome.as_ref().is_some_and(|(at, _)| *at == parameters);
        if known || search_state.under_way.is_some() || search_state.stopped {
            return None;
        }
        *tickets += 1;
        let (model, equations) =
            (Arc::clone(&self.loaded.model), Arc::clone(&self.loaded.equations));
        let (further, at) = (search_state.further, parameters.clone());
        let job = Job::new("searching for constants of the motion", move |progress| {
            let (model, equations) = ((*model).clone(), (*equations).clone());
            Answer::new(search(model, equations, &at, further, progress, aside))
        })
        .within(BUDGET * 4_u32.pow(further));
        let computation = Computation { ticket: *tickets, asker: Asker::Search, job };
        search_state.under_way = Some((UnderWay::new(&computation), parameters));
        Some(computation)
    }

    /// Takes in the outcome of the search, if it is wanted. Returns what gauges are to follow if that changes.
    pub(super) fn take_search(
        &mut self,
        ticket: u64,
        outcome: &Outcome<Answer>,
    ) -> Option<Option<Vec<FoundConstant>>> {
        let (_, at) = self.search.under_way.take_if(|(job, _)| job.ticket == ticket)?;
        let Outcome::Done(answer) = outcome else {
            self.search.stopped = true;
            return Some(None);
        };
        let result = answer.of::<Result<Arc<Findings>, String>>()?.clone();
        let found = result.as_ref().map(|findings| followed(findings)).unwrap_or_default();
        self.search.outcome = Some((at, result));
        let before = std::mem::replace(&mut self.search.followed, !found.is_empty());
        Some((before || !found.is_empty()).then_some(found))
    }

    /// What was found for the parameters as they are now.
    pub fn findings(&self) -> Option<Result<&Findings, &str>> {
        let (at, result) = self.search.outcome.as_ref()?;
        let now = self.seen()?;
        (now.parameters[..] == at[..])
            .then(|| result.as_ref().map(|findings| &**findings).map_err(String::as_str))
    }

    /// The gauges that are to follow once the parameters have changed: what was proved for all their values.
    pub(super) fn forget_search(&mut self) -> Option<Vec<FoundConstant>> {
        let (at, result) = self.search.outcome.as_ref()?;
        if self.seen()?.parameters[..] == at[..] {
            return None;
        }
        let kept: Vec<FoundConstant> = result.as_ref().map_or_else(
            |_| Vec::new(),
            |findings| {
                let all = followed(findings).into_iter().zip(&findings.invariants.found);
                all.filter(|(_, c)| c.proof == Proof::Proved).map(|(kept, _)| kept).collect()
            },
        );
        self.search.outcome = None;
        self.search.stopped = false;
        std::mem::take(&mut self.search.followed).then_some(kept)
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
    pub(super) fn look_after_search(&mut self, effects: &mut Vec<Effect>) {
        let (aside, shown) = (self.aside, self.page == Page::Equations);
        let Some(lab) = &mut self.lab else { return };
        if let Some(kept) = lab.forget_search() {
            effects.push(Effect::Tell(Command::Follow(kept)));
        }
        if shown {
            effects.extend(lab.wants_search(&mut self.jobs, aside).map(Effect::Compute));
        }
    }

    /// Searches further than before: to a higher degree, and for a longer time.
    pub(super) fn search_further(&mut self) -> Vec<Effect> {
        let Some(lab) = &mut self.lab else { return Vec::new() };
        if lab.search.under_way.is_some() {
            return self.notify("A search is being made; Esc ends it.");
        }
        let fresh = self.page != Page::Equations && lab.findings().is_none();
        if !fresh && lab.search.outcome.is_some() {
            if lab.search.further == MOST {
                return self.notify("phaselab invariants --degree searches further than this.");
            }
            lab.search.further += 1;
            lab.search.outcome = None;
        }
        lab.search.stopped = false;
        if self.page != Page::Equations {
            self.go(Page::Equations);
        }
        Vec::new()
    }

    /// Opens or closes the table of brackets.
    pub(super) fn show_brackets(&mut self) -> Vec<Effect> {
        let Some(lab) = &mut self.lab else { return Vec::new() };
        lab.search.brackets = !lab.search.brackets;
        if self.page != Page::Equations {
            if let Some(lab) = &mut self.lab {
                lab.search.brackets = true;
            }
            self.go(Page::Equations);
        }
        Vec::new()
    }

    /// Ends the search under way. Returns whether there was one.
    pub(super) fn stop_search(&mut self) -> bool {
        let Some(lab) = &mut self.lab else { return false };
        let was = lab.search.under_way.take().is_some();
        lab.search.stopped |= was;
        was
    }
}
