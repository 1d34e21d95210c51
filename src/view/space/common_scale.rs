//! The common scale of pictures of the same shapes that are seen from several frames of reference.
//!
//! In: the cameras of the pictures in view. Out: how much wider a frame is than its picture alone needs. Never here: what a
//! person zooms, which is theirs in each picture.

use ratatui::layout::Rect;

use super::annotation::legend_above;
use super::body::Outline;
use super::colours::colours;
use super::legend_lines;
use super::mechanics::ComparedMechanics;
use super::reference_frame::ReferenceFrame;
use super::scene::Scene;
use crate::instrument::CameraPose;
use crate::view::canvas::Canvas;
use crate::view::plot::{Camera, PlotFrame, Scale};
use crate::view::quantity::Quantities;

/// By what factor a picture is drawn smaller than it could be, so that lengths compare with those of the picture seen from another
/// frame of reference.
pub(super) fn share(canvas: &Canvas<'_>, area: Rect, q: &Quantities<'_>, eye: CameraPose) -> f64 {
    let model = &q.lab.loaded.model;
    if model.picture.follow.is_some() || eye.own_shapes(model).is_some() {
        return 1.0;
    }
    let others: Vec<_> = q.lab.eyes_in_view().filter(|other| other.frame != eye.frame).collect();
    if others.is_empty() {
        return 1.0;
    }
    let own = length_of_column(canvas, area, q, eye);
    let all = others.into_iter().map(|other| length_of_column(canvas, area, q, other));
    all.fold(own, f64::max) / own
}

/// The length in space that a column of an area shows in a picture, unless it is zoomed.
fn length_of_column(canvas: &Canvas<'_>, area: Rect, q: &Quantities<'_>, eye: CameraPose) -> f64 {
    let camera = Camera { yaw: eye.yaw, pitch: eye.pitch, ..Camera::FACE_ON };
    let outline = Outline::of(q, eye);
    let reference_frame = ReferenceFrame::of(q, eye.frame);
    let scene = Scene::of((q, outline.as_ref()), eye, reference_frame.as_ref());
    let mechanics = ComparedMechanics::of(q, eye, &colours(q, eye));
    let (_, below) = legend_above(area, &legend_lines(canvas, q, eye, mechanics.as_ref()));
    let frame = scene.frame(&camera, below);
    (frame.x.hi - frame.x.lo).abs() / f64::from(below.width.max(1))
}

/// A frame widened about its middle.
pub(super) fn widened(frame: PlotFrame, by: f64) -> PlotFrame {
    let wider = |scale: Scale| {
        let (middle, half) = (scale.lo / 2.0 + scale.hi / 2.0, scale.hi / 2.0 - scale.lo / 2.0);
        Scale { lo: middle - by * half, hi: middle + by * half, ..scale }
    };
    if by == 1.0 { frame } else { PlotFrame { x: wider(frame.x), y: wider(frame.y), ..frame } }
}
