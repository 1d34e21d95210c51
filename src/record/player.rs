//! The player: a script, its system and the application, brought together on the virtual clock.
//!
//! In: a [`Script`], a document. Out: a [`Recording`], or every mistake that only playing shows. What the application asks
//! for is done at once, in the same thread; what concerns a terminal or a file is not done. Never here: how anything
//! looks, or the form of a cast.

use std::mem;
use std::sync::Arc;
use std::time::Duration;

use ratatui::buffer::Buffer;
use ratatui::layout::{Rect, Size};

use super::assertion;
use super::clock::{Clock, Micros};
use super::plain::plain;
use super::script::{PACE, Script, Step, Text};
use crate::app::{App, Code, Effect, Key, LoadFailure, Loaded, Target};
use crate::experiment::{Command, Experiment, Progress, Ready, Status};
use crate::preset::{Catalog, Document, Mistake};
use crate::view::caption::{self, Caption};
use crate::view::frame::Frames;
use crate::view::{self, Look};

/// What came of a script.
#[derive(Clone, Debug)]
pub struct Recording {
    /// Its title.
    pub title: String,
    /// Columns and rows.
    pub size: (u16, u16),
    /// Frames in a second.
    pub fps: u32,
    /// How many frames time has passed: the whole lasts `frames / fps`.
    pub frames: u64,
    /// When it ends.
    pub end: Micros,
    /// How it looks.
    pub look: Look,
    /// What is to be shown when: bytes for a terminal, and the names of chapters.
    pub events: Vec<(Micros, Event)>,
    /// The chapters.
    pub markers: Vec<Marker>,
    /// The screen at the end.
    pub last: Buffer,
    /// What was done and found.
    pub log: Vec<(Micros, Entry)>,
    /// The claims that turned out false.
    pub false_claims: Vec<Mistake>,
}

/// Something in a recording.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Event {
    /// Text for the terminal.
    Output(String),
    /// A chapter begins.
    Marker(String),
}

/// A chapter.
#[derive(Clone, Debug)]
pub struct Marker {
    /// Its name.
    pub name: String,
    /// When it begins.
    pub time: Micros,
    /// What was on the screen then.
    pub screen: Buffer,
}

/// A line of the account.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Entry {
    /// Something was done.
    Done(&'static str, String),
    /// Something was claimed: whether it held, and what was found.
    Claimed(bool, String),
    /// A chapter began; its place among the markers.
    Marker(usize),
}

/// Plays a script.
///
/// `called` is how the system is called on the screen, `size` the screen where the script gives none.
///
/// # Errors
/// The mistakes of the script that only its system shows.
pub fn play(
    script: &Script,
    document: &Document,
    called: &str,
    size: (u16, u16),
) -> Result<Recording, Vec<Mistake>> {
    let size = script.head.size.unwrap_or(size);
    let mut player = Player::new(script, document, called, size)?;
    for (place, step) in &script.steps {
        player.step(place, step).map_err(|mistake| vec![mistake])?;
    }
    Ok(player.finish(script))
}

/// The most steps and rows of a motion in one frame. One too slow for its speed falls behind by the same amount on every
/// machine.
const BUDGET: u64 = 1_000_000;

/// The same where time runs as fast as it can.
const FLAT_OUT: u64 = 20_000;

/// How long a key is shown beside the caption.
const KEY_SHOWN: Micros = 1_200_000;

/// The most keys shown there.
const KEYS_SHOWN: usize = 6;

struct Player {
    app: App,
    look: Look,
    size: Size,
    /// Whether the last row is for captions.
    captions: bool,
    document: Document,
    called: String,
    catalog: Catalog,
    experiment: Option<Experiment>,
    epoch: u64,
    /// From where simulated time keeps pace: the frame, the time, the speed.
    base: (u64, f64, f64),
    clock: Clock,
    screen: Frames,
    pace: Micros,
    caption: String,
    keys: Vec<(String, usize, Micros)>,
    begun: bool,
    left: bool,
    events: Vec<(Micros, Event)>,
    markers: Vec<Marker>,
    log: Vec<(Micros, Entry)>,
    false_claims: Vec<Mistake>,
}

