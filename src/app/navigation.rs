//! Ways through the program: the help and back out of it, from page to page, and along what a page lists.
//!
//! In: directions. Out: the page, what lies over it, the line selected. Never here: what an action does to a picture or a value.

use super::keymap::KeyContext;
use super::{
    App, ArrowDirection, Asker, Effect, KeyHints, Notification, Overlay, Page, Pane, Prompt,
};

/// What the first Esc in the lab says, and in a lesson.
const LEAVING: &str = "Esc again for the list of systems.";
const LEAVING_LESSON: &str = "Esc again to leave the lesson.";

impl App {
    pub(super) fn help(&mut self) -> Vec<Effect> {
        match &mut self.overlay {
            Some(Overlay::Help { search, typing, .. }) => {
                (*search, *typing) = (None, false);
                return self.back();
            }
            _ => {
                // what was said before is not said of the help
                self.notifications.dismiss();
                let below = self.overlay.take().map(Box::new);
                let scroll = self.text.scroll;
                self.overlay = Some(Overlay::Help { scroll, below, search: None, typing: false });
            }
        }
        self.text.scroll = 0;
        Vec::new()
    }

    pub(super) fn back(&mut self) -> Vec<Effect> {
        if matches!(self.overlay, Some(Overlay::Workbench)) {
            return self.leave_buffer();
        }
        match self.overlay.take() {
            Some(Overlay::Help { scroll, below, search: Some(_), .. }) => {
                // The first Esc shows all keys again.
                self.overlay = Some(Overlay::Help { scroll, below, search: None, typing: false });
                self.text.scroll = 0;
                return Vec::new();
            }
            Some(Overlay::Help { scroll, below, .. }) => {
                self.text.scroll = scroll;
                self.overlay = below.map(|below| *below);
                return Vec::new();
            }
            Some(Overlay::Prompt(Prompt { under_way: Some(_), .. })) => {
                return vec![Effect::StopComputing(Asker::Prompt)];
            }
            Some(
                Overlay::Message(_) | Overlay::Menu(_) | Overlay::Field(_) | Overlay::Prompt(_),
            ) => {
                return Vec::new();
            }
            Some(Overlay::Workbench) | None => {}
        }
        if let Some(request) = self.awaited.system.take_if(|_| self.page == Page::Picker) {
            self.awaited.session = None;
            self.notifications
                .show(Notification::info(format!("Loading {} was cancelled.", request.name)));
            return vec![Effect::StopLoading];
        }
        if self.end_page_search() {
            return Vec::new();
        }
        let leaves = self.asked_to_leave();
        if self.page == Page::Equations && self.stop_search() {
            self.notifications.show(Notification::info("The search was stopped; I restarts it."));
            return vec![Effect::StopComputing(Asker::Search)];
        }
        match (self.page, &mut self.lab) {
            (Page::Picker, _) => self.picker.forget_search(),
            (Page::Lab, Some(lab)) if lab.focus.zoomed => lab.focus.zoomed = false,
            (Page::Lab, Some(_)) if !leaves => {
                let lesson = self.footer.hints == KeyHints::LabInLesson;
                let sentence = if lesson { LEAVING_LESSON } else { LEAVING };
                self.notifications.show(Notification::info(sentence));
                return Vec::new();
            }
            (Page::Lab, _) | (_, None) => {
                self.notifications.dismiss();
                if let Some(lab) = &self.lab {
                    self.picker.select(&lab.loaded.name);
                }
                self.go(Page::Picker);
            }
            (Page::Equations | Page::Notes | Page::Numbers | Page::Plain, Some(_)) => {
                self.go(Page::Lab);
            }
        }
        Vec::new()
    }

    /// Whether something lies over the page that the key for quitting closes.
    pub fn closes_with_quit(&self) -> bool {
        matches!(self.overlay, Some(Overlay::Help { .. } | Overlay::Message(_) | Overlay::Menu(_)))
    }

    /// Whether the last Esc has asked for another one, which leaves the lab.
    pub(super) fn asked_to_leave(&self) -> bool {
        self.notifications
            .shown
            .as_ref()
            .is_some_and(|notice| [LEAVING, LEAVING_LESSON].contains(&&*notice.text))
    }

    pub(super) fn shift(&mut self, way: ArrowDirection) -> Vec<Effect> {
        match way {
            ArrowDirection::Up => return self.jump(-1),
            ArrowDirection::Down => return self.jump(1),
            ArrowDirection::Left | ArrowDirection::Right => {}
        }
        self.with_plot(|plot, _| plot.shift(way.step()))
    }

    /// Moves by lines in whatever is scrolled or selected, or vertically in a plot.
    pub(super) fn jump(&mut self, by: isize) -> Vec<Effect> {
        match &mut self.overlay {
            Some(Overlay::Menu(menu)) => menu.step(by),
            Some(Overlay::Field(_) | Overlay::Prompt(_) | Overlay::Workbench) => {}
            Some(Overlay::Help { .. } | Overlay::Message(_)) => self.roll(by),
            None => match (self.page, &mut self.lab) {
                (Page::Picker, _) | (_, None) => self.picker.step(by),
                (Page::Lab, Some(lab)) if lab.focus.pane == Pane::Law => lab.roll_law(by),
                (Page::Lab, Some(lab)) => {
                    if let Pane::Plot(_) = lab.focus.pane {
                        let way = if by < 0 { ArrowDirection::Up } else { ArrowDirection::Down };
                        return self.with_plot(|plot, _| plot.shift(way.step()));
                    }
                    lab.select(|place| place.saturating_add_signed(by));
                }
                (Page::Equations | Page::Notes | Page::Numbers, Some(_)) => self.roll(by),
                (Page::Plain, Some(_)) => {
                    let last = usize::from(self.drawn.beyond + self.drawn.rows).saturating_sub(1);
                    let line = self.reading.line.saturating_add_signed(by);
                    self.reading.line = line.min(last);
                }
            },
        }
        Vec::new()
    }

    fn roll(&mut self, by: isize) {
        self.text.section = None;
        if let Some(search) = &mut self.text.search {
            search.seeks = false;
        }
        let rows = usize::from(self.text.scroll).saturating_add_signed(by);
        self.text.scroll = rows.min(usize::from(self.drawn.beyond)) as u16;
    }

    /// Returns the number of lines that a page up or down moves.
    pub(super) fn screenful(&self) -> isize {
        let contexts = self.key_contexts();
        let pages = [KeyContext::Text, KeyContext::HelpSearch, KeyContext::Plain];
        let text = pages.iter().any(|context| contexts.contains(context));
        if text { isize::from(self.drawn.rows.saturating_sub(2).max(1) as i16) } else { 10 }
    }
}
