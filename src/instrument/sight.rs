//! How a plot is viewed: through a camera, or through a window on its axes.
//!
//! In: moves and zoom factors. Out: [`CameraPose`]s and [`Viewport`]s. Never here: what is seen.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use serde::{Deserialize, Serialize};

use crate::expr::Expr;
use crate::model::{Model, Shape, Viewpoint};

/// How a plot is viewed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sight {
    /// Through a camera in space.
    Camera(CameraPose),
    /// Through a window on axes.
    Axes(Viewport),
}

/// The orientation, zoom and frame of a camera.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CameraPose {
    /// The rotation about the vertical axis, in radians.
    pub yaw: f64,
    /// The elevation above the horizon, in radians; at π/2 the camera looks straight down on the plane of x and y.
    pub pitch: f64,
    /// The zoom factor.
    pub zoom: f64,
    /// The offset of the window, in fractions of its width and height.
    #[serde(default)]
    pub pan: [f64; 2],
    /// The frame of the file that the camera moves and turns with; `None` for the axes of the shapes.
    pub frame: Option<usize>,
    /// The view of the file that it shows, which may have its own title and shapes.
    pub view: Option<usize>,
}

/// The window on the axes of a plot.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Viewport {
    /// The horizontal and vertical zoom factors.
    pub zoom: [f64; 2],
    /// The offset of the window, in fractions of its width and height.
    pub pan: [f64; 2],
    /// Whether the vertical axis is logarithmic.
    pub log: bool,
    /// Whether a unit has the same length on both axes.
    #[serde(default)]
    pub equal: bool,
    /// Whether a transformation moves the point in place of the coordinates.
    #[serde(default)]
    pub active: bool,
    /// Whether orbits are coloured by whether they are regular, in place of each in its own colour.
    #[serde(default)]
    pub by_chaos: bool,
    /// Whether the vector field and its nullclines are shown.
    #[serde(default)]
    pub field: bool,
    /// The cursor, in fractions of the width from the left and of the height from below.
    pub cursor: Option<[f64; 2]>,
    /// The data coordinates of the cursor since it was drawn: it stays there when the axes change.
    #[serde(default)]
    pub cursor_at: Option<[f64; 2]>,
}

impl Viewport {
    /// The whole motion.
    pub const WHOLE: Self = Self {
        zoom: [1.0; 2],
        pan: [0.0; 2],
        log: false,
        equal: false,
        active: false,
        by_chaos: false,
        field: false,
        cursor: None,
        cursor_at: None,
    };

    /// The part of a range of an axis that is seen.
    pub(super) fn part(&self, axis: usize, [from, to]: [f64; 2]) -> [f64; 2] {
        let half = (to - from) / self.zoom[axis] / 2.0;
        let middle = f64::midpoint(from, to) + self.pan[axis] * 2.0 * half;
        [middle - half, middle + half]
    }

    /// The same window with the smooth settings at their defaults.
    pub(super) fn at_rest(self) -> Self {
        let cursor = self.cursor.map(|_| [0.0; 2]);
        let Self { log, equal, active, by_chaos, field, .. } = self;
        Self { log, equal, active, by_chaos, field, cursor, ..Self::WHOLE }
    }

    /// Puts the cursor at a place in the window, or takes it away.
    pub fn put_cursor(&mut self, place: Option<[f64; 2]>) {
        (self.cursor, self.cursor_at) = (place, None);
    }

    /// Moves one step in a direction: the cursor if there is one, otherwise the window.
    pub(super) fn shift(&mut self, step: [f64; 2]) {
        match self.cursor {
            Some(cursor) => {
                let moved = [0, 1].map(|k| (cursor[k] + step[k] / 40.0).clamp(0.0, 1.0));
                self.put_cursor(Some(moved));
            }
            None => self.pan = [0, 1].map(|k| self.pan[k] + step[k] / 10.0),
        }
    }
}

impl CameraPose {
    /// A camera on the shapes of the model, or on those of a view in the view's frame. Plane motion is seen face on,
    /// motion in space from the side and above, unless the file says from where.
    pub fn on(model: &Model, view: Option<usize>) -> Self {
        let frame = view.and_then(|view| model.views.get(view)?.frame);
        Self { yaw: 0.0, pitch: 0.0, zoom: 1.0, pan: [0.0; 2], frame, view }.at_first(model)
    }

    /// The initial camera of the same picture.
    pub(super) fn at_first(self, model: &Model) -> Self {
        let usual = if self.is_plane(model) { (0.0, FRAC_PI_2) } else { (PI / 6.0, PI / 9.0) };
        let own = self.own_shapes(model).is_some();
        let written = if own { Viewpoint::default() } else { model.picture.viewpoint };
        let yaw = written.azimuth.map_or(usual.0, |azimuth| azimuth.rem_euclid(TAU));
        let pitch = written.elevation.unwrap_or(usual.1);
        Self { yaw, pitch, zoom: 1.0, pan: [0.0; 2], ..self }
    }

    /// Whether all that it sees stays in the plane z = 0.
    pub fn is_plane(self, model: &Model) -> bool {
        self.shapes(model).iter().all(is_plane)
    }

    /// Whether it was turned, or brought nearer, since the beginning.
    pub fn is_moved(self, model: &Model) -> bool {
        self != self.at_first(model)
    }

    /// The same camera with the smooth settings at their defaults.
    pub(super) fn at_rest(self) -> Self {
        Self { yaw: 0.0, pitch: 0.0, zoom: 1.0, pan: [0.0; 2], ..self }
    }

    pub(super) fn turn(&mut self, yaw: f64, pitch: f64) {
        self.yaw = (self.yaw + yaw).rem_euclid(TAU);
        self.pitch = (self.pitch + pitch).clamp(-FRAC_PI_2, FRAC_PI_2);
    }

    /// The visible shapes: those of the view, or the model's.
    pub fn shapes(self, model: &Model) -> &[Shape] {
        self.own_shapes(model).map_or(&model.picture.shapes, |view| {
            model.views[view].shapes.as_deref().unwrap_or_default()
        })
    }

    /// The view, if it has its own shapes.
    pub fn own_shapes(self, model: &Model) -> Option<usize> {
        self.view.filter(|&view| model.views.get(view).is_some_and(|view| view.shapes.is_some()))
    }
}

/// Whether a shape stays in the plane z = 0.
fn is_plane(shape: &Shape) -> bool {
    let flat = |point: &[Expr; 3]| point[2] == Expr::ZERO;
    match shape {
        Shape::Line { from, to } | Shape::Spring { from, to } => flat(from) && flat(to),
        Shape::Circle { centre, normal, .. } | Shape::Disc { centre, normal, .. } => {
            flat(centre) && normal[0] == Expr::ZERO && normal[1] == Expr::ZERO
        }
        Shape::Mass { at, .. } | Shape::Trace { at } | Shape::Caption { at, .. } => flat(at),
        Shape::Vector { at, components, .. } => flat(at) && flat(components),
        Shape::Path { points } => points.iter().all(flat),
        Shape::Plane { .. }
        | Shape::Body { .. }
        | Shape::Sphere { .. }
        | Shape::Cone { .. }
        | Shape::Cylinder { .. } => false,
    }
}
