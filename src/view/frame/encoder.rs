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

/// The bytes that a cell rarely takes more than.
const BYTES: usize = 8;

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
    /// Cells that did not fit in earlier frames, those of pictures behind those of letters, by row and column.
    pending: BTreeMap<(bool, u16, u16), Cell>,
    /// Where the next frame begins with each of the two: at the first of them from here on.
    next: [(u16, u16); 2],
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
            next: [(0, 0); 2],
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

    /// Keeps cells for later frames.
    fn keep<'a>(&mut self, cells: impl Iterator<Item = ((u16, u16), &'a Cell)>) {
        for ((y, x), cell) in cells {
            let is_of_picture = is_of_picture(cell);
            self.pending.remove(&(!is_of_picture, y, x));
            self.pending.insert((is_of_picture, y, x), cell.clone());
        }
    }

    /// Writes pending cells, those of letters first, each in the order of rows: from the top after a frame that they did not fit
    /// in, then from the first that the next frame had no room for either, wrapping around.
    fn write_pending(&mut self) -> io::Result<()> {
        let mut letters = std::mem::take(&mut self.pending);
        let pictures = letters.split_off(&(true, 0, 0));
        for (kind, mut before) in [letters, pictures].into_iter().enumerate() {
            let (y, x) = self.next[kind];
            let behind = before.split_off(&(kind == 1, y, x));
            let mut is_first = true;
            for (place, cell) in behind.into_iter().chain(before) {
                let (_, y, x) = place;
                if self.pending.is_empty() && self.put((y, x), &cell)? {
                    continue;
                }
                if std::mem::take(&mut is_first) {
                    self.next[kind] = (y, x);
                }
                self.pending.insert(place, cell);
            }
        }
        Ok(())
    }

    /// Writes cells, next to each other as far as that takes fewer bytes, and keeps those for which there is no room.
    fn write<'a>(
        &mut self,
        mut cells: impl Iterator<Item = ((u16, u16), &'a Cell)>,
    ) -> io::Result<()> {
        let mut window: Vec<_> = cells.by_ref().take(WINDOW).collect();
        while let Some(index) = self.cheapest(&window) {
            let (place, cell) = window.remove(index);
            if !self.put(place, cell)? {
                window.push((place, cell));
                self.keep(window.into_iter().chain(cells));
                self.next = [(0, 0); 2];
                break;
            }
            window.extend(cells.next());
        }
        Ok(())
    }
}

/// Whether a cell shows part of a picture, a frame or a bar, and no letter.
fn is_of_picture(cell: &Cell) -> bool {
    let first = cell.symbol().chars().next();
    first.is_some_and(|c| {
        matches!(c, '\u{2500}'..='\u{25ff}' | '\u{2800}'..='\u{28ff}' | '\u{1fb00}'..='\u{1fbff}' | '\u{1cd00}'..='\u{1ceaf}')
    })
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
        let cells = cells.map(|(x, y, cell)| ((y, x), cell));
        if self.has_pending() {
            self.keep(cells);
            return self.write_pending();
        }
        if self.most == usize::MAX {
            return self.write(cells);
        }
        // where there may be no room for all, letters come first
        let cells: Vec<_> = cells.collect();
        if cells.len().saturating_mul(BYTES) <= self.most {
            return self.write(cells.into_iter());
        }
        let (pictures, letters): (Vec<_>, Vec<_>) =
            cells.into_iter().partition(|(_, cell)| is_of_picture(cell));
        self.write(letters.into_iter().chain(pictures))
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
