//! The stage: the frame loop, which holds a page up on the terminal until it is done.
//!
//! In: a [`Screen`], what is typed, signals. Out: frames, and how it ended. It waits in one place, for all there is to
//! wait for. Never here: what the page is about.
//!
//! There is no writing thread: the terminal is written to without blocking, and while it has not taken the last frame
//! none is drawn. So a stalled terminal costs pictures, never a key.

use std::io;
use std::sync::Arc;
use std::time::{Duration, Instant};

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};

use super::governor::Governor;
use super::input::{Decoder, Input};
use super::panic;
use super::queue::Queue;
use super::request::LabError;
use super::signals::Signals;
use super::terminal::{Mode, Ready, Terminal, TerminalError};
use crate::app::Mouse;
use crate::view::Detail;
use crate::view::frame::Frames;

/// What can be held up on a terminal.
pub trait Screen {
    /// Something was done at the terminal.
    fn input(&mut self, input: Input) -> ScreenRequest;

    /// A frame is due and this much time has passed since the last; whether anything to be seen has changed.
    fn advance(&mut self, elapsed: Duration) -> bool;

    /// Draws on a blank area, and says where the terminal's cursor belongs, if it is to be seen.
    fn draw(&mut self, area: Rect, buffer: &mut Buffer) -> Option<Position>;

    /// Whether text is being typed, so that a paste should come as one.
    fn is_typing(&self) -> bool;

    /// Whether nothing more will come; the last picture is then shown and the page ends.
    fn is_done(&self) -> bool {
        false
    }

    /// It ends: what must not be lost is written down now, before anybody waits for the terminal; `hurried` where it is
    /// made to, and there is little time.
    fn on_exit(&mut self, _hurried: bool) {}

    /// The line to the terminal carries only so much: the next pictures should be that much poorer.
    fn reduce(&mut self, _detail: Detail) {}
}

/// What a page wants of the terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScreenRequest {
    /// Nothing but to be drawn anew.
    Nothing,
    /// Every cell painted, whatever the terminal shows.
    Repaint,
    /// The mouse reported, or left to the terminal.
    Mouse(bool),
    /// At most so many frames in a second.
    Frames(u16),
    /// To be stopped as by Ctrl-Z.
    Suspend,
    /// To end.
    Quit,
}

/// How frames are sent.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    /// The most frames in a second, at least one.
    pub frames: u16,
    /// The most bytes in a second, if there is a limit.
    pub bytes: Option<u32>,
    /// Whether they come between the marks of synchronized output.
    pub synchronized: bool,
    /// Whether the mouse is reported from the beginning.
    pub mouse: bool,
}

/// How a page came to its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// It wanted to.
    Quit,
    /// The terminal has hung up.
    Gone,
    /// This signal asked for it.
    Signal(i32),
}

/// Reads in a row before a frame is drawn, each of [`READ`] bytes; a flood must not keep the screen still.
const READS: usize = 64;
const READ: usize = 4096;

/// Frames that may fail one after the other before the terminal is given up.
const FAILURES: u32 = 20;

/// Holds a page up on the terminal until it ends. The terminal is then as it was, whatever the way out.
///
/// # Errors
/// Where there is no terminal, or it can no longer be used.
pub fn perform(page: &mut impl Screen, pace: Pace) -> Result<Ending, LabError> {
    TerminalError::check()?;
    let terminal = Arc::new(Terminal::open()?);
    panic::guard(&terminal);
    let signals = Signals::watch(Arc::clone(&terminal))?;
    let guard = Guard(terminal);
    let mut stage = Stage {
        terminal: &guard.0,
        signals,
        decoder: Decoder::default(),
        screen: Frames::new(pace.synchronized),
        queue: Queue::default(),
        size: None,
        governor: Governor::new(pace.frames, pace.bytes, Instant::now()),
        mouse: pace.mouse,
        failures: 0,
    };
    let ended = stage.enter().and_then(|()| stage.run(page));
    page.on_exit(!matches!(ended, Ok(Ending::Quit)));
    Ok(ended?)
}

/// Restores the terminal when it goes.
struct Guard(Arc<Terminal>);

impl Drop for Guard {
    fn drop(&mut self) {
        self.0.leave();
    }
}

struct Stage<'a> {
    terminal: &'a Terminal,
    signals: Signals,
    decoder: Decoder,
    screen: Frames,
    queue: Queue,
    size: Option<Size>,
    governor: Governor,
    /// The mouse is wanted.
    mouse: bool,
    failures: u32,
}

