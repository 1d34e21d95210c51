//! The script of a demo: one action per line, in order.
//!
//! In: text. Out: a [`Script`], or every error with its range and a correction. [`COMMANDS`] has one row for each
//! word that a line may begin with; README and the suggestions come from it. Never here: what a name of the script
//! means in a system, or playing it.

mod claim;
mod command;
mod line;

use std::collections::HashMap;

use crossterm::event::KeyEvent;

use crate::diagnostic::SourceRange;
use crate::diagnostic::nearest;
use crate::diagnostic::{Diagnostic, Document};
use crate::view::RenderStyle;
use crate::view::colour::ColourDepth;
use crate::view::glyphs::Glyphs;
use crate::view::theme::Theme;

use super::clock::{Micros, SECOND};

pub use claim::CLAIMS;
pub use command::{COMMANDS, CommandRow, read_size};
pub use line::LineText;
use line::ScriptLine;

/// The longest demo in seconds; a script that waits for a day would fill the memory.
pub const LONGEST: u64 = 3600;

/// The name of a system on the screen: a file without its folders, which are private.
pub fn called(name: &str) -> &str {
    let file = name.rsplit(['/', std::path::MAIN_SEPARATOR]).next().unwrap_or(name);
    file.strip_suffix(".toml").unwrap_or(file)
}

/// A parsed script, understood as far as is possible without its system.
#[derive(Clone, Debug)]
pub struct Script {
    /// The settings of the whole demo.
    pub head: ScriptHeader,
    /// The steps, in order.
    pub steps: Vec<(SourceRange, ScriptStep)>,
}

/// The settings of a demo.
#[derive(Clone, Debug, PartialEq)]
pub struct ScriptHeader {
    /// The preset or file to open, if the script names one.
    pub open: Option<LineText>,
    /// The title; by default the system's.
    pub title: Option<String>,
    /// Columns and rows.
    pub size: Option<(u16, u16)>,
    /// Frames per second.
    pub fps: u32,
    /// The palette's name.
    pub theme: &'static str,
    /// The colour depth.
    pub colour: ColourDepth,
    /// The glyph set.
    pub glyphs: Glyphs,
    /// Whether the status and the keys are shown below the panes.
    pub footer: bool,
}

impl Default for ScriptHeader {
    fn default() -> ScriptHeader {
        ScriptHeader {
            open: None,
            title: None,
            size: None,
            fps: 20,
            theme: "dark",
            colour: ColourDepth::True,
            glyphs: Glyphs::Braille,
            footer: true,
        }
    }
}

impl ScriptHeader {
    /// The render style, which depends on the script alone and not on the environment.
    pub fn render_style(&self) -> RenderStyle {
        let theme = Theme::named(self.theme, self.colour);
        RenderStyle {
            theme: theme.unwrap_or_else(|| Theme::dark(self.colour)),
            glyphs: self.glyphs,
        }
    }
}

/// The path of one value in a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepPath {
    /// The name of the value.
    pub name: LineText,
    /// The start; by default the current value.
    pub from: Option<LineText>,
    /// The end.
    pub to: LineText,
}

/// An action of a script.
#[derive(Clone, Debug, PartialEq)]
pub enum ScriptStep {
    /// Sets how long each following key is shown.
    Pace(Micros),
    /// Presses keys.
    Press(Vec<KeyEvent>),
    /// Types characters.
    Type(String),
    /// Lets time pass.
    Wait(Micros),
    /// Sets a parameter or an initial value.
    Set(LineText, LineText),
    /// Moves parameters and initial values evenly to other values while time passes.
    Sweep {
        /// The values, which move simultaneously.
        ways: Vec<SweepPath>,
        /// The duration.
        time: Micros,
    },
    /// Sets the simulated seconds per second.
    Speed(LineText),
    /// Look at a time of the recorded past.
    Look(LineText),
    /// Focuses a pane, and brings it into view.
    Focus(LineText),
    /// Sets the least ranges of quantities in the pictures.
    Extent(Vec<(LineText, [LineText; 2])>),
    /// Sets the line below the screen; an empty text clears it.
    Caption(String),
    /// Begins a chapter.
    Marker(String),
    /// Asserts a claim.
    Assert(Assert),
    /// A line of a lesson.
    Lesson(LessonStep),
}

