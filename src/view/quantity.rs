//! A quantity of the loaded system: its name, its unit, its values and its axis.
//!
//! In: a channel of the system and the snapshot. Out: text and scales. Never here: cells.

use super::RenderStyle;
use super::plot::ticks::nice_range;
use super::plot::{DrawnAxis, Scale};
use crate::app::Lab;
use crate::experiment::Snapshot;
use crate::expr::{Expr, Symbol};
use crate::instrument::{Present, Viewport};
use crate::model::Point;

/// The quantities of a lab in a snapshot.
#[derive(Clone, Copy)]
pub(super) struct Quantities<'a> {
    pub(super) lab: &'a Lab,
    pub(super) snapshot: &'a Snapshot,
    pub(super) style: &'a RenderStyle,
}

impl<'a> Quantities<'a> {
    /// The quantities in the lab's newest snapshot, or `None` if there is none.
    pub(super) fn of(lab: &'a Lab, style: &'a RenderStyle) -> Option<Self> {
        Some(Self { lab, snapshot: lab.seen()?, style })
    }

    /// The quantities in a snapshot, or `None` if it does not fit the system.
    pub(super) fn at(lab: &'a Lab, snapshot: &'a Snapshot, style: &'a RenderStyle) -> Option<Self> {
        lab.fits(snapshot).then_some(Self { lab, snapshot, style })
    }

    /// The same data in the form that instruments take.
    pub(super) fn present(&self) -> Present<'a> {
        self.lab.present_of(self.snapshot)
    }

    /// A channel's name as this terminal shows it: in ASCII a symbol is written as in the file, and words are those of every
    /// terminal.
    pub(super) fn name(&self, channel: usize) -> String {
        let channels = self.lab.loaded.system.channels();
        let name = |c: &crate::system::Channel| {
            let ascii = if c.shown.contains(' ') { &c.shown } else { &c.name };
            self.style.glyphs.pick(&c.shown, ascii).clone()
        };
        let name = channels.get(channel).map_or_else(|| "?".to_owned(), name);
        self.style.glyphs.text(&name).into_owned()
    }

    /// A channel's unit, or an empty text.
    pub(super) fn unit(&self, channel: usize) -> &'a str {
        self.lab.loaded.system.channels().get(channel).map_or("", |c| &c.unit)
    }

    pub(super) fn value(&self, channel: usize) -> f64 {
        self.snapshot.values.get(channel).copied().unwrap_or(f64::NAN)
    }

    /// The least and greatest value of a channel since the start.
    pub(super) fn bounds(&self, channel: usize) -> (f64, f64) {
        self.snapshot.bounds.get(channel).copied().unwrap_or((f64::NAN, f64::NAN))
    }

    /// The range of a channel. If it is only rounding error beside channels of the same kind and unit, their range; an angle has at
    /// least one in which rounding is flat.
    fn extent(&self, channel: usize) -> (f64, f64) {
        if let Some(greatest) = self.greatest_beside_rounding(channel) {
            return (-greatest, greatest);
        }
        let (lo, hi) = self.bounds(channel);
        let is_least = self.unit(channel) == "rad" && lo.abs().max(hi.abs()) < LEAST_ANGLE;
        if is_least { (-LEAST_ANGLE, LEAST_ANGLE) } else { (lo, hi) }
    }

    /// Whether a channel is only rounding error beside channels of the same kind and unit.
    pub(super) fn is_rounding_error(&self, channel: usize) -> bool {
        self.greatest_beside_rounding(channel).is_some()
    }

    /// The greatest value of channels of the same kind and unit, if this one is only rounding error beside it.
    fn greatest_beside_rounding(&self, channel: usize) -> Option<f64> {
        let channels = self.lab.loaded.system.channels();
        let own = channels.get(channel)?;
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
        (size(channel) < ROUNDING * greatest).then_some(greatest)
    }

    pub(super) fn period(&self, channel: usize) -> Option<f64> {
        self.lab.loaded.system.period(channel, &self.snapshot.parameters)
    }

    /// The source of an expression's value: a number, or a channel.
    pub(super) fn place(&self, expression: Expr) -> QuantitySource {
        if let Some(number) = self.lab.loaded.equations.pool.as_number(expression) {
            return QuantitySource::Number(number.value());
        }
        let channel = self.lab.loaded.system.channel_of(expression);
        channel.map_or(QuantitySource::Number(f64::NAN), QuantitySource::Channel)
    }

    /// Whether an expression is the same at all times: a number, or a function of parameters none of which is ramped.
    pub(super) fn is_constant(&self, expression: Expr) -> bool {
        let model = &self.lab.loaded.model;
        let constant = |symbol: &Symbol| {
            model.parameters.iter().any(|parameter| parameter.symbol == *symbol)
                && !model.ramped.functions().any(|(ramped, _)| ramped == *symbol)
        };
        let pool = &self.lab.loaded.equations.pool;
        pool.as_number(expression).is_some() || pool.symbols_of(expression).iter().all(constant)
    }

    /// The current value of an expression of a shape.
    pub(super) fn number(&self, expression: Expr) -> f64 {
        self.place(expression).read(&self.snapshot.values)
    }

    /// The current position of a point of a shape.
    pub(super) fn point(&self, point: &Point) -> [f64; 3] {
        point.map(|expression| self.number(expression))
    }

    /// The axis of a channel over the whole motion, or over the given range, seen through a viewport.
    pub(super) fn axis(
        &self,
        channel: usize,
        range: Option<[f64; 2]>,
        viewport: (Viewport, usize),
    ) -> DrawnAxis {
        let (lo, hi) = self.extent(channel);
        // a motion that was begun in the picture keeps its window
        let (lo, hi) = self
            .lab
            .window_before(channel)
            .map_or((lo, hi), |before| (before.0.min(lo), before.1.max(hi)));
        let range = self
            .lab
            .least_range(channel)
            .map(|least| {
                let [from, to] = range.unwrap_or([lo, hi]);
                [least[0].min(from), least[1].max(to)]
            })
            .or(range);
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
        DrawnAxis::new(self.name(channel), unit, through(scale, viewport))
    }
}

/// The least range of an angle, to either side of zero, far above what rounding leaves of its sine and cosine.
const LEAST_ANGLE: f64 = 1e-9;

/// Values below this, relative to similar ones, are rounding errors.
const ROUNDING: f64 = 1e-13;

/// The centre of the turn that contains all values between the two, so that a motion about the top is not split. If they
/// take most of a turn or more, it is zero.
fn turn_of(lo: f64, hi: f64, period: f64) -> f64 {
    let half = period / 2.0;
    if hi - lo < 0.8 * period { (f64::midpoint(lo, hi) / half).round() * half } else { 0.0 }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum QuantitySource {
    Number(f64),
    Channel(usize),
}

impl QuantitySource {
    /// Reads the value from a row of channels.
    pub(super) fn read(self, values: &[f64]) -> f64 {
        match self {
            Self::Number(number) => number,
            Self::Channel(index) => values.get(index).copied().unwrap_or(f64::NAN),
        }
    }
}

/// A scale seen through a viewport; `axis` is 0 for horizontal, 1 for vertical.
pub(super) fn through(scale: Scale, (viewport, axis): (Viewport, usize)) -> Scale {
    let scale = if viewport.log && axis == 1 { Scale::log(scale.lo, scale.hi) } else { scale };
    if viewport.zoom[axis] == 1.0 && viewport.pan[axis] == 0.0 {
        return scale;
    }
    scale.zoomed(viewport.zoom[axis], 0.5).panned(viewport.pan[axis])
}