impl Player {
    fn new(
        script: &Script,
        document: &Document,
        called: &str,
        size: (u16, u16),
    ) -> Result<Player, Vec<Mistake>> {
        // the user's own presets are no part of a demo that is to be the same everywhere
        let catalog = Catalog::with_folder(None);
        let (app, effects) = App::new(&catalog, Some(called));
        let mut player = Player {
            app,
            look: script.head.look(),
            size: Size::new(size.0, size.1),
            captions: script.has_captions(),
            document: document.clone(),
            called: called.to_owned(),
            catalog,
            experiment: None,
            epoch: 0,
            base: (0, 0.0, 1.0),
            clock: Clock::new(script.head.fps),
            screen: Frames::new(false),
            pace: PACE,
            caption: String::new(),
            keys: Vec::new(),
            begun: false,
            left: false,
            events: Vec::new(),
            markers: Vec::new(),
            log: Vec::new(),
            false_claims: Vec::new(),
        };
        player.perform(effects);
        if player.app.lab.is_none() {
            let place = script.head.open.as_ref().map_or(0..0, |open| open.place.clone());
            let message = format!("`{called}` cannot be opened: it has mistakes");
            return Err(vec![Mistake::error(place, message)]);
        }
        Ok(player)
    }

    fn step(&mut self, place: &std::ops::Range<usize>, step: &Step) -> Result<(), Mistake> {
        if self.left {
            let message = "the lab was left before this line";
            return Err(Mistake::error(place.clone(), message));
        }
        match step {
            Step::Pace(time) => self.pace = *time,
            Step::Press(keys) => {
                self.note("press", keys_written(keys));
                for key in keys {
                    self.press(*key);
                }
            }
            Step::Type(text) => {
                self.note("type", text.clone());
                text.chars().for_each(|c| self.press(Key::plain(Code::Char(c))));
            }
            Step::Wait(time) => self.wait(*time),
            Step::Set(name, written) => {
                let target = self.target(name)?;
                let value = assertion::value(&self.app, written)?;
                self.note("set", format!("{} = {value}", name.text));
                self.set(target, value);
            }
            Step::Sweep { name, from, to, time } => {
                let target = self.target(name)?;
                let of = |text: &Text| assertion::value(&self.app, text);
                let from = match from {
                    Some(from) => of(from)?,
                    None => self.app.lab.as_ref().and_then(|lab| lab.value(target)).unwrap_or(0.0),
                };
                let to = of(to)?;
                self.note("sweep", format!("{} from {from} to {to}", name.text));
                self.sweep(target, (from, to), *time);
            }
            Step::Speed(written) => {
                let speed = assertion::value(&self.app, written)?;
                if speed <= 0.0 {
                    let message = format!("a speed is above zero; this is {speed}");
                    return Err(Mistake::error(written.place.clone(), message));
                }
                self.note("speed", format!("{speed}"));
                self.perform(vec![Effect::Tell(Command::Speed(speed))]);
            }
            Step::Caption(text) => {
                let room = Script::caption_room(self.size.width);
                if text.chars().count() > room {
                    let message = format!("a caption may have {room} characters at this size");
                    return Err(Mistake::error(place.clone(), message));
                }
                self.note("caption", text.clone());
                self.caption.clone_from(text);
            }
            Step::Marker(name) => {
                self.begin();
                let (time, screen) = (self.clock.now(), self.picture());
                self.events.push((time, Event::Marker(name.clone())));
                self.log.push((time, Entry::Marker(self.markers.len())));
                self.markers.push(Marker { name: name.clone(), time, screen });
            }
            Step::Assert(claim) => {
                let rows = rows(&self.picture());
                let finding = assertion::find(claim, &self.app, &rows)?;
                if !finding.holds {
                    let message = format!("this is false: {}", finding.sentence);
                    self.false_claims.push(Mistake::error(place.clone(), message));
                }
                let entry = Entry::Claimed(finding.holds, finding.sentence);
                self.log.push((self.clock.now(), entry));
            }
        }
        Ok(())
    }

    fn note(&mut self, what: &'static str, text: String) {
        self.log.push((self.clock.now(), Entry::Done(what, text)));
    }

    /// Which value a name means: a parameter, or an initial value.
    fn target(&self, name: &Text) -> Result<Target, Mistake> {
        let Some(lab) = &self.app.lab else {
            return Err(Mistake::error(name.place.clone(), "there is no system here"));
        };
        let parameters = (0..lab.count(Target::Parameter)).map(Target::Parameter);
        let targets = parameters.chain((0..lab.count(Target::Initial)).map(Target::Initial));
        let named: Vec<(Target, String)> =
            targets.filter_map(|t| Some((t, lab.facts(t)?.name))).collect();
        let found = named.iter().find(|(_, known)| *known == name.text).map(|(target, _)| *target);
        found.ok_or_else(|| {
            let names = named.iter().map(|(_, name)| name.as_str());
            let kind = "parameter or initial value";
            assertion::missing(kind, name, names, &self.called)
        })
    }

