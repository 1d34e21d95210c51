//! Whole screens as they are meant to look, in `tests/screens`: first the text, then the style of every cell as a
//! letter; for large ones also the rendering without colour, and the text in ASCII.
//! `PHASELAB_BLESS=1 cargo test screen::golden` rewrites them; review the changes before you commit them.

use std::fs;
use std::path::Path;

use crossterm::event::{KeyCode, KeyEvent};
use phaselab::app::{Above, Guide, GuideKind, LessonTaken};
use phaselab::diagnostic::Document;
use phaselab::record::{Lesson, Script};
use phaselab::view::RenderStyle;
use phaselab::view::colour::ColourDepth;
use phaselab::view::glyphs::Glyphs;
use phaselab::view::theme::{Role, Theme};
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Rect;
use ratatui::style::{Color, Modifier};

use super::{rich, rows, screen};
use crate::fixtures::{at_picker, catalog, in_lab, lab, press};

/// The letter of each role; a dot is plain text, a hash any other style (of a curve or a trail).
const LETTERS: [(Role, char); 10] = [
    (Role::Dim, 'd'),
    (Role::Accent, 'a'),
    (Role::Title, 't'),
    (Role::Border, 'b'),
    (Role::Focus, 'f'),
    (Role::Good, 'g'),
    (Role::Warn, 'w'),
    (Role::Bad, '!'),
    (Role::Separatrix, 's'),
    (Role::Level, 'l'),
];

fn letter(cell: &Cell, look: &RenderStyle) -> char {
    if cell.modifier.contains(Modifier::REVERSED) {
        return 'S';
    }
    if cell.symbol() == " " || cell.style() == Cell::default().style().patch(look.theme[Role::Text])
    {
        return '.';
    }
    let is = |role: Role| cell.style() == Cell::default().style().patch(look.theme[role]);
    LETTERS.into_iter().find(|(role, _)| is(*role)).map_or('#', |(_, letter)| letter)
}

fn written(buffer: &Buffer, look: &RenderStyle) -> String {
    let mut text = rows(buffer).join("\n");
    text.push('\n');
    for y in 0..buffer.area.height {
        let row: String = (0..buffer.area.width).map(|x| letter(&buffer[(x, y)], look)).collect();
        text.push_str(row.trim_end_matches('.'));
        text.push('\n');
    }
    text
}

fn check(name: &str, buffer: &Buffer, look: &RenderStyle) {
    check_text(name, &written(buffer, look));
}

fn check_text(name: &str, now: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/screens").join(name);
    if std::env::var_os("PHASELAB_BLESS").is_some() {
        fs::write(&path, now).unwrap();
    }
    let meant = fs::read_to_string(&path).unwrap_or_default();
    assert!(meant == now, "{name} has changed; it is now\n{now}");
}

/// The modifier of each cell without colour, as its first letter; a dot if it has none.
fn weights(buffer: &Buffer) -> String {
    let messages = [
        (Modifier::REVERSED, 'r'),
        (Modifier::BOLD, 'b'),
        (Modifier::UNDERLINED, 'u'),
        (Modifier::DIM, 'd'),
    ];
    let letter = |cell: &Cell| {
        assert_eq!((cell.fg, cell.bg), (Color::Reset, Color::Reset), "{cell:?}");
        let found = messages.into_iter().find(|(weight, _)| cell.modifier.contains(*weight));
        found.map_or('.', |(_, letter)| letter)
    };
    let row = |y| (0..buffer.area.width).map(|x| letter(&buffer[(x, y)])).collect::<String>();
    let rows = (0..buffer.area.height).map(|y| row(y).trim_end_matches('.').to_owned() + "\n");
    rows.collect()
}

/// A large screen in colour, without, and in ASCII.
fn check_every_way(name: &str, mut draw: impl FnMut(&RenderStyle) -> Buffer) {
    let look = |depth, glyphs| RenderStyle { theme: Theme::dark(depth), glyphs };
    let colourful = draw(&rich());
    let plain = draw(&look(ColourDepth::None, Glyphs::Braille));
    let ascii = draw(&look(ColourDepth::Ansi16, Glyphs::Ascii));
    let ascii = rows(&ascii).join("\n");
    assert!(ascii.is_ascii(), "{name} in ASCII\n{ascii}");
    let now = format!(
        "{}\nwithout colour\n{}\n{}\nin ASCII\n{ascii}\n",
        written(&colourful, &rich()),
        rows(&plain).join("\n"),
        weights(&plain),
    );
    check_text(&format!("{name}-120x40.txt"), &now);
}

