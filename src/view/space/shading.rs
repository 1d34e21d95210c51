//! Shaded surfaces, where the terminal has colours enough: a cell that a surface covers has a background, on which lines are
//! drawn; the edges of surfaces are blocks of a quarter of a cell or, where it has four rows of dots, of a row of them.
//!
//! In: the dots that surfaces cover, how brightly they are lit. Out: backgrounds and blocks. Never here: lines, or
//! terminals of few colours, where surfaces are dots.

use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::{Position, Rect};
use ratatui::style::{Color, Style};
use ratatui::symbols::pixel::QUADRANTS;

use super::edge_block;
use crate::view::glyphs::Glyphs;
use crate::view::theme::{Theme, Tones};

/// A cell in which something is written has the background of a surface that covers this many of its quarters. Where a line
/// crosses the edge of a surface it yields to the block from this many on: a background would square the edge.
const HALF: usize = 2;

/// The same by the dots of braille.
const HALF_OF_DOTS: u32 = 4;

/// The bits of the dots of braille, row by row.
const BRAILLE: [[u8; 2]; 4] = [[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]];

/// A quarter of a cell: the number of its dots that are covered, their light, and the tones of the last of them.
#[derive(Clone, Copy, Debug, Default)]
struct Quarter {
    count: u8,
    light: f32,
    tones: u16,
}

/// The surfaces over an area of cells.
#[derive(Debug)]
pub(super) struct Shading {
    area: Rect,
    /// The number of dots in a cell: columns, rows.
    dots: [usize; 2],
    /// The number of dots in each quarter of a cell.
    room: [u8; 4],
    cells: Vec<[Quarter; 4]>,
    /// The covered dots of each cell, as braille has them; `None` where edges are blocks.
    braille: Option<Vec<u8>>,
    /// The tones of each surface.
    tones: Vec<Tones>,
}

impl Shading {
    pub(super) fn new(area: Rect, glyphs: Glyphs) -> Self {
        let (wide, high) = glyphs.dots();
        let dots = [usize::from(wide), usize::from(high)];
        let mut room = [0; 4];
        for place in 0..dots[0] * dots[1] {
            for quarter in quarters([place % dots[0], place / dots[0]], dots) {
                room[quarter] += 1;
            }
        }
        let braille = (glyphs == Glyphs::Braille).then(Vec::new);
        Self { area, dots, room, cells: Vec::new(), braille, tones: Vec::new() }
    }

    /// The number of dots in a block: columns, rows.
    pub(super) fn block(&self) -> [f64; 2] {
        self.dots.map(|dots| (dots as f64 / 2.0).max(1.0))
    }

    /// Adds the tones of a surface; returns their number.
    pub(super) fn add(&mut self, tones: Tones) -> usize {
        self.tones.push(tones);
        self.tones.len() - 1
    }

    /// Covers a dot with a surface of these tones, in a light from 0 to 1.
    pub(super) fn cover(&mut self, [x, y]: [i32; 2], tones: usize, light: f64) {
        let (wide, high) = (usize::from(self.area.width), usize::from(self.area.height));
        if self.cells.is_empty() {
            self.cells = vec![[Quarter::default(); 4]; wide * high];
            self.braille.iter_mut().for_each(|dots| *dots = vec![0; wide * high]);
        }
        let [columns, rows] = self.dots;
        let (x, y) = (x as usize, y as usize);
        let (column, row) = (x / columns, y / rows);
        if column >= wide || row >= high {
            return;
        }
        if let Some(dots) = &mut self.braille {
            dots[row * wide + column] |= BRAILLE[y % rows][x % columns];
        }
        for quarter in quarters([x % columns, y % rows], self.dots) {
            let quarter = &mut self.cells[row * wide + column][quarter];
            *quarter = Quarter {
                count: quarter.count + 1,
                light: quarter.light + light as f32,
                tones: tones as u16,
            };
        }
    }

    /// Whether any surface is shaded.
    pub(super) fn is_on(&self) -> bool {
        !self.cells.is_empty()
    }

    /// Whether the edges of solids are drawn as lines in a cell: not where they are blocks, nor in a blank cell beside these.
    pub(super) fn has_edges(&self, index: usize) -> bool {
        let Some(quarters) = self.cells.get(index) else { return true };
        self.is_whole(quarters) || is_blank(quarters) && !self.is_beside_surface(index)
    }

    /// Whether a surface covers some of a cell next to this one.
    fn is_beside_surface(&self, index: usize) -> bool {
        let (wide, high) = (usize::from(self.area.width), usize::from(self.area.height));
        let (column, row) = (index % wide, index / wide);
        let around = |at: usize, end: usize| at.saturating_sub(1)..(at + 2).min(end);
        let mut cells =
            around(row, high).flat_map(|y| around(column, wide).map(move |x| y * wide + x));
        cells.any(|index| !is_blank(&self.cells[index]))
    }

