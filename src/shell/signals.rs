//! Signals: a thread that receives them, wakes the frame loop, and makes sure that the program ends if it must.
//!
//! In: signals. Out: the pending signals for the frame loop; if the program does not end in time, a restored
//! terminal and the exit status 128 + n. Never here: work inside a signal handler; the thread is an ordinary one,
//! woken through a pipe.

use std::io::{self, Read, Write};
use std::mem;
use std::os::unix::net::UnixStream;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use rustix::event::{PollFd, PollFlags, poll};
use rustix::process::{Signal, kill_current_process_group};
use signal_hook::consts::{
    SIGABRT, SIGALRM, SIGBUS, SIGCONT, SIGHUP, SIGINT, SIGIO, SIGPROF, SIGQUIT, SIGSYS, SIGTERM,
    SIGTRAP, SIGTSTP, SIGUSR1, SIGUSR2, SIGVTALRM, SIGWINCH, SIGXCPU, SIGXFSZ,
};
use signal_hook::iterator::Signals as Caught;

use super::terminal::Terminal;

/// How long the frame loop has to save everything and end before the terminal is restored without it; and how much
/// longer it has, if it has begun to end, before the process is ended anyway.
const GRACE: Duration = Duration::from_millis(150);
const SAVING: Duration = Duration::from_millis(1500);

/// The signals that end a process by default. SIGSEGV, SIGILL and SIGFPE would reach the thread too late, so they
/// cannot be handled here, and SIGKILL cannot be handled at all. A real abort ends the process before the thread
/// wakes up.
const FATAL: [i32; 15] = [
    SIGTERM, SIGHUP, SIGINT, SIGQUIT, SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM, SIGPROF, SIGXCPU,
    SIGIO, SIGABRT, SIGBUS, SIGSYS, SIGTRAP,
];

/// Those of Linux alone, such as that of a failing supply of power.
#[cfg(target_os = "linux")]
const OF_SYSTEM: [i32; 2] = [Signal::POWER.as_raw(), Signal::STKFLT.as_raw()];
#[cfg(not(target_os = "linux"))]
const OF_SYSTEM: [i32; 0] = [];

/// The other signals for the frame loop; and SIGXFSZ, for a file that has become too large, which is ignored
/// because the writer gets an error.
const OTHERS: [i32; 4] = [SIGTSTP, SIGCONT, SIGWINCH, SIGXFSZ];

/// The channel from the signal thread to the frame loop.
#[derive(Debug)]
pub(super) struct Signals {
    pending: Arc<Mutex<PendingSignals>>,
    wake: UnixStream,
    /// Whether the frame loop has noticed that it is to end.
    answered: Arc<AtomicBool>,
}

/// The signals since the last check.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PendingSignals {
    pub(super) stop: bool,
    /// Whether it was stopped and has been resumed (SIGCONT).
    pub(super) resumed: bool,
    /// Whether the window has changed its size (SIGWINCH).
    pub(super) resized: bool,
    /// The signal that asked the program to end, if there was one; it stays set.
    pub(super) fatal: Option<i32>,
}

impl Signals {
    /// Starts the thread, which runs until the program ends.
    pub(super) fn watch(terminal: Arc<Terminal>) -> io::Result<Self> {
        let (wake, mut waker) = UnixStream::pair()?;
        wake.set_nonblocking(true)?;
        waker.set_nonblocking(true)?;
        let pending = Arc::new(Mutex::new(PendingSignals::default()));
        let shared = Arc::clone(&pending);
        let noticed = Arc::new(AtomicBool::new(false));
        let answered = Arc::clone(&noticed);
        let mut signals = Caught::new(FATAL.iter().chain(&OF_SYSTEM).chain(&OTHERS))?;
        thread::Builder::new().name("signals".to_owned()).spawn(move || {
            for signal in signals.forever() {
                let mut pending = shared.lock().unwrap_or_else(PoisonError::into_inner);
                match signal {
                    SIGTSTP => pending.stop = true,
                    SIGCONT => pending.resumed = true,
                    SIGWINCH => pending.resized = true,
                    SIGXFSZ => continue,
                    fatal => pending.fatal = Some(fatal),
                }
                let fatal = pending.fatal;
                drop(pending);
                // A full pipe wakes the reader as well as one more byte.
                let _ = waker.write(&[0]);
                if let Some(fatal) = fatal {
                    // The frame loop ends the program; a blocked frame loop is not waited for.
                    thread::sleep(GRACE);
                    terminal.leave();
                    if answered.load(Ordering::Acquire) {
                        thread::sleep(SAVING);
                    }
                    signal_hook::low_level::exit(128 + fatal);
                }
            }
        })?;
        Ok(Self { pending, wake, answered: noticed })
    }

    /// Returns a stream that is readable when signals are pending.
    pub(super) fn wake(&self) -> &UnixStream {
        &self.wake
    }

    pub(super) fn take(&self) -> PendingSignals {
        while matches!((&self.wake).read(&mut [0; 64]), Ok(64)) {}
        let mut pending = self.pending.lock().unwrap_or_else(PoisonError::into_inner);
        self.answered.fetch_or(pending.fatal.is_some(), Ordering::Release);
        let left = PendingSignals { fatal: pending.fatal, ..PendingSignals::default() };
        mem::replace(&mut *pending, left)
    }

    /// Stops the program and everything in its process group, as the terminal's own Ctrl-Z does. Returns when it is
    /// resumed.
    pub(super) fn stop(&self) -> io::Result<()> {
        // SIGTSTP would not work: it is caught here, and its default action is ignored in an orphaned process
        // group.
        kill_current_process_group(Signal::STOP)?;
        while !matches!(
            self.take(),
            PendingSignals { resumed: true, .. } | PendingSignals { fatal: Some(_), .. }
        ) {
            let mut fds = [PollFd::new(&self.wake, PollFlags::IN)];
            match poll(&mut fds, None) {
                Ok(_) | Err(rustix::io::Errno::INTR) => {}
                Err(error) => return Err(error.into()),
            }
        }
        Ok(())
    }

    /// Whether the program was asked to end.
    pub(super) fn is_fatal(&self) -> bool {
        self.pending.lock().unwrap_or_else(PoisonError::into_inner).fatal.is_some()
    }
}
