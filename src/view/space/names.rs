//! The names and colours of what a scene shows: of points, and of the bodies about them.
//!
//! In: points of shapes, words. Out: labels, colours. Never here: where a name has room.

use ratatui::style::Style;

use super::annotation::Label;
use super::{ScenePainter, is_colourless, scene};
use crate::expr::Expr;
use crate::model::{Point, Shape};
use crate::num::math;
use crate::view::number::brief;
use crate::view::plot::{Pen, Visibility};
use crate::view::theme::Role;

/// The rows at the lower edge that the names of the axes have.
const ABOVE_COMPASS: u16 = 5;

impl ScenePainter<'_> {
    /// Writes beside a point with which of two mechanics it moves, if colours do not say it.
    pub(super) fn name_mechanics(&mut self, at: &Point) {
        let q = self.q;
        let colours = self.mechanics.as_ref().filter(|_| is_colourless(q.style));
        let Some(colours) = colours else { return };
        let Some(colour) = colours.colour(&q.lab.loaded.equations.pool, at) else { return };
        let name = if colour == colours.colours[1] { "wrong" } else { "right" };
        self.label(self.point(at), None, name, q.style.theme[Role::Text]);
        if let Some(label) = self.labels.last_mut() {
            label.apart = true;
        }
    }

    /// Says at the edge where the comparison motion is that the picture no longer follows, and how far away.
    pub(super) fn name_comparison_out_of_view(&mut self) {
        let follow = self.q.lab.loaded.model.picture.follow.as_ref();
        let Some((follow, both)) = follow.zip(self.mechanics.as_ref()) else { return };
        let Some(beside) = follow.beside else { return };
        let style = self.q.style.theme.curve(both.colours[1]);
        let (at, other) = (self.point(&follow.at), self.point(&beside));
        let flat = self.flat(other);
        let edges = [self.frame.x, self.frame.y].map(|axis| [axis.lo, axis.hi]);
        if (0..2).all(|k| (edges[k][0]..=edges[k][1]).contains(&flat[k])) {
            return;
        }
        let apart = (0..3).map(|k| math::powi(other[k] - at[k], 2)).sum::<f64>().sqrt();
        if !apart.is_finite() {
            return;
        }
        let glyphs = self.q.style.glyphs;
        let distance = brief(apart, 2, glyphs);
        let text = match glyphs.pick(["←", "→", "↓", "↑"], ["<-", "->", "v", "^"]) {
            [left, ..] if flat[0] < edges[0][0] => format!("{left} wrong: {distance} away"),
            [_, right, ..] if flat[0] > edges[0][1] => format!("wrong: {distance} away {right}"),
            [.., down, _] if flat[1] < edges[1][0] => format!("wrong: {distance} away {down}"),
            [.., up] => format!("wrong: {distance} away {up}"),
        };
        let mut tip = [0, 1].map(|k| flat[k].max(edges[k][0]).min(edges[k][1]));
        // the names of the axes have the lower left corner
        let row = (edges[1][1] - edges[1][0]) / f64::from(self.frame.area.height.max(1));
        tip[1] = tip[1].max(edges[1][0] + f64::from(ABOVE_COMPASS) * row);
        let leftwards = flat[0] > edges[0][0];
        self.labels.push(Label { tip, leftwards, apart: false, text, style });
    }

    /// Writes words in a style beside a point, away from another one.
    pub(super) fn label(&mut self, at: [f64; 3], foot: Option<[f64; 3]>, text: &str, style: Style) {
        let veiled = self.sight(at) == Visibility::Veiled;
        let [tip, foot] = [at, foot.unwrap_or(at)].map(|point| self.flat(point));
        let style = if veiled { self.q.style.theme[Role::Dim] } else { style };
        let text = self.q.style.glyphs.text(text).into_owned();
        self.labels.push(Label { tip, leftwards: tip[0] < foot[0], apart: false, text, style });
    }

    /// The style of a vector: that of the trace at its foot or, of a vector from the origin, at its tip. Several without such a
    /// trace at one foot have colours of their own, behind those of masses and traces.
    pub(super) fn vector_style(&self, at: &Point, components: &Point) -> Style {
        let theme = &self.q.style.theme;
        if let Some(trace) = self.trace_of_vector(at, components) {
            return theme.curve(self.colour(&trace));
        }
        let shapes = self.q.lab.shapes(self.eye).map(|(shape, _)| shape);
        let beside: Vec<&Point> = shapes
            .filter_map(|shape| match shape {
                Shape::Vector { at: foot, components, .. } => (foot == at).then_some(components),
                _ => None,
            })
            .filter(|components| self.trace_of_vector(at, components).is_none())
            .collect();
        let own = beside.iter().position(|other| *other == components);
        let own = own.filter(|_| beside.len() > 1);
        own.map_or(theme[Role::Accent], |index| theme.curve(self.colours.len() + index))
    }

    fn trace_of_vector(&self, at: &Point, components: &Point) -> Option<Point> {
        let pool = &self.q.lab.loaded.equations.pool;
        let from_origin = at.iter().all(|e| pool.as_number(*e).is_some_and(|n| n.value() == 0.0));
        let mut traces = self.q.lab.shapes(self.eye).filter_map(|(shape, _)| match shape {
            Shape::Trace { at } => Some(*at),
            _ => None,
        });
        traces.find(|trace| trace == at || from_origin && trace == components)
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

    /// The style of the shade that a map has at a share of its range, where there are colours.
    pub(super) fn shade(&self, share: Option<Expr>) -> Option<Style> {
        let share = self.q.number(share?);
        let ramp = self.q.style.theme.density();
        let last = ramp.len().checked_sub(1)?;
        let step = (share.clamp(0.0, 1.0) * ramp.len() as f64) as usize;
        (share.is_finite() && !is_colourless(self.q.style)).then(|| ramp[step.min(last)].style)
    }

    /// A pen in the colour of the body about this point.
    pub(super) fn own_pen(&self, centre: &Point, pen: Pen) -> Pen {
        let own = self.own_colour(centre).map(|series| self.q.style.theme.curve(series));
        Pen { style: own.unwrap_or(pen.style), ..pen }
    }
}
