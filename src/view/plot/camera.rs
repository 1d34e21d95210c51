//! The camera: from points in space to points on the screen.
//!
//! In: points with z up, angles, zoom. Out: horizontal and vertical coordinates in the units of the scene, and the
//! depth. Never here: shapes, or hidden surfaces.

use std::f64::consts::FRAC_PI_2;

use ratatui::layout::Rect;

use super::scale::{PlotFrame, Scale};
use crate::num::{OrientationPolytope, math};

/// The size of a picture relative to what is in it; what is more keeps markers away from the edge.
pub const MARGIN: f64 = 1.05;

/// A view of space, orthographic or with slight perspective.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Rotation about the vertical axis, in radians; at 0 the x axis points to the right.
    pub yaw: f64,
    /// Elevation of the eye, in radians, −π/2 to π/2; at π/2 it looks straight down, with y up.
    pub pitch: f64,
    /// Magnification; 1 fits the scene.
    pub zoom: f64,
    /// Shift of the picture, as fractions of its width and height.
    pub pan: [f64; 2],
    /// Distance of the eye from the origin in units of the scene; `None` is infinity (orthographic).
    pub distance: Option<f64>,
}

impl Camera {
    /// The view for plane systems: the x–y plane seen face on, y up.
    pub const FACE_ON: Self =
        Self { yaw: 0.0, pitch: FRAC_PI_2, zoom: 1.0, pan: [0.0, 0.0], distance: None };

    /// Projects a point to its horizontal coordinate, its vertical coordinate, and how much nearer to the eye than the
    /// origin it is.
    pub fn project(&self, point: [f64; 3]) -> [f64; 3] {
        self.projection().of(point)
    }

    /// The direction towards the eye.
    pub fn towards(&self) -> [f64; 3] {
        let ((sin_yaw, cos_yaw), (sin_pitch, cos_pitch)) =
            (math::sin_cos(self.yaw), math::sin_cos(self.pitch));
        [sin_yaw * cos_pitch, -cos_yaw * cos_pitch, sin_pitch]
    }

    /// The projection of many points.
    pub fn projection(&self) -> CameraProjection {
        let (yaw, pitch) = (math::sin_cos(self.yaw), math::sin_cos(self.pitch));
        CameraProjection { yaw, pitch, distance: self.distance }
    }

    /// The frame over an area that shows a whole box with equal units, then zoomed and panned.
    pub fn frame(&self, bounds: &Bounds, area: Rect) -> PlotFrame {
        let [low, high] = bounds.ends.unwrap_or([[-1.0; 3], [1.0; 3]]);
        self.frame_around(&[Extent { low, high, radius: 0.0, hull: None }], area)
    }

    /// The frame over an area that shows the whole of each extent with equal units, then zoomed and panned. The
    /// outline of all of them on the screen, not a box in space around it, fills the area in one of its directions.
    pub fn frame_around(&self, extents: &[Extent], area: Rect) -> PlotFrame {
        self.frame_with(extents, &[], area)
    }

    /// The same around extents and single points.
    pub fn frame_with(&self, extents: &[Extent], points: &[[f64; 3]], area: Rect) -> PlotFrame {
        let projection = Self { distance: None, ..*self }.projection();
        let axes = projection.axes();
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for extent in extents {
            let (mut least, mut most) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
            for corner in extent.corners() {
                let seen = projection.of(corner);
                for k in 0..2 {
                    least[k] = least[k].min(seen[k]);
                    most[k] = most[k].max(seen[k]);
                }
            }
            for k in 0..2 {
                if let Some(hull) = &extent.hull {
                    least[k] = least[k].max(-hull.reach(axes[k].map(|x| -x)));
                    most[k] = most[k].min(hull.reach(axes[k]));
                }
                low[k] = low[k].min(least[k] - extent.radius);
                high[k] = high[k].max(most[k] + extent.radius);
            }
        }
        for point in points {
            let seen = projection.of(*point);
            for k in 0..2 {
                low[k] = low[k].min(seen[k]);
                high[k] = high[k].max(seen[k]);
            }
        }
        let half = |k: usize| high[k] / 2.0 - low[k] / 2.0;
        let least = half(0).max(half(1)).max(f64::MIN_POSITIVE) * 1e-3;
        let scale = |k: usize| {
            let middle = low[k] / 2.0 + high[k] / 2.0;
            let half = half(k).max(least) * MARGIN / self.zoom;
            Scale::linear(middle - half, middle + half)
        };
        let fitted = PlotFrame::equal(scale(0), scale(1), area);
        PlotFrame::new(fitted.x.panned(-self.pan[0]), fitted.y.panned(-self.pan[1]), area)
    }
}

