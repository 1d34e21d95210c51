//! Why a question about the derivatives of a motion has no answer.

use crate::integrate::MethodError;
use crate::system::{MotionError, MotionErrorKind};

/// Why a computation failed, as a sentence for the user.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum DynamicsError {
    /// The method does not suit the system.
    #[error(transparent)]
    Method(#[from] MethodError),
    /// The motion cannot begin or continue.
    #[error(transparent)]
    Motion(#[from] MotionError),
    /// The question does not apply to the system.
    #[error("{0}")]
    Unsuited(String),
    /// The question itself is wrong, whatever the system.
    #[error("{0}")]
    WrongRequest(String),
    /// Newton's method came to a path that no polynomial resolves.
    #[error("{0}")]
    Unresolved(String),
    /// No periodic orbit was found near the start; what the motion is instead can be asked for.
    #[error("{0}")]
    Unclosed(String),
    /// The periodic orbit near the start comes within rounding of a singularity of its law.
    #[error("{0}")]
    Singular(String),
}

impl DynamicsError {
    /// Whether the computation was cancelled.
    pub fn is_cancelled(&self) -> bool {
        matches!(self, DynamicsError::Motion(error) if error.kind == MotionErrorKind::Cancelled)
    }
}
