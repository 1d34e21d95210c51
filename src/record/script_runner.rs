//! A performance: a script on its way, frame by frame, in the laboratory on virtual time.
//!
//! In: a [`Script`] and the system it is about. Out: what happens next, one [`RunnerEvent`] at a time, and the screen as it is
//! then. Whoever asks for the beats decides whether they come as fast as they can (a recording) or as time passes (a demo
//! on a terminal). Never here: a cast, a clock, a terminal.

use std::ops::Range;
use std::{mem, vec};

use ratatui::buffer::Buffer;
use ratatui::layout::{Rect, Size};

use super::assertion::{self, Finding};
use super::clock::Micros;
use super::headless_lab::{Budget, HeadlessLab};
use super::plain::plain;
use super::script::{Assert, PACE, Script, Step, SweepPath, Text};
use crate::app::{Code, Drawn, Event, Key, ValueId};
use crate::diagnostic::{Diagnostic, Document};
use crate::experiment::Command;
use crate::view::caption::{self, Caption};
use crate::view::{self, RenderStyle};

/// How long a key is shown beside the caption.
const KEY_SHOWN: Micros = 1_200_000;

/// The most keys shown there.
const KEYS_SHOWN: usize = 6;

/// The most rows a caption takes on a screen narrower than the one it was written for.
const CAPTION_ROWS: u16 = 3;

/// A script being performed.
pub struct ScriptRunner {
    pub(super) lab: HeadlessLab,
    script: Script,
    /// The step that comes next.
    next: usize,
    under_way: UnderWay,
    /// Time passes, or something else needs a first picture.
    begins: bool,
    begun: bool,
    pace: Micros,
    caption: String,
    keys: Vec<ShownKey>,
    /// The size of the screen when it was last drawn.
    size: Size,
}

/// What of a step is still to be done.
enum UnderWay {
    Nothing,
    Keys(vec::IntoIter<Key>),
    Sweep { courses: Vec<Course>, frame: u64, count: u64 },
}

/// A value on its way, from one number to another.
#[derive(Clone, Copy)]
struct Course {
    target: ValueId,
    from: f64,
    to: f64,
}

/// A key beside the caption: its name, how often it was pressed (0 for typed text), until when it is shown.
struct ShownKey {
    name: String,
    count: usize,
    until: Micros,
}

/// What happens next in a performance.
pub(super) enum RunnerEvent {
    /// A frame has come and is to be drawn.
    Frame,
    /// Something was done.
    Done(&'static str, String),
    /// Something is claimed there; [`ScriptRunner::find`] says what to think of it.
    Claim(Range<usize>, Assert),
    /// A chapter begins.
    Marker(String),
    /// It is over.
    Overlay,
}

impl ScriptRunner {
    /// At its beginning, on a screen of some size; `called` is how the system is called on the screen.
    pub(super) fn new(
        script: Script,
        document: &Document,
        called: &str,
        size: Size,
        budget: Budget,
    ) -> Result<ScriptRunner, Diagnostic> {
        let lab = HeadlessLab::open(document, called, script.head.fps, budget);
        if lab.app.lab.is_none() {
            let place = script.head.open.as_ref().map_or(0..0, |open| open.place.clone());
            let message = format!("`{called}` cannot be opened: it has mistakes");
            return Err(Diagnostic::error(place, message));
        }
        Ok(ScriptRunner {
            lab,
            script,
            next: 0,
            under_way: UnderWay::Nothing,
            begins: false,
            begun: false,
            pace: PACE,
            caption: String::new(),
            keys: Vec::new(),
            size,
        })
    }

    /// A performance for someone who watches.
    ///
    /// # Errors
    /// The mistake by which the system cannot be opened.
    pub fn watched(
        script: Script,
        document: &Document,
        called: &str,
    ) -> Result<ScriptRunner, Diagnostic> {
        let size = script.head.size.unwrap_or((80, 24));
        ScriptRunner::new(script, document, called, size.into(), Budget::WATCHED)
    }

