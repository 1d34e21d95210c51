//! Where a command's data goes: standard output, or a file that appears whole or not at all.
//!
//! In: bytes. Out: a file or a stream. Never here: what the bytes mean.

use std::fs::{self, File};
use std::io::{self, BufWriter, Stdout, Write};
use std::path::{Path, PathBuf};

use super::failure::Failure;
use super::stderr;

/// A place for data.
#[derive(Debug)]
pub(super) struct Output {
    writer: BufWriter<Target>,
    /// As messages call it.
    name: String,
    /// The file under its final name, where the writer fills one beside it.
    replaces: Option<(PathBuf, PathBuf)>,
    /// Whether a file with something in it stands there already.
    over: bool,
}

#[derive(Debug)]
enum Target {
    Stdout(Stdout),
    File(File),
}

impl Output {
    /// Standard output, or the file of that path. A regular file is written under another name
    /// beside it and takes its place at [`Output::finish`], so that a failure leaves an old file
    /// as it was; a device or a pipe is written directly.
    pub(super) fn open(path: Option<&Path>) -> Result<Output, Failure> {
        let Some(path) = path else {
            let writer = BufWriter::new(Target::Stdout(io::stdout()));
            let name = "standard output".to_owned();
            return Ok(Output { writer, name, replaces: None, over: false });
        };
        let name = path.display().to_string();
        // a link keeps pointing where it points
        let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let about = fs::metadata(&path);
        let direct = about.as_ref().is_ok_and(|about| !about.is_file());
        let over = about.is_ok_and(|about| about.is_file() && about.len() > 0);
        let partial = partial_name(&path);
        let place = if direct { &path } else { &partial };
        let file =
            if direct { File::options().write(true).open(place) } else { File::create(place) }
                .map_err(|error| Failure::writing(&name, &error))?;
        let writer = BufWriter::new(Target::File(file));
        Ok(Output { writer, name, replaces: (!direct).then_some((partial, path)), over })
    }

    /// Brings everything to its place, and tells where something else stood there.
    pub(super) fn finish(mut self) -> Result<(), Failure> {
        let done = self.writer.flush().and_then(|()| match self.replaces.take() {
            None => Ok(()),
            Some((partial, path)) => fs::rename(&partial, path).inspect_err(|_| {
                // the error that matters is the one on its way
                let _ = fs::remove_file(&partial);
            }),
        });
        done.map_err(|error| Failure::writing(&self.name, &error))?;
        if self.over {
            stderr::tell(&format!("{} is replaced", self.name));
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

impl Drop for Output {
    /// An output that was not finished leaves nothing behind.
    fn drop(&mut self) {
        if let Some((partial, _)) = self.replaces.take() {
            let _ = fs::remove_file(partial);
        }
    }
}

impl Write for Target {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Target::Stdout(stdout) => stdout.write(bytes),
            Target::File(file) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Target::Stdout(stdout) => stdout.flush(),
            Target::File(file) => file.flush(),
        }
    }
}

/// `.out.csv.1234.partial` beside `out.csv`.
fn partial_name(path: &Path) -> PathBuf {
    let file = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{file}.{}.partial", std::process::id()))
}
