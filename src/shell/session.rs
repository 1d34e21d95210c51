//! The session: the application with everything that does what it asks for.
//!
//! In: inputs and frames from the stage. Out: a drawn screen; commands to the worker, loads to the loader, wishes to
//! the stage. Never here: what a key does, or how anything looks.

use std::io;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::checker::Checker;
use super::files::{self, Watch};
use super::input::Input;
use super::loader::Loader;
use super::product;
use super::request::Request;
use super::stage::{Page, Wish};
use super::store::{NoStore, Store};
use crate::app::{App, Checked, Effect, Event, Loaded, Notice, Saved};
use crate::experiment::{Export, Ready};
use crate::preset::{Catalog, Document, is_path};
use crate::view::{self, Look};
use crate::worker::Worker;

/// The laboratory as it runs.
pub(super) struct Session {
    app: App,
    look: Look,
    worker: Worker,
    loader: Loader,
    checker: Checker,
    /// The system's file, where it is to be watched.
    watch: Option<Watch>,
    store: Option<Store>,
    /// Since the session was last saved.
    unsaved: Duration,
    /// Told once more when the first system is there, for its loading ends what was told before.
    warning: Option<String>,
}

/// How often the session is saved while the laboratory is open.
const SAVING: Duration = Duration::from_secs(15);

impl Session {
    /// The laboratory, opened at a preset or file, or at the picker.
    pub(super) fn new(catalog: Catalog, request: &Request, look: Look) -> io::Result<Self> {
        let (mut app, effects) = App::new(&catalog, request.open.as_deref());
        app.mouse = request.mouse;
        let loader = Loader::new(Arc::new(catalog));
        let (store, unsaved) = (None, Duration::ZERO);
        let watch = request.watch.then(Watch::default);
        let (worker, checker) = (Worker::idle()?, Checker::new());
        let mut session =
            Self { app, look, worker, loader, checker, watch, store, unsaved, warning: None };
        session.perform(effects);
        Ok(session)
    }

    /// Goes on with a session once its system is loaded.
    pub(super) fn resume(&mut self, saved: Saved) {
        self.app.resume(saved);
    }

    /// Keeps the session in a store from now on; where there is none the user is told.
    pub(super) fn keep_in(&mut self, store: Result<Store, NoStore>) {
        match store {
            Ok(store) => self.store = Some(store),
            Err(why) => {
                self.app.notice = Some(Notice::error(why.to_string()));
                self.warning = Some(why.to_string());
            }
        }
    }

    /// Saves the session as it is now.
    pub(super) fn keep(&mut self) -> io::Result<()> {
        self.unsaved = Duration::ZERO;
        if let Some(snapshot) = self.worker.newest() {
            self.update(Event::Snapshot(snapshot));
        }
        let Some((store, mut saved)) = self.store.as_ref().zip(self.app.saved()) else {
            return Ok(());
        };
        if is_path(&saved.open) {
            saved.open = std::path::absolute(&saved.open)?.display().to_string();
        }
        store.save(&saved)
    }

    /// Saves the session now and then. What goes wrong is told once; it will go wrong again at the end.
    fn keep_now_and_then(&mut self, elapsed: Duration) {
        self.unsaved = self.unsaved.saturating_add(elapsed);
        if self.unsaved >= SAVING
            && let Err(error) = self.keep()
        {
            self.app.notice = Some(Notice::error(error.to_string()));
            self.unsaved = Duration::ZERO;
        }
    }

    fn update(&mut self, event: Event) -> Wish {
        let effects = self.app.update(event);
        self.perform(effects)
    }

    /// Does what the application asks for; what concerns the terminal is the stage's to do.
    fn perform(&mut self, effects: Vec<Effect>) -> Wish {
        let mut wish = Wish::Nothing;
        for effect in effects {
            match effect {
                Effect::Tell(command) => self.worker.tell(command),
                Effect::Load(name) => self.loader.load(name),
                Effect::Export => {
                    let written = self.export();
                    self.app.update(Event::Written(written));
                }
                Effect::Check { revision, title, text } => {
                    self.checker.check(revision, Document::new(title, text));
                }
                Effect::Save { place, text, known } => {
                    let saved = files::save(&place, &text, known.as_deref());
                    self.update(Event::FileSaved(saved.map(|()| (place, text))));
                }
                Effect::SaveCopy { name, text } => {
                    let saved = files::save_copy(&name, &text);
                    self.update(Event::FileSaved(saved.map(|place| (place, text))));
                }
                Effect::Reread(place) => match files::read(&place) {
                    Some(text) => {
                        self.update(Event::FileRead { text, asked: true });
                    }
                    None => {
                        let told = format!("cannot read {}", place.display());
                        self.app.notice = Some(Notice::error(told));
                    }
                },
                Effect::Repaint => wish = Wish::Repaint,
                Effect::Mouse(on) => wish = Wish::Mouse(on),
                Effect::Suspend => wish = Wish::Suspend,
                Effect::Quit => return Wish::Quit,
            }
        }
        wish
    }

