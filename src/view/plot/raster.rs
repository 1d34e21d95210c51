//! The raster: dots finer than cells, in layers.
//!
//! In: points, lines and clouds in the data coordinates of a [`PlotFrame`]. Out: cells of a buffer. A cell has one colour, so
//! it shows the dots of its highest layer only, in the style of the newest of them; a marker keeps the dots beside it
//! blank. Never here: axes, or the meaning of the curves.

mod bands;
mod cached_trail;
mod character;
mod cloud;
mod course;
mod halo;
mod letter;
mod marker;
mod polyline;

use std::cmp::Ordering;

use ratatui::buffer::{Buffer, Cell as ScreenCell};
use ratatui::layout::{Position, Rect};
use ratatui::style::Style;
use ratatui::symbols::pixel::{OCTANTS, QUADRANTS, SEXTANTS};

use super::scale::PlotFrame;
use crate::num::math;
use crate::view::glyphs::Glyphs;
use crate::view::theme::{Dash, Shade};
pub use cached_trail::{Ages, CachedTrail};
use letter::{letter, points};
pub use marker::Marker;

/// The most cells drawn in a row or column; no terminal has more.
const MOST_CELLS: u16 = 1024;

/// The share of dots from which on the shading of a surface is heavier in ASCII.
const LIGHT: f64 = 0.6;

/// One in so many cells of a surface has a character in ASCII.
const SPARSE: i32 = 4;

/// The dots of a cell from which on a mass fills it in ASCII.
const FILLED: u32 = 3;

/// How a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pen {
    /// Style of the cells it crosses.
    pub style: Style,
    /// Layer; the highest one in a cell sets its style.
    pub layer: u8,
    /// Age rank within a layer; the greatest one wins.
    pub fresh: u8,
    /// Share of the dots that are drawn, 0 to 1.
    pub coverage: f64,
    /// The pattern along the line.
    pub dash: Dash,
    /// Its characters in ASCII.
    pub letters: Letters,
}

/// The characters of a line in ASCII.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Letters {
    /// The height at which it crosses each cell, as in a plot of a function.
    #[default]
    Height,
    /// Its direction: an edge of a body in space.
    Direction,
    /// Dots: scenery.
    Dots,
    /// A solid mass: blocks where it covers enough of a cell, and elsewhere the height at which it does.
    Mass,
}

impl Pen {
    /// A solid line on a layer.
    pub fn new(style: Style, layer: u8) -> Self {
        Self { style, layer, fresh: 0, coverage: 1.0, dash: Dash::Full, letters: Letters::Height }
    }

    /// The same pen with fewer dots: 0.5 looks dotted, 1 is solid.
    #[must_use]
    pub fn covering(self, coverage: f64) -> Self {
        Self { coverage, ..self }
    }

    /// A line in a shade of the theme.
    pub fn shaded(shade: Shade, layer: u8) -> Self {
        let Shade { style, coverage, dash } = shade;
        Self { coverage, dash, ..Self::new(style, layer) }
    }

    fn aged(shade: Shade, layer: u8, fresh: usize) -> Self {
        Self { fresh: fresh.min(usize::from(u8::MAX)) as u8, ..Self::shaded(shade, layer) }
    }
}

/// One cell: its dots, and the origin of its style.
#[derive(Clone, Copy, Debug, Default)]
struct Cell {
    /// One bit per dot, row by row, starting with the leftmost dot of a row.
    dots: u8,
    /// The dots of the layer that sets the style; these are shown.
    upper: u8,
    /// A character that replaces the dots: a marker or, in ASCII, the age of a trail.
    sign: Option<char>,
    /// Layer of the style, whether it is a marker's, and its freshness; the greatest wins.
    rank: (u8, bool, u8),
    style: Style,
}

/// The dots over an area of cells.
#[derive(Clone, Debug)]
pub struct Raster {
    area: Rect,
    glyphs: Glyphs,
    /// The number of dots: columns, rows.
    size: [i32; 2],
    cells: Vec<Cell>,
}

impl Raster {
    /// Creates an empty raster over an area of the screen.
    pub fn new(area: Rect, glyphs: Glyphs) -> Self {
        let area =
            Rect { width: area.width.min(MOST_CELLS), height: area.height.min(MOST_CELLS), ..area };
        let count = usize::from(area.width) * usize::from(area.height);
        let (wide, high) = glyphs.dots();
        let size =
            [i32::from(area.width) * i32::from(wide), i32::from(area.height) * i32::from(high)];
        Self { area, glyphs, size, cells: vec![Cell::default(); count] }
    }

