//! The pen: cells as the bytes that make a terminal show them, as few as possible.
//!
//! In: cells and where they stand. Out: bytes. It remembers where the cursor is and how it writes, so that only
//! changes are sent. Never here: which cells have changed, or sending anything.
//!
//! ratatui's own writer is passed over: with `NO_COLOR` its colours become a bare `CSI m`, which also ends bold and
//! reverse; and it spends more bytes on placing the cursor and on colours, which a slow line feels.

use ratatui::buffer::Cell;
use ratatui::style::{Color, Modifier};
use unicode_width::UnicodeWidthStr;

use crate::view::sgr::{self, BACKGROUND, FOREGROUND, MODIFIERS};

/// Modifiers that can be seen on a blank cell.
const ON_BLANKS: Modifier =
    Modifier::REVERSED.union(Modifier::UNDERLINED).union(Modifier::CROSSED_OUT);

/// How many lines down are worth as many line feeds.
const FEEDS: u16 = 4;

/// What the terminal's cursor would do next; `None` where that is not known.
#[derive(Clone, Debug, Default)]
pub(super) struct Pen {
    at: Option<(u16, u16)>,
    ink: Option<CellStyle>,
}

/// How characters are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct CellStyle {
    fg: Color,
    bg: Color,
    modifier: Modifier,
}

impl Pen {
    /// Clears the whole screen, whatever was there and however the pen was left.
    pub(super) fn clear(&mut self, out: &mut Vec<u8>) {
        out.extend(b"\x1b[0m\x1b[2J");
        self.at = None;
        self.ink =
            Some(CellStyle { fg: Color::Reset, bg: Color::Reset, modifier: Modifier::empty() });
    }

    /// Writes a cell of a screen so many columns wide.
    pub(super) fn put(&mut self, out: &mut Vec<u8>, (x, y): (u16, u16), cell: &Cell, width: u16) {
        self.go(out, x, y);
        self.dip(out, cell);
        let symbol = cell.symbol();
        out.extend(symbol.as_bytes());
        // Terminals disagree on the width of what is more than one character, and on where the cursor is after the last
        // column.
        let plain = symbol.chars().count() == 1 && symbol.width() == 1;
        let known = plain && x + 1 < width;
        self.at = known.then_some((x + 1, y));
    }

    /// Leaves the cursor at a cell.
    pub(super) fn rest(&mut self, out: &mut Vec<u8>, (x, y): (u16, u16)) {
        self.go(out, x, y);
        self.at = Some((x, y));
    }

    /// Moves to a cell by the shortest way.
    fn go(&mut self, out: &mut Vec<u8>, x: u16, y: u16) {
        let Some((column, row)) = self.at else {
            out.extend(place(x, y));
            return;
        };
        if (column, row) == (x, y) {
            return;
        }
        let mut ways = vec![place(x, y)];
        if (row..=row + FEEDS).contains(&y) {
            let feeds = vec![b'\n'; usize::from(y - row)];
            let aside = if x >= column { forward(x - column) } else { back(column - x) };
            ways.push([feeds.clone(), aside].concat());
            ways.push([b"\r".to_vec(), feeds, forward(x)].concat());
        }
        out.extend(ways.into_iter().min_by_key(Vec::len).unwrap_or_default());
    }

    /// Takes up the ink of a cell.
    fn dip(&mut self, out: &mut Vec<u8>, cell: &Cell) {
        let mut ink = CellStyle { fg: cell.fg, bg: cell.bg, modifier: cell.modifier };
        if let (" ", Some(now)) = (cell.symbol(), self.ink) {
            let seen = ink.modifier & ON_BLANKS;
            ink.modifier = seen | (now.modifier - ON_BLANKS);
            if seen.is_empty() {
                ink.fg = now.fg;
            }
        }
        if self.ink == Some(ink) {
            return;
        }
        let afresh = sequence(&sgr::afresh(ink.modifier, ink.fg, ink.bg), 'm');
        let change = self.ink.map(|now| sequence(&change(now, ink), 'm'));
        out.extend(change.filter(|c| c.len() <= afresh.len()).unwrap_or(afresh));
        self.ink = Some(ink);
    }
}

/// To a place, counted from 0.
fn place(x: u16, y: u16) -> Vec<u8> {
    match (x, y) {
        (0, 0) => sequence(&[], 'H'),
        (0, _) => sequence(&[y + 1], 'H'),
        _ => sequence(&[y + 1, x + 1], 'H'),
    }
}

/// So many columns to the right.
fn forward(columns: u16) -> Vec<u8> {
    match columns {
        0 => Vec::new(),
        1 => sequence(&[], 'C'),
        _ => sequence(&[columns], 'C'),
    }
}

/// So many columns to the left.
fn back(columns: u16) -> Vec<u8> {
    match columns {
        0..=3 => vec![8; columns.into()],
        _ => sequence(&[columns], 'D'),
    }
}

/// A control sequence.
fn sequence(numbers: &[u16], last: char) -> Vec<u8> {
    let numbers: Vec<_> = numbers.iter().map(u16::to_string).collect();
    format!("\x1b[{}{last}", numbers.join(";")).into_bytes()
}

/// From one ink to another.
fn change(from: CellStyle, to: CellStyle) -> Vec<u16> {
    let mut numbers = Vec::new();
    let mut kept = from.modifier;
    for (modifier, _, off) in MODIFIERS {
        if (kept - to.modifier).contains(modifier) {
            numbers.push(off);
            MODIFIERS.iter().filter(|m| m.2 == off).for_each(|m| kept.remove(m.0));
        }
    }
    numbers.extend(sgr::weights(to.modifier - kept));
    for (old, new, ground) in [(from.fg, to.fg, FOREGROUND), (from.bg, to.bg, BACKGROUND)] {
        if old != new {
            numbers.extend(sgr::colour(new, ground));
        }
    }
    numbers
}
