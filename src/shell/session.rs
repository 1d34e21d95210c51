//! The session: the application together with everything that performs its effects.
//!
//! In: inputs and frames from the frame loop. Out: a drawn screen; commands to the worker, loads to the loader,
//! requests to the frame loop. Never here: what a key does, or how anything looks.

mod guiding;
mod outputs;
mod polling;
mod saving;

use std::collections::HashMap;
use std::io;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use crossterm::event::{
    Event as TerminalEvent, KeyCode, KeyEvent, KeyModifiers, MouseButton, MouseEventKind,
};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};

use tracing::{error, info};

use super::checker::Checker;
use super::clipboard;
use super::files::{self, Watch};
use super::frame_loop::{FramePace, Screen, ScreenRequest};
use super::guided::Guided;
use super::loader::Loader;
use super::mouse::with_shift;
use super::recorder::CastRecorder;
use super::request::Request;
use super::screen_style::ScreenStyle;
use super::store::Store;
use super::writer::Writer;
use crate::app::{App, AppEvent, Asker, Computation, Effect, Loaded, Notification, Overlay, Saved};
use crate::diagnostic::Document;
use crate::experiment::{Prepared, Status};
use crate::instrument::Answer;
use crate::preset::{Catalog, is_path};
use crate::view::colour::Rgb;
use crate::view::theme::PALETTES;
use crate::view::{self, Detail, Painter, RenderStyle};
use crate::worker::{SideJob, Worker};

pub(super) struct Session {
    app: App,
    style: ScreenStyle,
    worker: Worker,
    loader: Loader,
    checker: Checker,
    /// The watch on the system's file, if it is to be watched.
    watch: Option<Watch>,
    saving: Saving,
    /// Writes the file that a key requested.
    writer: Writer,
    sides: HashMap<Asker, SideJob<Answer>>,
    /// A warning to repeat when the first system is loaded, since loading clears notifications.
    warning: Option<String>,
    /// The last error logged.
    error: Option<String>,
    /// The lesson or demo that has the screen.
    guided: Option<Guided>,
    /// The recording under way, if there is one.
    recorder: Option<CastRecorder>,
    /// What draws the screen, and keeps what does not change.
    painter: Painter,
    /// How long nothing visible has changed.
    still: Duration,
    /// The screen's size when it was last drawn.
    size: Size,
    clipboard: Clipboard,
    exit: ProgramEnd,
}

/// What saves the session while the laboratory is open.
#[derive(Default)]
struct Saving {
    store: Option<Store>,
    since: Since,
    /// The revision of the texts stored last.
    stored_texts: u64,
}

struct Clipboard {
    is_there: bool,
    text: Option<String>,
}

#[derive(Default)]
struct ProgramEnd {
    /// The result of saving, once it was done.
    result: Option<ExitResult>,
    /// Whether the program was being terminated when it was saved.
    is_forced: bool,
}

#[derive(Debug)]
pub(super) struct ExitResult {
    pub(super) recorded: io::Result<()>,
    pub(super) saved: io::Result<()>,
}

/// How long nothing has to change before the page rests, and how long it rests then, with a watched file or without.
const SETTLED: Duration = Duration::from_millis(500);
const WATCHING: Duration = Duration::from_millis(250);
const RESTING: Duration = Duration::from_secs(1);

/// How long to wait for the disk at the end: at a normal exit; at a forced exit with unsaved texts, which could not
/// be recovered; and at any other forced exit.
const UNHURRIED: Duration = Duration::from_secs(10);
const FOR_TEXTS: Duration = Duration::from_millis(1200);
const HURRIED: Duration = Duration::from_millis(100);

/// The times since the session was saved, since the texts were stored, and since the other program was checked for.
#[derive(Debug, Default)]
struct Since {
    saved: Duration,
    texts: Duration,
    checked: Duration,
}

