//! The handling of events, one at a time.
//!
//! In: an event. Out: the changed state and the effects. Never here: what the individual actions do.

use std::sync::Arc;
use std::time::Duration;

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

use super::editor::beginning;
use super::field::{edit, paste};
use super::key::{self, pressed};
use super::keymap::{self, KeyContext};
use super::pending::{AwaitedPlots, LoadRequest};
use super::{
    App, AppEvent, Effect, Lab, LoadError, Loaded, Notification, Overlay, Page, Pane, TextInView,
};
use crate::experiment::{Command, Snapshot};

/// The maximum size of one paste, in bytes.
pub const LONGEST_PASTE: usize = 256 * 1024;

/// Shown if the editor has no room for all of a paste.
const LONG_TEXT: &str =
    "The pasted text was too long and was cut: a paste may be 256 KiB at most, a file 1 MiB.";

impl App {
    /// Handles an event, and returns the effects to perform.
    pub fn update(&mut self, event: AppEvent) -> Vec<Effect> {
        let shown = self.notifications.shown.clone();
        let mut effects = self.handle(event);
        if std::mem::take(&mut self.mouse.resumes) {
            effects.insert(0, Effect::Execute(Command::Play));
        }
        self.forget_past_motion(shown.as_ref(), &effects);
        self.request_jobs(&mut effects);
        if self.page == Page::Picker {
            self.list_unsaved();
        }
        if let Some(lab) = &mut self.lab
            && let Pane::Plot(index) = lab.focus.pane
        {
            lab.focus.bring_to_front(index);
        }
        effects
    }

    /// Clears the notifications about the previous motion where the effects begin another one. What has only just been said
    /// is about the new one.
    pub(super) fn forget_past_motion(&mut self, before: Option<&Notification>, effects: &[Effect]) {
        let begins = |effect: &Effect| matches!(effect, Effect::Execute(command) if command.begins_another_motion());
        if effects.iter().any(begins) {
            self.notifications.shown.take_if(|notice| Some(&*notice) == before);
            self.notifications.clear_waiting();
            // a motion that waits for a law gives way to the one that is begun
            if let Some(lab) = &mut self.lab {
                lab.restoration.forget_rebuild();
            }
        }
    }

    /// Lets notifications expire. Returns whether another one is shown.
    pub fn tick_notifications(&mut self, elapsed: Duration) -> bool {
        self.notifications.tick(elapsed)
    }

    pub(super) fn handle(&mut self, event: AppEvent) -> Vec<Effect> {
        match event {
            AppEvent::Key(key) => pressed(key).map_or_else(Vec::new, |key| self.press(key)),
            AppEvent::Paste(text) => self.paste(&text),
            AppEvent::Mouse(kind, hit) => self.point(kind, hit),
            AppEvent::Resize(..) | AppEvent::Focus(_) => Vec::new(),
            AppEvent::Snapshot(snapshot) => self.see(&snapshot),
            AppEvent::Loaded(Ok(loaded)) => self.loaded(loaded),
            AppEvent::Loaded(Err(error)) => self.failed(error),
            AppEvent::Written(Ok(sentence)) => {
                self.notifications.show(Notification::info(sentence));
                Vec::new()
            }
            AppEvent::Written(Err(sentence)) => self.fail(sentence),
            AppEvent::Tick(elapsed) => {
                self.meter.tick(elapsed);
                self.reading.tick(elapsed);
                self.tick_notifications(elapsed);
                if let Some(lab) = &mut self.lab {
                    lab.tick(elapsed);
                }
                if let Some(Overlay::Prompt(prompt)) = &mut self.overlay {
                    prompt.tick(elapsed);
                }
                let preview = self.picker.tick(elapsed).map(|name| self.ask(name, false));
                preview.into_iter().chain(self.tick_buffer(elapsed)).collect()
            }
            AppEvent::Checked(checked) => self.checked(*checked),
            AppEvent::FileSaved(outcome) => {
                self.saved_file(outcome);
                Vec::new()
            }
            AppEvent::FileRead { text, asked } => {
                match self
                    .awaited
                    .wrong_file
                    .clone()
                    .filter(|_| asked && self.open_buffer().is_none())
                {
                    Some(name) => self.edit_wrong(name, &text),
                    None => self.changed_on_disk(&text, asked),
                }
                Vec::new()
            }
            AppEvent::Computed { ticket, outcome } => self.computed(ticket, outcome),
            AppEvent::Progress { ticket, share } => {
                self.progressed(ticket, share);
                Vec::new()
            }
            AppEvent::GuideLeft { guides, wrong } => self.guide_left(guides, wrong),
            AppEvent::FileThere(there) => {
                self.found_on_disk(there);
                Vec::new()
            }
            AppEvent::Drawn(drawn) => {
                self.drawn = drawn;
                self.fix_cursor();
                if let (Some(panes), Some(lab)) = (self.drawn.panes.clone(), &mut self.lab) {
                    lab.take_drawn(panes);
                }
                self.follow_cursor();
                self.text.scroll =
                    self.drawn.scroll.unwrap_or(self.text.scroll).min(self.drawn.beyond);
                Vec::new()
            }
        }
    }

