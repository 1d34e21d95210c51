//! `diagram`: what becomes of the motion over a range of one parameter: where it crosses a surface of section (a
//! bifurcation diagram), or, where no surface is given, its largest Lyapunov exponent.
//!
//! The job follows one motion from the initial values for each value of the parameter, the values spread evenly over
//! what is seen, ever more closely, so that the picture fills as one looks and a zoom refines it. The running motion is a
//! vertical line; a point of the picture stands for a value of the parameter.

use std::ops::ControlFlow;
use std::sync::Arc;

use super::section::zero;
use super::straight_line::StraightLine;
use super::varied::{self, VariedConditions, VariedMotions};
use super::{
    Across, Answer, Axis, Entry, Heading, Ink, Instrument, Layer, Level, Measure, Need, Offer,
    Physics, Picture, Plot, PlotTable, Present, Upwards,
};
use crate::ensemble::{Crossings, SectionPlan, Start, crossings_of_all, in_order, section_group};
use crate::expr::Expr;
use crate::job::{Job, Progress};
use crate::model::{Variation, View};
use crate::system::System;

/// The levels of the picture.
const NOW: Level = 0;
const POINTS: Level = 1;

/// The values of the parameter, and how many of them make one part of the work, after which the picture is drawn anew.
const MOST: usize = 256;
const PART: usize = 16;

/// The parts that are waited for where there is no background.
const AT_ONCE: usize = 2;

/// The crossings at each value, and those before them that are left out where friction draws all motions to an attractor.
const COUNT: usize = 80;
const TRANSIENT: usize = 160;

/// A motion ends after so many steps without a crossing.
const IDLE: u64 = 4000;

/// An exponent is followed over so many seconds of the wall clock at the file's own speed.
const SECONDS: f64 = 120.0;

/// Crossings closer than this part of the range of all count as one.
const SAME: f64 = 1e-3;

/// The row.
pub(super) struct Diagram;

/// What was computed, and under which conditions.
struct ComputedDiagram {
    conditions: VariedConditions,
    /// The numbers at each value of the parameter.
    columns: Vec<(f64, Vec<f64>)>,
    /// All of them as points.
    points: Arc<Vec<[f64; 2]>>,
    /// The range of the numbers.
    extent: [f64; 2],
    /// Why a motion could not be followed.
    refused: Option<String>,
}

