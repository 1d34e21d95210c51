//! The script of a demo: one thing a line, in the order in which they happen.
//!
//! In: text. Out: a [`Script`], or every mistake in its place with what would be right. [`COMMANDS`] has one row for each
//! word a line may begin with; README and the nearest right word come from it. Never here: what a name of the script
//! means in a system, or playing it.

mod command;
mod key;
mod line;

use std::collections::HashMap;

use crate::app::Key;
use crate::diagnostic::SourceRange;
use crate::diagnostic::nearest;
use crate::diagnostic::{Diagnostic, Document};
use crate::view::RenderStyle;
use crate::view::colour::ColourDepth;
use crate::view::glyphs::Glyphs;
use crate::view::theme::Theme;

use super::clock::{Micros, SECOND};

pub use command::{CLAIMS, COMMANDS, Command, read_size};
use line::Line;

/// The longest demo, in seconds: a script that waits for a day would fill the memory.
pub const LONGEST: u64 = 3600;

/// A demo as written, understood as far as it can be without its system.
#[derive(Clone, Debug)]
pub struct Script {
    /// What is said before anything happens.
    pub head: Head,
    /// What happens, in order.
    pub steps: Vec<(SourceRange, Step)>,
}

/// What holds for the whole demo.
#[derive(Clone, Debug, PartialEq)]
pub struct Head {
    /// The preset or file it is about, if the script says so.
    pub open: Option<Text>,
    /// Its title; that of the system otherwise.
    pub title: Option<String>,
    /// Columns and rows.
    pub size: Option<(u16, u16)>,
    /// Frames in a second.
    pub fps: u32,
    /// The palette's name.
    pub theme: &'static str,
    /// How many colours are used.
    pub colour: ColourDepth,
    /// What is drawn with.
    pub glyphs: Glyphs,
}

impl Default for Head {
    fn default() -> Head {
        Head {
            open: None,
            title: None,
            size: None,
            fps: 20,
            theme: "dark",
            colour: ColourDepth::True,
            glyphs: Glyphs::Braille,
        }
    }
}

impl Head {
    /// How the screen looks: by the script alone, whatever the environment.
    pub fn look(&self) -> RenderStyle {
        let theme = Theme::named(self.theme, self.colour);
        RenderStyle {
            theme: theme.unwrap_or_else(|| Theme::dark(self.colour)),
            glyphs: self.glyphs,
        }
    }
}

/// A piece of a line whose meaning depends on the system, and where it stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Text {
    /// As written, without quotes.
    pub text: String,
    /// Where.
    pub place: SourceRange,
}

/// How one value goes in a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepPath {
    /// Which.
    pub name: Text,
    /// From where; from its present value otherwise.
    pub from: Option<Text>,
    /// To where.
    pub to: Text,
}

/// Something that happens.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// Each key that follows is given so much time to be seen.
    Pace(Micros),
    /// Keys are pressed.
    Press(Vec<Key>),
    /// Characters are typed.
    Type(String),
    /// Time passes.
    Wait(Micros),
    /// A parameter or an initial value is set.
    Set(Text, Text),
    /// Parameters and initial values go evenly to others while time passes.
    Sweep {
        /// Which, all at once.
        ways: Vec<SweepPath>,
        /// In what time.
        time: Micros,
    },
    /// Simulated seconds in a second.
    Speed(Text),
    /// The line below the screen says this; empty, it says nothing.
    Caption(String),
    /// A chapter begins.
    Marker(String),
    /// Something must hold now.
    Assert(Assert),
}

/// What must hold.
#[derive(Clone, Debug, PartialEq)]
pub enum Assert {
    /// Time runs, is held, has ended, or cannot go on.
    Status(Word),
    /// The text is on the screen.
    Screen(String),
    /// A gauge has this verdict.
    Verdict(Text, Word),
    /// A number compares with another.
    Number {
        /// What is measured.
        measure: Measure,
        /// Of what, or which expression.
        of: Text,
        /// How it compares.
        relation: Relation,
        /// With what.
        with: Text,
        /// How far it may be off; where numbers are to be equal.
        within: Option<Text>,
    },
}

/// One of a few words.
pub type Word = &'static str;

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// An expression of the present state.
    Value,
    /// The greatest drift of a gauge since its reference.
    Drift,
    /// The least value of a channel since the motion began.
    Least,
    /// The greatest.
    Greatest,
    /// How often an event or an impulse has happened.
    Count,
    /// When it last happened.
    Time,
}

/// How two numbers compare.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// Equal, within a tolerance.
    Equal,
    /// Below.
    Less,
    /// Above.
    More,
}

impl Script {
    /// Reads a script.
    ///
    /// # Errors
    /// Every mistake, in its place.
    pub fn read(document: &Document) -> Result<Script, Vec<Diagnostic>> {
        if let Some(mistake) = document.unreadable() {
            return Err(vec![mistake.clone()]);
        }
        let mut reading = Reading::default();
        let mut start = 0;
        for text in document.text.split('\n') {
            reading.line(text.strip_suffix('\r').unwrap_or(text), start);
            start += text.len() + 1;
        }
        reading.conclude(document.text.len())
    }

