//! Why a coordinate has no action.
//!
//! In: nothing. Out: an error whose words say what was found. Never here: how it is found.

use crate::ensemble::NotOnShell;
use crate::num::short;

/// Why there is no action.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum NoAction {
    /// The coordinate does not return.
    #[error(
        "the coordinate turned at {} and not at {}: its motion depends on the other coordinates, and the system does not separate in it",
        short(*.found),
        short(*.expected)
    )]
    NotSeparable {
        /// Where it turned.
        found: f64,
        /// Where it would if the other coordinates did not act on it.
        expected: f64,
    },
    /// The only coordinate turns before it comes to the other end.
    #[error(
        "the coordinate turned at {} and not at {}: between them the potential has wells narrower than the distance at which it \
         is looked at there; an angle needs its `period` in the file",
        short(*.found),
        short(*.expected)
    )]
    NarrowWells {
        /// Where it turned.
        found: f64,
        /// Where the next place beyond which the energy does not allow it was seen.
        expected: f64,
    },
    /// It turns where the energy is no more than that of another momentum.
    #[error(
        "the coordinate turned at {} with the momentum {}, not that of rest, {}: the energy does not grow on both sides of one \
         momentum, and no effective potential has its turning points",
        short(*.place),
        short(*.momentum),
        short(*.rest)
    )]
    SeveralRests {
        /// Where it turned.
        place: f64,
        /// The momentum at that place.
        momentum: f64,
        /// That at which it begins at rest.
        rest: f64,
    },
    /// The energy at rest is the greatest of the place, not the least.
    #[error(
        "where the coordinate is {} the energy is greatest, and not least, at the momentum of rest, {}: it has no effective \
         potential; −H may have one, with the same actions and periods",
        short(*.place),
        short(*.rest)
    )]
    GreatestAtRest {
        /// Where the motion begins.
        place: f64,
        /// The momentum of rest there.
        rest: f64,
    },
    /// The motion came to no return.
    #[error("{0}")]
    NoReturn(String),
    /// A start could not be completed.
    #[error(transparent)]
    NotOnShell(#[from] NotOnShell),
}
