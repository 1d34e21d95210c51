//! What is told to the person beside the data.

use std::io::{IsTerminal, Write, stderr};

/// Tells a sentence, unless it is empty. Whether anybody hears it changes nothing.
pub(super) fn tell(message: &str) {
    if !message.is_empty() {
        let _ = writeln!(stderr(), "phaselab: {message}");
    }
}

/// Shows text as it is.
pub(super) fn show(text: &str) {
    let _ = stderr().write_all(text.as_bytes());
}

/// Whether standard error is a terminal that wants colour (<https://no-color.org>).
pub(super) fn has_colour() -> bool {
    let set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
    stderr().is_terminal() && !dumb && !set("NO_COLOR")
}
