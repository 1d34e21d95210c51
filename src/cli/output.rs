//! Where a command's data goes: standard output, or a file that appears whole or not at all.
//!
//! In: text in a [`Form`]. Out: a file or a stream, without a character that would steer a terminal. Never here: what the
//! text means.

use std::fs::{self, File};
use std::io::{self, BufWriter, Stdout, Write};
use std::path::Path;

use super::failure::CommandError;
use super::stderr;
use crate::printable;
use crate::shell::whole::Whole;

/// What is written: how characters that would steer a terminal are written out in it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Form {
    /// Text: `\u{9b}`.
    Text,
    /// Text with colours of ours.
    Coloured,
    /// JSON: `\u009b`.
    Json,
}

/// A place for data.
#[derive(Debug)]
pub(super) struct Output {
    writer: BufWriter<Target>,
    form: Form,
    /// As messages call it.
    name: String,
    /// Whether a file with something in it stands there already.
    over: bool,
}

#[derive(Debug)]
enum Target {
    Stdout(Stdout),
    /// A device or a pipe.
    Direct(File),
    File(Whole),
}

impl Output {
    /// Standard output, or the file of that path. A regular file takes its place whole at [`Output::finish`], so that
    /// a failure leaves an old file as it was; a device or a pipe is written directly.
    pub(super) fn open(path: Option<&Path>, form: Form) -> Result<Output, CommandError> {
        let Some(path) = path else { return Ok(Output::standard(form)) };
        let name = printable::path(path);
        let about = fs::metadata(path);
        let direct = about.as_ref().is_ok_and(|about| !about.is_file());
        let over = about.is_ok_and(|about| about.is_file() && about.len() > 0);
        let target = if direct {
            File::options().write(true).open(path).map(Target::Direct)
        } else {
            Whole::begin(path).map(Target::File)
        };
        let target = target.map_err(|error| CommandError::writing(&name, &error))?;
        Ok(Output { writer: BufWriter::new(target), form, name, over })
    }

    fn standard(form: Form) -> Output {
        let writer = BufWriter::new(Target::Stdout(io::stdout()));
        Output { writer, form, name: "standard output".to_owned(), over: false }
    }

    /// Writes all of a text to standard output.
    pub(super) fn print(form: Form, text: &str) -> Result<(), CommandError> {
        let mut out = Output::standard(form);
        out.write_all(text.as_bytes()).map_err(|error| out.failed(&error))?;
        out.finish()
    }

    /// Whether it is a file that is to be put in its place.
    pub(super) fn is_file(&self) -> bool {
        matches!(self.writer.get_ref(), Target::File(_))
    }

    /// Brings everything to its place, and tells where something else stood there.
    pub(super) fn finish(self) -> Result<(), CommandError> {
        let Self { writer, name, over, .. } = self;
        let done = writer.into_inner().map_err(io::IntoInnerError::into_error);
        let done = done.and_then(|target| match target {
            Target::Stdout(mut stdout) => stdout.flush(),
            Target::Direct(mut file) => file.flush(),
            Target::File(file) => file.finish_on_disk(),
        });
        done.map_err(|error| CommandError::writing(&name, &error))?;
        if over {
            stderr::tell(&format!("{name} is replaced"));
        }
        Ok(())
    }

    /// As messages call it.
    pub(super) fn name(&self) -> &str {
        &self.name
    }

    /// The failure that a write error means.
    pub(super) fn failed(&self, error: &io::Error) -> CommandError {
        CommandError::writing(&self.name, error)
    }
}

impl Write for Output {
    /// Takes whole characters, as `write!` and the writers of JSON give them.
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let text = String::from_utf8_lossy(bytes);
        let safe = match self.form {
            Form::Text => printable::lines(&text),
            Form::Coloured => printable::coloured(&text),
            Form::Json => printable::json(&text),
        };
        self.writer.write_all(safe.as_bytes())?;
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
            Target::Direct(file) => file.write(bytes),
            Target::File(file) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Target::Stdout(stdout) => stdout.flush(),
            Target::Direct(file) => file.flush(),
            Target::File(file) => file.flush(),
        }
    }
}
