//! The script of a demo: one action per line, in order.
//!
//! In: text. Out: a [`Script`], or every error with its range and a correction. [`COMMANDS`] has one row for each
//! word that a line may begin with; README and the suggestions come from it. Never here: what a name of the script
//! means in a system, or playing it.

mod claim;
mod command;
mod line;
mod reading;

use crossterm::event::KeyEvent;

use crate::diagnostic::SourceRange;
use crate::view::RenderStyle;
use crate::view::colour::ColourDepth;
use crate::view::glyphs::Glyphs;
use crate::view::theme::Theme;

use super::clock::Micros;

pub use claim::CLAIMS;
pub use command::{COMMANDS, CommandRow, read_size};
pub use line::LineText;

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
    ScrubTo(LineText),
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

impl Script {
    /// The number of characters that fit in a caption on a screen of this width.
    pub fn caption_room(width: u16) -> usize {
        usize::from(width).saturating_sub(4)
    }

    /// The number of its claims.
    pub fn claims(&self) -> usize {
        self.steps.iter().filter(|(_, step)| matches!(step, ScriptStep::Assert(_))).count()
    }
}

/// How long a key is shown if the script does not specify it.
pub const PACE: Micros = 150_000;
