//! Files that a key asks for: put beside what is there, never over it, whole or not at all.
//!
//! In: a name and bytes. Out: the path it was given. Never here: what is in them.

use std::fs::{self, File};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// How many files of one name there may be.
const MOST: u32 = 9999;

/// Writes `heavy-top.toml` or, where there is one, `heavy-top-2.toml`, …
///
/// # Errors
/// Where it cannot be written; the error names the file, and nothing is left of it.
pub(super) fn put(folder: &Path, stem: &str, ending: &str, bytes: &[u8]) -> io::Result<PathBuf> {
    for count in 1..=MOST {
        let name = match count {
            1 => format!("{stem}.{ending}"),
            n => format!("{stem}-{n}.{ending}"),
        };
        let path = folder.join(name);
        let named = |error: io::Error| {
            io::Error::new(error.kind(), format!("cannot write {}: {error}", path.display()))
        };
        match File::create_new(&path) {
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
            Err(error) => return Err(named(error)),
            Ok(mut file) => {
                let written = file.write_all(bytes).and_then(|()| file.sync_all());
                return written.map(|()| path.clone()).map_err(|error| {
                    // The error that matters is the one on its way.
                    let _ = fs::remove_file(&path);
                    named(error)
                });
            }
        }
    }
    Err(io::Error::other(format!("there are {MOST} files called {stem}.{ending} already")))
}

/// What files made of a preset or file are called: its name without folders and ending.
pub(super) fn stem(name: &str) -> &str {
    Path::new(name).file_stem().and_then(|stem| stem.to_str()).unwrap_or("phaselab")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_written_over() {
        let folder = tempfile::tempdir().expect("a folder");
        let names: Vec<_> = (0..3)
            .map(|n| put(folder.path(), "top", "toml", &[n]).expect("it is written"))
            .map(|path| path.file_name().expect("a name").to_owned())
            .collect();
        assert_eq!(names, ["top.toml", "top-2.toml", "top-3.toml"]);
        assert_eq!(fs::read(folder.path().join("top.toml")).expect("it is there"), [0]);
    }

    #[test]
    fn what_cannot_be_written_is_named() {
        let error = put(Path::new("/nowhere/at/all"), "top", "svg", b"").expect_err("no folder");
        assert!(error.to_string().contains("cannot write /nowhere/at/all/top.svg"), "{error}");
    }

    #[test]
    fn names_come_from_presets_and_paths() {
        assert_eq!((stem("heavy-top"), stem("my/own.system.toml")), ("heavy-top", "own.system"));
    }
}
