//! Events, one by one.
//!
//! In: an event. Out: the changed state and the effects. Never here: what the single actions do.

use std::sync::Arc;

use super::editor::beginning;
use super::field::{edit, paste};
use super::keymap::{self, Place};
use super::{App, Code, Effect, Event, Key, Lab, LoadError, Loaded, Notification, Overlay, Page};
use crate::experiment::Snapshot;

/// The most that is taken of one paste, in bytes.
pub const LONGEST_PASTE: usize = 256 * 1024;

/// Told where the editor has no room for all of a paste.
const LONG_TEXT: &str = "The pasted text was too long; as much of its beginning was taken as a \
                         paste (256 KiB) and a file (1 MiB) can hold.";

impl App {
    /// Takes an event in, and says what is to be done about it.
    pub fn update(&mut self, event: Event) -> Vec<Effect> {
        match event {
            Event::Key(key) => self.press(key),
            Event::Paste(text) => self.paste(&text),
            Event::Mouse(act, spot) => self.point(act, spot),
            Event::Resize(..) | Event::Focus(_) => Vec::new(),
            Event::Snapshot(snapshot) => self.see(&snapshot),
            Event::Loaded(Ok(loaded)) => self.loaded(loaded),
            Event::Loaded(Err(failure)) => self.failed(failure),
            Event::Rebuilt(loaded) => self.rebuilt(loaded),
            Event::Written(Ok(sentence)) => {
                self.notice = Some(Notification::info(sentence));
                Vec::new()
            }
            Event::Written(Err(sentence)) => self.notify(sentence),
            Event::Tick(elapsed) => {
                self.meter.tick(elapsed);
                self.reading.tick(elapsed);
                self.notifications.tick(&mut self.notice, elapsed);
                if let Some(lab) = &mut self.lab {
                    lab.tick(elapsed);
                }
                let preview = self.picker.tick(elapsed).map(|name| self.ask(name, false));
                preview.into_iter().chain(self.tick_buffer(elapsed)).collect()
            }
            Event::Checked(checked) => self.checked(*checked),
            Event::FileSaved(outcome) => {
                self.saved_file(outcome);
                Vec::new()
            }
            Event::FileRead { text, asked } => {
                self.changed_on_disk(&text, asked);
                Vec::new()
            }
            Event::FileThere(there) => {
                self.found_on_disk(there);
                Vec::new()
            }
            Event::Drawn(drawn) => {
                self.drawn = drawn;
                self.follow_cursor();
                self.scroll = self.scroll.min(drawn.beyond);
                Vec::new()
            }
        }
    }

    /// Asks for a system, to be opened in the lab at once or only previewed.
    pub(super) fn ask(&mut self, name: String, open: bool) -> Effect {
        self.asked = Some((name.clone(), open));
        Effect::Load(name)
    }

    fn press(&mut self, key: Key) -> Vec<Effect> {
        self.drop_hold();
        let places = self.places();
        if let Some(action) = keymap::action(key, places) {
            let effects = self.perform(action);
            self.expect(&effects);
            return effects;
        }
        // Over a slow line Esc and the next key arrive together, and look like one key with Alt.
        if key.alt && !self.is_typing() {
            let mut effects = self.press(Key::plain(Code::Esc));
            effects.extend(self.press(Key { alt: false, ..key }));
            return effects;
        }
        let searching = places.contains(&Place::Search)
            || (places.contains(&Place::Picker) && begins_search(key));
        match &mut self.overlay {
            Some(Overlay::Workbench) => self.type_into_buffer(key),
            Some(Overlay::Field(field)) => field.press(key),
            Some(Overlay::Prompt(prompt)) => prompt.press(key),
            Some(Overlay::Menu(menu)) => {
                let changed = menu.filter.as_mut().is_some_and(|filter| edit(filter, key));
                menu.selected = if changed { 0 } else { menu.selected };
            }
            Some(Overlay::Help { .. } | Overlay::Message(_)) => {}
            None if searching => {
                self.picker.search(|input| {
                    edit(input, key);
                });
            }
            None => {}
        }
        Vec::new()
    }

