//! The destination of a command's data: standard output, or a file that appears complete or not at all.
//!
//! In: text in a [`OutputForm`]. Out: a file or a stream, without terminal control characters. Never here: what the text
//! means.

use std::borrow::Cow;
use std::fs::{self, File};
use std::io::{self, BufWriter, Stdout, Write};
use std::path::Path;

use super::error::CommandError;
use super::interrupt::{Interrupt, PORTION};
use super::standard_output::stdout;
use super::stderr;
use crate::printable;
use crate::shell::atomic_file::{AtomicFile, Durability};

/// The form of the text, which determines how terminal control characters are escaped.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum OutputForm {
    /// Text: `\u{9b}`.
    Text,
    /// Text with our own colours.
    Coloured,
    /// JSON: `\u009b`.
    Json,
    /// A picture, whose bytes are written as they are.
    Picture,
}

impl OutputForm {
    fn word(self) -> &'static str {
        match self {
            OutputForm::Json => "JSON",
            OutputForm::Picture => "a GIF",
            OutputForm::Text | OutputForm::Coloured => "text",
        }
    }
}

/// What a file's name says that is not what will be in it.
fn other_format(path: &Path, form: OutputForm) -> Option<String> {
    const BINARY: [&str; 15] = [
        "xlsx", "xls", "ods", "numbers", "parquet", "feather", "h5", "hdf5", "npy", "npz", "mat",
        "png", "jpg", "pdf", "gif",
    ];
    let ending = path.extension()?.to_str()?.to_ascii_lowercase();
    if form == OutputForm::Picture {
        return (ending != "gif").then(|| format!("which is not the format that .{ending} names"));
    }
    if BINARY.contains(&ending.as_str()) {
        return Some(format!("which is not the format that .{ending} names"));
    }
    let is_json = matches!(ending.as_str(), "json" | "jsonl");
    match form {
        OutputForm::Json if ending == "csv" => {
            Some("although .csv names another format".to_owned())
        }
        OutputForm::Text if is_json => Some(format!("although .{ending} names another format")),
        _ => None,
    }
}

/// A destination for data.
#[derive(Debug)]
pub(super) struct Output {
    writer: BufWriter<Target>,
    form: OutputForm,
    /// Its name in messages.
    name: String,
    /// Whether a file that is not empty already exists there.
    over: bool,
    /// What may end the command while it writes.
    interrupt: Option<Interrupt>,
}

#[derive(Debug)]
enum Target {
    Stdout(Stdout),
    /// Standard output that is closed.
    Closed,
    /// A device or a pipe.
    Direct(File),
    File(AtomicFile),
}

impl Output {
    /// Opens standard output, or the file at a path. A regular file is replaced as a whole in [`Output::finish`], so
    /// that a failure leaves an old file unchanged; a device or a pipe is written directly. A file that describes a system, such as
    /// the one that is being read, is not replaced.
    pub(super) fn open(path: Option<&Path>, form: OutputForm) -> Result<Output, CommandError> {
        let Some(path) = path else { return Ok(Output::standard(form)) };
        if describes_a_system(path) {
            let name = printable::path(path);
            return Err(CommandError::WrongUse(format!(
                "{name} describes a system, and is not replaced; give the output another name"
            )));
        }
        if let Some(other) = other_format(path, form) {
            let name = printable::path(path);
            stderr::report(&format!("{name} is written as {}, {other}", form.word()));
        }
        Output::rewrite(path, form)
    }

    /// Opens the file at a path, whatever is in it.
    pub(super) fn rewrite(path: &Path, form: OutputForm) -> Result<Output, CommandError> {
        let name = printable::path(path);
        let about = fs::metadata(path);
        let direct = about.as_ref().is_ok_and(|about| !about.is_file());
        let over = about.is_ok_and(|about| about.is_file() && about.len() > 0);
        let target = if direct {
            File::options().write(true).open(path).map(Target::Direct)
        } else {
            AtomicFile::begin(path).map(Target::File)
        };
        let target = target.map_err(|error| CommandError::writing(&name, &error))?;
        Ok(Output { writer: BufWriter::new(target), form, name, over, interrupt: None })
    }

    fn standard(form: OutputForm) -> Output {
        let writer = BufWriter::new(stdout().map_or(Target::Closed, Target::Stdout));
        Output { writer, form, name: "standard output".to_owned(), over: false, interrupt: None }
    }

    /// Writes all of a text to standard output.
    pub(super) fn print(form: OutputForm, text: &str) -> Result<(), CommandError> {
        Output::standard(form).write_text(text)
    }

    /// The same output; a signal that comes while it is written waits for it. A file that is moved into place is waited for,
    /// and so is a reader that takes what a signal left.
    pub(super) fn waited_for(self, interrupt: &Interrupt) -> Output {
        Output { interrupt: Some(interrupt.clone()), ..self }
    }

