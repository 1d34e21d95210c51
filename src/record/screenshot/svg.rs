//! A still as a drawing: dots, blocks and frames as shapes, words as text that fits its cells in any font.
//!
//! In: a screen. Out: SVG 1.1 without scripts, style sheets or embedded fonts. Never here: what the shapes are.

use std::fmt::Write;

use ratatui::buffer::{Buffer, Cell};
use ratatui::style::{Color, Modifier};

use super::shape::{CELL, DOT, GlyphShape};
use crate::view::colour::Rgb;
use crate::view::theme::Palette;

/// The margin around the screen, in units of the drawing.
const MARGIN: f64 = 8.0;

/// The part of a cell's style that a drawing shows.
#[derive(Clone, Copy, PartialEq)]
struct GlyphStyle {
    colour: Rgb,
    bold: bool,
    italic: bool,
    underlined: bool,
    dim: bool,
}

pub(super) fn write(screen: &Buffer, palette: &Palette, title: &str) -> String {
    let (columns, rows) = (screen.area.width, screen.area.height);
    let (width, height) = (f64::from(columns) * CELL.0, f64::from(rows) * CELL.1);
    let (whole, high) = (width + 2.0 * MARGIN, height + 2.0 * MARGIN);
    let background = hex(palette.background);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{whole}\" height=\"{high}\" \
         viewBox=\"{m} {m} {whole} {high}\">\n<title>{}</title>\n\
         <rect x=\"{m}\" y=\"{m}\" width=\"{whole}\" height=\"{high}\" rx=\"6\" fill=\"{background}\"/>\n",
        escaped(title),
        m = -MARGIN,
    );
    let wide = usize::from(columns).max(1);
    let cells = || screen.content.chunks(wide).enumerate();
    for (y, row) in cells() {
        fields(&mut out, y, row, palette);
    }
    for (y, row) in cells() {
        shapes(&mut out, y, row, palette);
    }
    out.push_str("<g font-family=\"ui-monospace, monospace\" font-size=\"13\">\n");
    for (y, row) in cells() {
        words(&mut out, y, row, palette);
    }
    out.push_str("</g>\n</svg>\n");
    out
}

// writing to a String cannot fail, so its results are ignored below

/// Writes the backgrounds of characters, one for each run of a colour.
fn fields(out: &mut String, y: usize, row: &[Cell], palette: &Palette) {
    let mut x = 0;
    for run in row.chunk_by(|a, b| field(a, palette) == field(b, palette)) {
        if let Some(colour) = field(&run[0], palette) {
            let (left, top) = (x as f64 * CELL.0, y as f64 * CELL.1);
            let (width, height) = (run.len() as f64 * CELL.0, CELL.1);
            let colour = hex(colour);
            let _ = writeln!(
                out,
                "<rect x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" fill=\"{colour}\"/>"
            );
        }
        x += run.len();
    }
}

/// The background of a character, if it is not the default.
fn field(cell: &Cell, palette: &Palette) -> Option<Rgb> {
    if cell.modifier.contains(Modifier::REVERSED) {
        return Some(named(cell.fg).unwrap_or(palette.foreground));
    }
    named(cell.bg)
}

fn ink(cell: &Cell, palette: &Palette) -> GlyphStyle {
    let has = |modifier| cell.modifier.contains(modifier);
    let colour = if has(Modifier::REVERSED) {
        named(cell.bg).unwrap_or(palette.background)
    } else {
        named(cell.fg).unwrap_or(palette.foreground)
    };
    GlyphStyle {
        colour,
        bold: has(Modifier::BOLD),
        italic: has(Modifier::ITALIC),
        underlined: has(Modifier::UNDERLINED),
        dim: has(Modifier::DIM),
    }
}

fn named(colour: Color) -> Option<Rgb> {
    if colour == Color::Reset { None } else { Rgb::of(colour) }
}

fn shape(cell: &Cell) -> Option<GlyphShape> {
    GlyphShape::of(cell.symbol().chars().next()?)
}

