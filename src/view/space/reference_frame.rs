//! The reference frame of the picture: the file's axes, or a frame that moves and turns relative to them.
//!
//! In: a frame of the model and rows of channels. Out: a point's coordinates in the frame, at the time of the row.
//! Never here: the camera, which is fixed in the frame; forces.

use crate::expr::Expr;
use crate::num::math;
use crate::system::ChannelKind;
use crate::view::quantity::{Quantities, QuantitySource};

/// A frame, with the channels of its origin and orientation.
pub(super) struct ReferenceFrame {
    turn: FrameOrientation,
    origin: [QuantitySource; 3],
}

/// The orientation of a frame.
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

    /// A box that contains the given box as seen from the frame at any time.
    pub(super) fn around(&self, q: &Quantities<'_>, [low, high]: [[f64; 3]; 2]) -> [[f64; 3]; 2] {
        let span = |source: QuantitySource| match source {
            QuantitySource::Number(number) => (number, number),
            QuantitySource::Channel(channel) => q.bounds(channel),
        };
        let origin = self.origin.map(span);
        let low = [0, 1, 2].map(|k| low[k] - origin[k].1);
        let high = [0, 1, 2].map(|k| high[k] - origin[k].0);
        let far = [0, 1, 2].map(|k| low[k].abs().max(high[k].abs()));
        let upright = match &self.turn {
            FrameOrientation::Axis { angle, .. } if span(*angle) == (0.0, 0.0) => {
                return [low, high];
            }
            FrameOrientation::Axis { axis, .. } => [0, 1].map(|k| span(axis[k])) == [(0.0, 0.0); 2],
            FrameOrientation::Body(_) => false,
        };
        if upright {
            let radius = math::hypot(far[0], far[1]);
            return [[-radius, -radius, low[2]], [radius, radius, high[2]]];
        }
        let radius = math::hypot(math::hypot(far[0], far[1]), far[2]);
        [[-radius; 3], [radius; 3]]
    }
}