    /// Writes all of a text, and finishes.
    pub(super) fn write_text(mut self, text: &str) -> Result<(), CommandError> {
        self.write_all(text.as_bytes()).map_err(|error| self.failed(&error))?;
        self.finish()
    }

    /// The same after a signal, too: the text, which may take long to be put into words, and its writing are waited for.
    pub(super) fn write_after_signal(
        self,
        text: impl FnOnce() -> String,
        interrupt: &Interrupt,
    ) -> Result<(), CommandError> {
        interrupt.prepares();
        let text = text();
        interrupt.is_prepared();
        self.write_pieces(std::iter::once(text), interrupt)
    }

    /// The same for a text that is put into words piece by piece: that of many rows takes longer than a command has to end
    /// by itself.
    pub(super) fn write_pieces(
        self,
        pieces: impl Iterator<Item = String>,
        interrupt: &Interrupt,
    ) -> Result<(), CommandError> {
        let mut out = self.waited_for(interrupt);
        if out.is_file() {
            interrupt.saves();
        }
        for piece in pieces {
            for portion in piece.as_bytes().chunks(PORTION) {
                out.write_all(portion).map_err(|error| out.failed(&error))?;
            }
        }
        out.finish()
    }

    /// Whether it is a file that is to be moved into place.
    pub(super) fn is_file(&self) -> bool {
        matches!(self.writer.get_ref(), Target::File(_))
    }

    /// Finishes writing, and reports if an existing file was replaced.
    pub(super) fn finish(self) -> Result<(), CommandError> {
        let Self { writer, name, over, interrupt, .. } = self;
        if let (Target::File(_), Some(interrupt)) = (writer.get_ref(), &interrupt) {
            interrupt.saves();
        }
        let done = writer.into_inner().map_err(io::IntoInnerError::into_error);
        let done = done.and_then(|target| match target {
            Target::Stdout(mut stdout) => stdout.flush(),
            Target::Closed => Ok(()),
            Target::Direct(mut file) => file.flush(),
            Target::File(file) => file.finish(Durability::OnDisk),
        });
        done.map_err(|error| CommandError::writing(&name, &error))?;
        if over {
            stderr::report(&format!("{name} is replaced"));
        }
        Ok(())
    }

    pub(super) fn name(&self) -> &str {
        &self.name
    }

    /// Converts a write error to a failure of the command.
    pub(super) fn failed(&self, error: &io::Error) -> CommandError {
        CommandError::writing(&self.name, error)
    }
}

/// Files that describe a system are not longer than this.
const LONGEST: u64 = 1 << 22;

/// Whether there is a file that gives coordinates or variables.
fn describes_a_system(path: &Path) -> bool {
    let known = fs::metadata(path);
    if !known.is_ok_and(|about| about.is_file() && about.len() <= LONGEST) {
        return false;
    }
    let Ok(text) = fs::read_to_string(path) else { return false };
    let tables = ["coordinates", "variables"];
    match text.parse::<toml::Table>() {
        Ok(file) => tables.iter().any(|table| file.contains_key(*table)),
        // a file with errors is one, too
        Err(_) => text.lines().any(|line| {
            let head = line.trim().trim_start_matches('[').trim_start();
            line.trim().starts_with('[') && tables.iter().any(|table| head.starts_with(table))
        }),
    }
}

impl Write for Output {
    /// Accepts whole characters, as `write!` and the JSON writers give them.
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if matches!(self.form, OutputForm::Picture) {
            return self.writer.write(bytes);
        }
        let safe = if printable::is_plain(bytes) {
            Cow::Borrowed(bytes)
        } else {
            let text = String::from_utf8_lossy(bytes);
            let escape = match self.form {
                OutputForm::Json => printable::json,
                OutputForm::Coloured => printable::coloured,
                OutputForm::Text | OutputForm::Picture => printable::lines,
            };
            Cow::Owned(escape(&text).into_owned().into_bytes())
        };
        if let Some(interrupt) = &self.interrupt
            && interrupt.signal().is_some()
            && !self.is_file()
        {
            interrupt.writes();
        }
        self.writer.write_all(&safe)?;
        if let Some(interrupt) = &self.interrupt {
            interrupt.taken();
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

impl Write for Target {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Target::Stdout(stdout) => stdout.write(bytes),
            Target::Closed => stdout()?.write(bytes),
            Target::Direct(file) => file.write(bytes),
            Target::File(file) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Target::Stdout(stdout) => stdout.flush(),
            Target::Closed => Ok(()),
            Target::Direct(file) => file.flush(),
            Target::File(file) => file.flush(),
        }
    }
}