/// Writes the dots, blocks and strokes of a row, grouped by colour.
fn shapes(out: &mut String, y: usize, row: &[Cell], palette: &Palette) {
    let mut x = 0;
    let top = y as f64 * CELL.1;
    for run in row.chunk_by(|a, b| {
        shape(a).is_some() == shape(b).is_some() && ink(a, palette) == ink(b, palette)
    }) {
        let drawn: Vec<(usize, GlyphShape)> =
            run.iter().enumerate().filter_map(|(i, cell)| Some((x + i, shape(cell)?))).collect();
        x += run.len();
        if drawn.is_empty() {
            continue;
        }
        let GlyphStyle { colour, dim, .. } = ink(&run[0], palette);
        let faint = if dim { " opacity=\"0.6\"" } else { "" };
        let _ = write!(out, "<g fill=\"{}\"{faint}>", hex(colour));
        for (column, shape) in drawn {
            one_shape(out, (column as f64 * CELL.0, top), &shape, colour);
        }
        out.push_str("</g>\n");
    }
}

fn one_shape(out: &mut String, (left, top): (f64, f64), shape: &GlyphShape, colour: Rgb) {
    match shape {
        GlyphShape::Dots(dots) => {
            for (x, y) in dots {
                let (x, y) = (left + x, top + y);
                let _ = write!(out, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{DOT}\"/>");
            }
        }
        GlyphShape::Blocks(blocks, seen) => {
            for [x, y, width, height] in blocks {
                let (x, y) = (left + x, top + y);
                let faint =
                    if *seen < 1.0 { format!(" opacity=\"{seen}\"") } else { String::new() };
                let _ = write!(
                    out,
                    "<rect x=\"{x}\" y=\"{y:.4}\" width=\"{width}\" height=\"{height:.4}\"{faint}/>"
                );
            }
        }
        GlyphShape::Stroke(data, heavy) => {
            let (colour, width) = (hex(colour), if *heavy { 2.4 } else { 1.0 });
            let _ = write!(
                out,
                "<path transform=\"translate({left} {top})\" d=\"{data}\" fill=\"none\" \
                 stroke=\"{colour}\" stroke-width=\"{width}\"/>"
            );
        }
    }
}

/// Writes the words of a row: runs of one style between blanks, each as wide as its cells.
fn words(out: &mut String, y: usize, row: &[Cell], palette: &Palette) {
    let is_word = |cell: &Cell| cell.symbol() != " " && shape(cell).is_none();
    let mut x = 0;
    for run in row.chunk_by(|a, b| {
        is_word(a) == is_word(b) && (!is_word(a) || ink(a, palette) == ink(b, palette))
    }) {
        let (left, length) = (x as f64 * CELL.0, run.len() as f64 * CELL.0);
        x += run.len();
        if !is_word(&run[0]) {
            continue;
        }
        let GlyphStyle { colour, bold, italic, underlined, dim } = ink(&run[0], palette);
        let base = y as f64 * CELL.1 + 12.5;
        let text: String = run.iter().map(Cell::symbol).collect();
        let _ = write!(
            out,
            "<text x=\"{left}\" y=\"{base}\" textLength=\"{length}\" \
             lengthAdjust=\"spacingAndGlyphs\" fill=\"{}\"",
            hex(colour)
        );
        let attributes = [
            (bold, " font-weight=\"bold\""),
            (italic, " font-style=\"italic\""),
            (underlined, " text-decoration=\"underline\""),
            (dim, " opacity=\"0.6\""),
        ];
        attributes.iter().filter(|(is, _)| *is).for_each(|(_, attribute)| out.push_str(attribute));
        let _ = writeln!(out, ">{}</text>", escaped(&text));
    }
}

fn hex(Rgb(r, g, b): Rgb) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Escapes text for XML; characters that XML 1.0 forbids are dropped.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\u{fffe}' | '\u{ffff}' => {}
            c if c.is_control() => {}
            c => out.push(c),
        }
    }
    out
}
