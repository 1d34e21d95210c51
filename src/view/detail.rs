//! Detail: what is left out of a look where the line to the terminal is too slow for all of it.
//!
//! In: a look. Out: the same with fewer colours, then with less in its pictures. Never here: how slow the line is.

use super::RenderStyle;
use super::colour::ColourDepth;

/// How much is left out, from nothing (the default) on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Detail(u8);

/// What a step leaves: colours, the shades of a trail, the share of its dots. First colours go, then shades, then dots.
const STEPS: [(ColourDepth, Option<usize>, f64); 5] = [
    (ColourDepth::True, None, 1.0),
    (ColourDepth::Ansi256, None, 1.0),
    (ColourDepth::Ansi16, None, 1.0),
    (ColourDepth::Ansi16, Some(2), 1.0),
    (ColourDepth::Ansi16, Some(1), 0.5),
];

impl Detail {
    /// One step more is left out; `None` where nothing more can be.
    #[must_use]
    pub fn poorer(self) -> Option<Self> {
        (usize::from(self.0) + 1 < STEPS.len()).then_some(Self(self.0 + 1))
    }

    /// One step less is left out; `None` where nothing is.
    #[must_use]
    pub fn richer(self) -> Option<Self> {
        self.0.checked_sub(1).map(Self)
    }
}

impl RenderStyle {
    /// The same look with some of it left out.
    #[must_use]
    pub fn reduced(&self, detail: Detail) -> Self {
        let (most, ages, share) = STEPS[usize::from(detail.0).min(STEPS.len() - 1)];
        let mut look = self.clone();
        if look.theme.depth() > most {
            look.theme = look.theme.with_depth(most);
        }
        if let Some(ages) = ages {
            look.theme = look.theme.with_ages(ages);
        }
        if share < 1.0 {
            look.theme = look.theme.thinned(share);
        }
        look
    }
}
