//! A script being performed, frame by frame, in the laboratory on virtual time.
//!
//! In: a [`Script`] and its system. Out: the next [`RunnerEvent`], one at a time, and the screen at that point. The
//! caller decides whether the events come as fast as possible (a recording) or as time passes (a demo on a terminal).
//! Never here: a cast, a clock, a terminal.

use std::ops::Range;
use std::{mem, vec};

use crossterm::event::{KeyCode, KeyEvent};
use ratatui::buffer::Buffer;
use ratatui::layout::{Rect, Size};

use super::assertion::{self, AssertionResult};
use super::clock::Micros;
use super::headless_lab::{Budget, HeadlessLab};
use super::plain::plain;
use super::script::{Assert, LessonStep, LineText, PACE, Script, ScriptStep, SweepPath};
use super::shown_keys::ShownKeys;
use crate::app::{AppEvent, Drawn, LeastRange, ValueId, key};
use crate::diagnostic::{Diagnostic, Document};
use crate::experiment::Command;
use crate::view::caption::{self, Caption};
use crate::view::{Painter, RenderStyle};

/// The most rows of a caption on a screen narrower than the one it was written for.
const CAPTION_ROWS: u16 = 3;

/// A script being performed.
pub struct ScriptRunner {
    pub(super) lab: HeadlessLab,
    pub(super) script: Script,
    pub(super) next: usize,
    under_way: PartialStep,
    /// Whether a first picture is due, because time passes or something else needs it.
    begins: bool,
    begun: bool,
    pace: Micros,
    caption: String,
    /// The least ranges of quantities in the pictures.
    least_ranges: Vec<LeastRange>,
    pub(super) keys: ShownKeys,
    /// The size of the screen when it was last drawn.
    pub(super) size: Size,
    painter: Painter,
}

enum PartialStep {
    Nothing,
    Keys(vec::IntoIter<KeyEvent>),
    Sweep { courses: Vec<ValueRamp>, frame: u64, count: u64 },
}

/// A value that moves from one number to another.
#[derive(Clone, Copy)]
struct ValueRamp {
    target: ValueId,
    from: f64,
    to: f64,
}

pub(super) enum RunnerEvent {
    /// A frame is due and is to be drawn.
    Frame,
    Done(&'static str, String),
    /// An assertion at this range; [`ScriptRunner::find`] evaluates it.
    Claim(Range<usize>, Assert),
    /// A chapter begins.
    Marker(String),
    /// A line of a lesson, which waits for a person.
    Lesson(Range<usize>, LessonStep),
    /// The performance has ended.
    Overlay,
}

impl ScriptRunner {
    /// Starts at the beginning, on a screen of some size; `called` is the system's name on the screen.
    pub(super) fn new(
        script: Script,
        document: &Document,
        called: &str,
        size: Size,
        budget: Budget,
    ) -> Result<ScriptRunner, Diagnostic> {
        let mut lab = HeadlessLab::open(document, called, script.head.fps, budget);
        lab.app.footer.shown = script.head.footer;
        if lab.app.lab.is_none() {
            let place = script.head.open.as_ref().map_or(0..0, |open| open.place.clone());
            let message = format!("`{called}` cannot be opened: it has errors");
            return Err(Diagnostic::error(place, message));
        }
        Ok(ScriptRunner {
            lab,
            script,
            next: 0,
            under_way: PartialStep::Nothing,
            begins: false,
            begun: false,
            pace: PACE,
            caption: String::new(),
            least_ranges: Vec::new(),
            keys: ShownKeys::default(),
            size,
            painter: Painter::default(),
        })
    }

    /// Starts a live performance.
    ///
    /// # Errors
    /// Returns the error for which the system cannot be opened.
    pub fn watched(
        script: Script,
        document: &Document,
        called: &str,
    ) -> Result<ScriptRunner, Diagnostic> {
        let size = script.head.size.unwrap_or((80, 24));
        ScriptRunner::new(script, document, called, size.into(), Budget::WATCHED)
    }

    /// Advances to this time since the beginning; returns whether there is more. Assertions are skipped, because a
    /// demo may show less on a screen of another size.
    ///
    /// # Errors
    /// Returns an error of the script that only its system reveals.
    pub fn continue_to(&mut self, time: Micros) -> Result<bool, Diagnostic> {
        while !self.begun || self.lab.clock.next() <= time {
            match self.next_event()? {
                RunnerEvent::Overlay => return Ok(false),
                RunnerEvent::Lesson(place, _) => return Err(waits(place)),
                _ => {}
            }
        }
        Ok(true)
    }

    /// The time of the current frame.
    pub fn now(&self) -> Micros {
        self.lab.now()
    }