/// A line of a lesson, which speaks to a person or waits for one.
#[derive(Clone, Debug, PartialEq)]
pub enum LessonStep {
    /// Text, which waits for a key.
    Say(String),
    /// A question with the options below it.
    Ask(String),
    /// An option of the question above.
    Option {
        /// The option.
        text: String,
        /// What is said to whoever chose it wrongly.
        why: Option<String>,
        /// The claim that decides, at the outcome, whether it is right.
        claim: Assert,
    },
    /// Something to be predicted.
    Predict {
        /// The question.
        text: String,
        /// What is expected of the person.
        asked: Asked,
    },
    /// The answer is compared with what has happened.
    Outcome,
    /// Something for the person to do in the lab.
    Task {
        /// What is to be done.
        text: String,
        /// What is said to whoever asks for help.
        hint: Option<String>,
        /// The claim that ends it.
        claim: Assert,
    },
    /// The keys that fulfil the task above.
    Solution(Vec<KeyEvent>),
    /// The lab is the person's until a key.
    Free(String),
}

/// What a prediction is asked for, at the outcome.
#[derive(Clone, Debug, PartialEq)]
pub enum Asked {
    /// The value of an expression.
    Value {
        /// The expression.
        value: LineText,
        /// How far a prediction may be off.
        within: LineText,
    },
    /// A place on a plot, set by its cursor: a point, or the curve that the motion draws from here to the outcome.
    Place {
        /// Whether the curve is asked for, and not a point.
        is_curve: bool,
        /// The horizontal and the vertical axis.
        axes: Box<[AskedAxis; 2]>,
    },
}

/// An axis of a plot on which something is predicted.
#[derive(Clone, Debug, PartialEq)]
pub struct AskedAxis {
    /// The quantity.
    pub of: LineText,
    /// The ends of what the axis shows at least.
    pub range: Option<[LineText; 2]>,
    /// How far a prediction may be off along this axis.
    pub within: LineText,
}

/// An assertion.
#[derive(Clone, Debug, PartialEq)]
pub enum Assert {
    /// The status: running, paused, ended or stopped.
    Status(Word),
    /// The text is on the screen.
    Screen(String),
    /// A gauge has this verdict.
    Verdict(LineText, Word),
    /// A number compares with another.
    Number {
        /// What is compared.
        measure: AssertedNumber,
        /// Its subject, or the expression.
        of: LineText,
        /// The relation.
        relation: Comparator,
        /// The other number.
        with: LineText,
        /// The tolerance, if the numbers are to be equal.
        within: Option<LineText>,
    },
}

/// One of a few words.
pub type Word = &'static str;

/// A number that can be asserted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AssertedNumber {
    /// An expression of the current state.
    Value,
    /// The greatest drift of a gauge since its reference.
    Drift,
    /// The least value of a channel since the motion began.
    Least,
    /// The greatest value of a channel since the motion began.
    Greatest,
    /// The number of occurrences of an event or impulse.
    Count,
    /// The time of the last occurrence.
    Time,
}

/// A relation between two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Comparator {
    /// Equal, within a tolerance.
    Equal,
    /// The first is below the second.
    Less,
    /// Greater.
    More,
}

impl ScriptHeader {
    /// Reads the settings of a script, which stand before its first step; the steps are not read.
    ///
    /// # Errors
    /// Returns every error up to there with its range.
    pub fn read(document: &Document) -> Result<ScriptHeader, Vec<Diagnostic>> {
        let reading = ScriptReading::of(document, |reading| reading.steps.is_empty())?;
        if reading.diagnostics.is_empty() { Ok(reading.head) } else { Err(reading.diagnostics) }
    }
}

impl Script {
    /// Reads a script.
    ///
    /// # Errors
    /// Returns every error with its range.
    pub fn read(document: &Document) -> Result<Script, Vec<Diagnostic>> {
        let reading = ScriptReading::of(document, |_| true)?;
        reading.conclude(document.text.len())
    }

    /// The number of characters that fit in a caption on a screen of this width.
    pub fn caption_room(width: u16) -> usize {
        usize::from(width).saturating_sub(4)
    }

    /// The number of its claims.
    pub fn claims(&self) -> usize {
        self.steps.iter().filter(|(_, step)| matches!(step, ScriptStep::Assert(_))).count()
    }

    /// The duration, without the time for keys.
    fn length(&self) -> Micros {
        let (mut pace, mut length) = (PACE, 0_u64);
        for (_, step) in &self.steps {
            length = length.saturating_add(match step {
                ScriptStep::Pace(time) => {
                    pace = *time;
                    0
                }
                ScriptStep::Wait(time) | ScriptStep::Sweep { time, .. } => *time,
                ScriptStep::Press(keys) => pace.saturating_mul(keys.len() as u64),
                ScriptStep::Type(text) => pace.saturating_mul(text.chars().count() as u64),
                _ => 0,
            });
        }
        length
    }
}

