//! Casts: errors have lines; a cast is read back equal after writing, in both versions; and it can be played.

use std::time::Duration;

use crossterm::event::{Event, KeyCode, KeyEvent, KeyModifiers};
use phaselab::record::cast_writer::{Cast, Version};
use phaselab::record::{CastEvent, RecordedCast};
use phaselab::shell::{CastPlayer, Screen};
use phaselab::view::theme::PALETTES;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::screen::rich;

pub(crate) const WORDS: &[&str] = &[
    "[0.5, \"o\", \"",
    "\"]\n",
    "[1, \"r\", \"100x40\"]\n",
    "[1, \"m\", \"one\"]\n",
    "\\u001b[",
    "31m",
    "2J",
    "?1049h",
    "\\u001b]0;",
    "\\r\\n",
    "65535b",
    "1;1H",
    "\\u001b[1000;1000H",
    "\"o\"",
    "\"version\":2",
    "\"width\":80",
    "idle_time_limit",
    "[",
    "]",
    ",",
    "{",
    "}",
    "\n",
    "e9",
    "-",
];

/// The number of frames drawn, and the largest screen drawn, because a terminal emulator takes time for every line.
const FRAMES: u32 = 4;
const SHOWN: u16 = 200;

fn written(cast: &RecordedCast, version: Version) -> RecordedCast {
    let title = cast.title.clone().unwrap_or_default();
    let mut out = Cast::begin(Vec::new(), version, cast.size, &title, &PALETTES[0]).unwrap();
    for (time, event) in &cast.events {
        match event {
            CastEvent::Output(text) => out.output(*time, text),
            CastEvent::Resize(columns, rows) => out.resize(*time, (*columns, *rows)),
            CastEvent::Marker(name) => out.marker(*time, name),
        }
        .unwrap();
    }
    out.end(cast.end, cast.size).unwrap();
    let text = String::from_utf8(out.into_inner()).unwrap();
    RecordedCast::read(&text).unwrap_or_else(|why| panic!("{text}: {why}"))
}

pub(crate) fn check(bytes: &[u8]) {
    let text = &*String::from_utf8_lossy(bytes);
    let cast = match RecordedCast::read(text) {
        Ok(cast) => cast,
        Err(why) => {
            let lines = text.lines().count().max(1);
            assert!((1..=lines).contains(&why.line) && !why.what.is_empty(), "{why:?}");
            return;
        }
    };
    for version in [Version::Two, Version::Three] {
        let again = written(&cast, version);
        assert_eq!((again.size, again.end), (cast.size, cast.end), "{version:?}");
        // it begins by hiding the cursor, and ends by showing it again
        assert_eq!(again.events[1..again.events.len() - 1], cast.events, "{version:?}");
    }
    if cast.size.0.max(cast.size.1) > SHOWN {
        return;
    }
    let area = Rect::new(0, 0, 60, 20);
    let mut player = CastPlayer::new(cast, rich());
    for _ in 0..FRAMES {
        player.advance(Duration::from_millis(500));
        player.draw(area, &mut Buffer::empty(area));
        player.input(Event::Key(KeyEvent::new(KeyCode::Tab, KeyModifiers::NONE)));
    }
}