    /// How many characters a caption may have on a screen of this width.
    pub fn caption_room(width: u16) -> usize {
        usize::from(width).saturating_sub(4)
    }

    /// Whether a row of the screen is kept for captions.
    pub fn has_captions(&self) -> bool {
        self.steps.iter().any(|(_, step)| matches!(step, Step::Caption(_)))
    }

    /// How long it lasts, but for what a key's pace adds.
    fn length(&self) -> Micros {
        let (mut pace, mut length) = (PACE, 0_u64);
        for (_, step) in &self.steps {
            length = length.saturating_add(match step {
                Step::Pace(time) => {
                    pace = *time;
                    0
                }
                Step::Wait(time) | Step::Sweep { time, .. } => *time,
                Step::Press(keys) => pace.saturating_mul(keys.len() as u64),
                Step::Type(text) => pace.saturating_mul(text.chars().count() as u64),
                _ => 0,
            });
        }
        length
    }
}

/// How long a key is given to be seen, where the script does not say.
pub const PACE: Micros = 150_000;

/// What was read so far.
#[derive(Default)]
struct Reading {
    head: Head,
    said: HashMap<&'static str, SourceRange>,
    steps: Vec<(SourceRange, Step)>,
    markers: HashMap<String, SourceRange>,
    mistakes: Vec<Diagnostic>,
}

/// What a line says.
pub(super) enum Said {
    /// Something for the whole demo.
    Head(Box<dyn FnOnce(&mut Head)>),
    /// Something that happens.
    Step(Step),
}

/// More mistakes than these are not reported.
const MOST_MISTAKES: usize = 100;

impl Reading {
    /// One line of the text, which begins at a byte.
    fn line(&mut self, text: &str, start: usize) {
        let mut line = Line::new(text, start);
        let Some(word) = line.word() else { return };
        if let Err(mistake) = self.command(&word, &mut line)
            && self.mistakes.len() < MOST_MISTAKES
        {
            self.mistakes.push(mistake);
        }
    }

    fn command(&mut self, word: &Text, line: &mut Line<'_>) -> Result<(), Diagnostic> {
        let command = COMMANDS.iter().find(|command| command.name == word.text);
        let command = command.ok_or_else(|| unknown(word))?;
        let said = (command.read)(line)?;
        line.end(command.form)?;
        let place = word.place.start..line.here();
        match said {
            Said::Head(say) => {
                if !self.steps.is_empty() {
                    let message = format!("`{}` comes too late: the demo has begun", word.text);
                    let help = "what holds for the whole demo stands before what happens";
                    return Err(Diagnostic::error(word.place.clone(), message).with_help(help));
                }
                if let Some(first) = self.said.insert(command.name, word.place.clone()) {
                    let message = format!("`{}` is said twice", word.text);
                    let mistake = Diagnostic::error(word.place.clone(), message);
                    return Err(mistake.with_also(first, "it was said here"));
                }
                say(&mut self.head);
            }
            Said::Step(step) => {
                if let Step::Marker(name) = &step
                    && let Some(first) = self.markers.insert(name.clone(), place.clone())
                {
                    let message = format!("there are two markers `{name}`");
                    let help = "a player finds a chapter by its name: give each its own";
                    let mistake = Diagnostic::error(place, message).with_help(help);
                    return Err(mistake.with_also(first, "the first one"));
                }
                self.steps.push((place, step));
            }
        }
        Ok(())
    }

    fn conclude(mut self, end: usize) -> Result<Script, Vec<Diagnostic>> {
        let script = Script { head: self.head, steps: self.steps };
        if let Some((width, _)) = script.head.size {
            let room = Script::caption_room(width);
            for (place, step) in &script.steps {
                if let Step::Caption(text) = step
                    && text.chars().count() > room
                {
                    let many = text.chars().count();
                    let message = format!(
                        "a caption may have {room} characters at this size; this one has {many}"
                    );
                    self.mistakes.push(Diagnostic::error(place.clone(), message));
                }
            }
        }
        let length = script.length();
        if self.mistakes.is_empty() && length > LONGEST * SECOND {
            let message = format!("a demo may last an hour; this one lasts {} s", length / SECOND);
            self.mistakes.push(Diagnostic::error(end..end, message));
        }
        if self.mistakes.is_empty() && length.saturating_mul(script.head.fps.into()) < SECOND {
            let message = "nothing is to be seen: no time passes in this script";
            let help = "let it pass with `Wait 2s`";
            self.mistakes.push(Diagnostic::error(end..end, message).with_help(help));
        }
        if self.mistakes.is_empty() { Ok(script) } else { Err(self.mistakes) }
    }
}

fn unknown(word: &Text) -> Diagnostic {
    let message = format!("there is no command `{}`", word.text);
    let mistake = Diagnostic::error(word.place.clone(), message);
    let names = COMMANDS.iter().map(|command| command.name);
    match nearest(&word.text, names.clone()) {
        Some(near) => mistake.with_help(format!("did you mean `{near}`?")),
        None => {
            mistake.with_help(format!("a line begins with {}", names.collect::<Vec<_>>().join(" ")))
        }
    }
}
