//! The options of the laboratory: one structure, from which the command line, the configuration, the environment,
//! the manual page and the README are generated.
//!
//! In: words, from any of these. Out: [`Options`], or what is wrong with a word. Never here: where the words come
//! from, or what an option does. Each option is `--name` on the command line, `name` in the configuration and
//! `PHASELAB_NAME` in the environment; the first paragraph of its documentation is its purpose, the second its
//! values.

use std::path::PathBuf;
use std::str::FromStr;
use std::sync::LazyLock;

use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::{ArgAction, Args, Command, ValueEnum};

use super::bandwidth::Bandwidth;
use super::log::LogFile;
use crate::diagnostic::nearest;
use crate::view::colour::ColourDepth;
use crate::view::glyphs::Glyphs;
use crate::view::theme::PALETTES;

/// The maximum number of frames per second that can be requested.
pub const MOST_FRAMES: u16 = 240;

/// The options of the laboratory, with their defaults.
#[derive(Args, Clone, PartialEq, Eq, Debug)]
pub struct Options {
    /// Continue the last session: its system, views, values and motion.
    #[arg(long, action = ArgAction::Set, num_args = 0..=1, require_equals = true, hide_possible_values = true)]
    #[arg(default_value = "false", default_missing_value = "true", value_name = SWITCH)]
    pub resume: bool,
    /// Rebuild the system whenever its file is saved; the motion continues.
    #[arg(long, action = ArgAction::Set, num_args = 0..=1, require_equals = true, hide_possible_values = true)]
    #[arg(default_value = "false", default_missing_value = "true", value_name = SWITCH)]
    pub watch: bool,
    /// How many colours to use.
    #[arg(long, value_enum, value_name = "WORD", default_value = "auto")]
    pub color: Color,
    /// What to draw with; `phaselab doctor --glyphs` shows what the font has.
    #[arg(long, value_enum, value_name = "WORD", default_value = "auto")]
    pub glyphs: GlyphSet,
    /// The colours of the screen; `phaselab theme list` shows them.
    #[arg(long, value_parser = themes(), value_name = "WORD", default_value = "auto")]
    pub theme: String,
    /// The most frames in a second.
    ///
    /// a whole number from 1 to 240, or auto (30, and 15 over ssh)
    #[arg(long, value_name = "N", default_value = "auto", allow_hyphen_values = true)]
    pub fps: Auto<FrameRate>,
    /// The most that is sent in a second; where that is too little, less is drawn.
    ///
    /// bytes a second such as 16k or 1M, off, or auto (off, and 64k over ssh)
    #[arg(long, value_name = "WORD", default_value = "auto", allow_hyphen_values = true)]
    pub bandwidth: Auto<Bandwidth>,
    /// At most 4 frames a second, and nothing that fades.
    #[arg(long, action = ArgAction::Set, num_args = 0..=1, require_equals = true, hide_possible_values = true)]
    #[arg(default_value = "false", default_missing_value = "true", value_name = SWITCH)]
    pub reduce_motion: bool,
    /// Where to write what happens.
    ///
    /// a path, off, or state for phaselab/phaselab.log in your state folder
    #[arg(long, short, value_name = "WORD", num_args = 0..=1, require_equals = true)]
    #[arg(default_value = "off", default_missing_value = "state")]
    pub log: LogTarget,
    /// Use the mouse; false leaves it to the terminal. M switches it in the lab.
    #[arg(long, action = ArgAction::Set, num_args = 0..=1, require_equals = true, hide_possible_values = true)]
    #[arg(default_value = "true", default_missing_value = "true", value_name = SWITCH)]
    pub mouse: bool,
    /// Disable synchronized output, for a terminal that shows its marks.
    #[arg(long, action = ArgAction::Set, num_args = 0..=1, require_equals = true, hide_possible_values = true)]
    #[arg(default_value = "false", default_missing_value = "true", value_name = SWITCH)]
    pub no_sync: bool,
}

/// The placeholder for the value of a switch in the help.
const SWITCH: &str = "true|false";

/// How many colours.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum Color {
    /// what the environment says: NO_COLOR, COLORTERM, TERM
    Auto,
    /// none
    Never,
    /// the terminal's own sixteen
    #[value(name = "16")]
    Ansi16,
    /// the xterm palette
    #[value(name = "256")]
    Ansi256,
    /// 24 bits
    True,
}

impl Color {
    /// Returns the requested depth, or `None` if the environment decides.
    pub fn depth(self) -> Option<ColourDepth> {
        match self {
            Self::Auto => None,
            Self::Never => Some(ColourDepth::None),
            Self::Ansi16 => Some(ColourDepth::Ansi16),
            Self::Ansi256 => Some(ColourDepth::Ansi256),
            Self::True => Some(ColourDepth::True),
        }
    }
}

