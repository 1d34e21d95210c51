//! `phaselab check`: every error in files, and whether their claims are true.

use std::io::{ErrorKind, IsTerminal, stdout};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use clap::ValueEnum;
use serde_json::{Value, json};

use super::error::CommandError;
use super::interrupt::Interrupt;
use super::output::{Output, OutputForm};
use super::slow_notice::with_notice;
use super::{open, stderr};
use crate::claims::false_claims_followed;
use crate::diagnostic::{Diagnostic, Document, Severity};
use crate::experiment::Derived;
use crate::mechanics::{ConservedKind, Reason, Report};
use crate::preset::is_path;
use crate::printable;

/// Report all errors in files, and whether what they claim is true.
///
/// Reports go to standard error. A file's claims (`conserved`, `[expect]`) are checked by
/// integrating the motion. If there are no errors, nothing is written except a short summary on a
/// terminal.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab check my/system.toml          every error with a caret, and what would be right
  phaselab check my/*.toml && echo fine
  phaselab check --format json my/system.toml | jq '.files[].mistakes'")]
pub(super) struct Arguments {
    /// The files, or the names of systems.
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// How they are reported.
    #[arg(long, value_enum, default_value_t)]
    format: CheckFormat,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, ValueEnum)]
enum CheckFormat {
    /// For reading, on standard error.
    #[default]
    Text,
    /// One object on standard output, `{"files": [...]}`.
    Json,
}

/// The claim that a motion is followed for, and the time to which it has come.
#[derive(Clone, Default)]
struct FollowedClaim(Arc<Mutex<Option<(String, f64)>>>);

impl FollowedClaim {
    fn note(&self, claim: &str, time: f64) {
        let mut followed = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        *followed = Some((claim.to_owned(), time));
    }

    fn clear(&self) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }

    /// Says how far the motion has come, if it was followed when a signal came.
    fn report(&self) {
        let followed = self.0.lock().unwrap_or_else(PoisonError::into_inner).take();
        let Some((claim, time)) = followed else { return };
        let time = printable::number(time);
        stderr::report(&format!(
            "stopped at t = {time} of the motion, before `{claim}` was checked"
        ));
    }
}

pub(super) fn execute(arguments: &Arguments, interrupt: &Interrupt) -> Result<(), CommandError> {
    let followed = FollowedClaim::default();
    let mut files = Vec::new();
    let mut errors = 0;
    for path in &arguments.files {
        let document = match Document::open(path) {
            Err(why) if why.kind() == ErrorKind::NotFound && !is_path(path) => open::find(path)?,
            read => read.map_err(|why| CommandError::reading(path, &why))?,
        };
        let (diagnostics, found) = findings(&document, &followed, interrupt);
        if let Some(signal) = interrupt.signal() {
            followed.report();
            return Err(CommandError::Signal(signal));
        }
        followed.clear();
        errors += diagnostics.iter().filter(|m| m.severity == Severity::Error).count();
        match arguments.format {
            CheckFormat::Text => {
                stderr::show(&document.report(&diagnostics, stderr::has_colour()));
                let found = found.filter(|_| diagnostics.is_empty() && stdout().is_terminal());
                if let Some(found) = found {
                    let name = printable::path(path);
                    Output::print(OutputForm::Text, &format!("{name}: no errors; {found}\n"))?;
                }
            }
            CheckFormat::Json => files.push(object(&document, &diagnostics)),
        }
    }
    if arguments.format == CheckFormat::Json {
        Output::print(OutputForm::Json, &format!("{:#}\n", json!({ "files": files })))?;
    }
    match (errors, arguments.files.as_slice()) {
        (0, _) => Ok(()),
        (n, [file]) => Err(CommandError::WrongFile(open::count(n, &printable::path(file)))),
        (n, files) => {
            Err(CommandError::WrongFile(open::count(n, &format!("{} files", files.len()))))
        }
    }
}

/// All errors of a file: those of its text, otherwise of its equations, otherwise of its claims; and what it describes.
fn findings(
    document: &Document,
    followed: &FollowedClaim,
    interrupt: &Interrupt,
) -> (Vec<Diagnostic>, Option<String>) {
    let checked = match document.read() {
        Ok(checked) => checked,
        Err(diagnostics) => return (diagnostics, None),
    };
    let mut found = None;
    let mut diagnostics = checked.warnings;
    let unknown_method = open::unknown_method(&checked.model);
    let is_known = unknown_method.is_none();
    diagnostics.extend(unknown_method);
    let place = checked.model.law_place.clone();
    match Derived::of(checked.model) {
        Ok(derived) => {
            found = Some(description(&derived));
            let stopped = followed.clone();
            interrupt.ends_by_itself(move || stopped.report());
            let note = |claim: &str, time| followed.note(claim, time);
            let claims = || false_claims_followed(&derived.model, &derived.equations, &note);
            let what = format!("following the motion of {} for what it claims", document.path);
            diagnostics.extend(with_notice(&what, claims));
            if is_known && let Ok(system) = derived.compile(&[]) {
                diagnostics.extend(open::unfit_method(&derived.model, &system));
            }
        }
        Err(why) => diagnostics.push(Diagnostic::error(place, why.to_string())),
    }
    diagnostics.sort_by_key(|diagnostic| diagnostic.place.start);
    (diagnostics, found)
}

/// What a system consists of and what it conserves: `2 coordinates, conserved: p_x, E`.
fn description(derived: &Derived) -> String {
    let report = Report::of(&derived.model, &derived.equations);
    let name = |constant: &ConservedKind<'_>| match constant {
        ConservedKind::Momentum(p) => derived.equations.pool.symbol_info(*p).name.clone(),
        ConservedKind::Energy => "E".to_owned(),
        ConservedKind::Casimir(name) | ConservedKind::Other(name) => (*name).to_owned(),
    };
    let names = |wanted: bool| {
        let among = |reason: &Reason| matches!(reason, Reason::BetweenImpulses(_)) == wanted;
        let conserved = report.conserved.iter().filter(|conserved| among(conserved.reason));
        conserved.map(|conserved| name(&conserved.constant)).collect::<Vec<_>>().join(", ")
    };
    let (always, between) = (names(false), names(true));
    let coordinates = match derived.model.coordinates.len() {
        1 => "1 coordinate".to_owned(),
        count => format!("{count} coordinates"),
    };
    match (always.is_empty(), between.is_empty()) {
        (true, true) => format!("{coordinates}, no conserved quantity was found"),
        (false, true) => format!("{coordinates}, conserved: {always}"),
        (true, false) => format!("{coordinates}, conserved between impulses: {between}"),
        (false, false) => {
            format!("{coordinates}, conserved: {always}, and between impulses: {between}")
        }
    }
}

fn object(document: &Document, diagnostics: &[Diagnostic]) -> Value {
    let diagnostics: Vec<Value> = diagnostics
        .iter()
        .map(|diagnostic| {
            let (line, column) = document.line_and_column(diagnostic.place.start);
            json!({
                "severity": match diagnostic.severity {
                    Severity::Error => "error",
                    Severity::Warning | Severity::Unused => "warning",
                },
                "line": line,
                "column": column,
                "message": diagnostic.message,
                "help": diagnostic.help,
            })
        })
        .collect();
    json!({ "file": document.path, "mistakes": diagnostics })
}