    /// Requests a system, to be opened in the lab or only previewed.
    pub(super) fn ask(&mut self, name: String, open: bool) -> Effect {
        self.awaited.system = Some(LoadRequest { name: name.clone(), opens: open });
        Effect::Load(name)
    }

    fn press(&mut self, key: KeyEvent) -> Vec<Effect> {
        self.end_group();
        self.awaited.wrong_file = None;
        if let Some(lab) = self.lab.as_mut().filter(|_| self.page != Page::Picker) {
            lab.focus.untouched = false;
        }
        let contexts = self.key_contexts();
        if let Some(action) = keymap::action(key, contexts) {
            let effects = self.handle_action(action);
            self.expect(&effects);
            return effects;
        }
        // Over a slow connection Esc and the next key may arrive together, and look like one key with Alt.
        if key.modifiers.contains(KeyModifiers::ALT) && !self.is_typing() {
            let mut effects = self.press(KeyCode::Esc.into());
            let modifiers = key.modifiers - KeyModifiers::ALT;
            effects.extend(self.press(KeyEvent { modifiers, ..key }));
            return effects;
        }
        let searching = contexts.contains(&KeyContext::Search)
            || (contexts.contains(&KeyContext::Picker) && begins_search(key));
        if let Some(search) = self.typed_search() {
            if edit(&mut search.input, key) {
                search.begin();
            }
            return Vec::new();
        }
        match &mut self.overlay {
            Some(Overlay::Workbench) => self.type_into_buffer(key),
            Some(Overlay::Field(field)) => field.press(key),
            Some(Overlay::Prompt(prompt)) => prompt.press(key),
            Some(Overlay::Menu(menu)) => {
                let changed = menu.filter.as_mut().is_some_and(|filter| edit(filter, key));
                menu.selected = if changed { 0 } else { menu.selected };
            }
            Some(Overlay::Help { search: Some(search), typing: true, .. }) => {
                if edit(search, key) {
                    self.text.scroll = 0;
                }
            }
            Some(Overlay::Help { .. } | Overlay::Message(_)) => return self.unknown(key),
            None if searching => {
                self.picker.search(|input| {
                    edit(input, key);
                });
            }
            None => return self.unknown(key),
        }
        Vec::new()
    }

    /// Notifies the user that a key has no effect here.
    fn unknown(&mut self, key: KeyEvent) -> Vec<Effect> {
        match key.code {
            KeyCode::Char(_) | KeyCode::F(_) => {
                self.notify(format!("{} does nothing here; ? shows the keys.", key::name(&key)))
            }
            _ => Vec::new(),
        }
    }

    fn paste(&mut self, text: &str) -> Vec<Effect> {
        let all = text.len();
        let text = beginning(text, LONGEST_PASTE);
        if let Some(search) = self.typed_search() {
            search.begin();
            paste(&mut search.input, text);
            return Vec::new();
        }
        let whole = match &mut self.overlay {
            Some(Overlay::Workbench) => self.paste_into_buffer(text),
            Some(Overlay::Field(field)) => field.paste(text),
            Some(Overlay::Prompt(prompt)) => paste(&mut prompt.input, text),
            Some(Overlay::Help { search: Some(search), typing: true, .. }) => {
                self.text.scroll = 0;
                paste(search, text)
            }
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
            self.notifications.show(Notification::error(match self.overlay {
                Some(Overlay::Workbench) => LONG_TEXT,
                _ => "The pasted text was too long; only its beginning was inserted.",
            }));
        }
        Vec::new()
    }

