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

/// The forms of kitty and of xterm's modifyOtherKeys: what a key is with them is what it is without.
#[test]
fn keys_that_come_by_their_numbers_are_the_same_keys() {
    check("\x1b[13;2u", &keys("Shift-Enter"));
    check("\x1b[27;2;13~", &keys("Shift-Enter"));
    check("\x1b[13;5u\x1b[27;5;13~\x1b[13;3u", &keys("Ctrl-Enter Ctrl-Enter Alt-Enter"));
    check("\x1b[27u\x1b[27;1u\x1b[27;2;9~\x1b[9;2u", &keys("Esc Esc Shift-Tab Shift-Tab"));
    check("\x1b[127u\x1b[127;5u\x1b[13u\x1b[9u", &keys("Backspace Ctrl-Backspace Enter Tab"));
    check("\x1b[99;5u\x1b[27;5;99~\x1b[122;6u", &keys("Ctrl-c Ctrl-c Ctrl-z"));
    check("\x1b[97;3u\x1b[97;4u\x1b[27;4;65~\x1b[49:33;4u", &keys("Alt-a Alt-A Alt-A Alt-!"));
    check("\x1b[113u\x1b[81;2u\x1b[32;2u\x1b[952u", &keys("q Q Space θ"));
    // What a control byte has always been.
    check("\x1b[105;5u\x1b[109;5u\x1b[104;5u\x1b[91;5u", &keys("Tab Enter Backspace Esc"));
    check("\x1b[32;5u\x1b[64;5u", &keys("Ctrl-Space Ctrl-Space"));
    // The keypad, a locked keyboard, a repetition, and the text that was typed.
    check("\x1b[57399u\x1b[57408u\x1b[57414u\x1b[57419u", &keys("0 9 Enter Up"));
    check("\x1b[57409u\x1b[57413u\x1b[57412u", &keys(". + -"));
    check(
        "\x1b[13;66u\x1b[13;130u\x1b[13;2:2u\x1b[97;;97u",
        &keys("Shift-Enter Shift-Enter Shift-Enter a"),
    );
    for nothing in [
        // Released, held with a key of the window manager, or no key of ours.
        "\x1b[13;2:3u",
        "\x1b[97;9u",
        "\x1b[97;33u",
        "\x1b[27;9;13~",
        "\x1b[57358u",
        "\x1b[57376u",
        "\x1b[57441;2u",
        "\x1b[u",
        "\x1b[0u",
        "\x1b[1u",
        "\x1b[128u",
        "\x1b[55296u",
        "\x1b[65535u",
        "\x1b[99999999u",
        "\x1b[27~",
        "\x1b[27;2~",
        "\x1b[27;2;0~",
        "\x1b[27;2;13;4~",
        "\x1b[>1u",
        "\x1b[<1u",
        "\x1b[=1;1u",
        "\x1b[?1u",
        "\x1b[?27;2;13~",
        "\x1b[13;0:3u",
    ] {
        check(&format!("{nothing}q"), &keys("q"));
    }
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