impl Instrument for Diagram {
    fn name(&self) -> &'static str {
        "diagram"
    }

    fn written(&self) -> &'static [Axis] {
        &[Axis::UPWARDS]
    }

    fn chosen(&self) -> &'static [Axis] {
        &[]
    }

    fn is_section(&self) -> bool {
        true
    }

    fn is_over_a_parameter(&self) -> bool {
        true
    }

    fn takes_seeds(&self) -> bool {
        false
    }

    fn shows(&self, view: Option<&View>) -> bool {
        view.is_none_or(|view| view.section.is_some())
    }

    fn offers(&self, physics: Physics<'_>) -> Vec<Offer> {
        let views = physics.model.views.iter().enumerate();
        let offer = |(index, view): (usize, &View)| Offer {
            label: format!("diagram over {}", name(physics, &view.over)),
            about: "where the motion crosses a surface, over the range of a parameter".to_owned(),
            columns: Vec::new(),
            view: Some(index),
            over: Vec::new(),
        };
        views.filter(|(_, view)| view.kind == self.name()).map(offer).collect()
    }

    fn words(&self, plot: &Plot, physics: Physics<'_>) -> String {
        format!("{} over {}", quantity(plot, physics), name(physics, &plot.over))
    }

    fn heading(&self, plot: &Plot, present: &Present<'_>) -> Option<Heading> {
        let value = varied::now(present, *plot.over.first()?)?;
        let entry = Entry::Number(name(present.physics, &plot.over).to_owned(), value);
        Some(plot.heading(present.physics, "Diagram", vec![entry]))
    }

    fn across(&self, plot: &Plot, present: &Present<'_>, _answer: Option<&Answer>) -> Across {
        let over = plot.over.first();
        over.zip(varied::range(plot, present, 0)).map_or(Across::Nothing, |(&over, range)| {
            Across::Named(varied::with_unit(present.physics, over), range)
        })
    }

    fn picture(
        &self,
        plot: &Plot,
        present: &Present<'_>,
        _seen: [f64; 2],
        answer: Option<&Answer>,
    ) -> Option<Picture> {
        let found = computed(answer);
        let points = found.map(|found| Arc::clone(&found.points)).unwrap_or_default();
        let [low, high] = heights(plot, present, found);
        let now = varied::now(present, *plot.over.first()?)?;
        let reach = high - low;
        let line = vec![[now, low - reach], [now, high + reach]];
        let mut layers = vec![(NOW, Layer::Line(line, Ink::Level.into()))];
        if view(plot, present.physics).is_some() {
            layers.push((POINTS, Layer::Bands(points, 0)));
        } else {
            let mut curve = points.to_vec();
            curve.sort_by(|a, b| a[0].total_cmp(&b[0]));
            layers.push((POINTS, Layer::Line(curve, Ink::Curve(0).into())));
        }
        if let Some(line) = straight_line(plot, present.physics, found) {
            let [from, to] = varied::range(plot, present, 0)?;
            let ends = [from, to].map(|x| [x, line.at(x)]);
            layers.push((NOW, Layer::Line(ends.to_vec(), Ink::Curve(1).into())));
            layers.push((POINTS, Layer::Legend(vec![line.in_words()])));
        }
        if let Some(why) = found.and_then(|found| found.refused.as_ref()) {
            layers.push((POINTS, Layer::Legend(vec![why.clone()])));
        }
        let upwards = Upwards::Named(quantity(plot, present.physics), [low, high]);
        Some(Picture::Axes { upwards, layers, occurrences: None })
    }

    fn parameters_at(&self, plot: &Plot, at: [f64; 2]) -> Vec<(usize, f64)> {
        varied::parameters_at(plot, at)
    }

    fn job(&self, plot: &Plot, present: &Present<'_>, answer: Option<&Answer>) -> Need {
        let Some(motions) = VariedMotions::of(plot, present) else { return Need::Nothing };
        let known = computed(answer).filter(|known| known.conditions == motions.conditions);
        let columns = known.map_or_else(Vec::new, |known| known.columns.clone());
        if columns.len() >= MOST || known.is_some_and(|known| known.refused.is_some()) {
            return Need::Held;
        }
        let view = view(plot, present.physics);
        let task = DiagramTask {
            section: view.and_then(|view| view.section),
            channel: view
                .and_then(|view| motions.system.channel_of(view.axes.first()?.first()?.expression)),
            motions,
            columns,
        };
        let first = task.columns.len() < AT_ONCE * PART;
        let job = Job::new("diagram", move |progress| Answer::new(task.next_part(progress)));
        if first { Need::Job(job) } else { Need::Addition(job) }
    }

    fn table(
        &self,
        plot: &Plot,
        present: &Present<'_>,
        answer: Option<&Answer>,
    ) -> Option<PlotTable> {
        let mut rows: Vec<Vec<f64>> =
            computed(answer)?.points.iter().map(|at| at.to_vec()).collect();
        // the values were taken ever more closely; crossings stay in their order
        rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let over = varied::written(present.physics, *plot.over.first()?).to_owned();
        let columns = vec![over, quantity(plot, present.physics)];
        Some(PlotTable { columns, counts: 0, rows })
    }

    fn measures(&self) -> &'static [Measure] {
        &[
            Measure {
                word: "columns",
                about: "how many values of the parameter are there",
                value: |_, _, answer| Some(computed(answer)?.columns.len() as f64),
            },
            Measure {
                word: "branches",
                about: "how many different crossings there are at the value next to that of the running motion",
                value: |plot, present, answer| {
                    let found = computed(answer)?;
                    let now = varied::now(present, *plot.over.first()?)?;
                    let [low, high] = heights(plot, present, Some(found));
                    branches(&found.columns, now, SAME * (high - low))
                },
            },
            Measure {
                word: "slope",
                about: "the slope of the straight line of least squares, where the file asks for it",
                value: |plot, present, answer| {
                    Some(straight_line(plot, present.physics, computed(answer))?.slope)
                },
            },
            Measure {
                word: "value",
                about: "the last number at that value: a crossing, or the exponent",
                value: |plot, present, answer| {
                    let now = varied::now(present, *plot.over.first()?)?;
                    nearest(&computed(answer)?.columns, now)?.1.last().copied()
                },
            },
        ]
    }
}

/// What a job computes: the numbers at the next values of the parameter.
struct DiagramTask {
    motions: VariedMotions,
    section: Option<usize>,
    /// The quantity at the crossings.
    channel: Option<usize>,
    columns: Vec<(f64, Vec<f64>)>,
}

