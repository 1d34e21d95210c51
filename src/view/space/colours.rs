//! The colours of masses and traces: one point, one colour.
//!
//! In: the shapes of a picture. Out: its points, in the order of their colours. Never here: the colours themselves.

use crate::expr::{Expr, Symbol};
use crate::instrument::CameraPose;
use crate::model::{Point, Shape};
use crate::view::quantity::Quantities;
use crate::view::theme::Shade;

/// The points of the masses and of the traces of other points, in the order of their colours: what moves comes first,
/// and the second colour, an amber, is left to the masses whose places are fixed by numbers and parameters.
pub(super) fn colours(q: &Quantities<'_>, eye: CameraPose) -> Vec<Point> {
    let stays = |at: &Point| at.iter().all(|e| is_constant(q, *e));
    let shapes = || q.lab.shapes(eye).map(|(shape, _)| shape);
    let masses: Vec<Point> = shapes()
        .filter_map(|shape| match shape {
            Shape::Mass { at, .. } => Some(*at),
            _ => None,
        })
        .collect();
    let (fixed, mut points): (Vec<_>, Vec<_>) = masses.into_iter().partition(stays);
    let traces = shapes().filter_map(|shape| match shape {
        Shape::Trace { at } => Some(*at),
        _ => None,
    });
    for at in traces {
        if !points.contains(&at) && !points.iter().any(|mass| is_shadow(q, &at, mass)) {
            points.push(at);
        }
    }
    // one of them holds the place of all
    if let Some(first) = fixed.first() {
        points.insert(1.min(points.len()), *first);
    }
    points
}

/// The colour of the mass or trace at a point: its own, or that of the mass whose shadow it is.
pub(super) fn colour(q: &Quantities<'_>, points: &[Point], at: &Point) -> usize {
    let own = points.iter().position(|other| other == at);
    let shadow = || points.iter().position(|mass| is_shadow(q, at, mass));
    let stays = |point: &Point| point.iter().all(|e| is_constant(q, *e));
    let fixed = || points.iter().position(stays).filter(|_| stays(at));
    own.or_else(shadow).or_else(fixed).unwrap_or(points.len())
}

/// The shades of the trace of a point, from its oldest part to its newest: those of a shadow are the dim ones.
pub(super) fn ramp<'a>(
    q: &Quantities<'a>,
    points: &[Point],
    at: &Point,
    series: usize,
) -> &'a [Shade] {
    let ramp = q.style.theme.trail(series);
    let is_dim = !points.contains(at) && points.iter().any(|mass| is_shadow(q, at, mass));
    if is_dim { &ramp[..(ramp.len() / 3).max(1)] } else { ramp }
}

/// Whether a point is another one seen in a plane across an axis: on the floor below it, say.
fn is_shadow(q: &Quantities<'_>, at: &Point, mass: &Point) -> bool {
    let apart: Vec<usize> = (0..3).filter(|&k| at[k] != mass[k]).collect();
    matches!(apart[..], [k] if is_constant(q, at[k])) && !mass.iter().all(|e| is_constant(q, *e))
}

/// Whether a coordinate is fixed by numbers and parameters.
fn is_constant(q: &Quantities<'_>, e: Expr) -> bool {
    let loaded = &q.lab.loaded;
    let is_parameter =
        |symbol: &Symbol| loaded.model.parameters.iter().any(|p| p.symbol == *symbol);
    loaded.equations.pool.symbols_of(e).iter().all(is_parameter)
}
