//! The terminal and its one guard: every mode that is set goes through here, and one call undoes them all.
//!
//! In: what to set, bytes to show. Out: bytes typed, the window's size. Several threads hold it: the frame loop, the
//! signal thread and the panic hook, any of which may have to [`Terminal::leave`]; after that no byte is sent.
//! Never here: what the bytes mean, or a question put to the terminal.

use std::env;
use std::ffi::OsStr;
use std::io;
use std::os::fd::{AsFd, BorrowedFd, OwnedFd};
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};
use std::thread;
use std::time::{Duration, Instant};

use ratatui::layout::Size;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{Mode as FileMode, OFlags, open};
use rustix::termios::{
    OptionalActions, QueueSelector, Termios, isatty, tcflush, tcgetattr, tcgetwinsize, tcsetattr,
    ttyname,
};

/// How long a terminal may take to accept what restores it, before its unsent output is thrown away.
const PATIENCE: Duration = Duration::from_millis(60);

/// Sizes beyond this, columns and rows, are taken for an error of whoever reports them.
const LARGEST: (u16, u16) = (1000, 1000);

/// The size of a terminal that does not know its own.
const USUAL: (u16, u16) = (80, 24);

/// Why there is no terminal to work with, as a sentence for the user.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TerminalError {
    /// Standard input or output is a file or a pipe.
    #[error("the laboratory needs a terminal for its input and output; {HEADLESS}")]
    Redirected,
    /// `TERM=dumb`.
    #[error(
        "the laboratory needs a terminal that can place its cursor, and TERM is `dumb`; {HEADLESS}"
    )]
    Dumb,
}

/// What can be done without one.
const HEADLESS: &str = "`phaselab run PRESET` integrates without one";

impl TerminalError {
    /// Whether there is a terminal to work with.
    pub(super) fn check() -> Result<(), TerminalError> {
        if !isatty(rustix::stdio::stdin()) || !isatty(rustix::stdio::stdout()) {
            return Err(TerminalError::Redirected);
        }
        let dumb = env::var_os("TERM").as_deref() == Some(OsStr::new("dumb"));
        if dumb { Err(TerminalError::Dumb) } else { Ok(()) }
    }
}

/// Something a terminal can be switched to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mode {
    /// A screen of our own; the shell's comes back unharmed.
    AlternateScreen,
    /// No cursor.
    HiddenCursor,
    /// Pasted text comes in brackets.
    Paste,
    /// Buttons, drags and the wheel are reported, in decimal numbers.
    Mouse,
    /// It is reported when the window gets the keyboard and loses it.
    Focus,
}

impl Mode {
    /// What switches it on, and off.
    fn sequences(self) -> [&'static [u8]; 2] {
        match self {
            Self::AlternateScreen => [b"\x1b[?1049h", b"\x1b[?1049l"],
            Self::HiddenCursor => [b"\x1b[?25l", b"\x1b[?25h"],
            Self::Paste => [b"\x1b[?2004h", b"\x1b[?2004l"],
            Self::Mouse => {
                [b"\x1b[?1000h\x1b[?1002h\x1b[?1006h", b"\x1b[?1006l\x1b[?1002l\x1b[?1000l"]
            }
            Self::Focus => [b"\x1b[?1004h", b"\x1b[?1004l"],
        }
    }
}

/// What a wait has brought.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Ready {
    /// Something was typed.
    pub(super) input: bool,
    /// The terminal has hung up.
    pub(super) gone: bool,
}

/// The terminal on standard input and output.
#[derive(Debug)]
pub(super) struct Terminal {
    input: BorrowedFd<'static>,
    /// Opened anew, so that it does not block and the setting is not shared with the shell that started us.
    output: OwnedFd,
    held: Mutex<Option<Held>>,
}

/// What has to be undone.
#[derive(Debug)]
struct Held {
    cooked: Termios,
    modes: Vec<Mode>,
}

impl Terminal {
    /// The terminal, not touched yet.
    pub(super) fn open() -> io::Result<Self> {
        let (input, output) = (rustix::stdio::stdin(), rustix::stdio::stdout());
        let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::NONBLOCK | OFlags::CLOEXEC;
        let output = ttyname(output, Vec::new())
            .and_then(|name| open(name, flags, FileMode::empty()))
            .or_else(|_| open("/dev/tty", flags, FileMode::empty()))
            // Both can be out of reach, in a container or after a change of user. A stalled terminal then blocks.
            .or_else(|_| rustix::io::dup(output))?;
        Ok(Self { input, output, held: Mutex::new(None) })
    }

    /// Makes the terminal raw; the bytes that set the modes are for the caller to send. Entering again sets everything
    /// anew, for after a stop or a failure nobody knows how the terminal was left.
    pub(super) fn enter(&self) -> io::Result<Vec<u8>> {
        let mut held = self.lock();
        let now = match held.take() {
            Some(held) => held,
            None => Held {
                cooked: tcgetattr(self.input)?,
                modes: vec![Mode::AlternateScreen, Mode::HiddenCursor, Mode::Focus],
            },
        };
        let mut raw = now.cooked.clone();
        raw.make_raw();
        let sequences = now.modes.iter().flat_map(|mode| mode.sequences()[0]).copied().collect();
        *held = Some(now);
        tcsetattr(self.input, OptionalActions::Now, &raw)?;
        Ok(sequences)
    }

