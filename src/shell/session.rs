//! The session: the application together with everything that performs its effects.
//!
//! In: inputs and frames from the frame loop. Out: a drawn screen; commands to the worker, loads to the loader,
//! requests to the frame loop. Never here: what a key does, or how anything looks.

use std::collections::HashMap;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use crossterm::event::{
    Event as TerminalEvent, KeyModifiers, MouseButton, MouseEvent, MouseEventKind,
};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};

use tracing::{error, info};

use super::atomic_file;
use super::checker::Checker;
use super::clipboard;
use super::files::{self, FileChange, Watch};
use super::frame_loop::{Pace, Screen, ScreenRequest};
use super::loader::Loader;
use super::recorder::Recorder;
use super::request::Request;
use super::store::{Store, StoreError};
use super::writer::{WriteReport, Writer};
use crate::app::{
    App, Asker, Checked, Computation, Effect, Event, LoadError, Loaded, Notification, Overlay,
    Saved, Unsaved,
};
use crate::diagnostic::Document;
use crate::experiment::{Export, Prepared, Snapshot, Status};
use crate::instrument::Answer;
use crate::preset::{Catalog, Origin, is_path};
use crate::record::{data, plain, screenshot};
use crate::view::colour::ColourDepth;
use crate::view::glyphs::Glyphs;
use crate::view::theme::{PALETTES, Palette, Theme};
use crate::view::{self, Detail, Painter, RenderStyle};
use crate::worker::{Side, Worker};

/// The running laboratory.
pub(super) struct Session {
    app: App,
    look: RenderStyle,
    /// The level of detail, reduced over a slow connection.
    detail: Detail,
    worker: Worker,
    loader: Loader,
    checker: Checker,
    /// The watch on the system's file, if it is to be watched.
    watch: Option<Watch>,
    store: Option<Store>,
    /// The times since the session was saved, since the texts were stored, and since the other program was checked
    /// for.
    since: Since,
    /// The revision of the texts stored last.
    kept_texts: u64,
    /// Writes the file that a key requested.
    writer: Writer,
    /// The background jobs of each asker.
    sides: HashMap<Asker, Side<Answer>>,
    /// A warning to repeat when the first system is loaded, since loading clears notifications.
    warning: Option<String>,
    /// The last fault logged.
    fault: Option<String>,
    /// The recording under way, if there is one.
    recorder: Option<Recorder>,
    /// What draws the screen, and keeps what does not change.
    painter: Painter,
    /// How long nothing visible has changed.
    still: Duration,
    /// The screen's size when it was last drawn.
    size: Size,
    /// Whether the terminal has a clipboard, and what is to be put into it.
    has_clipboard: bool,
    clipboard: Option<String>,
    /// The result of saving at the end.
    left: Option<Left>,
}

/// The result of saving at the end.
#[derive(Debug)]
pub(super) struct Left {
    pub(super) recorded: io::Result<()>,
    pub(super) kept: io::Result<()>,
}

/// The interval at which the session is saved while the laboratory is open, the delay before typed text is stored,
/// and the interval of checks whether another program that saves its session has ended.
const SAVING: Duration = Duration::from_secs(15);
const TEXTS: Duration = Duration::from_secs(1);
const TAKING_OVER: Duration = Duration::from_secs(1);

/// How long nothing has to change before the page rests, and how long it rests then, with a watched file or without.
const SETTLED: Duration = Duration::from_millis(500);
const WATCHING: Duration = Duration::from_millis(250);
const RESTING: Duration = Duration::from_secs(1);

/// How long to wait for the disk at the end: at a normal exit; at a forced exit with unsaved texts, which could not
/// be recovered; and at any other forced exit.
const UNHURRIED: Duration = Duration::from_secs(10);
const FOR_TEXTS: Duration = Duration::from_millis(1200);
const HURRIED: Duration = Duration::from_millis(100);

/// The times since the last run of each periodic task.
#[derive(Debug, Default)]
struct Since {
    saved: Duration,
    texts: Duration,
    looked: Duration,
}

