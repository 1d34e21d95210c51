//! The request: what to open and how to show it, with defaults from the environment.
//!
//! In: [`Options`]. Out: the render style and the frame settings. Never here: where options come from; what the
//! terminal answers.

use crate::experiment::Checkpoint;
use crate::view::RenderStyle;
use crate::view::colour::ColourDepth;
use crate::view::glyphs::Glyphs;
use crate::view::theme::Theme;

use super::bandwidth::Bandwidth;
use super::frame_loop::FramePace;
use super::log::LogFile;
use super::options::{MOST_FRAMES, Options};
use super::question::{self, Questions};

/// The frames per second on a local terminal.
const NEAR: u16 = 30;

/// The frames per second over a remote connection.
const FAR: u16 = 15;

/// The maximum if motion is to be reduced.
const CALM: u16 = 4;

/// The default bytes per second over a remote connection: half a megabit, which every connection suitable for
/// viewing pictures has. More would only fill the buffers on the way, and delay the response to every key.
const LINE: u32 = 64 * 1024;

/// What to open the laboratory with.
#[derive(Clone, Debug, Default)]
pub struct Request {
    /// A preset's name or a file's path; with `None` the picker opens.
    pub open: Option<String>,
    /// The motion that begins there; by default as the file says.
    pub start: Option<Checkpoint>,
    /// Whether to resume the last session.
    pub resume: bool,
    /// How many colours to use; by default the environment decides.
    pub colour: Option<ColourDepth>,
    /// What to draw with; by default the environment decides.
    pub glyphs: Option<Glyphs>,
    /// The maximum number of frames per second; by default 30, and 15 if `SSH_CONNECTION` or `SSH_TTY` is set.
    pub frames: Option<u16>,
    /// The name of the theme; by default the terminal is asked for its background, and gets the one for dark
    /// terminals until it answers, or the one for light ones if `COLORFGBG` indicates that.
    pub theme: Option<String>,
    /// Whether to omit the marks around each frame, for terminals that show them.
    pub unsynchronized: bool,
    /// The maximum number of bytes per second; by default no limit, and 64 KiB if `SSH_CONNECTION` or `SSH_TTY` is
    /// set.
    pub bandwidth: Option<Bandwidth>,
    /// Whether to reduce motion: at most 4 frames per second, and trails that do not fade.
    pub reduced_motion: bool,
    /// Where to write the log, if anywhere.
    pub log: Option<LogFile>,
    /// Whether to capture the mouse from the start.
    pub mouse: bool,
    /// Whether to rebuild the system whenever its file has changed.
    pub watch: bool,
}

impl Request {
    /// Creates the request from the options.
    pub fn new(open: Option<String>, options: &Options) -> Self {
        Self {
            // A name takes precedence over resuming the last session.
            resume: open.is_none() && options.resume,
            open,
            start: None,
            colour: options.color.depth(),
            glyphs: options.glyphs.glyphs(),
            frames: options.fps.given().map(|frames| frames.0),
            theme: Some(options.theme.clone()).filter(|name| name != "auto"),
            unsynchronized: options.no_sync,
            mouse: options.mouse,
            watch: options.watch,
            log: options.log.0.clone(),
            bandwidth: options.bandwidth.given(),
            reduced_motion: options.reduce_motion,
        }
    }

    /// Returns the render style; `variable` reads the environment.
    pub(super) fn render_style(&self, variable: &dyn Fn(&str) -> Option<String>) -> RenderStyle {
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

    /// Returns the maximum number of frames per second that may be requested.
    pub(super) fn most_frames(&self) -> u16 {
        if self.reduced_motion { CALM } else { MOST_FRAMES }
    }

    pub(super) fn pace(&self, variable: &dyn Fn(&str) -> Option<String>) -> FramePace {
        let far = ["SSH_CONNECTION", "SSH_TTY"].iter().any(|name| variable(name).is_some());
        let frames = self.frames.unwrap_or(if far { FAR } else { NEAR }).min(self.most_frames());
        let bandwidth = if far { Bandwidth::Bytes(LINE) } else { Bandwidth::Unlimited };
        let bytes = self.bandwidth.unwrap_or(bandwidth).bytes();
        let colour = self.colour.unwrap_or_else(|| ColourDepth::from_environment(variable));
        let keyboard = question::can_be_asked(variable);
        let background = keyboard && self.theme.is_none() && colour != ColourDepth::None;
        let asks = Questions { background, keyboard };
        let (synchronized, mouse) = (!self.unsynchronized, self.mouse);
        FramePace { frames, bytes, synchronized, mouse, asks }
    }
}

/// Whether the terminal reports a light background: some terminals put the numbers of their foreground and
/// background colours into `COLORFGBG`.
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
    fn a_line_is_taken_for_slow_unless_its_rate_is_given() {
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
        let style =
            request(None).render_style(&|name| (name == "TERM").then(|| "xterm-direct".to_owned()));
        assert_eq!(style.theme.trail(0).len(), 1);
        assert_eq!(style.reduced(crate::view::Detail::default()).theme.trail(0).len(), 1);
    }

    #[test]
    fn the_theme_is_the_one_asked_for_or_suits_the_terminal() {
        let theme = |asked: Option<&str>, colours: &str| {
            let request = Request { theme: asked.map(str::to_owned), ..Request::default() };
            let style =
                request.render_style(&|name| (name == "COLORFGBG").then(|| colours.to_owned()));
            style.theme.palette().name
        };
        assert_eq!(theme(None, ""), "dark");
        assert_eq!(theme(None, "15;0"), "dark");
        assert_eq!(theme(None, "0;15"), "light");
        assert_eq!(theme(None, "0;default;15"), "light");
        assert_eq!(theme(Some("contrast"), "0;15"), "contrast");
    }

    #[test]
    fn a_terminal_is_asked_for_its_background_only_where_the_answer_matters() {
        let asks = |request: Request, environment: &[(&str, &str)]| {
            let variable = |name: &str| {
                let found = environment.iter().find(|(other, _)| *other == name);
                found.map(|(_, value)| (*value).to_owned())
            };
            request.pace(&variable).asks.background
        };
        let xterm = ("TERM", "xterm-256color");
        assert!(asks(Request::default(), &[xterm]));
        assert!(asks(Request::default(), &[xterm, ("COLORFGBG", "15;0")]));
        assert!(!asks(Request::default(), &[("TERM", "linux")]));
        assert!(!asks(Request::default(), &[xterm, ("NO_COLOR", "1")]));
        let theme = Some("dark".to_owned());
        assert!(!asks(Request { theme, ..Request::default() }, &[xterm]));
        let colour = Some(ColourDepth::None);
        assert!(!asks(Request { colour, ..Request::default() }, &[xterm]));
    }

    #[test]
    fn what_is_asked_for_wins_over_the_environment() {
        let variable = |name: &str| match name {
            "TERM" => Some("xterm-256color".to_owned()),
            "LANG" => Some("C".to_owned()),
            "NO_COLOR" => Some("1".to_owned()),
            _ => None,
        };
        let style = Request::default().render_style(&variable);
        assert_eq!((style.theme.depth(), style.glyphs), (ColourDepth::None, Glyphs::Ascii));
        let asked = Request {
            colour: Some(ColourDepth::True),
            glyphs: Some(Glyphs::HalfBlock),
            ..Request::default()
        };
        let style = asked.render_style(&variable);
        assert_eq!((style.theme.depth(), style.glyphs), (ColourDepth::True, Glyphs::HalfBlock));
    }
}