    fn is_whole(&self, quarters: &[Quarter; 4]) -> bool {
        (0..4).all(|k| is_covered(quarters[k], self.room[k]))
    }

    /// Gives the covered cells their colours: those in which nothing is drawn or written blocks, the others a background. A blank
    /// between two words is written, too.
    pub(super) fn draw(
        &self,
        buffer: &mut Buffer,
        theme: &Theme,
        is_written: impl Fn(Position) -> bool,
    ) {
        for (index, quarters) in self.cells.iter().enumerate() {
            if is_blank(quarters) {
                continue;
            }
            let (column, row) =
                (index % usize::from(self.area.width), index / usize::from(self.area.width));
            let at = (self.area.x + column as u16, self.area.y + row as u16);
            let Some(cell) = buffer.cell_mut(at) else { continue };
            let written = is_written(at.into());
            if !written && self.draw_edge(index, cell) {
                continue;
            }
            let colours = self.colours(quarters);
            let covered = colours.iter().flatten().count();
            let is_edge = (HALF..4).contains(&covered) && is_of_dots(cell.symbol());
            if written || cell.symbol() != " " && !is_edge {
                if let Some(background) = most(&colours, None).filter(|_| covered >= HALF) {
                    let style = theme.legible(cell.style(), background);
                    cell.set_style(style.bg(background));
                }
                continue;
            }
            // A terminal's own background is none of its colours: it can only lie behind.
            let back = if colours.contains(&None) { None } else { most(&colours, None) };
            let Some(front) = most(&colours, back) else {
                if let Some(back) = back {
                    cell.set_bg(back);
                }
                continue;
            };
            let block = (0..4).filter(|&k| colours[k] != back).fold(0, |block, k| block | 1 << k);
            cell.set_char(QUADRANTS[block]).set_fg(front);
            if let Some(back) = back {
                cell.set_bg(back);
            }
        }
    }

    /// Draws what surfaces cover of a cell that they cover in part as a block; returns whether the cell is done. Lines yield to a
    /// surface that covers half of their cell, and marks stay.
    fn draw_edge(&self, index: usize, cell: &mut Cell) -> bool {
        let Some(covered) = self.braille.as_ref().map(|dots| dots[index]) else { return false };
        let Some(block) = edge_block::nearest(covered) else { return false };
        let first = cell.symbol().chars().next();
        let is_braille = matches!(first, Some('\u{2800}'..='\u{28ff}'));
        match cell.symbol() {
            " " => {}
            _ if !is_braille => return false,
            _ if covered.count_ones() < HALF_OF_DOTS => return true,
            _ => {}
        }
        let tone = self.tone(whole(&self.cells[index])).unwrap_or_default();
        cell.set_char(block).set_style(Style::reset().fg(tone));
        true
    }

    /// The colours of the quarters that are covered. Those of a cell that differ by one tone have the same one: a block takes
    /// more bytes than a background, and its edge would move with every change of the light.
    fn colours(&self, quarters: &[Quarter; 4]) -> [Option<Color>; 4] {
        let whole = whole(quarters);
        let steps = quarters.map(|quarter| self.step(quarter));
        let one = quarters.iter().all(|quarter| quarter.tones == whole.tones);
        let apart = steps.iter().max().zip(steps.iter().min()).map_or(0, |(high, low)| high - low);
        if one && apart <= 1 && self.is_whole(quarters) {
            return [self.tone(whole); 4];
        }
        [0, 1, 2, 3].map(|k| {
            is_covered(quarters[k], self.room[k]).then(|| self.tone(quarters[k])).flatten()
        })
    }

    /// The colour of something with this light.
    fn tone(&self, quarter: Quarter) -> Option<Color> {
        let tones = self.tones.get(usize::from(quarter.tones))?;
        tones.get(self.step(quarter)).copied()
    }

    /// The number of the tone of something with this light, or of the darkest where there is none.
    fn step(&self, quarter: Quarter) -> usize {
        let Some(tones) = self.tones.get(usize::from(quarter.tones)) else { return 0 };
        let (last, light) = (tones.len() - 1, quarter.light / f32::from(quarter.count.max(1)));
        ((light * last as f32).round() as usize).min(last)
    }
}

/// Whether a cell holds dots of lines: braille, or blocks of a half, a quarter, a sixth or an eighth of it. Anything else is a mark,
/// such as that of a mass, which stays.
fn is_of_dots(symbol: &str) -> bool {
    let of_dots = |c| {
        let blocks = matches!(c, '\u{2580}'..='\u{259f}' | '\u{1cd00}'..='\u{1cde5}');
        blocks || matches!(c, '\u{2800}'..='\u{28ff}' | '\u{1fb00}'..='\u{1fbaf}')
    };
    symbol.chars().all(of_dots)
}

