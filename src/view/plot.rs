//! Plots for a terminal: sub-cell dots in layers, axes, ticks and a camera.
//!
//! In: points in data coordinates as `f64`, with any bits. Out: cells of a ratatui buffer.
//! Never here: anything of phaselab. A number that cannot be drawn is left out; it never causes a panic or a long loop.

pub mod axes;
pub mod camera;
mod depth;
pub mod raster;
pub mod scale;
mod stroke;
pub mod ticks;

pub use axes::{Axes, DrawnAxis};
pub use camera::{Bounds, Camera, Extent, MARGIN};
pub use depth::{DepthBuffer, Visibility};
pub use raster::{Ages, CachedTrail, Letters, Marker, Pen, Raster};
pub use scale::{PlotFrame, Scale, ScaleKind};
