//! `potential`: a potential along one coordinate with everything else at its current value, the energy as a
//! horizontal line, and the region where the motion is allowed.

use super::{
    Across, Axis, Entry, Heading, Ink, Instrument, Layer, Level, MarkerShape, Offer, Physics,
    Picture, Plot, PlotContext, Present, Properties, Stroke, Upwards,
};
use crate::expr::{Expr, Pool, Symbol};
use crate::mechanics::Valuation;
use crate::num::rounded;

const ALLOWED: Level = 0;
const ENERGY: Level = 1;
const CURVE: Level = 2;
const NOW: Level = 3;

const POINTS: usize = 240;

/// Fraction of the dots drawn where the motion is allowed.
const SHADE: f64 = 0.12;

/// The margin beyond the turning points, as a fraction of the distance between them.
const BEYOND: f64 = 0.4;

/// Turning points are searched for at so many distances, the first of which is this part of what the motion has reached and
/// each of which is so many times the one before: up to some sixty times what it has reached. The interval with a turning
/// point is divided into parts, of which one has it, and so on.
const NEAREST: f64 = 1.0 / 64.0;
const RATIO: f64 = 1.09;
const TRIED: usize = 97;
const PARTS: usize = 16;
const ROUNDS: usize = 6;

pub(super) struct Potential;

/// The potential of a view of the file.
#[derive(Clone, Copy, Debug)]
pub struct PotentialView {
    /// The channel of the coordinate.
    pub x: usize,
    /// The channel of the potential.
    pub y: usize,
    coordinate: Symbol,
    expression: Expr,
}

impl PotentialView {
    /// The potential of a view of a system.
    pub fn of(physics: Physics<'_>, view: usize) -> Option<Self> {
        let Physics { model, system, .. } = physics;
        let view = model.views.get(view).filter(|view| view.kind == Potential.name())?;
        let [across, up] = [0, 1].map(|axis| Some(view.axes.get(axis)?.first()?.expression));
        Some(Self {
            x: system.channel_of(across?)?,
            y: system.channel_of(up?)?,
            coordinate: model.pool.as_symbol(across?)?,
            expression: up?,
        })
    }

    /// The potential at other values of the coordinate, with everything else at its current value.
    pub fn along(&self, pool: &Pool, now: &Valuation, places: &[f64]) -> Vec<f64> {
        let at = |symbol| steady(now.at(symbol));
        pool.evaluate_along(self.expression, (self.coordinate, places), &at)
    }
}

const PROPERTIES: Properties = Properties {
    name: "potential",
    written: &[Axis { coordinate: true, ..Axis::ACROSS }, Axis::UPWARDS],
    chosen: Some(&[]),
    shows_a_view: true,
    ..Properties::PLAIN
};

impl Instrument for Potential {
    fn properties(&self) -> &'static Properties {
        &PROPERTIES
    }

    fn offers(&self, physics: Physics<'_>) -> Vec<Offer> {
        let views = physics.model.views.iter().enumerate();
        let offer = |(index, view): (usize, &crate::model::View)| {
            let [x, y] = [0, 1].map(|axis| view.axes.get(axis)?.first());
            Some(Offer {
                label: format!("potential over {}", x?.written),
                about: y?.written.clone(),
                columns: Vec::new(),
                view: Some(index),
                over: Vec::new(),
            })
        };
        views.filter(|(_, view)| view.kind == self.name()).filter_map(offer).collect()
    }

    fn words(&self, _plot: &Plot, _physics: Physics<'_>) -> String {
        "potential".to_owned()
    }

    fn heading(&self, plot: &Plot, present: &Present<'_>) -> Option<Heading> {
        let along = PotentialView::of(present.physics, plot.view?)?;
        let title = present.physics.model.views.get(plot.view?).map_or("", |view| &view.title);
        let energy = present.valuation().at(present.physics.model.symbols.energy);
        Some(Heading {
            title: if title.is_empty() { "Potential" } else { title }.to_owned(),
            given: !title.is_empty(),
            entries: vec![
                Entry::Channel(along.x),
                Entry::Channel(along.y),
                Entry::Number("E".to_owned(), energy),
            ],
        })
    }

    fn across(&self, PlotContext { plot, present, .. }: PlotContext<'_>) -> Across {
        let along = plot.view.and_then(|view| PotentialView::of(present.physics, view));
        along
            .map_or(Across::Nothing, |along| Across::Channel(along.x, Some(range(present, &along))))
    }

    fn picture(
        &self,
        PlotContext { plot, present, .. }: PlotContext<'_>,
        [from, to]: [f64; 2],
    ) -> Option<Picture> {
        let along = PotentialView::of(present.physics, plot.view?)?;
        let (model, now) = (present.physics.model, present.valuation());
        let energy = steady(now.at(model.symbols.energy));
        let x = |i: usize| from + (to - from) * i as f64 / (POINTS - 1) as f64;
        let places: Vec<f64> = (0..POINTS).map(x).collect();
        let heights = along.along(&model.pool, &now, &places);
        let curve: Vec<[f64; 2]> = places.into_iter().zip(heights).map(<[f64; 2]>::from).collect();
        let now = [present.value(along.x), present.value(along.y)];
        let mut layers = Vec::new();
        let allowed = |pair: &&[[f64; 2]]| pair[0][1] <= energy && pair[1][1] <= energy;
        for pair in curve.windows(2).filter(allowed) {
            let stroke = Stroke { ink: Ink::Level, covering: Some(SHADE) };
            layers.push((ALLOWED, Layer::Line(vec![pair[0], [pair[0][0], energy]], stroke)));
        }
        let pairs: Vec<&[[f64; 2]]> = curve.windows(2).collect();
        for run in pairs.chunk_by(|a, b| allowed(a) == allowed(b)) {
            let (line, bright) =
                if allowed(&run[0]) { (Ink::Warn, Ink::Accent) } else { (Ink::Level, Ink::Plain) };
            let points = || run.iter().map(|pair| pair[0]).chain([run[run.len() - 1][1]]);
            // Point by point, since a line over an angle takes the shorter way between two of its points.
            let level = points().map(|[x, _]| [x, energy]).collect();
            layers.push((ENERGY, Layer::Line(level, line.into())));
            layers.push((CURVE, Layer::Line(points().collect(), bright.into())));
        }
        layers.push((NOW, Layer::Point([now[0], energy], MarkerShape::Ring, Ink::Warn)));
        layers.push((NOW, Layer::Point(now, MarkerShape::Disc, Ink::Accent)));
        let upwards = Upwards::Around(along.y, height(&curve, energy, now[1]));
        Some(Picture::Axes { upwards, layers, occurrences: None })
    }
}

