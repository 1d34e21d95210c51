//! What a search for constants of the motion found in the lab, and the search itself.
//!
//! In: a model, its equations, the parameters' values. Out: [`Findings`] and the gauges that follow them. Never here: when
//! it is made, or what it looks like.

use std::cell::Cell;
use std::sync::Arc;
use std::time::Duration;

use super::computation::NOTICE_DELAY;
use crate::experiment::FoundConstant;
use crate::expr::unicode_name;
use crate::integrability::{
    Invariants, Limits, Proof, Relations, found_names, invariants, is_hamiltonian, relations,
    separates, summary,
};
use crate::job::Progress;
use crate::mechanics::{Equations, derive};
use crate::model::Model;

/// The greatest degree of the first search; each further one goes two beyond.
const DEGREE: u32 = 6;

/// Where there is no clock: how often the first search may ask whether it has to end.
const QUESTIONS: u64 = 1_500;

/// The greatest degree of the first search where there is no clock.
const DEGREE_WITHOUT_CLOCK: u32 = 4;

/// What a search found, with everything that is said of it.
#[derive(Clone, Debug)]
pub struct Findings {
    /// The system with its numbers that are no short fractions as parameters.
    pub(super) model: Model,
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
    found_names: Vec<String>,
}

/// The search of a lab.
#[derive(Clone, Debug, Default)]
pub struct InvariantSearch {
    /// What was found, or why no search is made; for the parameters' values at that time.
    pub outcome: Option<(Vec<f64>, Result<Arc<Findings>, String>)>,
    /// Whether the table of brackets is open.
    pub brackets: bool,
    pub(super) under_way: Option<SearchUnderWay>,
    /// How often more was asked for.
    pub(super) further: u32,
    /// Whether the last one was stopped by a person.
    pub(super) stopped: bool,
    /// Whether gauges follow what was found.
    pub(super) followed: bool,
}

/// A search that has not ended.
#[derive(Clone, Debug)]
pub(super) struct SearchUnderWay {
    pub(super) ticket: u64,
    /// The parameters' values for which it is made.
    pub(super) at: Vec<f64>,
    pub(super) since: Duration,
}

impl InvariantSearch {
    /// What is shown of a search that has taken a while.
    pub fn status(&self) -> Option<String> {
        let job = self.under_way.as_ref().filter(|job| job.since >= NOTICE_DELAY)?;
        Some(format!("Searching for constants of the motion, {} s …", job.since.as_secs()))
    }

    /// Whether a person stopped the last one.
    pub fn was_stopped(&self) -> bool {
        self.stopped
    }

    pub(super) fn tick(&mut self, elapsed: Duration) {
        if let Some(job) = &mut self.under_way {
            job.since = job.since.saturating_add(elapsed);
        }
    }
}

/// The gauges for what was found: of what holds between impulses too, since their jumps are no drift.
pub(super) fn followed(findings: &Findings) -> Vec<FoundConstant> {
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
                name: findings.found_names[i].clone(),
                shown: findings.names[known + i].clone(),
                expression: pool.text(constant.expression),
                reason: format!("found at degree {}, {proof}{between}", constant.degree),
                proved: constant.proof != Proof::Unproved,
            }
        })
        .collect()
}

/// The law that is searched: at these values of the parameters, with numbers that are no short fractions as parameters
/// too, because products of them are rounded and relations between these would be lost.
pub(super) fn searched_law(
    mut model: Model,
    equations: Equations,
    parameters: &[f64],
    progress: &Progress,
) -> Result<(Model, Equations), String> {
    model.parameters.iter_mut().zip(parameters).for_each(|(p, &value)| p.value = value);
    let mut equations = equations;
    if model.name_literals() {
        model.pool.set_cancel(progress.token().clone());
        equations = derive(&model).map_err(|why| why.to_string())?;
    }
    equations.pool.set_cancel(progress.token().clone());
    if equations.has_pending_forms() {
        equations.find_closed_forms();
    }
    Ok((model, equations))
}

pub(super) fn search(
    model: Model,
    equations: Equations,
    parameters: &[f64],
    further: u32,
    progress: &Progress,
    has_clock: bool,
) -> Result<Arc<Findings>, String> {
    let (model, mut equations) = searched_law(model, equations, parameters, progress)?;
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
        name => unicode_name(name),
    });
    let count = invariants.found.len();
    let found_names = found_names(&model, &equations.pool, &invariants.known, count);
    let names = known.chain(found_names.iter().map(|name| unicode_name(name))).collect();
    Ok(Arc::new(Findings {
        model,
        equations,
        invariants,
        relations,
        summary,
        separates,
        hamiltonian,
        names,
        found_names,
    }))
}
