//! Inks: the colours of a picture by their purpose, in those of the theme.
//!
//! In: an ink, a layer. Out: a pen. Never here: what is drawn with it.

use super::canvas::Canvas;
use super::companions;
use super::plot::Pen;
use super::theme::Role;
use crate::instrument::{Ink, Level};

/// The pen of an ink on a layer.
pub(super) fn pen(canvas: &Canvas<'_>, ink: Ink, level: Level) -> Pen {
    let theme = &canvas.look.theme;
    match ink {
        Ink::Plain => Pen::new(theme[Role::Text], level),
        Ink::Accent => Pen::new(theme[Role::Accent], level),
        Ink::Warn => Pen::new(theme[Role::Warn], level),
        Ink::Level => Pen::shaded(theme.line(Role::Level), level),
        Ink::Separatrix => Pen::shaded(theme.line(Role::Separatrix), level),
        Ink::Curve(index) => Pen::new(theme.curve(index), level),
        Ink::Companion(number) => Pen::new(companions::ink(theme, number), level),
    }
}
