//! The targets of untrusted input: one row each, with the properties that every input must satisfy.

use std::fs;
use std::path::{Path, PathBuf};

use phaselab::shell::config;

use super::{cast, configuration, expression, preset, script, session, terminal};

/// One kind of input.
pub(crate) struct Target {
    /// Its name, and the name of its folder in `tests/corpus`.
    pub(crate) name: &'static str,
    /// Folders whose files are also inputs, relative to the root of the package.
    folders: &'static [&'static str],
    /// Inputs that the program itself writes.
    own: fn() -> Vec<String>,
    /// Keywords of its inputs.
    pub(crate) words: &'static [&'static str],
    /// The number of mutated inputs in every run of the tests.
    pub(crate) cases: u64,
    /// Checks an input; panics if a property is violated.
    pub(crate) check: fn(&[u8]),
}

pub(crate) const TARGETS: [Target; 7] = [
    Target {
        name: "presets",
        folders: &["presets", "tests/bad"],
        own: Vec::new,
        words: preset::WORDS,
        cases: 200,
        check: preset::check,
    },
    Target {
        name: "expressions",
        folders: &[],
        own: Vec::new,
        words: expression::WORDS,
        cases: 2000,
        check: expression::check,
    },
    Target {
        name: "input",
        folders: &[],
        own: Vec::new,
        words: terminal::WORDS,
        cases: 200,
        check: terminal::check,
    },
    Target {
        name: "casts",
        folders: &[],
        own: Vec::new,
        words: cast::WORDS,
        cases: 300,
        check: cast::check,
    },
    Target {
        name: "sessions",
        folders: &[],
        own: session::own,
        words: session::WORDS,
        cases: 200,
        check: session::check,
    },
    Target {
        name: "configuration",
        folders: &["tests/bad-config"],
        own: || vec![config::default_text()],
        words: configuration::WORDS,
        cases: 2000,
        check: configuration::check,
    },
    Target {
        name: "scripts",
        folders: &["presets/demos"],
        own: Vec::new,
        words: script::WORDS,
        cases: 1000,
        check: script::check,
    },
];

impl Target {
    /// Its seed inputs and the paths of their files.
    pub(crate) fn corpus(&self) -> Vec<(PathBuf, Vec<u8>)> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let own = format!("tests/corpus/{}", self.name);
        let mut places = Vec::new();
        for folder in [own.as_str()].iter().chain(self.folders) {
            files(&root.join(folder), &mut places);
        }
        places.sort();
        let kept = places.into_iter().map(|place| (place.clone(), fs::read(place).unwrap()));
        let own = (self.own)().into_iter().map(|text| ("what it writes".into(), text.into_bytes()));
        kept.chain(own).collect()
    }
}

fn files(folder: &Path, places: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap_or_else(|why| panic!("{}: {why}", folder.display())) {
        let place = entry.unwrap().path();
        if place.is_dir() {
            files(&place, places);
        } else {
            places.push(place);
        }
    }
}
