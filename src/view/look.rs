//! The render style of one terminal.
//!
//! In: what the terminal can show, and a theme. Out: a [`RenderStyle`]. Never here: cells.

use std::borrow::Cow;

use super::glyphs::Glyphs;
use super::theme::Theme;
use crate::app::App;
use crate::printable;

/// The glyphs and colours with which everything is drawn.
#[derive(Clone, Debug)]
pub struct RenderStyle {
    /// The colours.
    pub theme: Theme,
    /// The characters.
    pub glyphs: Glyphs,
}

impl RenderStyle {
    /// Returns text as this terminal can show it, without control characters.
    pub(super) fn shown<'t>(&self, text: &'t str) -> Cow<'t, str> {
        match printable::line(text) {
            Cow::Borrowed(safe) => self.glyphs.text(safe),
            Cow::Owned(safe) => Cow::Owned(self.glyphs.text(&safe).into_owned()),
        }
    }

    /// The style with the theme chosen by the user, or `None` if that is already this one's.
    pub(super) fn chosen_by(&self, app: &App) -> Option<Self> {
        let name = app.theme_shown().filter(|name| *name != self.theme.palette().name)?;
        Some(Self { theme: self.theme.renamed(name)?, glyphs: self.glyphs })
    }
}
