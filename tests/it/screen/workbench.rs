//! The workbench on the screen: the cursor always visible, errors marked, any size, ASCII.

use std::sync::Arc;

use phaselab::app::{App, AppEvent, BufferDiagnostic, BufferState, Caret, Notification};
use phaselab::view::RenderStyle;
use phaselab::view::colour::ColourDepth;
use phaselab::view::theme::Theme;
use proptest::prelude::*;
use ratatui::buffer::Buffer;
use ratatui::style::Modifier;

use super::{ascii, drawn, find, rich, rows, screen};
use crate::fixtures::{in_lab, press, snapshot};

fn edited() -> App {
    let mut app = in_lab();
    press(&mut app, "E Ctrl-Home");
    app
}

/// The text of the cells with a modifier left of a column, between the header and the footer.
fn cells(buffer: &Buffer, modifier: Modifier, right: u16) -> Vec<String> {
    let places = (1..buffer.area.height - 2).flat_map(|y| (0..right).map(move |x| (x, y)));
    let cells = places.map(|at| &buffer[at]).filter(|cell| cell.modifier.contains(modifier));
    cells.map(|cell| cell.symbol().to_owned()).collect()
}

const KEYS: [&str; 12] = [
    "Up",
    "Down",
    "Left",
    "Right",
    "Home",
    "End",
    "PageUp",
    "PageDown",
    "Ctrl-Home",
    "Ctrl-End",
    "Ctrl-Right",
    "Enter",
];

proptest! {
    #![proptest_config(crate::cases(64))]

    /// One cell is reversed, and it is the character at the cursor.
    #[test]
    fn the_cursor_is_in_sight_wherever_it_goes(
        keys in prop::collection::vec(prop::sample::select(KEYS.to_vec()), 0..30),
        (width, height) in (40_u16..111, 10_u16..50),
    ) {
        let mut app = edited();
        for word in keys {
            let (_, shown) = drawn(&app, &rich(), (width, height));
            app.update(AppEvent::Drawn(shown));
            press(&mut app, word);
        }
        let sheet = app.open_buffer().unwrap();
        let Caret { row, column } = sheet.editor.cursor();
        let under = sheet.editor.lines()[row].chars().nth(column).unwrap_or(' ').to_string();
        let buffer = screen(&app, &rich(), (width, height));
        prop_assert_eq!(cells(&buffer, Modifier::REVERSED, width), [under]);
    }
}

#[test]
fn an_error_is_underlined_marked_and_reported_below() {
    let mut app = edited();
    let sheet = app.workbench.top_mut().unwrap();
    let (from, to) = (Caret { row: 2, column: 10 }, Caret { row: 2, column: 13 });
    let (message, help) = ("it is not so".to_owned(), Some("write it so".to_owned()));
    sheet.diagnostics = vec![BufferDiagnostic { from, to, warning: false, message, help }];
    sheet.state = BufferState::Wrong;
    for (look, mark) in [(rich(), "✗"), (ascii(), "x")] {
        let buffer = screen(&app, &look, (80, 24));
        let line: String = sheet_line(&app, 2).chars().skip(10).take(3).collect();
        let (_, y) = find(&buffer, " 3  source").unwrap();
        let row = (0..80).map(|x| &buffer[(x, y)]);
        let underlined = row.filter(|cell| cell.modifier.contains(Modifier::UNDERLINED));
        assert_eq!(underlined.map(ratatui::buffer::Cell::symbol).collect::<String>(), line);
        for text in ["1 error", "3:11 it is not so", "help: write it so"] {
            assert!(find(&buffer, text).is_some(), "{text}: {:#?}", rows(&buffer));
        }
        assert_eq!(buffer[(1, y)].symbol(), mark);
    }
}

fn sheet_line(app: &App, row: usize) -> String {
    app.open_buffer().unwrap().editor.lines()[row].clone()
}

