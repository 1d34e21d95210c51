//! How a plot is looked at: through a camera, or through a window on its axes.
//!
//! In: moves and magnifications. Out: [`CameraPose`]s and [`Viewport`]es. Never here: what is seen.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use serde::{Deserialize, Serialize};

use crate::expr::Expr;
use crate::model::{Model, Shape};

/// How a plot is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sight {
    /// From somewhere in space.
    Camera(CameraPose),
    /// On axes.
    Axes(Viewport),
}

/// From which frame, and where the camera stands in it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CameraPose {
    /// Turn about the vertical axis, in radians.
    pub yaw: f64,
    /// Height above the horizon, in radians; π/2 looks straight down on the plane of x and y.
    pub pitch: f64,
    /// Magnification.
    pub zoom: f64,
    /// The frame of the file it moves and turns with; none for the axes in which the shapes are written.
    pub frame: Option<usize>,
    /// The view of the file it shows, which may have a title and shapes of its own.
    pub view: Option<usize>,
}

/// The window on the axes of a plot.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Viewport {
    /// Magnification across and upwards.
    pub zoom: [f64; 2],
    /// How far the window is moved, in parts of its width and height.
    pub pan: [f64; 2],
    /// Whether the axis upwards is logarithmic.
    pub log: bool,
    /// Whether a unit is as long across as upwards.
    #[serde(default)]
    pub equal: bool,
    /// Where the cursor stands, in parts of the width from the left and of the height from below.
    pub cursor: Option<[f64; 2]>,
}

impl Viewport {
    /// All of the motion.
    pub const WHOLE: Self =
        Self { zoom: [1.0; 2], pan: [0.0; 2], log: false, equal: false, cursor: None };

    /// The same without what a hand moves smoothly.
    pub(super) fn at_rest(self) -> Self {
        let cursor = self.cursor.map(|_| [0.0; 2]);
        Self { log: self.log, equal: self.equal, cursor, ..Self::WHOLE }
    }

    /// One step in a direction: of the cursor if there is one, else of the window.
    pub(super) fn shift(&mut self, step: [f64; 2]) {
        match &mut self.cursor {
            Some(cursor) => *cursor = [0, 1].map(|k| (cursor[k] + step[k] / 40.0).clamp(0.0, 1.0)),
            None => self.pan = [0, 1].map(|k| self.pan[k] + step[k] / 10.0),
        }
    }
}

impl CameraPose {
    /// On the shapes of the model, or on those of a view, from the frame the file gives it. Plane motion is seen face on,
    /// motion in space from the side and from above.
    pub fn on(model: &Model, view: Option<usize>) -> Self {
        let frame = view.and_then(|view| model.views.get(view)?.frame);
        Self { yaw: 0.0, pitch: 0.0, zoom: 1.0, frame, view }.at_first(model)
    }

    /// The same picture from the place where the camera first stands.
    pub(super) fn at_first(self, model: &Model) -> Self {
        let plane = self.shapes(model).iter().all(is_plane);
        let (yaw, pitch) = if plane { (0.0, FRAC_PI_2) } else { (PI / 6.0, PI / 9.0) };
        Self { yaw, pitch, zoom: 1.0, ..self }
    }

    /// The same without what a hand moves smoothly.
    pub(super) fn at_rest(self) -> Self {
        Self { yaw: 0.0, pitch: 0.0, zoom: 1.0, ..self }
    }

    /// Turns the picture by these angles.
    pub(super) fn turn(&mut self, yaw: f64, pitch: f64) {
        self.yaw = (self.yaw + yaw).rem_euclid(TAU);
        self.pitch = (self.pitch + pitch).clamp(-FRAC_PI_2, FRAC_PI_2);
    }

    /// The shapes seen: those of the view, or the model's.
    pub fn shapes(self, model: &Model) -> &[Shape] {
        self.own_shapes(model)
            .map_or(&model.space, |view| model.views[view].shapes.as_deref().unwrap_or_default())
    }

    /// The view, if it has shapes of its own.
    pub fn own_shapes(self, model: &Model) -> Option<usize> {
        self.view.filter(|&view| model.views.get(view).is_some_and(|view| view.shapes.is_some()))
    }
}

/// Whether a shape stays in the plane z = 0.
fn is_plane(shape: &Shape) -> bool {
    let flat = |point: &[Expr; 3]| point[2] == Expr::ZERO;
    match shape {
        Shape::Line { from, to } | Shape::Spring { from, to } => flat(from) && flat(to),
        Shape::Circle { centre, normal, .. } => {
            flat(centre) && normal[0] == Expr::ZERO && normal[1] == Expr::ZERO
        }
        Shape::Mass { at, .. } | Shape::Trace { at } => flat(at),
        Shape::Vector { at, components } => flat(at) && flat(components),
        Shape::Path { points } => points.iter().all(flat),
        Shape::Plane { .. } | Shape::Body { .. } => false,
    }
}
