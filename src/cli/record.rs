//! `phaselab record`: a script becomes a cast or a GIF, byte for byte the same on every machine.

use std::ffi::OsString;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};

use clap::ValueEnum;

use super::error::CommandError;
use super::open;
use super::output::{Output, OutputForm};
use super::slow_notice::with_notice;
use crate::diagnostic::nearest;
use crate::diagnostic::{Diagnostic, Document};
use crate::preset::{demo, demos};
use crate::record::animation::{CELL_WIDTH, CELL_WIDTHS};
use crate::record::cast_writer::{self, Version};
use crate::record::screenshot::{self, ImageFormat};
use crate::record::script::{ScriptStep, read_size};
use crate::record::{RecordedCast, Recording, Script, animation, called, play, transcript};
use crate::{file, printable};

/// Record a demo: a script of keys, waits and captions becomes a cast or a GIF, the same on every machine.
///
/// No terminal is needed, and its settings do not matter: TERM, NO_COLOR, the locale, the time and
/// the size of the window are ignored. Without --script the preset's own demo is recorded. A
/// script whose claims (Assert) turn out false gives no cast. A cast, such as one that was recorded
/// with the key O, becomes a GIF.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab record pendulum -o pendulum.cast            a preset's own demo
  phaselab record pendulum -o pendulum.gif             as an animated picture
  phaselab record session.cast -o session.gif          a cast as a GIF
  phaselab record my/system.toml --script my.demo --size 100x30 -o my.cast
  phaselab record pendulum --format account            what is done and found
  phaselab record pendulum --still swing.svg --at 'Large swings'")]
pub(super) struct Arguments {
    /// A preset's name, a file, or a cast.
    #[arg(value_name = "PRESET|FILE|CAST")]
    name: OsString,
    /// The script; by default the preset's own demo.
    #[arg(long, value_name = "FILE")]
    script: Option<PathBuf>,
    /// Columns and rows, where the script does not say them.
    #[arg(long, value_name = "WxH", value_parser = read_size)]
    size: Option<(u16, u16)>,
    /// What is written; by default an asciicast of version 3, or a GIF into a file that ends in .gif.
    #[arg(long, value_enum, value_name = "FORMAT", alias = "cast-version")]
    format: Option<CastFormat>,
    /// The width of a character in a GIF, in pixels; characters are twice as high as wide.
    #[arg(long, value_name = "PIXELS", default_value_t = CELL_WIDTH, value_parser = clap::value_parser!(u16).range(i64::from(CELL_WIDTHS[0])..=i64::from(CELL_WIDTHS[1])))]
    cell_width: u16,
    /// Takes a still as well: a drawing (.svg), text (.txt), or text with colours (.ans).
    #[arg(long, value_name = "FILE")]
    still: Option<PathBuf>,
    /// The chapter the still is taken at; by default the end.
    #[arg(long, value_name = "MARKER", requires = "still")]
    at: Option<String>,
    /// Writes to a file, which appears when it is complete and replaces an old one.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum CastFormat {
    /// An asciicast of version 3, of asciinema 3.
    #[value(alias = "3")]
    V3,
    /// An asciicast of version 2, of asciinema 2 and older players.
    #[value(alias = "2")]
    V2,
    /// An animated picture.
    Gif,
    /// What is done, shown and found, in words.
    Account,
}

impl Arguments {
    /// The format that is asked for, or that the name of the output says.
    fn format(&self) -> CastFormat {
        let ending = self.output.as_deref().and_then(Path::extension);
        let is_gif = ending.is_some_and(|ending| ending.eq_ignore_ascii_case("gif"));
        self.format.unwrap_or(if is_gif { CastFormat::Gif } else { CastFormat::V3 })
    }
}

