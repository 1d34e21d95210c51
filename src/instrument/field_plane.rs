//! Which planes of two quantities have a vector field, and what its nullclines are called.
//!
//! In: a plot or a view of a file. Out: its [`PlaneField`], or why it has none. Never here: rates.

use super::vector_field::{PlaneField, depends_on_time};
use super::{Physics, Plot, PlotContext};
use crate::model::{Model, WrittenExpr};
use crate::system::{ChannelKind, Form};

/// The indices of the curves of both nullclines among the colours: those that motions beside the main one have last, and neither
/// that of the motion nor near that of separatrices.
pub(super) const NULLCLINES: [usize; 2] = [1, 6];

/// Why a plane has no vector field, as a clause.
pub type NoField = String;

/// Whether two quantities of a law of motion span a plane with a vector field, and which: the coordinate of an index with its
/// momentum or its velocity. `kinds` are of the horizontal and the vertical axis, `None` for any other quantity; `names` are for the
/// clause.
///
/// # Errors
/// Returns a clause that says why they do not.
fn field_plane(
    model: &Model,
    kinds: [Option<ChannelKind>; 2],
    names: [&str; 2],
) -> Result<(usize, Form), NoField> {
    use ChannelKind::{Momentum, Position, Velocity};
    let [x, y] = names;
    if model.is_poisson() {
        return Err("variables with brackets of their own have no momenta".to_owned());
    }
    let found = match kinds {
        [Some(Position(i)), Some(Momentum(k))] | [Some(Momentum(k)), Some(Position(i))]
            if i == k =>
        {
            (i, Form::Momentum)
        }
        [Some(Position(i)), Some(Velocity(k))] | [Some(Velocity(k)), Some(Position(i))]
            if i == k =>
        {
            (i, Form::Velocity)
        }
        _ => {
            return Err(format!(
                "{y} against {x} is not a coordinate and its own momentum or velocity"
            ));
        }
    };
    if !model.constraints.is_empty() {
        return Err("the constraints allow only some of its points".to_owned());
    }
    if found.1 == Form::Velocity && !model.is_lagrangian() {
        return Err("H gives the rates of momenta, and not of velocities".to_owned());
    }
    Ok(found)
}

/// Whether the plane of a view over two expressions has a vector field.
///
/// # Errors
/// Returns a clause that says why it has none.
pub fn has_field(model: &Model, [x, y]: [&WrittenExpr; 2]) -> Result<(), NoField> {
    let kind = |e: &WrittenExpr| {
        let symbol = model.pool.as_symbol(e.expression)?;
        model.coordinates.iter().enumerate().find_map(|(i, c)| match symbol {
            symbol if symbol == c.position => Some(ChannelKind::Position(i)),
            symbol if symbol == c.velocity => Some(ChannelKind::Velocity(i)),
            symbol if symbol == c.momentum => Some(ChannelKind::Momentum(i)),
            _ => None,
        })
    };
    field_plane(model, [kind(x), kind(y)], [&x.written, &y.written]).map(|_| ())
}

impl Plot {
    /// Whether the vector field of its plane is asked for.
    pub fn shows_field(&self) -> bool {
        self.kind.properties().has_vector_field
            && self.viewport().is_some_and(|viewport| viewport.field)
    }

    /// Why its plane has no vector field, as a clause; `None` if it has one.
    pub fn lacks_field(&self, physics: Physics<'_>) -> Option<NoField> {
        plane_of(self, physics).err()
    }
}

impl PlaneField {
    /// The vector field of the plane of a plot's two quantities, at the present state.
    ///
    /// # Errors
    /// Returns a clause that says why there is none.
    pub fn of(PlotContext { plot, present, .. }: PlotContext<'_>) -> Result<Self, NoField> {
        let plane = plane_of(plot, present.physics)?;
        let across = present.physics.channel(ChannelKind::Position(plane.0));
        Ok(Self::new(present, plane, plot.column(0) == across))
    }
}

/// The coordinate and the form of a plot's plane.
fn plane_of(plot: &Plot, physics: Physics<'_>) -> Result<(usize, Form), NoField> {
    let columns = [plot.column(0), plot.column(1)];
    let kinds = columns.map(|column| Some(physics.system.channels().get(column?)?.kind));
    let names = columns.map(|column| column.map_or("?", |channel| physics.shown(channel)));
    field_plane(physics.model, kinds, names)
}

/// What the curves are on which each rate vanishes, in words: `θ′ = 0`.
pub(super) fn nullcline_names(plot: &Plot, physics: Physics<'_>) -> Option<[String; 2]> {
    plane_of(plot, physics).ok()?;
    let rate = |axis: usize| {
        let channel = physics.system.channels().get(plot.column(axis)?)?;
        Some(match channel.kind {
            ChannelKind::Velocity(i) => {
                let q = physics.channel(ChannelKind::Position(i))?;
                format!("{}″ = 0", physics.shown(q))
            }
            _ => format!("{}′ = 0", channel.shown),
        })
    };
    let names = [rate(0)?, rate(1)?];
    let moving = physics.system.degrees() > 1 || depends_on_time(physics);
    Some(names.map(|name| if moving { format!("{name} now") } else { name }))
}
