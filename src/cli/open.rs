//! From a name on the command line to a model and what follows from it.

use crate::analysis::flaws;
use crate::mechanics::{self, Equations};
use crate::model::Model;
use crate::preset::{Catalog, Document};

use super::failure::Failure;
use super::stderr;

/// Finds the document behind a preset's name or a file's path.
pub(super) fn find(name: &str) -> Result<Document, Failure> {
    Catalog::load().find(name).map_err(|why| Failure::WrongUse(why.to_string()))
}

/// Reads a document. Its mistakes are shown where they stand.
pub(super) fn read(document: &Document) -> Result<Model, Failure> {
    match document.read() {
        Ok(checked) => Ok(checked.model),
        Err(mistakes) => {
            stderr::show(&document.report(&mistakes, stderr::has_colour()));
            Err(Failure::WrongFile(count(mistakes.len(), &document.path)))
        }
    }
}

/// Derives what follows from a model. Brackets that are no Poisson structure are shown where they
/// stand.
pub(super) fn derive(document: &Document, model: &Model) -> Result<Equations, Failure> {
    let derived = mechanics::derive(model);
    let equations =
        derived.map_err(|why| Failure::WrongFile(format!("{}: {why}", document.path)))?;
    let mistakes = flaws(model, &equations);
    if mistakes.is_empty() {
        return Ok(equations);
    }
    stderr::show(&document.report(&mistakes, stderr::has_colour()));
    Err(Failure::WrongFile(count(mistakes.len(), &document.path)))
}

/// `2 mistakes in pendulum.toml`.
pub(super) fn count(mistakes: usize, path: &str) -> String {
    match mistakes {
        1 => format!("1 mistake in {path}"),
        n => format!("{n} mistakes in {path}"),
    }
}
