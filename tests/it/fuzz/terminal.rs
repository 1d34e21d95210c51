//! Terminal bytes: the result does not depend on how they are split, and the laboratory can be drawn after any of them.

use std::sync::OnceLock;

use crossterm::event::Event as Input;
use phaselab::app::{App, AppEvent};
use phaselab::shell::decode;
use phaselab::view::{draw, hit_targets};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::fixtures::in_lab;
use crate::screen::rich;

pub(crate) const WORDS: &[&str] = &[
    "\x1b",
    "\x1b[",
    "\x1b[A",
    "\x1b[1;5C",
    "\x1bOP",
    "\x1b[15~",
    "\x1b[200~",
    "\x1b[201~",
    "\x1b[<0;40;12M",
    "\x1b[<32;41;13M",
    "\x1b[<0;41;13m",
    "\x1b[<64;9;9M",
    "\x1b[I",
    "\x1b[O",
    "\x1b]11;",
    "\x07",
    "\x1bP",
    "\x1b\\",
    "\x18",
    "q",
    "\r",
    "\t",
    "\x7f",
    ":",
    "/",
    "?",
    "m",
    "v",
    "E",
    "2",
    "9",
    "l",
    "+",
    " ",
    "é",
    "θ",
];

/// The screen.
const AREA: Rect = Rect::new(0, 0, 80, 24);

/// The lab. Its jobs, which take nearly all of the time, are done for one input of ten, so that answers come in too; elsewhere they are
/// only asked for.
fn lab(bytes: &[u8]) -> App {
    static LAB: OnceLock<App> = OnceLock::new();
    let mut app = LAB.get_or_init(in_lab).clone();
    app.jobs.in_background = !bytes.len().is_multiple_of(10);
    app
}

pub(crate) fn check(bytes: &[u8]) {
    let inputs = decode([bytes]);
    let size = 1 + bytes.len() % 7;
    assert_eq!(decode(bytes.chunks(size)), inputs, "in pieces of {size}");
    assert!(inputs.len() <= bytes.len(), "more inputs than bytes");
    let mut app = lab(bytes);
    for input in inputs.into_iter().take(200) {
        let event = match input {
            Input::Key(key) => AppEvent::Key(key),
            Input::Paste(text) => AppEvent::Paste(text),
            Input::Mouse(mouse) => {
                let targets = hit_targets(&app, &rich(), AREA);
                let Some(target) = targets.at(mouse.column, mouse.row) else { continue };
                AppEvent::Mouse(mouse.kind, target)
            }
            Input::FocusGained | Input::FocusLost | Input::Resize(..) => continue,
        };
        app.update(event);
    }
    draw(&app, &rich(), AREA, &mut Buffer::empty(AREA));
}