#[test]
fn a_terminal_of_ascii_gets_ascii() {
    let mut app = edited();
    app.update(AppEvent::Paste("θ ẍ ½ 漢".to_owned()));
    for keys in ["", "Ctrl-s", "Ctrl-f"] {
        press(&mut app, keys);
        for size in [(40, 10), (80, 24), (200, 60)] {
            let text = rows(&screen(&app, &ascii(), size)).concat();
            assert!(text.is_ascii(), "{keys} {size:?}: {text}");
        }
        press(&mut app, "Esc E Ctrl-Home");
    }
}

#[test]
fn the_motion_stands_beside_the_text_where_there_is_room() {
    let app = edited();
    let beside = |size| find(&screen(&app, &rich(), size), "Motion").is_some();
    assert!(beside((120, 40)) && beside((200, 60)) && beside((80, 24)));
    assert!(!beside((77, 24)) && !beside((80, 10)));
}

/// At 80 × 24 a law that is edited and the motion of it are seen together, and nothing else is in the way.
#[test]
fn on_a_small_screen_the_motion_is_seen_while_the_law_is_edited() {
    let mut app = in_lab();
    let bob = |app: &App| {
        let buffer = screen(app, &rich(), (80, 24));
        let cells = (1..22).flat_map(|y| (56..79).map(move |x| (x, y)));
        let bobs: Vec<(u16, u16)> = cells.filter(|at| buffer[*at].symbol() == "●").collect();
        assert_eq!(bobs.len(), 1, "{:#?}", rows(&buffer));
        bobs[0]
    };
    press(&mut app, "E");
    let before = bob(&app);
    let text = rows(&screen(&app, &rich(), (80, 24)));
    assert!(text.iter().any(|row| row.contains("L = \"T - V\"")), "{text:#?}");
    let seen = snapshot(&app.lab.as_ref().unwrap().loaded, 0.4);
    app.update(AppEvent::Snapshot(Arc::new(seen)));
    assert_ne!(bob(&app), before);
}

const ALONG: [&str; 6] = ["Left", "Right", "Home", "End", "Ctrl-Right", "Ctrl-Left"];

/// The form of a character on an ASCII terminal.
fn spelt(c: char) -> String {
    match c {
        'θ' => "<theta>".to_owned(),
        '½' => "<1/2>".to_owned(),
        '漢' => "<U+6F22>".to_owned(),
        _ => c.to_string(),
    }
}

proptest! {
    #![proptest_config(crate::cases(64))]

    /// If a character takes several cells, the cursor covers all of them.
    #[test]
    fn the_cursor_is_in_sight_where_letters_are_spelt_out(
        keys in prop::collection::vec(prop::sample::select(ALONG.to_vec()), 0..20),
        (width, height) in (40_u16..111, 10_u16..50),
    ) {
        let mut app = edited();
        app.update(AppEvent::Paste("θx½漢".repeat(12) + "\n" + &"θ漢".repeat(40) + "\n"));
        press(&mut app, "Ctrl-Home");
        for word in keys {
            let (_, shown) = drawn(&app, &ascii(), (width, height));
            app.update(AppEvent::Drawn(shown));
            press(&mut app, word);
        }
        let sheet = app.open_buffer().unwrap();
        let Caret { row, column } = sheet.editor.cursor();
        let under = sheet.editor.lines()[row].chars().nth(column).unwrap_or(' ');
        let buffer = screen(&app, &ascii(), (width, height));
        prop_assert_eq!(cells(&buffer, Modifier::REVERSED, width).concat(), spelt(under));
    }
}

#[test]
fn what_is_reported_leaves_the_keys_in_sight() {
    let mut app = edited();
    let reported =
        "Saved: /home/somebody/a/long/way/to/a/file.toml, with 1 error: 12:3 no such name";
    for size in [(80, 24), (120, 40), (200, 60)] {
        for look in [rich(), ascii()] {
            app.notifications.dismiss();
            let before = rows(&screen(&app, &look, size));
            app.notifications.show(Notification::error(reported));
            let after = rows(&screen(&app, &look, size));
            assert_eq!(before.last(), after.last(), "{size:?}");
            assert!(after.last().unwrap().contains("F1 help"), "{after:#?}");
            let shown: Vec<&str> = after.iter().flat_map(|row| row.split_whitespace()).collect();
            let words: Vec<&str> = reported.split_whitespace().collect();
            assert!(words.iter().all(|word| shown.contains(word)), "{after:#?}");
        }
    }
}

