//! The potential a view of the file shows: which quantities, and its values along the coordinate.
//!
//! In: a view, the lab. Out: a [`Potential`]. Never here: how it is drawn.

use super::Lab;
use crate::expr::{Expr, Symbol};
use crate::model::ViewKind;

/// A potential along one coordinate, all else held at the present.
#[derive(Clone, Debug)]
pub struct Potential {
    /// The view's title, or empty.
    pub title: String,
    /// The channel of the coordinate, and that of the potential.
    pub x: usize,
    /// The channel of the potential.
    pub y: usize,
    /// The present energy.
    pub energy: f64,
    coordinate: Symbol,
    expression: Expr,
}

impl Lab {
    /// The potential of the view of an index, once the motion was seen.
    pub fn potential(&self, view: usize) -> Option<Potential> {
        let (model, system) = (&self.loaded.model, &self.loaded.system);
        let view = model.views.get(view).filter(|view| view.kind == ViewKind::Potential)?;
        let (across, up) = (view.x.as_ref()?.expression, view.y.first()?.expression);
        self.seen()?;
        Some(Potential {
            title: view.title.clone(),
            x: system.channel_of(across)?,
            y: system.channel_of(up)?,
            energy: self.now(model.symbols.energy),
            coordinate: model.pool.as_symbol(across)?,
            expression: up,
        })
    }
}

impl Potential {
    /// The value where the coordinate has another value, and velocities, momenta and all else those of the present.
    pub fn at(&self, lab: &Lab, x: f64) -> f64 {
        let there = lab.valuation().with([(self.coordinate, x)]);
        there.value(&lab.loaded.model.pool, self.expression)
    }
}
