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
use super::files::{self, News, Watch};
use super::input::Input;
use super::loader::Loader;
use super::log::Log;
use super::product;
use super::recorder::Recorder;
use super::request::Request;
use super::stage::{Pace, Page, Wish};
use super::store::{NoStore, Store};
use crate::app::{
    Act, App, Checked, Effect, Event, LoadFailure, Loaded, Mouse, Notice, Saved, Unsaved,
};
use crate::experiment::{Export, Ready, Status};
use crate::preset::{Catalog, Document, is_path};
use crate::record::{data, plain, still};
use crate::view::colour::ColourDepth;
use crate::view::glyphs::Glyphs;
use crate::view::theme::{PALETTES, Palette, Theme};
use crate::view::{self, Detail, Look};
use crate::worker::Worker;

/// The laboratory as it runs.
pub(super) struct Session {
    app: App,
    look: Look,
    /// What is left out of the look on a slow line.
    detail: Detail,
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

/// How often the session is saved while the laboratory is open.
const SAVING: Duration = Duration::from_secs(15);

impl Session {
    /// The laboratory, opened at a preset or file, or at the picker.
    pub(super) fn new(
        catalog: Catalog,
        request: &Request,
        look: Look,
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
        let (detail, store, unsaved) = (Detail::default(), None, Duration::ZERO);
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
            unsaved,
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
    /// for. What is not kept the user is told.
    pub(super) fn keep_in(&mut self, store: Result<Store, NoStore>, open: Option<&str>) {
        let troubles = match store {
            Err(why) => vec![why.to_string()],
            Ok(mut store) => {
                let texts = store.texts().iter().cloned();
                self.app.workbench.put(texts.map(|text| called(text, open)).collect());
                self.app.workbench.keeps = store.place_of_texts().is_some();
                let troubles = std::mem::take(&mut store.troubles);
                self.store = Some(store);
                troubles
            }
        };
        if !troubles.is_empty() {
            let told = troubles.join("; ");
            self.app.notice = Some(Notice::error(&told));
            self.warning = Some(told);
        }
    }

    /// Saves the session as it is now, and the texts that are not saved.
    pub(super) fn keep(&mut self) -> io::Result<()> {
        self.unsaved = Duration::ZERO;
        if let Some(snapshot) = self.worker.newest() {
            self.update(Event::Snapshot(snapshot));
        }
        let Some(store) = &mut self.store else { return Ok(()) };
        // one whose place cannot be told is kept by the name it has
        let place = |text: Unsaved| placed(text.clone()).unwrap_or(text);
        let texts = store.keep_texts(self.app.unsaved().into_iter().map(place).collect());
        self.app.workbench.keeps = texts.is_ok() && store.place_of_texts().is_some();
        if let Some(mut saved) = self.app.saved() {
            saved.open = absolute(saved.open)?;
            store.save(&saved)?;
        }
        texts
    }

    /// Whether the program may end: not where a text would be lost by it, before that was told.
    fn may_end(&mut self) -> bool {
        if !self.app.workbench.keeps || self.app.unsaved().is_empty() {
            return true;
        }
        if let Err(error) = self.keep() {
            self.log.error(error);
        }
        if !self.app.workbench.keeps {
            self.app.stay();
        }
        self.app.workbench.keeps
    }

    /// Saves the session now and then. What goes wrong is told once; it will go wrong again at the end.
    fn keep_now_and_then(&mut self, elapsed: Duration) {
        self.unsaved = self.unsaved.saturating_add(elapsed);
        if self.unsaved >= SAVING
            && let Err(error) = self.keep()
        {
            let told = error.to_string();
            if self.warning.as_ref() != Some(&told) {
                self.app.notice = Some(Notice::error(&told));
                self.warning = Some(told);
            }
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
                Effect::Tell(command) => {
                    self.log.info(format!("command {command:?}"));
                    self.worker.tell(command);
                }
                Effect::Load(name) => {
                    self.log.info(format!("load {name}"));
                    self.loader.load(name);
                }
                Effect::Export => {
                    let written = self.export();
                    self.log.info(format!("export {written:?}"));
                    self.app.update(Event::Written(written));
                }
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
                    Some(text) => {
                        self.update(Event::FileRead { text, asked: true });
                    }
                    None => {
                        let told = format!("cannot read {}", place.display());
                        self.app.notice = Some(Notice::error(told));
                    }
                },
                Effect::Repaint => wish = Wish::Repaint,
                Effect::Frames(count) => wish = Wish::Frames(count),
                Effect::Mouse(on) => wish = Wish::Mouse(on),
                Effect::Still => self.tell_of(Session::still),
                Effect::Data => self.tell_of(Session::data),
                Effect::Record(true) => self.record(),
                Effect::Record(false) => self.tell_of(Session::end_recording),
                Effect::Suspend => wish = Wish::Suspend,
                Effect::Quit if self.may_end() => return Wish::Quit,
                Effect::Quit => {}
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
        if let Some(watch) = &mut self.watch
            && let Some(name) = self.app.failed_system().filter(|name| is_path(name))
        {
            // a file that was wrong from the beginning
            let Some(News::Text { .. }) = watch.look(Path::new(name), elapsed) else {
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
            Some(News::Gone) => {
                self.log.info(format!("{} is gone", place.display()));
                self.update(Event::FileThere(false));
            }
            Some(News::Text { text, back }) => {
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
    fn tell_of_faults(&mut self) {
        let fault = match self.app.snapshot().map(|snapshot| &snapshot.status) {
            Some(Status::Faulted(fault)) => {
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

    /// Writes a file, and tells its name or why there is none.
    fn tell_of(&mut self, write: fn(&mut Session) -> io::Result<String>) {
        let written = write(self).map(|name| format!("{name} is written."));
        self.app.update(Event::Written(written.map_err(|why| why.to_string())));
    }

    /// Writes a file about the present into the current folder; its name.
    fn put(&self, ending: &str, bytes: &[u8]) -> io::Result<String> {
        let path = product::put(Path::new("."), product::stem(&self.stem()), ending, bytes)?;
        Ok(path.strip_prefix(".").unwrap_or(&path).display().to_string())
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
    fn still(&mut self) -> io::Result<String> {
        let palette = self.palette();
        let look = Look { theme: Theme::new(palette, ColourDepth::True), glyphs: Glyphs::Braille };
        let area = Rect::from(self.size);
        let mut screen = Buffer::empty(area);
        view::draw(&self.app, &look, area, &mut screen);
        plain(&mut screen);
        let drawing = still::write(&screen, palette, still::Form::Svg, &self.title());
        self.put("svg", drawing.as_bytes())
    }

    /// The rows that are recorded of the motion.
    fn data(&mut self) -> io::Result<String> {
        let seen = self.app.lab.as_ref().and_then(|lab| Some((&lab.loaded, lab.seen()?)));
        let (loaded, snapshot) =
            seen.ok_or_else(|| io::Error::other("there is no motion here to write down"))?;
        let mut table = Vec::new();
        data::write(loaded, snapshot, &mut table)?;
        self.put("csv", &table)
    }

    /// Begins to record; where that cannot be it is told, and nothing is recorded.
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
        self.app.notice = Some(Notice::error(format!("{told}.")));
    }

    /// Ends a recording; its name.
    fn end_recording(&mut self) -> io::Result<String> {
        self.app.recording = false;
        let recorder = self.recorder.take();
        recorder.map_or_else(|| Ok("nothing".to_owned()), Recorder::end)
    }

    /// Ends a recording on the way out, if there is one.
    fn finish_recording(&mut self) -> io::Result<()> {
        self.recorder.take().map_or(Ok(()), |recorder| recorder.end().map(|_| ()))
    }

    /// What became of the recording and of the session when it ended; writes both down if that was not done yet.
    pub(super) fn left(&mut self) -> Left {
        self.last_words();
        self.left.take().unwrap_or(Left { recorded: Ok(()), kept: Ok(()) })
    }

    /// The colours that are shown.
    fn palette(&self) -> &'static Palette {
        let named = |p: &&Palette| Some(p.name) == self.app.theme_shown();
        PALETTES.iter().find(named).unwrap_or_else(|| self.look.theme.palette())
    }

    /// Adds where a text of a system that cannot be loaded is found.
    fn with_text_kept(&self, mut failure: LoadFailure) -> LoadFailure {
        let place = self.store.as_ref().and_then(Store::place_of_texts);
        let kept = self.app.unsaved().iter().any(|text| text.name == failure.name);
        if let Some(place) = place.filter(|_| kept) {
            let place = place.display();
            failure.message += &format!("\n\nThe text of it that is not saved is in {place}.\n");
        }
        failure
    }

    /// Sets a loaded system in motion.
    fn begin(&mut self, name: String, ready: Ready) -> Loaded {
        let Ready { document, model, equations, system, experiment } = ready;
        let epoch = self.worker.load(experiment);
        Loaded { name, epoch, document, model, equations, system }
    }
}

/// A name that means the same wherever the program is started next.
fn absolute(name: String) -> io::Result<String> {
    if !is_path(&name) {
        return Ok(name);
    }
    Ok(std::path::absolute(&name)?.display().to_string())
}

/// A text with names that mean the same wherever the program is started next.
fn placed(text: Unsaved) -> io::Result<Unsaved> {
    let place = text.place.map(std::path::absolute).transpose()?;
    Ok(Unsaved { name: absolute(text.name)?, place, ..text })
}

/// A text that was kept, called as it was asked for now.
fn called(text: Unsaved, open: Option<&str>) -> Unsaved {
    let same = |open: &&str| absolute((*open).to_owned()).is_ok_and(|name| name == text.name);
    match open.filter(|open| is_path(open)).filter(same) {
        Some(open) => Unsaved { name: open.to_owned(), place: Some(PathBuf::from(open)), ..text },
        None => text,
    }
}

impl Page for Session {
    fn input(&mut self, input: Input) -> Wish {
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
                    None => return Wish::Nothing,
                }
            }
            Input::Focus(gained) => Event::Focus(gained),
            Input::Resize(columns, rows) => Event::Resize(columns, rows),
        })
    }

    /// Time by itself changes nothing that is worth a frame, except that a notice goes.
    fn advance(&mut self, elapsed: Duration) -> bool {
        self.tell_of_faults();
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

    fn last_words(&mut self) {
        if self.left.is_none() {
            // the texts first: nothing could make them again
            let kept = self.keep();
            let recorded = self.finish_recording();
            self.left = Some(Left { recorded, kept });
        }
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
    use crate::experiment::{Experiment, Ready};
    use crate::view::colour::ColourDepth;
    use crate::view::frame::Frames;
    use crate::view::glyphs::Glyphs;
    use crate::view::theme::Theme;

    /// A system in motion, and the terminal that shows it.
    struct Motion {
        app: App,
        experiment: Experiment,
        look: Look,
        screen: Frames,
        size: Size,
    }

    impl Motion {
        fn of(name: &str, depth: ColourDepth, (width, height): (u16, u16)) -> Self {
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
        let mut motion = Motion::of(name, ColourDepth::Ansi256, (80, 24));
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
            let mut motion = Motion::of("double-pendulum", ColourDepth::True, size);
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
