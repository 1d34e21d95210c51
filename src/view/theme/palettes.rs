//! The palettes: one constant each, listed in [`PALETTES`].
//!
//! In: nothing. Out: colours by role. Never here: what a terminal can show of them.
//!
//! The series' hues are based on the set of M. Okabe and K. Ito, "Color Universal Design" (2008), which people with
//! the common kinds of colour blindness can distinguish; their lightness is adjusted to each background.

use ratatui::style::{Color, Modifier};

use super::role::{CURVES, PaletteColour, Role};
use crate::view::colour::{ColourDepth, Rgb};

/// A named set of colours.
#[derive(Debug)]
pub struct Palette {
    /// The name by which it is selected.
    pub name: &'static str,
    /// One line about it.
    pub about: &'static str,
    /// The terminal background for which it is designed; it is not painted.
    pub background: Rgb,
    /// The colour with the highest contrast on that background.
    pub foreground: Rgb,
    /// The colours of [`Role::ALL`], in that order.
    pub roles: [PaletteColour; Role::ALL.len()],
    /// The colours of series.
    pub curves: [PaletteColour; CURVES],
    /// The control colours of the density ramp, from sparse to dense, with increasing contrast.
    pub heat: [PaletteColour; 4],
    /// The greatest depth of colour it uses.
    pub most: ColourDepth,
}

impl Palette {
    /// Whether it is designed for a dark background.
    pub fn is_dark(&self) -> bool {
        self.background.brightness() < self.foreground.brightness()
    }

    /// A colour with a share of the background, or with as much of it as leaves a line legible.
    pub(super) fn faded(&self, colour: Rgb, share: f64) -> Rgb {
        let shares = (0..=FADES).rev().map(|step| share * f64::from(step) / f64::from(FADES));
        let mut faded = shares.map(|share| colour.mix(self.background, share));
        faded.find(|faded| faded.contrast(self.background) >= LINE).unwrap_or(colour)
    }
}

/// The least contrast of a line with the background. Source: WCAG 2.2, "non-text contrast".
const LINE: f64 = 3.0;

/// The steps in which a colour is faded.
const FADES: u32 = 16;

/// Every palette; the first is the default.
pub const PALETTES: [Palette; 5] = [DARK, LIGHT, CONTRAST, COLOUR_BLIND, TERMINAL];

const NONE: Modifier = Modifier::empty();
const BOLD: Modifier = Modifier::BOLD;
const DIM: Modifier = Modifier::DIM;
const REVERSED: Modifier = Modifier::REVERSED;
const UNDERLINED: Modifier = Modifier::UNDERLINED;

const fn ink(hex: u32, ansi: Color, weight: Modifier, mono: Modifier) -> PaletteColour {
    let rgb = Rgb((hex >> 16) as u8, (hex >> 8) as u8, hex as u8);
    PaletteColour { rgb: Some(rgb), ansi, weight, mono }
}

/// The terminal's own foreground.
const fn own(weight: Modifier, mono: Modifier) -> PaletteColour {
    PaletteColour { rgb: None, ansi: Color::Reset, weight, mono }
}

