//! What distinguishes the recorded past of one run from that of another.
//!
//! In: nothing. Out: [`RunToken`]s; one that nobody holds any more is known to be forgotten. Never here: what was recorded.

use std::fmt;
use std::sync::{Arc, Weak};

/// The token of a run: a motion under one law from where it began.
#[derive(Clone, Default)]
pub struct RunToken(Arc<()>);

/// A token that is not held.
pub(super) struct ReleasedToken(Weak<()>);

impl RunToken {
    /// The same token, not held.
    pub(super) fn release(self) -> ReleasedToken {
        ReleasedToken(Arc::downgrade(&self.0))
    }
}

impl ReleasedToken {
    /// Returns the token, if somebody still holds it.
    pub(super) fn upgrade(&self) -> Option<RunToken> {
        self.0.upgrade().map(RunToken)
    }
}

impl PartialEq for RunToken {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl fmt::Debug for RunToken {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("RunToken")
    }
}
