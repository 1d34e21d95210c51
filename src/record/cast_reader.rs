//! Reads a cast of version 2 or 3, from any program.
//!
//! In: the text of a cast. Out: its timed events, within limits. The cast is untrusted: nothing of it may reach a
//! terminal except through an emulator. Never here: showing it.

use serde::Deserialize;
use serde_json::Value;
use unicode_width::UnicodeWidthChar;

use super::cast_theme::CastTheme;
use super::clock::{Micros, SECOND};
use super::recording::{Recording, RecordingEvent};
use crate::printable;

/// A cast in memory.
#[derive(Clone, Debug)]
pub struct RecordedCast {
    /// That of the header; `None` if it has none.
    pub title: Option<String>,
    /// The initial number of columns and rows.
    pub size: (u16, u16),
    /// The colours of its terminal.
    pub theme: CastTheme,
    /// The events in order of time.
    pub events: Vec<(Micros, CastEvent)>,
    /// The time of the end.
    pub end: Micros,
}

/// What happens at one time of a cast.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CastEvent {
    /// Text for the emulated terminal, which has a cell for each character: signs without a width of their own are left out.
    Output(String),
    /// A new size in columns and rows.
    Resize(u16, u16),
    /// A chapter begins.
    Marker(String),
}

/// Why a text is not a cast.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {what}")]
pub struct CastError {
    /// The line number, from 1.
    pub line: usize,
    /// What is wrong.
    pub what: String,
}

/// The greatest screen.
const MOST_COLUMNS: u64 = 1000;
const MOST_ROWS: u64 = 500;

/// The greatest duration of a cast in seconds: one day.
const LONGEST: f64 = 86_400.0;

#[derive(Deserialize)]
struct CastHeader {
    version: u64,
    title: Option<String>,
    idle_time_limit: Option<f64>,
    width: Option<u64>,
    height: Option<u64>,
    theme: Option<Value>,
    term: Option<TerminalReplay>,
}

#[derive(Deserialize)]
struct TerminalReplay {
    cols: u64,
    rows: u64,
    theme: Option<Value>,
}

impl RecordedCast {
    /// Reads a cast.
    ///
    /// # Errors
    /// Returns an error for the first line that does not belong to a cast.
    pub fn read(text: &str) -> Result<RecordedCast, CastError> {
        let wrong = |line: usize, what: String| CastError { line, what };
        let mut lines = text.lines().enumerate().map(|(index, line)| (index + 1, line));
        let (_, first) = lines.next().unwrap_or((1, ""));
        let head: CastHeader = serde_json::from_str(first)
            .map_err(|why| wrong(1, format!("this is not the head of a cast: {why}")))?;
        let size = match (head.version, &head.term, head.width, head.height) {
            (2, _, Some(width), Some(height)) => (width, height),
            (3, Some(term), _, _) => (term.cols, term.rows),
            (2 | 3, ..) => return Err(wrong(1, "the head has no size".to_owned())),
            (version, ..) => {
                let what =
                    format!("casts of version 2 and 3 can be read, not of version {version}");
                return Err(wrong(1, what));
            }
        };
        let theme = head.term.as_ref().and_then(|term| term.theme.as_ref()).or(head.theme.as_ref());
        let theme = theme.map(CastTheme::read).unwrap_or_default();
        let mut cast = RecordedCast {
            theme,
            title: head.title,
            size: sized(size).map_err(|what| wrong(1, what))?,
            events: Vec::new(),
            end: 0,
        };
        let idle = head.idle_time_limit.filter(|limit| *limit > 0.0).unwrap_or(LONGEST);
        let mut last = 0.0;
        for (number, line) in lines {
            if line.trim().is_empty() || line.starts_with('#') {
                continue;
            }
            let (time, code, data) = serde_json::from_str::<(f64, String, Value)>(line)
                .map_err(|why| wrong(number, format!("this is not an event of a cast: {why}")))?;
            let passed = if head.version == 2 { time - last } else { time };
            last = time;
            let passed = (passed.clamp(0.0, idle) * SECOND as f64).round() as Micros;
            cast.end += passed;
            if cast.end > (LONGEST as Micros) * SECOND {
                return Err(wrong(
                    number,
                    "a cast may last a day at most; this one is longer".to_owned(),
                ));
            }
            let data = data.as_str().unwrap_or_default();
            let event = match code.as_str() {
                "o" => Some(CastEvent::Output(without_combining_signs(data))),
                "m" => Some(CastEvent::Marker(data.to_owned())),
                "r" => {
                    let sides = data.split_once('x');
                    let size = sides.and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
                    let what = || format!("`{}` is not a size", printable::quoted(data));
                    let size = size.ok_or_else(what).and_then(sized);
                    let (columns, rows) = size.map_err(|what| wrong(number, what))?;
                    Some(CastEvent::Resize(columns, rows))
                }
                // input, the exit status, and what later versions may add
                _ => None,
            };
            cast.events.extend(event.map(|event| (cast.end, event)));
        }
        Ok(cast)
    }
}

