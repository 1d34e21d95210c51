//! The request: what to open and how to show it, and what the environment says where nothing is asked for.
//!
//! In: [`Options`]. Out: the look and the pace. Never here: where options come from; a question put to the terminal.

use crate::preset::NotFound;
use crate::view::Look;
use crate::view::colour::ColourDepth;
use crate::view::glyphs::Glyphs;
use crate::view::theme::Theme;

use super::options::Options;
use super::stage::Pace;
use super::store::NoSession;
use super::terminal::NoTerminal;

/// Frames in a second where the terminal is near.
const NEAR: u16 = 30;

/// The same at the other end of a line.
const FAR: u16 = 15;

/// What the laboratory is to be opened with.
#[derive(Clone, Debug, Default)]
pub struct Request {
    /// A preset's name or a file's path; without one the picker opens.
    pub open: Option<String>,
    /// Goes on with the last session.
    pub resume: bool,
    /// How many colours to use; the environment says it otherwise.
    pub colour: Option<ColourDepth>,
    /// What to draw with; the environment says it otherwise.
    pub glyphs: Option<Glyphs>,
    /// The most frames in a second; otherwise 30, and 15 where `SSH_CONNECTION` or `SSH_TTY` is set.
    pub frames: Option<u16>,
    /// Leaves out the marks round each frame, for terminals that show them.
    pub unsynchronized: bool,
    /// Has the mouse reported from the beginning.
    pub mouse: bool,
    /// Builds the system anew whenever its file has changed.
    pub watch: bool,
}

/// Why the laboratory does not open.
#[derive(Debug, thiserror::Error)]
pub enum Refusal {
    /// There is no terminal.
    #[error(transparent)]
    NoTerminal(#[from] NoTerminal),
    /// What was asked for is not there.
    #[error(transparent)]
    NotFound(#[from] NotFound),
    /// There is no session to go on with.
    #[error(transparent)]
    NoSession(#[from] NoSession),
    /// The laboratory was left, and its session could not be saved.
    #[error("the session is not saved: {0}")]
    Unsaved(std::io::Error),
    /// The system refuses something that the laboratory needs.
    #[error("the laboratory cannot go on: {0}")]
    System(#[from] std::io::Error),
}

impl Request {
    /// What the options ask for; words no row of the table of options accepts count as not said.
    pub fn new(open: Option<String>, options: &Options) -> Self {
        let colour = match options.get("color") {
            Some("never") => Some(ColourDepth::None),
            Some("16") => Some(ColourDepth::Ansi16),
            Some("256") => Some(ColourDepth::Ansi256),
            Some("true") => Some(ColourDepth::True),
            _ => None,
        };
        let glyphs = match options.get("glyphs") {
            Some("braille") => Some(Glyphs::Braille),
            Some("half") => Some(Glyphs::HalfBlock),
            Some("ascii") => Some(Glyphs::Ascii),
            _ => None,
        };
        let frames = options.count("fps");
        Self {
            // a name wins over going on with the last session
            resume: open.is_none() && options.is_on("resume"),
            open,
            colour,
            glyphs,
            frames,
            unsynchronized: options.is_on("no-sync"),
            mouse: options.is_on("mouse"),
            watch: options.is_on("watch"),
        }
    }

    /// How the screen looks, `variable` being the environment.
    pub(super) fn look(&self, variable: &dyn Fn(&str) -> Option<String>) -> Look {
        let depth = self.colour.unwrap_or_else(|| ColourDepth::from_environment(variable));
        let glyphs = self.glyphs.unwrap_or_else(|| Glyphs::from_environment(variable));
        Look { theme: Theme::dark(depth), glyphs }
    }

    /// How fast frames come.
    pub(super) fn pace(&self, variable: &dyn Fn(&str) -> Option<String>) -> Pace {
        let far = ["SSH_CONNECTION", "SSH_TTY"].iter().any(|name| variable(name).is_some());
        let frames = self.frames.unwrap_or(if far { FAR } else { NEAR });
        Pace { frames, synchronized: !self.unsynchronized, mouse: self.mouse }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_fewer_at_the_end_of_a_line() {
        let frames = |request: &Request, set: &str| {
            request.pace(&|name| (name == set).then(|| "value".to_owned())).frames
        };
        let plain = Request::default();
        assert_eq!(frames(&plain, "HOME"), 30);
        assert_eq!(frames(&plain, "SSH_TTY"), 15);
        assert_eq!(frames(&plain, "SSH_CONNECTION"), 15);
        let asked = Request { frames: Some(60), ..Request::default() };
        assert_eq!(frames(&asked, "SSH_TTY"), 60);
    }

    #[test]
    fn what_is_asked_for_wins_over_the_environment() {
        let variable = |name: &str| match name {
            "TERM" => Some("xterm-256color".to_owned()),
            "LANG" => Some("C".to_owned()),
            "NO_COLOR" => Some("1".to_owned()),
            _ => None,
        };
        let look = Request::default().look(&variable);
        assert_eq!((look.theme.depth(), look.glyphs), (ColourDepth::None, Glyphs::Ascii));
        let asked = Request {
            colour: Some(ColourDepth::True),
            glyphs: Some(Glyphs::HalfBlock),
            ..Request::default()
        };
        let look = asked.look(&variable);
        assert_eq!((look.theme.depth(), look.glyphs), (ColourDepth::True, Glyphs::HalfBlock));
    }
}
