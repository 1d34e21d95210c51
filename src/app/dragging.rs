//! A mass dragged in a picture of a plane.
//!
//! In: the place of the mouse in the units of the picture. Out: initial values, at rest. Never here: the mouse, or where anything is
//! on the screen.

use super::dragged_mass::DraggedMass;
use super::{Effect, Lab};
use crate::instrument::CameraPose;
use crate::system::InitialOverride;

impl Lab {
    /// Whether any mass of a picture can be dragged.
    pub(super) fn has_draggable_mass(&self, eye: CameraPose) -> bool {
        let count = eye.shapes(&self.loaded.model).len();
        (0..count).any(|shape| self.can_drag(eye, shape))
    }

    /// Takes hold of a mass.
    ///
    /// # Errors
    /// Returns a sentence that says why it cannot be dragged from where it is.
    pub(super) fn take_mass(&mut self, eye: CameraPose, shape: usize) -> Result<(), &'static str> {
        let shape = eye.shapes(&self.loaded.model).get(shape).filter(|_| eye.frame.is_none());
        self.dragged = None;
        let Some(mass) = shape.and_then(|shape| DraggedMass::of(&self.loaded, shape)) else {
            return Ok(());
        };
        mass.can_begin(&self.loaded, &self.valuation())?;
        self.dragged = Some(Box::new(mass));
        Ok(())
    }

    /// The initial values with which the mass is at rest at a place in the plane, or as near to it as it can be.
    pub(super) fn dragged_to(&mut self, at: [f64; 2]) -> Option<Vec<InitialOverride>> {
        let now = self.valuation();
        self.dragged.as_mut()?.drag_to(&self.loaded, &now, at)
    }

    /// Starts the motion with the values of a mass that is dragged for the first time since it was taken hold of. Its picture, which
    /// shows these ranges, keeps them.
    pub(super) fn start_drag(
        &mut self,
        values: &[InitialOverride],
        (eye, ranges): (CameraPose, [[f64; 2]; 2]),
    ) -> Vec<Effect> {
        let before = self.earlier_window.clone();
        self.keep_windows();
        let plane = [0, 1].map(|k| {
            let [low, high] = ranges[k].map(|end| end - eye.pan[k] * (ranges[k][1] - ranges[k][0]));
            let (middle, half) = (f64::midpoint(low, high), (high - low) / 2.0 * eye.zoom);
            [middle - half, middle + half]
        });
        self.earlier_window = self.earlier_window.clone().with_plane(eye.view, plane);
        self.start_in_window(values, before)
    }

    /// Lets go of the mass. The initial values at which it was left, if an angle is beyond the turn about zero, to which it is brought
    /// back.
    pub(super) fn release_mass(&mut self) -> Option<Vec<InitialOverride>> {
        let mass = self.dragged.take()?;
        mass.brought_back(&self.loaded, &self.seen()?.parameters)
    }
}
