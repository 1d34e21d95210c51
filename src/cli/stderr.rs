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
    let message = without_number(message);
    let message = printable::shortened(message, LONGEST);
    let _ = writeln!(stderr(), "phaselab: {}", printable::lines(&message));
}

/// The system's number of an error, at the end of its sentence, says nothing to a person.
fn without_number(message: &str) -> &str {
    let Some((sentence, number)) = message.rsplit_once(" (os error ") else { return message };
    let digits = number.strip_suffix(')').unwrap_or_default();
    let is_number = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
    if is_number { sentence } else { message }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_systems_number_is_left_out() {
        assert_eq!(
            without_number("cannot write x: No space (os error 28)"),
            "cannot write x: No space"
        );
        for whole in ["x", "x (os error 28) y", "x (os error )", "x (os error 2"] {
            assert_eq!(without_number(whole), whole);
        }
    }
}