    /// Writes the present as a file of a system; a sentence on it.
    fn export(&mut self) -> Result<String, String> {
        let lab = self.app.lab.as_ref().ok_or("there is no system to write")?;
        let snapshot = lab.seen().ok_or("the system was not seen in motion yet")?;
        let Loaded { name, document, model, system, .. } = &lab.loaded;
        let Export { text, missing } = Export::of(document, (model, system), snapshot)?;
        let path = product::put(Path::new("."), product::stem(name), "toml", text.as_bytes());
        let path = path.map_err(|error| error.to_string())?;
        let path = path.strip_prefix(".").unwrap_or(&path);
        Ok([vec![format!("{} is written.", path.display())], missing].concat().join(" "))
    }

    /// Looks at the file of the system in the lab; whether it has changed.
    fn watch(&mut self, elapsed: Duration) -> bool {
        let open = self.app.page != crate::app::Page::Picker;
        let Some((watch, place)) = self.watch.as_mut().zip(self.app.file().filter(|_| open)) else {
            return false;
        };
        let Some(text) = watch.look(&place, elapsed) else { return false };
        self.update(Event::FileRead { text, asked: false });
        true
    }

    /// Takes the answer to a check in, if one is there: what is right runs at once.
    fn answer(&mut self) -> bool {
        let Some(answer) = self.checker.take() else { return false };
        let name = self.app.lab.as_ref().map(|lab| lab.loaded.name.clone());
        let Some(name) = name.filter(|_| self.app.awaits(answer.revision)) else { return false };
        let outcome = answer.outcome.map(|ready| self.begin(name, *ready));
        let (revision, took) = (answer.revision, answer.took);
        self.update(Event::Checked(Box::new(Checked { revision, outcome, took })));
        true
    }

    /// Sets a loaded system in motion.
    fn begin(&mut self, name: String, ready: Ready) -> Loaded {
        let Ready { document, model, equations, system, experiment } = ready;
        let epoch = self.worker.load(experiment);
        Loaded { name, epoch, document, model, equations, system }
    }
}

impl Page for Session {
    fn input(&mut self, input: Input) -> Wish {
        self.update(match input {
            Input::Key(key) => Event::Key(key),
            Input::Paste(text) => Event::Paste(text),
            // Nothing on the screen answers to it yet.
            Input::Mouse(_) => return Wish::Nothing,
            Input::Focus(gained) => Event::Focus(gained),
            Input::Resize(columns, rows) => Event::Resize(columns, rows),
        })
    }

    /// Time by itself changes nothing that is worth a frame, except that a notice goes.
    fn advance(&mut self, elapsed: Duration) -> bool {
        self.keep_now_and_then(elapsed);
        let noticed = self.app.notice.is_some();
        self.update(Event::Tick(elapsed));
        let mut changed = self.app.notice.is_some() != noticed;
        if let Some(outcome) = self.loader.take() {
            let loaded = outcome.map(|(name, ready)| self.begin(name, *ready));
            self.update(Event::Loaded(loaded));
            if let Some(warning) = self.warning.take() {
                self.app.notice = Some(Notice::error(warning));
            }
            changed = true;
        }
        changed |= self.watch(elapsed);
        changed |= self.answer();
        if let Some(snapshot) = self.worker.newest() {
            self.update(Event::Snapshot(snapshot));
            changed = true;
        }
        changed
    }

    fn draw(&mut self, area: Rect, buffer: &mut Buffer) {
        let drawn = view::draw(&self.app, &self.look, area, buffer);
        self.update(Event::Drawn(drawn));
    }

    fn is_typing(&self) -> bool {
        self.app.is_typing()
    }
}

#[cfg(test)]
mod tests {
    use ratatui::layout::Size;

    use super::*;
    use crate::experiment::Ready;
    use crate::view::colour::ColourDepth;
    use crate::view::frame::Frames;
    use crate::view::glyphs::Glyphs;
    use crate::view::theme::Theme;

    /// The bytes of so many frames of a system in motion, 30 in a second, after its first two seconds.
    fn frames(name: &str, depth: ColourDepth, count: u32) -> Vec<usize> {
        let catalog = Catalog::with_folder(None);
        let document = catalog.find(name).expect("a shipped preset");
        let ready = Ready::of(&document).expect("a preset without mistakes");
        let Ready { document, model, equations, system, mut experiment } = ready;
        let name = name.to_owned();
        experiment.set_epoch(1);
        let (mut app, _) = App::new(&catalog, Some(&name));
        let loaded = Loaded { name, epoch: 1, document, model, equations, system };
        app.update(Event::Loaded(Ok(loaded)));
        let look = Look { theme: Theme::dark(depth), glyphs: Glyphs::Braille };
        let mut screen = Frames::new(true);
        let mut bytes = Vec::new();
        for frame in 0..count + 60 {
            let time = f64::from(frame) / 30.0 * experiment.speed();
            experiment.advance(time, u64::MAX);
            app.update(Event::Tick(Duration::from_secs(1) / 30));
            app.update(Event::Snapshot(Arc::new(experiment.snapshot())));
            let draw = |area, buffer: &mut Buffer| {
                view::draw(&app, &look, area, buffer);
            };
            bytes.push(screen.next(Size::new(80, 24), draw).len());
        }
        bytes.split_off(60)
    }

    #[test]
    fn frames_fit_a_slow_line() {
        let frames = frames("pendulum", ColourDepth::Ansi256, 200);
        let mean = frames.iter().sum::<usize>() / frames.len();
        let greatest = frames.iter().max().copied().unwrap_or(0);
        assert!(mean <= 350 && greatest <= 600, "mean {mean}, greatest {greatest}");
    }
}
