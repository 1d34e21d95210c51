//! Casts: recordings in asciinema's format, one JSON value per line.
//!
//! In: text for a terminal and names of chapters, each with its time in microseconds. Out: the lines of an asciicast,
//! version 3 (<https://docs.asciinema.org/manual/asciicast/v3/>: times since the previous event) or version 2
//! (<https://docs.asciinema.org/manual/asciicast/v2/>: times since the beginning). The header contains the size, the
//! title and the theme, and nothing about the machine. Never here: the alternate screen, whose end would leave the
//! last picture blank; files.

use std::io::{self, Write};

use serde_json::{Value, json};

use super::cast_theme::CastTheme;
use super::clock::{Micros, SECOND};
use super::recording::{Recording, RecordingEvent};
use crate::view::theme::Palette;

/// The version of a cast.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Version {
    /// The format of asciinema 2.
    Two,
    /// The format of asciinema 3.
    #[default]
    Three,
}

/// A cast that is being written.
#[derive(Debug)]
pub struct Cast<W> {
    out: W,
    version: Version,
    last: Micros,
}

/// Hides the cursor, which a picture does not need.
const HIDE: &str = "\x1b[?25l";

impl<W: Write> Cast<W> {
    /// Writes the header.
    ///
    /// # Errors
    /// Returns an error if writing fails.
    pub fn begin(
        mut out: W,
        version: Version,
        (columns, rows): (u16, u16),
        title: &str,
        palette: &Palette,
    ) -> io::Result<Cast<W>> {
        let theme = CastTheme::of(palette).written();
        let head = match version {
            Version::Two => json!({
                "version": 2, "width": columns, "height": rows, "title": title, "theme": theme,
            }),
            Version::Three => json!({
                "version": 3, "term": { "cols": columns, "rows": rows, "theme": theme }, "title": title,
            }),
        };
        out.write_all(format!("{head}\n").as_bytes())?;
        let mut cast = Cast { out, version, last: 0 };
        cast.event(0, "o", HIDE)?;
        Ok(cast)
    }

    /// Writes text for the terminal at a time that is not before the last one.
    ///
    /// # Errors
    /// Returns an error if writing fails.
    pub fn output(&mut self, time: Micros, text: &str) -> io::Result<()> {
        self.event(time, "o", text)
    }

    /// Writes a new size of the terminal.
    ///
    /// # Errors
    /// Returns an error if writing fails.
    pub fn resize(&mut self, time: Micros, (columns, rows): (u16, u16)) -> io::Result<()> {
        self.event(time, "r", &format!("{columns}x{rows}"))
    }

    /// Writes the beginning of a chapter.
    ///
    /// # Errors
    /// Returns an error if writing fails.
    pub fn marker(&mut self, time: Micros, name: &str) -> io::Result<()> {
        self.event(time, "m", name)
    }

    /// Writes the end. The last picture stays, and the cursor is shown again in the last corner, where the shell of a
    /// player continues.
    ///
    /// # Errors
    /// Returns an error if writing fails.
    pub fn end(&mut self, time: Micros, (columns, rows): (u16, u16)) -> io::Result<()> {
        self.event(time, "o", &format!("\x1b[0m\x1b[{rows};{columns}H\x1b[?25h"))?;
        self.out.flush()
    }

    /// The underlying writer.
    pub fn into_inner(self) -> W {
        self.out
    }

    fn event(&mut self, time: Micros, code: &str, data: &str) -> io::Result<()> {
        let time = time.max(self.last);
        let shown = match self.version {
            Version::Two => time,
            Version::Three => time - self.last,
        };
        self.last = time;
        let (whole, rest) = (shown / SECOND, shown % SECOND);
        // writes whole lines, so that no file ends within one
        let line = format!("[{whole}.{rest:06}, \"{code}\", {}]\n", Value::from(data));
        self.out.write_all(line.as_bytes())
    }
}

/// Writes a whole recording.
///
/// # Errors
/// Returns an error if writing fails.
pub fn write<W: Write>(recording: &Recording, version: Version, out: W) -> io::Result<W> {
    let palette = recording.style.theme.palette();
    let mut cast = Cast::begin(out, version, recording.size, &recording.title, palette)?;
    for (time, event) in &recording.events {
        match event {
            RecordingEvent::Output(text) => cast.output(*time, text)?,
            RecordingEvent::Marker(name) => cast.marker(*time, name)?,
        }
    }
    cast.end(recording.end, recording.size)?;
    Ok(cast.into_inner())
}