impl Session {
    /// Opens the laboratory at a preset or file, or at the picker.
    pub(super) fn new(
        catalog: Catalog,
        request: &Request,
        look: RenderStyle,
        pace: Pace,
    ) -> io::Result<Self> {
        let (mut app, effects) = App::new(&catalog, request.open.as_deref());
        app.mouse = pace.mouse;
        app.aside = true;
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
            writer: Writer::new(),
            sides: HashMap::new(),
            warning: None,
            fault: None,
            recorder: None,
            painter: Painter::default(),
            still: Duration::ZERO,
            size: Size::default(),
            has_clipboard: clipboard::is_there(&|name| std::env::var(name).ok()),
            clipboard: None,
            left: None,
        };
        session.perform(effects);
        Ok(session)
    }

    /// Resumes a session once its system is loaded.
    pub(super) fn resume(&mut self, saved: Saved) {
        self.app.resume(saved);
    }

    /// Offers to resume a session, in the list of systems.
    pub(super) fn offer(&mut self, saved: Saved) {
        self.app.offer_session(saved);
    }

    /// Saves the session in a store from now on, and restores the texts stored there; `open` is the requested name.
    /// Whatever cannot be stored is reported to the user.
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
        let left = atomic_file::left_behind(Path::new("."));
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
            let report = troubles.join("; ");
            self.app.notice = Some(Notification::error(&report));
            self.warning = Some(report);
        }
    }

    /// Restores stored texts under the names that their systems have in this program.
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

    /// Queues the current session and the unsaved texts for saving, without waiting for the disk.
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

    /// Queues the unsaved texts for storing.
    fn keep_texts(&mut self, last: bool) {
        self.since.texts = Duration::ZERO;
        self.kept_texts = self.app.workbench.revision();
        let Some(store) = &mut self.store else { return };
        // If the file cannot be resolved, the text is stored under its current name.
        let place = |text: Unsaved| placed(text.clone()).unwrap_or(text);
        store.keep_texts(self.app.unsaved().into_iter().map(place).collect(), last);
    }

    /// Saves the session and the texts, waiting for the disk at most this long.
    fn keep_within(&mut self, time: Duration) -> io::Result<()> {
        self.keep(true)?;
        let Some(store) = &mut self.store else { return Ok(()) };
        let first = store.settle(time).into_iter().next();
        self.app.workbench.keeps = store.keeps_texts();
        first.map_or(Ok(()), Err)
    }

    /// Whether the program may end. It may not before the user has been warned of the loss of a text.
    fn may_end(&mut self) -> bool {
        if !self.app.workbench.keeps || self.app.unsaved().is_empty() {
            return true;
        }
        if let Err(error) = self.keep_within(UNHURRIED) {
            error!("{error}");
        }
        if !self.app.workbench.keeps {
            self.app.stay();
        }
        self.app.workbench.keeps
    }

    /// Saves the session and the texts periodically. An error is reported only once; it will occur again at the
    /// end.
    fn save_periodically(&mut self, elapsed: Duration) {
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
            let report = error.to_string();
            if self.warning.as_ref() != Some(&report) {
                self.app.notice = Some(Notification::error(&report));
                self.warning = Some(report);
            }
        }
    }

    /// Takes over saving the session if the program that did so has ended.
    fn take_over(&mut self) {
        let Some(store) = &mut self.store else { return };
        let Some(texts) = store.take_over() else { return };
        let troubles = std::mem::take(&mut store.troubles);
        let mut report =
            vec!["The other phaselab has ended; this one saves the session now.".into()];
        report.extend(troubles);
        info!("{}", report.join(" "));
        self.app.notice = Some(Notification::info(report.join(" ")));
        self.warning = None;
        self.take_texts(texts, None);
        self.keep_texts(false);
    }

    fn update(&mut self, event: Event) -> ScreenRequest {
        let effects = self.app.update(event);
        self.perform(effects)
    }

    /// Performs the application's effects. Returns the request to the frame loop, which controls the terminal.
    fn perform(&mut self, effects: Vec<Effect>) -> ScreenRequest {
        let mut request = ScreenRequest::Nothing;
        for effect in effects {
            match effect {
                Effect::Tell(command) => {
                    info!("command {command:?}");
                    self.worker.tell(command);
                }
                Effect::Load(name) => {
                    info!("load {name}");
                    if let Some(watch) = self.watch.as_mut().filter(|_| is_path(&name)) {
                        watch.follow(Path::new(&name));
                    }
                    self.loader.load(name);
                }
                Effect::StopLoading => self.loader.stop(),
                Effect::StopCheck => self.checker.stop(),
                Effect::Compute(Computation { ticket, asker, job }) => {
                    let side = self.sides.entry(asker).or_insert_with(|| Side::new("side"));
                    side.begin(ticket, job);
                }
                Effect::StopComputing(asker) => {
                    self.sides.remove(&asker);
                }
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
                Effect::Repaint => request = ScreenRequest::Repaint,
                Effect::Frames(count) => request = ScreenRequest::Frames(count),
                Effect::Mouse(on) => request = ScreenRequest::Mouse(on),
                Effect::Still => self.still(),
                Effect::Data => self.data(),
                Effect::Copy { what, text, ending } => self.copy(what, text, ending),
                Effect::Record(true) => self.record(),
                Effect::Record(false) => self.end_recording(),
                Effect::Suspend => request = ScreenRequest::Suspend,
                Effect::Quit if self.may_end() => return ScreenRequest::Quit,
                Effect::Quit => {}
            }
        }
        request
    }

    /// Exports the current state as a system file.
    fn export(&mut self) {
        let Some((loaded, snapshot)) = self.seen() else {
            return self.report(Err("There is no motion here to write down.".to_owned()));
        };
        self.write_file(move || {
            let Loaded { name, document, model, system, .. } = &loaded;
            let export = Export::of(document, (model, system), &snapshot)?;
            let Export { text, missing } = export.with_what_holds(document)?;
            let written = put(name, "toml", text.as_bytes())?;
            Ok([vec![written], missing].concat().join(" "))
        });
    }

    /// Returns the system in the lab and its newest snapshot.
    fn seen(&self) -> Option<(Loaded, Arc<Snapshot>)> {
        let lab = self.app.lab.as_ref()?;
        lab.seen()?;
        Some((lab.loaded.clone(), Arc::clone(lab.snapshot.as_ref()?)))
    }

    /// Starts to write a file that a key requested; the outcome is reported.
    fn write_file(&mut self, work: impl FnOnce() -> WriteReport + Send + 'static) {
        if let Err(why) = self.writer.begin(work) {
            self.report(Err(why));
        }
    }

    /// Reports the outcome of writing a file.
    fn report(&mut self, report: WriteReport) {
        info!("{report:?}");
        self.app.update(Event::Written(report));
    }

    /// Checks the file of the system being loaded or in the lab. Returns whether it has changed.
    fn watch(&mut self, elapsed: Duration) -> bool {
        if let Some(watch) = &mut self.watch
            && let Some(name) = self.app.loading().filter(|name| is_path(name))
        {
            // The file has changed while it was being loaded.
            if let Some(FileChange::Text { .. }) = watch.look(Path::new(name), elapsed) {
                info!("load {name} again");
                self.loader.load(name.to_owned());
            }
            return false;
        }
        if let Some(watch) = &mut self.watch
            && let Some(name) = self.app.failed_system().filter(|name| is_path(name))
        {
            // This file could not be loaded at all.
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
                info!("{} is gone", place.display());
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

    /// Takes in the result of a check, if there is one; a correct system runs at once. Returns whether there was
    /// one.
    fn answer(&mut self) -> bool {
        let Some(answer) = self.checker.take() else { return false };
        let name = self.app.checked_system();
        let Some(name) = name.filter(|_| self.app.awaits(answer.ticket)) else { return false };
        let outcome = answer.outcome.map(|ready| self.begin(name, *ready));
        let (ticket, took) = (answer.ticket, answer.took);
        self.update(Event::Checked(Box::new(Checked { ticket, outcome, took })));
        true
    }

    /// Takes in the outcomes and the progress of background jobs. Returns whether there are any jobs.
    fn poll_jobs(&mut self) -> bool {
        let mut events = Vec::new();
        let mut busy = false;
        for side in self.sides.values_mut() {
            busy |= side.is_busy();
            if let Some((ticket, outcome)) = side.take() {
                events.push(Event::Computed { ticket, outcome });
            } else if let Some((ticket, share)) = side.share() {
                events.push(Event::Progress { ticket, share });
            }
        }
        for event in events {
            self.update(event);
        }
        busy
    }

    /// Logs each fault of the motion once.
    fn report_faults(&mut self) {
        let fault = match self.app.snapshot().map(|snapshot| &snapshot.status) {
            Some(Status::Failed(fault)) => {
                Some(format!("at t = {}: {}", fault.time, fault.message))
            }
            _ => None,
        };
        if fault != self.fault {
            if let Some(fault) = &fault {
                error!("{fault}");
            }
            self.fault = fault;
        }
    }

    /// Returns the stem for files about the current state.
    fn stem(&self) -> String {
        self.app.lab.as_ref().map_or_else(|| "phaselab".to_owned(), |lab| lab.loaded.name.clone())
    }

    fn title(&self) -> String {
        let lab = self.app.lab.as_ref();
        lab.map_or_else(|| "phaselab".to_owned(), |lab| lab.loaded.model.info.title.clone())
    }

    /// Saves a drawing of the screen, with all colours and the finest dots whatever the terminal supports.
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
            let drawing = screenshot::write(&screen, palette, screenshot::Form::Svg, &title);
            put(&stem, "svg", drawing.as_bytes())
        });
    }

    /// Puts a text into the terminal's clipboard, or else into a file.
    fn copy(&mut self, what: &'static str, text: String, ending: &'static str) {
        if self.has_clipboard && text.len() <= clipboard::MOST {
            self.clipboard = Some(text);
            let format = if ending == "tex" { " as LaTeX" } else { "" };
            return self.report(Ok(format!("{what} are copied{format}: paste them anywhere.")));
        }
        let stem = self.stem();
        self.write_file(move || put(&stem, ending, text.as_bytes()));
    }

    /// Saves a table of the recorded motion.
    fn data(&mut self) {
        let Some((loaded, snapshot)) = self.seen() else {
            return self.report(Err("There is no motion here to write down.".to_owned()));
        };
        self.write_file(move || {
            let mut table = Vec::new();
            data::write(&loaded, &snapshot, &mut table).map_err(|why| why.to_string())?;
            put(&loaded.name, "csv", &table)
        });
    }

    /// Starts a recording, or reports why that is impossible.
    fn record(&mut self) {
        let palette = self.palette();
        match Recorder::begin(&self.stem(), &self.title(), self.size, palette) {
            Ok(recorder) => self.recorder = Some(recorder),
            Err(why) => self.give_up_recording(&why),
        }
    }

    /// Ends the recording after an error, but keeps what was recorded; the next attempt begins another file.
    fn give_up_recording(&mut self, why: &io::Error) {
        let recorder = self.recorder.take();
        let report = recorder.map_or_else(|| why.to_string(), |recorder| recorder.give_up(why));
        error!("{report}");
        self.app.recording = false;
        self.app.notice = Some(Notification::error(format!("{report}.")));
    }

    /// Ends a recording, and reports its name.
    fn end_recording(&mut self) {
        self.app.recording = false;
        if let Some(recorder) = self.recorder.take() {
            let end = move || recorder.end(true).map_err(|why| why.to_string());
            self.write_file(move || end().map(|name| format!("{name} is written.")));
        }
    }

    /// Returns the result of saving the recording and the session at the end, and saves them if that has not been
    /// done yet.
    pub(super) fn left(&mut self) -> Left {
        self.on_exit(true);
        self.left.take().unwrap_or(Left { recorded: Ok(()), kept: Ok(()) })
    }

    /// Returns the palette shown.
    fn palette(&self) -> &'static Palette {
        let named = |p: &&Palette| Some(p.name) == self.app.theme_shown();
        PALETTES.iter().find(named).unwrap_or_else(|| self.look.theme.palette())
    }

    /// Adds the location of an unsaved text to the message about a system that cannot be loaded.
    fn with_text_kept(&self, mut failure: LoadError) -> LoadError {
        let place = self.store.as_ref().and_then(Store::place_of_texts);
        let unsaved = self.app.unsaved().iter().any(|text| text.name == failure.name);
        if let Some(place) = place.filter(|_| unsaved) {
            let place = place.display();
            failure.message += &format!("\n\nThe text of it that is not saved is in {place}.\n");
        }
        failure
    }

    /// Starts a loaded system.
    fn begin(&mut self, name: String, ready: Prepared) -> Loaded {
        let Prepared { document, model, equations, system, experiment } = ready;
        // The background jobs belong to the previous system.
        self.sides.clear();
        let epoch = self.worker.load(experiment);
        Loaded { name, epoch, document, model, equations, system }
    }
}

