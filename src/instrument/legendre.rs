//! `legendre`: the Legendre transform as a picture: L as a function of one velocity, with everything else at its current
//! value, and its tangent where the motion is. The slope of the tangent is the momentum p, and where it meets the vertical
//! axis stands L − p q̇, which is −H for one degree of freedom. Of a Hamiltonian system it is H over the momentum, with
//! the slope q̇ (*The Principles of Dynamics*, § 2.1).

use super::{
    Across, Axis, Columns, Entry, Heading, Ink, Instrument, Layer, Level, MarkerShape, Measure,
    Offer, Physics, Picture, Plot, PlotContext, Present, Properties, Stroke, Upwards,
};
use crate::expr::{Expr, Symbol};
use crate::model::Mechanics;
use crate::num::significant;
use crate::system::ChannelKind;

const AXIS: Level = 0;
const TANGENT: Level = 1;
const CURVE: Level = 2;
const NOW: Level = 3;

const POINTS: usize = 241;

/// The places at which the range of the vertical axis is evaluated, but for one.
const PLACES: usize = 16;

/// The range, as a multiple of what the motion has reached.
const BEYOND: f64 = 1.4;

/// A second difference below this part of the greatest value counts as zero.
const FLAT: f64 = 1e-12;

pub(super) struct LegendrePlot;

#[derive(Clone, Copy)]
struct TransformedFunction {
    /// L of a velocity, or H of a momentum.
    function: Expr,
    letters: [&'static str; 2],
    number: Symbol,
    /// The coordinate, and its channel.
    place: (Symbol, usize),
    /// The channels of that number, and of the slope.
    channel: usize,
    slope: usize,
    /// Whether there is one degree of freedom.
    alone: bool,
}

impl TransformedFunction {
    fn of(plot: &Plot, physics: Physics<'_>) -> Option<Self> {
        let Physics { model, system, .. } = physics;
        let column = plot.column(0)?;
        let ChannelKind::Position(i) = system.channels().get(column)?.kind else {
            return None;
        };
        let coordinate = model.coordinates.get(i)?;
        let (velocity, momentum) = (ChannelKind::Velocity(i), ChannelKind::Momentum(i));
        let (function, letters, number, [channel, slope]) = match &model.mechanics {
            Mechanics::Lagrangian { lagrangian, .. } => {
                (*lagrangian, ["L", "H"], coordinate.velocity, [velocity, momentum])
            }
            Mechanics::Hamiltonian { hamiltonian, .. } => {
                (*hamiltonian, ["H", "L"], coordinate.momentum, [momentum, velocity])
            }
            Mechanics::Poisson { .. } => return None,
        };
        let (channel, slope) = (physics.channel(channel)?, physics.channel(slope)?);
        let alone = model.coordinates.len() == 1;
        let place = (coordinate.position, column);
        Some(Self { function, letters, number, place, channel, slope, alone })
    }

    /// The numbers of the motion now: the abscissa, the function there, and the slope.
    fn now(&self, present: &Present<'_>) -> [f64; 3] {
        let x = present.value(self.channel);
        [x, self.at(present, &[x])[0], present.value(self.slope)]
    }

    /// The function at numbers, with everything else at its current value.
    fn at(&self, present: &Present<'_>, numbers: &[f64]) -> Vec<f64> {
        let (model, now) = (present.physics.model, present.valuation());
        let value = |&x: &f64| {
            let at = |symbol| if symbol == self.number { x } else { now.at(symbol) };
            model.pool.evaluate(self.function, &at)
        };
        numbers.iter().map(value).collect()
    }

    /// Values of the function where the coordinate has been, at the ends of the range and in its middle: with them the vertical
    /// axis stays where it is while the curve goes up and down.
    fn elsewhere(&self, present: &Present<'_>, [from, to]: [f64; 2]) -> Vec<f64> {
        let Some(&(low, high)) = present.bounds.get(self.place.1) else { return Vec::new() };
        let (model, now) = (present.physics.model, present.valuation());
        let places = (0..=PLACES).map(|k| low + (high - low) * k as f64 / PLACES as f64);
        let all = places.flat_map(|place| [from, 0.5 * (from + to), to].map(|x| (place, x)));
        let value = |(place, x): (f64, f64)| {
            let at = |symbol| match symbol {
                s if s == self.number => x,
                s if s == self.place.0 => place,
                _ => now.at(symbol),
            };
            model.pool.evaluate(self.function, &at)
        };
        all.map(value).collect()
    }

    fn range(&self, present: &Present<'_>) -> [f64; 2] {
        let (low, high) = present.bounds.get(self.channel).copied().unwrap_or((0.0, 0.0));
        let reached = [low, high, present.value(self.channel)].map(f64::abs);
        let reached = reached.into_iter().filter(|x| x.is_finite()).fold(0.0, f64::max);
        let reach = if reached > 0.0 { BEYOND * reached } else { 1.0 };
        [-reach, reach]
    }
}

const PROPERTIES: Properties = Properties {
    name: "legendre",
    written: &[Axis { heading: "Coordinate", coordinate: true, ..Axis::ACROSS }],
    measures: &[
        Measure::new(
            "slope",
            "the slope of the tangent, by the momentum (or velocity) of the motion",
            |PlotContext { plot, present, .. }| {
                Some(TransformedFunction::of(plot, present.physics)?.now(present)[2])
            },
        ),
        Measure::new(
            "intercept",
            "where the tangent meets the vertical axis",
            |PlotContext { plot, present, .. }| {
                let [x, y, slope] = TransformedFunction::of(plot, present.physics)?.now(present);
                Some(y - slope * x)
            },
        ),
    ],
    ..Properties::PLAIN
};

impl Instrument for LegendrePlot {
    fn properties(&self) -> &'static Properties {
        &PROPERTIES
    }

