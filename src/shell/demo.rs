//! The demo: a script performed on the terminal while one watches, from its beginning to its end.
//!
//! In: a [`ScriptRunner`], time, a few keys. Out: the laboratory's own screen, in the size and the colours of this terminal.
//! It ends by itself, so that a program that records terminals can record it. Never here: what a script says.

use std::time::Duration;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use super::frame_loop::{Screen, ScreenRequest};
use super::input::Input;
use crate::app::{Code, Key};
use crate::diagnostic::Diagnostic;
use crate::record::ScriptRunner;
use crate::view::{Detail, RenderStyle};

/// The most that one frame lets pass. Where the terminal or the machine cannot keep up the demo waits for it, so that
/// nothing is missed.
const LONGEST: Duration = Duration::from_secs(1);

/// A script being performed on the terminal.
pub(super) struct Demo {
    performance: ScriptRunner,
    look: RenderStyle,
    detail: Detail,
    /// Since its beginning, without what it was held.
    time: Duration,
    held: bool,
    /// Nothing more comes, or it was left; with what is wrong with the script, if that is why.
    end: Option<Result<(), Diagnostic>>,
}

impl Demo {
    /// At its beginning.
    pub(super) fn new(performance: ScriptRunner, look: RenderStyle) -> Self {
        let (detail, time) = (Detail::default(), Duration::ZERO);
        Self { performance, look, detail, time, held: false, end: None }
    }

    /// The last picture of a demo that was not left before; or what is wrong with the script.
    pub(super) fn outcome(self) -> Result<Option<Buffer>, Diagnostic> {
        let Self { performance, look, end, .. } = self;
        Ok(end.transpose()?.map(|()| performance.picture(&look)))
    }
}

impl Screen for Demo {
    fn input(&mut self, input: Input) -> ScreenRequest {
        match input {
            Input::Key(Key { ctrl: true, code: Code::Char('c'), .. }) => ScreenRequest::Quit,
            Input::Key(Key { ctrl: true, code: Code::Char('z'), .. }) => ScreenRequest::Suspend,
            Input::Key(Key { ctrl: true, code: Code::Char('l'), .. }) => ScreenRequest::Repaint,
            Input::Key(Key { code: Code::Char('q') | Code::Esc, .. }) => ScreenRequest::Quit,
            Input::Key(Key { code: Code::Char(' '), .. }) => {
                self.held = !self.held;
                self.performance.hold(self.held);
                ScreenRequest::Nothing
            }
            _ => ScreenRequest::Nothing,
        }
    }

    fn advance(&mut self, elapsed: Duration) -> bool {
        if self.held || self.end.is_some() {
            return false;
        }
        self.time += elapsed.min(LONGEST);
        let before = self.performance.now();
        match self.performance.go_on(self.time.as_micros() as u64) {
            Ok(true) => {}
            Ok(false) => self.end = Some(Ok(())),
            Err(mistake) => self.end = Some(Err(mistake)),
        }
        before == 0 || self.performance.now() != before
    }

    fn draw(&mut self, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        self.performance.draw(&self.look.reduced(self.detail), area, buffer);
        // no cursor blinks over a demo
        None
    }

    fn is_typing(&self) -> bool {
        false
    }

    fn is_done(&self) -> bool {
        self.end.is_some()
    }

    fn reduce(&mut self, detail: Detail) {
        self.detail = detail;
    }
}
