//! Inks: the colours of a picture by their purpose, in those of the theme.
//!
//! In: an ink, a layer. Out: a pen, or the marker that distinguishes it from others where there is no colour. Never here: what is drawn
//! with it.

use super::RenderStyle;
use super::canvas::Canvas;
use super::colour::ColourDepth;
use super::companions;
use super::plot::{Marker, Pen};
use super::theme::Role;
use crate::instrument::{Ink, Level, MarkerShape};

pub(super) fn pen(canvas: &Canvas<'_>, ink: Ink, level: Level) -> Pen {
    let theme = &canvas.style.theme;
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

pub(super) fn marker(shape: MarkerShape) -> Marker {
    match shape {
        MarkerShape::Disc => Marker::Disc,
        MarkerShape::Ring => Marker::Ring,
        MarkerShape::Cross => Marker::Cross,
    }
}

/// The marker that distinguishes points of a verdict from others where there is no colour: crosses for what calls for attention, rings
/// for what is plain, and dots for the rest.
pub(super) fn colourless_mark(canvas: &Canvas<'_>, ink: Ink) -> Option<MarkerShape> {
    match ink {
        _ if !is_colourless(canvas.style) => None,
        Ink::Warn => Some(MarkerShape::Cross),
        Ink::Plain => Some(MarkerShape::Ring),
        _ => None,
    }
}

pub(super) fn is_colourless(style: &RenderStyle) -> bool {
    style.theme.depth() == ColourDepth::None
}
