//! The list of lessons and demos, and the choice of one.
//!
//! In: what the shell found, with how far each lesson was taken. Out: a menu, the effect of a choice. Never here: scripts,
//! files.

use super::{
    App, Choice, Choosing, Effect, Guide, GuideKind, Item, LessonTaken, Menu, Notification, Overlay,
};

impl App {
    /// Returns the lessons that were finished, and how many there are.
    pub fn lessons_finished(&self) -> (usize, usize) {
        let lessons = self.picker.guides.iter().filter_map(|guide| match guide.kind {
            GuideKind::Lesson(taken) => Some(taken),
            GuideKind::Demo => None,
        });
        let finished = lessons.clone().filter(|taken| *taken == LessonTaken::Whole);
        (finished.count(), lessons.count())
    }

    /// Lists the lessons and demos. Selected is the next lesson that is not finished, or the demo that was watched last.
    pub(super) fn open_guides(&mut self) -> Vec<Effect> {
        let item = |(index, guide): (usize, &Guide)| {
            Item::plain(guide.title.clone(), guide.about(), Choice::Guide(index))
        };
        let items: Vec<Item> = self.picker.guides.iter().enumerate().map(item).collect();
        if items.is_empty() {
            return self.notify("There are no lessons or demos.");
        }
        let open = |guide: &Guide| matches!(guide.kind, GuideKind::Lesson(taken) if taken != LessonTaken::Whole);
        let guides = &self.picker.guides;
        // A lesson and a demo may have the same name.
        let last = self.picker.last_guide.filter(|&last| last < guides.len());
        // A lesson that was finished leads to the next one.
        let from = last.unwrap_or(0);
        let next = guides.iter().skip(from).position(open).map(|place| place + from);
        let stays = last.is_some_and(|last| guides[last].kind == GuideKind::Demo);
        let next = if stays { last } else { next.or(last) }.map(Choice::Guide);
        let menu = Menu::new("Lessons and demos", Choosing::Guide, items);
        self.overlay = Some(Overlay::Menu(menu.at(next)));
        Vec::new()
    }

    /// Goes back to the list after a lesson or a demo.
    pub(super) fn guide_left(&mut self, guides: Vec<Guide>, wrong: Option<String>) -> Vec<Effect> {
        self.picker.guides = guides;
        let effects = self.open_guides();
        if let Some(wrong) = wrong {
            self.notifications.show(Notification::error(wrong));
        }
        effects
    }

    pub(super) fn take_guide(&mut self, index: usize) -> Vec<Effect> {
        let Some(guide) = self.picker.guides.get(index) else { return Vec::new() };
        self.picker.last_guide = Some(index);
        vec![Effect::TakeGuide(guide.clone())]
    }
}