    /// Goes on until so much time has passed since the beginning; whether there is more to come. What is claimed on the
    /// way is not looked at: on another screen than its own a demo may show less.
    ///
    /// # Errors
    /// The mistake of the script that only its system shows.
    pub fn go_on(&mut self, time: Micros) -> Result<bool, Diagnostic> {
        while !self.begun || self.lab.clock.next() <= time {
            if matches!(self.beat()?, RunnerEvent::Overlay) {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// When the frame that is shown came.
    pub fn now(&self) -> Micros {
        self.lab.now()
    }

    /// Does what comes next.
    pub(super) fn beat(&mut self) -> Result<RunnerEvent, Diagnostic> {
        loop {
            if self.begins && !self.begun {
                self.begun = true;
                return Ok(RunnerEvent::Frame);
            }
            if self.lab.clock.left() > 0 {
                self.frame();
                if let Some(why) = self.lab.overdue() {
                    let step = self.next.saturating_sub(1);
                    let place = self.script.steps.get(step).map_or(0..0, |step| step.0.clone());
                    return Err(Diagnostic::error(place, why));
                }
                return Ok(RunnerEvent::Frame);
            }
            match &mut self.under_way {
                UnderWay::Keys(keys) => match keys.next() {
                    Some(key) => self.press(key),
                    None => self.under_way = UnderWay::Nothing,
                },
                // no frame was left for it
                UnderWay::Sweep { courses, .. } => {
                    let courses = mem::take(courses);
                    self.carry(&courses, 1.0);
                    self.end_sweep();
                }
                UnderWay::Nothing => {
                    if let Some(beat) = self.step()? {
                        return Ok(beat);
                    }
                }
            }
        }
    }

    /// Begins the next step of the script.
    fn step(&mut self) -> Result<Option<RunnerEvent>, Diagnostic> {
        let Some((place, step)) = self.script.steps.get(self.next).cloned() else {
            // what never showed anything shows its first picture
            self.begins = true;
            return Ok(self.begun.then_some(RunnerEvent::Overlay));
        };
        if self.lab.left {
            return Err(Diagnostic::error(place, "the lab was left before this line"));
        }
        if matches!(step, Step::Marker(_)) && !self.begun {
            self.begins = true;
            return Ok(None);
        }
        self.next += 1;
        self.take(place, step)
    }

    fn take(&mut self, place: Range<usize>, step: Step) -> Result<Option<RunnerEvent>, Diagnostic> {
        let done = |what, text| Ok(Some(RunnerEvent::Done(what, text)));
        match step {
            Step::Pace(time) => {
                self.pace = time;
                Ok(None)
            }
            Step::Press(keys) => {
                let written = keys_written(&keys);
                self.under_way = UnderWay::Keys(keys.into_iter());
                done("press", written)
            }
            Step::Type(text) => {
                let keys: Vec<Key> = text.chars().map(|c| Key::plain(Code::Char(c))).collect();
                self.under_way = UnderWay::Keys(keys.into_iter());
                done("type", text)
            }
            Step::Wait(time) => {
                self.pass(time);
                Ok(None)
            }
            Step::Set(name, written) => {
                let target = self.target(&name)?;
                let value = assertion::value(&self.lab.app, &written)?;
                self.lab.set(target, value);
                done("set", format!("{} = {value}", name.text))
            }
            Step::Sweep { ways, time } => {
                let courses =
                    ways.iter().map(|way| self.course(way)).collect::<Result<Vec<_>, _>>()?;
                let told = ways.iter().zip(&courses).map(|(way, Course { from, to, .. })| {
                    format!("{} from {from} to {to}", way.name.text)
                });
                let told = told.collect::<Vec<_>>().join(", ");
                self.lab.app.hold_on();
                self.pass(time);
                let count = self.lab.clock.left();
                self.under_way = UnderWay::Sweep { courses, frame: 0, count };
                done("sweep", told)
            }
            Step::Speed(written) => {
                let speed = assertion::value(&self.lab.app, &written)?;
                if speed <= 0.0 {
                    let message = format!("a speed is above zero; this is {speed}");
                    return Err(Diagnostic::error(written.place, message));
                }
                self.lab.tell(Command::Speed(speed));
                done("speed", format!("{speed}"))
            }
            Step::Caption(text) => {
                self.caption.clone_from(&text);
                done("caption", text)
            }
            Step::Marker(name) => Ok(Some(RunnerEvent::Marker(name))),
            Step::Assert(claim) => Ok(Some(RunnerEvent::Claim(place, claim))),
        }
    }

    /// What is to be thought of a claim now.
    pub(super) fn find(&self, claim: &Assert, screen: &[String]) -> Result<Finding, Diagnostic> {
        assertion::find(claim, &self.lab.app, screen)
    }

    /// Which value a name means: a parameter, or an initial value.
    fn target(&self, name: &Text) -> Result<ValueId, Diagnostic> {
        let Some(lab) = &self.lab.app.lab else {
            return Err(Diagnostic::error(name.place.clone(), "there is no system here"));
        };
        let parameters = (0..lab.count(ValueId::Parameter)).map(ValueId::Parameter);
        let targets = parameters.chain((0..lab.count(ValueId::Initial)).map(ValueId::Initial));
        let named: Vec<(ValueId, String)> =
            targets.filter_map(|t| Some((t, lab.facts(t)?.name))).collect();
        let found = named.iter().find(|(_, known)| *known == name.text).map(|(target, _)| *target);
        found.ok_or_else(|| {
            let names = named.iter().map(|(_, name)| name.as_str());
            let kind = "parameter or initial value";
            assertion::missing(kind, name, names, &self.lab.called)
        })
    }

    /// What goes from where to where.
    fn course(&self, way: &SweepPath) -> Result<Course, Diagnostic> {
        let target = self.target(&way.name)?;
        let of = |text: &Text| assertion::value(&self.lab.app, text);
        let present = || self.lab.app.lab.as_ref().and_then(|lab| lab.value(target));
        let from = match &way.from {
            Some(from) => of(from)?,
            None => present().unwrap_or(0.0),
        };
        Ok(Course { target, from, to: of(&way.to)? })
    }

    /// Puts values at a part of their ways.
    fn carry(&mut self, courses: &[Course], part: f64) {
        for &Course { target, from, to } in courses {
            self.lab.set(target, if part < 1.0 { from + (to - from) * part } else { to });
        }
    }

    /// All that it carried is there; a key would take it back as one.
    fn end_sweep(&mut self) {
        self.under_way = UnderWay::Nothing;
        self.lab.app.drop_hold();
    }

    /// Lets time pass; its frames are the next beats.
    fn pass(&mut self, time: Micros) {
        self.begins = true;
        self.lab.clock.pass(time);
    }

    /// Presses a key, and gives it time to be seen.
    fn press(&mut self, key: Key) {
        if self.lab.left {
            return;
        }
        self.show_key(key);
        self.lab.happen(Event::Key(key));
        self.pass(self.pace);
    }

    /// The key stands beside the caption for a while; typed characters stand together.
    fn show_key(&mut self, key: Key) {
        let until = self.lab.now().saturating_add(KEY_SHOWN);
        let typing = self.lab.app.is_typing() && matches!(key.code, Code::Char(c) if c != ' ');
        let name = key.to_string();
        match self.keys.last_mut() {
            Some(last) if last.name == name && !typing => {
                last.count += 1;
                last.until = until;
            }
            Some(last) if typing && last.count == 0 => {
                last.name.push_str(&name);
                last.until = until;
            }
            _ => self.keys.push(ShownKey { name, count: usize::from(!typing), until }),
        }
    }

    /// Goes on by one frame.
    fn frame(&mut self) {
        if let UnderWay::Sweep { courses, frame, count } = &mut self.under_way {
            *frame += 1;
            let (courses, part) = (courses.clone(), *frame as f64 / *count as f64);
            self.carry(&courses, part);
            if part >= 1.0 {
                self.end_sweep();
            }
        }
        self.lab.tick();
        let now = self.lab.now();
        self.keys.retain(|key| key.until > now);
        let surplus = self.keys.len().saturating_sub(KEYS_SHOWN);
        self.keys.drain(..surplus);
    }

    /// Draws the present, and tells the application what became of it.
    pub fn draw(&mut self, look: &RenderStyle, area: Rect, buffer: &mut Buffer) -> Drawn {
        self.size = area.as_size();
        let drawn = self.paint(look, area, buffer);
        self.lab.happen(Event::Drawn(drawn));
        drawn
    }

    /// Holds time, or lets it go on: what is shown says so.
    pub fn hold(&mut self, held: bool) {
        self.lab.app.held = held;
    }

    /// The screen as it would be drawn now.
    pub fn picture(&self, look: &RenderStyle) -> Buffer {
        let area = Rect::from(self.size);
        let mut buffer = Buffer::empty(area);
        self.paint(look, area, &mut buffer);
        buffer
    }

    /// Draws the lab, and the caption below it.
    fn paint(&self, look: &RenderStyle, area: Rect, buffer: &mut Buffer) -> Drawn {
        let rows = self.caption_rows(area.width).min(area.height);
        let height = area.height - rows;
        let drawn = view::draw(&self.lab.app, look, Rect { height, ..area }, buffer);
        if rows > 0 {
            let below = Rect { y: area.y + height, height: rows, ..area };
            let written = |key: &ShownKey| match key.count {
                0 | 1 => key.name.clone(),
                count => format!("{} x{count}", key.name),
            };
            let keys: Vec<String> = self.keys.iter().map(written).collect();
            caption::draw(look, &Caption { text: &self.caption, keys: &keys }, below, buffer);
        }
        plain(buffer);
        drawn
    }

    /// How many rows are kept for captions, the same from beginning to end.
    fn caption_rows(&self, width: u16) -> u16 {
        let texts = self.script.steps.iter().filter_map(|(_, step)| match step {
            Step::Caption(text) => Some(text.as_str()),
            _ => None,
        });
        texts.map(|text| caption::rows(text, width)).max().unwrap_or(0).min(CAPTION_ROWS)
    }
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