impl Stage<'_> {
    fn run(&mut self, page: &mut impl Screen) -> io::Result<Ending> {
        let mut last = Instant::now();
        let mut due = last;
        let mut changed = true;
        loop {
            let notes = self.signals.take();
            if let Some(signal) = notes.fatal {
                return Ok(Ending::Signal(signal));
            }
            if notes.stop {
                self.suspend()?;
            } else if notes.resumed {
                self.enter()?;
            } else if notes.resized {
                // Even where the size is the same again, the terminal may have lost what it showed.
                self.screen.forget();
            }
            if self.decoder.deadline().is_some_and(|deadline| deadline <= Instant::now()) {
                self.decoder.expire();
            }
            while let Some(input) = self.decoder.next() {
                changed = true;
                due = due.min(self.governor.soon(Instant::now()));
                if !self.admits(&input) {
                    continue;
                }
                match page.input(input) {
                    ScreenRequest::Nothing => {}
                    ScreenRequest::Repaint => self.screen.forget(),
                    ScreenRequest::Mouse(on) => self.mouse = on,
                    ScreenRequest::Frames(count) => self.governor.want(count),
                    ScreenRequest::Suspend => self.suspend()?,
                    ScreenRequest::Quit => return Ok(Ending::Quit),
                }
            }
            if due <= Instant::now() && !self.queue.is_busy() {
                let now = Instant::now();
                changed |= self.resize(page) | page.advance(now - last) | !self.screen.is_current();
                let bytes = if changed { self.frame(page) } else { 0 };
                changed = self.count(bytes, page);
                (last, due) = (now, self.governor.due());
            }
            self.send()?;
            if page.is_done() && !changed && !self.queue.is_busy() {
                return Ok(Ending::Quit);
            }

            let ready = self.wait(due)?;
            if ready.gone || ready.input && !self.read()? {
                return Ok(Ending::Gone);
            }
        }
    }

    /// Sets the terminal up, and knows nothing of what it shows.
    fn enter(&mut self) -> io::Result<()> {
        self.queue.clear();
        self.queue.push(&self.terminal.enter()?);
        self.decoder.expect(Mode::Focus, true);
        self.governor.watched = true;
        self.screen.forget();
        Ok(())
    }

    /// Switches a mode, and knows what may then come in.
    fn switch(&mut self, mode: Mode, on: bool) {
        self.queue.push(self.terminal.switch(mode, on));
        self.decoder.expect(mode, on);
    }

    /// Whether an input is for the page: what lies beyond the window is not. Who types or clicks looks here, even
    /// where the terminal has not said so.
    fn admits(&mut self, input: &Input) -> bool {
        match *input {
            Input::Focus(gained) => self.governor.watched = gained,
            Input::Key(_) | Input::Paste(_) => self.governor.watched = true,
            Input::Mouse(Mouse { column, row, .. }) => {
                let size = self.size.unwrap_or_default();
                return column < size.width && row < size.height;
            }
            Input::Resize(..) => {}
        }
        true
    }

    /// Gives the terminal back until the program goes on.
    fn suspend(&mut self) -> io::Result<()> {
        self.terminal.leave();
        self.signals.stop()?;
        // What ends in the background must not touch the terminal, or it is stopped again.
        if self.signals.is_fatal() { Ok(()) } else { self.enter() }
    }

    /// Tells the page of a new size. It is asked for every time, which many resizes at once cannot outrun.
    fn resize(&mut self, page: &mut impl Screen) -> bool {
        let size = self.terminal.size();
        let changed = self.size.replace(size) != Some(size);
        if changed {
            page.input(Input::Resize(size.width, size.height));
        }
        changed
    }

    /// Draws, and puts what has changed in the queue; how many bytes that are.
    fn frame(&mut self, page: &mut impl Screen) -> usize {
        let size = self.size.unwrap_or_default();
        self.switch(Mode::Paste, page.is_typing());
        self.switch(Mode::Mouse, self.mouse);
        let draw = |area, buffer: &mut Buffer| page.draw(area, buffer);
        let frame = self.screen.next_with(size, self.governor.most(), draw);
        self.queue.push(&frame);
        self.switch(Mode::HiddenCursor, self.screen.cursor().is_none());
        frame.len()
    }

    /// Has the bytes of a frame count, and says whether the next must be drawn because it is richer or poorer.
    fn count(&mut self, bytes: usize, page: &mut impl Screen) -> bool {
        let before = self.governor.detail();
        self.governor.sent(bytes, Instant::now());
        let detail = self.governor.detail();
        if detail != before {
            page.reduce(detail);
        }
        detail != before
    }

    /// Sends what the terminal takes. One failed write costs a frame; then all is set up and painted anew.
    fn send(&mut self) -> io::Result<()> {
        match self.queue.send(|bytes| self.terminal.write(bytes)) {
            Ok(()) => self.failures = 0,
            Err(error) if self.failures == FAILURES => return Err(error),
            Err(_) => {
                self.failures += 1;
                self.enter()?;
            }
        }
        Ok(())
    }

    /// Waits for input, a signal, room for output or the next frame.
    fn wait(&self, due: Instant) -> io::Result<Ready> {
        let busy = self.queue.is_busy();
        let now = Instant::now();
        let frame = Some(due).filter(|_| !busy);
        let times = [frame, self.decoder.deadline(), Some(now + Duration::from_secs(1))];
        let next = times.into_iter().flatten().min().unwrap_or(now);
        let time = next.saturating_duration_since(now);
        self.terminal.wait(self.signals.wake(), busy, time)
    }

    /// Reads what was typed; `false` if the terminal is gone.
    fn read(&mut self) -> io::Result<bool> {
        let mut buffer = [0; READ];
        for _ in 0..READS {
            match self.terminal.read(&mut buffer) {
                Ok(0) => return Ok(false),
                Ok(count) => self.decoder.feed(&buffer[..count], Instant::now()),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => break,
                Err(_) => return Ok(false),
            }
            if !self.terminal.wait(self.signals.wake(), false, Duration::ZERO)?.input {
                break;
            }
        }
        Ok(true)
    }
}