/// Writes a file about the current state into the current folder. Returns a sentence about it.
fn put(stem: &str, ending: &'static str, bytes: &[u8]) -> WriteReport {
    let path = atomic_file::write_new(Path::new(""), stem, ending, bytes)
        .map_err(|why| why.to_string())?;
    Ok(format!("{} is written.", path.display()))
}

/// Returns a name that is valid whatever folder the program is next started in.
fn absolute(name: String) -> io::Result<String> {
    if !is_path(&name) {
        return Ok(name);
    }
    Ok(std::path::absolute(&name)?.display().to_string())
}

/// Returns the canonical path of a file, with links resolved, even if the file does not exist.
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

/// Identifies a text by the canonical path of its file, so that it is found again from any folder and under any
/// spelling.
fn placed(text: Unsaved) -> io::Result<Unsaved> {
    let place = text.place.map(|place| identity(&place)).transpose()?;
    let name = if is_path(&text.name) {
        identity(Path::new(&text.name))?.display().to_string()
    } else {
        text.name
    };
    Ok(Unsaved { name, place, ..text })
}

/// Renames a restored text to the one of these names that denotes its file, if there is one.
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

/// Shift makes the right button of the left one: many terminals keep one of the two for themselves.
fn with_shift(mouse: MouseEvent) -> MouseEventKind {
    match mouse.kind {
        MouseEventKind::Up(MouseButton::Left) if mouse.modifiers.contains(KeyModifiers::SHIFT) => {
            MouseEventKind::Up(MouseButton::Right)
        }
        MouseEventKind::Down(MouseButton::Left)
            if mouse.modifiers.contains(KeyModifiers::SHIFT) =>
        {
            MouseEventKind::Down(MouseButton::Right)
        }
        kind => kind,
    }
}

