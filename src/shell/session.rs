//! The session: the application with everything that does what it asks for.
//!
//! In: inputs and frames from the stage. Out: a drawn screen; commands to the worker, loads to the loader, wishes to
//! the stage. Never here: what a key does, or how anything looks.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};

use super::checker::Checker;
use super::files::{self, FileChange, Watch};
use super::frame_loop::{Pace, Page, ScreenRequest};
use super::fresh;
use super::input::Input;
use super::job::{Job, Told};
use super::loader::Loader;
use super::log::Log;
use super::product;
use super::recorder::Recorder;
use super::request::Request;
use super::store::{Store, StoreError};
use crate::app::{
    Act, App, Checked, Effect, Event, LoadError, Loaded, Mouse, Notification, Saved, Unsaved,
};
use crate::diagnostic::Document;
use crate::experiment::{Export, Prepared, Snapshot, Status};
use crate::preset::{Catalog, Origin, is_path};
use crate::record::{data, plain, screenshot};
use crate::view::colour::ColourDepth;
use crate::view::glyphs::Glyphs;
use crate::view::theme::{PALETTES, Palette, Theme};
use crate::view::{self, Detail, RenderStyle};
use crate::worker::Worker;

/// The laboratory as it runs.
pub(super) struct Session {
    app: App,
    look: RenderStyle,
    /// What is left out of the look on a slow line.
    detail: Detail,
    worker: Worker,
    loader: Loader,
    checker: Checker,
    /// The system's file, where it is to be watched.
    watch: Option<Watch>,
    store: Option<Store>,
    /// Since the session was last saved, the texts were, and the place of another program was looked at.
    since: Since,
    /// The state of the texts when they were kept last.
    kept_texts: u64,
    /// The file being written that a key asked for.
    job: Job,
    /// Told once more when the first system is there, for its loading ends what was reported before.
    warning: Option<String>,
    /// What happens is written there.
    pub(super) log: Log,
    /// The fault last told of there.
    fault: Option<String>,
    /// What is shown goes in here too.
    recorder: Option<Recorder>,
    /// The screen's size when it was last drawn.
    size: Size,
    /// What was written down at the end.
    left: Option<Left>,
}

/// What was written down at the end.
#[derive(Debug)]
pub(super) struct Left {
    pub(super) recorded: io::Result<()>,
    pub(super) kept: io::Result<()>,
}

/// How often the session is saved while the laboratory is open, how soon a text that is typed, and how often it is
/// looked whether another program that saves its session has ended.
const SAVING: Duration = Duration::from_secs(15);
const TEXTS: Duration = Duration::from_secs(1);
const TAKING_OVER: Duration = Duration::from_secs(1);

/// How long the disk is waited for at the end: without a hurry; where texts are not saved, which nothing could make
/// again; else.
const UNHURRIED: Duration = Duration::from_secs(10);
const FOR_TEXTS: Duration = Duration::from_millis(1200);
const HURRIED: Duration = Duration::from_millis(100);

/// Times since something was done.
#[derive(Debug, Default)]
struct Since {
    saved: Duration,
    texts: Duration,
    looked: Duration,
}

impl Session {
    /// The laboratory, opened at a preset or file, or at the picker.
    pub(super) fn new(
        catalog: Catalog,
        request: &Request,
        look: RenderStyle,
        pace: Pace,
        log: Log,
    ) -> io::Result<Self> {
        let (mut app, effects) = App::new(&catalog, request.open.as_deref());
        app.mouse = pace.mouse;
        app.meter.asked = pace.frames;
        app.meter.most = request.most_frames();
        app.themes = PALETTES.iter().map(|palette| (palette.name, palette.about)).collect();
        app.theme = Some(look.theme.palette().name);
        let loader = Loader::new(Arc::new(catalog));
        let (detail, store) = (Detail::default(), None);
        let watch = request.watch.then(Watch::default);
        let (worker, checker) = (Worker::idle()?, Checker::new());
        let mut session = Self {
            app,
            look,
            detail,
            worker,
            loader,
            checker,
            watch,
            store,
            since: Since::default(),
            kept_texts: 0,
            job: Job::default(),
            warning: None,
            log,
            fault: None,
            recorder: None,
            size: Size::default(),
            left: None,
        };
        session.perform(effects);
        Ok(session)
    }

