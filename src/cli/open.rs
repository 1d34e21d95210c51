//! From a name on the command line to a model and its equations.

use std::ffi::OsStr;

use crate::diagnostic::SourceRange;
use crate::diagnostic::nearest;
use crate::diagnostic::{Diagnostic, Document, Severity};
use crate::experiment::{Derived, choose_method};
use crate::integrate::{METHODS, Settings, method_named};
use crate::mechanics::{StructureError, structure_errors};
use crate::model::{Model, WrittenExpr};
use crate::preset::{self, Checked};
use crate::printable;
use crate::system::System;

use super::error::CommandError;
use super::stderr;

/// The name by which a file selects the best suitable method.
const AUTO: &str = "auto";

/// Finds the document behind a preset's name or a file's path.
pub(super) fn find(name: impl AsRef<OsStr>) -> Result<Document, CommandError> {
    preset::find(name).map_err(|why| CommandError::WrongUse(why.to_string()))
}

/// Reads a document. Its errors, and the warnings that bear on the motion, are shown with their ranges.
pub(super) fn read(document: &Document) -> Result<Model, CommandError> {
    match document.read() {
        Ok(Checked { model, mut warnings, .. }) => {
            warnings.retain(|warning| warning.severity == Severity::Warning);
            stderr::show(&document.report(&warnings, stderr::has_colour()));
            Ok(model)
        }
        Err(diagnostics) => Err(refuse(document, &diagnostics)),
    }
}

/// Derives the equations of a model. Brackets that do not form a Poisson structure are reported
/// with their ranges.
pub(super) fn derive(document: &Document, model: Model) -> Result<Derived, CommandError> {
    let derived = Derived::of(model);
    let derived =
        derived.map_err(|why| CommandError::WrongFile(format!("{}: {why}", document.path)))?;
    let errors = structure_errors(&derived.model, &derived.equations);
    // what an option has added has no place in the file
    let (own, added): (Vec<StructureError>, _) =
        errors.into_iter().partition(|e| e.place.is_some());
    let added: Vec<String> = added.iter().map(|e| format!("{}; {}", e.message, e.help)).collect();
    match (own.is_empty(), added.first()) {
        (true, None) => Ok(derived),
        (true, Some(first)) => Err(CommandError::WrongUse(first.clone())),
        (false, _) => {
            for sentence in &added {
                stderr::report(sentence);
            }
            let own: Vec<Diagnostic> =
                own.into_iter().filter_map(StructureError::diagnostic).collect();
            Err(refuse(document, &own))
        }
    }
}

/// The error of a file whose method is not in the table.
pub(super) fn unknown_method(model: &Model) -> Option<Diagnostic> {
    let name = &model.run.method;
    if name == AUTO || method_named(name).is_some() {
        return None;
    }
    let place = model.run.method_place.clone().unwrap_or_default();
    let diagnostic = Diagnostic::error(place, format!("unknown method `{name}`"));
    let names = METHODS.iter().map(|method| method.name);
    Some(match nearest(name, names.clone().chain([AUTO])) {
        Some(near) => diagnostic.with_help(format!("did you mean `{near}`?")),
        None => diagnostic
            .with_help(format!("there are {AUTO} {}", names.collect::<Vec<_>>().join(" "))),
    })
}

/// The error of a file whose method does not suit the system, or does not take the given
/// tolerance or step.
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

/// Shows the errors of a file with their ranges.
pub(super) fn refuse(document: &Document, diagnostics: &[Diagnostic]) -> CommandError {
    stderr::show(&document.report(diagnostics, stderr::has_colour()));
    CommandError::WrongFile(count(diagnostics.len(), &document.path))
}

/// Compiles a system with further columns, and reports the constraints that repeat others.
pub(super) fn compile(
    document: &Document,
    derived: &Derived,
    columns: &[WrittenExpr],
) -> Result<System, CommandError> {
    let system = derived
        .compile(columns)
        .map_err(|why| CommandError::WrongFile(format!("{}: {why}", document.path)))?;
    refuse_twins(&system)?;
    for name in system.redundant() {
        stderr::report(&format!("the constraint `{name}` depends at the start on those before it"));
    }
    Ok(system)
}

/// Refuses two columns with the same name, because they could not be distinguished.
fn refuse_twins(system: &System) -> Result<(), CommandError> {
    let columns = &system.channels()[..system.columns()];
    for (i, column) in columns.iter().enumerate() {
        if column.name == "t" || columns[..i].iter().any(|other| other.name == column.name) {
            let message = format!(
                "there would be two columns `{}`; give one a name of its own, --observe NAME=EXPR",
                printable::quoted(&column.name)
            );
            return Err(CommandError::WrongUse(message));
        }
    }
    Ok(())
}

/// `2 errors in pendulum.toml`.
pub(super) fn count(diagnostics: usize, path: &str) -> String {
    match diagnostics {
        1 => format!("1 error in {path}"),
        n => format!("{n} errors in {path}"),
    }
}
