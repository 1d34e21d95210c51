//! What of the equations takes longer to find and is shown on their page: transformations with K and their generating functions,
//! generators, the complete integral. Asked for once, when the page of equations is first shown.
//!
//! In: the equations of the lab. Out: a job, and what it found. Never here: how any of it is written.

use std::sync::Arc;

use super::answers::FurtherForms;
use super::computation::Jobs;
use super::{Asker, Computation, Lab};
use crate::instrument::Answer;
use crate::job::{Job, Outcome};
use crate::mechanics::{Equations, Further};

impl Lab {
    /// What was found of transformations, generators and the complete integral, once it is there.
    pub fn further(&self) -> Option<&FurtherForms> {
        self.derivations.further.as_deref()
    }

    /// Whether the file has any of them.
    pub fn has_further(&self) -> bool {
        let model = &self.loaded.model;
        !model.transformations.is_empty()
            || !model.generators.is_empty()
            || model.complete_integral.is_some()
    }

    /// The job that finds them, once for each system, after the closed forms of its equations.
    pub(super) fn ask_for_further(&mut self, jobs: &mut Jobs) -> Option<Computation> {
        let equations = &self.loaded.equations;
        let waits = equations.has_pending_forms();
        if waits || self.derivations.further_job.is_some() || !self.has_further() {
            return None;
        }
        let (model, equations) = (Arc::clone(&self.loaded.model), Arc::clone(equations));
        let job = Job::new("transformations", move |progress| {
            let mut equations = Equations::clone(&equations);
            equations.pool.set_cancel(progress.token().clone());
            let further = Further::of(&model, &mut equations);
            Answer::new(Arc::new(FurtherForms { equations, further }))
        });
        let computation = jobs.request(Asker::Equations, job);
        self.derivations.further_job = Some(computation.ticket);
        Some(computation)
    }

    /// Takes in what was found. Returns whether it was wanted.
    pub(super) fn take_further(&mut self, ticket: u64, outcome: &Outcome<Answer>) -> bool {
        if self.derivations.further_job != Some(ticket) {
            return false;
        }
        if let Outcome::Done(answer) = outcome
            && let Some(found) = answer.of::<Arc<FurtherForms>>()
        {
            self.derivations.further = Some(Arc::clone(found));
        }
        true
    }
}
