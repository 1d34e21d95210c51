//! The encoder: a ratatui backend that turns cells into bytes and stores them.
//!
//! In: the cells that have changed, a size, and a limit on the number of bytes. Out: the bytes of a frame. Never here:
//! sending them, hiding the cursor (the owner of the terminal does that, because it must be shown again), or a query:
//! all questions are answered from what was written.
//!
//! Cells are encoded by the [`TerminalPen`], for the reasons in its module head, and everything else by crossterm's
//! [`CrosstermBackend`].

use std::collections::BTreeMap;
use std::io;

use crossterm::queue;
use crossterm::terminal::{BeginSynchronizedUpdate, EndSynchronizedUpdate};
use ratatui::backend::{Backend, ClearType, CrosstermBackend, WindowSize};
use ratatui::buffer::Cell;
use ratatui::layout::{Position, Size};

use super::pen::TerminalPen;

/// How many cells, in the order of rows, the next one to be written is chosen from. To move the cursor takes fewer bytes than
/// to change a colour, so cells of one style are written one after the other.
const WINDOW: usize = 64;

#[derive(Debug)]
pub(super) struct Encoder {
    bytes: Vec<u8>,
    pen: TerminalPen,
    /// Whether a frame is enclosed in synchronization marks.
    synchronized: bool,
    size: Size,
    /// The approximate limit on the bytes of a frame.
    most: usize,
    /// Whether the screen must be cleared first.
    clear: bool,
    /// Cells that did not fit in earlier frames, by row and column.
    pending: BTreeMap<(u16, u16), Cell>,
    /// Where the next frame begins with them: at the first of them from here on.
    next: (u16, u16),
    cursor: Option<Position>,
}

impl Encoder {
    /// Creates an encoder for a screen of zero size.
    pub(super) fn new(synchronized: bool) -> Self {
        Self {
            bytes: Vec::new(),
            pen: TerminalPen::default(),
            synchronized,
            size: Size::default(),
            most: 0,
            clear: false,
            pending: BTreeMap::new(),
            next: (0, 0),
            cursor: None,
        }
    }

    /// Begins a frame for a screen of this size, with about `most` bytes at most.
    pub(super) fn begin(&mut self, size: Size, most: usize) {
        (self.size, self.most) = (size, most);
        self.bytes.clear();
    }

    /// Takes the bytes of the frame.
    pub(super) fn take(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.bytes)
    }

    pub(super) fn has_pending(&self) -> bool {
        !self.pending.is_empty()
    }

    /// The position of the cursor, or `None` if it is hidden.
    pub(super) fn cursor(&self) -> Option<Position> {
        self.cursor
    }

    /// crossterm's backend on the same bytes.
    fn crossterm(&mut self) -> CrosstermBackend<&mut Vec<u8>> {
        CrosstermBackend::new(&mut self.bytes)
    }

    /// Begins the frame if necessary, and returns the pen and its output.
    fn pen(&mut self) -> io::Result<(&mut TerminalPen, &mut Vec<u8>)> {
        if self.bytes.is_empty() && self.synchronized {
            queue!(self.bytes, BeginSynchronizedUpdate)?;
        }
        if std::mem::take(&mut self.clear) {
            self.pen.clear(&mut self.bytes)?;
        }
        Ok((&mut self.pen, &mut self.bytes))
    }

    /// Writes a cell if there is room for it, and returns whether there was.
    fn put(&mut self, (y, x): (u16, u16), cell: &Cell) -> io::Result<bool> {
        let (width, most) = (self.size.width, self.most);
        let room = self.bytes.len() < most;
        if room {
            let (pen, bytes) = self.pen()?;
            pen.put(bytes, (x, y), cell, width);
        }
        Ok(room)
    }

    /// The index of the cell among these that takes the fewest bytes to write next, the first of them if several do.
    fn cheapest(&self, window: &[((u16, u16), &Cell)]) -> Option<usize> {
        let mut best = None;
        for (index, ((y, x), cell)) in window.iter().enumerate() {
            let cost = self.pen.cost((*x, *y), cell);
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, index));
            }
            if cost == 0 {
                break;
            }
        }
        best.map(|(_, index)| index)
    }

    /// Writes pending cells in the order of rows: from the top after a frame that they did not fit in, then from the first that
    /// the next frame had no room for either, wrapping around.
    fn write_pending(&mut self) -> io::Result<()> {
        let behind = self.pending.split_off(&self.next);
        let before = std::mem::take(&mut self.pending);
        for (place, cell) in behind.into_iter().chain(before) {
            if self.pending.is_empty() && self.put(place, &cell)? {
                continue;
            }
            if self.pending.is_empty() {
                self.next = place;
            }
            self.pending.insert(place, cell);
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
        if self.has_pending() {
            self.pending.extend(cells.map(|(x, y, cell)| ((y, x), cell.clone())));
            return self.write_pending();
        }
        let mut cells = cells.map(|(x, y, cell)| ((y, x), cell));
        let mut window: Vec<_> = cells.by_ref().take(WINDOW).collect();
        while let Some(index) = self.cheapest(&window) {
            let (place, cell) = window.remove(index);
            if !self.put(place, cell)? {
                window.push((place, cell));
                let rest = window.into_iter().chain(cells);
                self.pending.extend(rest.map(|(place, cell)| (place, cell.clone())));
                self.next = (0, 0);
                break;
            }
            window.extend(cells.next());
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
            self.pending.clear();
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

    fn flush(&mut self) -> io::Result<()> {
        if self.synchronized && !self.bytes.is_empty() {
            queue!(self.bytes, EndSynchronizedUpdate)?;
        }
        self.crossterm().flush()
    }
}