    fn see(&mut self, snapshot: &Arc<Snapshot>) -> Vec<Effect> {
        let Some(lab) = &mut self.lab else { return Vec::new() };
        let before = lab.snapshot.as_ref().map(|s| Arc::clone(&s.notices)).unwrap_or_default();
        let steps = snapshot.method.steps;
        if lab.see(snapshot) {
            self.meter.count(steps);
            self.reading.see(snapshot);
            for sentence in notifications(&before, &snapshot.notices) {
                self.notifications.add(Notification::info(sentence.clone()));
            }
            let counts = snapshot.occurrences.counts().iter().filter(|count| count.count > 1);
            let repeated = counts.map(|count| count.name.as_str());
            self.notifications.outdate(repeated);
        }
        Vec::new()
    }

    pub(super) fn loaded(&mut self, loaded: Loaded) -> Vec<Effect> {
        let answered = self.answered(&loaded.name);
        self.end_group();
        // a motion that was dragged is no longer there
        self.mouse.resumes = false;
        let stale = self.workbench.postpone_check().then_some(Effect::StopCheck);
        self.workbench.clear();
        self.overlay.take_if(|overlay| matches!(overlay, Overlay::Workbench));
        self.awaited.plots = AwaitedPlots::default();
        self.awaited.view = None;
        let warning = loaded.warning();
        self.lab = Some(Lab::new(loaded));
        // An error message stays valid when something else is loaded.
        self.notifications.shown.take_if(|notice| !notice.is_error());
        self.notifications.clear_waiting();
        if let Some(warning) = warning {
            self.notifications.add(Notification::warning(warning));
        }
        self.meter.forget();
        self.picker.error = None;
        if answered == Some(true) {
            self.go(Page::Lab);
        }
        let mut effects = self.begin(answered == Some(true));
        effects.extend(stale);
        effects
    }

    /// Returns the system whose file is reported to be wrong.
    pub fn failed_system(&self) -> Option<&str> {
        match &self.overlay {
            Some(Overlay::Message(error)) => Some(&error.name),
            _ => None,
        }
    }

    /// Requests that system again, since its file has changed.
    pub fn again(&mut self) -> Vec<Effect> {
        let name = self.failed_system().map(str::to_owned);
        name.map(|name| self.ask(name, true)).into_iter().collect()
    }

    fn failed(&mut self, error: LoadError) -> Vec<Effect> {
        if self.answered(&error.name) == Some(true) {
            self.text.scroll = 0;
            self.overlay = Some(Overlay::Message(error.clone()));
        }
        self.picker.error = Some(error);
        Vec::new()
    }

    /// Handles the answer to a request. Returns whether it is to be opened, if it is the latest request.
    fn answered(&mut self, name: &str) -> Option<bool> {
        self.awaited.system.take_if(|request| request.name == name).map(|request| request.opens)
    }

    pub(super) fn go(&mut self, page: Page) {
        if page == Page::Picker {
            self.left = self.saved();
            if let Some(left) = &self.left {
                self.picker.offer(left.clone(), false);
            }
            // Notifications about the motion being left do not apply to another.
            self.notifications.dismiss();
            self.notifications.clear_waiting();
        }
        (self.page, self.overlay, self.text) = (page, None, TextInView::default());
        if page == Page::Plain {
            self.read();
        }
    }
}

/// Returns the sentences of `now` that came after those of `before`: old ones may have been dropped at the front, or the
/// last one replaced by what is newer on the same subject.
fn notifications<'a>(before: &[String], now: &'a [String]) -> &'a [String] {
    let mut known = (0..=before.len().min(now.len())).rev();
    let dropped = known.find(|count| before.ends_with(&now[..*count])).unwrap_or(0);
    let shared = before.iter().zip(now).take_while(|(before, now)| before == now).count();
    let replaced = if shared + 1 == before.len() { shared } else { 0 };
    &now[dropped.max(replaced)..]
}

/// Whether a key starts a search; in the list of systems, any letter without a binding does.
fn begins_search(key: KeyEvent) -> bool {
    let pressed = key.modifiers.intersects(KeyModifiers::CONTROL | KeyModifiers::ALT);
    matches!(key.code, KeyCode::Char(c) if c.is_alphanumeric()) && !pressed
}
