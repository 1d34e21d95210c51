//! The lesson on the terminal: its time, its keys, its picture.
//!
//! In: a [`Lesson`], events, time. Out: its picture, and what is wrong with its script. Never here: what a lesson says, or
//! the file of its progress.

use std::borrow::BorrowMut;
use std::time::Duration;

use crossterm::event::{Event, KeyCode, KeyEventKind, KeyModifiers};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use super::frame_loop::{Screen, ScreenRequest};
use super::mouse::with_shift;
use super::screen_style::ScreenStyle;
use crate::diagnostic::Diagnostic;
use crate::record::{Lesson, Pressed};
use crate::view::colour::Rgb;
use crate::view::{Detail, RenderStyle};

/// The maximum time that one frame advances, as for demos.
const LONGEST: Duration = Duration::from_secs(1);

/// A lesson on the terminal, its own or borrowed.
pub(super) struct LessonScreen<L> {
    lesson: L,
    style: ScreenStyle,
    diagnostic: Option<Diagnostic>,
}

impl<L: BorrowMut<Lesson>> LessonScreen<L> {
    /// Creates the screen of a lesson.
    pub(super) fn new(lesson: L, style: RenderStyle) -> Self {
        Self { lesson, style: ScreenStyle::new(style), diagnostic: None }
    }

    /// Returns the lesson, and what is wrong with its script, if anything is.
    pub(super) fn outcome(self) -> (L, Result<(), Diagnostic>) {
        (self.lesson, self.diagnostic.map_or(Ok(()), Err))
    }
}

impl<L: BorrowMut<Lesson>> Screen for LessonScreen<L> {
    fn input(&mut self, event: Event) -> ScreenRequest {
        if let Event::Mouse(mouse) = event {
            let at = [mouse.column, mouse.row];
            self.lesson.borrow_mut().point(with_shift(mouse), self.style.drawn(), at);
            let left = self.lesson.borrow().is_left();
            return if left { ScreenRequest::Quit } else { ScreenRequest::Nothing };
        }
        let Event::Key(key) = event else { return ScreenRequest::Nothing };
        if key.kind == KeyEventKind::Release {
            return ScreenRequest::Nothing;
        }
        match (key.code, key.modifiers.contains(KeyModifiers::CONTROL)) {
            (KeyCode::Char('z'), true) => return ScreenRequest::Suspend,
            (KeyCode::Char('l'), true) => return ScreenRequest::Repaint,
            _ => {}
        }
        match self.lesson.borrow_mut().press(key) {
            Pressed::Leave => ScreenRequest::Quit,
            Pressed::Taken => ScreenRequest::Nothing,
        }
    }

    fn advance(&mut self, elapsed: Duration) -> bool {
        if self.diagnostic.is_some() {
            return false;
        }
        match self.lesson.borrow_mut().advance(elapsed.min(LONGEST).as_micros() as u64) {
            Ok(changed) => changed,
            Err(diagnostic) => {
                self.diagnostic = Some(diagnostic);
                true
            }
        }
    }

    fn draw(&mut self, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        self.lesson.borrow_mut().draw(self.style.drawn(), area, buffer);
        None
    }

    fn is_typing(&self) -> bool {
        self.lesson.borrow().is_typing()
    }

    fn is_done(&self) -> bool {
        self.diagnostic.is_some()
    }

    fn reduce(&mut self, detail: Detail) {
        self.style.reduce(detail);
    }

    fn background(&mut self, colour: Rgb) {
        self.style.suit(colour);
    }
}
