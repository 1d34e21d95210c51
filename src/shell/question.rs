//! The questions that a terminal is asked once, at the start: the colour of its background, and whether it knows the keyboard
//! protocol of kitty.
//!
//! In: the environment. Out: which questions are asked, their bytes, the answers. Never here: waiting for an answer, or what is
//! done with it.
//!
//! The request for the device's attributes (DA1), which nearly every terminal answers, follows the others: since a terminal
//! answers in order, whoever answers DA1 first has nothing to say to them.

use crate::view::colour::Rgb;

/// What a terminal is asked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Questions {
    /// The colour of its background.
    pub background: bool,
    /// Whether it knows the keyboard protocol of kitty, which distinguishes keys that have the same bytes otherwise, such as
    /// Enter and Shift-Enter.
    pub keyboard: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TerminalReply {
    Background(Rgb),
    /// It knows the keyboard protocol.
    Keyboard,
}

/// The flags of the keyboard protocol.
const KEYBOARD: &[u8] = b"\x1b[?u";

/// OSC 11. It ends in BEL, because the urxvt that is in use ends its answer as the question ended, and forgets half of ST.
const BACKGROUND: &[u8] = b"\x1b]11;?\x07";

/// DA1.
const ATTRIBUTES: &[u8] = b"\x1b[c";

impl Questions {
    /// Whether anything is asked.
    pub(super) fn any(self) -> bool {
        self.background || self.keyboard
    }

    pub(super) fn bytes(self) -> Vec<u8> {
        let asked = [(self.keyboard, KEYBOARD), (self.background, BACKGROUND)];
        let asked = asked.into_iter().filter(|(asked, _)| *asked).map(|(_, bytes)| bytes);
        if self.any() { asked.chain([ATTRIBUTES]).collect::<Vec<_>>().concat() } else { Vec::new() }
    }
}

/// Whether the terminal can be asked; `variable` reads the environment.
///
/// The console of Linux does not know OSC and shows the rest of it. GNU screen passes the question on and answers DA1
/// itself, so that its answer would come when none is expected.
pub(super) fn can_be_asked(variable: &dyn Fn(&str) -> Option<String>) -> bool {
    let term = variable("TERM").unwrap_or_default();
    let inside_screen = variable("STY").is_some_and(|name| !name.is_empty());
    let silent = matches!(term.as_str(), "" | "dumb" | "linux" | "screen" | "vt100" | "vt220");
    !silent && !term.starts_with("screen.") && !inside_screen
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_attributes_are_asked_for_after_anything_else_and_never_alone() {
        let bytes = |background, keyboard| Questions { background, keyboard }.bytes();
        assert_eq!(bytes(true, true), b"\x1b[?u\x1b]11;?\x07\x1b[c");
        assert_eq!(bytes(true, false), b"\x1b]11;?\x07\x1b[c");
        assert_eq!(bytes(false, true), b"\x1b[?u\x1b[c");
        assert_eq!(bytes(false, false), b"");
    }

    #[test]
    fn a_terminal_that_would_show_the_question_is_not_asked() {
        let asked = |environment: &[(&str, &str)]| {
            can_be_asked(&|name| {
                let found = environment.iter().find(|(other, _)| *other == name);
                found.map(|(_, value)| (*value).to_owned())
            })
        };
        for term in ["xterm-256color", "tmux-256color", "screen-256color", "foot", "rxvt-unicode"] {
            assert!(asked(&[("TERM", term)]), "{term}");
            assert!(!asked(&[("TERM", term), ("STY", "1.pts")]), "{term} in screen");
        }
        for term in ["", "dumb", "linux", "screen", "screen.xterm-256color", "vt100"] {
            assert!(!asked(&[("TERM", term)]), "{term}");
        }
        assert!(!asked(&[]));
    }
}
