//! Folders of wrong files, each with its exact expected report beside it.

use std::fs;
use std::path::{Path, PathBuf};

use phaselab::diagnostic::Document;

/// The files of a folder of the repository, in order.
pub(crate) fn files(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let files = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> =
        files.filter(|path| path.extension().is_some_and(|e| e == "toml")).collect();
    files.sort();
    files
}

/// Compares the report on each of at least so many files with the expected one; `UPDATE_EXPECT=1` rewrites these.
pub(crate) fn compare(folder: &str, least: usize, report: impl Fn(&Document) -> String) {
    let update = std::env::var_os("UPDATE_EXPECT").is_some();
    let files = files(folder);
    assert!(files.len() >= least, "the corpus holds {} files", files.len());
    let mut wrong = Vec::new();
    for path in files {
        let mut document = Document::open(&path).unwrap();
        document.path = format!("{}", path.file_name().unwrap().display());
        let given = report(&document);
        let expected = path.with_extension("txt");
        if update {
            fs::write(&expected, given).unwrap();
        } else if fs::read_to_string(&expected).unwrap_or_default() != given {
            wrong.push(given);
        }
    }
    assert!(wrong.is_empty(), "reports that differ:\n\n{}", wrong.join("\n"));
}