    /// Goes on with a session once its system is loaded.
    pub(super) fn resume(&mut self, saved: Saved) {
        self.app.resume(saved);
    }

    /// Keeps the session in a store from now on, and takes the texts up that are kept there; `open` is what was asked
    /// for. What is not kept the user is reported.
    pub(super) fn keep_in(&mut self, store: Result<Store, StoreError>, open: Option<&str>) {
        let mut troubles = match store {
            Err(why) => vec![why.to_string()],
            Ok(mut store) => {
                self.take_texts(store.texts().to_vec(), open);
                self.app.workbench.keeps = store.keeps_texts();
                let troubles = std::mem::take(&mut store.troubles);
                self.store = Some(store);
                troubles
            }
        };
        let left = fresh::left_behind(Path::new("."));
        if let Some(first) = left.first() {
            let more = if left.len() > 1 {
                format!(" and {} more", left.len() - 1)
            } else {
                String::new()
            };
            let first = first.strip_prefix(".").unwrap_or(first).display();
            troubles.push(format!("unfinished files were left here: {first}{more}"));
        }
        if !troubles.is_empty() {
            let told = troubles.join("; ");
            self.app.notice = Some(Notification::error(&told));
            self.warning = Some(told);
        }
    }

    /// Takes texts up that were kept, each called as its system is here.
    fn take_texts(&mut self, texts: Vec<Unsaved>, open: Option<&str>) {
        let own = self.app.picker.entries.iter().filter_map(|entry| match &entry.origin {
            Origin::User(path) => Some((entry.name.as_str(), path.as_path())),
            Origin::Shipped => None,
        });
        let open = open.filter(|open| is_path(open)).map(|open| (open, Path::new(open)));
        let names: Vec<_> = open.into_iter().chain(own).collect();
        let texts = texts.into_iter().map(|text| called(text, &names)).collect();
        self.app.workbench.put(texts);
    }

    /// Has the session saved as it is now, and the texts that are not saved; nobody waits for the disk.
    fn keep(&mut self, last: bool) -> io::Result<()> {
        self.since = Since::default();
        if let Some(snapshot) = self.worker.newest() {
            self.update(Event::Snapshot(snapshot));
        }
        self.keep_texts(last);
        let Some(store) = &mut self.store else { return Ok(()) };
        if let Some(mut saved) = self.app.saved() {
            saved.open = absolute(saved.open)?;
            store.save(saved);
        }
        Ok(())
    }

    /// Has the texts kept that are not saved.
    fn keep_texts(&mut self, last: bool) {
        self.since.texts = Duration::ZERO;
        self.kept_texts = self.app.workbench.revision();
        let Some(store) = &mut self.store else { return };
        // one whose place cannot be reported is kept by the name it has
        let place = |text: Unsaved| placed(text.clone()).unwrap_or(text);
        store.keep_texts(self.app.unsaved().into_iter().map(place).collect(), last);
    }

    /// The same, and waits for the disk no longer than that.
    fn keep_within(&mut self, time: Duration) -> io::Result<()> {
        self.keep(true)?;
        let Some(store) = &mut self.store else { return Ok(()) };
        let first = store.settle(time).into_iter().next();
        self.app.workbench.keeps = store.keeps_texts();
        first.map_or(Ok(()), Err)
    }

    /// Whether the program may end: not where a text would be lost by it, before that was reported.
    fn may_end(&mut self) -> bool {
        if !self.app.workbench.keeps || self.app.unsaved().is_empty() {
            return true;
        }
        if let Err(error) = self.keep_within(UNHURRIED) {
            self.log.error(error);
        }
        if !self.app.workbench.keeps {
            self.app.stay();
        }
        self.app.workbench.keeps
    }

