//! Recordings: played on the virtual clock, written as casts, and replayed by independent terminals.

mod animation;
mod demos;
mod guided;
mod lessons;
mod performance;
mod projector;
mod replay;
mod schema;
mod scripts;
mod stills;
mod timeline;

use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread::{self, available_parallelism};

use phaselab::diagnostic::Document;
use phaselab::preset::demo;
use phaselab::record::{Recording, Script, play};

use crate::fixtures::catalog;

/// Parses a script.
pub(crate) fn script(text: &str) -> Script {
    let document = Document::new("test.demo", text);
    Script::read(&document)
        .unwrap_or_else(|diagnostics| panic!("{}", document.report(&diagnostics, false)))
}

/// Plays a script of a preset, whose claims all hold.
pub(crate) fn played(preset: &str, text: &str) -> Recording {
    let recording = recorded(preset, text);
    let false_claims = &recording.false_claims;
    let document = Document::new("test.demo", text);
    assert!(false_claims.is_empty(), "{}", document.report(false_claims, false));
    recording
}

/// Plays a script of a preset.
pub(crate) fn recorded(preset: &str, text: &str) -> Recording {
    let document = Document::new("test.demo", text);
    let system = catalog().find(preset).expect("a preset");
    play(&script(text), &system, preset, (80, 24))
        .unwrap_or_else(|diagnostics| panic!("{}", document.report(&diagnostics, false)))
}

/// Plays a preset's own demo.
pub(crate) fn shipped(preset: &str) -> Recording {
    recorded(preset, &demo(preset).expect("a demo").text)
}

/// Does the same with every name, on all cores.
pub(crate) fn on_all_cores(names: &[&str], work: impl Fn(&str) + Sync) {
    let next = AtomicUsize::new(0);
    let cores = available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        for _ in 0..cores.min(names.len()) {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(name) = names.get(index) else { return };
                    work(name);
                }
            });
        }
    });
}
