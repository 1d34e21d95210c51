//! A request to stop, shared by whoever asks and whatever is at work: one atomic flag.
//!
//! A system that is opened has one token: its [`Pool`](crate::expr::Pool) looks at it while
//! expressions grow, the compiled [`System`](crate::system::System) while series are built and
//! steps are taken. Never here: signals, clocks, threads.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A flag that is set once and never cleared. Clones share it.
#[derive(Clone, Debug, Default)]
pub struct Cancel(Arc<AtomicBool>);

impl Cancel {
    /// A token of its own that nobody has set.
    pub fn new() -> Cancel {
        Cancel::default()
    }

    /// A token over a flag that a signal handler may set.
    pub fn of(flag: Arc<AtomicBool>) -> Cancel {
        Cancel(flag)
    }

    /// Asks everything that shares the token to stop.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether somebody asked.
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