    /// Has the session and the texts saved now and then. What goes wrong is reported once; it will go wrong again at the end.
    fn keep_now_and_then(&mut self, elapsed: Duration) {
        let since = &mut self.since;
        for time in [&mut since.saved, &mut since.texts, &mut since.looked] {
            *time = time.saturating_add(elapsed);
        }
        if self.since.looked >= TAKING_OVER {
            self.since.looked = Duration::ZERO;
            self.take_over();
        }
        let mut errors = Vec::new();
        if self.since.saved >= SAVING {
            errors.extend(self.keep(false).err());
        } else if self.since.texts >= TEXTS && self.kept_texts != self.app.workbench.revision() {
            self.keep_texts(false);
        }
        if let Some(store) = &mut self.store {
            errors.extend(store.errors());
            self.app.workbench.keeps = store.keeps_texts();
        }
        if let Some(error) = errors.first() {
            let told = error.to_string();
            if self.warning.as_ref() != Some(&told) {
                self.app.notice = Some(Notification::error(&told));
                self.warning = Some(told);
            }
        }
    }

    /// Saves the session from now on where another program did that and has ended.
    fn take_over(&mut self) {
        let Some(store) = &mut self.store else { return };
        let Some(texts) = store.take_over() else { return };
        let troubles = std::mem::take(&mut store.troubles);
        let mut told = vec!["The other phaselab has ended; this one saves the session now.".into()];
        told.extend(troubles);
        self.log.info(told.join(" "));
        self.app.notice = Some(Notification::info(told.join(" ")));
        self.warning = None;
        self.take_texts(texts, None);
        self.keep_texts(false);
    }

    fn update(&mut self, event: Event) -> ScreenRequest {
        let effects = self.app.update(event);
        self.perform(effects)
    }

    /// Does what the application asks for; what concerns the terminal is the stage's to do.
    fn perform(&mut self, effects: Vec<Effect>) -> ScreenRequest {
        let mut wish = ScreenRequest::Nothing;
        for effect in effects {
            match effect {
                Effect::Tell(command) => {
                    self.log.info(format!("command {command:?}"));
                    self.worker.tell(command);
                }
                Effect::Load(name) => {
                    self.log.info(format!("load {name}"));
                    if let Some(watch) = self.watch.as_mut().filter(|_| is_path(&name)) {
                        watch.follow(Path::new(&name));
                    }
                    self.loader.load(name);
                }
                Effect::StopLoading => self.loader.stop(),
                Effect::StopCheck => self.checker.stop(),
                Effect::Export => self.export(),
                Effect::Check { ticket, title, text } => {
                    self.checker.check(ticket, Document::new(title, text));
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
                    Ok(text) => {
                        self.update(Event::FileRead { text, asked: true });
                    }
                    Err(why) => self.app.notice = Some(Notification::error(why.to_string())),
                },
                Effect::Repaint => wish = ScreenRequest::Repaint,
                Effect::Frames(count) => wish = ScreenRequest::Frames(count),
                Effect::Mouse(on) => wish = ScreenRequest::Mouse(on),
                Effect::Still => self.still(),
                Effect::Data => self.data(),
                Effect::Record(true) => self.record(),
                Effect::Record(false) => self.end_recording(),
                Effect::Suspend => wish = ScreenRequest::Suspend,
                Effect::Quit if self.may_end() => return ScreenRequest::Quit,
                Effect::Quit => {}
            }
        }
        wish
    }

    /// Writes the present as a file of a system.
    fn export(&mut self) {
        let Some((loaded, snapshot)) = self.seen() else {
            return self.told(Err("There is no motion here to write down.".to_owned()));
        };
        self.write_file(move || {
            let Loaded { name, document, model, system, .. } = &loaded;
            let export = Export::of(document, (model, system), &snapshot)?;
            let Export { text, missing } = export.with_what_holds(document)?;
            let written = put(product::stem(name), "toml", text.as_bytes())?;
            Ok([vec![written], missing].concat().join(" "))
        });
    }

    /// The system in the lab and its newest snapshot.
    fn seen(&self) -> Option<(Loaded, Arc<Snapshot>)> {
        let lab = self.app.lab.as_ref()?;
        lab.seen()?;
        Some((lab.loaded.clone(), Arc::clone(lab.snapshot.as_ref()?)))
    }

    /// Has a file written that a key asked for; what becomes of it is reported.
    fn write_file(&mut self, work: impl FnOnce() -> Told + Send + 'static) {
        if let Err(why) = self.job.begin(work) {
            self.told(Err(why));
        }
    }

