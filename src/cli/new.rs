//! `phaselab new`: a file to begin a system of one's own from.

use std::fs::File;
use std::io::{self, Write};
use std::path::PathBuf;

use super::error::CommandError;
use super::output::{Output, OutputForm};
use crate::preset::template;
use crate::printable;

/// Begin a system of your own: write a commented file that runs as it is.
///
/// An existing file is never overwritten.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab new cart && phaselab ./cart.toml     write cart.toml and open it; E edits it")]
pub(super) struct Arguments {
    /// The name of the system; the file is NAME.toml.
    #[arg(value_name = "NAME")]
    name: PathBuf,
}

pub(super) fn execute(arguments: &Arguments) -> Result<(), CommandError> {
    let mut path = arguments.name.clone();
    if path.file_name().is_none() {
        let shown = printable::path(&path);
        return Err(CommandError::WrongUse(format!(
            "`{shown}` is not a file name; write phaselab new NAME, as phaselab new cart"
        )));
    }
    if path.extension().is_none_or(|extension| extension != "toml") {
        path.as_mut_os_string().push(".toml");
    }
    let shown = printable::path(&path);
    let mut file = File::create_new(&path).map_err(|why| match why.kind() {
        io::ErrorKind::AlreadyExists => CommandError::WrongUse(format!(
            "{shown} already exists and was not overwritten; choose another name, or open it: phaselab {}",
            as_argument(&shown)
        )),
        _ => CommandError::writing(&shown, &why),
    })?;
    let written = file.write_all(template().as_bytes()).and_then(|()| file.sync_all());
    written.map_err(|why| CommandError::writing(&shown, &why))?;
    let text = format!("{shown} was written; open it with phaselab {}\n", as_argument(&shown));
    Output::print(OutputForm::Text, &text)
}

/// A path as an argument that is taken for a file, not for a preset, in quotation marks where a shell needs them.
fn as_argument(path: &str) -> String {
    let path = if path.contains('/') { path.to_owned() } else { format!("./{path}") };
    let is_plain = |c: char| c.is_alphanumeric() || "/._-+,:@%=".contains(c);
    if path.chars().all(is_plain) { path } else { format!("'{}'", path.replace('\'', r"'\''")) }
}
