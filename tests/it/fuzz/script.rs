//! Scripts of demos: errors lie in the text, and a script is read back equal.

use phaselab::diagnostic::Document;
use phaselab::record::Script;

use super::preset::are_placed;

pub(crate) const WORDS: &[&str] = &[
    "Open pendulum\n",
    "Size 80x24\n",
    "Fps 20\n",
    "Wait 2s\n",
    "Press Right\n",
    "Type \"a\"\n",
    "Set m 2\n",
    "Sweep m 1 2 3s\n",
    "Assert energy constant\n",
    "Caption \"",
    "Marker \"",
    "\"",
    "\n",
    "#",
    "x",
    "ms",
    "Ctrl-",
];

pub(crate) fn check(bytes: &[u8]) {
    let document = Document::from_bytes("stranger.demo", bytes);
    match Script::read(&document) {
        Ok(script) => {
            let places: Vec<_> = script.steps.iter().map(|(place, _)| place.clone()).collect();
            assert!(places.iter().all(|place| document.text.get(place.clone()).is_some()));
            assert!(places.is_sorted_by_key(|place| place.start), "{places:?}");
        }
        Err(diagnostics) => are_placed(&document, &diagnostics),
    }
}