/// What is covered of a cell, with the tones of the last quarter of which something is.
fn whole(quarters: &[Quarter; 4]) -> Quarter {
    let covered = quarters.iter().filter(|quarter| quarter.count > 0);
    covered.fold(Quarter::default(), |sum, quarter| Quarter {
        count: sum.count + quarter.count,
        light: sum.light + quarter.light,
        tones: quarter.tones,
    })
}

/// Whether nothing of a cell is covered.
fn is_blank(quarters: &[Quarter; 4]) -> bool {
    quarters.iter().all(|quarter| quarter.count == 0)
}

/// Whether at least half of a quarter is covered.
fn is_covered(quarter: Quarter, room: u8) -> bool {
    quarter.count > 0 && 2 * quarter.count >= room
}

/// The most frequent of some colours but for one.
fn most(colours: &[Option<Color>; 4], but: Option<Color>) -> Option<Color> {
    let others = || colours.iter().flatten().filter(|colour| Some(**colour) != but);
    let count = |colour: &Color| others().filter(|other| *other == colour).count();
    others().max_by_key(|colour| count(colour)).copied()
}

/// The quarters of a cell, row by row, in which a dot lies; where a cell has one column of dots they lie in two.
fn quarters([x, y]: [usize; 2], [columns, rows]: [usize; 2]) -> impl Iterator<Item = usize> {
    let row = 2 * (y * 2 / rows);
    let columns = if columns == 1 { 0..2 } else { x * 2 / columns..x * 2 / columns + 1 };
    columns.map(move |column| row + column)
}

#[cfg(test)]
mod tests {
    use ratatui::style::Color;

    use super::*;

    /// A row of cells, of which some are covered whole and some on their left half.
    fn row(whole: u16, half: u16, glyphs: Glyphs) -> Shading {
        let area = Rect::new(0, 0, whole + half, 1);
        let mut shading = Shading::new(area, glyphs);
        let tones = shading.add([Color::Blue; 10]);
        for cell in 0..whole + half {
            for dot in 0..8 {
                let (x, y) = (dot % 2, dot / 2);
                if cell < whole || x == 0 {
                    shading.cover([2 * i32::from(cell) + x, y], tones, 0.5);
                }
            }
        }
        shading
    }

    #[test]
    fn an_edge_is_a_block_and_the_inside_a_background() {
        let shading = row(3, 1, Glyphs::Octant);
        let mut buffer = Buffer::empty(Rect::new(0, 0, 4, 1));
        let theme = Theme::dark(crate::view::colour::ColourDepth::True);
        shading.draw(&mut buffer, &theme, |_| false);
        assert_eq!((buffer[(1, 0)].symbol(), buffer[(1, 0)].bg), (" ", Color::Blue));
        assert_eq!((buffer[(3, 0)].symbol(), buffer[(3, 0)].fg), ("▌", Color::Blue));
        assert_eq!(buffer[(3, 0)].bg, Color::Reset);
    }

    /// A background would square the edge: a line leaves its cells to the block, and a mark keeps them.
    #[test]
    fn lines_yield_to_an_edge_and_marks_do_not() {
        let shading = row(1, 2, Glyphs::Octant);
        let mut buffer = Buffer::empty(Rect::new(0, 0, 3, 1));
        for (x, symbol) in ["⠉", "⠉", "●"].into_iter().enumerate() {
            buffer[(x as u16, 0)].set_symbol(symbol);
        }
        let theme = Theme::dark(crate::view::colour::ColourDepth::True);
        shading.draw(&mut buffer, &theme, |_| false);
        let cells: Vec<_> = buffer.content.iter().map(|cell| (cell.symbol(), cell.bg)).collect();
        let expected = [("⠉", Color::Blue), ("▌", Color::Reset), ("●", Color::Blue)];
        assert_eq!(cells, expected);
    }

    /// With the four rows of braille a block may fill one or three of them; a line yields to it.
    #[test]
    fn an_edge_beside_braille_is_a_block() {
        let shading = row(1, 3, Glyphs::Braille);
        let mut buffer = Buffer::empty(Rect::new(0, 0, 4, 1));
        buffer[(2, 0)].set_symbol("⠉");
        buffer[(3, 0)].set_symbol("●");
        let theme = Theme::dark(crate::view::colour::ColourDepth::True);
        shading.draw(&mut buffer, &theme, |_| false);
        let cells: Vec<_> = buffer.content.iter().map(|cell| (cell.symbol(), cell.bg)).collect();
        let none = Color::Reset;
        assert_eq!(cells, [(" ", Color::Blue), ("▌", none), ("▌", none), ("●", Color::Blue)]);
        assert_eq!(buffer[(2, 0)].fg, Color::Blue);
    }
}