impl Session {
    /// Opens the laboratory at a preset or file, or at the picker.
    pub(super) fn new(
        catalog: Catalog,
        request: &Request,
        style: RenderStyle,
        pace: FramePace,
    ) -> io::Result<Self> {
        let (mut app, effects) = App::new(&catalog, request.open.as_deref());
        if let (Some(name), Some(start)) = (&request.open, &request.start) {
            app.start_with(name, start.clone());
        }
        app.mouse.is_reported = pace.mouse;
        app.jobs.in_background = true;
        app.meter.asked = pace.frames;
        app.meter.most = request.most_frames();
        app.themes.available =
            PALETTES.iter().map(|palette| (palette.name, palette.about)).collect();
        app.themes.chosen = Some(style.theme.palette().name);
        let loader = Loader::new(Arc::new(catalog));
        let watch = request.watch.then(Watch::default);
        let (worker, checker) = (Worker::idle()?, Checker::new());
        let mut session = Self {
            app,
            style: ScreenStyle::new(style),
            worker,
            loader,
            checker,
            watch,
            saving: Saving::default(),
            writer: Writer::new(),
            sides: HashMap::new(),
            warning: None,
            error: None,
            guided: None,
            recorder: None,
            painter: Painter::default(),
            still: Duration::ZERO,
            size: Size::default(),
            clipboard: Clipboard {
                is_there: clipboard::is_there(&|name| std::env::var(name).ok()),
                text: None,
            },
            exit: ProgramEnd::default(),
        };
        session.find_guides();
        session.execute(effects);
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

    fn update(&mut self, event: AppEvent) -> ScreenRequest {
        let effects = self.app.update(event);
        self.execute(effects)
    }

    /// Performs the application's effects. Returns the request to the frame loop, which controls the terminal.
    fn execute(&mut self, effects: Vec<Effect>) -> ScreenRequest {
        let mut request = ScreenRequest::Nothing;
        for effect in effects {
            match effect {
                Effect::Execute(command) => {
                    info!("command {command:?}");
                    self.worker.execute(command);
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
                    let side = self.sides.entry(asker).or_insert_with(|| SideJob::new("side"));
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
                    self.update(AppEvent::FileSaved(saved.map(|()| (place, text))));
                }
                Effect::SaveCopy { name, text } => {
                    let saved = files::save_copy(&name, &text);
                    self.update(AppEvent::FileSaved(saved.map(|place| (place, text))));
                }
                Effect::Reread(place) => match files::read(&place) {
                    Ok(text) => {
                        self.update(AppEvent::FileRead { text, asked: true });
                    }
                    Err(why) => self.app.notifications.show(Notification::error(why.to_string())),
                },
                Effect::Repaint => request = ScreenRequest::Repaint,
                Effect::Frames(count) => request = ScreenRequest::Frames(count),
                Effect::Mouse(on) => request = ScreenRequest::Mouse(on),
                Effect::Still => self.still(),
                Effect::Data => self.data(),
                Effect::Copy { what, text, ending } => self.copy(what, text, ending),
                Effect::Record(true) => self.record(),
                Effect::Record(false) => self.end_recording(),
                Effect::TakeGuide(guide) => self.take_guide(&guide),
                Effect::Suspend => request = ScreenRequest::Suspend,
                Effect::Quit if self.may_end() => return ScreenRequest::Quit,
                Effect::Quit => {}
            }
        }
        request
    }

    /// Returns the result of saving the recording and the session at the end, saves them if that has not been
    /// done yet, and puts them on the disk, unless that takes long.
    pub(super) fn left(&mut self) -> ExitResult {
        self.on_exit(true);
        if let Some(store) = self.saving.store.as_mut().filter(|_| !self.exit.is_forced) {
            store.sync(HURRIED);
        }
        self.exit.result.take().unwrap_or(ExitResult { recorded: Ok(()), saved: Ok(()) })
    }

    /// Starts a loaded system.
    fn begin(&mut self, name: String, ready: Prepared) -> Loaded {
        // The background jobs belong to the previous system.
        self.sides.clear();
        Loaded::of(name, ready, |experiment| self.worker.load(experiment))
    }
}

/// Whether this is Ctrl-c.
fn is_interrupt(event: &TerminalEvent) -> bool {
    matches!(event, TerminalEvent::Key(KeyEvent { code: KeyCode::Char('c'), modifiers, .. })
        if modifiers.contains(KeyModifiers::CONTROL))
}

impl Screen for Session {
    fn input(&mut self, event: TerminalEvent) -> ScreenRequest {
        if is_interrupt(&event) {
            // It ends the program, whatever has the screen.
            self.leave_guide();
        } else if let Some(guided) = &mut self.guided {
            let request = guided.input(event);
            return self.asked_by_guide(request);
        }
        let event = match event {
            TerminalEvent::Key(key) => AppEvent::Key(key),
            TerminalEvent::Paste(text) => AppEvent::Paste(text),
            TerminalEvent::Mouse(mouse) => {
                // Not every terminal reports the release of a button.
                let is_released =
                    mouse.kind == MouseEventKind::Moved && self.app.mouse.drag.is_some();
                if mouse.kind == MouseEventKind::Down(MouseButton::Left) || is_released {
                    self.app.end_group();
                }
                let area = Rect::from((Position::ORIGIN, self.size));
                match view::hit_test(&self.app, self.style.full(), area, mouse.column, mouse.row) {
                    Some(hit) => AppEvent::Mouse(with_shift(mouse), hit),
                    None => {
                        if mouse.kind == MouseEventKind::Up(MouseButton::Left) {
                            self.app.end_group();
                        }
                        return ScreenRequest::Nothing;
                    }
                }
            }
            TerminalEvent::FocusGained => AppEvent::Focus(true),
            TerminalEvent::FocusLost => AppEvent::Focus(false),
            TerminalEvent::Resize(columns, rows) => AppEvent::Resize(columns, rows),
        };
        self.still = Duration::ZERO;
        self.update(event)
    }

