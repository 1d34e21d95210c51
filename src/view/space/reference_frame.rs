//! The reference frame of the picture: the file's axes, or a frame that moves and turns relative to them.
//!
//! In: a frame of the model and rows of channels. Out: a point's coordinates in the frame, at the time of the row.
//! Never here: the camera, which is fixed in the frame; forces.

use crate::expr::Expr;
use crate::num::{OrientationPolytope, math};
use crate::system::ChannelKind;
use crate::view::plot::Extent;
use crate::view::quantity::{Quantities, QuantitySource};

/// A frame, with the channels of its origin and orientation.
pub(super) struct ReferenceFrame {
    turn: FrameOrientation,
    origin: [QuantitySource; 3],
}

enum FrameOrientation {
    /// Rotated by an angle about an axis.
    Axis { axis: [QuantitySource; 3], angle: QuantitySource },
    /// Fixed in the body, given by its attitude matrix; this is the channel of the first entry.
    Body(usize),
}

impl ReferenceFrame {
    /// The frame with this index, or `None` for the file's axes.
    pub(super) fn of(q: &Quantities<'_>, frame: Option<usize>) -> Option<Self> {
        let frame = q.lab.loaded.model.frames.get(frame?)?;
        let place = |e: Expr| q.place(e);
        let turn = if frame.attitude {
            let mut channels = q.lab.loaded.system.channels().iter();
            FrameOrientation::Body(channels.position(|c| c.kind == ChannelKind::Attitude(0))?)
        } else {
            FrameOrientation::Axis { axis: frame.axis.map(place), angle: q.place(frame.angle) }
        };
        Some(Self { turn, origin: frame.origin.map(place) })
    }

    /// R(−α)(r − o).
    pub(super) fn point(&self, row: &[f64], r: [f64; 3]) -> [f64; 3] {
        let origin = self.origin.map(|source| source.read(row));
        self.direction(row, [0, 1, 2].map(|k| r[k] - origin[k]))
    }

    /// A v, or R(−α) v = v cos α − (n×v) sin α + n (n·v)(1 − cos α), Rodrigues' formula.
    pub(super) fn direction(&self, row: &[f64], v: [f64; 3]) -> [f64; 3] {
        let (axis, angle) = match &self.turn {
            FrameOrientation::Axis { axis, angle } => (axis, angle),
            FrameOrientation::Body(first) => {
                let entry =
                    |i: usize, j: usize| QuantitySource::Channel(first + 3 * i + j).read(row);
                return [0, 1, 2].map(|i| (0..3).map(|j| entry(i, j) * v[j]).sum());
            }
        };
        let axis = axis.map(|source| source.read(row));
        let length = axis.iter().map(|a| a * a).sum::<f64>().sqrt();
        let n = axis.map(|a| a / length);
        let (sin, cos) = math::sin_cos(angle.read(row));
        let along: f64 = (0..3).map(|k| n[k] * v[k]).sum();
        [0, 1, 2].map(|k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let across = n[i] * v[j] - n[j] * v[i];
            v[k] * cos - across * sin + n[k] * along * (1.0 - cos)
        })
    }

    /// What contains the given extent as seen from the frame at any time: where the frame turns about the vertical what is
    /// around it, where it tumbles the ball around its origin.
    pub(super) fn around(&self, q: &Quantities<'_>, extent: &Extent) -> Extent {
        let origin = self.origin.map(|source| span(q, source));
        let shift = origin.map(|(least, _)| -least);
        let fixed = origin.iter().all(|(least, greatest)| least == greatest);
        let shift = fixed.then(|| OrientationPolytope::around(shift));
        let hull = extent.hull.zip(shift).map(|(hull, shift)| hull.plus(&shift));
        let low = [0, 1, 2].map(|k| extent.low[k] - origin[k].1);
        let high = [0, 1, 2].map(|k| extent.high[k] - origin[k].0);
        let far = [0, 1, 2].map(|k| low[k].abs().max(high[k].abs()));
        match self.turning(q) {
            FrameRotation::Not => Extent { low, high, hull, ..*extent },
            FrameRotation::Upright => {
                let radius = math::hypot(far[0], far[1]);
                let (low, high) = ([-radius, -radius, low[2]], [radius, radius, high[2]]);
                Extent { low, high, hull: None, ..*extent }
            }
            FrameRotation::Any => {
                let corner = math::hypot(math::hypot(far[0], far[1]), far[2]);
                let farthest = hull.map_or(corner, |hull| hull.farthest().min(corner));
                let radius = farthest + extent.radius;
                Extent { low: [0.0; 3], high: [0.0; 3], radius, hull: None }
            }
        }
    }

    /// Whether it leaves what is in a horizontal plane in one.
    pub(super) fn keeps_planes(&self, q: &Quantities<'_>) -> bool {
        !matches!(self.turning(q), FrameRotation::Any)
    }

    fn turning(&self, q: &Quantities<'_>) -> FrameRotation {
        match &self.turn {
            FrameOrientation::Axis { angle, .. } if span(q, *angle) == (0.0, 0.0) => {
                FrameRotation::Not
            }
            FrameOrientation::Axis { axis: [x, y, _], .. }
                if [x, y].map(|source| span(q, *source)) == [(0.0, 0.0); 2] =>
            {
                FrameRotation::Upright
            }
            FrameOrientation::Axis { .. } | FrameOrientation::Body(_) => FrameRotation::Any,
        }
    }
}

enum FrameRotation {
    Not,
    /// About the vertical.
    Upright,
    Any,
}

/// The least and the greatest value so far.
fn span(q: &Quantities<'_>, source: QuantitySource) -> (f64, f64) {
    match source {
        QuantitySource::Number(number) => (number, number),
        QuantitySource::Channel(channel) => q.bounds(channel),
    }
}
