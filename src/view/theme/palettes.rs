//! The palettes: one constant each, listed in [`PALETTES`].
//!
//! In: nothing. Out: colours by role. Never here: what a terminal can show of them.
//!
//! The series' hues start from the set of M. Okabe and K. Ito, "Color Universal Design" (2008), which people with
//! the common kinds of colour blindness can tell apart; they are moved in lightness to suit each background.

use ratatui::style::{Color, Modifier};

use super::{CURVES, Ink, Role};
use crate::view::colour::Rgb;

/// A named set of colours.
#[derive(Debug)]
pub struct Palette {
    /// How it is asked for.
    pub name: &'static str,
    /// One line about it.
    pub about: &'static str,
    /// The terminal background it is made for; it is not painted.
    pub background: Rgb,
    /// The strongest colour on that background.
    pub foreground: Rgb,
    /// The inks of [`Role::ALL`], in that order.
    pub roles: [Ink; Role::ALL.len()],
    /// The colours of series.
    pub curves: [Ink; CURVES],
    /// Anchors of the density ramp, sparse to dense, of growing contrast.
    pub heat: [Ink; 4],
}

/// Every palette; the first is the default.
pub const PALETTES: [Palette; 2] = [DARK, LIGHT];

const NONE: Modifier = Modifier::empty();
const BOLD: Modifier = Modifier::BOLD;
const DIM: Modifier = Modifier::DIM;
const REVERSED: Modifier = Modifier::REVERSED;
const UNDERLINED: Modifier = Modifier::UNDERLINED;

const fn ink(hex: u32, ansi: Color, weight: Modifier, mono: Modifier) -> Ink {
    let rgb = Rgb((hex >> 16) as u8, (hex >> 8) as u8, hex as u8);
    Ink { rgb: Some(rgb), ansi, weight, mono }
}

/// The terminal's own foreground.
const fn own(weight: Modifier, mono: Modifier) -> Ink {
    Ink { rgb: None, ansi: Color::Reset, weight, mono }
}

/// Middle tones: bright enough for black, and still dark enough to be read should the terminal be white.
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
        ink(0x5a_60_78, Color::DarkGray, NONE, DIM),
        ink(0xd7_8f_2f, Color::Yellow, BOLD, NONE),
        ink(0x3f_a8_6a, Color::Green, NONE, NONE),
        ink(0xc4_96_1a, Color::Yellow, NONE, UNDERLINED),
        ink(0xe8_64_5a, Color::LightRed, BOLD, REVERSED),
        own(REVERSED, NONE),
        ink(0xd8_6f_a8, Color::LightMagenta, NONE, BOLD),
        ink(0x5c_6f_9c, Color::DarkGray, NONE, DIM),
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
        ink(0x4a_3f_8c, Color::LightBlue, NONE, NONE),
        ink(0x2f_7f_a8, Color::Cyan, NONE, NONE),
        ink(0x4f_bf_7a, Color::Yellow, NONE, NONE),
        ink(0xf5_e6_5a, Color::White, NONE, NONE),
    ],
};

/// Deep tones on white.
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
        ink(0x9a_9e_ac, Color::DarkGray, NONE, DIM),
        ink(0xa0_4a_00, Color::Red, BOLD, NONE),
        ink(0x00_6e_3a, Color::Reset, NONE, NONE),
        ink(0x8a_5a_00, Color::Magenta, NONE, UNDERLINED),
        ink(0xb8_1c_1c, Color::Red, BOLD, REVERSED),
        own(REVERSED, NONE),
        ink(0xa0_2c_78, Color::Magenta, NONE, BOLD),
        ink(0x8c_9a_bc, Color::DarkGray, NONE, DIM),
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
        ink(0xc8_b8_50, Color::Cyan, NONE, NONE),
        ink(0x3f_a0_70, Color::DarkGray, NONE, NONE),
        ink(0x2a_60_90, Color::Red, NONE, NONE),
        ink(0x30_18_60, Color::Black, NONE, NONE),
    ],
};