/// A value without its last bits: where it is conserved they are rounding errors, and without them the curve is the one of
/// the frame before, bit by bit, and need not be drawn again.
fn steady(value: f64) -> f64 {
    const LOST: u64 = 1 << 14;
    if value.is_finite() {
        f64::from_bits((value.to_bits() + LOST / 2) & !(LOST - 1))
    } else {
        value
    }
}

/// The range of a coordinate: one period, or somewhat more than the motion has reached and will reach.
fn range(present: &Present<'_>, along: &PotentialView) -> [f64; 2] {
    if let Some(period) = present.physics.system.period(along.x, present.parameters) {
        return [-period / 2.0, period / 2.0];
    }
    let (lo, hi) = present.bounds.get(along.x).copied().unwrap_or((f64::NAN, f64::NAN));
    let [below, above] = turning_points(present, along, [lo, hi]);
    let (lo, hi) = (below.map_or(lo, |at| at.min(lo)), above.map_or(hi, |at| at.max(hi)));
    let reached = width(lo, hi);
    // A coordinate that has never changed its sign, such as a distance, is not shown beyond zero.
    let low = lo - BEYOND * reached;
    let low = if lo > 0.0 { low.max(0.05 * lo) } else { low };
    [low, hi + BEYOND * reached]
}

/// How far a motion between these values comes, which may have only begun.
fn width(lo: f64, hi: f64) -> f64 {
    (hi - lo).max(0.1 * lo.abs().max(hi.abs())).max(f64::MIN_POSITIVE)
}

/// The nearest places below and above the current one where the potential exceeds the energy, if there are any near what the
/// motion has reached.
fn turning_points(
    present: &Present<'_>,
    along: &PotentialView,
    [lo, hi]: [f64; 2],
) -> [Option<f64>; 2] {
    let (model, now) = (present.physics.model, present.valuation());
    let (energy, here) = (now.at(model.symbols.energy), present.value(along.x));
    // the end of the first of these intervals of the line from `from` whose end is beyond the energy, and its beginning
    let first = |from: f64, places: &[f64]| {
        let heights = along.along(&model.pool, &now, places);
        let beyond = heights.iter().position(|height| *height > energy)?;
        Some([beyond.checked_sub(1).map_or(from, |before| places[before]), places[beyond]])
    };
    let scale = width(lo, hi);
    [-1.0, 1.0].map(|side| {
        let distances = std::iter::successors(Some(NEAREST * scale), |far| Some(RATIO * far));
        let places = distances.take(TRIED).map(|far| here + side * far);
        // as above, a distance does not change its sign
        let places: Vec<f64> = places.filter(|at| lo <= 0.0 || *at > 0.0).collect();
        let mut between = first(here, &places)?;
        for _ in 0..ROUNDS {
            let [from, to] = between;
            let inner = (1..=PARTS).map(|k| from + (to - from) * k as f64 / PARTS as f64);
            between = first(from, &inner.collect::<Vec<_>>())?;
        }
        // to five digits, so that the picture is the same for a motion that returns with a rounding error
        Some(rounded(between[1], 5))
    })
}

/// From the bottom of the curve to well above the energy.
fn height(curve: &[[f64; 2]], energy: f64, now: f64) -> [f64; 2] {
    let finite = |v: &f64| v.is_finite();
    let values = curve.iter().map(|point| point[1]).filter(finite);
    let bottom = values.clone().fold(f64::INFINITY, f64::min).min(now).min(energy);
    let top = values.fold(f64::NEG_INFINITY, f64::max).max(energy);
    let deep = energy - bottom;
    let room = if deep > 1e-9 * energy.abs().max(bottom.abs()) { deep } else { top - bottom };
    [bottom - 0.1 * room, (energy + 0.6 * room).min(top.max(energy + 0.1 * room))]
}
