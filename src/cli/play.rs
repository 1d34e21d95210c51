//! `phaselab play`: a cast or a script on the terminal.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

use super::demo_source::scripted;
use super::failure::CommandError;
use super::interrupt::Interrupt;
use super::lab::{self, ReadOptions};
use super::record;
use crate::diagnostic::Document;
use crate::preset::demo;
use crate::record::RecordedCast;
use crate::shell;
use crate::{file, printable};

/// Play a cast (asciinema's, version 2 or 3) or a script of a demo on the terminal.
///
/// Space pauses, `.` steps, `[` and `]` change the speed, the arrows go back and forward by five seconds,
/// Tab goes to the next chapter, Home to the beginning, End to the end, `c` shows or hides the line
/// of controls, q leaves. Where no row is left below the cast that line stands over its last one,
/// for a few seconds after each key. Whatever a cast holds, only its characters and colours reach
/// the terminal.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab play pendulum               a preset's own demo
  phaselab play my.demo                a script
  phaselab play session.cast           what asciinema or phaselab recorded")]
pub(super) struct Arguments {
    /// A cast, a script, or a preset with a demo of its own.
    #[arg(value_name = "CAST|SCRIPT|PRESET")]
    file: PathBuf,
}

/// The greatest size of a cast that is read.
const LIMIT: u64 = 64 << 20;

pub(super) fn perform(
    arguments: &Arguments,
    of_screen: &[OsString],
    read: ReadOptions,
    interrupt: &Interrupt,
) -> Result<(), CommandError> {
    let cast = read_cast(&arguments.file)?;
    let request = lab::request(None, of_screen, read)?;
    // the terminal must be restored first
    interrupt.stand_aside();
    lab::how_it_ended(shell::show(cast, &request))
}

fn read_cast(path: &Path) -> Result<RecordedCast, CommandError> {
    if let Some(own) = path.to_str().filter(|_| !path.exists()).and_then(demo) {
        return recorded(&own);
    }
    let (bytes, _) = file::read(path, LIMIT).map_err(|why| CommandError::reading(path, &why))?;
    let shown = printable::path(path);
    if bytes.len() as u64 > LIMIT {
        let what = format!("{shown}: a cast may have 64 MiB; this one has more");
        return Err(CommandError::WrongFile(what));
    }
    if bytes.trim_ascii_start().starts_with(b"{") {
        let text = String::from_utf8_lossy(&bytes);
        return RecordedCast::read(&text)
            .map_err(|why| CommandError::WrongFile(format!("{shown}: {why}")));
    }
    recorded(&Document::from_bytes(shown, &bytes))
}

/// Plays a script to make a cast.
fn recorded(source: &Document) -> Result<RecordedCast, CommandError> {
    let (script, system, name) = scripted(source)?;
    // the screen stays as it is until all is computed; a terminal is told why
    let wait = ProgressBar::new_spinner();
    let style = ProgressStyle::with_template("{spinner} {msg}");
    wait.set_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
    wait.set_message(format!("computing the demo of {}", printable::line(&name)));
    wait.enable_steady_tick(Duration::from_millis(100));
    let recording = record::recorded(&script, source, &system, &name, None);
    wait.finish_and_clear();
    let recording = recording?;
    record::hold(source, &recording)?;
    Ok(recording.into())
}
