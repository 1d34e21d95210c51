//! A sentence on the terminal about work that takes long, so that it is not silent.
//!
//! In: what is done, and the work. Out: its result. Never here: the work itself, or how it is stopped.

use std::io::IsTerminal;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use super::stderr;

/// Shorter work is not mentioned.
const NOTICE_DELAY: Duration = Duration::from_secs(2);

/// Does the work, and says after a while what is being done and how to stop it, if somebody is there to read it.
pub(super) fn with_notice<T>(what: &str, work: impl FnOnce() -> T) -> T {
    if !std::io::stderr().is_terminal() {
        return work();
    }
    let (done, waiting) = channel::<()>();
    thread::scope(|scope| {
        scope.spawn(move || {
            if waiting.recv_timeout(NOTICE_DELAY) == Err(RecvTimeoutError::Timeout) {
                stderr::report(&format!("{what}; this takes a while; Ctrl-C ends it"));
            }
        });
        let result = work();
        drop(done);
        result
    })
}
