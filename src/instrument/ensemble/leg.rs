//! The methods by which a cloud was carried, one after the other.
//!
//! In: what was known of a cloud, and where the law of the motion was changed last. Out: [`CloudLeg`]s. Never here: how a
//! cloud is carried.

use super::super::Present;
use super::super::conditions::PlotConditions;
use crate::integrate::{Method, Settings};

/// A method by which a cloud was carried, up to the time at which another one took its place.
#[derive(Clone)]
pub(super) struct CloudLeg {
    pub(super) until: f64,
    pub(super) method: (&'static Method, Settings),
}

impl CloudLeg {
    /// The methods that have carried a cloud so far, where the motion was continued by another one than that of the
    /// conditions. `None` if the motion begins again with it.
    pub(super) fn all(
        (known, conditions): (&[CloudLeg], &PlotConditions),
        begun: f64,
        present: &Present<'_>,
    ) -> Option<Vec<CloudLeg>> {
        let until = present.changed_at().filter(|&time| time >= begun)?;
        let mut legs: Vec<CloudLeg> =
            known.iter().filter(|leg| leg.until <= until).cloned().collect();
        if until > legs.last().map_or(begun, |leg| leg.until) {
            legs.push(CloudLeg { until, method: conditions.method()? });
        }
        Self::are_of_the_motion(&legs, present).then_some(legs)
    }

    /// Whether these methods have carried the motion, too: one that begins again is of the last of them from its start.
    pub(super) fn are_of_the_motion(legs: &[CloudLeg], present: &Present<'_>) -> bool {
        legs.last().is_none_or(|leg| present.changed_at() == Some(leg.until))
    }
}
