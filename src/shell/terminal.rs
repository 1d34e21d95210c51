//! The terminal and its guard: every mode is set here, and one call restores them all.
//!
//! In: modes to set, bytes to show. Out: crossterm's commands for the modes, typed bytes, the window's size.
//! Several threads share it: the frame loop, the signal thread and the panic hook, any of which may have to call
//! [`Terminal::leave`]; after that no byte is sent. (`ratatui::restore` would not reset pastes, the mouse and
//! focus.)
//! Never here: what the bytes mean.

use std::ffi::OsStr;
use std::io::{self, Write};
use std::os::fd::{AsFd, BorrowedFd, OwnedFd};
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};
use std::thread;
use std::time::{Duration, Instant};
use std::{env, fmt};

use crossterm::cursor::{Hide, Show};
use crossterm::event::{
    DisableBracketedPaste, DisableFocusChange, EnableBracketedPaste, EnableFocusChange,
    KeyboardEnhancementFlags, PopKeyboardEnhancementFlags, PushKeyboardEnhancementFlags,
};
use crossterm::style::{Attribute, SetAttribute};
use crossterm::terminal::{
    EndSynchronizedUpdate, EnterAlternateScreen, LeaveAlternateScreen, disable_raw_mode,
    enable_raw_mode, window_size,
};
use crossterm::{Command, queue};
use ratatui::layout::Size;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{Mode as FileMode, OFlags, open};
use rustix::termios::{QueueSelector, isatty, tcflush, ttyname};

/// How long a terminal may take to accept the restoring bytes before its unsent output is discarded.
const TIMEOUT: Duration = Duration::from_millis(60);

/// Larger sizes, in columns and rows, are treated as errors of the terminal.
const LARGEST: (u16, u16) = (1000, 1000);

/// The size assumed for a terminal that does not know its own.
const USUAL: (u16, u16) = (80, 24);

