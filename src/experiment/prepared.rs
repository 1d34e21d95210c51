//! All the stages in one go: from a document to an experiment that is ready to begin.
//!
//! In: a [`Document`]. Out: what each stage made of it. Never here: the stages themselves.

use std::fmt::Display;
use std::sync::Arc;

use super::{Experiment, Setup};
use crate::analysis::flaws;
use crate::cancel::Cancel;
use crate::diagnostic::{Diagnostic, Document};
use crate::mechanics::{self, Equations};
use crate::model::Model;
use crate::system::System;

/// A system on all its stages.
pub struct Prepared {
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

/// Why a document gives no experiment.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{report}")]
pub struct PrepareError {
    /// For the user, in one or many lines.
    pub report: String,
    /// Each mistake in its place; what has none stands at the beginning.
    pub mistakes: Vec<Diagnostic>,
}

impl PrepareError {
    /// Somebody asked that it stop.
    fn stopped(document: &Document) -> PrepareError {
        let told = "stopped before it was ready";
        let report = format!("{}: {told}", document.path);
        PrepareError { report, mistakes: vec![Diagnostic::error(0..0, told)] }
    }
}

impl Prepared {
    /// Reads, derives, compiles and sets up.
    ///
    /// # Errors
    /// Every mistake of the file in its place, or why there are no equations or no method for it.
    pub fn of(document: &Document) -> Result<Prepared, PrepareError> {
        Prepared::with(document, &Cancel::new())
    }

    /// The same, with a token by which the stages, and later the motion, can be stopped.
    ///
    /// # Errors
    /// Those of [`Prepared::of`]; that it was stopped, where it was.
    pub fn with(document: &Document, cancel: &Cancel) -> Result<Prepared, PrepareError> {
        let made = Prepared::made_of(document, cancel);
        // what was refused or made of half an expression says nothing of the file
        if cancel.is_cancelled() { Err(PrepareError::stopped(document)) } else { made }
    }

    fn made_of(document: &Document, cancel: &Cancel) -> Result<Prepared, PrepareError> {
        let stop =
            || if cancel.is_cancelled() { Err(PrepareError::stopped(document)) } else { Ok(()) };
        let read = document.read_with(cancel);
        let report = |mistakes: Vec<Diagnostic>| PrepareError {
            report: document.report(&mistakes, false),
            mistakes,
        };
        let model = read.map_err(&report)?.model;
        let why = |what: &dyn Display| PrepareError {
            report: format!("{}: {what}", document.path),
            mistakes: vec![Diagnostic::error(0..0, what.to_string())],
        };
        stop()?;
        let equations = mechanics::derive(&model).map_err(|error| why(&error))?;
        stop()?;
        let mistakes = flaws(&model, &equations);
        if !mistakes.is_empty() {
            return Err(report(mistakes));
        }
        stop()?;
        let system = System::compile(&model, &equations, &[]).map_err(|error| why(&error))?;
        stop()?;
        let (model, equations) = (Arc::new(model), Arc::new(equations));
        let experiment = Experiment::new(&model, &equations, &system, Setup::of(&model));
        let experiment = experiment.map_err(|error| why(&error))?;
        let document = Arc::new(document.clone());
        Ok(Prepared { document, model, equations, system: Arc::new(system), experiment })
    }
}
