//! The render style of one terminal.
//!
//! In: what the terminal can show, and a theme. Out: a [`RenderStyle`]. Never here: cells.

use std::borrow::Cow;

use super::colour::Rgb;
use super::glyphs::Glyphs;
use super::theme::{PALETTES, Theme};
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
    /// The width of text in columns if it can be shown as it is, one character in a cell.
    pub(super) fn columns(&self, text: &str) -> Option<usize> {
        self.glyphs.columns(text)
    }

    /// Returns text as this terminal can show it, without control characters.
    pub(super) fn shown<'t>(&self, text: &'t str) -> Cow<'t, str> {
        if self.columns(text).is_some() {
            return Cow::Borrowed(text);
        }
        match printable::line(text) {
            Cow::Borrowed(safe) => self.glyphs.text(safe),
            Cow::Owned(safe) => Cow::Owned(self.glyphs.text(&safe).into_owned()),
        }
    }

    /// The style for a terminal with this background: with the theme, of those that are made for dark and light terminals,
    /// whose text stands out more on it.
    #[must_use]
    pub fn on(&self, background: Rgb) -> Self {
        let contrast = |name: &&str| {
            let palette = PALETTES.iter().find(|palette| palette.name == *name);
            palette.map_or(0.0, |palette| palette.foreground.contrast(background))
        };
        let suits =
            ["light", "dark"].into_iter().max_by(|a, b| contrast(a).total_cmp(&contrast(b)));
        let theme = suits.and_then(|name| self.theme.renamed(name));
        Self { theme: theme.unwrap_or_else(|| self.theme.clone()), glyphs: self.glyphs }
    }

    /// The style with the theme chosen by the user, or `None` if that is already this one's.
    pub(super) fn chosen_by(&self, app: &App) -> Option<Self> {
        let name = app.theme_shown().filter(|name| *name != self.theme.palette().name)?;
        Some(Self { theme: self.theme.renamed(name)?, glyphs: self.glyphs })
    }
}
