//! `diagram`, `frequency`, `period`: what becomes of the motion over a range of one parameter or initial value: where it crosses
//! a surface of section (a bifurcation diagram), or, where no surface is given, its largest Lyapunov exponent; its frequency; its
//! period.
//!
//! The job follows one motion for each value of the parameter, the values spread evenly over what is seen, ever more closely, so
//! that the picture fills as one looks and a zoom refines it. The running motion is a vertical line; a point of the picture
//! stands for a value of the parameter.

mod task;

use std::borrow::Cow;
use std::sync::Arc;

pub(super) use task::DiagramQuantity;
use task::{ComputedDiagram, DiagramTask, MOST, PART};

use super::section::zero;
use super::straight_line::StraightLine;
use super::varied::{self, VariedMotions};
use super::{
    Across, Answer, Axis, Entry, Heading, Ink, Instrument, Layer, Level, Measure, Need, NoStart,
    Offer, Physics, Picture, Plot, PlotContext, PlotTable, Present, Properties, StartValues,
    Upwards,
};
use crate::job::Job;
use crate::model::{Variation, View};

const NOW: Level = 0;
const POINTS: Level = 1;
const FITTED: Level = 2;

/// The parts that are waited for where there is no background.
const AT_ONCE: usize = 2;

/// Crossings closer than this part of the range of all count as one.
const SAME: f64 = 1e-3;

/// Numbers that differ by less than this part of them are drawn as one.
const LEVEL: f64 = 1e-6;

pub(super) struct Diagram(pub(super) DiagramQuantity);

const CROSSINGS: Properties = Properties {
    name: "diagram",
    other: Some(&Diagram(DiagramQuantity::Frequency)),
    written: &[Axis::UPWARDS],
    chosen: Some(&[]),
    is_section: true,
    is_over_a_parameter: true,
    shows_a_view: true,
    measures: &[
        Measure::new(
            "columns",
            "how many values of the parameter are there",
            |PlotContext { plot, answer, .. }| Some(computed(plot, answer)?.columns.len() as f64),
        ),
        Measure::new(
            "branches",
            "how many different crossings there are at the value next to that of the running motion",
            |PlotContext { plot, present, answer }| {
                let found = computed(plot, answer)?;
                let now = varied::now(present, *plot.over.first()?)?;
                let [low, high] = heights(plot, present, Some(found));
                branches(&found.columns, now, SAME * (high - low))
            },
        ),
        Measure::new(
            "slope",
            "the slope of the straight line of least squares, where the file asks for it",
            |PlotContext { plot, present, answer }| {
                Some(straight_line(plot, present.physics, computed(plot, answer))?.slope)
            },
        ),
        Measure::new(
            "value",
            "the last number at that value: a crossing, or the exponent",
            |PlotContext { plot, present, answer }| {
                let now = varied::now(present, *plot.over.first()?)?;
                nearest(&computed(plot, answer)?.columns, now)?.1.last().copied()
            },
        ),
    ],
    ..Properties::PLAIN
};

const FREQUENCY: Properties = Properties {
    name: "frequency",
    other: Some(&Diagram(DiagramQuantity::Period)),
    written: &[],
    is_section: false,
    ..CROSSINGS
};

const PERIOD: Properties =
    Properties { name: "period", other: Some(&Diagram(DiagramQuantity::Crossings)), ..FREQUENCY };

