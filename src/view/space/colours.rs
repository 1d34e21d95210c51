//! The colours of masses and traces: one point, one colour.
//!
//! In: the shapes of a picture. Out: its points, in the order of their colours. Never here: the colours themselves.

use crate::expr::{Expr, Symbol};
use crate::instrument::CameraPose;
use crate::model::{Point, Shape};
use crate::view::quantity::{Quantities, QuantitySource};

/// The points of the masses and of the traces of other points, in the order of their colours: what moves comes first,
/// and the second colour, an amber, is left to the first mass whose place is fixed by numbers and parameters.
pub(super) fn colours(q: &Quantities<'_>, eye: CameraPose) -> Vec<Point> {
    let loaded = &q.lab.loaded;
    let parameters: Vec<Symbol> = loaded.model.parameters.iter().map(|p| p.symbol).collect();
    let constant = |e: Expr| {
        loaded.equations.pool.symbols_of(e).iter().all(|symbol| parameters.contains(symbol))
    };
    let stays = |at: &Point| at.iter().all(|e| constant(*e));
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
    for (index, at) in fixed.into_iter().enumerate() {
        points.insert((1 + index).min(points.len()), at);
    }
    points
}

/// The colour of the mass or trace at a point: its own, or that of the mass whose shadow it is.
pub(super) fn colour(q: &Quantities<'_>, points: &[Point], at: &Point) -> usize {
    let own = points.iter().position(|other| other == at);
    let shadow = || points.iter().position(|mass| is_shadow(q, at, mass));
    own.or_else(shadow).unwrap_or(points.len())
}

/// Whether a point is another one seen in a plane across an axis: on the floor below it, say.
fn is_shadow(q: &Quantities<'_>, at: &Point, mass: &Point) -> bool {
    let apart: Vec<usize> = (0..3).filter(|&k| at[k] != mass[k]).collect();
    let moves = |e| !matches!(q.place(e), QuantitySource::Number(_));
    matches!(apart[..], [k] if !moves(at[k])) && mass.iter().any(|e| moves(*e))
}