/// Going far to the right moves the line of the cursor alone, and only the text looks focused beside the motion.
#[test]
fn one_line_scrolls_and_one_pane_is_focused() {
    let mut app = edited();
    press(&mut app, "Ctrl-Home");
    app.update(AppEvent::Paste(format!("# {}end\n", "long ".repeat(60))));
    press(&mut app, "Up End");
    let look = RenderStyle { theme: Theme::dark(ColourDepth::None), ..rich() };
    let seen = screen(&app, &look, (120, 40));
    let text = rows(&seen);
    assert!(text.iter().any(|row| row.contains("…") && row.contains("long end")), "{text:#?}");
    assert!(text.iter().any(|row| row.contains(" [coordinates]")), "{text:#?}");
    assert!(!text.iter().any(|row| row.contains("# long")), "{text:#?}");
    assert_eq!(text.concat().matches('┏').count(), 1, "{text:#?}");
}

/// On the smallest screen an error is reported, and not only that there is one.
#[test]
fn an_error_is_reported_in_few_rows() {
    let mut app = edited();
    let (from, to) = (Caret { row: 0, column: 0 }, Caret { row: 0, column: 5 });
    let sheet = app.workbench.top_mut().unwrap();
    let message = "unknown key `xname` in this table".to_owned();
    let help = Some("did you mean `name`?".to_owned());
    sheet.diagnostics = vec![BufferDiagnostic { from, to, warning: false, message, help }];
    sheet.state = BufferState::Wrong;
    let buffer = screen(&app, &rich(), (40, 10));
    assert!(find(&buffer, "1:1 unknown key `xname`").is_some(), "{:#?}", rows(&buffer));
    assert!(find(&buffer, "did you mean `name`?").is_some(), "{:#?}", rows(&buffer));
}

/// Of several errors as many are reported as there is room for, the one at the cursor first and in full.
#[test]
fn several_errors_are_reported_at_once() {
    let mut app = edited();
    let sheet = app.workbench.top_mut().unwrap();
    let error = |row: usize, help: Option<&str>| BufferDiagnostic {
        from: Caret { row, column: 0 },
        to: Caret { row, column: 1 },
        warning: false,
        message: format!("wrong number {row}"),
        help: help.map(str::to_owned),
    };
    sheet.diagnostics = vec![error(0, None), error(2, Some("mend it")), error(4, None)];
    sheet.state = BufferState::Wrong;
    let reported = |app: &App| {
        let rows = rows(&screen(app, &rich(), (80, 24)));
        let row =
            |text: &str| rows.iter().position(|row| row.contains(text)).expect("it is reported");
        [row("1:1 wrong number 0"), row("3:1 wrong number 2"), row("5:1 wrong number 4")]
    };
    let [first, second, third] = reported(&app);
    assert!(first < second && second < third);
    press(&mut app, "Down Down");
    let [first, second, third] = reported(&app);
    assert!(second + 1 < third && third < first, "its help is in the row below");
}

/// Rows that nothing is said in belong to the text.
#[test]
fn the_text_has_the_rows_that_messages_leave() {
    let mut app = edited();
    for (height, least) in [(24, 18), (15, 9)] {
        let (buffer, shown) = drawn(&app, &rich(), (80, height));
        assert!(shown.rows >= least, "{}: {:#?}", shown.rows, rows(&buffer));
    }
    app.notifications.show(Notification::info("lift-off at t = 2"));
    assert_eq!(drawn(&app, &rich(), (80, 24)).1.rows, 18, "a line in place of the status");
    app.notifications.show(Notification::info("a message that is longer than a line ".repeat(2)));
    assert_eq!(drawn(&app, &rich(), (80, 24)).1.rows, 17);
}