    fn set(&mut self, target: Target, value: f64) {
        self.perform(vec![Effect::Tell(match target {
            Target::Parameter(index) => Command::Parameter { index, value },
            Target::Initial(index) => Command::Initial { index, value },
        })]);
    }

    fn sweep(&mut self, target: Target, (from, to): (f64, f64), time: Micros) {
        self.begin();
        self.clock.pass(time);
        let count = self.clock.left();
        for frame in 1..=count {
            let part = frame as f64 / count as f64;
            self.set(target, if frame == count { to } else { from + (to - from) * part });
            self.frame();
        }
        if count == 0 {
            self.set(target, to);
        }
    }

    /// Presses a key, and gives it time to be seen.
    fn press(&mut self, key: Key) {
        if self.left {
            return;
        }
        self.show_key(key);
        let effects = self.app.update(crate::app::Event::Key(key));
        self.perform(effects);
        self.wait(self.pace);
    }

    /// The key stands beside the caption for a while; typed characters stand together.
    fn show_key(&mut self, key: Key) {
        let gone = self.clock.now().saturating_add(KEY_SHOWN);
        let shown = self.look.glyphs.text(&key.to_string()).into_owned();
        let typing = self.app.is_typing() && matches!(key.code, Code::Char(c) if c != ' ');
        match self.keys.last_mut() {
            Some((last, count, until)) if *last == shown && !typing => {
                *count += 1;
                *until = gone;
            }
            Some((last, 0, until)) if typing => {
                last.push_str(&shown);
                *until = gone;
            }
            _ => self.keys.push((shown, usize::from(!typing), gone)),
        }
    }

    fn wait(&mut self, time: Micros) {
        self.begin();
        self.clock.pass(time);
        while self.frame() {}
    }

    /// The first frame.
    fn begin(&mut self) {
        if !mem::replace(&mut self.begun, true) {
            self.draw();
        }
    }

    /// The next frame, if it is due.
    fn frame(&mut self) -> bool {
        let Some(elapsed) = self.clock.tick() else { return false };
        self.advance();
        self.keys.retain(|(_, _, until)| *until > self.clock.now());
        let keys = self.keys.len().saturating_sub(KEYS_SHOWN);
        self.keys.drain(..keys);
        self.happen(crate::app::Event::Tick(elapsed));
        self.look_at_motion();
        self.draw();
        true
    }

    /// Carries the motion on to where it should be at this frame.
    fn advance(&mut self) {
        let Some(experiment) = &mut self.experiment else { return };
        if experiment.status() != Status::Running {
            return;
        }
        let (frame, time, speed) = self.base;
        let now = self.clock.frame();
        let (target, budget) = if speed.is_finite() {
            (time + speed * self.clock.seconds(now - frame), BUDGET)
        } else {
            (f64::INFINITY, FLAT_OUT)
        };
        if experiment.advance(target, budget) != Progress::Arrived {
            self.base = (now, experiment.time(), speed);
        }
    }

    fn happen(&mut self, event: crate::app::Event) {
        let effects = self.app.update(event);
        self.perform(effects);
    }

    fn look_at_motion(&mut self) {
        if let Some(experiment) = &self.experiment {
            let snapshot = Arc::new(experiment.snapshot());
            self.happen(crate::app::Event::Snapshot(snapshot));
        }
    }

    /// Does what the application asks for.
    fn perform(&mut self, effects: Vec<Effect>) {
        for effect in effects {
            match effect {
                Effect::Tell(command) => self.tell(command),
                Effect::Load(name) => {
                    let loaded = self.load(name);
                    self.happen(crate::app::Event::Loaded(loaded));
                    self.look_at_motion();
                }
                Effect::Repaint => self.screen.forget(),
                Effect::Quit => self.left = true,
                // A demo has no terminal to be changed and no files to be written.
                _ => {}
            }
        }
    }

    fn tell(&mut self, command: Command) {
        let Some(experiment) = &mut self.experiment else { return };
        let clockwork = |e: &Experiment| (e.status() == Status::Running, e.time(), e.speed());
        let before = clockwork(experiment);
        experiment.obey(command);
        let after = clockwork(experiment);
        if after != before {
            self.base = (self.clock.frame(), after.1, after.2);
        }
        self.look_at_motion();
    }

