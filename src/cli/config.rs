//! `phaselab config`: the path of the configuration, its keys, and its errors.

use std::path::PathBuf;

use super::error::CommandError;
use super::output::{Output, OutputForm};
use super::{open, stderr};
use crate::diagnostic::Document;
use crate::printable;
use crate::shell::config;
use crate::shell::options::Words;

/// Show where the configuration belongs and what it may contain, or check it for errors.
///
/// The laboratory reads `phaselab/config.toml` in your configuration folder, if it is there. Its
/// keys are the laboratory's options. An option on the command line wins over a variable of the
/// environment (`PHASELAB_FPS=10`), and that over the file. Commands without a screen never read
/// it.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab config path                 where it belongs
  phaselab config print-default        one to begin with
  phaselab config check                check it for errors")]
pub(super) struct Arguments {
    #[command(subcommand)]
    command: ConfigCommand,
}

#[derive(Debug, clap::Subcommand)]
enum ConfigCommand {
    /// Print a configuration with all defaults and a comment on each key.
    PrintDefault,
    /// Print where the configuration file belongs, whether or not it exists.
    Path,
    /// Report every error in the configuration, or in a file that is to become one.
    Check {
        /// The file to look at in place of the configuration.
        #[arg(value_name = "FILE")]
        file: Option<PathBuf>,
    },
}

pub(super) fn execute(arguments: &Arguments) -> Result<(), CommandError> {
    match &arguments.command {
        ConfigCommand::PrintDefault => print(&config::default_text()),
        ConfigCommand::Path => print(&format!("{}\n", printable::path(&path()?))),
        ConfigCommand::Check { file: Some(path) } => {
            let document = Document::open(path).map_err(|why| CommandError::reading(path, &why))?;
            read(&document).map(|_| ())
        }
        ConfigCommand::Check { file: None } => match find()? {
            Some(document) => read(&document).map(|_| ()),
            None => {
                let path = printable::path(&path()?);
                stderr::report(&format!("there is no configuration at {path}"));
                Ok(())
            }
        },
    }
}

/// The options of the configuration, empty if there is none. Its errors are shown with their
/// ranges.
pub(super) fn options() -> Result<Words, CommandError> {
    find()?.map_or(Ok(Words::new()), |document| read(&document))
}

fn find() -> Result<Option<Document>, CommandError> {
    config::find().map_err(|why| match config::path() {
        Some(path) => CommandError::reading(&path, &why),
        None => CommandError::CouldNot(printable::why(&why)),
    })
}

fn path() -> Result<PathBuf, CommandError> {
    let none = "there is no home folder to keep a configuration in: set HOME or XDG_CONFIG_HOME";
    config::path().ok_or_else(|| CommandError::CouldNot(none.to_owned()))
}

fn read(document: &Document) -> Result<Words, CommandError> {
    config::read(document).map_err(|diagnostics| open::refuse(document, &diagnostics))
}

fn print(text: &str) -> Result<(), CommandError> {
    Output::print(OutputForm::Text, text)
}
