//! Colour: how many colours the terminal supports, and how colours are mixed and compared.
//!
//! In: environment variables, sRGB triples. Out: a [`ColourDepth`], and ratatui colours that depth can show.
//! Never here: the use of a colour (see [`theme`](super::theme)), or a query to the terminal.

use std::sync::LazyLock;

use ratatui::style::Color;

use crate::num::math;

/// The number of colours that may be sent to the terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ColourDepth {
    /// No colour; bold, dim and reverse are still used.
    None,
    /// The terminal's own sixteen colours.
    Ansi16,
    /// The xterm palette: a 6×6×6 cube and a ramp of greys.
    Ansi256,
    /// 24 bits.
    True,
}

/// Terminals whose `TERM` alone implies 24-bit colour; unlike `COLORTERM` it survives ssh.
const TRUE_COLOUR_TERMS: [&str; 7] =
    ["alacritty", "contour", "foot", "wezterm", "xterm-ghostty", "xterm-kitty", "rio"];

/// Terminal families that support the xterm palette even if their name does not say so.
const PALETTE_TERMS: [&str; 9] =
    ["xterm", "tmux", "rxvt", "konsole", "gnome", "vte", "putty", "mintty", "st"];

impl ColourDepth {
    /// Reads the depth from environment variables alone, because probing the terminal leaks text in tmux and screen.
    ///
    /// `NO_COLOR` (any non-empty value) and a dumb or missing `TERM` mean none; `COLORTERM` is trusted except
    /// inside GNU screen, which garbles 24-bit sequences but inherits the variable from the outer terminal.
    pub fn from_environment(variable: &dyn Fn(&str) -> Option<String>) -> Self {
        let get = |name: &str| variable(name).filter(|value| !value.is_empty());
        let rich = get("COLORTERM").is_some_and(|c| matches!(c.as_str(), "truecolor" | "24bit"));
        if get("NO_COLOR").is_some() {
            return Self::None;
        }
        let Some(term) = get("TERM").map(|term| term.to_ascii_lowercase()) else {
            return if rich || get("WT_SESSION").is_some() { Self::True } else { Self::None };
        };
        let named = Self::of_term(&term);
        let screen = get("STY").is_some() || (term.starts_with("screen") && get("TMUX").is_none());
        if rich && named != Self::None && !screen { Self::True } else { named }
    }

    /// The depth that the name of a terminal implies; the most specific part is tested first.
    fn of_term(term: &str) -> Self {
        let family = |names: &[&str]| {
            names.iter().any(|name| {
                term.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with('-'))
            })
        };
        let vt =
            term.strip_prefix("vt").is_some_and(|r| r.starts_with(|c: char| c.is_ascii_digit()));
        if term == "dumb"
            || term == "unknown"
            || vt
            || term.ends_with("-m")
            || term.ends_with("-mono")
        {
            Self::None
        } else if term.ends_with("-direct") || family(&TRUE_COLOUR_TERMS) {
            Self::True
        } else if term.contains("256col") {
            Self::Ansi256
        } else if term.ends_with("-color")
            || term.ends_with("-16color")
            || term.ends_with("-88color")
        {
            Self::Ansi16
        } else if family(&PALETTE_TERMS) {
            Self::Ansi256
        } else {
            Self::Ansi16
        }
    }

    /// Parses a depth: `never`, `16`, `256` or `true`.
    pub fn named(name: &str) -> Option<Self> {
        Some(match name {
            "never" => Self::None,
            "16" => Self::Ansi16,
            "256" => Self::Ansi256,
            "true" => Self::True,
            _ => return None,
        })
    }
}

/// A colour in the sRGB space, 8 bits per channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Rgb(pub u8, pub u8, pub u8);

impl Rgb {
    /// Relative luminance, 0 (black) to 1 (white). Source: WCAG 2.2, "relative luminance".
    pub fn luminance(self) -> f64 {
        let [r, g, b] = self.linear();
        0.2126 * r + 0.7152 * g + 0.0722 * b
    }

    /// Contrast ratio, 1 to 21; text needs at least 4.5. Source: WCAG 2.2, "contrast ratio".
    pub fn contrast(self, other: Self) -> f64 {
        let (a, b) = (self.luminance() + 0.05, other.luminance() + 0.05);
        (a / b).max(b / a)
    }

