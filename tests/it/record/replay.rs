//! Casts read independently: as JSON, by vt100, and by asciinema's own terminal.

use phaselab::record::Recording;
use phaselab::record::cast_writer::{self, Version};
use ratatui::buffer::{Buffer, Cell};
use ratatui::style::{Color, Modifier};
use serde_json::Value;

use super::{played, schema};

/// A cast in its own format, parsed without the program's own reader.
pub(super) struct Read {
    head: Value,
    /// Time as written, in whole microseconds; code; data.
    events: Vec<(u64, String, String)>,
}

pub(super) fn read(recording: &Recording, version: Version) -> Read {
    let text = cast_writer::write(recording, version, Vec::new()).expect("written to memory");
    let text = String::from_utf8(text).expect("UTF-8");
    assert_eq!(schema::error(&text, version), None);
    let mut lines = text.lines();
    let head = serde_json::from_str(lines.next().expect("a head")).expect("JSON");
    let event = |line: &str| {
        let (time, code, data): (Value, String, String) = serde_json::from_str(line).expect(line);
        (micros(&time.to_string(), line), code, data)
    };
    Read { head, events: lines.map(event).collect() }
}

/// A time with six decimals, as a whole number.
fn micros(time: &str, line: &str) -> u64 {
    // the number as written in the line, because a JSON reader may have rounded it
    let written = line[1..].split(',').next().expect("a time");
    assert_eq!(written.parse::<f64>().unwrap(), time.parse::<f64>().unwrap());
    let (whole, part) = written.split_once('.').expect("decimals");
    assert_eq!(part.len(), 6, "{line}");
    whole.parse::<u64>().unwrap() * 1_000_000 + part.parse::<u64>().unwrap()
}

impl Read {
    pub(super) fn outputs(&self) -> impl Iterator<Item = &str> {
        self.events.iter().filter(|(_, code, _)| code == "o").map(|(_, _, data)| data.as_str())
    }
}

/// The appearance of a cell, in either terminal.
#[derive(PartialEq, Eq, Debug)]
struct Looks {
    symbol: String,
    fg: Option<Color>,
    bg: Option<Color>,
    /// Bold, dim, italic, underlined, reversed.
    weights: [bool; 5],
}

impl Looks {
    /// Removes what is invisible on a blank.
    fn seen(mut self) -> Looks {
        if self.symbol == " " {
            let [.., underlined, reversed] = self.weights;
            self.weights = [false, false, false, underlined, reversed];
            self.fg = self.fg.filter(|_| underlined || reversed);
        }
        self
    }

    fn drawn(cell: &Cell) -> Looks {
        use Modifier as M;
        let colour = |c: Color| (c != Color::Reset).then_some(c);
        let has = |m: Modifier| cell.modifier.contains(m);
        let weights = [M::BOLD, M::DIM, M::ITALIC, M::UNDERLINED, M::REVERSED].map(has);
        let symbol = cell.symbol().to_owned();
        Looks { symbol, fg: colour(cell.fg), bg: colour(cell.bg), weights }.seen()
    }

    fn vt100(cell: &vt100::Cell) -> Looks {
        let colour = |c| match c {
            vt100::Color::Default => None,
            vt100::Color::Idx(i) => Some(indexed(i)),
            vt100::Color::Rgb(r, g, b) => Some(Color::Rgb(r, g, b)),
        };
        Looks {
            symbol: if cell.has_contents() { cell.contents().to_owned() } else { " ".to_owned() },
            fg: colour(cell.fgcolor()),
            bg: colour(cell.bgcolor()),
            weights: [cell.bold(), cell.dim(), cell.italic(), cell.underline(), cell.inverse()],
        }
        .seen()
    }

    fn avt(cell: &avt::Cell) -> Looks {
        let colour = |c: Option<avt::Color>| match c {
            None => None,
            Some(avt::Color::Indexed(i)) => Some(indexed(i)),
            Some(avt::Color::RGB(rgb)) => Some(Color::Rgb(rgb.r, rgb.g, rgb.b)),
        };
        let p = cell.pen();
        Looks {
            symbol: cell.char().to_string(),
            fg: colour(p.foreground()),
            bg: colour(p.background()),
            weights: [p.is_bold(), p.is_faint(), p.is_italic(), p.is_underline(), p.is_inverse()],
        }
        .seen()
    }
}

/// The sixteen colours by ratatui's names.
fn indexed(index: u8) -> Color {
    use Color as C;
    let sixteen = [
        C::Black,
        C::Red,
        C::Green,
        C::Yellow,
        C::Blue,
        C::Magenta,
        C::Cyan,
        C::Gray,
        C::DarkGray,
        C::LightRed,
        C::LightGreen,
        C::LightYellow,
        C::LightBlue,
        C::LightMagenta,
        C::LightCyan,
        C::White,
    ];
    sixteen.get(usize::from(index)).copied().unwrap_or(C::Indexed(index))
}

