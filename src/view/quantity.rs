//! A quantity of the loaded system: its name, its unit, its values and the axis it is drawn on.
//!
//! In: a channel of the system and the snapshot. Out: text and scales. Never here: cells.

use super::RenderStyle;
use super::plot::ticks::nice_range;
use super::plot::{Axis, Scale};
use crate::app::{Lab, Viewport};
use crate::experiment::Snapshot;
use crate::expr::Expr;
use crate::model::Point;

/// Quantities of a lab, as its snapshot has them.
#[derive(Clone, Copy)]
pub(super) struct Quantities<'a> {
    pub(super) lab: &'a Lab,
    pub(super) snapshot: &'a Snapshot,
    pub(super) look: &'a RenderStyle,
}

impl<'a> Quantities<'a> {
    /// The quantities of a lab that has been seen in motion.
    pub(super) fn of(lab: &'a Lab, look: &'a RenderStyle) -> Option<Self> {
        Some(Self { lab, snapshot: lab.seen()?, look })
    }

    /// The quantities as a snapshot has them, if it fits the system.
    pub(super) fn at(lab: &'a Lab, snapshot: &'a Snapshot, look: &'a RenderStyle) -> Option<Self> {
        lab.fits(snapshot).then_some(Self { lab, snapshot, look })
    }

    /// A channel's name as this terminal shows it.
    pub(super) fn name(&self, channel: usize) -> String {
        let channels = self.lab.loaded.system.channels();
        let name = |c: &crate::system::Channel| self.look.glyphs.pick(&c.shown, &c.name).clone();
        let name = channels.get(channel).map_or_else(|| "?".to_owned(), name);
        self.look.glyphs.text(&name).into_owned()
    }

    /// A channel's unit, in brackets, or nothing.
    pub(super) fn unit(&self, channel: usize) -> &'a str {
        self.lab.loaded.system.channels().get(channel).map_or("", |c| &c.unit)
    }

    /// A channel's value now.
    pub(super) fn value(&self, channel: usize) -> f64 {
        self.snapshot.values.get(channel).copied().unwrap_or(f64::NAN)
    }

    /// The least and greatest value of a channel since the start.
    pub(super) fn bounds(&self, channel: usize) -> (f64, f64) {
        self.snapshot.bounds.get(channel).copied().unwrap_or((f64::NAN, f64::NAN))
    }

    /// The bounds of a channel that is more than rounding beside others of its kind and unit; else theirs.
    fn extent(&self, channel: usize) -> (f64, f64) {
        let (lo, hi) = self.bounds(channel);
        let channels = self.lab.loaded.system.channels();
        let Some(own) = channels.get(channel) else { return (lo, hi) };
        let size = |channel: usize| {
            let (lo, hi) = self.bounds(channel);
            lo.abs().max(hi.abs())
        };
        let alike = channels.iter().enumerate().filter(|(_, other)| {
            std::mem::discriminant(&other.kind) == std::mem::discriminant(&own.kind)
                && other.unit == own.unit
        });
        let greatest =
            alike.map(|(index, _)| size(index)).filter(|s| s.is_finite()).fold(0.0, f64::max);
        if size(channel) < ROUNDING * greatest { (-greatest, greatest) } else { (lo, hi) }
    }

    /// After what a channel repeats.
    pub(super) fn period(&self, channel: usize) -> Option<f64> {
        self.lab.loaded.system.period(channel, &self.snapshot.parameters)
    }

    /// Where an expression of the model or of what follows from it is found: a number, or a channel.
    pub(super) fn place(&self, expression: Expr) -> Source {
        if let Some(number) = self.lab.loaded.equations.pool.as_number(expression) {
            return Source::Number(number.value());
        }
        let channel = self.lab.loaded.system.channel_of(expression);
        channel.map_or(Source::Number(f64::NAN), Source::Channel)
    }

    /// The present value of an expression of a shape.
    pub(super) fn number(&self, expression: Expr) -> f64 {
        self.place(expression).read(&self.snapshot.values)
    }

    /// Where a point of a shape is now.
    pub(super) fn point(&self, point: &Point) -> [f64; 3] {
        point.map(|expression| self.number(expression))
    }

    /// The axis of a channel that shows all of the motion, or the range given, through a lens.
    pub(super) fn axis(
        &self,
        channel: usize,
        range: Option<[f64; 2]>,
        viewport: (Viewport, usize),
    ) -> Axis {
        let (lo, hi) = self.extent(channel);
        let period = self.period(channel);
        let scale = match (range, period) {
            (Some([lo, hi]), _) => Scale::linear(lo, hi),
            (None, Some(period)) if lo < -period / 2.0 || hi > period / 2.0 => {
                let middle = turn_of(lo, hi, period);
                Scale::linear(middle - period / 2.0, middle + period / 2.0)
            }
            _ => {
                let (lo, hi) = nice_range(lo, hi);
                Scale::linear(lo, hi)
            }
        };
        let scale = match period {
            Some(period) => scale.wrapped(period),
            None => scale,
        };
        let unit = self.unit(channel);
        let scale = if unit == "rad" { scale.angle() } else { scale };
        Axis::new(self.name(channel), unit, through(scale, viewport))
    }
}

/// What is smaller than this beside its like is zero but for rounding.
const ROUNDING: f64 = 1e-13;

/// The middle of the turn in which all values between two lie: a motion about the top is not torn in two. Where they take
/// most of a turn, or more, zero.
fn turn_of(lo: f64, hi: f64, period: f64) -> f64 {
    let half = period / 2.0;
    if hi - lo < 0.8 * period { (f64::midpoint(lo, hi) / half).round() * half } else { 0.0 }
}

/// Where a number comes from.
#[derive(Clone, Copy)]
pub(super) enum Source {
    /// It is always the same.
    Number(f64),
    /// The channel of this index.
    Channel(usize),
}

impl Source {
    /// The value in a row of channels.
    pub(super) fn read(self, values: &[f64]) -> f64 {
        match self {
            Self::Number(number) => number,
            Self::Channel(index) => values.get(index).copied().unwrap_or(f64::NAN),
        }
    }
}

/// A scale through a lens; `axis` is 0 across, 1 upwards.
pub(super) fn through(scale: Scale, (viewport, axis): (Viewport, usize)) -> Scale {
    let scale = if viewport.log && axis == 1 { Scale::log(scale.lo, scale.hi) } else { scale };
    if viewport.zoom[axis] == 1.0 && viewport.pan[axis] == 0.0 {
        return scale;
    }
    scale.zoomed(viewport.zoom[axis], 0.5).panned(viewport.pan[axis])
}
