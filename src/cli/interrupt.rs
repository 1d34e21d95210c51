//! Signals of commands without a screen: each ends in a fifth of a second, with 128 + n.
//!
//! In: SIGINT, SIGTERM, SIGHUP, SIGQUIT. Out: a token that work looks at, the signal's number, and, where the work does
//! not end by itself, the end of the process. A command that has nothing to bring to an end is ended at once. Never here:
//! the signals of the laboratory (`shell` has its own), or work inside a signal handler; the thread is an ordinary one.

use std::fmt;
use std::sync::atomic::{AtomicBool, AtomicI32, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM};
use signal_hook::iterator::Signals;

use super::exit;
use crate::cancel::Cancel;
use crate::shell::atomic_file;

/// How long a command has to end by itself.
const GRACE: Duration = Duration::from_millis(100);

/// How long what it left can take to be written by somebody else.
const LAST_WORDS: Duration = Duration::from_millis(60);

/// How long a file that is being put in its place is waited for beyond that.
const SAVING: Duration = Duration::from_millis(1500);

/// How often a file that is being put in its place is looked after.
const BETWEEN: Duration = Duration::from_millis(10);

/// What is written where the work itself is stuck.
type Words = Box<dyn FnOnce() + Send>;

/// Whether the process is asked to end.
#[derive(Clone, Debug, Default)]
pub(super) struct Interrupt(Arc<Shared>);

#[derive(Default)]
struct Shared {
    /// The signal that came first.
    signal: AtomicI32,
    cancel: Cancel,
    /// What ends the command; without one it is ended at once.
    words: Mutex<Option<Words>>,
    /// Somebody else looks after signals.
    aside: AtomicBool,
    /// A file is being put in its place.
    saving: AtomicBool,
}

impl fmt::Debug for Shared {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Shared").field("signal", &self.signal).finish_non_exhaustive()
    }
}

impl Interrupt {
    /// Watches for signals from now on. Where they cannot be watched for they end the program as they always do.
    pub(super) fn watch() -> Interrupt {
        let interrupt = Interrupt::default();
        let mut numbers = vec![SIGINT, SIGTERM, SIGQUIT];
        // `nohup` has it ignored, and means it
        if !is_ignored(SIGHUP) {
            numbers.push(SIGHUP);
        }
        let Ok(mut signals) = Signals::new(numbers) else { return interrupt };
        let watched = interrupt.clone();
        let watch = move || signals.forever().for_each(|signal| watched.came(signal));
        let started = thread::Builder::new().name("signals".to_owned()).spawn(watch);
        drop(started);
        interrupt
    }

    /// The signal that came, if one did.
    pub(super) fn signal(&self) -> Option<i32> {
        match self.0.signal.load(Ordering::Acquire) {
            0 => None,
            number => Some(number),
        }
    }

    /// What is set when one comes.
    pub(super) fn cancel(&self) -> &Cancel {
        &self.0.cancel
    }

    /// From now on the command ends by itself when a signal came. Where it is stuck, `words` is called on a thread of
    /// its own, and then the process ends.
    pub(super) fn ends_by_itself(&self, words: impl FnOnce() + Send + 'static) {
        *self.words() = Some(Box::new(words));
    }

    /// A file is being put in its place, which is waited for.
    pub(super) fn saves(&self) {
        self.0.saving.store(true, Ordering::Release);
    }

    /// From now on somebody else looks after signals.
    pub(super) fn stand_aside(&self) {
        self.0.aside.store(true, Ordering::Release);
    }

    fn words(&self) -> MutexGuard<'_, Option<Words>> {
        self.0.words.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn came(&self, signal: i32) {
        if self.0.aside.load(Ordering::Acquire) {
            return;
        }
        let first =
            self.0.signal.compare_exchange(0, signal, Ordering::AcqRel, Ordering::Acquire).is_ok();
        self.0.cancel.cancel();
        let words = self.words().take().filter(|_| first);
        let Some(words) = words else { leave(signal) };
        let interrupt = self.clone();
        // this one listens: a second signal ends it at once
        let wait = move || interrupt.wait(signal, words);
        if thread::Builder::new().name("last words".to_owned()).spawn(wait).is_err() {
            leave(signal);
        }
    }

    /// Ends the process where the command does not.
    fn wait(&self, signal: i32, words: Words) {
        thread::sleep(GRACE);
        let deadline = Instant::now() + SAVING;
        while self.0.saving.load(Ordering::Acquire) && Instant::now() < deadline {
            thread::sleep(BETWEEN);
        }
        let interrupt = self.clone();
        let said = thread::Builder::new().spawn(move || {
            words();
            interrupt.0.saving.store(false, Ordering::Release);
            leave(signal);
        });
        drop(said);
        thread::sleep(LAST_WORDS);
        while self.0.saving.load(Ordering::Acquire) && Instant::now() < deadline {
            thread::sleep(BETWEEN);
        }
        leave(signal);
    }
}

/// Ends the process; no file is left half.
fn leave(signal: i32) -> ! {
    atomic_file::remove_unfinished();
    signal_hook::low_level::exit(i32::from(exit::SIGNAL) + signal);
}

/// Whether whoever started the process has a signal ignored, where the system tells.
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    ignored(&status, signal)
}

fn ignored(status: &str, signal: i32) -> bool {
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mask_of_ignored_signals_is_read() {
        let status = "Name:\tphaselab\nSigBlk:\t0000000000000000\nSigIgn:\t0000000000001001\n";
        assert!(ignored(status, SIGHUP));
        assert!(!ignored(status, SIGINT));
        assert!(!ignored("", SIGHUP));
    }
}