    pub(super) fn next_event(&mut self) -> Result<RunnerEvent, Diagnostic> {
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
                PartialStep::Keys(keys) => match keys.next() {
                    Some(key) => self.press(key),
                    None => self.under_way = PartialStep::Nothing,
                },
                // no frame was left for it
                PartialStep::Sweep { courses, .. } => {
                    let courses = mem::take(courses);
                    self.carry(&courses, 1.0);
                    self.end_sweep();
                }
                PartialStep::Nothing => {
                    if let Some(next_event) = self.step()? {
                        return Ok(next_event);
                    }
                }
            }
        }
    }

    fn step(&mut self) -> Result<Option<RunnerEvent>, Diagnostic> {
        let Some((place, step)) = self.script.steps.get(self.next).cloned() else {
            // a script that has not shown anything draws its first picture
            self.begins = true;
            return Ok(self.begun.then_some(RunnerEvent::Overlay));
        };
        if self.lab.left {
            return Err(Diagnostic::error(place, "the lab was left before this line"));
        }
        if matches!(step, ScriptStep::Marker(_)) && !self.begun {
            self.begins = true;
            return Ok(None);
        }
        self.next += 1;
        self.take(place, step)
    }

    fn take(
        &mut self,
        place: Range<usize>,
        step: ScriptStep,
    ) -> Result<Option<RunnerEvent>, Diagnostic> {
        let done = |what, text| Ok(Some(RunnerEvent::Done(what, text)));
        match step {
            ScriptStep::Pace(time) => {
                self.pace = time;
                Ok(None)
            }
            ScriptStep::Press(keys) => {
                let written = ShownKeys::of(&keys).written().join(" ");
                self.under_way = PartialStep::Keys(keys.into_iter());
                done("press", written)
            }
            ScriptStep::Type(text) => {
                let keys: Vec<KeyEvent> = text.chars().map(key::character).collect();
                self.under_way = PartialStep::Keys(keys.into_iter());
                done("type", text)
            }
            ScriptStep::Wait(time) => {
                self.pass(time);
                Ok(None)
            }
            ScriptStep::Set(name, written) => {
                let target = self.target(&name)?;
                let value = assertion::value(&self.lab.app, &written)?;
                self.lab.set(target, value);
                done("set", format!("{} = {value}", name.text))
            }
            ScriptStep::Sweep { ways, time } => {
                let courses =
                    ways.iter().map(|way| self.course(way)).collect::<Result<Vec<_>, _>>()?;
                let moves = ways.iter().zip(&courses).map(|(way, ValueRamp { from, to, .. })| {
                    format!("{} from {from} to {to}", way.name.text)
                });
                let moves = moves.collect::<Vec<_>>().join(", ");
                self.lab.app.begin_group();
                self.pass(time);
                let count = self.lab.clock.left();
                self.under_way = PartialStep::Sweep { courses, frame: 0, count };
                done("sweep", moves)
            }
            ScriptStep::Speed(written) => {
                let speed = assertion::value(&self.lab.app, &written)?;
                if speed <= 0.0 {
                    let message = format!("a speed must be above zero; this is {speed}");
                    return Err(Diagnostic::error(written.place, message));
                }
                self.lab.execute(Command::Speed(speed));
                done("speed", format!("{speed}"))
            }
            ScriptStep::ScrubTo(written) => {
                let time = assertion::value(&self.lab.app, &written)?;
                self.lab.execute(Command::ScrubTo(time));
                done("look", format!("{time}"))
            }
            ScriptStep::Focus(name) => {
                if !self.lab.app.focus_on(&name.text) {
                    let names = self.lab.app.names_of_panes().into_iter();
                    return Err(assertion::missing("pane", &name, names, &self.lab.called));
                }
                done("focus", name.text)
            }
            ScriptStep::Extent(written) => {
                let app = &self.lab.app;
                let mut ranges: Vec<LeastRange> = Vec::new();
                for (of, ends) in &written {
                    let channel = Some(assertion::shown_channel(app, of)?);
                    if let Some(first) = ranges.iter().position(|range| range.channel == channel) {
                        let message = format!("`{}` has two ranges", of.text);
                        let first = written[first].0.place.clone();
                        return Err(Diagnostic::error(of.place.clone(), message)
                            .with_also(first, "its range is given here already"));
                    }
                    let range = assertion::range(app, ends)?;
                    ranges.push(LeastRange { of: of.text.clone(), range, channel });
                }
                self.least_ranges = ranges;
                self.set_least_ranges();
                let names: Vec<_> = written.iter().map(|(of, _)| of.text.as_str()).collect();
                done("extent", names.join(", "))
            }
            ScriptStep::Caption(text) => {
                self.caption.clone_from(&text);
                done("caption", text)
            }
            ScriptStep::Marker(name) => Ok(Some(RunnerEvent::Marker(name))),
            ScriptStep::Assert(claim) => Ok(Some(RunnerEvent::Claim(place, claim))),
            ScriptStep::Lesson(step) => Ok(Some(RunnerEvent::Lesson(place, step))),
        }
    }

    pub(super) fn set_least_ranges(&mut self) {
        if let Some(lab) = &mut self.lab.app.lab {
            lab.set_least_ranges(self.least_ranges.clone());
        }
    }

    /// Evaluates an assertion now.
    pub(super) fn find(
        &self,
        claim: &Assert,
        screen: &[String],
    ) -> Result<AssertionResult, Diagnostic> {
        assertion::find(claim, &self.lab.app, screen)
    }

    /// The value that a name refers to: a parameter or an initial value.
    fn target(&self, name: &LineText) -> Result<ValueId, Diagnostic> {
        let Some(lab) = &self.lab.app.lab else {
            return Err(Diagnostic::error(name.place.clone(), "there is no system here"));
        };
        let parameters = (0..lab.count(ValueId::Parameter)).map(ValueId::Parameter);
        let targets = parameters.chain((0..lab.count(ValueId::Initial)).map(ValueId::Initial));
        let named: Vec<(ValueId, String)> =
            targets.filter_map(|t| Some((t, lab.value_info(t)?.name))).collect();
        let found = named.iter().find(|(_, known)| *known == name.text).map(|(target, _)| *target);
        found.ok_or_else(|| {
            let names = named.iter().map(|(_, name)| name.as_str());
            let kind = "parameter or initial value";
            assertion::missing(kind, name, names, &self.lab.called)
        })
    }

    fn course(&self, way: &SweepPath) -> Result<ValueRamp, Diagnostic> {
        let target = self.target(&way.name)?;
        let of = |text: &LineText| assertion::value(&self.lab.app, text);
        let present = || self.lab.app.lab.as_ref().and_then(|lab| lab.value(target));
        let from = match &way.from {
            Some(from) => of(from)?,
            None => present().unwrap_or(0.0),
        };
        Ok(ValueRamp { target, from, to: of(&way.to)? })
    }

    /// Sets the values at a fraction of their courses.
    fn carry(&mut self, courses: &[ValueRamp], part: f64) {
        for &ValueRamp { target, from, to } in courses {
            self.lab.set(target, if part < 1.0 { from + (to - from) * part } else { to });
        }
    }

    /// Ends a sweep, after which undo reverts all of it at once.
    fn end_sweep(&mut self) {
        self.under_way = PartialStep::Nothing;
        self.lab.app.end_group();
    }

    /// Lets time pass; its frames are the next events.
    fn pass(&mut self, time: Micros) {
        self.begins = true;
        self.lab.clock.pass(time);
    }

    /// Presses a key and gives it time to be seen.
    fn press(&mut self, key: KeyEvent) {
        if self.lab.left {
            return;
        }
        let typing = self.lab.app.is_typing() && matches!(key.code, KeyCode::Char(c) if c != ' ');
        self.keys.press(&key, typing, self.lab.now());
        self.lab.update(AppEvent::Key(key));
        self.pass(self.pace);
    }

    pub(super) fn frame(&mut self) {
        if let PartialStep::Sweep { courses, frame, count } = &mut self.under_way {
            *frame += 1;
            let (courses, part) = (courses.clone(), *frame as f64 / *count as f64);
            self.carry(&courses, part);
            if part >= 1.0 {
                self.end_sweep();
            }
        }
        self.lab.tick();
        self.keys.pass(self.lab.now());
    }

    /// Draws the current state, and reports the result to the application.
    pub fn draw(&mut self, style: &RenderStyle, area: Rect, buffer: &mut Buffer) -> Drawn {
        self.size = area.as_size();
        let mut painter = std::mem::take(&mut self.painter);
        let drawn = self.paint(&mut painter, style, area, buffer);
        self.painter = painter;
        self.lab.update(AppEvent::Drawn(drawn.clone()));
        drawn
    }

    /// Pauses or resumes time; the screen shows which.
    pub fn suspend(&mut self, suspended: bool) {
        self.lab.app.suspended = suspended;
    }

    /// The screen as it would be drawn now.
    pub fn picture(&self, style: &RenderStyle) -> Buffer {
        let area = Rect::from(self.size);
        let mut buffer = Buffer::empty(area);
        self.paint(&mut Painter::default(), style, area, &mut buffer);
        buffer
    }

    /// Draws the lab, and the caption below it.
    pub(super) fn paint(
        &self,
        painter: &mut Painter,
        style: &RenderStyle,
        area: Rect,
        buffer: &mut Buffer,
    ) -> Drawn {
        let rows = self.caption_rows(area.width).min(area.height);
        let height = area.height - rows;
        let drawn = painter.draw(&self.lab.app, style, Rect { height, ..area }, buffer);
        if rows > 0 {
            let below = Rect { y: area.y + height, height: rows, ..area };
            let keys = self.keys.written();
            caption::draw(style, &Caption { text: &self.caption, keys: &keys }, below, buffer);
        }
        plain(buffer);
        drawn
    }

    /// The number of rows reserved for captions, constant throughout.
    pub(super) fn caption_rows(&self, width: u16) -> u16 {
        let texts = self.script.steps.iter().filter_map(|(_, step)| match step {
            ScriptStep::Caption(text) => Some(text.as_str()),
            _ => None,
        });
        texts.map(|text| caption::rows(text, width)).max().unwrap_or(0).min(CAPTION_ROWS)
    }
}

/// A line of a lesson where nobody could answer.
pub(super) fn waits(place: Range<usize>) -> Diagnostic {
    let message = "this line belongs to a lesson, which waits for a person";
    Diagnostic::error(place, message).with_help("use `phaselab lessons`, or `lesson check`")
}
