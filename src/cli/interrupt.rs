//! Signals of commands without a screen: each ends the command within a fifth of a second, with exit code 128 + n. Output that is
//! being written is waited for, up to a second and a half.
//!
//! In: SIGINT, SIGTERM, SIGHUP, SIGQUIT. Out: a token that the work checks, the signal's number, and the end of the
//! process if the work does not end by itself. A command with nothing to finish is ended at once. Never here: the
//! signals of the laboratory (`shell` has its own), or work inside a signal handler; the thread is an ordinary one.

use std::fmt;
use std::sync::atomic::{AtomicBool, AtomicI32, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM};
use signal_hook::iterator::Signals;

use super::exit;
use crate::cancel::Cancel;
use crate::shell::atomic_file;

/// How long a command may take to end by itself.
const GRACE: Duration = Duration::from_millis(100);

/// How long another thread may take to write the output of a stuck command.
const FINISH_TIME: Duration = Duration::from_millis(60);

/// How much longer a file that is being moved into place is waited for.
const SAVING: Duration = Duration::from_millis(1500);

/// A reader that takes nothing for this long while the rest of the output is written to it is not waited for.
const STALLED: Duration = Duration::from_millis(80);

/// How much output is written at a time.
pub(super) const PORTION: usize = 16_384;

/// The interval of checks on a file that is being moved into place.
const BETWEEN: Duration = Duration::from_millis(10);

/// Writes the output if the work itself is stuck.
type Finish = Box<dyn FnOnce() + Send>;

/// A request to end the process.
#[derive(Clone, Debug, Default)]
pub(super) struct Interrupt(Arc<SignalState>);

#[derive(Default)]
struct SignalState {
    /// The signal that came first.
    signal: AtomicI32,
    cancel: Cancel,
    /// The function that ends the command; without one it is ended at once.
    finish: Mutex<Option<Finish>>,
    /// Another component handles signals.
    stood_down: AtomicBool,
    /// A file is being moved into place, or the rest of the output is written to a reader.
    saving: AtomicBool,
    /// The reader need not be waited for unless it takes what is written.
    reading: AtomicBool,
    /// The portions that it has taken.
    taken: AtomicU64,
}

impl fmt::Debug for SignalState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SignalState").field("signal", &self.signal).finish_non_exhaustive()
    }
}

impl Interrupt {
    /// Starts watching for signals. If that is not possible, they end the program as usual.
    pub(super) fn watch() -> Interrupt {
        let interrupt = Interrupt::default();
        let mut numbers = vec![SIGINT, SIGTERM, SIGQUIT];
        // `nohup` deliberately ignores this signal
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

    /// The signal that came, if any.
    pub(super) fn signal(&self) -> Option<i32> {
        match self.0.signal.load(Ordering::Acquire) {
            0 => None,
            number => Some(number),
        }
    }

    /// The token that is set when a signal comes.
    pub(super) fn cancel(&self) -> &Cancel {
        &self.0.cancel
    }

    /// Declares that the command ends by itself after a signal. If it is stuck, `finish` is called on a separate
    /// thread, and then the process ends.
    pub(super) fn ends_by_itself(&self, finish: impl FnOnce() + Send + 'static) {
        *self.finish() = Some(Box::new(finish));
    }

    /// Declares that a file is being moved into place, which is waited for.
    pub(super) fn saves(&self) {
        self.0.saving.store(true, Ordering::Release);
    }

    /// Declares that the rest of the output is written to a reader, which is waited for as long as it takes some.
    pub(super) fn writes(&self) {
        self.0.reading.store(true, Ordering::Release);
        self.saves();
    }

    /// Declares that the output is being put into words, which is waited for.
    pub(super) fn prepares(&self) {
        self.saves();
    }

    /// Declares that this is done. After a signal what is written then is waited for, and otherwise nothing.
    pub(super) fn is_prepared(&self) {
        if self.signal().is_none() {
            self.0.saving.store(false, Ordering::Release);
        }
    }

    /// Declares that the reader has taken a portion.
    pub(super) fn taken(&self) {
        self.0.taken.fetch_add(1, Ordering::AcqRel);
    }

    /// Waits while something is being saved, up to a time.
    fn wait_for_saving(&self, deadline: Instant) {
        let taken = || self.0.taken.load(Ordering::Acquire);
        let (mut known, mut since) = (taken(), Instant::now());
        while self.0.saving.load(Ordering::Acquire) && Instant::now() < deadline {
            thread::sleep(BETWEEN);
            // in this order: a reader has only been there since the last portion
            let reading = self.0.reading.load(Ordering::Acquire);
            if taken() != known {
                (known, since) = (taken(), Instant::now());
            }
            if reading && since.elapsed() >= STALLED {
                return;
            }
        }
    }

    /// Declares that another component handles signals from now on.
    pub(super) fn stand_down(&self) {
        self.0.stood_down.store(true, Ordering::Release);
    }

    fn finish(&self) -> MutexGuard<'_, Option<Finish>> {
        self.0.finish.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn came(&self, signal: i32) {
        if self.0.stood_down.load(Ordering::Acquire) {
            return;
        }
        let first =
            self.0.signal.compare_exchange(0, signal, Ordering::AcqRel, Ordering::Acquire).is_ok();
        self.0.cancel.cancel();
        let finish = self.finish().take().filter(|_| first);
        let Some(finish) = finish else { leave(signal) };
        let interrupt = self.clone();
        // this thread keeps listening: a second signal ends the process at once
        let wait = move || interrupt.wait(signal, finish);
        if thread::Builder::new().name("last words".to_owned()).spawn(wait).is_err() {
            leave(signal);
        }
    }

    /// Ends the process if the command does not end.
    fn wait(&self, signal: i32, finish: Finish) {
        thread::sleep(GRACE);
        let deadline = Instant::now() + SAVING;
        self.wait_for_saving(deadline);
        if self.0.saving.load(Ordering::Acquire) {
            // the output is stuck, and so is whatever else would be written
            leave(signal);
        }
        let interrupt = self.clone();
        let writer = thread::Builder::new().spawn(move || {
            finish();
            interrupt.0.saving.store(false, Ordering::Release);
            leave(signal);
        });
        drop(writer);
        thread::sleep(FINISH_TIME);
        self.wait_for_saving(deadline);
        leave(signal);
    }
}

/// Ends the process; temporary files are removed, so that no file is left incomplete.
fn leave(signal: i32) -> ! {
    atomic_file::remove_unfinished();
    signal_hook::low_level::exit(i32::from(exit::SIGNAL) + signal);
}

/// Whether the parent process has set a signal to be ignored, if the system reports it.
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