impl DiagramTask {
    fn next_part(&self, progress: &Progress) -> ComputedDiagram {
        let conditions = self.motions.conditions.clone();
        let system = self.motions.system.with_cancel(progress.token().clone());
        let mut columns = self.columns.clone();
        let first = columns.len();
        let [from, to] = conditions.window.first().copied().unwrap_or_default();
        let at = |i: usize| from + (to - from) * evenly(first + i);
        progress.expect(PART as u64);
        let mut refused = None;
        let places: Vec<f64> = (0..PART).map(at).collect();
        let groups: Vec<&[f64]> = places.chunks(self.group(&system)).collect();
        let group = |i: usize| self.numbers(&system, groups[i]);
        let mut done = 0;
        let take = |i: usize, found: Vec<Result<Vec<f64>, String>>| {
            done += found.len() as u64;
            progress.reach(done);
            for (&value, found) in groups[i].iter().zip(found) {
                // a value without a motion leaves a gap; the reason is shown where none has one
                let numbers = found.unwrap_or_else(|why| {
                    refused.get_or_insert(why);
                    Vec::new()
                });
                columns.push((value, numbers));
            }
            ControlFlow::Continue(())
        };
        let threads = in_order(0, groups.len(), progress.token(), group, take);
        if let Err(why) = threads {
            refused = Some(why.to_string());
        }
        let nothing = columns.iter().all(|(_, numbers)| numbers.is_empty());
        let refused = refused.filter(|_| nothing);
        let points: Vec<[f64; 2]> =
            columns.iter().flat_map(|(x, all)| all.iter().map(|y| [*x, *y])).collect();
        let finite = points.iter().map(|at| at[1]).filter(|y| y.is_finite());
        let extent = finite
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], y| [low.min(y), high.max(y)]);
        ComputedDiagram { conditions, columns, points: Arc::new(points), extent, refused }
    }

    /// How many motions one thread follows at a time.
    fn group(&self, system: &System) -> usize {
        let (method, settings) = self.motions.method;
        self.section.map_or(1, |_| section_group(system, method, settings))
    }

    /// The crossings of the motions at values of the parameter, or their largest exponents.
    fn numbers(&self, system: &System, values: &[f64]) -> Vec<Result<Vec<f64>, String>> {
        let VariedMotions { model, method: (method, settings), .. } = &self.motions;
        let starts: Vec<Start> = values.iter().map(|&x| self.motions.start(&[x])).collect();
        let (Some(section), Some(channel)) = (self.section, self.channel) else {
            let length = SECONDS * model.run.speed;
            let exponent =
                |start| Ok(self.motions.exponent(system, start, length)?.into_iter().collect());
            return starts.iter().map(exponent).collect();
        };
        let dissipates = model.mechanics.dissipation() != Expr::ZERO;
        let transient = if dissipates { TRANSIENT } else { 0 };
        let plan = SectionPlan {
            event: model.sections[section].name.clone(),
            count: Some((transient + COUNT) as u64),
            until: None,
            idle: IDLE,
            all_channels: true,
        };
        let numbers = |(found, period): (Crossings, Option<f64>)| {
            let rows = found.rows.iter().skip(transient);
            let numbers: Vec<f64> = rows
                .filter_map(|row| row.get(1 + channel).map(|&x| varied::within(x, period)))
                .collect();
            match found.message {
                Some(why) if numbers.is_empty() => Err(why),
                _ => Ok(numbers),
            }
        };
        let periods: Vec<Option<f64>> =
            starts.iter().map(|start| system.period(channel, &start.parameters)).collect();
        let starts = starts.into_iter().map(Ok).collect();
        let found = crossings_of_all(system, method, *settings, starts, &plan);
        found.into_iter().zip(periods).map(numbers).collect()
    }
}

/// The i-th of numbers that fill the interval from 0 to 1 ever more closely: the binary digits of i, mirrored at the
/// point (J. G. van der Corput, 1935).
fn evenly(i: usize) -> f64 {
    (i as u64).reverse_bits() as f64 / u64::MAX as f64
}

fn computed(answer: Option<&Answer>) -> Option<&ComputedDiagram> {
    answer?.of::<ComputedDiagram>()
}

/// The view of the file that has the surface.
fn view<'a>(plot: &Plot, physics: Physics<'a>) -> Option<&'a View> {
    physics.model.views.get(plot.view?).filter(|view| view.section.is_some())
}

/// The name of what it runs over.
fn name<'a>(physics: Physics<'a>, over: &[Variation]) -> &'a str {
    over.first().map_or("?", |&over| varied::named(physics, over).0)
}

/// What is drawn upwards.
fn quantity(plot: &Plot, physics: Physics<'_>) -> String {
    let Some(view) = view(plot, physics) else { return "largest exponent λ".to_owned() };
    let axis = |axis: usize| view.axes.get(axis).and_then(|axis| axis.first());
    let Some(written) = axis(0) else { return "?".to_owned() };
    let channel = physics.system.channel_of(written.expression);
    let shown = channel.map_or(written.written.as_str(), |channel| physics.shown(channel));
    format!("{shown} where {}", zero(physics, view))
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
    let own = found.map(|found| found.extent).filter(|[low, high]| low < high);
    // it shows the horizontal axis of a section
    let section = view(plot, present.physics).filter(|view| view.kind != plot.kind.name());
    let given = match section {
        Some(section) => varied::ends(section, present, 0),
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
