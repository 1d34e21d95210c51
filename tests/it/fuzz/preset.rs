//! Presets: errors lie in the text; a valid file runs or reports why not, and is still valid after it is written.

use phaselab::diagnostic::{Diagnostic, Document};
use phaselab::experiment::{Export, Prepared};

pub(crate) const WORDS: &[&str] = &[
    "[coordinates]\n",
    "[parameters]\n",
    "[lagrangian]\n",
    "[[views]]\n",
    "[[events]]\n",
    "[[impulses]]\n",
    "[run]\n",
    "initial = ",
    "velocity = ",
    "until = ",
    "= ",
    "\"",
    "'",
    "{",
    "}",
    "[",
    "]",
    ",",
    "\n",
    "sin(",
    "sqrt(",
    ")",
    "^2",
    "/",
    "theta'",
    "t",
    "-",
    "1/2*",
    "true",
    "'''",
    "\"\"\"",
    "#",
    "\\",
];

/// One of this many valid short inputs is also run.
const RUN: u64 = 4;
const SHORT: usize = 3000;

/// Asserts that there are errors, and that each lies in the text and can be rendered.
pub(super) fn are_placed(document: &Document, diagnostics: &[Diagnostic]) {
    assert!(!diagnostics.is_empty());
    for diagnostic in diagnostics {
        assert!(document.text.get(diagnostic.place.clone()).is_some(), "{diagnostic:?}");
    }
    let drawn = document.report(diagnostics, false);
    assert_eq!(drawn.matches(&format!("{}:", document.path)).count(), diagnostics.len(), "{drawn}");
}

pub(crate) fn check(bytes: &[u8]) {
    let document = Document::from_bytes("stranger.toml", bytes);
    match document.read() {
        Err(diagnostics) => return are_placed(&document, &diagnostics),
        Ok(checked) if checked.warnings.is_empty() => {}
        Ok(checked) => are_placed(&document, &checked.warnings),
    }
    let sum =
        bytes.iter().fold(0_u64, |sum, byte| sum.wrapping_mul(31).wrapping_add((*byte).into()));
    if bytes.len() > SHORT || sum % RUN != 0 {
        return;
    }
    let mut experiment = match Prepared::of(&document) {
        Ok(ready) => ready.experiment,
        Err(why) => return assert!(!why.report.is_empty() && !why.diagnostics.is_empty()),
    };
    let frame = experiment.time() + 0.02 * experiment.speed().min(1e3);
    experiment.advance(frame, 20);
    let parts = (&**experiment.model(), experiment.system());
    if let Ok(export) = Export::of(&document, parts, &experiment.snapshot()) {
        let written = Document::new("written.toml", export.text.as_str());
        let diagnostics = written.read().err().unwrap_or_default();
        assert!(diagnostics.is_empty(), "{}", written.report(&diagnostics, false));
    }
}
