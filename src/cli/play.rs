//! `phaselab play`: a cast or a script on the terminal.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::time::Duration;

use super::demo_source::scripted;
use super::error::CommandError;
use super::interrupt::Interrupt;
use super::lab::{self, ReadOptions};
use super::record;
use super::stderr;
use crate::diagnostic::Document;
use crate::preset::demo;
use crate::printable;
use crate::record::RecordedCast;
use crate::shell::{self, LeftRecording, NotRecorded, RecordingAhead, Request};

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

pub(super) fn execute(
    arguments: &Arguments,
    of_screen: &[OsString],
    read: ReadOptions,
    interrupt: &Interrupt,
) -> Result<(), CommandError> {
    let request = lab::request(None, of_screen, read)?;
    let played = read_played(&arguments.file)?;
    // the terminal must be restored first
    interrupt.stand_down();
    match played {
        Played::Cast(cast) => lab::how_it_ended(shell::show(cast, &request)),
        Played::Script(source) => play_script(&source, &request),
    }
}

enum Played {
    Cast(RecordedCast),
    /// The text of a script.
    Script(Document),
}

fn read_played(path: &Path) -> Result<Played, CommandError> {
    if let Some(own) = path.to_str().filter(|_| !path.exists()).and_then(demo) {
        return Ok(Played::Script(own));
    }
    let bytes = record::cast_bytes(path)?;
    let shown = printable::path(path);
    if bytes.trim_ascii_start().starts_with(b"{") {
        let text = String::from_utf8_lossy(&bytes);
        let cast = RecordedCast::read(&text);
        return cast
            .map(Played::Cast)
            .map_err(|why| CommandError::WrongFile(format!("{shown}: {why}")));
    }
    Ok(Played::Script(Document::from_bytes(shown, &bytes)))
}

/// Records a script and shows the recording meanwhile. Errors in the script are reported after the terminal is restored.
fn play_script(source: &Document, request: &Request) -> Result<(), CommandError> {
    let (script, system, name) = scripted(source)?;
    let begin = || RecordingAhead::begin(script, system, &name, record::DEFAULT_SIZE);
    let (ending, recorded) = match shell::show_ahead(begin, request) {
        Ok(done) => done,
        Err(error) => return lab::how_it_ended(Err(error)),
    };
    match recorded {
        Some(Ok(recording)) => record::check_claims(source, &recording)?,
        Some(Err(NotRecorded::Script(wrong))) => return Err(record::located(source, &wrong)),
        Some(Err(NotRecorded::Failed(why))) => return Err(CommandError::CouldNot(why)),
        Some(Err(NotRecorded::Left(left))) => {
            stderr::report(&unchecked(&left));
            let ended = lab::how_it_ended(Ok(ending));
            if ended.is_ok() && !left.false_claims.is_empty() {
                return Err(record::located(source, &left.false_claims));
            }
            return ended;
        }
        None => {}
    }
    lab::how_it_ended(Ok(ending))
}

/// What was not checked of a script that was left before it was recorded to its end.
fn unchecked(left: &LeftRecording) -> String {
    let (checked, all) = left.claims;
    let missing = all.saturating_sub(checked);
    if missing == 0 {
        return String::new();
    }
    let at = Duration::from_micros(left.reached).as_secs_f64();
    let (claims, were) = if missing == 1 { ("claim", "was") } else { ("claims", "were") };
    format!(
        "left after {at:.1} s of the demo: {missing} {claims} of {all} {were} not \
         reached; `phaselab script check` checks all of them"
    )
}
