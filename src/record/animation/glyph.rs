//! Characters as pixels: dots, blocks and frames by their exact shapes, letters by a font.
//!
//! In: a cell of the screen. Out: the coverage of its pixels in a few levels. Never here: colours.

use std::collections::HashMap;

use super::coverage::{Coverage, PixelPoint, curve, distance_squared};
use super::font::Font;
use super::screen::ScreenCell;
use crate::record::screenshot::shape::{CELL, DOT, GlyphShape, PathPart, path_parts};

/// The number of levels of coverage above none.
pub(super) const LEVELS: usize = 8;

/// A character as pixels.
pub(super) struct Glyph {
    width: usize,
    levels: Vec<u8>,
    histogram: [u32; LEVELS + 1],
}

impl Glyph {
    /// The levels of coverage, row by row.
    pub(super) fn rows(&self) -> impl Iterator<Item = &[u8]> {
        self.levels.chunks(self.width)
    }

    /// The number of pixels of each level.
    pub(super) fn histogram(&self) -> &[u32; LEVELS + 1] {
        &self.histogram
    }
}

/// What distinguishes the glyphs of characters: bold, italic, underlined, struck through.
type Weight = [bool; 4];

/// The characters that were drawn.
pub(super) struct GlyphAtlas {
    cell: (usize, usize),
    font: Font,
    known: HashMap<(char, Weight), Glyph>,
}

impl GlyphAtlas {
    /// For cells of a width in pixels, which are twice as high.
    pub(super) fn new(width: usize) -> GlyphAtlas {
        let cell = (width, 2 * width);
        GlyphAtlas { cell, font: Font::new(cell), known: HashMap::new() }
    }

    /// The width and height of a cell in pixels.
    pub(super) fn cell(&self) -> (usize, usize) {
        self.cell
    }

    /// The pixels of a cell.
    pub(super) fn of(&mut self, cell: &ScreenCell) -> &Glyph {
        let weight = [cell.bold, cell.italic, cell.underlined, cell.strikethrough];
        let (size, font) = (self.cell, &self.font);
        self.known.entry((cell.character, weight)).or_insert_with(|| {
            let coverage = drawn(size, font, cell.character, weight);
            let level = |share: &f64| (share * LEVELS as f64).round() as u8;
            let levels: Vec<u8> = coverage.pixels().iter().map(level).collect();
            let mut histogram = [0; LEVELS + 1];
            for level in &levels {
                histogram[usize::from(*level)] += 1;
            }
            Glyph { width: size.0, levels, histogram }
        })
    }
}

fn drawn(size: (usize, usize), font: &Font, character: char, weight: Weight) -> Coverage {
    let [bold, italic, underlined, strikethrough] = weight;
    let mut coverage = Coverage::new(size.0, size.1);
    match GlyphShape::of(character) {
        Some(shape) => cover(&mut coverage, size, &shape),
        None if character == ' ' => {}
        None => {
            coverage.fill(&font.outline(character, bold, italic));
            if character == '∮' {
                let middle = (0.5 * size.0 as f64, 0.5 * size.1 as f64);
                ring(&mut coverage, middle, 0.28 * size.0 as f64, 0.5 * thickness(size, false));
            }
        }
    }
    let thick = thickness(size, false) as usize;
    for (wanted, sixteenths) in [(underlined, 14), (strikethrough, 8)] {
        if wanted {
            let top = size.1 * sixteenths / 16;
            coverage.rectangle((0, top), (size.0, top + thick), 1.0);
        }
    }
    coverage
}

/// Covers a shape that is given in units of [`CELL`].
fn cover(coverage: &mut Coverage, size: (usize, usize), shape: &GlyphShape) {
    let scale = (size.0 as f64 / CELL.0, size.1 as f64 / CELL.1);
    match shape {
        GlyphShape::Dots(dots) => {
            let radius = DOT * scale.0;
            let near = |(x, y): PixelPoint, dot: &PixelPoint| {
                distance_squared((x, y), [(dot.0 * scale.0, dot.1 * scale.1); 2]) < radius * radius
            };
            coverage.sampled(|place| dots.iter().any(|dot| near(place, dot)));
        }
        GlyphShape::Blocks(blocks, share) => {
            // edges are rounded one by one, so that neighbours meet
            let pixel = |place: f64, scale: f64| (place * scale).round() as usize;
            for [x, y, width, height] in blocks {
                let from = (pixel(*x, scale.0), pixel(*y, scale.1));
                let to = (pixel(x + width, scale.0), pixel(y + height, scale.1));
                coverage.rectangle(from, to, *share);
            }
        }
        GlyphShape::Stroke(data, heavy) => {
            let thick = thickness(size, *heavy);
            let segments = segments(data, size, thick);
            let reach = 0.25 * thick * thick;
            coverage.sampled(|at| segments.iter().any(|s| distance_squared(at, *s) < reach));
        }
    }
}

/// The thickness of a stroke in whole pixels.
fn thickness(size: (usize, usize), heavy: bool) -> f64 {
    let units = if heavy { 2.4 } else { 1.0 };
    (units * size.0 as f64 / CELL.0).round().max(1.0)
}

/// The segments of a stroke. Its middle is moved to where a line of whole pixels can be, and its ends stay at the edges.
fn segments(data: &str, size: (usize, usize), thick: f64) -> Vec<[PixelPoint; 2]> {
    let along = |place: f64, unit: f64, length: usize| {
        let (middle, length) = (0.5 * unit, length as f64);
        let centre = (0.5 * (length - thick)).floor() + 0.5 * thick;
        if place <= middle {
            place / middle * centre
        } else {
            centre + (place - middle) / middle * (length - centre)
        }
    };
    let place = |(x, y): PixelPoint| (along(x, CELL.0, size.0), along(y, CELL.1, size.1));
    let mut segments = Vec::new();
    let mut at = (0.0, 0.0);
    for part in path_parts(data) {
        match part {
            PathPart::Move(to) => at = to,
            PathPart::Line(to) => {
                segments.push([place(at), place(to)]);
                at = to;
            }
            PathPart::Curve(by, to) => {
                let mut last = place(at);
                for next in curve(last, place(by), place(to)) {
                    segments.push([last, next]);
                    last = next;
                }
                at = to;
            }
        }
    }
    segments
}

fn ring(coverage: &mut Coverage, middle: PixelPoint, radius: f64, half: f64) {
    coverage.sampled(|at| {
        let far = distance_squared(at, [middle; 2]);
        let (inner, outer) = (radius - half, radius + half);
        far > inner * inner && far < outer * outer
    });
}
