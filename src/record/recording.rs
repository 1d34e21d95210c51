//! Recordings: a complete performance of a script.
//!
//! In: a [`Script`], a document. Out: a [`Recording`], or the errors that only playing reveals. Never here: what a
//! line of a script does, or the format of a cast.

use std::io;
use std::ops::ControlFlow;
use std::time::Duration;

use ratatui::buffer::Buffer;
use ratatui::layout::Size;

use super::clock::Micros;
use super::headless_lab::Budget;
use super::script::{Script, ScriptStep};
use super::script_runner::{RunnerEvent, ScriptRunner, waits};
use crate::diagnostic::{Diagnostic, Document};
use crate::view::RenderStyle;
use crate::view::colour::ColourDepth;
use crate::view::frame::Frames;

/// A recorded performance.
#[derive(Clone, Debug)]
pub struct Recording {
    /// What the header of the cast says.
    pub title: String,
    /// Columns and rows.
    pub size: (u16, u16),
    /// Frames per second.
    pub fps: u32,
    /// The number of frames; the duration is `frames / fps`.
    pub frames: u64,
    /// The time of the end.
    pub end: Micros,
    /// The render style.
    pub style: RenderStyle,
    /// The timed output: bytes for a terminal and names of chapters.
    pub events: Vec<(Micros, RecordingEvent)>,
    /// The chapters.
    pub markers: Vec<ChapterMarker>,
    /// The screen at the end.
    pub last: Buffer,
    /// The same as it is drawn without colours.
    pub last_colourless: Buffer,
    /// The actions and assertions.
    pub log: Vec<(Micros, TranscriptEntry)>,
    /// The assertions that failed.
    pub false_claims: Vec<Diagnostic>,
}

/// What happens at one time while a script is recorded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RecordingEvent {
    /// Text for the terminal.
    Output(String),
    /// A chapter begins.
    Marker(String),
}

/// A place in a recording to which a player can jump.
#[derive(Clone, Debug)]
pub struct ChapterMarker {
    /// As a player lists it.
    pub name: String,
    /// The time of its beginning.
    pub time: Micros,
    /// The screen at that time.
    pub screen: Buffer,
    /// The same as it is drawn without colours.
    pub colourless: Buffer,
}

/// An entry of the transcript of a script that was run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TranscriptEntry {
    /// An action.
    Done(&'static str, String),
    /// An assertion: whether it was true, and a sentence with the values.
    Claimed(bool, String),
    /// The beginning of a chapter, with its index among the markers.
    Marker(usize),
}

/// What is there of a recording while it is made.
#[derive(Clone, Copy, Debug)]
pub struct RecordingSoFar<'a> {
    /// The events that are new.
    pub new: &'a [(Micros, RecordingEvent)],
    /// The time that is reached.
    pub reached: Micros,
    /// The number of assertions that were checked.
    pub claims: usize,
    /// Those that failed.
    pub false_claims: &'a [Diagnostic],
}

/// Plays a script.
///
/// `called` is the system's name on the screen; `size` is the screen size if the script does not give one.
///
/// # Errors
/// Returns the errors of the script that only its system and its screen reveal.
pub fn play(
    script: &Script,
    document: &Document,
    called: &str,
    size: (u16, u16),
) -> Result<Recording, Vec<Diagnostic>> {
    let mut whole = |_: RecordingSoFar<'_>| ControlFlow::Continue(());
    play_while(script, document, (called, size), &mut whole).map(|(recording, _)| recording)
}