/// Why there is no usable terminal, as a sentence for the user.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TerminalError {
    /// Standard input or output is a file or a pipe.
    #[error("the laboratory needs a terminal for its input and output{0}")]
    Redirected(&'static str),
    /// `TERM=dumb`.
    #[error("the laboratory needs a terminal that can place its cursor, and TERM is `dumb`{0}")]
    Dumb(&'static str),
}

/// What integrates without a terminal.
pub(super) const HEADLESS: &str = "; `phaselab run PRESET` integrates without one";
/// What shows a demo without a terminal.
pub(super) const RECORDED: &str =
    "; `phaselab record PRESET --format account` describes a demo without one";

impl TerminalError {
    /// Checks that there is a usable terminal; `instead` ends the sentence with what needs none.
    pub(super) fn check(instead: &'static str) -> Result<(), TerminalError> {
        if !isatty(rustix::stdio::stdin()) || !isatty(rustix::stdio::stdout()) {
            return Err(TerminalError::Redirected(instead));
        }
        let dumb = env::var_os("TERM").as_deref() == Some(OsStr::new("dumb"));
        if dumb { Err(TerminalError::Dumb(instead)) } else { Ok(()) }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TerminalMode {
    /// The alternate screen; the shell's screen reappears unchanged.
    AlternateScreen,
    HiddenCursor,
    /// Pasted text is enclosed in brackets.
    Paste,
    /// Buttons, drags and the wheel are reported, in decimal numbers.
    Mouse,
    /// Changes of the window's focus are reported.
    Focus,
    /// Keys that have the same bytes otherwise are distinguished, as kitty does.
    Keyboard,
}

impl TerminalMode {
    /// Writes the commands that switch it on or off.
    fn switch(self, on: bool, mut out: impl Write) -> io::Result<()> {
        match (self, on) {
            (Self::AlternateScreen, true) => queue!(out, EnterAlternateScreen),
            (Self::AlternateScreen, false) => queue!(out, LeaveAlternateScreen),
            (Self::HiddenCursor, true) => queue!(out, Hide),
            (Self::HiddenCursor, false) => queue!(out, Show),
            (Self::Paste, true) => queue!(out, EnableBracketedPaste),
            (Self::Paste, false) => queue!(out, DisableBracketedPaste),
            (Self::Mouse, on) => queue!(out, ReportMouse(on)),
            (Self::Focus, true) => queue!(out, EnableFocusChange),
            (Self::Focus, false) => queue!(out, DisableFocusChange),
            (Self::Keyboard, true) => {
                let flags = KeyboardEnhancementFlags::DISAMBIGUATE_ESCAPE_CODES;
                queue!(out, PushKeyboardEnhancementFlags(flags))
            }
            (Self::Keyboard, false) => queue!(out, PopKeyboardEnhancementFlags),
        }
    }
}

/// Enables or disables reports of buttons, drags and the wheel. crossterm's `EnableMouseCapture` also enables
/// reports of every motion (mode 1003, crossterm-rs/crossterm#640): the connection would carry some ten bytes, and
/// the program wake up, for each cell that the mouse passes.
struct ReportMouse(bool);

impl Command for ReportMouse {
    fn write_ansi(&self, f: &mut impl fmt::Write) -> fmt::Result {
        let ReportMouse(on) = *self;
        f.write_str(if on {
            "\x1b[?1000h\x1b[?1002h\x1b[?1006h"
        } else {
            "\x1b[?1006l\x1b[?1002l\x1b[?1000l"
        })
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Readiness {
    pub(super) input: bool,
    /// Whether the terminal has hung up.
    pub(super) hung_up: bool,
}

/// The terminal on standard input and output.
#[derive(Debug)]
pub(super) struct Terminal {
    input: BorrowedFd<'static>,
    /// Opened separately, so that it does not block and its flags are not shared with the shell that started the
    /// program.
    output: OwnedFd,
    /// The modes to be undone, besides raw mode; `None` if the terminal has not been changed.
    active: Mutex<Option<Vec<TerminalMode>>>,
}

impl Terminal {
    /// Opens the terminal without changing it.
    pub(super) fn open() -> io::Result<Self> {
        let (input, output) = (rustix::stdio::stdin(), rustix::stdio::stdout());
        let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::NONBLOCK | OFlags::CLOEXEC;
        let output = ttyname(output, Vec::new())
            .and_then(|name| open(name, flags, FileMode::empty()))
            .or_else(|_| open("/dev/tty", flags, FileMode::empty()))
            // The device can be inaccessible, in a container or after a change of user. A stalled terminal then
            // blocks.
            .or_else(|_| rustix::io::dup(output))?;
        Ok(Self { input, output, active: Mutex::new(None) })
    }

    /// Makes the terminal raw, and writes the commands for its modes. Entering again sets everything again, since
    /// the state of the terminal is unknown after a stop or a failure.
    pub(super) fn enter(&self, mut out: impl Write) -> io::Result<()> {
        let mut active = self.lock();
        let first =
            || vec![TerminalMode::AlternateScreen, TerminalMode::HiddenCursor, TerminalMode::Focus];
        let modes = active.get_or_insert_with(first);
        // A shell may have changed the mode since, although crossterm still considers it raw.
        disable_raw_mode()?;
        enable_raw_mode()?;
        if modes.contains(&TerminalMode::Keyboard) {
            // It was pushed before, on the same stack.
            TerminalMode::Keyboard.switch(false, &mut out)?;
        }
        modes.iter().try_for_each(|mode| mode.switch(true, &mut out))
    }

    /// Switches a mode, and writes the commands for that.
    pub(super) fn switch(&self, mode: TerminalMode, on: bool, out: impl Write) -> io::Result<()> {
        let mut active = self.lock();
        let Some(modes) = active.as_mut().filter(|modes| modes.contains(&mode) != on) else {
            return Ok(());
        };
        modes.retain(|&other| other != mode);
        if on {
            modes.push(mode);
        }
        mode.switch(on, out)
    }

    /// Undoes all changes. Any thread may call it, at any time, more than once. Unread input is discarded, so that
    /// the rest of a paste does not become commands of the shell.
    pub(super) fn leave(&self) {
        let active = self.lock_soon().and_then(|mut active| active.take());
        let Some(modes) = active else { return };
        let mut bytes = Vec::new();
        // Writing to memory cannot fail.
        let _ = queue!(bytes, EndSynchronizedUpdate, SetAttribute(Attribute::Reset));
        for mode in modes.iter().rev() {
            let _ = mode.switch(false, &mut bytes);
        }
        if !self.write_within(&mut bytes, TIMEOUT) {
            // The terminal is stalled: the rest of the frame that it has not accepted no longer matters.
            let _ = tcflush(&self.output, QueueSelector::OFlush);
            self.write_within(&mut bytes, TIMEOUT);
        }
        let _ = tcflush(self.input, QueueSelector::IFlush);
        let _ = disable_raw_mode();
    }

    /// Whether there is something to undo.
    pub(super) fn is_changed(&self) -> bool {
        self.lock_soon().is_some_and(|active| active.is_some())
    }

    /// Sends what the terminal accepts without blocking. After [`Self::leave`] nothing is sent.
    pub(super) fn write(&self, bytes: &[u8]) -> io::Result<usize> {
        let active = self.lock();
        if active.is_none() {
            return Ok(bytes.len());
        }
        Ok(rustix::io::write(&self.output, bytes)?)
    }

    /// Reads input; call it when there is some.
    pub(super) fn read(&self, buffer: &mut [u8]) -> io::Result<usize> {
        Ok(rustix::io::read(self.input, buffer)?)
    }

    pub(super) fn has_input(&self) -> io::Result<bool> {
        let mut fds = [PollFd::new(&self.input, PollFlags::IN)];
        match poll(&mut fds, Some(&timespec(Duration::ZERO))) {
            Ok(_) | Err(rustix::io::Errno::INTR) => Ok(fds[0].revents().contains(PollFlags::IN)),
            Err(error) => Err(error.into()),
        }
    }

    /// Returns the size in columns and rows.
    pub(super) fn size() -> Size {
        let (columns, rows) = match window_size() {
            Ok(size) if size.columns > 0 && size.rows > 0 => (size.columns, size.rows),
            _ => USUAL,
        };
        Size::new(columns.min(LARGEST.0), rows.min(LARGEST.1))
    }

    /// Waits until there is input, `wake` is readable, the terminal accepts output again (if that is requested), or
    /// the time is over.
    pub(super) fn wait(
        &self,
        wake: impl AsFd,
        for_output: bool,
        time: Duration,
    ) -> io::Result<Readiness> {
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
        Ok(Readiness {
            input: events(0).contains(PollFlags::IN),
            hung_up: events(0).union(events(2)).intersects(lost),
        })
    }

    /// Writes all of `bytes`, removing what has been written. Returns whether that was completed in time.
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
                // The terminal has hung up, so there is nothing left to write to.
                Err(_) => return true,
            }
        }
        true
    }

    fn lock(&self) -> MutexGuard<'_, Option<Vec<TerminalMode>>> {
        self.active.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes the lock, unless its holder is stuck in a blocking write: then nothing can be restored.
    fn lock_soon(&self) -> Option<MutexGuard<'_, Option<Vec<TerminalMode>>>> {
        let end = Instant::now() + TIMEOUT;
        loop {
            match self.active.try_lock() {
                Ok(active) => return Some(active),
                Err(TryLockError::Poisoned(active)) => return Some(active.into_inner()),
                Err(TryLockError::WouldBlock) if Instant::now() >= end => return None,
                Err(TryLockError::WouldBlock) => thread::sleep(Duration::from_millis(1)),
            }
        }
    }
}

fn timespec(time: Duration) -> Timespec {
    Timespec { tv_sec: time.as_secs() as i64, tv_nsec: time.subsec_nanos().into() }
}