/// What to draw with.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum GlyphSet {
    /// what the locale says: LC_ALL, LC_CTYPE, LANG
    Auto,
    /// braille patterns, the finest
    Braille,
    /// half blocks
    Half,
    /// quarters of a cell
    Quadrant,
    /// sixths of a cell; few fonts have them
    Sextant,
    /// eighths of a cell; very few fonts have them
    Octant,
    /// ASCII only
    Ascii,
}

impl GlyphSet {
    /// Returns the requested glyphs, or `None` if the locale decides.
    pub fn glyphs(self) -> Option<Glyphs> {
        self.to_possible_value().and_then(|value| Glyphs::named(value.get_name()))
    }
}

/// Returns the names of the themes, and `auto`.
fn themes() -> PossibleValuesParser {
    let auto =
        PossibleValue::new("auto").help("light where the terminal's background is, dark otherwise");
    let themes =
        PALETTES.iter().map(|palette| PossibleValue::new(palette.name).help(palette.about));
    PossibleValuesParser::new([auto].into_iter().chain(themes))
}

/// A value, or `auto`: the terminal and the connection decide.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Auto<T> {
    /// `auto`.
    Auto,
    /// A value.
    Is(T),
}

impl<T> Auto<T> {
    /// Returns the value, if one is given.
    pub fn given(self) -> Option<T> {
        match self {
            Self::Auto => None,
            Self::Is(value) => Some(value),
        }
    }
}

impl<T: FromStr> FromStr for Auto<T> {
    type Err = T::Err;

    fn from_str(word: &str) -> Result<Self, T::Err> {
        if word == "auto" { Ok(Self::Auto) } else { word.parse().map(Self::Is) }
    }
}

/// Frames per second.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct FrameRate(pub u16);

impl FromStr for FrameRate {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        let number = word.parse().ok().filter(|number| (1..=MOST_FRAMES).contains(number));
        number
            .map(Self)
            .ok_or_else(|| format!("not a whole number from 1 to {MOST_FRAMES}, or auto"))
    }
}

/// The destination of the log, if there is one.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct LogTarget(pub Option<LogFile>);

impl FromStr for LogTarget {
    type Err = &'static str;

    fn from_str(word: &str) -> Result<Self, &'static str> {
        match word {
            "" => Err("a path is missing"),
            "off" => Ok(Self(None)),
            "state" => Ok(Self(Some(LogFile::Usual))),
            path => Ok(Self(Some(LogFile::At(PathBuf::from(path))))),
        }
    }
}

/// The description of one option.
#[derive(Debug)]
pub struct OptionRow {
    /// The name by which it is typed.
    pub name: String,
    /// Its purpose, as a sentence.
    pub about: String,
    /// Its possible words, each with its meaning; empty if others are possible.
    pub words: Vec<(String, String)>,
    /// A short description of its other possible values.
    pub shape: String,
    /// Its default.
    pub usual: String,
    /// Whether it is true or false.
    pub is_switch: bool,
}

static ROWS: LazyLock<Vec<OptionRow>> =
    LazyLock::new(|| command().get_arguments().map(OptionRow::new).collect());

/// Returns all options, in the order of the help.
pub fn rows() -> &'static [OptionRow] {
    &ROWS
}

fn command() -> Command {
    Options::augment_args(Command::new("options").no_binary_name(true).disable_help_flag(true))
}

impl OptionRow {
    fn new(argument: &clap::Arg) -> Self {
        let text = |text: Option<&clap::builder::StyledStr>| {
            text.map(ToString::to_string).unwrap_or_default()
        };
        let values = argument.get_possible_values();
        let word = |value: &PossibleValue| (value.get_name().to_owned(), text(value.get_help()));
        let is_switch = argument.get_value_names().is_some_and(|names| names == [SWITCH]);
        let long = text(argument.get_long_help());
        let usual = argument.get_default_values().first();
        Self {
            name: argument.get_long().unwrap_or_default().to_owned(),
            about: format!("{}.", text(argument.get_help())),
            words: values.iter().map(word).collect(),
            shape: long.split_once("\n\n").map_or("", |(_, shape)| shape).to_owned(),
            usual: usual.map_or(String::new(), |word| word.to_string_lossy().into_owned()),
            is_switch,
        }
    }

    /// Returns its environment variable: `PHASELAB_NO_SYNC`.
    pub fn variable(&self) -> String {
        format!("PHASELAB_{}", self.name.to_uppercase().replace('-', "_"))
    }

    /// Returns a short description of its possible values.
    pub fn may_be(&self) -> String {
        let words: Vec<&str> = self.words.iter().map(|(word, _)| word.as_str()).collect();
        if words.is_empty() { self.shape.clone() } else { words.join(", ") }
    }

