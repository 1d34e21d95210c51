//! The decoder of what a terminal sends: keys, pastes, and what is neither. What takes time, and which reports were asked
//! for, is in the tests of its own file.

use crossterm::event::{Event, KeyEvent};
use phaselab::app::key;
use phaselab::shell::{PASTE_LIMIT, decode};

fn check(bytes: &str, keys: &[KeyEvent]) {
    let expected: Vec<_> = keys.iter().copied().map(Event::Key).collect();
    assert_eq!(decode([bytes.as_bytes()]), expected, "{bytes:?} at once");
    assert_eq!(decode(bytes.as_bytes().chunks(1)), expected, "{bytes:?} in pieces");
}

/// Parses keys by their names.
fn keys(names: &str) -> Vec<KeyEvent> {
    names.split_whitespace().map(|name| key::named(name).expect("a key")).collect()
}

#[test]
fn keys_of_every_kind() {
    check("aZ θ", &keys("a Z Space θ"));
    check("\r\n\t", &keys("Enter Enter Tab"));
    check("\x7f\x08", &keys("Backspace Backspace"));
    check("\x03\x1a\0", &keys("Ctrl-c Ctrl-z Ctrl-Space"));
    check("\x1c\x1f", &keys("Ctrl-\\ Ctrl-_"));
    check("\x1b[A\x1bOA\x1b[D", &keys("Up Up Left"));
    check("\x1b[H\x1b[4~\x1bOF", &keys("Home End End"));
    check("\x1b[5~\x1b[6~\x1b[3~", &keys("PgUp PgDn Delete"));
    check("\x1bOP\x1b[15~\x1b[24~\x1b[[B", &keys("F1 F5 F12 F2"));
    check("\x1b[Z\x1b[1;2C\x1b[1;5A", &keys("Shift-Tab Shift-Right Ctrl-Up"));
    check("\x1bx\x1b\r\x1bé\x1b\x7f", &keys("Alt-x Alt-Enter Alt-é Alt-Backspace"));
    check("\x1bOp\x1bOM", &keys("0 Enter"));
}

#[test]
fn esc_is_a_key_when_nothing_follows() {
    check("\x1b", &keys("Esc"));
    check("\x1b\x1b", &keys("Esc Esc"));
    check("\x1b\x1b[A", &keys("Esc Up"));
    check("\x1bO", &keys("Alt-O"));
}

#[test]
fn an_answer_that_is_not_understood_swallows_no_key() {
    for noise in ["\x1b[?2026;2$y", "\x1b[?997;1n", "\x1b[>1;2c", "\x1b[8;24;80t"] {
        check(&format!("{noise}q"), &keys("q"));
    }
}

#[test]
fn pastes_are_one_event_and_bounded() {
    let paste = |text: &str| vec![Event::Paste(text.to_owned())];
    assert_eq!(decode([b"\x1b[200~q\r2*x\x1b[A\x1b[201~".as_slice()]), paste("q\r2*x"));
    assert_eq!(decode([b"\x1b[200~never ended".as_slice()]), paste("never ended"));
    let long = format!("\x1b[200~{}\x1b[201~", "θ".repeat(500_000));
    assert_eq!(decode([long.as_bytes()]), paste(&"θ".repeat(PASTE_LIMIT / 2)));
}
