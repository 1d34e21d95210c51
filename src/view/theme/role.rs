//! Roles of the screen's parts, and the colours and shades that a palette gives them.
//!
//! In: nothing. Out: the types. Never here: the colours of a palette.

use ratatui::style::{Color, Modifier, Style};

use super::dash::Dash;
use crate::view::colour::{ColourDepth, Rgb};

/// The purpose of a part of the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Role {
    /// Ordinary text, in the terminal's own colour.
    Text,
    /// Secondary text: units, ticks, hints.
    Dim,
    /// Emphasized text: a changing value, the key of a hint.
    Accent,
    /// Titles of panes and pages.
    Title,
    /// Axes, and frames of panes without the focus.
    Border,
    /// The frame of the pane with the focus.
    Focus,
    /// A good verdict.
    Good,
    /// A verdict that needs attention.
    Warn,
    /// A bad verdict, or an error.
    Bad,
    /// The selected row of a list.
    Selected,
    /// The separatrix among the level curves.
    Separatrix,
    /// Level curves of H and other constructions behind the motion.
    Level,
}

impl Role {
    /// Every role, in the order in which palettes list them.
    pub const ALL: [Self; 12] = [
        Self::Text,
        Self::Dim,
        Self::Accent,
        Self::Title,
        Self::Border,
        Self::Focus,
        Self::Good,
        Self::Warn,
        Self::Bad,
        Self::Selected,
        Self::Separatrix,
        Self::Level,
    ];
}

/// One colour of a palette: in 24 bits, among the sixteen, and its substitute without colour.
#[derive(Clone, Copy, Debug)]
pub struct PaletteColour {
    /// The colour; `None` is the terminal's own foreground.
    pub rgb: Option<Rgb>,
    /// The nearest of the terminal's sixteen colours.
    pub ansi: Color,
    /// Modifiers used at every depth.
    pub weight: Modifier,
    /// Modifiers that replace the colour if there is none.
    pub mono: Modifier,
}

impl PaletteColour {
    /// The style of this colour at a depth.
    pub fn style(&self, depth: ColourDepth) -> Style {
        let style = Style::new().add_modifier(self.weight);
        match (depth, self.rgb) {
            (ColourDepth::None, _) => style.add_modifier(self.mono),
            (ColourDepth::Ansi16, _) => style.fg(self.ansi),
            (_, None) => style.fg(Color::Reset),
            (ColourDepth::Ansi256, Some(rgb)) => style.fg(Color::Indexed(rgb.nearest256())),
            (ColourDepth::True, Some(Rgb(r, g, b))) => style.fg(Color::Rgb(r, g, b)),
        }
    }
}

/// A step of a fading ramp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shade {
    /// The style of the dots.
    pub style: Style,
    /// Share of the dots that are drawn, 0 to 1; it is below 1 only if colour cannot show their age.
    pub coverage: f64,
    /// The pattern along a line.
    pub dash: Dash,
}

/// The number of series with a colour of their own.
pub const CURVES: usize = 7;
