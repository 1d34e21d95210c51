//! `phaselab script check`: every error of scripts, and whether their claims are true.

use std::path::PathBuf;

use clap::Subcommand;

use super::error::CommandError;
use super::{open, record};
use crate::diagnostic::Document;
use crate::record::Script;

/// Check scripts of demos.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab script check my.demo")]
pub(super) struct Arguments {
    #[command(subcommand)]
    command: DemoCommand,
}

#[derive(Debug, Subcommand)]
enum DemoCommand {
    /// Report every error in scripts, and whether what they claim is true.
    ///
    /// Reports go to standard error. A script that says which system it is about (Open) is played
    /// to its end, without writing anything.
    Check {
        /// The scripts.
        #[arg(value_name = "FILE", required = true)]
        files: Vec<PathBuf>,
    },
}

pub(super) fn execute(arguments: &Arguments) -> Result<(), CommandError> {
    let DemoCommand::Check { files } = &arguments.command;
    let mut wrong = Vec::new();
    for path in files {
        let source = Document::open(path).map_err(|why| CommandError::reading(path, &why))?;
        match check(&source) {
            Err(CommandError::WrongFile(what)) => wrong.push(what),
            other => other?,
        }
    }
    if wrong.is_empty() { Ok(()) } else { Err(CommandError::WrongFile(wrong.join("\n"))) }
}

fn check(source: &Document) -> Result<(), CommandError> {
    let script =
        Script::read(source).map_err(|diagnostics| record::located(source, &diagnostics))?;
    let Some(system) = &script.head.open else { return Ok(()) };
    let document = open::find(&system.text)?;
    let recording = record::recorded(&script, source, &document, &system.text, None)?;
    record::check_claims(source, &recording)
}