/// Asserts that both terminals finally show what was drawn.
pub(super) fn check_last_picture(recording: &Recording, cast: &Read) {
    let (columns, rows) = recording.size;
    let mut one = vt100::Parser::new(rows, columns, 0);
    let mut other = avt::Vt::new(columns.into(), rows.into());
    for output in cast.outputs() {
        one.process(output.as_bytes());
        other.feed_str(output);
    }
    let drawn: &Buffer = &recording.last;
    assert_eq!((drawn.area.width, drawn.area.height), recording.size);
    for y in 0..rows {
        let line = other.line(y.into());
        for x in 0..columns {
            let expected = Looks::drawn(&drawn[(x, y)]);
            let cell = one.screen().cell(y, x).expect("inside");
            assert_eq!(Looks::vt100(cell), expected, "vt100 at {x}, {y}");
            assert_eq!(Looks::avt(&line.cells()[usize::from(x)]), expected, "avt at {x}, {y}");
        }
    }
    assert!(!one.screen().hide_cursor(), "the cursor is given back");
    assert!(other.cursor().visible);
}

/// Asserts the properties of every cast.
pub(super) fn check(recording: &Recording) {
    let (three, two) = (read(recording, Version::Three), read(recording, Version::Two));
    let (columns, rows) = recording.size;
    assert_eq!(three.head["version"], 3);
    assert_eq!(three.head["term"]["cols"], columns);
    assert_eq!(three.head["term"]["rows"], rows);
    assert_eq!(two.head["version"], 2);
    assert_eq!((&two.head["width"], &two.head["height"]), (&columns.into(), &rows.into()));
    for head in [&three.head, &two.head] {
        assert_eq!(head["title"], recording.title);
        for key in ["timestamp", "env", "command", "user", "hostname"] {
            assert!(head.get(key).is_none(), "{key}");
        }
    }
    let theme = &three.head["term"]["theme"];
    assert_eq!(theme["palette"].as_str().unwrap().split(':').count(), 16);

    // the same events at the same times
    let whole: u64 = three.events.iter().map(|(time, ..)| time).sum();
    assert_eq!(whole, two.events.last().expect("events").0);
    assert_eq!(whole, recording.end);
    let by_frames = u128::from(recording.frames) * 1_000_000 / u128::from(recording.fps);
    assert_eq!(u128::from(whole), by_frames);
    let mut time = 0;
    assert_eq!(three.events.len(), two.events.len());
    for (three, two) in three.events.iter().zip(&two.events) {
        time += three.0;
        assert_eq!((time, &three.1, &three.2), (two.0, &two.1, &two.2));
    }

    // chapters, each once
    let chapters = |cast: &Read| -> Vec<String> {
        let markers = cast.events.iter().filter(|(_, code, _)| code == "m");
        markers.map(|(_, _, name)| name.clone()).collect()
    };
    let names: Vec<String> = recording.markers.iter().map(|m| m.name.clone()).collect();
    assert_eq!((chapters(&three), chapters(&two)), (names.clone(), names.clone()));
    let mut unique = names.clone();
    unique.sort();
    unique.dedup();
    assert_eq!(unique.len(), names.len());

    // no alternate screen, so that the last picture stays
    assert!(three.outputs().all(|text| !text.contains("\u{1b}[?1049")));
    check_last_picture(recording, &three);
}

#[test]
fn a_cast_replays_to_what_was_drawn() {
    let common =
        "Caption \"A swing\"\nPress Tab x2 z\nWait 0.33s\nMarker \"Large\"\nPress z\nWait 1s";
    let check = |head: &str| {
        let recording = played("pendulum", &format!("{head}\n{common}"));
        assert!(recording.false_claims.is_empty());
        check(&recording);
    };
    check("Size 100x30");
    // a velocity has a dot above a letter, for which there is no single character
    check("Size 110x32\nOpen heavy-top");
    check("Size 80x24\nFps 30\nColor 256\nTheme light");
    check("Fps 7\nColor 16\nGlyphs half");
    check("Size 40x11\nFps 60\nColor never\nGlyphs ascii");
}

#[test]
fn the_last_screen_has_the_picture_in_it() {
    let recording = played("pendulum", "Size 100x30\nWait 1s");
    let cast = read(&recording, Version::Three);
    let mut terminal = avt::Vt::new(100, 30);
    for output in cast.outputs() {
        terminal.feed_str(output);
    }
    let text = terminal.text().join("\n");
    assert!(text.contains("Simple pendulum") && text.contains("Phase"), "{text}");
}
