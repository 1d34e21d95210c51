//! Every error of the corpus `tests/bad`: each file has its exact expected report beside it.
//! `UPDATE_EXPECT=1` rewrites the reports; review them afterwards.

use std::fs;
use std::path::{Path, PathBuf};

use crate::nonempty;
use phaselab::diagnostic::{Document, Severity};

fn corpus() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad");
    let mut files: Vec<PathBuf> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .collect();
    files.sort();
    files
}

#[test]
fn each_error_gives_its_report() {
    let update = std::env::var_os("UPDATE_EXPECT").is_some();
    let files = corpus();
    assert!(files.len() >= 40, "the corpus holds {} files", files.len());
    let mut wrong = Vec::new();
    for path in files {
        let mut document = Document::open(&path).unwrap();
        document.path = format!("{}", path.file_name().unwrap().display());
        let diagnostics = document.read().expect_err(&document.path);
        assert!(diagnostics.iter().any(|m| m.severity == Severity::Error), "{}", document.path);
        let given = document.report(&diagnostics, false);
        let expected = path.with_extension("txt");
        if update {
            fs::write(&expected, given).unwrap();
        } else if fs::read_to_string(&expected).unwrap_or_default() != given {
            wrong.push(given);
        }
    }
    assert!(wrong.is_empty(), "reports that differ:\n\n{}", wrong.join("\n"));
}

#[test]
fn each_expected_report_has_its_file() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad");
    for entry in nonempty(fs::read_dir(folder).unwrap()) {
        let path = entry.unwrap().path();
        assert!(path.with_extension("toml").exists(), "{} belongs to no file", path.display());
    }
}

/// Positions are within the file and on whole characters, and the report names the line and column.
#[test]
fn places_lie_in_the_file() {
    for path in nonempty(corpus()) {
        let document = Document::open(&path).unwrap();
        for diagnostic in document.read().unwrap_err() {
            let place = diagnostic.place.clone();
            assert!(document.text.get(place).is_some(), "{}: {diagnostic:?}", path.display());
        }
    }
}