    /// Tells what became of a file.
    fn told(&mut self, told: Told) {
        self.log.info(format!("{told:?}"));
        self.app.update(Event::Written(told));
    }

    /// Looks at the file of the system in the lab; whether it has changed.
    fn watch(&mut self, elapsed: Duration) -> bool {
        if let Some(watch) = &mut self.watch
            && let Some(name) = self.app.loading().filter(|name| is_path(name))
        {
            // what is being loaded is no longer what stands there
            if let Some(FileChange::Text { .. }) = watch.look(Path::new(name), elapsed) {
                self.log.info(format!("load {name} again"));
                self.loader.load(name.to_owned());
            }
            return false;
        }
        if let Some(watch) = &mut self.watch
            && let Some(name) = self.app.failed_system().filter(|name| is_path(name))
        {
            // a file that was wrong from the beginning
            let Some(FileChange::Text { .. }) = watch.look(Path::new(name), elapsed) else {
                return false;
            };
            let effects = self.app.again();
            self.perform(effects);
            return true;
        }
        let open = self.app.page != crate::app::Page::Picker;
        let Some((watch, place)) = self.watch.as_mut().zip(self.app.file().filter(|_| open)) else {
            return false;
        };
        match watch.look(&place, elapsed) {
            None => return false,
            Some(FileChange::Gone) => {
                self.log.info(format!("{} is gone", place.display()));
                self.update(Event::FileThere(false));
            }
            Some(FileChange::Text { text, back }) => {
                if back {
                    self.update(Event::FileThere(true));
                }
                self.update(Event::FileRead { text, asked: false });
            }
        }
        true
    }

    /// Takes the answer to a check in, if one is there: what is right runs at once.
    fn answer(&mut self) -> bool {
        let Some(answer) = self.checker.take() else { return false };
        let name = self.app.lab.as_ref().map(|lab| lab.loaded.name.clone());
        let Some(name) = name.filter(|_| self.app.awaits(answer.ticket)) else { return false };
        let outcome = answer.outcome.map(|ready| self.begin(name, *ready));
        let (ticket, took) = (answer.ticket, answer.took);
        self.update(Event::Checked(Box::new(Checked { ticket, outcome, took })));
        true
    }

    /// Writes why the motion cannot go on, once.
    fn report_faults(&mut self) {
        let fault = match self.app.snapshot().map(|snapshot| &snapshot.status) {
            Some(Status::Failed(fault)) => {
                Some(format!("at t = {}: {}", fault.time, fault.message))
            }
            _ => None,
        };
        if fault != self.fault {
            if let Some(fault) = &fault {
                self.log.error(fault);
            }
            self.fault = fault;
        }
    }

    /// What files are called that are written about the present.
    fn stem(&self) -> String {
        self.app.lab.as_ref().map_or_else(|| "phaselab".to_owned(), |lab| lab.loaded.name.clone())
    }

    fn title(&self) -> String {
        let lab = self.app.lab.as_ref();
        lab.map_or_else(|| "phaselab".to_owned(), |lab| lab.loaded.model.info.title.clone())
    }

    /// A drawing of the screen, with all colours and the finest dots whatever the terminal has.
    fn still(&mut self) {
        let palette = self.palette();
        let look =
            RenderStyle { theme: Theme::new(palette, ColourDepth::True), glyphs: Glyphs::Braille };
        let area = Rect::from(self.size);
        let mut screen = Buffer::empty(area);
        view::draw(&self.app, &look, area, &mut screen);
        plain(&mut screen);
        let (stem, title) = (self.stem(), self.title());
        self.write_file(move || {
            let drawing = still::write(&screen, palette, still::Form::Svg, &title);
            put(product::stem(&stem), "svg", drawing.as_bytes())
        });
    }

    /// The rows that are recorded of the motion.
    fn data(&mut self) {
        let Some((loaded, snapshot)) = self.seen() else {
            return self.told(Err("There is no motion here to write down.".to_owned()));
        };
        self.write_file(move || {
            let mut table = Vec::new();
            data::write(&loaded, &snapshot, &mut table).map_err(|why| why.to_string())?;
            put(product::stem(&loaded.name), "csv", &table)
        });
    }