/// Plays a script like [`play`], and hands over what is new as it comes, as long as that is
/// wanted. Returns also whether the script was played to its end.
///
/// # Errors
/// Returns the errors of the script that only its system and its screen reveal.
pub fn play_while(
    script: &Script,
    document: &Document,
    (called, size): (&str, (u16, u16)),
    wanted: &mut dyn FnMut(RecordingSoFar<'_>) -> ControlFlow<()>,
) -> Result<(Recording, bool), Vec<Diagnostic>> {
    let size = script.head.size.unwrap_or(size);
    let diagnostics = too_long(script, size.0);
    if !diagnostics.is_empty() {
        return Err(diagnostics);
    }
    let area = Size::from(size);
    let (fps, title) = (script.head.fps, script.head.title.clone());
    let alone = |diagnostic| vec![diagnostic];
    let performance = ScriptRunner::new(script.clone(), document, called, area, Budget::RECORDED);
    let mut take = Take {
        performance: performance.map_err(alone)?,
        screen: Frames::new(false).map_err(|why| alone(unwritten(&why)))?,
        style: script.head.render_style(),
        area,
        events: Vec::new(),
        markers: Vec::new(),
        log: Vec::new(),
        claims: 0,
        false_claims: Vec::new(),
    };
    let mut whole = true;
    let mut heard = 0;
    while whole && take.advance().map_err(alone)? {
        let so_far = RecordingSoFar {
            new: &take.events[heard..],
            reached: take.performance.now(),
            claims: take.claims,
            false_claims: &take.false_claims,
        };
        whole = wanted(so_far).is_continue();
        heard = take.events.len();
    }
    let last_colourless = take.performance.picture(&colourless(&take.style));
    let Take { performance, screen, style, events, markers, log, false_claims, .. } = take;
    let lab = performance.lab;
    let of_system = || {
        let opened = lab.app.lab.as_ref();
        opened.map_or_else(|| called.to_owned(), |opened| opened.loaded.model.info.title.clone())
    };
    let recording = Recording {
        title: title.unwrap_or_else(of_system),
        size,
        fps,
        frames: lab.clock.frame(),
        end: lab.now(),
        style,
        last: screen.shown().cloned().unwrap_or_default(),
        last_colourless,
        events,
        markers,
        log,
        false_claims,
    };
    Ok((recording, whole))
}

/// The same style without colours.
fn colourless(style: &RenderStyle) -> RenderStyle {
    let theme = style.theme.clone().with_depth(ColourDepth::None);
    RenderStyle { theme, glyphs: style.glyphs }
}

/// A frame that could not be written.
fn unwritten(why: &io::Error) -> Diagnostic {
    Diagnostic::error(0..0, format!("a frame cannot be written: {why}"))
}

/// Captions that are too long for a screen of this width.
fn too_long(script: &Script, width: u16) -> Vec<Diagnostic> {
    let room = Script::caption_room(width);
    let long = script.steps.iter().filter(|(_, step)| match step {
        ScriptStep::Caption(text) => text.chars().count() > room,
        _ => false,
    });
    let message = format!("a caption may have {room} characters at this size");
    long.map(|(place, _)| Diagnostic::error(place.clone(), message.clone())).collect()
}

struct Take {
    performance: ScriptRunner,
    screen: Frames,
    style: RenderStyle,
    area: Size,
    events: Vec<(Micros, RecordingEvent)>,
    markers: Vec<ChapterMarker>,
    log: Vec<(Micros, TranscriptEntry)>,
    claims: usize,
    false_claims: Vec<Diagnostic>,
}

impl Take {
    /// Records the next event; returns whether there are more.
    fn advance(&mut self) -> Result<bool, Diagnostic> {
        let next = self.performance.next_event()?;
        let now = self.performance.now();
        match next {
            RunnerEvent::Frame => self.draw(now).map_err(|why| unwritten(&why))?,
            RunnerEvent::Done(what, text) => {
                self.log.push((now, TranscriptEntry::Done(what, text)));
            }
            RunnerEvent::Claim(place, claim) => {
                let screen = rows(&self.performance.picture(&self.style));
                let finding = self.performance.find(&claim, &screen)?;
                self.claims += 1;
                if !finding.holds {
                    let message = format!("this is false: {}", finding.sentence);
                    self.false_claims.push(Diagnostic::error(place, message));
                }
                self.log.push((now, TranscriptEntry::Claimed(finding.holds, finding.sentence)));
            }
            RunnerEvent::Marker(name) => {
                let screen = self.performance.picture(&self.style);
                let colourless = self.performance.picture(&colourless(&self.style));
                self.events.push((now, RecordingEvent::Marker(name.clone())));
                self.log.push((now, TranscriptEntry::Marker(self.markers.len())));
                self.markers.push(ChapterMarker { name, time: now, screen, colourless });
            }
            RunnerEvent::Lesson(place, _) => return Err(waits(place)),
            RunnerEvent::Overlay => return Ok(false),
        }
        Ok(true)
    }

    fn draw(&mut self, now: Micros) -> io::Result<()> {
        let Self { performance, screen, style, .. } = self;
        if performance.lab.takes_repaint() {
            screen.forget();
        }
        let bytes = screen.next(self.area, |area, buffer| {
            performance.draw(style, area, buffer);
        })?;
        if !bytes.is_empty() {
            let text = String::from_utf8_lossy(&bytes).into_owned();
            self.events.push((now, RecordingEvent::Output(text)));
        }
        Ok(())
    }
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

/// A time in a transcript: seconds with hundredths.
pub(super) fn seconds(time: Micros) -> String {
    format!("{:.2}", Duration::from_micros(time).as_secs_f64())
}