impl Instrument for Diagram {
    fn properties(&self) -> &'static Properties {
        match self.0 {
            DiagramQuantity::Crossings => &CROSSINGS,
            DiagramQuantity::Frequency => &FREQUENCY,
            DiagramQuantity::Period => &PERIOD,
        }
    }

    fn shows(&self, view: Option<&View>) -> bool {
        view.is_none_or(|view| view.section.is_some() || view.kind == self.name())
    }

    fn offers(&self, physics: Physics<'_>) -> Vec<Offer> {
        let (noun, about) = match self.0 {
            DiagramQuantity::Crossings => {
                ("diagram", "where the motion crosses a surface, over the range of a parameter")
            }
            DiagramQuantity::Frequency => {
                ("frequency", "the frequency of the motion, over a range")
            }
            DiagramQuantity::Period => ("period", "the period of the motion, over a range"),
        };
        let offer = |over: &[Variation], view: Option<usize>| Offer {
            label: format!("{noun} over {}", name(physics, over)),
            about: about.to_owned(),
            columns: Vec::new(),
            view,
            over: over.to_vec(),
        };
        let views = physics.model.views.iter().enumerate();
        let of_file = views.filter(|(_, view)| view.kind == self.name());
        let mut all: Vec<Offer> =
            of_file.map(|(index, view)| offer(&view.over, Some(index))).collect();
        let is_offered = match self.0 {
            DiagramQuantity::Crossings => false,
            DiagramQuantity::Frequency => true,
            // with more degrees of freedom few motions have one
            DiagramQuantity::Period => physics.system.degrees() == 1,
        };
        if is_offered && !physics.model.is_poisson() {
            all.extend(varied::offered(physics).map(|over| offer(&[over], None)));
        }
        all
    }

    fn words(&self, plot: &Plot, physics: Physics<'_>) -> String {
        format!("{} over {}", self.quantity(plot, physics), name(physics, &plot.over))
    }

    fn heading(&self, plot: &Plot, present: &Present<'_>) -> Option<Heading> {
        let value = varied::now(present, *plot.over.first()?)?;
        let title = match self.0 {
            DiagramQuantity::Crossings => "Diagram",
            DiagramQuantity::Frequency => "Frequency",
            DiagramQuantity::Period => "Period",
        };
        let entry = Entry::Number(name(present.physics, &plot.over).to_owned(), value);
        Some(plot.heading(present.physics, title, vec![entry]))
    }

    fn across(&self, PlotContext { plot, present, .. }: PlotContext<'_>) -> Across {
        let over = plot.over.first();
        over.zip(varied::range(plot, present, 0)).map_or(Across::Nothing, |(&over, range)| {
            Across::Named(varied::with_unit(present.physics, over), range)
        })
    }

    fn picture(&self, context: PlotContext<'_>, _seen: [f64; 2]) -> Option<Picture> {
        let PlotContext { plot, present, answer } = context;
        let found = computed(plot, answer);
        let points = found.map(|found| Arc::clone(&found.points)).unwrap_or_default();
        let [low, high] = heights(plot, present, found);
        let now = varied::now(present, *plot.over.first()?)?;
        let reach = high - low;
        let line = vec![[now, low - reach], [now, high + reach]];
        let mut layers = vec![(NOW, Layer::Line(line, Ink::Level.into()))];
        if view(plot, present.physics).is_some() {
            layers.push((POINTS, Layer::Bands(points, 0)));
        } else {
            let curves = found.map_or_else(Vec::new, curves).into_iter();
            layers.extend(curves.map(|curve| (POINTS, Layer::Line(curve, Ink::Curve(0).into()))));
        }
        if let Some(line) = straight_line(plot, present.physics, found) {
            let [from, to] = varied::range(plot, present, 0)?;
            let ends = [from, to].map(|x| [x, line.at(x)]);
            layers.push((FITTED, Layer::Line(ends.to_vec(), Ink::Plain.into())));
            layers.push((POINTS, Layer::Legend(vec![line.in_words()])));
        }
        if let Some(why) = found.and_then(|found| found.refused.as_ref()) {
            layers.push((POINTS, Layer::Legend(vec![why.clone()])));
        }
        let upwards = Upwards::Named(self.quantity(plot, present.physics), [low, high]);
        Some(Picture::Axes { upwards, layers, occurrences: None })
    }

    fn start(&self, context: PlotContext<'_>, at: [f64; 2]) -> StartValues {
        let PlotContext { plot, present, .. } = context;
        match plot.over.first() {
            Some(&Variation::Initial(index)) => {
                Ok(vec![present.physics.system.initial_override(index, at[0])])
            }
            _ => Err(NoStart::Nothing),
        }
    }

    fn parameters_at(&self, plot: &Plot, at: [f64; 2]) -> Vec<(usize, f64)> {
        varied::parameters_at(plot, at)
    }

    fn job(&self, PlotContext { plot, present, answer }: PlotContext<'_>) -> Need {
        let Some(motions) = VariedMotions::of(plot, present) else { return Need::Nothing };
        let known = computed(plot, answer).filter(|known| known.conditions == motions.conditions);
        let columns = known.map_or_else(Vec::new, |known| known.columns.clone());
        if columns.len() >= MOST || known.is_some_and(|known| known.refused.is_some()) {
            return Need::Valid;
        }
        let view = view(plot, present.physics);
        let task = DiagramTask {
            number: self.0,
            section: view.and_then(|view| view.section),
            channel: view.and_then(|view| {
                let axis = drawn_axis(plot, present.physics, view);
                motions.system.channel_of(view.axes.get(axis)?.first()?.expression)
            }),
            motions,
            columns,
        };
        let first = task.columns.len() < AT_ONCE * PART;
        let job = Job::new("diagram", move |progress| Answer::new(task.next_part(progress)));
        if first { Need::Job(job) } else { Need::Addition(job) }
    }

    fn table(&self, PlotContext { plot, present, answer }: PlotContext<'_>) -> Option<PlotTable> {
        let mut rows: Vec<Vec<f64>> =
            computed(plot, answer)?.points.iter().map(|at| at.to_vec()).collect();
        // the values were taken ever more closely; crossings stay in their order
        rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let over = varied::written(present.physics, *plot.over.first()?).to_owned();
        let columns = vec![over, self.quantity(plot, present.physics)];
        Some(PlotTable { columns, counts: 0, rows })
    }
}