    /// The number of dots set.
    pub fn count(&self) -> usize {
        self.cells.iter().map(|cell| cell.dots.count_ones() as usize).sum()
    }

    /// Adds the dots of another raster of the same area; styles are ignored.
    pub fn absorb(&mut self, other: &Self) {
        for (cell, other) in self.cells.iter_mut().zip(&other.cells) {
            cell.dots |= other.dots;
        }
    }

    /// The fraction of this raster's non-empty cells in which another raster of the same area has dots too; in ASCII,
    /// neighbouring cells beside them count as well, and with half blocks, which fill their cells, all around them. It is 0
    /// if there are none.
    pub fn shared(&self, other: &Self) -> f64 {
        let wide = usize::from(self.area.width).max(1);
        let [across, along] = match self.glyphs {
            Glyphs::Ascii => [1, 0],
            Glyphs::HalfBlock => [1, 1],
            _ => [0, 0],
        };
        let last = self.cells.len() / wide;
        let near = |i: usize| {
            let (row, column) = (i / wide, i % wide);
            let columns = column.saturating_sub(across)..=(column + across).min(wide - 1);
            let mut rows = row.saturating_sub(along)..(row + along + 1).min(last);
            rows.any(|row| columns.clone().any(|column| other.cells[row * wide + column].dots != 0))
        };
        let inked = || (0..self.cells.len()).filter(|i| self.cells[*i].dots != 0);
        inked().filter(|i| near(*i)).count() as f64 / inked().count().max(1) as f64
    }

    /// Whether a dot is set; `[0, 0]` is at the upper left.
    pub fn is_set(&self, [x, y]: [i32; 2]) -> bool {
        self.place([x, y]).is_some_and(|(index, bit)| self.cells[index].dots & bit != 0)
    }

    /// The number of dots: columns, rows.
    pub fn size(&self) -> [i32; 2] {
        self.size
    }

    /// Sets one dot; a dot outside the raster is ignored.
    pub fn dot(&mut self, dot: [i32; 2], pen: &Pen) {
        self.ink(dot, pen, None);
    }

    /// Sets one dot of a shaded surface. In ASCII some of its cells have a light character in place of their dots, so that lines on
    /// the surface are seen.
    pub fn shade(&mut self, dot: [i32; 2], pen: &Pen) {
        if !self.glyphs.is_ascii() || pen.coverage >= 1.0 {
            return self.ink(dot, pen, None);
        }
        let [wide, high] = self.cell();
        let [column, row] = [dot[0] / wide, dot[1] / high];
        if (column + SPARSE / 2 * row) % SPARSE == 0 {
            let light = if pen.coverage < LIGHT { '.' } else { ':' };
            self.ink(dot, &pen.covering(1.0), Some(light));
        }
    }

    /// Draws single dots.
    pub fn points(
        &mut self,
        frame: &PlotFrame,
        points: impl IntoIterator<Item = [f64; 2]>,
        pen: &Pen,
    ) {
        let size = self.size();
        for point in points {
            let place = frame.dot(point, size);
            if (0..2).all(|i| (0.0..=f64::from(size[i])).contains(&place[i])) {
                let dot = std::array::from_fn(|i| (place[i] as i32).min(size[i] - 1));
                self.dot(dot, pen);
                self.letter_points(dot, pen);
            }
        }
    }

    /// In ASCII, shows the dots of a cell as points and not as the strokes of a line.
    fn letter_points(&mut self, dot: [i32; 2], pen: &Pen) {
        if let (Glyphs::Ascii, Some((index, _))) = (self.glyphs, self.place(dot)) {
            let cell = &mut self.cells[index];
            if cell.rank == (pen.layer, false, pen.fresh) {
                cell.sign = Some(points(cell.upper));
            }
        }
    }

