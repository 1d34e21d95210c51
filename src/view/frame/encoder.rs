//! The encoder: a backend of ratatui that turns cells into bytes and keeps them.
//!
//! In: the cells that have changed, a size, and how many bytes there is room for. Out: the bytes of a frame. Never here:
//! sending them, hiding the cursor (whoever holds the terminal does, for it has to be shown again), or a question: all
//! that is asked is answered from what was written.
//!
//! What is not a cell is crossterm's [`CrosstermBackend`]; cells are the [`Pen`]'s, whose head says why.

use std::collections::BTreeMap;
use std::io;

use crossterm::queue;
use crossterm::terminal::{BeginSynchronizedUpdate, EndSynchronizedUpdate};
use ratatui::backend::{Backend, ClearType, CrosstermBackend, WindowSize};
use ratatui::buffer::Cell;
use ratatui::layout::{Position, Size};

use super::pen::Pen;

/// Writes frames down.
#[derive(Debug)]
pub(super) struct Encoder {
    bytes: Vec<u8>,
    pen: Pen,
    /// Whether a frame stands between marks.
    synchronized: bool,
    size: Size,
    /// About how many bytes a frame may have.
    most: usize,
    /// The screen is to be cleared first.
    clear: bool,
    /// Cells for which there was no room, by row and column.
    owed: BTreeMap<(u16, u16), Cell>,
    /// Where the next frame begins with them.
    next: (u16, u16),
    cursor: Option<Position>,
}

impl Encoder {
    /// Of a screen of no size yet.
    pub(super) fn new(synchronized: bool) -> Self {
        Self {
            bytes: Vec::new(),
            pen: Pen::default(),
            synchronized,
            size: Size::default(),
            most: 0,
            clear: false,
            owed: BTreeMap::new(),
            next: (0, 0),
            cursor: None,
        }
    }

    /// Begins a frame of a screen of that size, in about so many bytes.
    pub(super) fn begin(&mut self, size: Size, most: usize) {
        (self.size, self.most) = (size, most);
        self.bytes.clear();
    }

    /// The bytes of the frame.
    pub(super) fn take(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.bytes)
    }

    /// Whether cells are still to be written.
    pub(super) fn owes(&self) -> bool {
        !self.owed.is_empty()
    }

    /// Where the cursor was left, if it is to be seen there.
    pub(super) fn cursor(&self) -> Option<Position> {
        self.cursor
    }

    /// crossterm's backend on the same bytes.
    fn crossterm(&mut self) -> CrosstermBackend<&mut Vec<u8>> {
        CrosstermBackend::new(&mut self.bytes)
    }

    /// The pen, and where it writes; a frame has begun.
    fn pen(&mut self) -> io::Result<(&mut Pen, &mut Vec<u8>)> {
        if self.bytes.is_empty() && self.synchronized {
            queue!(self.bytes, BeginSynchronizedUpdate)?;
        }
        if std::mem::take(&mut self.clear) {
            self.pen.clear(&mut self.bytes)?;
        }
        Ok((&mut self.pen, &mut self.bytes))
    }

    /// Writes a cell where there is room for it; whether there was.
    fn put(&mut self, (y, x): (u16, u16), cell: &Cell) -> io::Result<bool> {
        let (width, most) = (self.size.width, self.most);
        let room = self.bytes.len() < most;
        if room {
            let (pen, bytes) = self.pen()?;
            pen.put(bytes, (x, y), cell, width);
        }
        Ok(room)
    }

    /// Writes what is owed, from where the last frame ended and round to there again.
    fn pay(&mut self) -> io::Result<()> {
        let behind = self.owed.split_off(&self.next);
        let before = std::mem::take(&mut self.owed);
        for (place, cell) in behind.into_iter().chain(before) {
            if self.owed.is_empty() && self.put(place, &cell)? {
                continue;
            }
            if self.owed.is_empty() {
                self.next = place;
            }
            self.owed.insert(place, cell);
        }
        Ok(())
    }
}

impl Backend for Encoder {
    type Error = io::Error;

    fn draw<'a, I>(&mut self, cells: I) -> io::Result<()>
    where
        I: Iterator<Item = (u16, u16, &'a Cell)>,
    {
        if self.clear {
            self.pen()?;
        }
        if self.owes() {
            self.owed.extend(cells.map(|(x, y, cell)| ((y, x), cell.clone())));
            return self.pay();
        }
        for (x, y, cell) in cells {
            let place = (y, x);
            if self.owed.is_empty() && self.put(place, cell)? {
                continue;
            }
            if self.owed.is_empty() {
                self.next = place;
            }
            self.owed.insert(place, cell.clone());
        }
        Ok(())
    }

    fn hide_cursor(&mut self) -> io::Result<()> {
        self.cursor = None;
        Ok(())
    }

    fn show_cursor(&mut self) -> io::Result<()> {
        Ok(())
    }

    fn get_cursor_position(&mut self) -> io::Result<Position> {
        Ok(self.cursor.unwrap_or_default())
    }

    fn set_cursor_position<P: Into<Position>>(&mut self, position: P) -> io::Result<()> {
        let at = position.into();
        self.cursor = Some(at);
        if !self.pen.is_at((at.x, at.y)) {
            let (pen, bytes) = self.pen()?;
            pen.rest(bytes, (at.x, at.y));
        }
        Ok(())
    }

    fn clear(&mut self) -> io::Result<()> {
        self.clear_region(ClearType::All)
    }

    fn clear_region(&mut self, region: ClearType) -> io::Result<()> {
        if region == ClearType::All {
            self.owed.clear();
            self.clear = true;
            return Ok(());
        }
        self.pen()?;
        self.crossterm().clear_region(region)
    }

    fn size(&self) -> io::Result<Size> {
        Ok(self.size)
    }

    fn window_size(&mut self) -> io::Result<WindowSize> {
        Ok(WindowSize { columns_rows: self.size, pixels: Size::default() })
    }

    /// Ends the frame.
    fn flush(&mut self) -> io::Result<()> {
        if self.synchronized && !self.bytes.is_empty() {
            queue!(self.bytes, EndSynchronizedUpdate)?;
        }
        self.crossterm().flush()
    }
}
