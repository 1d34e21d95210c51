//! What the distances of a gauge are compared with, and why they may show nothing.
//!
//! In: a monitor. Out: a scale, and what rounding explains. Never here: what is recorded, and the verdict.

use super::super::seen_distances::SeenDistances;
use super::{ENERGY, InvariantMonitor};
use crate::analysis::{self, LEFT, LOST, RoundedInput, Unseen};

/// What distances are compared with.
pub(super) struct DriftMeasure {
    /// What a drift is relative to.
    pub(super) scale: f64,
    /// The distance that rounding explains.
    pub(super) rounding: f64,
    /// What a distance is relative to that rounding explains: what the last digits of the value hide is small compared with the terms.
    pub(super) hidden_scale: f64,
    /// The greatest drift, where each distance was compared with what had moved up to its time.
    pub(super) worst: Option<f64>,
    /// When the drift first exceeded the limit, if it did.
    pub(super) left: Option<f64>,
    /// Why nothing is known of the method by this drift.
    pub(super) unseen: Option<Unseen>,
}

impl DriftMeasure {
    pub(super) fn drift(&self, distance: f64) -> f64 {
        match distance {
            0.0 => 0.0,
            _ if distance <= self.rounding => distance / self.hidden_scale,
            _ => distance / self.scale,
        }
    }

    /// Whether there is a drift at all: one that rounding of the state explains has been seen.
    pub(super) fn is_known(&self) -> bool {
        matches!(self.unseen, None | Some(Unseen::Rounded(_)))
    }
}

impl InvariantMonitor {
    /// Where the value itself shows the drift: what its last digits hide is rounding.
    pub(super) fn measured_by_value(
        &self,
        floor: f64,
        now: Option<(f64, RoundedInput)>,
    ) -> DriftMeasure {
        let scale = self.moving();
        let explained = self.seen.explained(self.drift.farthest, floor, now);
        DriftMeasure {
            scale,
            rounding: SeenDistances::hidden(self.reference.value.abs().max(scale)),
            hidden_scale: scale,
            worst: None,
            left: self.seen.first_beyond(LEFT * scale),
            unseen: explained.map(Unseen::Rounded),
        }
    }

    /// Elsewhere: what the terms have gathered is rounding.
    pub(super) fn measured_by_terms(&self, floor: f64) -> DriftMeasure {
        let scale = self.scale();
        let (worst, left) = self.drifted();
        DriftMeasure {
            scale,
            rounding: floor * self.rounding.greatest,
            hidden_scale: scale.max(self.rounding.greatest),
            worst: Some(worst),
            left,
            unseen: self.unseen(),
        }
    }

    /// Why a drift would not be seen, if it would not: all its terms have always been below the numbers that have all their digits,
    /// and not because they are 0; or a motion whose energy is all but constant terms could be lost within their rounding error.
    fn unseen(&self) -> Option<Unseen> {
        let moving = self.moving();
        if self.rounding.underflows && self.rounding.greatest < f64::MIN_POSITIVE {
            return Some(Unseen::Underflow);
        }
        let is_lost = analysis::rounding_floor(0) * self.rounding.greatest > LOST * moving;
        let within_rounding = self.drift.farthest <= self.rounding.explained;
        // the terms of others may all be constant, so that what moves of them is rounding
        (self.invariant.quantity == Some(ENERGY) && moving > 0.0 && is_lost && within_rounding)
            .then(|| Unseen::Unresolved(self.rounding.greatest / moving))
    }
}
