//! The passage of a motion in `f64` through a place where its digits do not suffice: a root of a function whose terms cancel.
//!
//! In: a step that could not be taken. Out: the series with its lowest orders in double-double, until the motion is out of that place.
//! Never here: steps.

use super::Taylor;
use super::step_size::{EXACT_ORDERS, SeriesOrders};
use crate::system::{MotionError, MotionErrorKind};

impl Taylor {
    /// Whether the place where a step could not be taken may be passed with more digits.
    pub(super) fn wants_digits(&self, error: &MotionError) -> bool {
        !self.exact
            && matches!(error.kind, MotionErrorKind::StepUnderflow(_) | MotionErrorKind::Rough)
    }

    /// Goes on with the lowest orders in double-double.
    pub(super) fn begin_passage(&mut self) -> Result<(), MotionError> {
        let orders = SeriesOrders::of(self.tolerance, &self.system);
        let mut series = self.system.series(orders.highest, EXACT_ORDERS);
        series.set_parameters(&self.system.inputs(&self.parameters));
        series.set_scale(self.series.scale());
        self.plain = Some(Box::new(std::mem::replace(&mut self.series, series)));
        self.exact = true;
        self.history.landed = false;
        self.kinks.begin(&mut self.series, &mut self.rates, &self.state)
    }

    /// Goes back to `f64` if the motion is out of the place, or if it begins anew.
    pub(super) fn end_passage(&mut self, anew: bool) {
        let is_out = !self.history.landed && !self.kinks.is_on_surface() && self.history.is_long();
        let Some(mut plain) = self.plain.take_if(|_| anew || is_out) else { return };
        plain.set_scale(self.series.scale());
        for (i, &side) in self.series.sides().iter().enumerate() {
            plain.set_side(i, side);
        }
        self.series = *plain;
        self.exact = false;
    }
}