/// A camera with the sine and cosine of its angles at hand.
#[derive(Clone, Copy, Debug)]
pub struct CameraProjection {
    yaw: (f64, f64),
    pitch: (f64, f64),
    distance: Option<f64>,
}

impl CameraProjection {
    /// The directions in space that are seen as horizontal and as vertical.
    fn axes(&self) -> [[f64; 3]; 2] {
        let ((sin_yaw, cos_yaw), (sin_pitch, cos_pitch)) = (self.yaw, self.pitch);
        [[cos_yaw, sin_yaw, 0.0], [-sin_yaw * sin_pitch, cos_yaw * sin_pitch, cos_pitch]]
    }

    /// Projects a point, see [`Camera::project`].
    pub fn of(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let ((sin_yaw, cos_yaw), (sin_pitch, cos_pitch)) = (self.yaw, self.pitch);
        let right = x * cos_yaw + y * sin_yaw;
        let away = y * cos_yaw - x * sin_yaw;
        let up = away * sin_pitch + z * cos_pitch;
        let near = z * sin_pitch - away * cos_pitch;
        let size = match self.distance {
            // Near the eye and behind it the magnification is limited.
            Some(distance) if distance > 0.0 => distance / (distance - near).max(distance * 0.1),
            _ => 1.0,
        };
        [right * size, up * size, near]
    }
}

/// A box in space.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bounds {
    ends: Option<[[f64; 3]; 2]>,
}

impl Bounds {
    /// The empty box.
    pub const EMPTY: Self = Self { ends: None };

    /// The smallest box around points; non-finite ones are ignored.
    pub fn around(points: impl IntoIterator<Item = [f64; 3]>) -> Self {
        points.into_iter().fold(Self::EMPTY, Self::with)
    }

    /// Enlarges the box to contain a point.
    #[must_use]
    pub fn with(self, point: [f64; 3]) -> Self {
        if !point.iter().all(|v| v.is_finite()) {
            return self;
        }
        let [low, high] = self.ends.unwrap_or([point, point]);
        let each = |pick: fn(f64, f64) -> f64, end: [f64; 3]| {
            std::array::from_fn(|i| pick(end[i], point[i]))
        };
        Self { ends: Some([each(f64::min, low), each(f64::max, high)]) }
    }

    /// The lowest and the highest corner, or `None` if the box is empty.
    pub fn ends(&self) -> Option<[[f64; 3]; 2]> {
        self.ends
    }
}

/// A box in space, each of whose points is the centre of a ball, or what of it is within a polytope.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// The lowest corner of the box.
    pub low: [f64; 3],
    /// The highest corner of the box.
    pub high: [f64; 3],
    /// The radius of the balls; 0 where the extent is the box itself.
    pub radius: f64,
    /// The polytope that contains the centres as well, if it is known.
    pub hull: Option<OrientationPolytope>,
}

impl Extent {
    /// The eight corners of the box, without the balls.
    fn corners(&self) -> impl Iterator<Item = [f64; 3]> {
        let Self { low, high, .. } = *self;
        (0..8).map(move |i| [0, 1, 2].map(|k| if i >> k & 1 == 0 { low[k] } else { high[k] }))
    }
}
