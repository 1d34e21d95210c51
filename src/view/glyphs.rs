//! Glyphs: which characters the terminal can show, and plain ASCII in place of all others.
//!
//! In: the locale, text that may contain Greek letters and exponents. Out: a [`Glyphs`], border characters, ASCII text.
//! Never here: colours, or positions on the screen.

use std::borrow::Cow;

use ratatui::symbols::border;
use unicode_width::UnicodeWidthChar;

use crate::expr::{Expr, Pool, spell, subscript};

/// The characters used for dots, lines and letters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Glyphs {
    /// Braille patterns: 2×4 dots in a cell, the finest grid that most fonts have.
    Braille,
    /// Half blocks: 1×2 dots in a cell.
    HalfBlock,
    /// Quadrants: 2×2 dots in a cell, without gaps between them.
    Quadrant,
    /// Sextants: 2×3 dots in a cell; from Unicode 13.
    Sextant,
    /// Octants: 2×4 dots in a cell; from Unicode 16, and missing from most fonts.
    Octant,
    /// Only characters below 0x80, chosen by which of a cell's 2×3 dots are set.
    Ascii,
}

const ASCII_BORDER: border::Set<'static> = border::Set {
    top_left: "+",
    top_right: "+",
    bottom_left: "+",
    bottom_right: "+",
    vertical_left: "|",
    vertical_right: "|",
    horizontal_top: "-",
    horizontal_bottom: "-",
};

impl Glyphs {
    /// Reads the choice from the locale (`LC_ALL`, else `LC_CTYPE`, else `LANG`) and `TERM`.
    ///
    /// A locale other than UTF-8 gets ASCII; the Linux console, whose fonts lack braille, gets half blocks.
    pub fn from_environment(variable: &dyn Fn(&str) -> Option<String>) -> Self {
        let get = |name: &str| variable(name).filter(|value| !value.is_empty());
        let term = get("TERM").unwrap_or_default();
        let locale = ["LC_ALL", "LC_CTYPE", "LANG"].into_iter().find_map(get).unwrap_or_default();
        let locale = locale.to_ascii_lowercase();
        if term.starts_with("vt") || term == "dumb" {
            Self::Ascii
        } else if locale.contains("utf-8") || locale.contains("utf8") {
            if term.starts_with("linux") { Self::HalfBlock } else { Self::Braille }
        } else if locale.is_empty() && get("WT_SESSION").is_some() {
            Self::Braille
        } else {
            Self::Ascii
        }
    }

    /// All sets, the most widely supported first.
    pub const ALL: [Self; 6] =
        [Self::Braille, Self::HalfBlock, Self::Quadrant, Self::Sextant, Self::Octant, Self::Ascii];

    /// The name used in options and settings.
    pub fn name(self) -> &'static str {
        match self {
            Self::Braille => "braille",
            Self::HalfBlock => "half",
            Self::Quadrant => "quadrant",
            Self::Sextant => "sextant",
            Self::Octant => "octant",
            Self::Ascii => "ascii",
        }
    }

    /// Returns the set with this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|glyphs| glyphs.name() == name)
    }

    /// Whether only characters below 0x80 may be used.
    pub fn is_ascii(self) -> bool {
        self == Self::Ascii
    }

    /// The number of dots in a cell: columns, rows.
    pub fn dots(self) -> (u16, u16) {
        match self {
            Self::Braille | Self::Octant => (2, 4),
            Self::HalfBlock => (1, 2),
            Self::Quadrant => (2, 2),
            Self::Sextant | Self::Ascii => (2, 3),
        }
    }

    /// Returns `unicode`, or `ascii` if only ASCII may be used.
    pub fn pick<T>(self, unicode: T, ascii: T) -> T {
        if self.is_ascii() { ascii } else { unicode }
    }

    /// The characters of a box.
    pub fn border(self) -> border::Set<'static> {
        self.pick(border::ROUNDED, ASCII_BORDER)
    }

    /// The width of a text in columns if [`Self::text`] leaves it as it is and each of its characters fills one cell; `None`
    /// where that takes more than a look at each character.
    pub fn columns(self, text: &str) -> Option<usize> {
        // without an early end, so that many bytes are looked at together
        if text.bytes().fold(true, |all, byte| all & matches!(byte, b' '..=b'~')) {
            return Some(text.len());
        }
        if self.is_ascii() {
            return None;
        }
        let mut count = 0;
        for c in text.chars() {
            if !is_plain(c) {
                return None;
            }
            count += 1;
        }
        Some(count)
    }

    /// Returns the text as this terminal can show it, one cell per character: dots above letters become primes
    /// (`θ̇` → `θ′`), or everything is spelt in ASCII (`θ₁²` → `theta1^2`).
    pub fn text(self, text: &str) -> Cow<'_, str> {
        if text.is_ascii() {
            Cow::Borrowed(text)
        } else if self.is_ascii() {
            Cow::Owned(spell(&single(text)))
        } else {
            single(text)
        }
    }

    /// Returns an expression in mathematical notation, or in ASCII as it can be typed.
    pub(super) fn formula(self, pool: &Pool, e: Expr) -> String {
        if self.is_ascii() { pool.ascii(e) } else { pool.unicode(e) }
    }
}

