//! Point transformations: whether two new coordinates are a plane with one scale.
//!
//! In: a plot of two new variables. Out: whether they are functions of old coordinates that are themselves such a plane, linear
//! in these, so that lengths in both compare. Never here: canonical variables, which have areas and no lengths.

use super::{Plot, shown};
use crate::instrument::Physics;
use crate::system::ChannelKind;

/// Whether they are two new coordinates of a linear point transformation whose old ones share a scale.
pub(super) fn is_plane(plot: &Plot, physics: Physics<'_>) -> bool {
    linear(plot, physics).unwrap_or(false)
}

fn linear(plot: &Plot, physics: Physics<'_>) -> Option<bool> {
    let (model, equations) = (physics.model, physics.equations);
    let shown = shown(plot, physics)?;
    let place = model.transformations.iter().position(|law| law.name == shown.law.name)?;
    let is_position = |s: &_| shown.law.new.iter().any(|[position, _]| position == s);
    let forwards = equations.supplements.maps.written.get(place)?.as_ref()?;
    let image = |symbol| forwards.iter().find(|(s, _)| *s == symbol).map(|(_, e)| *e);
    let images = [image(shown.new[0])?, image(shown.new[1])?];
    if shown.new[0] == shown.new[1] || !shown.new.iter().all(is_position) {
        return Some(false);
    }
    let mut pool = equations.pool.clone();
    let on = |symbol| images.iter().any(|&e| equations.pool.depends(e, symbol));
    let coordinates = model.coordinates.iter().enumerate();
    let old: Vec<_> = coordinates.clone().filter(|(_, c)| on(c.position)).collect();
    let [(i, x), (k, y)] = old[..] else { return Some(false) };
    let channel =
        |index| physics.system.channels().get(physics.channel(ChannelKind::Position(index))?);
    let (first, second) = (channel(i)?, channel(k)?);
    let alike =
        first.unit == second.unit && (!first.unit.is_empty() || first.is_place && second.is_place);
    let is_point = !coordinates.clone().any(|(_, c)| on(c.momentum));
    let old = [x.position, y.position];
    let is_linear = images.iter().all(|&image| {
        old.iter().all(|&by| {
            let slope = pool.derivative(image, by);
            !old.iter().any(|&symbol| pool.depends(slope, symbol))
        })
    });
    Some(alike && is_point && is_linear)
}