    /// The perceptual mixture of two colours: linear interpolation in Oklab, with `share` (0 to 1) of `other`.
    #[must_use]
    pub fn mix(self, other: Self, share: f64) -> Self {
        let share = if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) };
        let (a, b) = (self.oklab(), other.oklab());
        Self::from_oklab(std::array::from_fn(|i| a[i] + share * (b[i] - a[i])))
    }

    /// The mixture of two colours channel by channel, with `share` (0 to 1) of `other`: rougher than [`mix`](Self::mix), and
    /// cheap enough for each cell of a frame.
    #[must_use]
    pub fn towards(self, other: Self, share: f64) -> Self {
        let channel =
            |from: u8, to: u8| (f64::from(from) + share * (f64::from(to) - f64::from(from))) as u8;
        Self(channel(self.0, other.0), channel(self.1, other.1), channel(self.2, other.2))
    }

    /// The grey of the same brightness.
    #[must_use]
    pub fn grey(self) -> Self {
        let level = (255.0 * self.brightness()).round() as u8;
        Self(level, level, level)
    }

    /// How bright a colour looks, 0 to 1: the luma of its channels. Source: ITU-R BT.709.
    pub fn brightness(self) -> f64 {
        let Self(r, g, b) = self;
        (0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b)) / 255.0
    }

    /// The perceptual difference of two colours: their distance in Oklab, about 1 from black to white.
    pub fn distance(self, other: Self) -> f64 {
        let (a, b) = (self.oklab(), other.oklab());
        a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
    }

    /// The perceptually nearest entry of the xterm palette, among the cube and the greys (16 to 255).
    pub fn nearest256(self) -> u8 {
        static PALETTE: LazyLock<Vec<(u8, [f64; 3])>> = LazyLock::new(|| {
            (16..=255).map(|index| (index, Rgb::of_index(index).oklab())).collect()
        });
        let here = self.oklab();
        let far =
            |there: &[f64; 3]| here.iter().zip(there).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
        let nearest = PALETTE.iter().min_by(|(_, a), (_, b)| far(a).total_cmp(&far(b)));
        nearest.map_or(16, |(index, _)| *index)
    }

    /// The colour of an entry of the xterm palette; the first sixteen are xterm's defaults, which other terminals change.
    pub fn of_index(index: u8) -> Self {
        match index {
            0 => Self(0, 0, 0),
            1 => Self(205, 0, 0),
            2 => Self(0, 205, 0),
            3 => Self(205, 205, 0),
            4 => Self(0, 0, 238),
            5 => Self(205, 0, 205),
            6 => Self(0, 205, 205),
            7 => Self(229, 229, 229),
            8 => Self(127, 127, 127),
            9 => Self(255, 0, 0),
            10 => Self(0, 255, 0),
            11 => Self(255, 255, 0),
            12 => Self(92, 92, 255),
            13 => Self(255, 0, 255),
            14 => Self(0, 255, 255),
            15 => Self(255, 255, 255),
            16..=231 => {
                let level = |n: u8| if n == 0 { 0 } else { 55 + 40 * n };
                let n = index - 16;
                Self(level(n / 36), level(n / 6 % 6), level(n % 6))
            }
            232..=255 => {
                let grey = 8 + 10 * (index - 232);
                Self(grey, grey, grey)
            }
        }
    }

    /// The value of a ratatui colour, or `None` for the terminal's default.
    pub fn of(colour: Color) -> Option<Self> {
        Some(match colour {
            Color::Reset => return None,
            Color::Rgb(r, g, b) => Self(r, g, b),
            Color::Indexed(index) => Self::of_index(index),
            Color::Black => Self::of_index(0),
            Color::Red => Self::of_index(1),
            Color::Green => Self::of_index(2),
            Color::Yellow => Self::of_index(3),
            Color::Blue => Self::of_index(4),
            Color::Magenta => Self::of_index(5),
            Color::Cyan => Self::of_index(6),
            Color::Gray => Self::of_index(7),
            Color::DarkGray => Self::of_index(8),
            Color::LightRed => Self::of_index(9),
            Color::LightGreen => Self::of_index(10),
            Color::LightYellow => Self::of_index(11),
            Color::LightBlue => Self::of_index(12),
            Color::LightMagenta => Self::of_index(13),
            Color::LightCyan => Self::of_index(14),
            Color::White => Self::of_index(15),
        })
    }

    /// The three channels in linear light, 0 to 1. Source: IEC 61966-2-1.
    fn linear(self) -> [f64; 3] {
        [self.0, self.1, self.2].map(|channel| {
            let v = f64::from(channel) / 255.0;
            if v <= 0.04045 { v / 12.92 } else { math::powf((v + 0.055) / 1.055, 2.4) }
        })
    }

    /// Lightness and two opponent colours. Source: B. Ottosson, "A perceptual color space for image processing" (2020).
    fn oklab(self) -> [f64; 3] {
        let [r, g, b] = self.linear();
        let l = math::cbrt(0.412_221_470_8 * r + 0.536_332_536_3 * g + 0.051_445_992_9 * b);
        let m = math::cbrt(0.211_903_498_2 * r + 0.680_699_545_1 * g + 0.107_396_956_6 * b);
        let s = math::cbrt(0.088_302_461_9 * r + 0.281_718_837_6 * g + 0.629_978_700_5 * b);
        [
            0.210_454_255_3 * l + 0.793_617_785_0 * m - 0.004_072_046_8 * s,
            1.977_998_495_1 * l - 2.428_592_205_0 * m + 0.450_593_709_9 * s,
            0.025_904_037_1 * l + 0.782_771_766_2 * m - 0.808_675_766_0 * s,
        ]
    }

    fn from_oklab([lightness, a, b]: [f64; 3]) -> Self {
        let l = math::powi(lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b, 3);
        let m = math::powi(lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b, 3);
        let s = math::powi(lightness - 0.089_484_177_5 * a - 1.291_485_548_0 * b, 3);
        let channel = |v: f64| {
            let v =
                if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * math::powf(v, 1.0 / 2.4) - 0.055 };
            (255.0 * v).round().clamp(0.0, 255.0) as u8
        };
        Self(
            channel(4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s),
            channel(-1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s),
            channel(-0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s),
        )
    }
}