pub(super) fn execute(arguments: &Arguments) -> Result<(), CommandError> {
    let format = arguments.format();
    if format == CastFormat::Gif && arguments.output.is_none() && io::stdout().is_terminal() {
        let what = "a GIF is not for a terminal: give a file, -o NAME.gif";
        return Err(CommandError::WrongUse(what.to_owned()));
    }
    let path = Path::new(&arguments.name);
    if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("cast")) {
        return convert(path, arguments);
    }
    let system = open::find(&arguments.name)?;
    let source = match &arguments.script {
        Some(path) => Document::open(path).map_err(|why| CommandError::reading(path, &why))?,
        None => own_demo(&printable::os(&arguments.name), "give one with --script")?,
    };
    let script = Script::read(&source).map_err(|diagnostics| located(&source, &diagnostics))?;
    let name = printable::os(&arguments.name);
    // what cannot be drawn is refused before a minute of recording
    let still = match &arguments.still {
        Some(path) => Some((path, still_format(path)?)),
        None => None,
    };
    if let Some(at) = &arguments.at {
        let markers = script.steps.iter().filter_map(|(_, step)| match step {
            ScriptStep::Marker(name) => Some(name.as_str()),
            _ => None,
        });
        find_marker(markers, at)?;
    }
    let recording = recorded(&script, &source, &system, &name, arguments.size)?;
    if format != CastFormat::Account {
        check_claims(&source, &recording)?;
    }
    if let Some((path, form)) = still {
        take_still(&recording, path, form, arguments.at.as_deref())?;
        // without a destination, a cast would flood the terminal
        if arguments.output.is_none() {
            return check_claims(&source, &recording);
        }
    }
    let form = match format {
        CastFormat::V3 | CastFormat::V2 => OutputForm::Json,
        CastFormat::Gif => OutputForm::Picture,
        CastFormat::Account => OutputForm::Text,
    };
    let mut out = Output::open(arguments.output.as_deref(), form)?;
    let written = match format {
        CastFormat::V3 => cast_writer::write(&recording, Version::Three, &mut out).map(|_| ()),
        CastFormat::V2 => cast_writer::write(&recording, Version::Two, &mut out).map(|_| ()),
        CastFormat::Gif => {
            let cast = RecordedCast::from(recording);
            return write_gif(&cast, arguments.cell_width, out);
        }
        CastFormat::Account => out.write_all(transcript::write(&recording).as_bytes()),
    };
    written.map_err(|error| out.failed(&error))?;
    out.finish()?;
    check_claims(&source, &recording)
}

/// Draws a cast as a GIF.
fn convert(path: &Path, arguments: &Arguments) -> Result<(), CommandError> {
    let wrong = |what: &str| Err(CommandError::WrongUse(what.to_owned()));
    if arguments.format() != CastFormat::Gif {
        return wrong("a cast becomes a GIF: give -o NAME.gif, or --format gif");
    }
    if arguments.script.is_some() || arguments.still.is_some() || arguments.size.is_some() {
        return wrong("a cast is drawn as it is: --script, --size and --still are for scripts");
    }
    let cast = read_cast(path)?;
    let out = Output::open(arguments.output.as_deref(), OutputForm::Picture)?;
    write_gif(&cast, arguments.cell_width, out)
}

fn write_gif(cast: &RecordedCast, cell_width: u16, mut out: Output) -> Result<(), CommandError> {
    let drawn = || animation::write(cast, cell_width, &mut out).map(|_| ());
    match with_notice("drawing the pictures", drawn) {
        Err(error) if error.kind() == io::ErrorKind::InvalidInput => {
            return Err(CommandError::WrongUse(error.to_string()));
        }
        written => written.map_err(|error| out.failed(&error))?,
    }
    out.finish()
}

/// The greatest size of a cast that is read.
const LARGEST_CAST: u64 = 64 << 20;

fn read_cast(path: &Path) -> Result<RecordedCast, CommandError> {
    let bytes = cast_bytes(path)?;
    let cast = RecordedCast::read(&String::from_utf8_lossy(&bytes));
    cast.map_err(|why| CommandError::WrongFile(format!("{}: {why}", printable::path(path))))
}