    /// Switches a mode; the bytes are for the caller to send.
    pub(super) fn switch(&self, mode: Mode, on: bool) -> &'static [u8] {
        let mut held = self.lock();
        let Some(held) = held.as_mut().filter(|held| held.modes.contains(&mode) != on) else {
            return b"";
        };
        held.modes.retain(|&other| other != mode);
        let [switch_on, switch_off] = mode.sequences();
        if on {
            held.modes.push(mode);
            return switch_on;
        }
        switch_off
    }

    /// Undoes all that was done. May be called by any thread, at any time, more than once. Typed input that nobody has
    /// read is dropped, so that the rest of a paste does not become commands of the shell.
    pub(super) fn leave(&self) {
        let held = self.lock_soon().and_then(|mut held| held.take());
        let Some(Held { cooked, modes }) = held else { return };
        let mut bytes = b"\x1b[?2026l\x1b[0m".to_vec();
        bytes.extend(modes.iter().rev().flat_map(|mode| mode.sequences()[1]));
        if !self.write_within(&mut bytes, PATIENCE) {
            // A stalled terminal: what it has not taken so far was a frame that no longer matters.
            let _ = tcflush(&self.output, QueueSelector::OFlush);
            self.write_within(&mut bytes, PATIENCE);
        }
        let _ = tcflush(self.input, QueueSelector::IFlush);
        let _ = tcsetattr(self.input, OptionalActions::Now, &cooked);
    }

    /// Whether there is something to undo.
    pub(super) fn is_held(&self) -> bool {
        self.lock_soon().is_some_and(|held| held.is_some())
    }

    /// Sends what the terminal takes without waiting. After [`Self::leave`] nothing is sent.
    pub(super) fn write(&self, bytes: &[u8]) -> io::Result<usize> {
        let held = self.lock();
        if held.is_none() {
            return Ok(bytes.len());
        }
        Ok(rustix::io::write(&self.output, bytes)?)
    }

    /// Reads what was typed; call it when there is something.
    pub(super) fn read(&self, buffer: &mut [u8]) -> io::Result<usize> {
        Ok(rustix::io::read(self.input, buffer)?)
    }

    /// Columns and rows.
    pub(super) fn size(&self) -> Size {
        let (columns, rows) = match tcgetwinsize(&self.output) {
            Ok(size) if size.ws_col > 0 && size.ws_row > 0 => (size.ws_col, size.ws_row),
            _ => USUAL,
        };
        Size::new(columns.min(LARGEST.0), rows.min(LARGEST.1))
    }

    /// Waits until something is typed, `wake` can be read, the terminal takes output again (if that is asked for), or
    /// the time is over.
    pub(super) fn wait(
        &self,
        wake: impl AsFd,
        for_output: bool,
        time: Duration,
    ) -> io::Result<Ready> {
        let output = if for_output { PollFlags::OUT } else { PollFlags::empty() };
        let mut fds = [
            PollFd::new(&self.input, PollFlags::IN),
            PollFd::new(&wake, PollFlags::IN),
            PollFd::new(&self.output, output),
        ];
        match poll(&mut fds, Some(&timespec(time))) {
            Ok(_) | Err(rustix::io::Errno::INTR) => {}
            Err(error) => return Err(error.into()),
        }
        let lost = PollFlags::HUP | PollFlags::ERR | PollFlags::NVAL;
        let events = |fd: usize| fds[fd].revents();
        Ok(Ready {
            input: events(0).contains(PollFlags::IN),
            gone: events(0).union(events(2)).intersects(lost),
        })
    }

    /// Writes until all is written, dropping from `bytes` what is; says whether that came to its end in time.
    fn write_within(&self, bytes: &mut Vec<u8>, time: Duration) -> bool {
        let end = Instant::now() + time;
        while !bytes.is_empty() {
            match rustix::io::write(&self.output, bytes) {
                Ok(count) => {
                    bytes.drain(..count);
                }
                Err(rustix::io::Errno::AGAIN) => {
                    let left = end.saturating_duration_since(Instant::now());
                    let mut fds = [PollFd::new(&self.output, PollFlags::OUT)];
                    if left.is_zero() || poll(&mut fds, Some(&timespec(left))) == Ok(0) {
                        return false;
                    }
                }
                Err(rustix::io::Errno::INTR) => {}
                // There is nobody left to show anything to.
                Err(_) => return true,
            }
        }
        true
    }

    fn lock(&self) -> MutexGuard<'_, Option<Held>> {
        self.held.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The lock, unless its holder is stuck in a write that blocks: then nothing can be restored.
    fn lock_soon(&self) -> Option<MutexGuard<'_, Option<Held>>> {
        let end = Instant::now() + PATIENCE;
        loop {
            match self.held.try_lock() {
                Ok(held) => return Some(held),
                Err(TryLockError::Poisoned(held)) => return Some(held.into_inner()),
                Err(TryLockError::WouldBlock) if Instant::now() >= end => return None,
                Err(TryLockError::WouldBlock) => thread::sleep(Duration::from_millis(1)),
            }
        }
    }
}

fn timespec(time: Duration) -> Timespec {
    Timespec { tv_sec: time.as_secs() as i64, tv_nsec: time.subsec_nanos().into() }
}
