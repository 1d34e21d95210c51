//! The frame loop, which shows a page on the terminal until the page is done.
//!
//! In: a [`Screen`], typed input, signals. Out: frames, and how it ended. It blocks in a single place, for
//! everything that can happen. Never here: what the page is about.
//!
//! There is no writing thread: writes to the terminal do not block, and no frame is drawn until the terminal has
//! accepted the last one. So a stalled terminal costs pictures, but never a key.

use std::io::{self, Write};
use std::sync::Arc;
use std::time::{Duration, Instant};

use crossterm::event::Event;
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};

use super::clipboard;
use super::decoder::Decoder;
use super::events::EventSource;
use super::governor::Governor;
use super::lab_error::LabError;
use super::panic;
use super::question::{Questions, TerminalReply};
use super::queue::Queue;
use super::signals::Signals;
use super::terminal::{HEADLESS, Readiness, Terminal, TerminalError, TerminalMode};
use crate::view::Detail;
use crate::view::colour::Rgb;
use crate::view::frame::Frames;

/// A page that can be shown on a terminal.
pub trait Screen {
    /// Handles an event of the terminal.
    fn input(&mut self, event: Event) -> ScreenRequest;

    /// Advances the time to the next frame. Returns whether anything visible has changed.
    fn advance(&mut self, elapsed: Duration) -> bool;

    /// How long nothing visible will change without input, if that is known; until then no frame is asked for.
    fn rest(&self) -> Option<Duration> {
        None
    }

    /// Draws on a blank area. Returns the position of the terminal's cursor, or `None` to hide it.
    fn draw(&mut self, area: Rect, buffer: &mut Buffer) -> Option<Position>;

    /// Whether text is being typed, so that a paste should arrive as one event.
    fn is_typing(&self) -> bool;

    /// Whether the page is finished; its last picture is then shown, and the loop ends.
    fn is_done(&self) -> bool {
        false
    }

    /// Called at the end, before the terminal is waited for, to save what must not be lost; `hurried` says that the
    /// program is being terminated and there is little time.
    fn on_exit(&mut self, _hurried: bool) {}

    /// Returns a text to be put into the terminal's clipboard, once.
    fn clipboard(&mut self) -> Option<String> {
        None
    }

    /// Sets the level of detail of the next pictures, as the bandwidth allows.
    fn reduce(&mut self, _detail: Detail) {}

    /// Called once if the terminal was asked for the colour of its background, and has answered.
    fn background(&mut self, _colour: Rgb) {}
}

/// What a page requests of the terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScreenRequest {
    /// Nothing except a redraw.
    Nothing,
    /// Repaint every cell, whatever the terminal shows.
    Repaint,
    /// Capture the mouse, or leave it to the terminal.
    Mouse(bool),
    /// Draw at most this many frames per second.
    Frames(u16),
    /// Suspend the process, as Ctrl-Z does.
    Suspend,
    /// End the loop.
    Quit,
}

/// How frames are sent.
#[derive(Clone, Copy, Debug)]
pub struct FramePace {
    /// The maximum number of frames per second, at least one.
    pub frames: u16,
    /// The maximum number of bytes per second, if there is a limit.
    pub bytes: Option<u32>,
    /// Whether frames are enclosed in the marks of synchronized output.
    pub synchronized: bool,
    /// Whether the mouse is captured from the start.
    pub mouse: bool,
    /// What the terminal is asked.
    pub asks: Questions,
}

/// How a page ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// The page requested it.
    Quit,
    /// The terminal has hung up.
    HungUp,
    /// The program was asked to end by this signal.
    Signal(i32),
}

/// How long an answer of the terminal is accepted; nothing waits for it.
const ANSWER: Duration = Duration::from_secs(1);

/// How long a page that is left at once waits for the answer, which the shell would otherwise take for typed text.
const LAST_WORD: Duration = Duration::from_millis(100);

/// The number of consecutive failed frames after which the terminal is given up.
const MOST_FAILED_FRAMES: u32 = 20;