    fn offers(&self, physics: Physics<'_>) -> Vec<Offer> {
        let offer = |(_, channel): (usize, usize)| {
            let columns: Columns = vec![vec![channel]];
            let plot = Plot::new(&LegendrePlot, (columns.clone(), None), physics.model);
            let found = TransformedFunction::of(&plot, physics)?;
            let (function, number) = (found.letters[0], physics.shown(found.channel));
            Some(Offer::new(
                format!("Legendre transform, {function} over {number}"),
                "the momentum as a slope, the Hamiltonian as an intercept",
                columns,
            ))
        };
        physics.positions().filter_map(offer).collect()
    }

    fn words(&self, plot: &Plot, physics: Physics<'_>) -> String {
        let of = plot.column(0).map_or("?", |channel| physics.shown(channel));
        format!("Legendre transform in {of}")
    }

    fn heading(&self, plot: &Plot, present: &Present<'_>) -> Option<Heading> {
        let found = TransformedFunction::of(plot, present.physics)?;
        let entries = vec![Entry::Channel(found.channel), Entry::Channel(found.slope)];
        Some(plot.heading(present.physics, "Legendre transform", entries))
    }

    fn across(&self, PlotContext { plot, present, .. }: PlotContext<'_>) -> Across {
        TransformedFunction::of(plot, present.physics).map_or(Across::Nothing, |found| {
            Across::Channel(found.channel, Some(found.range(present)))
        })
    }

    fn picture(
        &self,
        PlotContext { plot, present, .. }: PlotContext<'_>,
        [from, to]: [f64; 2],
    ) -> Option<Picture> {
        let found = TransformedFunction::of(plot, present.physics)?;
        let [x, y, slope] = found.now(present);
        let step = (to - from) / (POINTS - 1) as f64;
        let numbers: Vec<f64> = (0..POINTS).map(|i| from + step * i as f64).collect();
        let values = found.at(present, &numbers);
        let intercept = y - slope * x;
        let tangent = |at: f64| [at, intercept + slope * at];
        let elsewhere = found.elsewhere(present, [from, to]);
        let seen = values.iter().chain(&elsewhere).chain([&y, &intercept]);
        let seen = seen.filter(|value| value.is_finite());
        let (low, high) = seen.fold((0.0_f64, 0.0_f64), |(lo, hi), &v| (lo.min(v), hi.max(v)));
        let faint = Stroke { ink: Ink::Level, covering: Some(0.5) };
        let [letter, other] = found.letters;
        let [number, of_slope] = [found.channel, found.slope].map(|c| present.physics.shown(c));
        let named = if found.alone {
            format!("−{other}")
        } else {
            format!("{letter} − {of_slope} {number}")
        };
        let short = |x: f64| significant(x, 4, 1e-3..1e5).replace('-', "−");
        let mut lines = vec![
            format!("slope {of_slope} = {}", short(slope)),
            format!("intercept {named} = {}", short(intercept)),
        ];
        lines.extend(shape(&values).map(|shape| match shape {
            CurveShape::Straight => format!("straight: {of_slope} does not determine {number}"),
            CurveShape::Bent => format!("not convex: several {number} may have one {of_slope}"),
        }));
        let curve = numbers.iter().zip(&values).map(|(&x, &y)| [x, y]).collect();
        let layers = vec![
            (AXIS, Layer::Line(vec![[0.0, intercept], [0.0, 0.0]], faint)),
            (TANGENT, Layer::Line(vec![tangent(from), tangent(to)], Ink::Warn.into())),
            (CURVE, Layer::Line(curve, Ink::Accent.into())),
            (NOW, Layer::Point([0.0, intercept], MarkerShape::Ring, Ink::Warn)),
            (NOW, Layer::Point([x, y], MarkerShape::Disc, Ink::Accent)),
            (NOW, Layer::Legend(lines)),
        ];
        let upwards = Upwards::Named(letter.to_owned(), [low, high]);
        Some(Picture::Axes { upwards, layers, occurrences: None })
    }
}

/// How a curve is bent whose slope does not determine the abscissa.
enum CurveShape {
    Straight,
    Bent,
}

/// Whether a curve is straight, or bent in both directions; `None` if it is bent in one.
fn shape(values: &[f64]) -> Option<CurveShape> {
    let size = values.iter().fold(0.0_f64, |size, y| size.max(y.abs()));
    let bends = values.windows(3).map(|three| three[0] - 2.0 * three[1] + three[2]);
    let (mut up, mut down, mut known) = (false, false, false);
    for bend in bends.filter(|bend| bend.is_finite()) {
        up |= bend > FLAT * size;
        down |= bend < -FLAT * size;
        known = true;
    }
    match (up, down) {
        (true, true) => Some(CurveShape::Bent),
        (false, false) if known => Some(CurveShape::Straight),
        _ => None,
    }
}