/// How long a key is shown if the script does not specify it.
pub const PACE: Micros = 150_000;

#[derive(Default)]
struct ScriptReading {
    head: ScriptHeader,
    given: HashMap<&'static str, SourceRange>,
    steps: Vec<(SourceRange, ScriptStep)>,
    markers: HashMap<String, SourceRange>,
    diagnostics: Vec<Diagnostic>,
}

pub(super) enum Said {
    /// A setting of the whole demo.
    Head(Box<dyn FnOnce(&mut ScriptHeader)>),
    Step(ScriptStep),
}

const MOST_ERRORS: usize = 100;

impl ScriptReading {
    /// Reads the lines of a text for as long as a condition holds.
    fn of(document: &Document, continues: impl Fn(&Self) -> bool) -> Result<Self, Vec<Diagnostic>> {
        if let Some(diagnostic) = document.unreadable() {
            return Err(vec![diagnostic.clone()]);
        }
        // editors put a byte order mark in front
        let text = document.text.strip_prefix('\u{feff}').unwrap_or(&document.text);
        let (mut reading, mut start) = (Self::default(), document.text.len() - text.len());
        for text in text.split('\n') {
            reading.line(text.strip_suffix('\r').unwrap_or(text), start);
            start += text.len() + 1;
            if !continues(&reading) {
                break;
            }
        }
        Ok(reading)
    }

    /// Reads one line of the text, which begins at this byte.
    fn line(&mut self, text: &str, start: usize) {
        let mut line = ScriptLine::new(text, start);
        let Some(word) = line.word() else { return };
        if let Err(diagnostic) = self.command(&word, &mut line)
            && self.diagnostics.len() < MOST_ERRORS
        {
            self.diagnostics.push(diagnostic);
        }
    }

    fn command(&mut self, word: &LineText, line: &mut ScriptLine<'_>) -> Result<(), Diagnostic> {
        let command = COMMANDS.iter().find(|command| command.name == word.text);
        let command = command.ok_or_else(|| unknown(word))?;
        let parsed = (command.read)(line)?;
        line.end(command.form)?;
        let place = word.place.start..line.here();
        match parsed {
            Said::Head(say) => {
                if !self.steps.is_empty() {
                    let message = format!("`{}` comes too late: the demo has begun", word.text);
                    let help = "what holds for the whole demo stands before what happens";
                    return Err(Diagnostic::error(word.place.clone(), message).with_help(help));
                }
                if let Some(first) = self.given.insert(command.name, word.place.clone()) {
                    let message = format!("`{}` is given twice", word.text);
                    let diagnostic = Diagnostic::error(word.place.clone(), message);
                    return Err(diagnostic.with_also(first, "it was given here"));
                }
                say(&mut self.head);
            }
            Said::Step(step) => {
                if let ScriptStep::Marker(name) = &step
                    && let Some(first) = self.markers.insert(name.clone(), place.clone())
                {
                    let message = format!("there are two markers `{name}`");
                    let help = "a player finds a chapter by its name: give each its own";
                    let diagnostic = Diagnostic::error(place, message).with_help(help);
                    return Err(diagnostic.with_also(first, "the first one"));
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
                if let ScriptStep::Caption(text) = step
                    && text.chars().count() > room
                {
                    let many = text.chars().count();
                    let message = format!(
                        "a caption may have {room} characters at this size; this one has {many}"
                    );
                    self.diagnostics.push(Diagnostic::error(place.clone(), message));
                }
            }
        }
        let length = script.length();
        if self.diagnostics.is_empty() && length > LONGEST * SECOND {
            let message = format!("a demo may last an hour; this one lasts {} s", length / SECOND);
            self.diagnostics.push(Diagnostic::error(end..end, message));
        }
        if self.diagnostics.is_empty() && length.saturating_mul(script.head.fps.into()) < SECOND {
            let message = "there is nothing to see: no time passes in this script";
            let help = "let it pass with `Wait 2s`";
            self.diagnostics.push(Diagnostic::error(end..end, message).with_help(help));
        }
        if self.diagnostics.is_empty() { Ok(script) } else { Err(self.diagnostics) }
    }
}

fn unknown(word: &LineText) -> Diagnostic {
    let message = format!("unknown command `{}`", word.text);
    let diagnostic = Diagnostic::error(word.place.clone(), message);
    let names = COMMANDS.iter().map(|command| command.name);
    match nearest(&word.text, names.clone()) {
        Some(near) => diagnostic.with_help(format!("did you mean `{near}`?")),
        None => diagnostic
            .with_help(format!("a line begins with {}", names.collect::<Vec<_>>().join(" "))),
    }
}
