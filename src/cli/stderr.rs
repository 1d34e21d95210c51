//! What is told to the person beside the data: the one way to standard error.
//!
//! Whoever quotes a file, a name or an argument has cleaned it where it is quoted; here it is done once more, for all.

use std::io::{IsTerminal, Write, stderr};

use crate::printable;

/// The most characters of one message: whatever it quotes, a person is to read it.
const LONGEST: usize = 8192;

/// Tells a sentence, unless it is empty. Whether anybody hears it changes nothing.
pub(super) fn tell(message: &str) {
    if message.is_empty() {
        return;
    }
    let message = printable::shortened(message, LONGEST);
    let _ = writeln!(stderr(), "phaselab: {}", printable::lines(&message));
}

/// Shows a report; its colours are ours.
pub(super) fn show(text: &str) {
    let text = if has_colour() { printable::coloured(text) } else { printable::lines(text) };
    let _ = stderr().write_all(text.as_bytes());
}

/// Whether standard error is a terminal that wants colour (<https://no-color.org>).
pub(super) fn has_colour() -> bool {
    let set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
    stderr().is_terminal() && !dumb && !set("NO_COLOR")
}