/// The width of text in columns, as the Unicode standard has it.
pub(super) trait TextWidth {
    /// The number of columns.
    fn width(&self) -> usize;
}

impl TextWidth for str {
    fn width(&self) -> usize {
        Glyphs::Braille.columns(self).unwrap_or_else(|| unicode_width::UnicodeWidthStr::width(self))
    }
}

/// Whether a character is shown as it is and fills one cell, whatever stands beside it: letters and signs of formulas, lines
/// and dots. Many others are too; these are nearly all that the program writes.
fn is_plain(c: char) -> bool {
    matches!(c,
        ' '..='~'
            | '\u{a1}'..='\u{ac}'
            | '\u{ae}'..='\u{bf}'
            | '×'
            | '÷'
            | '\u{391}'..='\u{3c9}'
            | '\u{2010}'..='\u{2027}'
            | '\u{2030}'..='\u{205e}'
            | '\u{2070}'..='\u{209c}'
            | '\u{2100}'..='\u{2138}'
            | '\u{2190}'..='\u{2319}'
            | '\u{2500}'..='\u{25fc}'
            | '\u{2800}'..='\u{28ff}')
}

/// Returns the text without combining marks, which terminals render differently and some misalign. Marks of rates of
/// change become primes, as in the files; others are removed.
fn single(text: &str) -> Cow<'_, str> {
    let over = |c: char| c.width() == Some(0);
    if !text.chars().any(|c| over(c) || undotted(c).is_some()) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len());
    let mut before = ' ';
    let mut letters = text.chars().peekable();
    while let Some(letter) = letters.next() {
        // A dotted letter inside a word belongs to ordinary text.
        let alone = |next: Option<&char>| {
            !before.is_alphabetic() && next.is_none_or(|next| !next.is_alphabetic())
        };
        let prime = match (letter, undotted(letter)) {
            ('\u{307}', _) => Some('′'),
            ('\u{308}', _) => Some('″'),
            (_, Some((plain, prime))) if alone(letters.peek()) => {
                out.push(plain);
                Some(prime)
            }
            (other, _) => {
                out.extend(Some(other).filter(|c| !over(*c)));
                None
            }
        };
        before = letter;
        if let Some(prime) = prime {
            // The prime comes after a subscript: θ₁′ and L_x′, not θ′₁ and L′_x.
            while let Some(low) = letters.next_if(|c| subscript(*c).is_some()) {
                out.push(low);
            }
            if let Some(line) = letters.next_if_eq(&'_') {
                out.push(line);
                while let Some(low) = letters.next_if(|c| c.is_alphanumeric()) {
                    out.push(low);
                }
            }
            out.push(prime);
        }
    }
    Cow::Owned(out)
}

/// Splits a precomposed letter with one dot or two into the letter and the primes for its rate of change.
fn undotted(letter: char) -> Option<(char, char)> {
    Some(match letter {
        'ȧ' => ('a', '′'),
        'ṙ' => ('r', '′'),
        'ṡ' => ('s', '′'),
        'ẋ' => ('x', '′'),
        'ẏ' => ('y', '′'),
        'ż' => ('z', '′'),
        'ṗ' => ('p', '′'),
        'ẍ' => ('x', '″'),
        'ÿ' => ('y', '″'),
        _ => return None,
    })
}
