//! Files that a key asks for: put beside what is there, never over it, whole or not at all.
//!
//! In: a name and bytes. Out: the path it was given. Never here: what is in them.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::fresh::Fresh;

/// Writes `heavy-top.toml` or, where there is one, `heavy-top-2.toml`, … and returns its path.
///
/// # Errors
/// Where it cannot be written; the error names the file, and nothing is left of it.
pub(super) fn put(
    folder: &Path,
    stem: &str,
    ending: &'static str,
    bytes: &[u8],
) -> io::Result<PathBuf> {
    let mut file = Fresh::within(folder, stem, ending)?;
    file.write_all(bytes)?;
    // not finished before it is whole, or it would get its name all the same
    file.sync()?;
    Ok(folder.join(file.finish()?))
}

/// What files made of a preset or file are called: its name without folders and ending.
pub(super) fn stem(name: &str) -> &str {
    Path::new(name).file_stem().and_then(|stem| stem.to_str()).unwrap_or("phaselab")
}

#[cfg(test)]
mod tests {
    use std::fs;

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
