//! Fresh files: what is written for long into the current folder; it gets its name when it is whole, and never that of a
//! file that is there.
//!
//! In: a name and bytes, little by little. Out: the file and the name it got (`pendulum.cast`, else `pendulum-2.cast`, …).
//! Never here: what the bytes mean; files that are written at once (`product`).

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// A file that is being written under another name.
#[derive(Debug)]
pub(super) struct Fresh {
    writer: Option<BufWriter<File>>,
    partial: PathBuf,
    stem: String,
    ending: &'static str,
}

/// How many names are tried.
const NAMES: u32 = 10_000;

impl Fresh {
    /// Begins a file in the current folder; `stem` is what of its name stands before the ending.
    pub(super) fn begin(stem: &str, ending: &'static str) -> io::Result<Fresh> {
        Fresh::within(Path::new(""), stem, ending)
    }

    fn within(folder: &Path, stem: &str, ending: &'static str) -> io::Result<Fresh> {
        let stem = plain(stem);
        let partial = folder.join(format!(".{stem}.{}.{ending}.partial", std::process::id()));
        let file = File::create(&partial).map_err(|why| told(&partial, &why))?;
        Ok(Fresh { writer: Some(BufWriter::new(file)), partial, stem, ending })
    }

    /// Gives it its name, which is returned.
    pub(super) fn finish(mut self) -> io::Result<String> {
        let written = match self.writer.take() {
            Some(mut writer) => writer.flush(),
            None => Ok(()),
        };
        written.map_err(|why| told(&self.partial, &why))?;
        let folder = self.partial.parent().unwrap_or(Path::new(""));
        for number in 1..=NAMES {
            let name = match number {
                1 => format!("{}.{}", self.stem, self.ending),
                n => format!("{}-{n}.{}", self.stem, self.ending),
            };
            let path = folder.join(&name);
            // a link is refused where the name is taken; a rename would not be
            match fs::hard_link(&self.partial, &path) {
                Ok(()) => return Ok(name),
                Err(why) if why.kind() == io::ErrorKind::AlreadyExists => {}
                Err(_) if !path.exists() => {
                    // there are file systems without links
                    return fs::rename(&self.partial, &path)
                        .map(|()| name)
                        .map_err(|why| told(&path, &why));
                }
                Err(_) => {}
            }
        }
        Err(io::Error::other(format!("there are {NAMES} files named after {}", self.stem)))
    }
}

impl Write for Fresh {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.writer.as_mut().map_or(Ok(bytes.len()), |writer| writer.write(bytes))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.as_mut().map_or(Ok(()), Write::flush)
    }
}

impl Drop for Fresh {
    /// What is not finished leaves nothing behind, and neither does the name it was written under.
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.partial);
    }
}

/// The last part of a name, without what a file's name should not hold.
fn plain(name: &str) -> String {
    let last = Path::new(name).file_stem().map_or(String::new(), |s| s.to_string_lossy().into());
    let kept: String = last.chars().filter(|c| !c.is_control() && !"/\\:".contains(*c)).collect();
    if kept.is_empty() { "phaselab".to_owned() } else { kept }
}

/// The error with the file's name.
fn told(path: &Path, why: &io::Error) -> io::Error {
    io::Error::new(why.kind(), format!("cannot write {}: {why}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_written_over() {
        let folder = tempfile::tempdir().expect("a folder");
        let write = |text: &str| {
            let mut file = Fresh::within(folder.path(), "my/pendulum.toml", "svg").expect("begun");
            file.write_all(text.as_bytes()).expect("written");
            file.finish().expect("finished")
        };
        assert_eq!([write("one"), write("two")], ["pendulum.svg", "pendulum-2.svg"]);
        let read = |name: &str| fs::read_to_string(folder.path().join(name)).expect("a file");
        assert_eq!((read("pendulum.svg"), read("pendulum-2.svg")), ("one".into(), "two".into()));
        drop(Fresh::within(folder.path(), "given up", "cast").expect("begun"));
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 2);
    }
}
