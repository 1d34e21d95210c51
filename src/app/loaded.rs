//! A system ready to be shown, or the reason why there is none.
//!
//! In: what the shell has built. Out: [`Loaded`], and what is copied of it. Never here: how a system is built.

use std::sync::Arc;

use crate::diagnostic::{Diagnostic, Document, Severity};
use crate::experiment::{Experiment, Prepared};
use crate::instrument::Physics;
use crate::mechanics::{Equations, Further, NamedRamps, Report, latex};
use crate::model::Model;
use crate::system::System;

/// A system ready to be shown.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The requested name: a preset's name or a file's path.
    pub name: String,
    /// The epoch of its snapshots.
    pub epoch: u64,
    /// The parsed text of the file.
    pub document: Arc<Document>,
    /// What the text allows but probably does not mean.
    pub warnings: Vec<Diagnostic>,
    /// The model that the file describes.
    pub model: Arc<Model>,
    /// The equations derived from it.
    pub equations: Arc<Equations>,
    /// The compiled system, with its channels.
    pub system: Arc<System>,
}

impl Loaded {
    /// What the lab needs of a system that is ready. `start` takes the experiment, which is run elsewhere, and returns the
    /// epoch of its snapshots.
    pub fn of(name: String, ready: Prepared, start: impl FnOnce(Experiment) -> u64) -> Loaded {
        let Prepared { document, warnings, model, equations, system, experiment } = ready;
        Loaded { name, epoch: start(experiment), document, warnings, model, equations, system }
    }

    /// Returns what follows from its law as a fragment for LaTeX, as `phaselab derive --format latex` writes it.
    pub fn latex(&self) -> String {
        let mut equations = (*self.equations).clone();
        equations.find_closed_forms();
        let further = Further::of(&self.model, &mut equations);
        match NamedRamps::readable(&equations, &further) {
            Some((named, further)) => latex(&Report::of(&named.model, &named.equations), &further),
            None => latex(&Report::of(&self.model, &equations), &further),
        }
    }

    /// Returns the first warning of the text that bears on the motion, in one line with its place.
    pub(super) fn warning(&self) -> Option<String> {
        let mut warnings = self.warnings.iter().filter(|one| one.severity == Severity::Warning);
        let first = warnings.next()?;
        let (line, _) = self.document.line_and_column(first.place.start);
        let help = first.help.as_ref().map_or_else(String::new, |help| format!("; {help}"));
        let more = match warnings.count() {
            0 => String::new(),
            1 => " (and 1 more warning: E shows it)".to_owned(),
            n => format!(" (and {n} more warnings: E shows them)"),
        };
        Some(format!("Warning, line {line}: {}{help}{more}", first.message))
    }

    /// Returns the system as instruments see it.
    pub fn physics(&self) -> Physics<'_> {
        Physics { model: &self.model, equations: &self.equations, system: &self.system }
    }
}

/// Why a system could not be loaded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoadError {
    /// The requested name.
    pub name: String,
    /// What is wrong, as it would be printed, in one or more lines.
    pub message: String,
}
