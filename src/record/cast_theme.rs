//! The colours of a terminal that shows a cast: foreground, background and the sixteen basic ones.
//!
//! In: a palette, or the header of a cast. Out: colours, or their notation in a header. Never here: what they are used
//! for.

use serde_json::{Value, json};

use crate::view::colour::Rgb;
use crate::view::theme::{PALETTES, Palette};

/// The sixteen basic colours, if a header has none: those of VGA, softened.
const SIXTEEN: [Rgb; 16] = [
    Rgb(0x1a, 0x1b, 0x26),
    Rgb(0xc8, 0x4f, 0x4f),
    Rgb(0x4f, 0xa8, 0x6a),
    Rgb(0xc4, 0x96, 0x1a),
    Rgb(0x5a, 0x7f, 0xd0),
    Rgb(0xb0, 0x6a, 0xb8),
    Rgb(0x3f, 0xa7, 0xb6),
    Rgb(0xb8, 0xbc, 0xc8),
    Rgb(0x5a, 0x60, 0x78),
    Rgb(0xe8, 0x64, 0x5a),
    Rgb(0x6a, 0xc8, 0x8a),
    Rgb(0xe6, 0xb4, 0x3f),
    Rgb(0x7a, 0x9c, 0xf0),
    Rgb(0xd6, 0x8f, 0xd0),
    Rgb(0x5f, 0xc7, 0xd6),
    Rgb(0xff, 0xff, 0xff),
];

/// The colours of a terminal.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CastTheme {
    /// The colour of what has none of its own.
    pub foreground: Rgb,
    /// The colour behind everything.
    pub background: Rgb,
    /// The sixteen basic colours.
    pub sixteen: [Rgb; 16],
}

impl Default for CastTheme {
    fn default() -> CastTheme {
        CastTheme::of(&PALETTES[0])
    }
}

impl CastTheme {
    /// The terminal for which a palette is designed.
    pub(super) fn of(palette: &Palette) -> CastTheme {
        let (foreground, background) = (palette.foreground, palette.background);
        CastTheme { foreground, background, sixteen: SIXTEEN }
    }

    /// The theme as a header writes it.
    pub(super) fn written(&self) -> Value {
        let hex = |Rgb(r, g, b): Rgb| format!("#{r:02x}{g:02x}{b:02x}");
        let sixteen = self.sixteen.map(hex).join(":");
        json!({ "fg": hex(self.foreground), "bg": hex(self.background), "palette": sixteen })
    }

    /// Reads the theme of a header. A header may give eight basic colours, which then serve for the bright ones as well;
    /// what it does not give, or not as a colour, is that of the default theme.
    pub(super) fn read(written: &Value) -> CastTheme {
        let mut theme = CastTheme::default();
        let colour = |key: &str| written.get(key).and_then(Value::as_str).and_then(hexadecimal);
        theme.foreground = colour("fg").unwrap_or(theme.foreground);
        theme.background = colour("bg").unwrap_or(theme.background);
        let palette = written.get("palette").and_then(Value::as_str).unwrap_or_default();
        let given: Option<Vec<Rgb>> = palette.split(':').map(hexadecimal).collect();
        if let Some(given) = given.filter(|given| matches!(given.len(), 8 | 16)) {
            theme.sixteen = std::array::from_fn(|index| given[index % given.len()]);
        }
        theme
    }
}

/// A colour written as `#rrggbb`.
fn hexadecimal(text: &str) -> Option<Rgb> {
    let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6)?;
    let number = u32::from_str_radix(digits, 16).ok()?;
    let [_, r, g, b] = number.to_be_bytes();
    Some(Rgb(r, g, b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read() {
        for palette in &PALETTES {
            let theme = CastTheme::of(palette);
            assert_eq!(CastTheme::read(&theme.written()), theme, "{}", palette.name);
        }
    }

    #[test]
    fn a_theme_may_be_incomplete() {
        let default = CastTheme::default();
        assert_eq!(CastTheme::read(&json!(null)), default);
        let eight = (0..8).map(|n| format!("#00000{n}")).collect::<Vec<_>>().join(":");
        let read = CastTheme::read(&json!({ "fg": "#ff8000", "bg": "teal", "palette": eight }));
        assert_eq!((read.foreground, read.background), (Rgb(255, 128, 0), default.background));
        assert_eq!((read.sixteen[3], read.sixteen[11]), (Rgb(0, 0, 3), Rgb(0, 0, 3)));
    }
}
