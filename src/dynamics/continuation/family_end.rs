//! Why a family of periodic orbits ends, in words.
//!
//! In: the last points of it. Out: a sentence. Never here: whether it ends.

use super::point::FamilyPoint;
use crate::num::significant;

pub(super) enum FamilyEnd {
    Equilibrium(FamilyPoint),
    /// At an orbit of another family, as tori about a steady precession shrink to that.
    Branching(FamilyPoint),
}

/// A period grows where it is so many times that of the orbit begun with.
const LONG: f64 = 3.0;

/// The value at an equilibrium is zero up to this part of that beside it.
const VANISHES: f64 = 1e-6;

/// Why a family ends beside a point.
pub(super) fn ended(from: &FamilyPoint, end: &FamilyEnd) -> String {
    let (end, how, digits) = match end {
        FamilyEnd::Equilibrium(end) => (end, ["at", "at an equilibrium"], 6),
        FamilyEnd::Branching(end) => {
            (end, ["near", "at an orbit of another, from which it branches off"], 4)
        }
    };
    // the first digits of a value that vanishes are rounding
    let value = if end.value.abs() <= VANISHES * from.value.abs() { 0.0 } else { end.value };
    let [value, period] = [value, end.period].map(|x| significant(x, digits, 1e-4..1e6));
    let [near, place] = how;
    format!("the family ends {near} {value}, {place}, where its period is {period}")
}

/// Whether the period at a point is so much longer than the first that it grows without bound.
pub(super) fn grows(here: &FamilyPoint, first: f64) -> bool {
    here.period.abs() > LONG * first.abs()
}

/// Why a family ends at a point: as its period grows without bound, as towards a separatrix, where that is seen.
pub(super) fn lost(here: &FamilyPoint, first: f64) -> String {
    let (value, period) =
        (significant(here.value, 6, 1e-4..1e6), significant(here.period, 3, 1e-4..1e6));
    if grows(here, first) {
        return format!("the family ends near {value}: its period grows, to {period} so far");
    }
    format!("the family was lost at {value}")
}