    fn load(&mut self, name: String) -> Result<Loaded, LoadFailure> {
        let found = if name == self.called {
            Ok(self.document.clone())
        } else {
            self.catalog.find(&name).map_err(|why| why.to_string())
        };
        let ready = found.and_then(|document| Ready::of(&document).map_err(|why| why.report));
        match ready {
            Err(message) => Err(LoadFailure { name, message }),
            Ok(Ready { model, equations, system, mut experiment, document }) => {
                self.epoch += 1;
                experiment.set_epoch(self.epoch);
                self.base = (self.clock.frame(), experiment.time(), experiment.speed());
                self.experiment = Some(experiment);
                Ok(Loaded { name, epoch: self.epoch, model, equations, system, document })
            }
        }
    }

    /// Shows the present as a frame.
    fn draw(&mut self) {
        let Self { app, look, captions, caption, keys, screen, .. } = self;
        let mut drawn = crate::app::Drawn::default();
        let bytes = screen.next(self.size, |area, buffer| {
            drawn = paint(app, look, *captions, (caption, keys), area, buffer);
        });
        if !bytes.is_empty() {
            let text = String::from_utf8_lossy(&bytes).into_owned();
            self.events.push((self.clock.now(), Event::Output(text)));
        }
        self.happen(crate::app::Event::Drawn(drawn));
    }

    /// The screen as it would be drawn now.
    fn picture(&self) -> Buffer {
        let area = Rect::from(self.size);
        let mut buffer = Buffer::empty(area);
        let below = (self.caption.as_str(), self.keys.as_slice());
        paint(&self.app, &self.look, self.captions, below, area, &mut buffer);
        buffer
    }

    fn finish(mut self, script: &Script) -> Recording {
        self.begin();
        let last = self.screen.shown().cloned().unwrap_or_default();
        let of_system = || {
            let lab = self.app.lab.as_ref();
            lab.map_or_else(|| self.called.clone(), |lab| lab.loaded.model.info.title.clone())
        };
        Recording {
            title: script.head.title.clone().unwrap_or_else(of_system),
            size: (self.size.width, self.size.height),
            fps: script.head.fps,
            frames: self.clock.frame(),
            end: self.clock.now(),
            look: self.look,
            events: self.events,
            markers: self.markers,
            last,
            log: self.log,
            false_claims: self.false_claims,
        }
    }
}

/// Draws the lab, and the caption below it.
fn paint(
    app: &App,
    look: &Look,
    captions: bool,
    (text, keys): (&str, &[(String, usize, Micros)]),
    area: Rect,
    buffer: &mut Buffer,
) -> crate::app::Drawn {
    let height = area.height - u16::from(captions);
    let drawn = view::draw(app, look, Rect { height, ..area }, buffer);
    if captions {
        let row = Rect { y: area.y + height, height: 1, ..area };
        let keys: Vec<String> = keys
            .iter()
            .map(|(key, count, _)| if *count > 1 { format!("{key} x{count}") } else { key.clone() })
            .collect();
        caption::draw(look, &Caption { text, keys: &keys }, row, buffer);
    }
    plain(buffer);
    drawn
}

/// The screen's rows as text.
pub(super) fn rows(screen: &Buffer) -> Vec<String> {
    let row = |y: u16| -> String {
        let area = screen.area;
        let cells = (area.left()..area.right()).map(|x| screen[(x, y)].symbol());
        cells.collect::<String>().trim_end().to_owned()
    };
    (screen.area.top()..screen.area.bottom()).map(row).collect()
}

/// Keys as they are written in a script.
fn keys_written(keys: &[Key]) -> String {
    let mut written: Vec<(String, usize)> = Vec::new();
    for key in keys {
        let key = key.to_string();
        match written.last_mut() {
            Some((last, count)) if *last == key => *count += 1,
            _ => written.push((key, 1)),
        }
    }
    let words = written.iter().map(|(key, count)| match count {
        1 => key.clone(),
        count => format!("{key} x{count}"),
    });
    words.collect::<Vec<_>>().join(" ")
}

/// Time in an account: seconds with hundredths.
pub(super) fn seconds(time: Micros) -> String {
    format!("{:.2}", Duration::from_micros(time).as_secs_f64())
}
