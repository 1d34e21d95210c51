//! The request: what to open and how to show it, and what the environment says where nothing is asked for.
//!
//! In: [`Options`]. Out: the look and the pace. Never here: where options come from; a question put to the terminal.

use crate::preset::NotFound;
use crate::view::RenderStyle;
use crate::view::colour::ColourDepth;
use crate::view::glyphs::Glyphs;
use crate::view::theme::Theme;

use super::bandwidth::Bandwidth;
use super::frame_loop::Pace;
use super::log::{LogError, LogFile};
use super::options::Options;
use super::store::SessionError;
use super::terminal::TerminalError;

/// Frames in a second where the terminal is near.
const NEAR: u16 = 30;

/// The same at the other end of a line.
const FAR: u16 = 15;

/// The most frames in a second that can be asked for.
pub const MOST_FRAMES: u16 = 240;

/// The same where motion is to be reduced.
const CALM: u16 = 4;

/// Bytes in a second at the other end of a line where nothing is said of it: half a megabit, which every line has that
/// one would look at a picture over. More would only fill the buffers on the way, and every key would wait behind them.
const LINE: u32 = 64 * 1024;

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
    /// The name of the theme; otherwise the one for dark terminals, or for light ones where `COLORFGBG` says so.
    pub theme: Option<String>,
    /// Leaves out the marks round each frame, for terminals that show them.
    pub unsynchronized: bool,
    /// The most bytes in a second; otherwise no limit, and 64 KiB where `SSH_CONNECTION` or `SSH_TTY` is set.
    pub bandwidth: Option<Bandwidth>,
    /// Draws little that moves: at most 4 frames a second, and trails that do not fade.
    pub reduced_motion: bool,
    /// Where to write what happens, if anywhere.
    pub log: Option<LogFile>,
    /// Has the mouse reported from the beginning.
    pub mouse: bool,
    /// Builds the system anew whenever its file has changed.
    pub watch: bool,
}

/// Why the laboratory does not open.
#[derive(Debug, thiserror::Error)]
pub enum LabError {
    /// There is no terminal.
    #[error(transparent)]
    TerminalError(#[from] TerminalError),
    /// What was asked for is not there.
    #[error(transparent)]
    NotFound(#[from] NotFound),
    /// There is no session to go on with.
    #[error(transparent)]
    SessionError(#[from] SessionError),
    /// The laboratory was left, and its session could not be saved.
    #[error("the session is not saved: {0}")]
    Unsaved(std::io::Error),
    /// The log cannot be written.
    #[error(transparent)]
    LogError(#[from] LogError),
    /// The laboratory was left, and what it recorded could not be saved.
    #[error("the recording is not whole: {0}")]
    Unrecorded(std::io::Error),
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
        let glyphs = options.get("glyphs").and_then(Glyphs::named);
        let frames = options.count("fps");
        let theme = options.get("theme").filter(|name| *name != "auto").map(str::to_owned);
        Self {
            // a name wins over going on with the last session
            resume: open.is_none() && options.is_on("resume"),
            open,
            colour,
            glyphs,
            frames,
            theme,
            unsynchronized: options.is_on("no-sync"),
            mouse: options.is_on("mouse"),
            watch: options.is_on("watch"),
            log: match options.get("log") {
                None | Some("off") => None,
                Some("state") => Some(LogFile::Usual),
                Some(path) => Some(LogFile::At(path.into())),
            },
            bandwidth: options.get("bandwidth").and_then(|word| word.parse().ok()),
            reduced_motion: options.is_on("reduce-motion"),
        }
    }

    /// How the screen looks, `variable` being the environment.
    pub(super) fn look(&self, variable: &dyn Fn(&str) -> Option<String>) -> RenderStyle {
        let depth = self.colour.unwrap_or_else(|| ColourDepth::from_environment(variable));
        let glyphs = self.glyphs.unwrap_or_else(|| Glyphs::from_environment(variable));
        let named = self.theme.as_deref().and_then(|name| Theme::named(name, depth));
        let theme = named.unwrap_or_else(|| {
            let name = if is_light(variable) { "light" } else { "dark" };
            Theme::named(name, depth).unwrap_or_else(|| Theme::dark(depth))
        });
        let theme = if self.reduced_motion { theme.with_ages(1) } else { theme };
        RenderStyle { theme, glyphs }
    }

    /// The most frames in a second that may be asked for.
    pub(super) fn most_frames(&self) -> u16 {
        if self.reduced_motion { CALM } else { MOST_FRAMES }
    }

    /// How fast frames come.
    pub(super) fn pace(&self, variable: &dyn Fn(&str) -> Option<String>) -> Pace {
        let far = ["SSH_CONNECTION", "SSH_TTY"].iter().any(|name| variable(name).is_some());
        let frames = self.frames.unwrap_or(if far { FAR } else { NEAR }).min(self.most_frames());
        let bandwidth = if far { Bandwidth::Bytes(LINE) } else { Bandwidth::Unlimited };
        let bytes = self.bandwidth.unwrap_or(bandwidth).bytes();
        Pace { frames, bytes, synchronized: !self.unsynchronized, mouse: self.mouse }
    }
}

/// Whether the terminal says that it is light: some put the numbers of their colours, foreground and background, into
/// `COLORFGBG`.
fn is_light(variable: &dyn Fn(&str) -> Option<String>) -> bool {
    let colours = variable("COLORFGBG").unwrap_or_default();
    matches!(colours.rsplit(';').next(), Some("7" | "15"))
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
    fn a_line_is_taken_for_slow_unless_it_is_said_how_fast_it_is() {
        let bytes = |bandwidth: Option<Bandwidth>, set: &str| {
            let request = Request { bandwidth, ..Request::default() };
            request.pace(&|name| (name == set).then(|| "value".to_owned())).bytes
        };
        assert_eq!(bytes(None, "HOME"), None);
        assert_eq!(bytes(None, "SSH_TTY"), Some(64 * 1024));
        assert_eq!(bytes(Some(Bandwidth::Unlimited), "SSH_TTY"), None);
        assert_eq!(bytes(Some(Bandwidth::Bytes(16_384)), "HOME"), Some(16_384));
    }

    #[test]
    fn reduced_motion_is_few_frames_and_no_fading() {
        let request = |frames| Request { reduced_motion: true, frames, ..Request::default() };
        for (asked, frames) in [(None, 4), (Some(60), 4), (Some(2), 2)] {
            assert_eq!(request(asked).pace(&|_| None).frames, frames);
        }
        let look = request(None).look(&|name| (name == "TERM").then(|| "xterm-direct".to_owned()));
        assert_eq!(look.theme.trail(0).len(), 1);
        assert_eq!(look.reduced(crate::view::Detail::default()).theme.trail(0).len(), 1);
    }

    #[test]
    fn the_theme_is_the_one_asked_for_or_suits_the_terminal() {
        let theme = |asked: Option<&str>, colours: &str| {
            let request = Request { theme: asked.map(str::to_owned), ..Request::default() };
            let look = request.look(&|name| (name == "COLORFGBG").then(|| colours.to_owned()));
            look.theme.palette().name
        };
        assert_eq!(theme(None, ""), "dark");
        assert_eq!(theme(None, "15;0"), "dark");
        assert_eq!(theme(None, "0;15"), "light");
        assert_eq!(theme(None, "0;default;15"), "light");
        assert_eq!(theme(Some("contrast"), "0;15"), "contrast");
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
