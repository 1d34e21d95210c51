//! Scales and frames: from data to positions on the screen and back.
//!
//! In: values in the units of an axis. Out: fractions of the axis, dots and cells. Never here: drawing.

use ratatui::layout::{Position, Rect};

use crate::num::math;
use crate::view::glyphs::Glyphs;

/// What rounding leaves of zero, in parts of an axis.
const ROUNDING: f64 = 1e-9;

/// The height of a cell relative to its width, approximately.
pub const CELL_ASPECT: f64 = 2.0;

/// How numbers become places along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScaleKind {
    /// Equal differences are equally far apart.
    Linear,
    /// Linear, with ticks at fractions of π.
    Angle,
    /// Logarithmic; only positive values have a position.
    Log,
}

/// One axis: the range of values it shows, from left to right or from bottom to top.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// Value at the left or lower end.
    pub lo: f64,
    /// Value at the right or upper end, above `lo`.
    pub hi: f64,
    /// How the axis is divided.
    pub kind: ScaleKind,
    /// Period after which values repeat; they are then wrapped about the middle of the range.
    pub period: Option<f64>,
}

impl Scale {
    /// Creates a linear scale. An empty, reversed or non-finite range becomes a usable one.
    pub fn linear(lo: f64, hi: f64) -> Self {
        let (lo, hi) = usable(lo, hi);
        Self { lo, hi, kind: ScaleKind::Linear, period: None }
    }

    /// Creates a logarithmic scale; a range that is not positive becomes the decades just below its upper end.
    pub fn log(lo: f64, hi: f64) -> Self {
        let hi = if hi.is_finite() && hi > f64::MIN_POSITIVE { hi } else { 1.0 };
        let lo = if lo.is_finite() && lo > 0.0 && lo < hi {
            lo
        } else {
            (hi * 1e-3).max(f64::MIN_POSITIVE)
        };
        let lo = if math::log10(hi) - math::log10(lo) > 1e-9 { lo } else { hi * 0.5 };
        Self { lo, hi, kind: ScaleKind::Log, period: None }
    }

    /// One turn of an angle in radians, −π to π, wrapped.
    pub fn turn() -> Self {
        Self::linear(-std::f64::consts::PI, std::f64::consts::PI)
            .angle()
            .wrapped(std::f64::consts::TAU)
    }

    /// The same range with ticks at fractions of π.
    #[must_use]
    pub fn angle(self) -> Self {
        Self { kind: ScaleKind::Angle, ..self }
    }

    /// The same range for values that repeat after `period`; a period that is not positive is ignored.
    #[must_use]
    pub fn wrapped(self, period: f64) -> Self {
        Self { period: Some(period).filter(|p| p.is_finite() && *p > 0.0), ..self }
    }

    /// The middle of the range.
    pub fn middle(&self) -> f64 {
        self.value(0.5)
    }

    /// The range magnified by `factor` about the value at `anchor` (a fraction of the axis).
    #[must_use]
    pub fn zoomed(&self, factor: f64, anchor: f64) -> Self {
        let factor = if factor.is_finite() && factor > 0.0 { factor } else { 1.0 };
        let end = |fraction: f64| self.value(anchor + (fraction - anchor) / factor);
        self.with_range(end(0.0), end(1.0))
    }

    /// The range shifted by a fraction of its length.
    #[must_use]
    pub fn panned(&self, fraction: f64) -> Self {
        self.with_range(self.value(fraction), self.value(1.0 + fraction))
    }

    /// The same axis with another range.
    #[must_use]
    pub fn with_range(&self, lo: f64, hi: f64) -> Self {
        let Self { lo, hi, .. } =
            if self.kind == ScaleKind::Log { Self::log(lo, hi) } else { Self::linear(lo, hi) };
        Self { lo, hi, ..*self }
    }

    /// The position of a value on the axis: 0 at `lo`, 1 at `hi`, not clamped; NaN if it has none. Periodic values wrap.
    pub fn fraction(&self, value: f64) -> f64 {
        let value = self.wrap(value);
        match self.kind {
            // The values are halved, because the length of a huge range overflows.
            ScaleKind::Linear | ScaleKind::Angle => {
                (value / 2.0 - self.lo / 2.0) / (self.hi / 2.0 - self.lo / 2.0)
            }
            ScaleKind::Log if value > 0.0 => {
                (math::ln(value) - math::ln(self.lo)) / (math::ln(self.hi) - math::ln(self.lo))
            }
            ScaleKind::Log => f64::NAN,
        }
    }

    /// The value at a position on the axis; the inverse of [`Self::fraction`].
    pub fn value(&self, fraction: f64) -> f64 {
        match self.kind {
            ScaleKind::Linear | ScaleKind::Angle => self.lo * (1.0 - fraction) + self.hi * fraction,
            ScaleKind::Log => {
                math::exp(math::ln(self.lo) * (1.0 - fraction) + math::ln(self.hi) * fraction)
            }
        }
    }

    /// The fraction of the axis that one period takes, if it is periodic.
    pub(super) fn turn_length(&self) -> Option<f64> {
        let length = self.period? / (self.hi - self.lo);
        (self.kind != ScaleKind::Log && length.is_finite() && length > 0.0).then_some(length)
    }

