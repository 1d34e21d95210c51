//! What a scene has names for: its points, and two mechanics side by side.
//!
//! In: points of shapes, words. Out: labels, colours. Never here: where a name has room.

use super::annotation::Label;
use super::{ScenePainter, scene};
use crate::expr::Symbol;
use crate::model::{Point, Shape};
use crate::view::plot::{Pen, Visibility};
use crate::view::theme::Role;

impl ScenePainter<'_> {
    /// Writes words beside a point, away from another one.
    pub(super) fn label(&mut self, at: [f64; 3], foot: Option<[f64; 3]>, text: &str) {
        let veiled = self.sight(at) == Visibility::Veiled;
        let [tip, foot] = [at, foot.unwrap_or(at)].map(|point| self.flat(point));
        let role = match () {
            () if veiled => Role::Dim,
            () if foot == tip => Role::Text,
            () => Role::Accent,
        };
        let text = self.q.look.glyphs.text(text).into_owned();
        self.labels.push(Label { tip, leftwards: tip[0] < foot[0], text, role });
    }

    /// The colours of the traces of the right mechanics and of the wrong one beside it, where both leave one.
    pub(super) fn mechanics(&self) -> Option<[usize; 2]> {
        self.q.lab.loaded.model.comparison.as_ref()?;
        let trace = |wrong: bool| {
            self.q.lab.shapes(self.eye).find_map(|(shape, _)| match shape {
                Shape::Trace { at } => (self.is_wrong(at) == wrong).then(|| self.colour(at)),
                _ => None,
            })
        };
        Some([trace(false)?, trace(true)?])
    }

    /// The colour of a body about this point: that of the motion it stands for, where two are compared, or of the mass at its
    /// centre; `None` if it has none of its own.
    pub(super) fn own_colour(&self, centre: &Point) -> Option<usize> {
        if scene::rests(self.q, centre) {
            return None;
        }
        if let Some([right, wrong]) = self.mechanics() {
            return Some(if self.is_wrong(centre) { wrong } else { right });
        }
        self.colours.iter().position(|point| point == centre)
    }

    /// A pen in the colour of the body about this point.
    pub(super) fn own_pen(&self, centre: &Point, pen: Pen) -> Pen {
        let own = self.own_colour(centre).map(|series| self.q.look.theme.curve(series));
        Pen { style: own.unwrap_or(pen.style), ..pen }
    }

    /// Whether a point is one of the wrong mechanics beside the right one.
    fn is_wrong(&self, at: &Point) -> bool {
        let Some(comparison) = &self.q.lab.loaded.model.comparison else { return false };
        let other: Vec<Symbol> =
            comparison.symbols.iter().flat_map(|&(place, rate)| [place, rate]).collect();
        let pool = &self.q.lab.loaded.equations.pool;
        at.iter().any(|&e| pool.depends_on_any(e, &other))
    }
}
