//! What the mouse does, for the help: the words only; `pointer` carries it out.
//!
//! In: nothing. Out: a table. Never here: events.

/// The title of the table on the help page.
pub const MOUSE: &str = "Mouse";

/// What a hand does with the mouse, and what follows.
#[rustfmt::skip]
pub const GESTURES: &[(&str, &str)] = &[
    ("click", "in a phase portrait or a section: begin the motion there; in any other plot: put the cursor there"),
    ("Shift-click", "or the right button: add a motion beside the others that begins there"),
    ("drag", "a slider: change the value; a plot: move its window; a picture in space: turn it; a part of a plane one: move it; a mass in a plane: place it, and start from rest; the time bar: look at the past"),
    ("wheel", "zoom a plot or a picture at the mouse; scroll a text or a list"),
    ("click", "a tab, a page or a key of the last line: the same as its key; a value that is selected: type it"),
    ("M", "leave the mouse to the terminal, to select text; again: use it here"),
];