    /// Fills a disc about a point of the frame, with its radius in the units of the axes.
    pub fn disc(&mut self, frame: &PlotFrame, [x, y]: [f64; 2], radius: f64, pen: &Pen) {
        let size = self.size();
        let [left, top] = frame.dot([x - radius, y + radius], size);
        let [right, bottom] = frame.dot([x + radius, y - radius], size);
        let (middle, half) = (
            [f64::midpoint(left, right), f64::midpoint(top, bottom)],
            [right - left, bottom - top],
        );
        if ![left, top, right, bottom].iter().all(|v| v.is_finite()) || half.contains(&0.0) {
            return;
        }
        let range = |from: f64, to: f64, most: i32| {
            let within = |v: f64| v.clamp(0.0, f64::from(most));
            within(from.min(to).floor()) as i32..within(from.max(to).ceil()) as i32
        };
        for row in range(top, bottom, size[1]) {
            for column in range(left, right, size[0]) {
                let off = |dot: i32, k: usize| (f64::from(dot) + 0.5 - middle[k]) * 2.0 / half[k];
                if math::hypot(off(column, 0), off(row, 1)) <= 1.0 {
                    self.ink([column, row], pen, None);
                }
            }
        }
    }

    /// Copies the dots to the screen. Cells without dots do not change, and neither does the background.
    pub fn draw(&self, buffer: &mut Buffer) {
        self.draw_where(buffer, |_, _| true);
    }

    /// Copies the dots of some cells, given by their index row by row and by their position, to the screen where it is blank.
    pub fn draw_on_blank(&self, buffer: &mut Buffer, shown: impl Fn(usize, Position) -> bool) {
        let wide = usize::from(self.area.width).max(1);
        let at = |index: usize| Position {
            x: self.area.x + (index % wide) as u16,
            y: self.area.y + (index / wide) as u16,
        };
        self.draw_where(buffer, |index, place| place.symbol() == " " && shown(index, at(index)));
    }

    fn draw_where(&self, buffer: &mut Buffer, shows: impl Fn(usize, &ScreenCell) -> bool) {
        let covered = self.beside_markers();
        // A raster and what is on the screen have the same columns, row by row.
        let shown = self.area.intersection(buffer.area);
        if shown.is_empty() {
            return;
        }
        for y in shown.top()..shown.bottom() {
            let first = usize::from(y - self.area.y) * usize::from(self.area.width)
                + usize::from(shown.x - self.area.x);
            let from = buffer.index_of(shown.x, y);
            let there = &mut buffer.content[from..from + usize::from(shown.width)];
            for (index, place) in (first..).zip(there) {
                let cell = &self.cells[index];
                if (cell.upper != 0 || cell.sign.is_some()) && shows(index, place) {
                    self.show(index, covered.get(index).copied().unwrap_or(0), place);
                }
            }
        }
    }

    /// Shows a cell on the screen but for some of its dots.
    fn show(&self, index: usize, blank: u8, place: &mut ScreenCell) {
        let cell = &self.cells[index];
        let dots = cell.upper & !blank;
        let symbol = match (cell.sign, self.glyphs) {
            (Some(sign), _) => sign,
            (None, _) if dots == 0 => return,
            (None, Glyphs::Braille) => braille(dots),
            (None, Glyphs::HalfBlock) => half_block(dots),
            (None, Glyphs::Quadrant) => QUADRANTS[usize::from(dots & 0xf)],
            (None, Glyphs::Sextant) => SEXTANTS[usize::from(dots & 0x3f)],
            (None, Glyphs::Octant) => OCTANTS[usize::from(dots)],
            (None, Glyphs::Ascii) => letter(dots),
        };
        // The old modifiers are removed with the old character.
        let background = place.bg;
        place.reset();
        place.set_char(symbol).set_bg(background).set_style(cell.style);
    }

    fn ink(&mut self, dot: [i32; 2], pen: &Pen, sign: Option<char>) {
        let Some((index, bit)) = self.place(dot) else { return };
        if pen.coverage < 1.0 {
            // A character in ASCII is drawn whole or not at all; its parts are not thinned.
            let [wide, high] = if self.glyphs.is_ascii() { self.cell() } else { [1, 1] };
            if noise([dot[0] / wide, dot[1] / high]) >= pen.coverage {
                return;
            }
        }
        self.set((index, bit), pen, sign);
    }