/// Shows a page on the terminal until it ends. The terminal is restored in every case.
///
/// # Errors
/// Returns an error if there is no terminal, or if it can no longer be used.
pub fn run_screen(page: &mut impl Screen, pace: FramePace) -> Result<Ending, LabError> {
    TerminalError::check(HEADLESS)?;
    let terminal = Arc::new(Terminal::open()?);
    panic::guard(&terminal);
    let signals = Signals::watch(Arc::clone(&terminal))?;
    let guard = RestoreOnDrop(terminal);
    let mut frame_loop = FrameLoop {
        terminal: &guard.0,
        signals,
        events: Decoder::default(),
        screen: Frames::new(pace.synchronized)?,
        queue: Queue::default(),
        size: None,
        governor: Governor::new(pace.frames, pace.bytes, Instant::now()),
        mouse: pace.mouse,
        failed_frames: 0,
        keyboard: false,
        asked: None,
    };
    let begun = frame_loop.enter().and_then(|()| frame_loop.ask(pace.asks));
    let ended = begun.and_then(|()| frame_loop.run(page));
    page.on_exit(!matches!(ended, Ok(Ending::Quit)));
    if let Ok(Ending::Quit) = ended {
        // a terminal that has hung up by now has nothing more to say
        let _ = frame_loop.hear_out();
    }
    Ok(ended?)
}

struct RestoreOnDrop(Arc<Terminal>);

impl Drop for RestoreOnDrop {
    fn drop(&mut self) {
        self.0.leave();
    }
}

struct FrameLoop<'a, E> {
    terminal: &'a Terminal,
    signals: Signals,
    events: E,
    screen: Frames,
    queue: Queue,
    size: Option<Size>,
    governor: Governor,
    mouse: bool,
    /// Whether the terminal knows the keyboard protocol.
    keyboard: bool,
    failed_frames: u32,
    /// When the terminal was asked.
    asked: Option<Instant>,
}

