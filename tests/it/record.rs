//! Recordings: played on the virtual clock, written as casts, replayed by terminals that know nothing of them.

mod demos;
mod performance;
mod projector;
mod replay;
mod schema;
mod scripts;
mod stills;

use phaselab::diagnostic::Document;
use phaselab::preset::{Catalog, demo};
use phaselab::record::{Recording, Script, play};

/// The script of a text.
pub(crate) fn script(text: &str) -> Script {
    let document = Document::new("test.demo", text);
    Script::read(&document)
        .unwrap_or_else(|mistakes| panic!("{}", document.report(&mistakes, false)))
}

/// A script of a preset, played.
pub(crate) fn played(preset: &str, text: &str) -> Recording {
    let document = Document::new("test.demo", text);
    let system = Catalog::with_folder(None).find(preset).expect("a preset");
    play(&script(text), &system, preset, (80, 24))
        .unwrap_or_else(|mistakes| panic!("{}", document.report(&mistakes, false)))
}

/// A preset's own demo, played.
pub(crate) fn shipped(preset: &str) -> Recording {
    played(preset, &demo(preset).expect("a demo").text)
}