fn sized((columns, rows): (u64, u64)) -> Result<(u16, u16), String> {
    if (1..=MOST_COLUMNS).contains(&columns) && (1..=MOST_ROWS).contains(&rows) {
        return Ok((columns as u16, rows as u16));
    }
    Err(format!("a screen has 1x1 to {MOST_COLUMNS}x{MOST_ROWS} characters, not {columns}x{rows}"))
}

fn without_combining_signs(text: &str) -> String {
    text.chars().filter(|c| c.width() != Some(0)).collect()
}

impl From<RecordingEvent> for CastEvent {
    fn from(event: RecordingEvent) -> CastEvent {
        match event {
            RecordingEvent::Output(text) => CastEvent::Output(without_combining_signs(&text)),
            RecordingEvent::Marker(name) => CastEvent::Marker(name),
        }
    }
}

impl From<Recording> for RecordedCast {
    fn from(recording: Recording) -> RecordedCast {
        let events = recording.events.into_iter();
        RecordedCast {
            title: Some(recording.title),
            size: recording.size,
            theme: CastTheme::of(recording.style.theme.palette()),
            events: events.map(|(time, event)| (time, event.into())).collect(),
            end: recording.end,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_versions_are_read() {
        let two = "{\"version\":2,\"width\":80,\"height\":24}\n[0.5, \"o\", \"a\"]\n[2.0, \"m\", \"x\"]\n";
        let three = "{\"version\":3,\"term\":{\"cols\":80,\"rows\":24}}\n# words\n[0.5, \"o\", \"a\"]\n\
                     [1.5, \"m\", \"x\"]\n";
        let events = [
            (500_000, CastEvent::Output("a".to_owned())),
            (2_000_000, CastEvent::Marker("x".to_owned())),
        ];
        for text in [two, three] {
            let cast = RecordedCast::read(text).expect("a cast");
            assert_eq!((cast.size, cast.end), ((80, 24), 2_000_000));
            assert_eq!(cast.events, events);
        }
    }

    #[test]
    fn what_is_no_cast_is_reported_in_its_line() {
        let check = |text: &str, line: usize, part: &str| {
            let error = RecordedCast::read(text).expect_err(text);
            assert!(error.line == line && error.what.contains(part), "{text}: {error}");
        };
        let head = "{\"version\":2,\"width\":80,\"height\":24}\n";
        check("", 1, "not the head");
        check("{\"version\":1,\"width\":80,\"height\":24}", 1, "not of version 1");
        check("{\"version\":3}", 1, "no size");
        check("{\"version\":2,\"width\":0,\"height\":24}", 1, "0x24");
        check("{\"version\":2,\"width\":1000000,\"height\":1000000}", 1, "1000000x1000000");
        check(&format!("{head}[1.0, \"o\"]"), 2, "not an event");
        check(&format!("{head}\n[1.0, \"r\", \"99999x99999\"]"), 3, "99999x99999");
        check(&format!("{head}[1e300, \"o\", \"a\"]\n[2e300, \"o\", \"b\"]"), 3, "a day");
    }
}
