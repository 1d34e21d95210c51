//! Where a command's data goes: standard output, or a file that appears whole or not at all.
//!
//! In: bytes. Out: a file or a stream. Never here: what the bytes mean.

use std::fs::{self, File};
use std::io::{self, BufWriter, Stdout, Write};
use std::path::Path;

use super::failure::Failure;
use super::stderr;
use crate::shell::whole::Whole;

/// A place for data.
#[derive(Debug)]
pub(super) struct Output {
    writer: BufWriter<Target>,
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
    pub(super) fn open(path: Option<&Path>) -> Result<Output, Failure> {
        let Some(path) = path else {
            let writer = BufWriter::new(Target::Stdout(io::stdout()));
            return Ok(Output { writer, name: "standard output".to_owned(), over: false });
        };
        let name = path.display().to_string();
        let about = fs::metadata(path);
        let direct = about.as_ref().is_ok_and(|about| !about.is_file());
        let over = about.is_ok_and(|about| about.is_file() && about.len() > 0);
        let target = if direct {
            File::options().write(true).open(path).map(Target::Direct)
        } else {
            Whole::begin(path).map(Target::File)
        };
        let target = target.map_err(|error| Failure::writing(&name, &error))?;
        Ok(Output { writer: BufWriter::new(target), name, over })
    }

    /// Brings everything to its place, and tells where something else stood there.
    pub(super) fn finish(self) -> Result<(), Failure> {
        let Self { writer, name, over } = self;
        let done = writer.into_inner().map_err(io::IntoInnerError::into_error);
        let done = done.and_then(|target| match target {
            Target::Stdout(mut stdout) => stdout.flush(),
            Target::Direct(mut file) => file.flush(),
            Target::File(file) => file.finish(),
        });
        done.map_err(|error| Failure::writing(&name, &error))?;
        if over {
            stderr::tell(&format!("{name} is replaced"));
        }
        Ok(())
    }

    /// The failure that a write error means.
    pub(super) fn failed(&self, error: &io::Error) -> Failure {
        Failure::writing(&self.name, error)
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.writer.write(bytes)
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