impl<E: EventSource> FrameLoop<'_, E> {
    fn run(&mut self, page: &mut impl Screen) -> io::Result<Ending> {
        let mut last = Instant::now();
        let mut due = last;
        let mut changed = true;
        loop {
            let pending = self.signals.take();
            if let Some(signal) = pending.fatal {
                return Ok(Ending::Signal(signal));
            }
            if pending.stop {
                self.suspend()?;
            } else if pending.resumed {
                self.enter()?;
            } else if pending.resized {
                // Even if the size is the same again, the terminal may have lost its contents.
                self.screen.forget();
            }
            if pending.stop || pending.resumed || pending.resized {
                due = due.min(Instant::now());
            }
            while let Some(event) = self.events.next(Instant::now()) {
                changed = true;
                due = due.min(self.governor.soon(Instant::now()));
                if !self.admits(&event) {
                    continue;
                }
                match page.input(event) {
                    ScreenRequest::Nothing => {}
                    ScreenRequest::Repaint => self.screen.forget(),
                    ScreenRequest::Mouse(on) => self.mouse = on,
                    ScreenRequest::Frames(count) => self.governor.want(count),
                    ScreenRequest::Suspend => self.suspend()?,
                    ScreenRequest::Quit => return Ok(Ending::Quit),
                }
                if let Some(text) = page.clipboard() {
                    clipboard::write(&text, &mut self.queue)?;
                }
            }
            while let Some(answer) = self.events.answer() {
                match answer {
                    TerminalReply::Background(colour) => page.background(colour),
                    TerminalReply::Keyboard => self.keyboard = true,
                }
                changed = true;
                due = due.min(self.governor.soon(Instant::now()));
            }
            if self.asked.is_some_and(|asked| asked.elapsed() > ANSWER) {
                self.events.expect_answers(Questions::default());
            }
            if due <= Instant::now() && !self.queue.is_busy() {
                let now = Instant::now();
                changed |= self.resize(page) | page.advance(now - last) | !self.screen.is_current();
                let bytes = if changed { self.frame(page)? } else { 0 };
                changed = self.count(bytes, page);
                (last, due) = (now, self.governor.due());
                if let (false, Some(rest)) = (changed, page.rest()) {
                    due = due.max(now + rest);
                }
            }
            self.send()?;
            if page.is_done() && !changed && !self.queue.is_busy() {
                return Ok(Ending::Quit);
            }

            let ready = self.wait(due)?;
            if ready.hung_up || ready.input && !self.events.read(self.terminal)? {
                return Ok(Ending::HungUp);
            }
        }
    }

    /// Sets up the terminal, and assumes nothing about its contents.
    fn enter(&mut self) -> io::Result<()> {
        self.queue.clear();
        self.terminal.enter(&mut self.queue)?;
        self.events.expect(TerminalMode::Focus, true);
        self.governor.watched = true;
        self.screen.forget();
        Ok(())
    }

    /// Asks the terminal, before the first frame, which does not wait for the answers.
    fn ask(&mut self, asks: Questions) -> io::Result<()> {
        self.queue.write_all(&asks.bytes())?;
        self.events.expect_answers(asks);
        self.asked = asks.any().then(Instant::now);
        Ok(())
    }

    /// Waits for the answer to a question that has only just been asked, so that it does not become typed text after
    /// the end.
    fn hear_out(&mut self) -> io::Result<()> {
        let Some(end) = self.asked.map(|asked| asked + LAST_WORD) else { return Ok(()) };
        while self.events.awaits_answer() && self.signals.take().fatal.is_none() {
            let left = end.saturating_duration_since(Instant::now());
            let ready = self.terminal.wait(self.signals.wake(), self.queue.is_busy(), left)?;
            if left.is_zero() || ready.hung_up || ready.input && !self.events.read(self.terminal)? {
                break;
            }
            self.send()?;
        }
        Ok(())
    }

    /// Switches a mode, and accepts or ignores its reports from now on.
    fn switch(&mut self, mode: TerminalMode, on: bool) -> io::Result<()> {
        self.terminal.switch(mode, on, &mut self.queue)?;
        self.events.expect(mode, on);
        Ok(())
    }

    /// Whether an event is meant for the page; mouse events outside the window are not. Input implies that the
    /// window is being watched, even if the terminal has not reported so.
    fn admits(&mut self, event: &Event) -> bool {
        match event {
            Event::FocusLost => self.governor.watched = false,
            Event::FocusGained | Event::Key(_) | Event::Paste(_) => self.governor.watched = true,
            Event::Mouse(mouse) => {
                let size = self.size.unwrap_or_default();
                return mouse.column < size.width && mouse.row < size.height;
            }
            Event::Resize(..) => {}
        }
        true
    }

    /// Releases the terminal until the program is resumed.
    fn suspend(&mut self) -> io::Result<()> {
        self.terminal.leave();
        self.signals.stop()?;
        // A program ending in the background must not touch the terminal, or it is stopped again.
        if self.signals.is_fatal() { Ok(()) } else { self.enter() }
    }

    /// Reports a new size to the page. The size is queried every time, so that a burst of resizes cannot get ahead
    /// of it.
    fn resize(&mut self, page: &mut impl Screen) -> bool {
        let size = Terminal::size();
        let changed = self.size.replace(size) != Some(size);
        if changed {
            page.input(Event::Resize(size.width, size.height));
        }
        changed
    }

    /// Draws, and queues the changes. Returns the number of bytes.
    fn frame(&mut self, page: &mut impl Screen) -> io::Result<usize> {
        let size = self.size.unwrap_or_default();
        self.switch(TerminalMode::Paste, page.is_typing())?;
        self.switch(TerminalMode::Mouse, self.mouse)?;
        self.switch(TerminalMode::Keyboard, self.keyboard)?;
        let draw = |area, buffer: &mut Buffer| page.draw(area, buffer);
        let frame = self.screen.next_with(size, self.governor.most(), draw)?;
        self.queue.write_all(&frame)?;
        self.switch(TerminalMode::HiddenCursor, self.screen.cursor().is_none())?;
        Ok(frame.len())
    }

    /// Accounts for the bytes of a frame. Returns whether the level of detail changed, so that the next frame must
    /// be drawn.
    fn count(&mut self, bytes: usize, page: &mut impl Screen) -> bool {
        let before = self.governor.detail();
        self.governor.sent(bytes, Instant::now());
        let detail = self.governor.detail();
        if detail != before {
            page.reduce(detail);
        }
        detail != before
    }

    /// Sends what the terminal accepts. After a failed write, the terminal is set up and painted again.
    fn send(&mut self) -> io::Result<()> {
        match self.queue.send(|bytes| self.terminal.write(bytes)) {
            Ok(()) => self.failed_frames = 0,
            Err(error) if self.failed_frames == MOST_FAILED_FRAMES => return Err(error),
            Err(_) => {
                self.failed_frames += 1;
                self.enter()?;
            }
        }
        Ok(())
    }

    /// Waits for input, a signal, room for output or the next frame.
    fn wait(&self, due: Instant) -> io::Result<Readiness> {
        let busy = self.queue.is_busy();
        let now = Instant::now();
        let frame = Some(due).filter(|_| !busy);
        let times = [frame, self.events.deadline(), Some(now + Duration::from_secs(1))];
        let next = times.into_iter().flatten().min().unwrap_or(now);
        let time = next.saturating_duration_since(now);
        self.terminal.wait(self.signals.wake(), busy, time)
    }
}
