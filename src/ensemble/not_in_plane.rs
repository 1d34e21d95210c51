//! Why a point of a plane of section is no start of a motion.
//!
//! In: nothing. Out: [`NotInPlane`], a sentence. Never here: how it is found out.

use super::NotOnShell;
use crate::integrate::MethodError;
use crate::num::short;
use crate::system::{CompileError, MotionError};

/// Why a point of a plane is no start.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum NotInPlane {
    /// The energy forbids the point, or does not determine the start.
    #[error(transparent)]
    Shell(#[from] NotOnShell),
    /// The numbers of the point determine no state.
    #[error(transparent)]
    NoState(#[from] MotionError),
    /// The motions through it cross in the other direction.
    #[error("no motion of this energy crosses the surface there in the direction that is shown")]
    OtherDirection,
    /// The motion begins at another phase of the drive, from which none that is shown was reached.
    #[error("the picture shows another phase of the drive than that of the start, t = {}, and none was reached from there", short(*.0))]
    OtherPhase(f64),
    /// The motion begins at another phase of the drive, and between the two an impulse acts.
    #[error(
        "the motion begins at t = {}, the picture shows t = {}, and over an impulse between them no point can be carried back",
        short(*.time),
        short(*.instant)
    )]
    ImpulseBetween {
        /// The time of the initial values.
        time: f64,
        /// The first instant of the stroboscope.
        instant: f64,
    },
    /// The method of the motion does not fit it.
    #[error(transparent)]
    Method(#[from] MethodError),
    /// The system cannot be run the other way.
    #[error(transparent)]
    Reversed(#[from] CompileError),
}
