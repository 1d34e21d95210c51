//! The editor: a text, keys, and the resulting text.

use phaselab::app::{Caret, Editor};
use proptest::prelude::*;

use crate::fixtures::key;

const LIMIT: usize = 1 << 20;

/// Presses keys written as words; `|` marks the cursor in a text.
fn check(before: &str, keys: &str, after: &str) {
    let mut editor = at(before);
    for word in keys.split_whitespace() {
        match word {
            "Undo" => drop(editor.undo()),
            "Redo" => drop(editor.redo()),
            "Cut" => drop(editor.cut()),
            "Copy" => editor.copy(),
            "Put" => drop(editor.put_back()),
            word => drop(editor.press(key(word), 2)),
        }
    }
    assert_eq!(shown(&editor), after, "{before:?} after {keys}");
}

fn at(marked: &str) -> Editor {
    let byte = marked.find('|').expect("a cursor");
    let mut editor = Editor::new(&marked.replace('|', ""), LIMIT);
    let caret = editor.caret_at(byte);
    editor.go(caret);
    editor
}

fn shown(editor: &Editor) -> String {
    let Caret { row, column } = editor.cursor();
    let mut lines = editor.lines().to_vec();
    let byte = lines[row].char_indices().nth(column).map_or(lines[row].len(), |(at, _)| at);
    lines[row].insert(byte, '|');
    lines.join("\n")
}

#[test]
fn keys_type_and_erase() {
    check("ab|", "c", "abc|");
    check("a|b", "θ Space x", "aθ x|b");
    check("a|b", "Enter", "a\n|b");
    check("  a|b", "Enter", "  a\n  |b");
    check("a|", "Tab b", "a   b|");
    check("ab|c", "Backspace", "a|c");
    check("a\n|b", "Backspace", "a|b");
    check("|a", "Backspace", "|a");
    check("a|\nb", "Delete", "a|b");
    check("a|", "Delete", "a|");
    check("one two|", "Ctrl-w", "one |");
    check("|one two", "Ctrl-Delete", "| two");
}

#[test]
fn keys_move() {
    check("ab\nc|", "Left Left", "ab|\nc");
    check("ab|\nc", "Right", "ab\n|c");
    check("abcd|\nx\nabcd", "Down Down", "abcd\nx\nabcd|");
    check("ab|\nc", "Up", "|ab\nc");
    check("ab\n|c", "Down", "ab\nc|");
    check("  ab|", "Home", "  |ab");
    check("  ab|", "Home Home", "|  ab");
    check("|ab\nc", "End", "ab|\nc");
    check("ab\nc|", "Ctrl-Home", "|ab\nc");
    check("|ab\nc", "Ctrl-End", "ab\nc|");
    check("one two_3|.", "Ctrl-Left", "one |two_3.");
    check("|one two", "Ctrl-Right", "one| two");
    check("1\n2\n3\n4|", "PageUp", "1\n2|\n3\n4");
    check("1|\n2\n3\n4", "PageDown", "1\n2\n3|\n4");
}

#[test]
fn what_is_selected_is_replaced_cut_and_copied() {
    check("|abc", "Shift-Right Shift-Right x", "x|c");
    check("a\n|b", "Shift-Up Backspace", "|b");
    check("|abc", "Shift-Right Cut Put Put", "aa|bc");
    check("|abc", "Shift-End Copy End Put", "abcabc|");
    check("one\nt|wo\nthree", "Cut", "one\n|three");
    check("one\nt|wo", "Copy Ctrl-End Enter Put", "one\ntwo\ntwo|");
    check("|abc", "Shift-Right Right Backspace", "a|c");
}

#[test]
fn words_are_taken_back_together() {
    check("|", "a b Undo", "|");
    check("|", "a b Space c d Undo", "ab |");
    check("|", "a b Space c d Undo Undo", "|");
    check("|", "a Left b Undo", "|a");
    check("abc|", "Backspace Backspace Undo", "ab|");
    check("|", "a b Undo Redo", "ab|");
    check("|ab", "Shift-Right x Undo", "a|b");
    check("|", "a Undo b Redo", "b|");
}

#[test]
fn words_are_found_from_the_cursor_on_and_round_again() {
    let mut editor = Editor::new("Mass m\nlength l\nmass 2", LIMIT);
    let mut places = Vec::new();
    for _ in 0..3 {
        assert!(editor.find("mass"));
        places.push(editor.selection().expect("it is selected").0);
    }
    let caret = |row, column| Caret { row, column };
    assert_eq!(places, [caret(0, 0), caret(2, 0), caret(0, 0)]);
    // a capital letter matches itself only
    assert!(editor.find("Mass") && !editor.find("MASS"));
    assert_eq!(editor.selection().expect("it is selected").0, caret(0, 0));
    assert!(!editor.find("gravity"));
    assert!(!editor.find(""));
}

#[test]
fn pasted_text_brings_no_steering_and_no_more_than_there_is_room_for() {
    let mut editor = Editor::new("", 64);
    assert!(editor.paste("a\r\nb\x1b[2J\tc\r"));
    assert_eq!(editor.text(), "a\nb[2J    c\n");
    assert!(!editor.paste(&"x".repeat(100)), "there is no room for all of it");
    let text = editor.text();
    assert!((40..=64).contains(&text.len()), "{text}");
    assert_eq!(text.trim_end_matches('x'), "a\nb[2J    c\n");
}

#[test]
fn places_of_bytes_are_places_of_characters() {
    let editor = Editor::new("θ = 1\r\nφ = 2\r\n", LIMIT);
    assert_eq!(editor.caret_at(2), Caret { row: 0, column: 1 });
    assert_eq!(editor.caret_at("θ = 1\r\nφ".len()), Caret { row: 1, column: 1 });
    assert_eq!(editor.caret_at(1000), Caret { row: 2, column: 0 });
}

const KEYS: [&str; 22] = [
    "a",
    "θ",
    "Space",
    "Enter",
    "Tab",
    "Backspace",
    "Delete",
    "Left",
    "Right",
    "Up",
    "Down",
    "Home",
    "End",
    "Ctrl-Left",
    "Ctrl-Right",
    "Ctrl-w",
    "Shift-Left",
    "Shift-Down",
    "PageUp",
    "PageDown",
    "Shift-End",
    "Ctrl-Home",
];

proptest! {
    /// Every edit can be undone and redone, and nothing panics.
    #[test]
    fn everything_is_taken_back(
        text in "[aé\n ]{0,12}(\r\n)?",
        keys in prop::collection::vec(prop::sample::select(KEYS.to_vec()), 0..60),
    ) {
        let mut editor = Editor::new(&text, LIMIT);
        prop_assert_eq!(editor.text(), text.clone());
        for word in keys {
            editor.press(key(word), 3);
            let Caret { row, column } = editor.cursor();
            prop_assert!(column <= editor.lines()[row].chars().count());
        }
        let after = editor.text();
        while editor.undo() {}
        prop_assert_eq!(editor.text(), text);
        while editor.redo() {}
        prop_assert_eq!(editor.text(), after);
    }
}
