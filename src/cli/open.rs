//! From a name on the command line to a model and what follows from it.

use std::ffi::OsStr;

use crate::analysis::flaws;
use crate::diagnostic::SourceRange;
use crate::diagnostic::nearest;
use crate::diagnostic::{Diagnostic, Document};
use crate::experiment::choose_method;
use crate::integrate::{METHODS, Settings, method_named};
use crate::mechanics::{self, Equations};
use crate::model::Model;
use crate::preset::Catalog;
use crate::system::System;

use super::failure::CommandError;
use super::stderr;

/// What a file says where the best method that fits is to be taken.
const AUTO: &str = "auto";

/// Finds the document behind a preset's name or a file's path.
pub(super) fn find(name: impl AsRef<OsStr>) -> Result<Document, CommandError> {
    Catalog::load().find(name).map_err(|why| CommandError::WrongUse(why.to_string()))
}

/// Reads a document. Its mistakes are shown where they stand.
pub(super) fn read(document: &Document) -> Result<Model, CommandError> {
    match document.read() {
        Ok(checked) => Ok(checked.model),
        Err(mistakes) => Err(refuse(document, &mistakes)),
    }
}

/// Derives what follows from a model. Brackets that are no Poisson structure are shown where they
/// stand.
pub(super) fn derive(document: &Document, model: &Model) -> Result<Equations, CommandError> {
    let derived = mechanics::derive(model);
    let equations =
        derived.map_err(|why| CommandError::WrongFile(format!("{}: {why}", document.path)))?;
    let mistakes = flaws(model, &equations);
    if mistakes.is_empty() { Ok(equations) } else { Err(refuse(document, &mistakes)) }
}

/// The file's method, if the table has none of that name.
pub(super) fn unknown_method(model: &Model) -> Option<Diagnostic> {
    let name = &model.run.method;
    if name == AUTO || method_named(name).is_some() {
        return None;
    }
    let place = model.run.method_place.clone().unwrap_or_default();
    let mistake = Diagnostic::error(place, format!("there is no method `{name}`"));
    let names = METHODS.iter().map(|method| method.name);
    Some(match nearest(name, names.clone().chain([AUTO])) {
        Some(near) => mistake.with_help(format!("did you mean `{near}`?")),
        None => {
            mistake.with_help(format!("there are {AUTO} {}", names.collect::<Vec<_>>().join(" ")))
        }
    })
}

/// The file's method, if it is none for this system, or takes no such tolerance or step.
pub(super) fn unfit_method(model: &Model, system: &System) -> Option<Diagnostic> {
    let run = &model.run;
    let at = |place: &Option<SourceRange>, why: String| {
        let place = place.as_ref().or(run.method_place.as_ref());
        Diagnostic::error(place.cloned().unwrap_or_default(), why)
    };
    let method = match choose_method(system, &run.method) {
        Ok(method) => method,
        Err(why) => return Some(at(&run.method_place, why.to_string())),
    };
    let settings = Settings { step: run.step, tolerance: run.tolerance };
    let why = (method.make)(system, &settings).err()?;
    Some(at(&run.settings_place, why.to_string()))
}

/// Shows mistakes of a file where they stand.
pub(super) fn refuse(document: &Document, mistakes: &[Diagnostic]) -> CommandError {
    stderr::show(&document.report(mistakes, stderr::has_colour()));
    CommandError::WrongFile(count(mistakes.len(), &document.path))
}

/// `2 mistakes in pendulum.toml`.
pub(super) fn count(mistakes: usize, path: &str) -> String {
    match mistakes {
        1 => format!("1 mistake in {path}"),
        n => format!("{n} mistakes in {path}"),
    }
}