fn computed<'a>(plot: &Plot, answer: Option<&'a Answer>) -> Option<&'a ComputedDiagram> {
    let found = answer?.of::<ComputedDiagram>();
    found.filter(|found| Diagram(found.number).name() == plot.kind.name())
}

/// The view of the file that has the surface, if crossings are shown.
fn view<'a>(plot: &Plot, physics: Physics<'a>) -> Option<&'a View> {
    let view = physics.model.views.get(plot.view?)?;
    Some(view).filter(|view| view.section.is_some() && plot.kind.properties().is_section)
}

/// The curves through the numbers, each up to a value that has none.
fn curves(found: &ComputedDiagram) -> Vec<Vec<[f64; 2]>> {
    let mut columns: Vec<_> = found.columns.iter().collect();
    columns.sort_by(|a, b| a.0.total_cmp(&b.0));
    let pieces = columns.split(|(_, numbers)| numbers.is_empty());
    let points = |piece: &[&(f64, Vec<f64>)]| {
        piece.iter().flat_map(|(x, all)| all.iter().map(|y| [*x, *y])).collect()
    };
    pieces.filter(|piece| !piece.is_empty()).map(points).collect()
}

fn name<'a>(physics: Physics<'a>, over: &[Variation]) -> &'a str {
    over.first().map_or("?", |&over| varied::named(physics, over).0)
}

impl Diagram {
    /// What is drawn upwards.
    fn quantity(&self, plot: &Plot, physics: Physics<'_>) -> String {
        let first = physics.model.coordinates.first().map_or("?", |q| q.shown.as_str());
        let unit = |unit: String| if unit.is_empty() { unit } else { format!(" [{unit}]") };
        let time = physics.model.time_unit();
        let rate = if time.is_empty() { String::new() } else { format!("rad/{time}") };
        match self.0 {
            DiagramQuantity::Crossings => crossing(plot, physics),
            DiagramQuantity::Frequency => format!("frequency ω of {first}{}", unit(rate)),
            DiagramQuantity::Period => format!("period 2π/ω of {first}{}", unit(time.to_owned())),
        }
    }
}

