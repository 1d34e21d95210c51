//! The camera: from points in space to points on the screen.
//!
//! In: points with z up, angles, zoom. Out: places to the right and upwards in the units of the scene, with their
//! depth. Never here: shapes, or what is hidden by what.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use ratatui::layout::Rect;

use super::scale::{Frame, Scale};
use crate::num::math;

/// A view of space from far away, or with slight perspective.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Turn about the vertical axis, in radians; at 0 the x axis points to the right.
    pub yaw: f64,
    /// Height of the eye above the horizon, in radians, −π/2 to π/2; at π/2 it looks straight down, y up.
    pub pitch: f64,
    /// Magnification, 1 fits the scene.
    pub zoom: f64,
    /// Shift of the picture, in parts of its width and height.
    pub pan: [f64; 2],
    /// Distance of the eye from the origin in units of the scene; `None` is infinitely far (orthographic).
    pub distance: Option<f64>,
}

impl Camera {
    /// For plane systems: the x–y plane seen face on, y up.
    pub const FACE_ON: Self =
        Self { yaw: 0.0, pitch: FRAC_PI_2, zoom: 1.0, pan: [0.0, 0.0], distance: None };

    /// For systems in space: from the front, a little from the right and from above, z up.
    pub const IN_SPACE: Self =
        Self { yaw: PI / 6.0, pitch: PI / 9.0, zoom: 1.0, pan: [0.0, 0.0], distance: None };

    /// Turned further; the pitch stops at the poles.
    #[must_use]
    pub fn turned(self, yaw: f64, pitch: f64) -> Self {
        let yaw = (self.yaw + yaw).rem_euclid(TAU);
        let pitch = (self.pitch + pitch).clamp(-FRAC_PI_2, FRAC_PI_2);
        Self {
            yaw: if yaw.is_finite() { yaw } else { self.yaw },
            pitch: if pitch.is_finite() { pitch } else { self.pitch },
            ..self
        }
    }

    /// Magnified further, between a hundredth and a hundredfold.
    #[must_use]
    pub fn zoomed(self, factor: f64) -> Self {
        let zoom = (self.zoom * factor).clamp(0.01, 100.0);
        Self { zoom: if zoom.is_finite() { zoom } else { self.zoom }, ..self }
    }

    /// Moved by parts of the picture's width and height.
    #[must_use]
    pub fn panned(self, right: f64, up: f64) -> Self {
        Self { pan: [self.pan[0] + right, self.pan[1] + up], ..self }
    }

    /// Place to the right, place upwards, and how much nearer to the eye than the origin.
    pub fn project(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let (sin_yaw, cos_yaw) = math::sin_cos(self.yaw);
        let (sin_pitch, cos_pitch) = math::sin_cos(self.pitch);
        let right = x * cos_yaw + y * sin_yaw;
        let away = y * cos_yaw - x * sin_yaw;
        let up = away * sin_pitch + z * cos_pitch;
        let near = z * sin_pitch - away * cos_pitch;
        let size = match self.distance {
            // Close to the eye and behind it things only grow so much.
            Some(distance) if distance > 0.0 => distance / (distance - near).max(distance * 0.1),
            _ => 1.0,
        };
        [right * size, up * size, near]
    }

    /// The frame over an area that shows a box whole, with equal units, then zoomed and panned.
    ///
    /// In space the fit is the same for every yaw, so that the picture does not breathe while it is turned.
    pub fn frame(&self, bounds: &Bounds, area: Rect) -> Frame {
        let [right, up, _] = Self { distance: None, ..*self }.project(bounds.middle());
        let [x, y, z] = bounds.half();
        let plane = z == 0.0 && self.pitch == FRAC_PI_2 && self.yaw == 0.0;
        let round = math::hypot(x, y);
        let (wide, high) = if plane {
            (x, y)
        } else {
            (round, round * math::sin(self.pitch).abs() + z * math::cos(self.pitch))
        };
        let least = wide.max(high).max(f64::MIN_POSITIVE) * 1e-3;
        let scale = |middle: f64, half: f64, pan: f64| {
            // A margin of a twentieth keeps markers off the edge.
            let half = half.max(least) * 1.05 / self.zoom;
            Scale::linear(middle - half, middle + half).panned(-pan)
        };
        let fitted = Frame::equal(scale(right, wide, 0.0), scale(up, high, 0.0), area);
        Frame::new(fitted.x.panned(-self.pan[0]), fitted.y.panned(-self.pan[1]), area)
    }
}

/// A box in space.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bounds {
    ends: Option<[[f64; 3]; 2]>,
}

impl Bounds {
    /// A box with nothing in it.
    pub const EMPTY: Self = Self { ends: None };

    /// The least box around points; non-finite ones are left out.
    pub fn around(points: impl IntoIterator<Item = [f64; 3]>) -> Self {
        points.into_iter().fold(Self::EMPTY, Self::with)
    }

    /// The box widened to hold a point.
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

    /// The lowest and the highest corner, `None` of nothing.
    pub fn ends(&self) -> Option<[[f64; 3]; 2]> {
        self.ends
    }

    fn middle(&self) -> [f64; 3] {
        let [low, high] = self.ends.unwrap_or_default();
        std::array::from_fn(|i| low[i] / 2.0 + high[i] / 2.0)
    }

    fn half(&self) -> [f64; 3] {
        let [low, high] = self.ends.unwrap_or([[-1.0; 3], [1.0; 3]]);
        std::array::from_fn(|i| high[i] / 2.0 - low[i] / 2.0)
    }
}
