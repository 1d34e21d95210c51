//! The demo: performs a script on the terminal from start to end, for the user to watch.
//!
//! In: a [`ScriptRunner`], time, a few keys. Out: the laboratory's own screen, in the size and the colours of this
//! terminal.
//! It ends by itself, so that a program that records terminals can record it. Never here: the contents of a script.

use std::time::Duration;

use crossterm::event::{Event, KeyCode, KeyEvent, KeyModifiers};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use super::frame_loop::{Screen, ScreenRequest};
use super::screen_style::ScreenStyle;
use crate::diagnostic::Diagnostic;
use crate::record::ScriptRunner;
use crate::view::colour::Rgb;
use crate::view::{Detail, RenderStyle};

/// The maximum time that one frame advances. If the terminal or the machine cannot keep up, the demo slows down, so
/// that nothing is skipped.
const LONGEST: Duration = Duration::from_secs(1);

/// A script being performed on the terminal.
pub(super) struct Demo {
    runner: ScriptRunner,
    style: ScreenStyle,
    /// The time since the start, without pauses.
    time: Duration,
    paused: bool,
    /// How it ended, by itself or by the user; an error if the script is wrong.
    end: Option<Result<(), Diagnostic>>,
}

impl Demo {
    pub(super) fn new(runner: ScriptRunner, style: RenderStyle) -> Self {
        let style = ScreenStyle::new(style);
        Self { runner, style, time: Duration::ZERO, paused: false, end: None }
    }

    /// Returns the last picture of a demo that was not ended by the user, or what is wrong with the script.
    pub(super) fn outcome(self) -> Result<Option<Buffer>, Diagnostic> {
        let Self { runner, style, end, .. } = self;
        Ok(end.transpose()?.map(|()| runner.picture(style.full())))
    }
}

impl Screen for Demo {
    fn input(&mut self, event: Event) -> ScreenRequest {
        let Event::Key(KeyEvent { code, modifiers, .. }) = event else {
            return ScreenRequest::Nothing;
        };
        match (code, modifiers.contains(KeyModifiers::CONTROL)) {
            (KeyCode::Char('c'), true) => ScreenRequest::Quit,
            (KeyCode::Char('z'), true) => ScreenRequest::Suspend,
            (KeyCode::Char('l'), true) => ScreenRequest::Repaint,
            (KeyCode::Char('q') | KeyCode::Esc, _) => ScreenRequest::Quit,
            (KeyCode::Char(' '), _) => {
                self.paused = !self.paused;
                self.runner.suspend(self.paused);
                ScreenRequest::Nothing
            }
            _ => ScreenRequest::Nothing,
        }
    }

    fn advance(&mut self, elapsed: Duration) -> bool {
        if self.paused || self.end.is_some() {
            return false;
        }
        self.time += elapsed.min(LONGEST);
        let before = self.runner.now();
        match self.runner.continue_to(self.time.as_micros() as u64) {
            Ok(true) => {}
            Ok(false) => self.end = Some(Ok(())),
            Err(diagnostic) => self.end = Some(Err(diagnostic)),
        }
        before == 0 || self.runner.now() != before
    }

    fn draw(&mut self, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        self.runner.draw(self.style.drawn(), area, buffer);
        // A demo shows no blinking cursor.
        None
    }

    fn is_typing(&self) -> bool {
        false
    }

    fn is_done(&self) -> bool {
        self.end.is_some()
    }

    fn reduce(&mut self, detail: Detail) {
        self.style.reduce(detail);
    }

    fn background(&mut self, colour: Rgb) {
        self.style.suit(colour);
    }
}
