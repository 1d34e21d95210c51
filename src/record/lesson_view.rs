//! Looking around while a lesson speaks or asks: other panes and pages, while motion and lesson stand still.
//!
//! In: a key. Out: another view of the lab, and the view of before once the lesson continues. Never here: the keys of
//! the lesson.

use crossterm::event::{KeyCode, KeyEvent};

use super::headless_lab::HeadlessLab;
use crate::app::{AppEvent, Focus, Page};

/// What was seen before somebody looked around.
#[derive(Clone)]
pub(super) struct LessonView {
    page: Page,
    focus: Focus,
}

impl LessonView {
    /// Handles a key that only changes what is seen, and keeps the first view of all in `before`. Returns whether it is
    /// one.
    pub(super) fn handle_key(
        before: &mut Option<LessonView>,
        host: &mut HeadlessLab,
        key: KeyEvent,
    ) -> bool {
        let app = &host.app;
        let page_scrolls = app.page != Page::Lab;
        let changes_view = match key.code {
            KeyCode::Tab | KeyCode::BackTab | KeyCode::Char('\\' | '1'..='4' | '9') => true,
            KeyCode::PageUp | KeyCode::PageDown => page_scrolls,
            _ => false,
        };
        let Some(lab) = app.lab.as_ref().filter(|_| changes_view) else { return false };
        before.get_or_insert_with(|| LessonView { page: app.page, focus: lab.focus.clone() });
        // the focus is the lesson's: Tab leads to what is hidden
        match (key.code, &mut host.app.lab) {
            (KeyCode::Tab | KeyCode::BackTab, Some(lab)) => {
                lab.show_hidden(key.code == KeyCode::Tab);
            }
            _ => host.update(AppEvent::Key(key)),
        }
        true
    }

    /// Returns to what was seen before somebody looked around, so that what follows does not depend on it.
    pub(super) fn restore(self, host: &mut HeadlessLab) {
        host.app.page = self.page;
        if let Some(lab) = &mut host.app.lab {
            lab.focus = self.focus;
        }
    }
}
