//! A table of numbers as a drawing of text: points on axes, or shades.
//!
//! In: points with a number each, the names of the axes. Out: lines of text. Never here: files, or where numbers come from.

mod lattice;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use super::RenderStyle;
use super::colour::ColourDepth;
use super::glyphs::Glyphs;
use super::plot::ticks::nice_range;
use super::plot::{Axes, DrawnAxis, Pen, Raster, Scale};
use super::theme::{PALETTES, Role, Theme};
use crate::num::short;
use lattice::Lattice;

/// The shades from the least number to the greatest.
const SHADES: [char; 4] = ['░', '▒', '▓', '█'];
const LETTERS: [char; 4] = ['.', ':', '+', '#'];

/// What is drawn of a table.
#[derive(Clone, Debug)]
pub struct TablePlot {
    /// Written above it; may be empty.
    pub title: String,
    /// The name of the horizontal axis.
    pub x: String,
    /// The name of the vertical axis.
    pub y: String,
    /// The name of what is shaded, if anything is.
    pub of: Option<String>,
    /// The points, each with the number that is shaded.
    pub points: Vec<[f64; 3]>,
    /// Whether each point that is not shaded stands on a line from the horizontal axis up, as a line of a spectrum.
    pub stems: bool,
}

/// The lines of the drawing.
pub fn drawn(plot: &TablePlot, [columns, rows]: [u16; 2], glyphs: Glyphs) -> String {
    let style = RenderStyle { theme: Theme::new(&PALETTES[0], ColourDepth::None), glyphs };
    let area = Rect::new(0, 0, columns, rows);
    let mut buffer = Buffer::empty(area);
    let ends = |k: usize| {
        let all = plot.points.iter().map(|point| point[k]);
        let [lo, hi] =
            all.fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], x| [lo.min(x), hi.max(x)]);
        [lo, hi]
    };
    let axis = |name: &str, k: usize| {
        let [lo, hi] = ends(k);
        let (lo, hi) = nice_range(lo, hi);
        DrawnAxis::new(glyphs.text(name), "", Scale::linear(lo, hi))
    };
    let [least, most] = ends(2);
    let signs = if glyphs.is_ascii() { LETTERS } else { SHADES };
    let mut head: Vec<String> = Vec::new();
    head.extend((!plot.title.is_empty()).then(|| plot.title.clone()));
    head.extend(
        plot.of.as_ref().map(|of| {
            format!("{of}: {} {} to {} {}", signs[0], short(least), signs[3], short(most))
        }),
    );
    let above = u16::from(!head.is_empty());
    let inside = Rect { y: above, height: rows - above, ..area };
    let axes = Axes::new(axis(&plot.x, 0), axis(&plot.y, 1));
    let frame = axes.draw(inside, &mut buffer, &style.theme, glyphs);
    if plot.of.is_some() {
        let wide = usize::from(frame.area.width);
        // halves, since the difference of two numbers may be larger than any
        let share_of = |value: f64| (0.5 * value - 0.5 * least) / (0.5 * most - 0.5 * least);
        let mut cells = vec![(0.0, 0_u32); wide * usize::from(frame.area.height)];
        for [x, y, value] in &plot.points {
            let Some(at) = frame.cell([*x, *y]) else { continue };
            let (i, j) = (at.x - frame.area.x, at.y - frame.area.y);
            let cell = &mut cells[usize::from(j) * wide + usize::from(i)];
            *cell = (cell.0 + share_of(*value), cell.1 + 1);
        }
        // between the places of a coarse lattice is what lies nearest
        if let Some(lattice) = Lattice::of(&plot.points) {
            for at in frame.area.positions() {
                let (i, j) = (at.x - frame.area.x, at.y - frame.area.y);
                let cell = &mut cells[usize::from(j) * wide + usize::from(i)];
                if let (0, Some(value)) = (cell.1, lattice.nearest(frame.at(at))) {
                    *cell = (share_of(value), 1);
                }
            }
        }
        for (index, (sum, count)) in cells.into_iter().enumerate().filter(|(_, c)| c.1 > 0) {
            let share = sum / f64::from(count);
            let step = if share.is_finite() { (4.0 * share).floor().clamp(0.0, 3.0) } else { 0.0 };
            let (x, y) = ((index % wide) as u16, (index / wide) as u16);
            let at = Position { x: frame.area.x + x, y: frame.area.y + y };
            buffer[at].set_char(signs[step as usize]);
        }
    } else {
        let mut raster = Raster::new(frame.area, glyphs);
        let pen = Pen::new(style.theme[Role::Text], 0);
        let points = plot.points.iter().map(|[x, y, _]| [*x, *y]);
        if plot.stems {
            for at in points {
                raster.polyline(&frame, [[at[0], frame.y.lo], at], &pen);
            }
        } else {
            raster.points(&frame, points, &pen);
        }
        raster.draw(&mut buffer);
    }
    let mut text = String::new();
    for row in 0..rows {
        let line: String = match (row, above) {
            (0, 1) => glyphs.text(&head.join("   ")).chars().take(columns.into()).collect(),
            _ => (0..columns).map(|x| buffer[Position { x, y: row }].symbol()).collect(),
        };
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}