    /// Checks a value.
    ///
    /// # Errors
    /// Returns what is wrong, as a clause without a full stop, and a suggested correction.
    pub fn accept(&self, word: &str) -> Result<(), RejectedWord> {
        if command().try_get_matches_from([format!("--{}={word}", self.name)]).is_ok() {
            return Ok(());
        }
        let (wanted, near) = if self.is_switch {
            ("true or false".to_owned(), None)
        } else if self.words.is_empty() {
            (self.shape.clone(), None)
        } else {
            let words = self.words.iter().map(|(word, _)| word.as_str());
            (format!("one of {}", self.may_be()), nearest(word, words))
        };
        let message = format!("`{}` is {wanted}, not `{word}`", self.name);
        Err(RejectedWord { message, help: near.map(|near| format!("did you mean `{near}`?")) })
    }
}

/// Why a word is not accepted.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct RejectedWord {
    /// What is wrong.
    pub message: String,
    /// A suggested correction, if there is one.
    pub help: Option<String>,
}

/// Option values from outside the command line: accepted words with the names of their options.
pub type Words = Vec<(&'static str, String)>;

/// Reads the options from the environment; `variable` returns the value of a variable.
///
/// # Errors
/// Returns a sentence about a variable that cannot be used.
pub fn of_environment(variable: &dyn Fn(&str) -> Option<String>) -> Result<Words, String> {
    let mut words = Words::new();
    for row in rows() {
        let name = row.variable();
        let Some(word) = variable(&name).filter(|word| !word.is_empty()) else { continue };
        row.accept(&word).map_err(|wrong| {
            let help = wrong.help.map_or(String::new(), |help| format!("; {help}"));
            format!("{name}: {}{help}", wrong.message)
        })?;
        words.push((&row.name, word));
    }
    Ok(words)
}

/// Returns a command line with these words as defaults. The last word for a name counts, and the command line takes
/// precedence.
#[must_use]
pub fn with_defaults(command: Command, words: Words) -> Command {
    words.into_iter().fold(command, |command, (name, word)| {
        command.mut_args(|argument| {
            let meant = argument.get_long() == Some(name);
            if meant { argument.default_value(word.clone()) } else { argument }
        })
    })
}

#[cfg(test)]
mod tests {
    use clap::FromArgMatches;

    use super::*;

    #[test]
    fn every_option_accepts_what_it_usually_is() {
        assert!(!rows().is_empty());
        for row in rows() {
            assert_eq!(row.accept(&row.usual), Ok(()), "{}", row.name);
            assert!(row.name == "log" || row.accept("no such word").is_err(), "{}", row.name);
            assert!(!row.may_be().is_empty() && row.about.len() > 10, "{}", row.name);
        }
    }

    #[test]
    fn the_command_line_wins_over_the_environment_and_that_over_the_configuration() {
        let variable = |name: &str| match name {
            "PHASELAB_FPS" => Some("20".to_owned()),
            "PHASELAB_NO_SYNC" => Some(String::new()),
            _ => None,
        };
        let file = [("glyphs", "ascii"), ("fps", "10"), ("color", "true"), ("no-sync", "true")];
        let mut words: Words = file.map(|(name, word)| (name, word.to_owned())).to_vec();
        words.extend(of_environment(&variable).expect("good words"));
        let matches = with_defaults(command(), words).try_get_matches_from(["--glyphs=half"]);
        let options = Options::from_arg_matches(&matches.expect("good words")).expect("options");
        assert_eq!(options.glyphs, GlyphSet::Half);
        assert_eq!(options.fps, Auto::Is(FrameRate(20)));
        assert_eq!((options.color, options.mouse), (Color::True, true));
        assert!(options.no_sync, "an empty variable says nothing");
    }

    #[test]
    fn a_variable_that_cannot_be_used_is_reported() {
        let check = |name: &str, word: &str, expected: &str| {
            let variable = |asked: &str| (asked == name).then(|| word.to_owned());
            assert_eq!(of_environment(&variable), Err(expected.to_owned()));
        };
        check(
            "PHASELAB_FPS",
            "1000",
            "PHASELAB_FPS: `fps` is a whole number from 1 to 240, or auto (30, and 15 over ssh), not `1000`",
        );
        check(
            "PHASELAB_GLYPHS",
            "brail",
            "PHASELAB_GLYPHS: `glyphs` is one of auto, braille, half, quadrant, sextant, octant, ascii, not `brail`; \
             did you mean `braille`?",
        );
        check("PHASELAB_NO_SYNC", "yes", "PHASELAB_NO_SYNC: `no-sync` is true or false, not `yes`");
    }
}
