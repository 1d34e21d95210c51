//! Every error of the corpus `tests/bad`: each file has its exact expected report beside it.
//! `UPDATE_EXPECT=1` rewrites the reports; review them afterwards.

use std::fs;
use std::path::Path;

use crate::{nonempty, report_corpus};
use phaselab::diagnostic::{Document, Severity};

#[test]
fn each_error_gives_its_report() {
    report_corpus::compare("tests/bad", 40, |document| {
        let diagnostics = document.read().expect_err(&document.path);
        assert!(diagnostics.iter().any(|m| m.severity == Severity::Error), "{}", document.path);
        document.report(&diagnostics, false)
    });
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
    for path in nonempty(report_corpus::files("tests/bad")) {
        let document = Document::open(&path).unwrap();
        for diagnostic in document.read().unwrap_err() {
            let place = diagnostic.place.clone();
            assert!(document.text.get(place).is_some(), "{}: {diagnostic:?}", path.display());
        }
    }
}