impl Screen for Session {
    fn input(&mut self, event: TerminalEvent) -> ScreenRequest {
        let event = match event {
            TerminalEvent::Key(key) => Event::Key(key),
            TerminalEvent::Paste(text) => Event::Paste(text),
            TerminalEvent::Mouse(mouse) => {
                if mouse.kind == MouseEventKind::Down(MouseButton::Left) {
                    // Not every terminal reports the release of a button.
                    self.app.drop_hold();
                }
                let area = Rect::from((Position::ORIGIN, self.size));
                match view::hit_test(&self.app, &self.look, area, mouse.column, mouse.row) {
                    Some(hit) => Event::Mouse(with_shift(mouse), hit),
                    None => return ScreenRequest::Nothing,
                }
            }
            TerminalEvent::FocusGained => Event::Focus(true),
            TerminalEvent::FocusLost => Event::Focus(false),
            TerminalEvent::Resize(columns, rows) => Event::Resize(columns, rows),
        };
        self.still = Duration::ZERO;
        self.update(event)
    }

    /// Nothing changes while time is paused and nobody is at work. Whatever comes later all the same, such as the text
    /// of a watched file, is looked for now and then.
    fn rest(&self) -> Option<Duration> {
        let app = &self.app;
        let paused = app.snapshot().is_some_and(|snapshot| snapshot.status != Status::Running);
        let awaited = app.loading().is_some()
            || app.notice.is_some()
            || self.writer.is_busy()
            || self.sides.values().any(Side::is_busy);
        let editing = matches!(app.overlay, Some(Overlay::Workbench));
        let rests = self.still >= SETTLED && paused && !awaited && !editing;
        rests.then_some(if self.watch.is_some() { WATCHING } else { RESTING })
    }