    /// Begins to record; where that cannot be it is reported, and nothing is recorded.
    fn record(&mut self) {
        let palette = self.palette();
        match Recorder::begin(&self.stem(), &self.title(), self.size, palette) {
            Ok(recorder) => self.recorder = Some(recorder),
            Err(why) => self.give_up_recording(&why),
        }
    }

    /// Records no longer, but keeps what was recorded; the next try begins another file.
    fn give_up_recording(&mut self, why: &io::Error) {
        let recorder = self.recorder.take();
        let told = recorder.map_or_else(|| why.to_string(), |recorder| recorder.give_up(why));
        self.log.error(&told);
        self.app.recording = false;
        self.app.notice = Some(Notification::error(format!("{told}.")));
    }

    /// Ends a recording, and tells its name.
    fn end_recording(&mut self) {
        self.app.recording = false;
        if let Some(recorder) = self.recorder.take() {
            let end = move || recorder.end(true).map_err(|why| why.to_string());
            self.write_file(move || end().map(|name| format!("{name} is written.")));
        }
    }

    /// What became of the recording and of the session when it ended; writes both down if that was not done yet.
    pub(super) fn left(&mut self) -> Left {
        self.on_exit(true);
        self.left.take().unwrap_or(Left { recorded: Ok(()), kept: Ok(()) })
    }

    /// The colours that are shown.
    fn palette(&self) -> &'static Palette {
        let named = |p: &&Palette| Some(p.name) == self.app.theme_shown();
        PALETTES.iter().find(named).unwrap_or_else(|| self.look.theme.palette())
    }

    /// Adds where a text of a system that cannot be loaded is found.
    fn with_text_kept(&self, mut failure: LoadError) -> LoadError {
        let place = self.store.as_ref().and_then(Store::place_of_texts);
        let kept = self.app.unsaved().iter().any(|text| text.name == failure.name);
        if let Some(place) = place.filter(|_| kept) {
            let place = place.display();
            failure.message += &format!("\n\nThe text of it that is not saved is in {place}.\n");
        }
        failure
    }

    /// Sets a loaded system in motion.
    fn begin(&mut self, name: String, ready: Prepared) -> Loaded {
        let Prepared { document, model, equations, system, experiment } = ready;
        let epoch = self.worker.load(experiment);
        Loaded { name, epoch, document, model, equations, system }
    }
}

/// Writes a file about the present into the current folder; a sentence on it.
fn put(stem: &str, ending: &'static str, bytes: &[u8]) -> Told {
    let path = product::put(Path::new(""), stem, ending, bytes).map_err(|why| why.to_string())?;
    Ok(format!("{} is written.", path.display()))
}

/// A name that means the same wherever the program is started next.
fn absolute(name: String) -> io::Result<String> {
    if !is_path(&name) {
        return Ok(name);
    }
    Ok(std::path::absolute(&name)?.display().to_string())
}

/// The one path of a file, whatever it is called: without links, also where there is no file now.
fn identity(path: &Path) -> io::Result<PathBuf> {
    let whole = std::path::absolute(path)?;
    if let Ok(real) = whole.canonicalize() {
        return Ok(real);
    }
    let folder = whole.parent().and_then(|folder| folder.canonicalize().ok());
    Ok(match (folder, whole.file_name()) {
        (Some(folder), Some(name)) => folder.join(name),
        _ => whole,
    })
}

/// A text by its file, so that it is found however that is spelled and wherever the program is started next.
fn placed(text: Unsaved) -> io::Result<Unsaved> {
    let place = text.place.map(|place| identity(&place)).transpose()?;
    let name = if is_path(&text.name) {
        identity(Path::new(&text.name))?.display().to_string()
    } else {
        text.name
    };
    Ok(Unsaved { name, place, ..text })
}

/// A text that was kept, called as its file is here, where it is among these names.
fn called(text: Unsaved, names: &[(&str, &Path)]) -> Unsaved {
    let own = is_path(&text.name).then(|| PathBuf::from(&text.name)).or(text.place.clone());
    let Some(file) = own.and_then(|own| identity(&own).ok()) else { return text };
    let same = |path: &Path| identity(path).is_ok_and(|path| path == file);
    match names.iter().find(|(_, path)| same(path)) {
        Some((name, path)) => {
            Unsaved { name: (*name).to_owned(), place: Some(path.to_path_buf()), ..text }
        }
        None => text,
    }
}

