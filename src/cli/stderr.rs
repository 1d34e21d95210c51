//! Messages to the user beside the data: the only access to standard error.
//!
//! Quoted files, names and arguments are already sanitized when they are quoted; all messages are sanitized again
//! here.

use std::io::{IsTerminal, Write, stderr};

use crate::printable;

/// The greatest length of a message, whatever it quotes.
const LONGEST: usize = 8192;

/// Writes a sentence unless it is empty. A failure to write is ignored.
pub(super) fn report(message: &str) {
    if message.is_empty() {
        return;
    }
    let message = printable::shortened(message, LONGEST);
    let _ = writeln!(stderr(), "phaselab: {}", printable::lines(&message));
}

/// Writes a report with our own colours.
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
