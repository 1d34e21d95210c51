//! Looking around while a lesson speaks or asks: other panes and pages, while motion and lesson stand still.
//!
//! In: a key. Out: another view of the lab, and the view of before once the lesson continues. Never here: the keys of
//! the lesson.

use crossterm::event::{KeyCode, KeyEvent};

use super::lesson::{Lesson, LessonView};
use crate::app::{Event, Page};

impl Lesson {
    /// Handles a key that only changes what is seen. Returns whether it is one.
    pub(super) fn look_around(&mut self, key: KeyEvent) -> bool {
        let app = &mut self.runner.lab.app;
        let page_scrolls = app.page != Page::Lab;
        let looks = match key.code {
            KeyCode::Tab | KeyCode::BackTab | KeyCode::Char('1'..='4' | '9') => true,
            KeyCode::PageUp | KeyCode::PageDown => page_scrolls,
            _ => false,
        };
        let Some(lab) = app.lab.as_ref().filter(|_| looks) else { return false };
        let view = LessonView { page: app.page, focus: lab.focus, front: lab.front };
        self.view.get_or_insert(view);
        self.runner.lab.happen(Event::Key(key));
        true
    }

    /// Returns to what was seen before somebody looked around, so that what follows does not depend on it.
    pub(super) fn look_back(&mut self) {
        let Some(LessonView { page, focus, front }) = self.view.take() else { return };
        let app = &mut self.runner.lab.app;
        app.page = page;
        if let Some(lab) = &mut app.lab {
            (lab.focus, lab.front) = (focus, front);
        }
    }
}
