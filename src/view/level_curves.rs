//! Level curves: as many as can be distinguished, and the separatrices above them.
//!
//! In: a landscape, the frame of the axes. Out: dots. Never here: the computation of the curves.

use ratatui::style::Style;

use super::canvas::Canvas;
use super::ink::pen;
use super::plot::{Marker, Pen, PlotFrame, Raster};
use crate::analysis::{Curve, Landscape};
use crate::instrument::{Ink, Level};

/// A level curve is omitted if it shares more than this fraction of its cells with others: in ASCII, and with dots.
const CROWDED: [f64; 2] = [0.25, 0.35];

/// The number of dots above which all levels are drawn.
const ROOMY: u32 = 16_000;

/// Draws separatrices, and one in so many energy levels, as many as fit beside each other.
pub(super) fn draw(
    canvas: &Canvas<'_>,
    raster: &mut Raster,
    frame: &PlotFrame,
    (landscape, every): (&Landscape, usize),
    lowest: Level,
) {
    let style = canvas.style;
    let crowded = style.glyphs.pick(CROWDED[1], CROWDED[0]);
    let plain = Pen::new(Style::new(), 0);
    let trace = |raster: &mut Raster, curves: &[Curve], pen: &Pen| {
        for curve in curves {
            raster.polyline(frame, curve.iter().copied(), pen);
        }
    };
    let parting = pen(canvas, Ink::Separatrix, lowest + 1);
    trace(raster, &landscape.separatrices, &parting);
    let faint = pen(canvas, Ink::Level, lowest);
    let levels = landscape.levels.iter().step_by(every.max(1));
    let (wide, high) = style.glyphs.dots();
    let dots = frame.area.area() * u32::from(wide) * u32::from(high);
    if dots > ROOMY && !style.glyphs.is_ascii() {
        levels.for_each(|level| trace(raster, level, &faint));
    } else {
        let blank = Raster::new(frame.area, style.glyphs);
        let mut drawn = blank.clone();
        trace(&mut drawn, &landscape.separatrices, &plain);
        for level in levels {
            // Curves that share most of their cells cannot be distinguished.
            let mut alone = blank.clone();
            trace(&mut alone, level, &plain);
            if alone.shared(&drawn) <= crowded {
                trace(raster, level, &faint);
                drawn.absorb(&alone);
            }
        }
    }
    for saddle in &landscape.saddles {
        raster.marker(frame, *saddle, Marker::Cross, &parting);
    }
}
