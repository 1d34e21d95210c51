//! Signals: a thread that ends the program as it should end, and passes on what the frame loop has to do.
//!
//! In: signals. Out: a note of what the frame loop has to do; where that does not end the program in time, a restored
//! terminal and the exit status 128 + n. Never here: work inside a signal
//! handler; the thread is an ordinary one, woken through a pipe.

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

/// How long the frame loop has to save what there is and end, before the terminal is restored without it; and how long
/// it has beyond that, if it has begun to end, before the program is ended all the same.
const LAST_WORDS: Duration = Duration::from_millis(150);
const SAVING: Duration = Duration::from_millis(1500);

/// What ends a program that does not catch it. A thread that is to be reported of SIGSEGV, SIGILL or SIGFPE would be reported too
/// late, so they cannot be caught here, and SIGKILL nowhere; a real abort ends the program before the thread is awake.
const FATAL: [i32; 15] = [
    SIGTERM, SIGHUP, SIGINT, SIGQUIT, SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM, SIGPROF, SIGXCPU,
    SIGIO, SIGABRT, SIGBUS, SIGSYS, SIGTRAP,
];

/// What the frame loop has to do beside; and a file that has become too large (SIGXFSZ), of which its writer hears by an
/// error.
const OTHERS: [i32; 4] = [SIGTSTP, SIGCONT, SIGWINCH, SIGXFSZ];

/// The way from the signal thread to the frame loop.
#[derive(Debug)]
pub(super) struct Signals {
    posted: Arc<Mutex<PendingSignals>>,
    wake: UnixStream,
    /// The frame loop has heard that it is to end.
    answered: Arc<AtomicBool>,
}

/// What has happened since the last look.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PendingSignals {
    /// The program was asked to stop (SIGTSTP).
    pub(super) stop: bool,
    /// It was stopped and goes on (SIGCONT).
    pub(super) resumed: bool,
    /// The window has changed its size (SIGWINCH).
    pub(super) resized: bool,
    /// The program was asked to end by this signal; it stays noted.
    pub(super) fatal: Option<i32>,
}

impl Signals {
    /// Starts to watch; the thread ends with the program.
    pub(super) fn watch(terminal: Arc<Terminal>) -> io::Result<Self> {
        let (wake, mut bell) = UnixStream::pair()?;
        wake.set_nonblocking(true)?;
        bell.set_nonblocking(true)?;
        let posted = Arc::new(Mutex::new(PendingSignals::default()));
        let board = Arc::clone(&posted);
        let heard = Arc::new(AtomicBool::new(false));
        let answered = Arc::clone(&heard);
        let mut signals = Caught::new(FATAL.iter().chain(&OTHERS))?;
        thread::Builder::new().name("signals".to_owned()).spawn(move || {
            for signal in signals.forever() {
                let mut notes = board.lock().unwrap_or_else(PoisonError::into_inner);
                match signal {
                    SIGTSTP => notes.stop = true,
                    SIGCONT => notes.resumed = true,
                    SIGWINCH => notes.resized = true,
                    SIGXFSZ => continue,
                    fatal => notes.fatal = Some(fatal),
                }
                let fatal = notes.fatal;
                drop(notes);
                // A full pipe wakes as well as one more byte.
                let _ = bell.write(&[0]);
                if let Some(fatal) = fatal {
                    // The frame loop ends the program; one that is stuck is not waited for.
                    thread::sleep(LAST_WORDS);
                    terminal.leave();
                    if answered.load(Ordering::Acquire) {
                        thread::sleep(SAVING);
                    }
                    signal_hook::low_level::exit(128 + fatal);
                }
            }
        })?;
        Ok(Self { posted, wake, answered: heard })
    }

    /// Can be read when there is a note.
    pub(super) fn wake(&self) -> &UnixStream {
        &self.wake
    }

    /// Takes the notes.
    pub(super) fn take(&self) -> PendingSignals {
        while matches!((&self.wake).read(&mut [0; 64]), Ok(64)) {}
        let mut posted = self.posted.lock().unwrap_or_else(PoisonError::into_inner);
        self.answered.fetch_or(posted.fatal.is_some(), Ordering::Release);
        let left = PendingSignals { fatal: posted.fatal, ..PendingSignals::default() };
        mem::replace(&mut *posted, left)
    }

    /// Stops the program and all that was started with it in one pipeline, as the terminal's own Ctrl-Z does, and
    /// returns when it goes on.
    pub(super) fn stop(&self) -> io::Result<()> {
        // Not SIGTSTP: that is caught here, and by default it does nothing in a group that has no shell.
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
        self.posted.lock().unwrap_or_else(PoisonError::into_inner).fatal.is_some()
    }
}
