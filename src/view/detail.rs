//! Detail: how much of the picture is left out if the connection to the terminal is too slow for all of it.
//!
//! In: a render style. Out: the same style with fewer colours, then with less detail in plots. Never here: how slow
//! the connection is.

use super::RenderStyle;
use super::colour::ColourDepth;

/// The level of reduction; the default is none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Detail(u8);

/// What each level retains: colours, the number of shades of a trail, the share of its dots. Colours are reduced first,
/// then shades, then dots.
const STEPS: [(ColourDepth, Option<usize>, f64); 5] = [
    (ColourDepth::True, None, 1.0),
    (ColourDepth::Ansi256, None, 1.0),
    (ColourDepth::Ansi16, None, 1.0),
    (ColourDepth::Ansi16, Some(2), 1.0),
    (ColourDepth::Ansi16, Some(1), 0.5),
];

impl Detail {
    /// Reduces the detail by one step; `None` if it is already minimal.
    #[must_use]
    pub fn poorer(self) -> Option<Self> {
        (usize::from(self.0) + 1 < STEPS.len()).then_some(Self(self.0 + 1))
    }

    /// Increases the detail by one step; `None` if it is already full.
    #[must_use]
    pub fn richer(self) -> Option<Self> {
        self.0.checked_sub(1).map(Self)
    }
}

impl RenderStyle {
    /// The same style with reduced detail.
    #[must_use]
    pub fn reduced(&self, detail: Detail) -> Self {
        let (most, ages, share) = STEPS[usize::from(detail.0).min(STEPS.len() - 1)];
        let mut style = self.clone();
        if style.theme.depth() > most {
            style.theme = style.theme.with_depth(most);
        }
        if let Some(ages) = ages {
            style.theme = style.theme.with_ages(ages);
        }
        if share < 1.0 {
            style.theme = style.theme.thinned(share);
        }
        style
    }
}