    /// Nothing changes while time is paused and nobody is at work. Whatever comes later all the same, such as the text
    /// of a watched file, is checked now and then.
    fn rest(&self) -> Option<Duration> {
        let app = &self.app;
        let paused = app.snapshot().is_some_and(|snapshot| snapshot.status != Status::Running);
        let awaited = app.loading().is_some()
            || app.notifications.shown.is_some()
            || self.writer.is_busy()
            || self.sides.values().any(SideJob::is_busy);
        let editing = matches!(app.overlay, Some(Overlay::Workbench));
        let rests =
            self.still >= SETTLED && paused && !awaited && !editing && self.guided.is_none();
        rests.then_some(if self.watch.is_some() { WATCHING } else { RESTING })
    }

    /// The passing of time changes nothing visible by itself, except that a notification disappears.
    fn advance(&mut self, elapsed: Duration) -> bool {
        if let Some(guided) = &mut self.guided {
            return guided.advance(elapsed);
        }
        self.report_errors();
        self.save_periodically(elapsed);
        let noticed = self.app.notifications.shown.is_some();
        self.update(AppEvent::Tick(elapsed));
        let mut changed = self.app.notifications.shown.is_some() != noticed;
        if let Some(outcome) = self.loader.take() {
            match &outcome {
                Ok((name, _)) => info!("loaded {name}"),
                Err(error) => {
                    error!("cannot load {}: {}", error.name, error.message);
                }
            }
            let loaded = outcome
                .map(|(name, ready)| self.begin(name, *ready))
                .map_err(|error| self.with_text_saved(error));
            self.update(AppEvent::Loaded(loaded));
            if let Some(warning) = self.warning.take() {
                self.app.notifications.show(Notification::error(warning));
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
            self.update(AppEvent::Snapshot(snapshot));
            changed = true;
        }
        self.still = if changed { Duration::ZERO } else { self.still.saturating_add(elapsed) };
        changed
    }

    fn draw(&mut self, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        if let Some(guided) = &mut self.guided {
            return guided.draw(area, buffer);
        }
        let drawn = self.painter.draw(&self.app, self.style.drawn(), area, buffer);
        self.size = area.as_size();
        if let Some(recorder) = &mut self.recorder
            && let Err(why) = recorder.take(buffer)
        {
            self.give_up_recording(&why);
        }
        let cursor = drawn.cursor;
        self.update(AppEvent::Drawn(drawn));
        cursor.map(Position::from)
    }

    fn is_typing(&self) -> bool {
        if let Some(guided) = &self.guided {
            return guided.is_typing();
        }
        self.app.is_typing()
    }

    fn clipboard(&mut self) -> Option<String> {
        self.clipboard.text.take()
    }

    fn on_exit(&mut self, hurried: bool) {
        if self.exit.result.is_some() {
            return;
        }
        self.leave_guide();
        self.exit.is_forced = hurried;
        // A working thread would use up the time that is left.
        self.loader.stop();
        self.checker.stop();
        self.sides.clear();
        let time = match (hurried, self.app.unsaved().is_empty()) {
            (false, _) => UNHURRIED,
            (true, false) => FOR_TEXTS,
            (true, true) => HURRIED,
        };
        // Files outlive the program: they are put on the disk when the terminal is a shell's again.
        if let Some(store) = &self.saving.store {
            store.hurry(true);
        }
        // The texts come first, since they could not be recovered.
        let saved = self.keep_within(time);
        let recorder = self.recorder.take();
        let recorded = recorder.map_or(Ok(()), |recorder| recorder.end(!hurried).map(|_| ()));
        let written = if hurried { None } else { self.writer.wait(UNHURRIED) };
        let written = written.map_or(Ok(()), |report| report.map(|_| ()).map_err(io::Error::other));
        self.exit.result = Some(ExitResult { recorded: recorded.and(written), saved });
    }

    /// What the user has chosen in the meantime stays.
    fn background(&mut self, colour: Rgb) {
        let initial = self.style.full().theme.palette().name;
        self.style.suit(colour);
        let suits = self.style.full().theme.palette().name;
        info!("the terminal's background is {colour:?}: the {suits} theme");
        if self.app.themes.chosen == Some(initial) {
            self.app.themes.chosen = Some(suits);
        }
        if let Some(guided) = &mut self.guided {
            guided.background(colour);
        }
    }

    fn reduce(&mut self, detail: Detail) {
        info!("the line to the terminal is slow or fast again: {detail:?}");
        if let Some(guided) = &mut self.guided {
            guided.reduce(detail);
        }
        self.style.reduce(detail);
    }
}