impl Page for Session {
    fn input(&mut self, input: Input) -> ScreenRequest {
        if let Input::Mouse(Mouse { act: Act::Press, .. }) = input {
            // Not every terminal says that the button came up.
            self.app.drop_hold();
        }
        self.update(match input {
            Input::Key(key) => Event::Key(key),
            Input::Paste(text) => Event::Paste(text),
            Input::Mouse(Mouse { column, row, act }) => {
                let area = Rect::from((Position::ORIGIN, self.size));
                match view::spot(&self.app, &self.look, area, column, row) {
                    Some(spot) => Event::Mouse(act, spot),
                    None => return ScreenRequest::Nothing,
                }
            }
            Input::Focus(gained) => Event::Focus(gained),
            Input::Resize(columns, rows) => Event::Resize(columns, rows),
        })
    }

    /// Time by itself changes nothing that is worth a frame, except that a notice goes.
    fn advance(&mut self, elapsed: Duration) -> bool {
        self.report_faults();
        self.keep_now_and_then(elapsed);
        let noticed = self.app.notice.is_some();
        self.update(Event::Tick(elapsed));
        let mut changed = self.app.notice.is_some() != noticed;
        if let Some(outcome) = self.loader.take() {
            match &outcome {
                Ok((name, _)) => self.log.info(format!("loaded {name}")),
                Err(failure) => {
                    self.log.error(format!("cannot load {}: {}", failure.name, failure.message));
                }
            }
            let loaded = outcome
                .map(|(name, ready)| self.begin(name, *ready))
                .map_err(|failure| self.with_text_kept(failure));
            self.update(Event::Loaded(loaded));
            if let Some(warning) = self.warning.take() {
                self.app.notice = Some(Notification::error(warning));
            }
            changed = true;
        }
        changed |= self.watch(elapsed);
        changed |= self.answer();
        if let Some(told) = self.job.take() {
            self.told(told);
            changed = true;
        }
        if let Some(snapshot) = self.worker.newest() {
            self.update(Event::Snapshot(snapshot));
            changed = true;
        }
        changed
    }

    fn draw(&mut self, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        let reduced = (self.detail != Detail::default()).then(|| self.look.reduced(self.detail));
        let look = reduced.as_ref().unwrap_or(&self.look);
        let drawn = view::draw(&self.app, look, area, buffer);
        self.size = area.as_size();
        if let Some(recorder) = &mut self.recorder
            && let Err(why) = recorder.take(buffer)
        {
            self.give_up_recording(&why);
        }
        self.update(Event::Drawn(drawn));
        drawn.cursor.map(Position::from)
    }

    fn is_typing(&self) -> bool {
        self.app.is_typing()
    }

    fn on_exit(&mut self, hurried: bool) {
        if self.left.is_some() {
            return;
        }
        // a thread at work would take the time that is left
        self.loader.stop();
        self.checker.stop();
        let time = match (hurried, self.app.unsaved().is_empty()) {
            (false, _) => UNHURRIED,
            (true, false) => FOR_TEXTS,
            (true, true) => HURRIED,
        };
        if let Some(store) = self.store.as_ref().filter(|_| hurried) {
            store.hurry();
        }
        // the texts first: nothing could make them again
        let kept = self.keep_within(time);
        let recorder = self.recorder.take();
        let recorded = recorder.map_or(Ok(()), |recorder| recorder.end(!hurried).map(|_| ()));
        let written = if hurried { None } else { self.job.wait(UNHURRIED) };
        let written = written.map_or(Ok(()), |told| told.map(|_| ()).map_err(io::Error::other));
        self.left = Some(Left { recorded: recorded.and(written), kept });
    }

    fn reduce(&mut self, detail: Detail) {
        self.log.info(format!("the line to the terminal is slow or fast again: {detail:?}"));
        self.detail = detail;
    }
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use ratatui::layout::Size;