/// The bytes of a file that may be a cast.
pub(super) fn cast_bytes(path: &Path) -> Result<Vec<u8>, CommandError> {
    let (bytes, _) =
        file::read(path, LARGEST_CAST).map_err(|why| CommandError::reading(path, &why))?;
    if bytes.len() as u64 > LARGEST_CAST {
        let what =
            format!("{}: a cast may be 64 MiB at most; this one is larger", printable::path(path));
        return Err(CommandError::WrongFile(what));
    }
    Ok(bytes)
}

fn still_format(path: &Path) -> Result<ImageFormat, CommandError> {
    let wrong =
        |why: String| CommandError::WrongUse(format!("--still {}: {why}", printable::path(path)));
    path.to_string_lossy().parse().map_err(wrong)
}

fn find_marker<'a>(
    names: impl Iterator<Item = &'a str>,
    wanted: &str,
) -> Result<usize, CommandError> {
    let names: Vec<&str> = names.collect();
    names.iter().position(|name| *name == wanted).ok_or_else(|| {
        let help = match nearest(wanted, names.iter().copied()) {
            Some(near) => format!("did you mean `{near}`?"),
            None if names.is_empty() => "the script has none".to_owned(),
            None => format!("there are {}", names.join(", ")),
        };
        let wanted = printable::quoted(wanted);
        CommandError::WrongUse(format!("unknown marker `{wanted}`; {help}"))
    })
}

/// Writes a still of the end, or of the beginning of a chapter.
fn take_still(
    recording: &Recording,
    path: &Path,
    form: ImageFormat,
    at: Option<&str>,
) -> Result<(), CommandError> {
    let (screen, colourless) = match at {
        None => (&recording.last, &recording.last_colourless),
        Some(name) => {
            let names = recording.markers.iter().map(|marker| marker.name.as_str());
            let marker = &recording.markers[find_marker(names, name)?];
            (&marker.screen, &marker.colourless)
        }
    };
    // What colours tell apart, as a surface and what is drawn on it, text has to tell apart by its characters.
    let screen = if form == ImageFormat::Text { colourless } else { screen };
    let palette = recording.style.theme.palette();
    let text = screenshot::write(screen, palette, form, &recording.title);
    let written = if form == ImageFormat::Ansi { OutputForm::Coloured } else { OutputForm::Text };
    Output::open(Some(path), written)?.write_text(&text)
}

/// The shipped demo of a preset; if there is none, an error with an alternative.
pub(super) fn own_demo(name: &str, instead: &str) -> Result<Document, CommandError> {
    demo(name).ok_or_else(|| {
        let near = nearest(name, demos()).map_or(String::new(), |n| format!("; `{n}` has one"));
        let name = printable::quoted(name);
        CommandError::WrongUse(format!("`{name}` has no demo of its own: {instead}{near}"))
    })
}

/// Columns and rows, where nobody says them.
pub(super) const DEFAULT_SIZE: (u16, u16) = (80, 24);

/// Plays a script about a system.
pub(super) fn recorded(
    script: &Script,
    source: &Document,
    system: &Document,
    name: &str,
    size: Option<(u16, u16)>,
) -> Result<Recording, CommandError> {
    // the errors of the system are reported for the system's own file
    open::read(system)?;
    let size = size.unwrap_or(DEFAULT_SIZE);
    let played = || play(script, system, called(name), size);
    with_notice(&format!("playing {}", source.path), played)
        .map_err(|diagnostics| located(source, &diagnostics))
}

/// Reports the claims that are false.
pub(super) fn check_claims(source: &Document, recording: &Recording) -> Result<(), CommandError> {
    if recording.false_claims.is_empty() {
        Ok(())
    } else {
        Err(located(source, &recording.false_claims))
    }
}

/// Shows errors with their ranges.
pub(super) fn located(source: &Document, diagnostics: &[Diagnostic]) -> CommandError {
    open::refuse(source, diagnostics)
}
