//! The card: the same curve in every set of glyphs, so that the user can see which of them the font supports.
//!
//! In: nothing. Out: lines of text. Never here: the choice of a set.

use std::f64::consts::TAU;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

use super::glyphs::Glyphs;
use super::plot::{Pen, PlotFrame, Raster, Scale};
use crate::num::math;

/// The size of a sample in cells: columns, rows.
const SAMPLE: (u16, u16) = (32, 3);

/// The number of filled columns in a sample.
const FILLED: u16 = 4;

/// The width of a sample's name.
const NAME: usize = 10;

/// Returns the lines of the card.
pub fn card() -> Vec<String> {
    let mut lines = Vec::new();
    for glyphs in Glyphs::ALL {
        let (across, down) = glyphs.dots();
        for (index, row) in sample(glyphs).into_iter().enumerate() {
            let head = match index {
                0 => glyphs.name().to_owned(),
                1 => format!("{across}x{down} dots"),
                _ => String::new(),
            };
            lines.push(format!("{head:<NAME$}|{row}|"));
        }
        lines.push(String::new());
    }
    lines.push(format!("{:<NAME$}|● ○ × ◆ ■  ━━━●───  ▁▂▃▄▅▆▇█  ╭─╮|", "signs"));
    lines.push(format!("{:<NAME$}|θ′ ψ² p₁ ∂L/∂q′ ≤ √½ → ∞ ∮ ⊕ ☉    |", "letters"));
    lines
}

/// Draws two waves of a curve and a filled area, as the raster of a plot draws them.
fn sample(glyphs: Glyphs) -> Vec<String> {
    let area = Rect::new(0, 0, SAMPLE.0, SAMPLE.1);
    let mut raster = Raster::new(area, glyphs);
    let pen = Pen::new(Style::new(), 0);
    let wave = Rect { width: SAMPLE.0 - FILLED - 1, ..area };
    let frame = PlotFrame::new(Scale::linear(0.0, 2.0), Scale::linear(-1.1, 1.1), wave);
    let mut curve = Raster::new(wave, glyphs);
    let points = (0..=400).map(|i| f64::from(i) / 200.0).map(|x| [x, math::sin(TAU * x)]);
    curve.polyline(&frame, points, &pen);
    let [wide, high] = raster.size();
    let filled = i32::from(FILLED * glyphs.dots().0);
    for y in 0..high {
        for x in wide - filled..wide {
            raster.dot([x, y], &pen);
        }
    }
    let mut buffer = Buffer::empty(area);
    raster.draw(&mut buffer);
    curve.draw(&mut buffer);
    let row = |y: u16| (0..area.width).map(|x| buffer[(x, y)].symbol()).collect();
    (0..area.height).map(row).collect()
}