    fn paste(&mut self, text: &str) -> Vec<Effect> {
        let all = text.len();
        let text = beginning(text, LONGEST_PASTE);
        let whole = match &mut self.overlay {
            Some(Overlay::Workbench) => self.paste_into_buffer(text),
            Some(Overlay::Field(field)) => field.paste(text),
            Some(Overlay::Prompt(prompt)) => paste(&mut prompt.input, text),
            Some(Overlay::Menu(menu)) => {
                menu.selected = 0;
                menu.filter.as_mut().is_none_or(|filter| paste(filter, text))
            }
            None if self.picker.search.is_some() && self.page == Page::Picker => {
                let mut whole = true;
                self.picker.search(|input| whole = paste(input, text));
                whole
            }
            _ => return Vec::new(),
        };
        if !whole || text.len() < all {
            self.notice = Some(Notification::error(match self.overlay {
                Some(Overlay::Workbench) => LONG_TEXT,
                _ => "The pasted text was too long; its beginning was taken.",
            }));
        }
        Vec::new()
    }

    fn see(&mut self, snapshot: &Arc<Snapshot>) -> Vec<Effect> {
        let Some(lab) = &mut self.lab else { return Vec::new() };
        let before = lab.snapshot.as_ref().map(|s| Arc::clone(&s.notices)).unwrap_or_default();
        let steps = snapshot.method.steps;
        if lab.see(Arc::clone(snapshot)) {
            self.meter.count(steps);
            self.reading.see(snapshot);
            for sentence in notifications(&before, &snapshot.notices) {
                self.notifications.tell(&mut self.notice, Notification::info(sentence.clone()));
            }
        }
        Vec::new()
    }

    pub(super) fn loaded(&mut self, loaded: Loaded) -> Vec<Effect> {
        let answered = self.answered(&loaded.name);
        self.drop_hold();
        let stale = self.workbench.put_off().then_some(Effect::StopCheck);
        self.workbench.clear();
        self.overlay.take_if(|overlay| matches!(overlay, Overlay::Workbench));
        self.lab = Some(Lab::new(loaded));
        // What went wrong is not less so because something else is there.
        self.notice.take_if(|notice| !notice.error);
        self.notifications.clear();
        self.meter.forget();
        self.picker.failure = None;
        if answered == Some(true) {
            self.go(Page::Lab);
        }
        let mut effects = self.begin(answered == Some(true));
        effects.extend(stale);
        effects
    }

    /// The system whose file is told to be wrong.
    pub fn failed_system(&self) -> Option<&str> {
        match &self.overlay {
            Some(Overlay::Message(failure)) => Some(&failure.name),
            _ => None,
        }
    }

    /// Asks for that system anew: its file has changed.
    pub fn again(&mut self) -> Vec<Effect> {
        let name = self.failed_system().map(str::to_owned);
        name.map(|name| self.ask(name, true)).into_iter().collect()
    }

    fn failed(&mut self, failure: LoadError) -> Vec<Effect> {
        if self.answered(&failure.name) == Some(true) {
            self.scroll = 0;
            self.overlay = Some(Overlay::Message(failure.clone()));
        }
        self.picker.failure = Some(failure);
        Vec::new()
    }

    /// What was asked for is there, or is not: whether it was to be opened, if this is what was asked for last.
    fn answered(&mut self, name: &str) -> Option<bool> {
        let (_, open) = self.asked.take_if(|(asked, _)| asked == name)?;
        Some(open)
    }

    /// Shows a page from its beginning.
    pub(super) fn go(&mut self, page: Page) {
        if page == Page::Picker {
            self.left = self.saved();
            // what was reported of the motion that is left says nothing of another
            self.notice = None;
            self.notifications.clear();
        }
        (self.page, self.overlay, self.scroll) = (page, None, 0);
        if page == Page::Plain {
            self.read();
        }
    }
}

/// The sentences of `now` that came after those of `before`; old ones may have gone at the front.
fn notifications<'a>(before: &[String], now: &'a [String]) -> &'a [String] {
    let mut known = (0..=before.len().min(now.len())).rev();
    &now[known.find(|count| before.ends_with(&now[..*count])).unwrap_or(0)..]
}

/// In the list of systems any letter that is no key begins a search.
fn begins_search(key: Key) -> bool {
    matches!(key.code, Code::Char(c) if c.is_alphanumeric()) && !key.ctrl && !key.alt
}