/// Medium tones: bright enough on black, and dark enough to be legible if the terminal is white.
const DARK: Palette = Palette {
    name: "dark",
    about: "for dark terminals, legible on light ones",
    background: Rgb(0x1a, 0x1b, 0x26),
    foreground: Rgb(0xff, 0xff, 0xff),
    roles: [
        own(NONE, NONE),
        ink(0x8c_90_9e, Color::Gray, NONE, DIM),
        ink(0x3f_a7_d6, Color::Cyan, NONE, BOLD),
        own(BOLD, UNDERLINED),
        ink(0x6a_6f_88, Color::DarkGray, NONE, DIM),
        ink(0xd7_8f_2f, Color::Yellow, BOLD, NONE),
        ink(0x3f_a8_6a, Color::Green, NONE, NONE),
        ink(0xc4_96_1a, Color::Yellow, NONE, UNDERLINED),
        ink(0xe8_64_5a, Color::LightRed, BOLD, REVERSED),
        own(REVERSED, NONE),
        ink(0xd8_6f_a8, Color::LightMagenta, NONE, BOLD),
        ink(0x6a_80_b2, Color::DarkGray, NONE, DIM),
    ],
    curves: [
        ink(0x4f_b3_e8, Color::Cyan, NONE, NONE),
        ink(0xe6_9a_1f, Color::Yellow, NONE, BOLD),
        ink(0x2f_b3_84, Color::Green, NONE, DIM),
        ink(0xd6_7f_b4, Color::Magenta, NONE, NONE),
        ink(0xe8_6a_3f, Color::Red, NONE, BOLD),
        ink(0x7a_8c_f0, Color::Blue, NONE, DIM),
        ink(0xb8_bc_c8, Color::Gray, NONE, NONE),
    ],
    heat: [
        ink(0x6a_5f_c0, Color::LightBlue, NONE, NONE),
        ink(0x2f_7f_a8, Color::Cyan, NONE, NONE),
        ink(0x4f_bf_7a, Color::Yellow, NONE, NONE),
        ink(0xf5_e6_5a, Color::White, NONE, NONE),
    ],
    most: ColourDepth::True,
};

/// Dark tones on white.
const LIGHT: Palette = Palette {
    name: "light",
    about: "for light terminals",
    background: Rgb(0xff, 0xff, 0xff),
    foreground: Rgb(0x00, 0x00, 0x00),
    roles: [
        own(NONE, NONE),
        ink(0x5c_60_70, Color::Reset, NONE, DIM),
        ink(0x00_5f_9e, Color::Blue, NONE, BOLD),
        own(BOLD, UNDERLINED),
        ink(0x8a_8e_a0, Color::DarkGray, NONE, DIM),
        ink(0xa0_4a_00, Color::Blue, BOLD, NONE),
        ink(0x00_6e_3a, Color::Reset, NONE, NONE),
        ink(0x8a_5a_00, Color::Magenta, NONE, UNDERLINED),
        ink(0xb8_1c_1c, Color::Red, BOLD, REVERSED),
        own(REVERSED, NONE),
        ink(0xa0_2c_78, Color::Magenta, NONE, BOLD),
        ink(0x6b_7c_a8, Color::DarkGray, NONE, DIM),
    ],
    curves: [
        ink(0x00_6a_a8, Color::Blue, NONE, NONE),
        ink(0x94_66_00, Color::Red, NONE, BOLD),
        ink(0x00_78_50, Color::Green, NONE, DIM),
        ink(0xa8_3c_80, Color::Magenta, NONE, NONE),
        ink(0xcc_33_11, Color::Red, NONE, BOLD),
        ink(0x4a_3c_c0, Color::Blue, NONE, DIM),
        ink(0x50_54_60, Color::Black, NONE, NONE),
    ],
    heat: [
        ink(0x9a_8a_20, Color::Cyan, NONE, NONE),
        ink(0x2f_8a_5c, Color::DarkGray, NONE, NONE),
        ink(0x2a_60_90, Color::Red, NONE, NONE),
        ink(0x30_18_60, Color::Black, NONE, NONE),
    ],
    most: ColourDepth::True,
};