    fn set(&mut self, (index, bit): (usize, u8), pen: &Pen, sign: Option<char>) {
        let cell = &mut self.cells[index];
        cell.dots |= bit;
        let rank = (pen.layer, false, pen.fresh);
        if pen.layer >= cell.rank.0 {
            cell.upper = if pen.layer > cell.rank.0 { bit } else { cell.upper | bit };
        }
        if rank >= cell.rank {
            cell.rank = rank;
            cell.style = pen.style;
            let is_filled = pen.letters == Letters::Mass && cell.upper.count_ones() >= FILLED;
            cell.sign = sign.or(is_filled.then_some('#'));
        }
    }

    /// Adds everything on another raster of the same area.
    pub fn lay(&mut self, other: &Self) {
        for (cell, other) in self.cells.iter_mut().zip(&other.cells) {
            if other.dots == 0 && other.sign.is_none() {
                continue;
            }
            cell.dots |= other.dots;
            match other.rank.0.cmp(&cell.rank.0) {
                Ordering::Greater => cell.upper = other.upper,
                Ordering::Equal => cell.upper |= other.upper,
                Ordering::Less => {}
            }
            if other.rank >= cell.rank {
                (cell.rank, cell.style, cell.sign) = (other.rank, other.style, other.sign);
            }
        }
    }

    /// Adds everything on a raster of points. In ASCII a cell shows them together with those of the same rank in it.
    pub fn lay_points(&mut self, other: &Self) {
        self.lay(other);
        if self.glyphs.is_ascii() {
            for (cell, other) in self.cells.iter_mut().zip(&other.cells) {
                if other.dots != 0 && cell.rank == other.rank {
                    cell.sign = Some(points(cell.upper));
                }
            }
        }
    }

    /// The number of dots in a cell: columns, rows.
    fn cell(&self) -> [i32; 2] {
        let (wide, high) = self.glyphs.dots();
        [i32::from(wide), i32::from(high)]
    }

    /// Whether a marker stands in a cell of the screen.
    pub fn has_marker(&self, at: Position) -> bool {
        let (column, row) = (at.x.wrapping_sub(self.area.x), at.y.wrapping_sub(self.area.y));
        let index = usize::from(row) * usize::from(self.area.width) + usize::from(column);
        let is_inside = column < self.area.width && row < self.area.height;
        is_inside && self.cells.get(index).is_some_and(|cell| cell.rank.1)
    }

    /// The index of a dot's cell, and the bit of the dot.
    fn place(&self, [x, y]: [i32; 2]) -> Option<(usize, u8)> {
        let [wide, high] = self.size;
        if !(0..wide).contains(&x) || !(0..high).contains(&y) {
            return None;
        }
        let (x, y, across) = (x as u32, y as u32, u32::from(self.area.width));
        let place = |columns: u32, rows: u32| {
            let cell = y / rows * across + x / columns;
            (cell as usize, 1 << (y % rows * columns + x % columns))
        };
        // a division by a known number is a shift or a product
        Some(match self.glyphs.dots() {
            (2, 4) => place(2, 4),
            (2, 3) => place(2, 3),
            (columns, rows) => place(columns.into(), rows.into()),
        })
    }
}

/// A value in 0..1 fixed to a dot, spread evenly along every direction (M. Roberts' R2 sequence, 2018), so that
/// thinned lines neither flicker nor vanish.
fn noise([x, y]: [i32; 2]) -> f64 {
    let along = f64::from(x) * 0.754_877_666_246_692_7 + f64::from(y) * 0.569_840_290_998_053_2;
    // Dots are counted from zero; a fraction taken by way of a whole number needs no call.
    along - along as i64 as f64
}

/// Maps dots in row order to the order of Unicode's braille block.
fn braille(dots: u8) -> char {
    BRAILLE[usize::from(dots)]
}

/// The character of each set of dots.
const BRAILLE: [char; 256] = {
    const BITS: [u32; 8] = [0x01, 0x08, 0x02, 0x10, 0x04, 0x20, 0x40, 0x80];
    let mut characters = ['⠀'; 256];
    let mut dots = 0;
    while dots < 256 {
        let (mut pattern, mut bit) = (0, 0);
        while bit < 8 {
            pattern += (dots as u32 >> bit & 1) * BITS[bit];
            bit += 1;
        }
        if let Some(character) = char::from_u32(0x2800 + pattern) {
            characters[dots] = character;
        }
        dots += 1;
    }
    characters
};

fn half_block(dots: u8) -> char {
    match dots & 3 {
        1 => '▀',
        2 => '▄',
        _ => '█',
    }
}
