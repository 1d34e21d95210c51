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

use phaselab::view::plot::{PlotFrame, Raster, Scale};
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
