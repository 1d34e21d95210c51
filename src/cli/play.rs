//! `phaselab play`: a cast or a script on the terminal.

use std::path::{Path, PathBuf};

use super::failure::CommandError;
use super::interrupt::Interrupt;
use super::{lab, open, record};
use crate::diagnostic::Document;
use crate::preset::{demo, is_path};
use crate::record::{RecordedCast, Script};
use crate::shell;
use crate::{file, printable};

/// Play a cast (asciinema's, version 2 or 3) or a script of a demo on the terminal.
///
/// Space holds it, `.` steps, `[` and `]` change the pace, the arrows go five seconds back and on,
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

pub(super) fn perform(arguments: &Arguments, interrupt: &Interrupt) -> Result<(), CommandError> {
    let cast = read_cast(&arguments.file)?;
    let request = lab::request(None, &["phaselab".into()])?;
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
    let recording = record::recorded(&script, source, &system, &name, None)?;
    record::hold(source, &recording)?;
    Ok(recording.into())
}

/// The tour, which is played if no demo is named.
const TOUR: &str = include_str!("tour.demo");

/// The text of a script: a file's, a preset's demo, or the tour.
pub(super) fn source(name: Option<&str>) -> Result<Document, CommandError> {
    let Some(name) = name else { return Ok(Document::new("tour.demo", TOUR)) };
    let path = Path::new(name);
    let is_script = path.extension().is_some_and(|ending| ending == "demo");
    if is_script || (is_path(name) && path.extension().is_none_or(|ending| ending != "toml")) {
        return Document::open(path).map_err(|why| CommandError::reading(path, &why));
    }
    record::own_demo(name, "name a script, as in --demo my.demo")
}

/// A script with its system and the system's name on the screen.
pub(super) fn scripted(source: &Document) -> Result<(Script, Document, String), CommandError> {
    let script = Script::read(source).map_err(|mistakes| record::located(source, &mistakes))?;
    let Some(system) = &script.head.open else {
        let what = format!("{} does not say which system it is about: Open NAME", source.path);
        return Err(CommandError::WrongFile(what));
    };
    let document = open::find(&system.text)?;
    // the mistakes of the system are reported for the system's own file
    open::read(&document)?;
    let name = record::called(&system.text).to_owned();
    Ok((script, document, name))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::play;

    #[test]
    fn the_tour_is_short_and_true() {
        let source = source(None).expect("there is one");
        let (script, system, name) = scripted(&source).expect("without mistakes");
        let recording = play(&script, &system, &name, (80, 24)).expect("it can be played");
        assert_eq!(recording.false_claims, []);
        assert!((8..=15).contains(&(recording.end / 1_000_000)), "{}", recording.end);
    }
}
