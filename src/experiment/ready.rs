//! All the stages in one go: from a document to an experiment that is ready to begin.
//!
//! In: a [`Document`]. Out: what each stage made of it. Never here: the stages themselves.

use std::fmt::Display;
use std::sync::Arc;

use super::{Experiment, Setup};
use crate::analysis::flaws;
use crate::mechanics::{self, Equations};
use crate::model::Model;
use crate::preset::Document;
use crate::system::System;

/// A system on all its stages.
pub struct Ready {
    /// The file's text.
    pub document: Arc<Document>,
    /// What the file says.
    pub model: Arc<Model>,
    /// What follows from it.
    pub equations: Arc<Equations>,
    /// The same as a program.
    pub system: Arc<System>,
    /// The system in motion.
    pub experiment: Experiment,
}

/// Why a document gives no experiment: a report for the user, in one or many lines.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Unready(pub String);

impl Ready {
    /// Reads, derives, compiles and sets up.
    ///
    /// # Errors
    /// Every mistake of the file in its place, or why there are no equations or no method for it.
    pub fn of(document: &Document) -> Result<Ready, Unready> {
        let read = document.read();
        let report = |mistakes: &[_]| Unready(document.report(mistakes, false));
        let model = read.map_err(|mistakes| report(&mistakes))?.model;
        let why = |what: &dyn Display| Unready(format!("{}: {what}", document.path));
        let equations = mechanics::derive(&model).map_err(|error| why(&error))?;
        let mistakes = flaws(&model, &equations);
        if !mistakes.is_empty() {
            return Err(report(&mistakes));
        }
        let system = System::compile(&model, &equations, &[]).map_err(|error| why(&error))?;
        let (model, equations) = (Arc::new(model), Arc::new(equations));
        let experiment = Experiment::new(&model, &equations, &system, Setup::of(&model));
        let experiment = experiment.map_err(|error| why(&error))?;
        let document = Arc::new(document.clone());
        Ok(Ready { document, model, equations, system: Arc::new(system), experiment })
    }
}
