//! `phaselab fmt`: expressions in the notation of the screen written in the plain form of files.

use std::io::Write;
use std::path::PathBuf;

use super::error::CommandError;
use super::output::{Output, OutputForm};
use super::{open, stderr};
use crate::diagnostic::Document;
use crate::printable;

/// Write the expressions of files in their plain form.
///
/// `½ m l² θ′²` becomes `1/2*m*l^2*theta'^2`. Only what is in the notation of the screen
/// changes; comments, spaces and everything else stay. The text goes to standard output, or back
/// into the files.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab fmt my/system.toml            the file in plain form
  phaselab fmt --write my/*.toml         the files themselves")]
pub(super) struct Arguments {
    /// The files.
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// Write the files themselves.
    #[arg(long)]
    write: bool,
}

pub(super) fn execute(arguments: &Arguments) -> Result<(), CommandError> {
    for path in &arguments.files {
        let document = Document::open(path).map_err(|why| CommandError::reading(path, &why))?;
        let checked = document.read().map_err(|diagnostics| {
            stderr::show(&document.report(&diagnostics, stderr::has_colour()));
            CommandError::WrongFile(open::count(diagnostics.len(), &printable::path(path)))
        })?;
        let text = checked.in_plain_form(&document.text);
        if !arguments.write {
            Output::print(OutputForm::Text, &text)?;
        } else if text != document.text {
            let mut output = Output::rewrite(path, OutputForm::Text)?;
            output.write_all(text.as_bytes()).map_err(|why| output.failed(&why))?;
            output.finish()?;
        }
    }
    Ok(())
}
