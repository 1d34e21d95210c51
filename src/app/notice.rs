//! What the user is told in passing, in the line above the key hints.
//!
//! In: sentences. Out: the one to be shown now. Never here: what lasts, as a fault does.

use std::time::Duration;

/// A sentence that goes away by itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Notice {
    /// The sentence.
    pub text: String,
    /// Whether something went wrong.
    pub error: bool,
    left: Duration,
}

impl Notice {
    /// For what went well.
    pub fn info(text: impl Into<String>) -> Self {
        Self { text: text.into(), error: false, left: Duration::from_secs(5) }
    }

    /// For what did not.
    pub fn error(text: impl Into<String>) -> Self {
        Self { text: text.into(), error: true, left: Duration::from_secs(10) }
    }

    /// The notice after some time has passed.
    #[must_use]
    pub fn after(self, elapsed: Duration) -> Option<Self> {
        let left = self.left.saturating_sub(elapsed);
        (!left.is_zero()).then_some(Self { left, ..self })
    }
}
