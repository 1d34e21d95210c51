//! The terminal's clipboard: whether there is one, and a text put into it.
//!
//! In: the environment, a text. Out: bytes for the terminal (OSC 52). Never here: reading a clipboard, which a stranger's
//! file could ask for, or a query: a terminal that has none would show it.

use std::io::{self, Write};

use crossterm::clipboard::CopyToClipboard;
use crossterm::queue;

/// The longest text that is copied, in bytes: encoded it fits in the 74 994 bytes that terminals take.
pub(super) const MOST: usize = 56_000;

/// Terminals that put what OSC 52 sends into the clipboard, by the beginnings of `TERM` and of `TERM_PROGRAM`.
const TERMS: [&str; 7] =
    ["alacritty", "contour", "foot", "rio", "wezterm", "xterm-ghostty", "xterm-kitty"];
const PROGRAMS: [&str; 8] =
    ["WezTerm", "WindowsTerminal", "contour", "ghostty", "kitty", "mintty", "rio", "vscode"];

/// Whether the terminal of this environment is known to have a clipboard. tmux, unless it is told otherwise, ignores what
/// programs send for one, whatever terminal it runs in.
pub(super) fn is_there(variable: &dyn Fn(&str) -> Option<String>) -> bool {
    let begins = |name: &str, known: &[&str]| {
        variable(name).is_some_and(|value| known.iter().any(|known| value.starts_with(known)))
    };
    let windows = variable("WT_SESSION").is_some_and(|value| !value.is_empty());
    let tmux = variable("TMUX").is_some_and(|value| !value.is_empty());
    !tmux && (windows || begins("TERM", &TERMS) || begins("TERM_PROGRAM", &PROGRAMS))
}

pub(super) fn write(text: &str, mut out: impl Write) -> io::Result<()> {
    queue!(out, CopyToClipboard::to_clipboard_from(text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clipboard_is_used_where_it_is_known_to_be() {
        let known = |name: &'static str, value: &'static str| {
            is_there(&move |asked: &str| (asked == name).then(|| value.to_owned()))
        };
        assert!(known("TERM", "xterm-kitty") && known("TERM", "foot-extra"));
        assert!(known("TERM_PROGRAM", "WezTerm") && known("WT_SESSION", "a"));
        assert!(!known("TERM", "xterm-256color") && !known("TERM", "linux"));
        assert!(!known("TERM_PROGRAM", "Apple_Terminal") && !known("WT_SESSION", ""));
        assert!(!known("TERM", "tmux-256color"));
        let in_tmux = |asked: &str| match asked {
            "TMUX" => Some("/tmp/tmux-0/default,1,0".to_owned()),
            "WT_SESSION" => Some("a".to_owned()),
            _ => None,
        };
        assert!(!is_there(&in_tmux));
    }

    /// The bytes of the sequence, with the text in base64 (RFC 4648, its own example).
    #[test]
    fn a_text_is_sent_in_base64() {
        let mut bytes = Vec::new();
        write("foobar", &mut bytes).expect("memory");
        assert_eq!(bytes, b"\x1b]52;c;Zm9vYmFy\x1b\\");
    }
}
