//! Dashes: the patterns that distinguish lines without colour.
//!
//! In: a position along an axis of the raster, in dots. Out: whether a dot is drawn there. Never here: which line has
//! which pattern.

/// A pattern along a line. It is fixed to the screen, so that a line that moves along itself does not flicker.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Dash {
    /// A solid line.
    #[default]
    Full,
    /// Dashes with gaps between.
    Dashed,
    /// Dots.
    Dotted,
    /// A dash and a dot by turns.
    DashDot,
    /// A dash, two dots.
    DashDotDot,
    /// Widely spaced dots.
    Sparse,
    /// Long dashes with small gaps.
    Long,
}

impl Dash {
    /// Every pattern, in the order in which lines get them.
    pub const ALL: [Self; 7] = [
        Self::Full,
        Self::Dashed,
        Self::Dotted,
        Self::DashDot,
        Self::DashDotDot,
        Self::Sparse,
        Self::Long,
    ];

    /// The pattern in dots; `#` is drawn.
    fn dots(self) -> &'static [u8] {
        match self {
            Self::Full => b"#",
            Self::Dashed => b"#####....",
            Self::Dotted => b"#...",
            Self::DashDot => b"######..#..",
            Self::DashDotDot => b"######..#..#..",
            Self::Sparse => b"#.......",
            Self::Long => b"##############...",
        }
    }

    /// Whether the dot at a position along the line is drawn.
    pub fn covers(self, place: i32) -> bool {
        let dots = self.dots();
        dots[place.rem_euclid(dots.len() as i32) as usize] == b'#'
    }

    /// The character for the line in ASCII, in which patterns cannot be drawn; `None` for the solid line, which is
    /// drawn by its shape.
    pub fn letter(self) -> Option<char> {
        match self {
            Self::Full => None,
            Self::Dashed => Some('+'),
            Self::Dotted => Some('.'),
            Self::DashDot => Some('x'),
            Self::DashDotDot => Some('*'),
            Self::Sparse => Some(':'),
            Self::Long => Some('%'),
        }
    }

    /// The pattern in three characters, for a heading: in Unicode, and in ASCII.
    pub fn sample(self) -> [&'static str; 2] {
        match self {
            Self::Full => ["━━━", "---"],
            Self::Dashed => ["━ ━", "+++"],
            Self::Dotted => ["···", "..."],
            Self::DashDot => ["━·━", "xxx"],
            Self::DashDotDot => ["━··", "***"],
            Self::Sparse => ["· ·", ":::"],
            Self::Long => ["━━ ", "%%%"],
        }
    }
}
