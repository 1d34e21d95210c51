//! What the pictures keep in view when the motion is begun elsewhere: how far each quantity and each point in space had come.
//!
//! In: snapshots. Out: ranges and hulls. Never here: axes and cameras.

use std::sync::Arc;

use crate::experiment::{Hull, Snapshot};
use crate::num::OrientationPolytope;

/// What the motions before the current one have reached.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct EarlierWindow {
    /// The least and greatest value of each channel.
    bounds: Arc<[(f64, f64)]>,
    /// The hulls of the points in space.
    hulls: Arc<[Hull]>,
    /// The picture of a plane in which a mass was dragged last: its view of the file, and the ranges of its axes.
    plane: Option<(Option<usize>, [[f64; 2]; 2])>,
}

impl EarlierWindow {
    /// The same, and what the motion of a snapshot has reached.
    #[must_use]
    pub(super) fn with(&self, snapshot: &Snapshot) -> Self {
        let bounds = snapshot.bounds.iter().enumerate().map(|(channel, &(lo, hi))| {
            let (least, greatest) = self.bounds(channel).unwrap_or((lo, hi));
            (least.min(lo), greatest.max(hi))
        });
        let hulls = snapshot.hulls.iter().map(|hull| match self.hull(hull.channels) {
            Some(earlier) => Hull { polytope: hull.polytope.joined(earlier), ..*hull },
            None => *hull,
        });
        Self { bounds: bounds.collect(), hulls: hulls.collect(), plane: self.plane }
    }

    /// The same, and the ranges of a picture of a plane.
    #[must_use]
    pub(super) fn with_plane(self, view: Option<usize>, ranges: [[f64; 2]; 2]) -> Self {
        Self { plane: Some((view, ranges)), ..self }
    }

    /// The ranges of the axes of a picture of a plane.
    pub(super) fn plane(&self, view: Option<usize>) -> Option<[[f64; 2]; 2]> {
        self.plane.filter(|(of, _)| *of == view).map(|(_, ranges)| ranges)
    }

    /// The least and greatest value of a channel.
    pub(super) fn bounds(&self, channel: usize) -> Option<(f64, f64)> {
        self.bounds.get(channel).copied()
    }

    /// The hull of the point with these components.
    pub(super) fn hull(&self, channels: [Option<usize>; 3]) -> Option<&OrientationPolytope> {
        self.hulls.iter().find(|hull| hull.channels == channels).map(|hull| &hull.polytope)
    }
}