/// Systems of different kinds.
#[test]
fn laboratories_on_a_large_screen() {
    for name in
        ["double-pendulum", "merry-go-round", "heavy-top-body", "rolling-race", "kicked-rotor"]
    {
        let app = lab(name, 2.0);
        check_every_way(name, |look| screen(&app, look, (120, 40)));
    }
}

/// The vector field of the pendulum with its nullclines, beside the other panes and alone.
#[test]
fn the_vector_field() {
    let mut app = in_lab();
    press(&mut app, "*");
    check_every_way("vector-field", |look| screen(&app, look, (120, 40)));
    check("vector-field-80x24.txt", &screen(&app, &rich(), (80, 24)), &rich());
}

/// The pages beside the lab, the workbench and the help.
#[test]
fn pages_on_a_large_screen() {
    for (name, keys) in
        [("equations", "2"), ("notes", "3"), ("numbers", "4"), ("workbench", "E"), ("help", "?")]
    {
        let mut app = in_lab();
        press(&mut app, keys);
        check_every_way(name, |look| screen(&app, look, (120, 40)));
    }
}

/// The list of lessons and demos, and a lesson that waits for an answer.
#[test]
fn lessons_on_a_large_screen() {
    let mut app = at_picker();
    let guide = |kind, name: &str, title: &str| Guide {
        kind,
        name: name.to_owned(),
        title: title.to_owned(),
        system: "Simple pendulum".to_owned(),
    };
    app.picker.guides = vec![
        guide(GuideKind::Lesson(LessonTaken::Whole), "tour", "A tour"),
        guide(GuideKind::Lesson(LessonTaken::Partly), "kepler", "Why does an ellipse close?"),
        guide(GuideKind::Lesson(LessonTaken::NotYet), "top", "Why does a top not fall?"),
        guide(GuideKind::Demo, "pendulum", "The pendulum"),
    ];
    while app.picker.selected_above() != Some(Above::Guides) {
        press(&mut app, "Up");
    }
    press(&mut app, "Enter");
    check_every_way("lessons", |look| screen(&app, look, (120, 40)));

    let text = "Open planet\nSpeed 1/6\nSay \"This is a planet.\"\n\
                Predict \"How far from its sun will it be?\" r within 0.1\nWait 3s\nOutcome\n";
    let script = Script::read(&Document::new("my.lesson", text)).expect("a script");
    let planet = catalog().find("planet").expect("a preset");
    let mut lesson = Lesson::watched(script, &planet, "planet").expect("a lesson");
    while !lesson.is_typing() {
        lesson.advance(50_000).expect("it goes on");
        if !lesson.is_typing() {
            lesson.press(KeyEvent::from(KeyCode::Enter));
        }
    }
    check_every_way("lesson", |look| {
        let area = Rect::new(0, 0, 120, 40);
        let mut buffer = Buffer::empty(area);
        lesson.draw(look, area, &mut buffer);
        buffer
    });
}

#[test]
fn the_lab() {
    check("lab-80x24.txt", &screen(&in_lab(), &rich(), (80, 24)), &rich());
}

#[test]
fn the_palette() {
    let mut app = in_lab();
    press(&mut app, ": m e t h");
    check("palette-80x24.txt", &screen(&app, &rich(), (80, 24)), &rich());
}

#[test]
fn the_plain_reading() {
    let mut app = in_lab();
    press(&mut app, "9");
    check("plain-80x24.txt", &screen(&app, &rich(), (80, 24)), &rich());
}

#[test]
fn the_themes() {
    let mut app = in_lab();
    press(&mut app, "T Down");
    check("themes-80x24.txt", &screen(&app, &rich(), (80, 24)), &rich());
}

#[test]
fn the_picker() {
    check("picker-80x24.txt", &screen(&at_picker(), &rich(), (80, 24)), &rich());
}

#[test]
fn the_equations() {
    let mut app = in_lab();
    press(&mut app, "2");
    check("equations-80x24.txt", &screen(&app, &rich(), (80, 24)), &rich());
}
