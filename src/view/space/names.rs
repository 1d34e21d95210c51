//! The names and colours of what a scene shows: of points, and of the bodies about them.
//!
//! In: points of shapes, words. Out: labels, colours. Never here: where a name has room.

use super::annotation::Label;
use super::{ScenePainter, scene};
use crate::model::Point;
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

    /// The colour of a body about this point: that of the motion it stands for, where two are compared, or of the mass at its
    /// centre; `None` if it has none of its own.
    pub(super) fn own_colour(&self, centre: &Point) -> Option<usize> {
        if scene::rests(self.q, centre) {
            return None;
        }
        let pool = &self.q.lab.loaded.equations.pool;
        let motion = self.mechanics.as_ref().and_then(|both| both.colour(pool, centre));
        motion.or_else(|| self.colours.iter().position(|point| point == centre))
    }

    /// A pen in the colour of the body about this point.
    pub(super) fn own_pen(&self, centre: &Point, pen: Pen) -> Pen {
        let own = self.own_colour(centre).map(|series| self.q.look.theme.curve(series));
        Pen { style: own.unwrap_or(pen.style), ..pen }
    }
}