    use super::super::governor::Governor;
    use super::*;
    use crate::experiment::{Experiment, Prepared};
    use crate::view::colour::ColourDepth;
    use crate::view::frame::Frames;
    use crate::view::glyphs::Glyphs;
    use crate::view::theme::Theme;

    /// A system in motion, and the terminal that shows it.
    struct OpenSystem {
        app: App,
        experiment: Experiment,
        look: RenderStyle,
        screen: Frames,
        size: Size,
    }

    impl OpenSystem {
        fn of(name: &str, depth: ColourDepth, (width, height): (u16, u16)) -> Self {
            let catalog = Catalog::with_folder(None);
            let document = catalog.find(name).expect("a shipped preset");
            let ready = Prepared::of(&document).expect("a preset without mistakes");
            let Prepared { document, model, equations, system, mut experiment } = ready;
            let name = name.to_owned();
            experiment.set_epoch(1);
            let (mut app, _) = App::new(&catalog, Some(&name));
            let loaded = Loaded { name, epoch: 1, document, model, equations, system };
            app.update(Event::Loaded(Ok(loaded)));
            let look = RenderStyle { theme: Theme::dark(depth), glyphs: Glyphs::Braille };
            Self { app, experiment, look, screen: Frames::new(true), size: Size { width, height } }
        }

        /// The bytes of a frame at that time of the clock, in seconds.
        fn frame(&mut self, time: f64, most: usize, detail: Detail) -> usize {
            self.experiment.advance(time * self.experiment.speed(), u64::MAX);
            self.app.update(Event::Tick(Duration::from_secs(1) / 30));
            self.app.update(Event::Snapshot(Arc::new(self.experiment.snapshot())));
            let look = self.look.reduced(detail);
            let draw = |area, buffer: &mut Buffer| {
                view::draw(&self.app, &look, area, buffer);
            };
            self.screen.next_within(self.size, most, draw).len()
        }
    }

    /// The bytes of so many frames, 30 in a second, after the first two seconds: their mean and the greatest.
    fn frames(name: &str, count: u32) -> (usize, usize) {
        let mut motion = OpenSystem::of(name, ColourDepth::Ansi256, (80, 24));
        let frame =
            |frame: u32| motion.frame(f64::from(frame) / 30.0, usize::MAX, Detail::default());
        let bytes = (0..count + 60).map(frame).collect::<Vec<_>>().split_off(60);
        (bytes.iter().sum::<usize>() / bytes.len(), bytes.iter().max().copied().unwrap_or(0))
    }

    #[test]
    fn frames_fit_a_slow_line() {
        let limits = [
            ("pendulum", 350, 600),
            ("planet", 450, 1000),
            ("double-pendulum", 350, 1200),
            ("henon-heiles", 350, 1500),
            ("solar-system", 350, 1300),
            ("foucault", 350, 1500),
            ("toda", 350, 1300),
        ];
        let found = limits.map(|(name, ..)| (name, frames(name, 200)));
        let fits =
            |((_, mean, most), (_, bytes)): (&(&str, usize, usize), &(&str, (usize, usize)))| {
                bytes.0 <= *mean && bytes.1 <= *most
            };
        assert!(limits.iter().zip(&found).all(fits), "name, mean and greatest: {found:?}");
    }

    #[test]
    fn a_limit_of_the_line_is_kept_to() {
        const BUDGET: u32 = 16 * 1024;
        for size in [(80, 24), (200, 60)] {
            let mut motion = OpenSystem::of("double-pendulum", ColourDepth::True, size);
            let start = Instant::now();
            let mut governor = Governor::new(15, Some(BUDGET), start);
            let (mut now, mut sum, mut count) = (start, 0, 0);
            while now - start < Duration::from_secs(10) {
                let time = (now - start).as_secs_f64();
                let bytes = motion.frame(time, governor.most(), governor.detail());
                governor.sent(bytes, now);
                (sum, count) = (sum + bytes, count + 1);
                now = governor.due();
            }
            assert!(sum <= BUDGET as usize * 11, "{size:?}: {sum} bytes in ten seconds");
            assert!(count >= 20, "{size:?}: {count} frames in ten seconds");
        }
    }
}
