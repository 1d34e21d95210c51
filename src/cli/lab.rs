//! `phaselab [PRESET|FILE]`: the laboratory on the screen.

use clap::ValueEnum;

use super::failure::Failure;
use crate::shell::{self, Ending, NoSession, Refusal, Request};
use crate::view::colour::ColourDepth;
use crate::view::glyphs::Glyphs;

/// What to open and how to show it.
#[derive(Debug, clap::Args)]
#[group(skip)]
pub(super) struct Arguments {
    /// A preset's name, or a file.
    #[arg(value_name = "PRESET|FILE")]
    name: Option<String>,
    /// Go on with the last session: its system, views, values and motion.
    #[arg(long, conflicts_with = "name")]
    resume: bool,
    /// How many colours to use.
    #[arg(long, value_enum, value_name = "COLOURS", default_value_t)]
    color: Colours,
    /// What to draw with.
    #[arg(long, value_enum, value_name = "GLYPHS", default_value_t)]
    glyphs: Drawn,
    /// The most frames in a second; 30 where it is left out, 15 over ssh.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=240))]
    fps: Option<u16>,
    /// Leave out the marks round each frame, for a terminal that shows them.
    #[arg(long)]
    no_sync: bool,
    /// Use the mouse from the beginning; in the lab M switches it on and off.
    ///
    /// While it is on, the terminal's own selection of text needs Shift held.
    #[arg(long)]
    mouse: bool,
}

#[derive(Clone, Copy, Debug, Default, ValueEnum)]
enum Colours {
    /// What the environment says: NO_COLOR, COLORTERM, TERM.
    #[default]
    Auto,
    /// None.
    Never,
    /// The terminal's own sixteen.
    #[value(name = "16")]
    Sixteen,
    /// The xterm palette.
    #[value(name = "256")]
    Palette,
    /// 24 bits.
    True,
}

#[derive(Clone, Copy, Debug, Default, ValueEnum)]
enum Drawn {
    /// What the locale says: LC_ALL, LC_CTYPE, LANG.
    #[default]
    Auto,
    /// Braille patterns, the finest.
    Braille,
    /// Half blocks.
    Half,
    /// ASCII only.
    Ascii,
}

pub(super) fn perform(arguments: &Arguments) -> Result<(), Failure> {
    let request = Request {
        open: arguments.name.clone(),
        resume: arguments.resume,
        colour: match arguments.color {
            Colours::Auto => None,
            Colours::Never => Some(ColourDepth::None),
            Colours::Sixteen => Some(ColourDepth::Ansi16),
            Colours::Palette => Some(ColourDepth::Ansi256),
            Colours::True => Some(ColourDepth::True),
        },
        glyphs: match arguments.glyphs {
            Drawn::Auto => None,
            Drawn::Braille => Some(Glyphs::Braille),
            Drawn::Half => Some(Glyphs::HalfBlock),
            Drawn::Ascii => Some(Glyphs::Ascii),
        },
        frames: arguments.fps,
        unsynchronized: arguments.no_sync,
        mouse: arguments.mouse,
    };
    match shell::run(&request) {
        Ok(Ending::Quit) => Ok(()),
        Ok(Ending::Gone) => Err(Failure::Signal(signal_hook::consts::SIGHUP)),
        Ok(Ending::Signal(number)) => Err(Failure::Signal(number)),
        Err(refusal @ Refusal::System(_)) => Err(Failure::CouldNot(refusal.to_string())),
        Err(refusal @ Refusal::Unsaved(_)) => Err(Failure::CouldNotWrite(refusal.to_string())),
        Err(Refusal::NoSession(why @ (NoSession::Newer { .. } | NoSession::Malformed { .. }))) => {
            Err(Failure::WrongFile(why.to_string()))
        }
        Err(refusal) => Err(Failure::WrongUse(refusal.to_string())),
    }
}
