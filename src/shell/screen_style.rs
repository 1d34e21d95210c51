//! The style of a screen on this terminal: as the terminal and its background allow, reduced while the line is slow.
//!
//! In: a style, the terminal's background, the level of detail. Out: the style to draw with. Never here: when these change.

use crate::view::colour::Rgb;
use crate::view::{Detail, RenderStyle};

pub(super) struct ScreenStyle {
    full: RenderStyle,
    detail: Detail,
    /// The style at the current level of detail.
    drawn: RenderStyle,
}

impl ScreenStyle {
    pub(super) fn new(full: RenderStyle) -> Self {
        Self { drawn: full.clone(), full, detail: Detail::default() }
    }

    pub(super) fn full(&self) -> &RenderStyle {
        &self.full
    }

    pub(super) fn drawn(&self) -> &RenderStyle {
        &self.drawn
    }

    /// Draws in this detail from now on.
    pub(super) fn reduce(&mut self, detail: Detail) {
        (self.detail, self.drawn) = (detail, self.full.reduced(detail));
    }

    /// Suits a background of this colour from now on.
    pub(super) fn suit(&mut self, background: Rgb) {
        self.full = self.full.on(background);
        self.reduce(self.detail);
    }
}
