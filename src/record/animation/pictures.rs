//! The pictures of a cast at whole centiseconds.
//!
//! In: a cast. Out: what its terminal shows, and for how long. Viewers of GIFs replace a delay below two centiseconds by
//! ten, so whatever follows sooner belongs to the same picture. Never here: pixels.

use super::screen::{CastTerminal, ScreenCell};
use crate::record::cast_reader::{CastEvent, RecordedCast};

/// Microseconds in a centisecond.
const CENTISECOND: u64 = 10_000;

/// The shortest delay, in centiseconds.
const SHORTEST_DELAY: u64 = 2;

/// What the terminal shows for some time.
pub(super) struct CastPicture {
    /// The cells row by row.
    pub(super) cells: Vec<ScreenCell>,
    /// The number of cells in a row, constant throughout a cast.
    pub(super) columns: u16,
    /// Centiseconds.
    pub(super) lasts: u64,
}

pub(super) struct CastPictures<'a> {
    cast: &'a RecordedCast,
    terminal: CastTerminal,
    size: (u16, u16),
    next: usize,
    /// Where the current picture begins, and the end, in centiseconds.
    start: u64,
    end: u64,
    over: bool,
}

impl<'a> CastPictures<'a> {
    pub(super) fn new(cast: &'a RecordedCast) -> CastPictures<'a> {
        CastPictures {
            cast,
            terminal: CastTerminal::new(cast.size, cast.theme.clone()),
            size: CastPictures::largest(cast),
            next: 0,
            start: 0,
            end: centiseconds(cast.end),
            over: false,
        }
    }

    /// The columns and rows that hold every size of the terminal.
    pub(super) fn largest(cast: &RecordedCast) -> (u16, u16) {
        let sizes = cast.events.iter().filter_map(|(_, event)| match event {
            CastEvent::Resize(columns, rows) => Some((*columns, *rows)),
            _ => None,
        });
        sizes.fold(cast.size, |(w, h), (columns, rows)| (w.max(columns), h.max(rows)))
    }

    /// The next picture; the last one ends with the cast.
    pub(super) fn next(&mut self) -> Option<CastPicture> {
        if self.over {
            return None;
        }
        // nothing begins too late to be seen
        let latest = self.end.saturating_sub(SHORTEST_DELAY);
        while let Some((time, event)) = self.cast.events.get(self.next) {
            let time = centiseconds(*time).min(latest);
            if time >= self.start + SHORTEST_DELAY {
                let picture = self.picture(time);
                self.start = time;
                return Some(picture);
            }
            match event {
                CastEvent::Output(text) => self.terminal.feed(text),
                CastEvent::Resize(columns, rows) => self.terminal.resize(*columns, *rows),
                CastEvent::Marker(_) => {}
            }
            self.next += 1;
        }
        self.over = true;
        Some(self.picture(self.end))
    }

    fn picture(&self, until: u64) -> CastPicture {
        let cells = self.terminal.cells(self.size);
        CastPicture { cells, columns: self.size.0, lasts: until - self.start }
    }
}

fn centiseconds(micros: u64) -> u64 {
    (micros + CENTISECOND / 2) / CENTISECOND
}

/// The indices of the cells that differ from what was shown; all of them if nothing was.
pub(super) fn changed<'a>(
    shown: &'a [ScreenCell],
    cells: &'a [ScreenCell],
) -> impl Iterator<Item = usize> + 'a {
    cells.iter().enumerate().filter(|(index, cell)| shown.get(*index) != Some(cell)).map(|(i, _)| i)
}