    /// The passing of time changes nothing visible by itself, except that a notification disappears.
    fn advance(&mut self, elapsed: Duration) -> bool {
        self.report_faults();
        self.save_periodically(elapsed);
        let noticed = self.app.notice.is_some();
        self.update(Event::Tick(elapsed));
        let mut changed = self.app.notice.is_some() != noticed;
        if let Some(outcome) = self.loader.take() {
            match &outcome {
                Ok((name, _)) => info!("loaded {name}"),
                Err(failure) => {
                    error!("cannot load {}: {}", failure.name, failure.message);
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
        changed |= self.poll_jobs();
        if let Some(report) = self.writer.take() {
            self.report(report);
            changed = true;
        }
        if let Some(snapshot) = self.worker.newest() {
            self.update(Event::Snapshot(snapshot));
            changed = true;
        }
        self.still = if changed { Duration::ZERO } else { self.still.saturating_add(elapsed) };
        changed
    }

    fn draw(&mut self, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        let reduced = (self.detail != Detail::default()).then(|| self.look.reduced(self.detail));
        let look = reduced.as_ref().unwrap_or(&self.look);
        let drawn = self.painter.draw(&self.app, look, area, buffer);
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

    fn clipboard(&mut self) -> Option<String> {
        self.clipboard.take()
    }

    fn on_exit(&mut self, hurried: bool) {
        if self.left.is_some() {
            return;
        }
        // A working thread would use up the time that is left.
        self.loader.stop();
        self.checker.stop();
        self.sides.clear();
        let time = match (hurried, self.app.unsaved().is_empty()) {
            (false, _) => UNHURRIED,
            (true, false) => FOR_TEXTS,
            (true, true) => HURRIED,
        };
        if let Some(store) = self.store.as_ref().filter(|_| hurried) {
            store.hurry();
        }
        // The texts come first, since they could not be recovered.
        let kept = self.keep_within(time);
        let recorder = self.recorder.take();
        let recorded = recorder.map_or(Ok(()), |recorder| recorder.end(!hurried).map(|_| ()));
        let written = if hurried { None } else { self.writer.wait(UNHURRIED) };
        let written = written.map_or(Ok(()), |report| report.map(|_| ()).map_err(io::Error::other));
        self.left = Some(Left { recorded: recorded.and(written), kept });
    }

    fn reduce(&mut self, detail: Detail) {
        info!("the line to the terminal is slow or fast again: {detail:?}");
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

    /// A running system, and the terminal that shows it.
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
            Self {
                app,
                experiment,
                look,
                screen: Frames::new(true).expect("memory"),
                size: Size { width, height },
            }
        }

        /// Returns the size in bytes of a frame at this time of the clock, in seconds.
        fn frame(&mut self, time: f64, most: usize, detail: Detail) -> usize {
            self.experiment.advance(time * self.experiment.speed(), u64::MAX);
            self.app.update(Event::Tick(Duration::from_secs(1) / 30));
            self.app.update(Event::Snapshot(Arc::new(self.experiment.snapshot())));
            let look = self.look.reduced(detail);
            let draw = |area, buffer: &mut Buffer| {
                view::draw(&self.app, &look, area, buffer);
            };
            self.screen.next_within(self.size, most, draw).expect("bytes").len()
        }
    }

    /// Returns the mean and the greatest size in bytes of this many frames, at 30 per second, after the first two
    /// seconds.
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
