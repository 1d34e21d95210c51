//! A request to stop, shared between the requester and the work in progress: one atomic flag.
//!
//! Each opened system has one token. Its [`Pool`](crate::expr::Pool) checks it while expressions
//! grow, and the compiled [`System`](crate::system::System) checks it while series are built and
//! steps are taken. In: a request. Out: whether there was one. Never here: signals, clocks, threads.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A flag that is set once and never cleared. Clones share it.
#[derive(Clone, Debug, Default)]
pub struct Cancel(Arc<AtomicBool>);

impl Cancel {
    /// Creates a separate token that is not set.
    pub fn new() -> Cancel {
        Cancel::default()
    }

    /// Asks everything that shares the token to stop.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Returns whether a stop has been requested.
    #[inline]
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
