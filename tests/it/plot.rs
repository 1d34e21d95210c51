//! Plots on ratatui buffers: raster, axes, ticks, themes, level curves and the camera.

mod axes;
mod ball;
mod camera;
mod environment;
mod number;
mod raster;
mod robust;
mod scale;
mod sparkline;
mod theme;
mod ticks;
mod trail;

use phaselab::view::glyphs::Glyphs;
use phaselab::view::plot::{Ages, CachedTrail, PlotFrame, Raster, Scale};
use phaselab::view::theme::Shade;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

/// A frame from 0 to 1 on both axes.
fn unit(area: Rect) -> PlotFrame {
    PlotFrame::new(Scale::linear(0.0, 1.0), Scale::linear(0.0, 1.0), area)
}

/// The dots that are set.
fn dots(raster: &Raster) -> Vec<[i32; 2]> {
    let [wide, high] = raster.size();
    let all = (0..high).flat_map(|y| (0..wide).map(move |x| [x, y]));
    all.filter(|dot| raster.is_set(*dot)).collect()
}

/// The text of a buffer, row by row, without trailing blanks.
fn rows(buffer: &Buffer) -> Vec<String> {
    let row = |y: u16| (0..buffer.area.width).map(|x| buffer[(x, y)].symbol()).collect::<String>();
    (0..buffer.area.height).map(|y| row(y).trim_end().to_owned()).collect()
}

/// Draws a fading trail, oldest point first: the points are divided among the shades of a ramp.
fn draw_trail(
    raster: &mut Raster,
    glyphs: Glyphs,
    frame: &PlotFrame,
    points: &[[f64; 2]],
    ramp: &[Shade],
) {
    let Some((&[x, y], past)) = points.split_last() else { return };
    let mut trail = CachedTrail::new(frame, glyphs, None);
    for (index, [x, y]) in past.iter().enumerate() {
        trail.to([*x, *y, 0.0], index as f64);
    }
    let first = |age: usize| age * points.len() / ramp.len();
    let since = (0..ramp.len()).map(first);
    let since = since.map(|first| if first < past.len() { first as f64 } else { f64::INFINITY });
    let since: Vec<f64> = since.collect();
    trail.draw(raster, Ages { since: &since, ramp, layer: 2, behind: None }, [x, y]);
}