/// Strong tones on black: all text has a contrast of at least 7 to 1, frames and level curves 4.5.
const CONTRAST: Palette = Palette {
    name: "contrast",
    about: "high contrast, for black terminals",
    background: Rgb(0x00, 0x00, 0x00),
    foreground: Rgb(0xff, 0xff, 0xff),
    roles: [
        own(NONE, NONE),
        ink(0xd0_d0_d0, Color::Gray, NONE, DIM),
        ink(0x5f_ff_ff, Color::LightCyan, BOLD, BOLD),
        own(BOLD, UNDERLINED),
        ink(0xa8_a8_a8, Color::Gray, NONE, DIM),
        ink(0xff_ff_00, Color::LightYellow, BOLD, NONE),
        ink(0x5f_ff_5f, Color::LightGreen, BOLD, NONE),
        ink(0xff_ff_00, Color::LightYellow, BOLD, UNDERLINED),
        ink(0xff_87_87, Color::LightRed, BOLD, REVERSED),
        own(REVERSED, NONE),
        ink(0xff_87_ff, Color::LightMagenta, BOLD, BOLD),
        ink(0x87_af_ff, Color::Gray, NONE, DIM),
    ],
    curves: [
        ink(0x5f_d7_ff, Color::LightCyan, NONE, NONE),
        ink(0xff_d7_00, Color::LightYellow, NONE, BOLD),
        ink(0x5f_ff_87, Color::LightGreen, NONE, DIM),
        ink(0xff_87_ff, Color::LightMagenta, NONE, NONE),
        ink(0xff_87_5f, Color::LightRed, NONE, BOLD),
        ink(0x9a_9a_ff, Color::Cyan, NONE, DIM),
        ink(0xff_ff_ff, Color::White, NONE, NONE),
    ],
    heat: [
        ink(0x5f_5f_ff, Color::LightBlue, NONE, NONE),
        ink(0x00_af_ff, Color::Cyan, NONE, NONE),
        ink(0x5f_ff_af, Color::LightYellow, NONE, NONE),
        ink(0xff_ff_d7, Color::White, NONE, NONE),
    ],
    most: ColourDepth::True,
};

/// Verdicts in blue, yellow and vermilion; nothing depends on distinguishing red from green.
const COLOUR_BLIND: Palette = Palette {
    name: "colour-blind",
    about: "safe for red-green colour blindness",
    background: Rgb(0x14, 0x16, 0x1c),
    foreground: Rgb(0xff, 0xff, 0xff),
    roles: [
        own(NONE, NONE),
        ink(0x9a_9e_aa, Color::Gray, NONE, DIM),
        ink(0x6c_b8_f0, Color::LightCyan, NONE, BOLD),
        own(BOLD, UNDERLINED),
        ink(0x6a_70_80, Color::DarkGray, NONE, DIM),
        ink(0xf0_e4_42, Color::LightYellow, BOLD, NONE),
        ink(0x56_b4_e9, Color::LightCyan, NONE, NONE),
        ink(0xf0_e4_42, Color::LightYellow, NONE, UNDERLINED),
        ink(0xe8_72_22, Color::LightRed, BOLD, REVERSED),
        own(REVERSED, NONE),
        ink(0xe6_9f_d0, Color::LightMagenta, NONE, BOLD),
        ink(0x66_7b_a8, Color::DarkGray, NONE, DIM),
    ],
    curves: [
        ink(0x56_b4_e9, Color::LightCyan, NONE, NONE),
        ink(0xe6_9f_00, Color::Yellow, NONE, BOLD),
        ink(0x00_9e_73, Color::Green, NONE, DIM),
        ink(0xf0_e4_42, Color::LightYellow, NONE, NONE),
        ink(0x4a_7c_e8, Color::LightBlue, NONE, BOLD),
        ink(0xd5_5e_00, Color::LightRed, NONE, DIM),
        ink(0xe8_c8_e0, Color::White, NONE, NONE),
    ],
    heat: [
        ink(0x54_68_a8, Color::LightBlue, NONE, NONE),
        ink(0x56_84_b0, Color::Cyan, NONE, NONE),
        ink(0xc0_b0_60, Color::LightYellow, NONE, NONE),
        ink(0xff_f4_b0, Color::White, NONE, NONE),
    ],
    most: ColourDepth::True,
};

/// The sixteen colours configured in the terminal, even if it supports more.
const TERMINAL: Palette = Palette {
    name: "terminal",
    about: "the terminal's own sixteen colours",
    background: Rgb(0x00, 0x00, 0x00),
    most: ColourDepth::Ansi16,
    ..DARK
};
