//! Hulls: how far each point of the picture in space has come, since the last restart.
//!
//! In: rows of channels. Out: polytopes that contain the points of all rows. Never here: the camera.

use crate::model::{Model, Point, Shape};
use crate::num::OrientationPolytope;
use crate::system::System;

/// What contains a point of the picture at all times recorded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hull {
    /// The channels of its components; `None` for one that is constant, and counts as zero.
    pub channels: [Option<usize>; 3],
    /// The polytope, around no point if there is no row.
    pub polytope: OrientationPolytope,
}

/// The hulls of all points that move in more than one of their components; of the others the bounds say all.
#[derive(Clone, Debug, Default)]
pub(super) struct Hulls(Vec<Hull>);

impl Hulls {
    /// The hulls of the points of a model's pictures, without rows.
    pub(super) fn of(model: &Model, system: &System) -> Hulls {
        let own = model.views.iter().flat_map(|view| view.shapes.iter().flatten());
        let mut all = Hulls::default();
        for point in model.picture.shapes.iter().chain(own).flat_map(Shape::points) {
            let channels = channels(&point, model, system);
            let known = all.0.iter().any(|hull| hull.channels == channels);
            if !known && channels.iter().flatten().count() > 1 {
                all.0.push(Hull { channels, polytope: OrientationPolytope::EMPTY });
            }
        }
        all
    }

    /// The same points, without rows.
    pub(super) fn begun_anew(&self) -> Hulls {
        let empty = |hull: &Hull| Hull { polytope: OrientationPolytope::EMPTY, ..*hull };
        Hulls(self.0.iter().map(empty).collect())
    }

    /// Widens the hulls to include the points of a row.
    pub(super) fn widen(&mut self, values: &[f64]) {
        for hull in &mut self.0 {
            let value = |channel: Option<usize>| {
                channel.map_or(0.0, |channel| values.get(channel).copied().unwrap_or(f64::NAN))
            };
            hull.polytope.include(hull.channels.map(value));
        }
    }

    pub(super) fn all(&self) -> &[Hull] {
        &self.0
    }
}

/// The channels of the components of a point that are not numbers.
fn channels(point: &Point, model: &Model, system: &System) -> [Option<usize>; 3] {
    point.map(|expression| match model.pool.as_number(expression) {
        Some(_) => None,
        None => system.channel_of(expression),
    })
}