    fn wrap(&self, value: f64) -> f64 {
        match self.period {
            Some(period) if self.kind != ScaleKind::Log => {
                // The upper end is part of the window, so that a range of one period contains both its ends.
                let turns = (value - self.middle()) / period;
                let turns = if turns.abs() <= 0.5 { 0.0 } else { turns.round() };
                value - period * turns
            }
            _ => value,
        }
    }
}

/// Makes a usable range from any two numbers.
fn usable(lo: f64, hi: f64) -> (f64, f64) {
    let (lo, hi) = match (lo.is_finite(), hi.is_finite()) {
        (true, true) => (lo.min(hi), lo.max(hi)),
        (true, false) => (lo, lo),
        (false, true) => (hi, hi),
        (false, false) => (0.0, 0.0),
    };
    // A range too narrow for floating-point numbers counts as empty.
    let size = lo.abs().max(hi.abs());
    if hi - lo > size * 1e-12 && hi - lo > f64::MIN_POSITIVE {
        return (lo, hi);
    }
    let half = if size < 1e-300 { 1.0 } else { size * 0.5 };
    ((lo - half).max(f64::MIN), (hi + half).min(f64::MAX))
}

/// The distance, in plot lengths, beyond which a point is moved; nearer points keep their exact direction.
const FAR: f64 = 1e7;

/// Two scales over a rectangle of cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlotFrame {
    /// The horizontal axis.
    pub x: Scale,
    /// The vertical axis; values increase towards the top.
    pub y: Scale,
    /// The cells that they cover.
    pub area: Rect,
}

impl PlotFrame {
    /// The two scales over an area.
    pub fn new(x: Scale, y: Scale, area: Rect) -> Self {
        Self { x, y, area }
    }

    /// Widens one range about its middle until a unit has the same length on both axes. Logarithmic axes have no common
    /// unit and remain unchanged.
    pub fn equal(x: Scale, y: Scale, area: Rect) -> Self {
        if x.kind == ScaleKind::Log || y.kind == ScaleKind::Log {
            return Self::new(x, y, area);
        }
        let wide = f64::from(area.width.max(1));
        let high = f64::from(area.height.max(1)) * CELL_ASPECT;
        let unit = ((x.hi - x.lo) / wide).max((y.hi - y.lo) / high);
        let widened = |scale: &Scale, length: f64| {
            let half = unit * length / 2.0;
            scale.with_range(scale.middle() - half, scale.middle() + half)
        };
        Self { x: widened(&x, wide), y: widened(&y, high), area }
    }

    /// The cell that contains a point, or `None` if it is outside the area.
    pub fn cell(&self, [x, y]: [f64; 2]) -> Option<Position> {
        let column = index(self.x.fraction(x), self.area.width)?;
        let row = index(1.0 - self.y.fraction(y), self.area.height)?;
        Some(Position::new(self.area.x.saturating_add(column), self.area.y.saturating_add(row)))
    }

    /// A point whose coordinates are zero where they are nearer to it than these parts of the axes.
    pub fn near_zero(&self, at: [f64; 2], parts: [f64; 2]) -> [f64; 2] {
        let scales = [self.x, self.y];
        [0, 1].map(|k| {
            let off = (scales[k].fraction(at[k]) - scales[k].fraction(0.0)).abs();
            if off < parts[k] { 0.0 } else { at[k] }
        })
    }

    /// The data coordinates of the centre of a cell, for the cursor's readout and the mouse; what rounding leaves of zero is zero.
    pub fn at(&self, cell: Position) -> [f64; 2] {
        let middle = |cell: u16, start: u16, length: u16| {
            (f64::from(cell) - f64::from(start) + 0.5) / f64::from(length.max(1))
        };
        let at = [
            self.x.value(middle(cell.x, self.area.x, self.area.width)),
            self.y.value(1.0 - middle(cell.y, self.area.y, self.area.height)),
        ];
        self.near_zero(at, [ROUNDING; 2])
    }

    /// The position of a point among this many dots, with y downwards; NaN if a coordinate is not finite.
    pub(super) fn dot(&self, [x, y]: [f64; 2], [wide, high]: [i32; 2]) -> [f64; 2] {
        let fraction = |scale: &Scale, value: f64| {
            if value.is_finite() { scale.fraction(value).clamp(-FAR, FAR) } else { f64::NAN }
        };
        let (right, up) = (fraction(&self.x, x), fraction(&self.y, y));
        [right * f64::from(wide), (1.0 - up) * f64::from(high)]
    }

    /// The number of dots: columns, rows.
    pub fn dots(&self, glyphs: Glyphs) -> (u32, u32) {
        let (wide, high) = glyphs.dots();
        (
            u32::from(self.area.width) * u32::from(wide),
            u32::from(self.area.height) * u32::from(high),
        )
    }
}

/// The one of `count` equal parts that contains a fraction; the end 1 belongs to the last.
fn index(fraction: f64, count: u16) -> Option<u16> {
    if !(0.0..=1.0).contains(&fraction) || count == 0 {
        return None;
    }
    // Rounding must not decide at the border of two parts, or even ticks would be spaced unevenly.
    Some(((fraction * f64::from(count) + 1e-9) as u16).min(count - 1))
}
