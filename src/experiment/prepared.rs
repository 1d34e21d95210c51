//! The stages from a document to an experiment that is ready to begin, one by one or all at once.
//!
//! In: a [`Document`], or the result of a stage. Out: the results of the next stages. Never here: the stages
//! themselves.

use std::fmt::Display;
use std::sync::Arc;

use super::{Experiment, Setup};
use crate::cancel::Cancel;
use crate::claims::{structure_diagnostics, unresolved_feature};
use crate::diagnostic::{Diagnostic, Document};
use crate::mechanics::{self, Equations, NoClosedForm};
use crate::model::{Model, WrittenExpr};
use crate::preset::Checked;
use crate::system::{CompileError, System};

/// A model with its derived equations.
#[derive(Clone, Debug)]
pub struct Derived {
    /// The model of the file.
    pub model: Model,
    /// The derived equations.
    pub equations: Equations,
}

impl Derived {
    /// Derives the equations of a model, as far as its motion needs them.
    ///
    /// # Errors
    /// Returns an error if the expressions grow beyond the limits.
    pub fn of(model: Model) -> Result<Derived, NoClosedForm> {
        let equations = mechanics::derive_for_motion(&model)?;
        Ok(Derived { model, equations })
    }

    /// The errors in its brackets and Casimirs. With any of them the system has no motion.
    pub fn diagnostics(&self) -> Vec<Diagnostic> {
        structure_diagnostics(&self.model, &self.equations)
    }

    /// Compiles the system, with these expressions as further columns.
    ///
    /// # Errors
    /// Returns an error if an expression cannot be evaluated during a motion.
    pub fn compile(&self, columns: &[WrittenExpr]) -> Result<System, CompileError> {
        System::compile(&self.model, &self.equations, columns)
    }
}

/// A system at all its stages.
pub struct Prepared {
    /// The file's text.
    pub document: Arc<Document>,
    /// What the text allows but probably does not mean.
    pub warnings: Vec<Diagnostic>,
    /// The model of the file.
    pub model: Arc<Model>,
    /// The derived equations.
    pub equations: Arc<Equations>,
    /// The compiled system.
    pub system: Arc<System>,
    /// With the state at the start, before its first step.
    pub experiment: Experiment,
}

/// Why a document gives no experiment.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{report}")]
pub struct PrepareError {
    /// A report for the user, in one or more lines.
    pub report: String,
    /// Each error with its range; one without a range has the beginning of the file.
    pub diagnostics: Vec<Diagnostic>,
}

impl PrepareError {
    fn stopped(document: &Document) -> PrepareError {
        let message = "stopped before it was ready";
        let report = format!("{}: {message}", document.path);
        PrepareError { report, diagnostics: vec![Diagnostic::error(0..0, message)] }
    }
}

impl Prepared {
    /// Reads, derives, compiles and sets up.
    ///
    /// # Errors
    /// Returns every error of the file with its range, or the reason why there are no equations or no suitable
    /// method.
    pub fn of(document: &Document) -> Result<Prepared, PrepareError> {
        Prepared::with(document, &Cancel::new())
    }

    /// Like [`Prepared::of`], with a token that cancels the stages and later the motion.
    ///
    /// # Errors
    /// Returns the errors of [`Prepared::of`], or an error if it was cancelled.
    pub fn with(document: &Document, cancel: &Cancel) -> Result<Prepared, PrepareError> {
        let made = Prepared::made_of(document, cancel);
        // the errors of a cancelled stage say nothing about the file
        if cancel.is_cancelled() { Err(PrepareError::stopped(document)) } else { made }
    }

    fn made_of(document: &Document, cancel: &Cancel) -> Result<Prepared, PrepareError> {
        let stop =
            || if cancel.is_cancelled() { Err(PrepareError::stopped(document)) } else { Ok(()) };
        let read = document.read_with(cancel);
        let report = |diagnostics: Vec<Diagnostic>| PrepareError {
            report: document.report(&diagnostics, false),
            diagnostics,
        };
        let Checked { model, mut warnings, .. } = read.map_err(&report)?;
        let why = |what: &dyn Display| PrepareError {
            report: format!("{}: {what}", document.path),
            diagnostics: vec![Diagnostic::error(0..0, what.to_string())],
        };
        stop()?;
        let derived = Derived::of(model).map_err(|error| why(&error))?;
        stop()?;
        let diagnostics = derived.diagnostics();
        if !diagnostics.is_empty() {
            return Err(report(diagnostics));
        }
        stop()?;
        let system = derived.compile(&[]).map_err(|error| why(&error))?;
        stop()?;
        let Derived { model, equations } = derived;
        let (model, equations) = (Arc::new(model), Arc::new(equations));
        let experiment = Experiment::new(&model, &equations, &system, Setup::of(&model));
        let experiment = experiment.map_err(|error| why(&error))?;
        let (law, start) = ((&*model, &*equations, &system), experiment.snapshot());
        warnings.extend(unresolved_feature(law, &start.state, &start.parameters));
        let document = Arc::new(document.clone());
        Ok(Prepared { document, warnings, model, equations, system: Arc::new(system), experiment })
    }
}