/// What is drawn upwards where the motions cross a surface, or where there is none.
fn crossing(plot: &Plot, physics: Physics<'_>) -> String {
    let Some(view) = view(plot, physics) else { return "largest exponent λ".to_owned() };
    let axis = view.axes.get(drawn_axis(plot, physics, view));
    let Some(written) = axis.and_then(|axis| axis.first()) else { return "?".to_owned() };
    let channel = physics.system.channel_of(written.expression);
    let shown = channel.map_or(written.written.as_str(), |channel| physics.shown(channel));
    format!("{} where {}", binary_logarithm(shown), zero(physics, view))
}

/// The axis of a view whose quantity is drawn upwards: the horizontal one of a section, or the vertical one where the horizontal
/// one is an angle, of which crossings may fill all values whatever the parameter.
fn drawn_axis(plot: &Plot, physics: Physics<'_>, view: &View) -> usize {
    let across = view.axes.first().and_then(|axis| axis.first());
    let channel = across.and_then(|across| physics.system.channel_of(across.expression));
    let is_angle = channel.is_some_and(|channel| physics.system.channels()[channel].periodic);
    usize::from(is_angle && view.kind != plot.kind.name())
}

/// A quantity as it is written, a logarithm over ln 2 as one to that base: `ln(x)/ln(2)` → `log₂ x`.
fn binary_logarithm(written: &str) -> Cow<'_, str> {
    let argument = written.strip_prefix("ln(").and_then(|rest| rest.strip_suffix(")/ln(2)"));
    match argument {
        Some(name) if name.chars().all(|c| c.is_alphanumeric() || c == '_') => {
            Cow::Owned(format!("log₂ {name}"))
        }
        _ => Cow::Borrowed(written),
    }
}

/// The straight line of least squares through the points, where the file asks for it.
fn straight_line(
    plot: &Plot,
    physics: Physics<'_>,
    found: Option<&ComputedDiagram>,
) -> Option<StraightLine> {
    physics.model.views.get(plot.view?).filter(|view| view.slope)?;
    StraightLine::through(&found?.points)
}

/// The range upwards: the file's, or that of the numbers.
fn heights(plot: &Plot, present: &Present<'_>, found: Option<&ComputedDiagram>) -> [f64; 2] {
    let own = found.map(|found| found.extent).filter(|[low, high]| low <= high);
    // numbers that differ by rounding are one
    let own = own.map(|[low, high]| {
        let about = if view(plot, present.physics).is_some() || high - low > LEVEL * high.abs() {
            0.0
        } else {
            0.1 * high.abs()
        };
        [low - about, high + about]
    });
    let own = own.filter(|[low, high]| low < high);
    let section = view(plot, present.physics).filter(|view| view.kind != plot.kind.name());
    let given = match section {
        Some(section) => varied::ends(section, present, drawn_axis(plot, present.physics, section)),
        None => varied::given(plot, present, 1),
    };
    given.or(own).unwrap_or([0.0, 1.0])
}

/// The numbers at the value of the parameter next to this one.
fn nearest(columns: &[(f64, Vec<f64>)], now: f64) -> Option<&(f64, Vec<f64>)> {
    columns.iter().min_by(|a, b| (a.0 - now).abs().total_cmp(&(b.0 - now).abs()))
}

/// How many of them differ by more than a bound.
fn branches(columns: &[(f64, Vec<f64>)], now: f64, bound: f64) -> Option<f64> {
    let mut numbers = nearest(columns, now)?.1.clone();
    numbers.sort_by(f64::total_cmp);
    let jumps = numbers.windows(2).filter(|pair| pair[1] - pair[0] > bound).count();
    (!numbers.is_empty()).then_some(jumps as f64 + 1.0)
}
