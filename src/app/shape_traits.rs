//! What is derived of each shape of a system once: whether it is a rod, and whether it can be dragged.
//!
//! In: a system. Out: the traits of the shapes that a camera sees. Never here: dragging, drawing.

use super::Loaded;
use super::dragged_mass::draggable;
use crate::expr::{Pool, Zero};
use crate::instrument::CameraPose;
use crate::model::{Model, Shape};

/// The traits of each shape: of the spatial picture, then of each view with shapes of its own.
#[derive(Clone, Debug)]
pub(super) struct ShapeTraits {
    space: Vec<ShapeTrait>,
    views: Vec<Vec<ShapeTrait>>,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct ShapeTrait {
    /// Whether it is a line of constant length that turns.
    pub(super) is_rod: bool,
    /// Whether it is a mass that can be dragged.
    pub(super) is_draggable: bool,
}

impl ShapeTraits {
    /// Of the shapes of a system.
    pub(super) fn of(loaded: &Loaded) -> Self {
        let mut pool = loaded.equations.pool.clone();
        let mut each = |shape: &Shape| ShapeTrait {
            is_rod: is_rod(loaded, &mut pool, shape),
            is_draggable: draggable(loaded, shape).is_some(),
        };
        let mut all = |shapes: &[Shape]| shapes.iter().map(&mut each).collect();
        let space = all(&loaded.model.picture.shapes);
        let views = loaded.model.views.iter();
        Self { space, views: views.map(|v| all(v.shapes.as_deref().unwrap_or_default())).collect() }
    }

    /// Of the shapes that a camera sees.
    pub(super) fn seen_by(&self, eye: CameraPose, model: &Model) -> &[ShapeTrait] {
        eye.own_shapes(model).map_or(&self.space, |view| &self.views[view])
    }
}

/// Whether a shape is a rod, which turns: its length is independent of the coordinates, its direction is not.
fn is_rod(loaded: &Loaded, pool: &mut Pool, shape: &Shape) -> bool {
    let Shape::Line { from, to } = shape else { return false };
    let along = [0, 1, 2].map(|k| pool.sub(to[k], from[k]));
    let squares = along.map(|difference| pool.powi(difference, 2));
    let length = pool.sum(&squares);
    let coordinates = &loaded.equations.coordinates;
    let turns = along
        .iter()
        .any(|&component| coordinates.iter().any(|c| pool.depends(component, c.position)));
    turns
        && coordinates.iter().all(|c| {
            let slope = pool.derivative(length, c.position);
            pool.is_zero(slope) == Zero::Proved
        })
}
