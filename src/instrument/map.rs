//! `map`: a number of the motion over a plane of two parameters, two initial values, or one of each: its largest Lyapunov
//! exponent, the time of its first crossing of a surface, or a quantity at its end.
//!
//! The job follows one motion for each place of a lattice, coarsely first and ever more finely, so that the picture sharpens
//! as one looks and a zoom refines it. The running motion is a point of the plane, and any other point begins a motion.

use std::ops::ControlFlow;
use std::sync::Arc;

use super::section::zero;
use super::varied::{self, VariedConditions, VariedMotions};
use super::{
    Across, Answer, Axis, Entry, Field, Heading, Ink, Instrument, Layer, Level, Measure, Need,
    NoStart, Offer, Physics, Picture, Plot, PlotTable, Present, Sign, Upwards,
};
use crate::ensemble::{SectionPlan, Start, SystemFlow, crossings, in_order};
use crate::job::{Job, Progress};
use crate::mechanics::Valuation;
use crate::model::{Variation, View};
use crate::num::significant;
use crate::system::{InitialOverride, System};

/// The levels of the picture.
const FIELD: Level = 0;
const NOW: Level = 2;

/// The places of the lattice, and how many of them make one part of the work, after which the picture is drawn anew.
const LATTICE: [usize; 2] = [128, 64];
const PART: usize = 64;

/// The distance of neighbours in the first pass, a power of two; each further pass halves it.
const COARSE: usize = 16;

/// The parts that are waited for where there is no background.
const AT_ONCE: usize = 2;

/// Motions are followed over so many seconds of the wall clock at the file's own speed, where it does not say how long.
const SECONDS: f64 = 60.0;

/// The part of the numbers that the ramp of shades spans: single ones may be far above.
const SHADED: f64 = 0.98;

/// The numbers of coordinates and of parameters of which all pairs are offered.
const OFFERED: usize = 3;

/// The row.
pub(super) struct Map;

/// What was computed, and under which conditions.
struct ComputedMap {
    conditions: VariedConditions,
    length: f64,
    /// The numbers at the places, in their order.
    values: Vec<f64>,
    field: Arc<Field>,
    /// Why a motion could not be followed, where none could.
    refused: Option<String>,
}

/// The number of a motion that is shown.
#[derive(Clone, Copy, PartialEq)]
enum MapNumber {
    /// Its largest Lyapunov exponent.
    Exponent,
    /// When it first crosses the surface of section of this index.
    FirstCrossing(usize),
    /// A channel at its end.
    AtTheEnd(usize),
}

impl Instrument for Map {
    fn name(&self) -> &'static str {
        "map"
    }

    fn written(&self) -> &'static [Axis] {
        const { &[Axis { varied: true, ..Axis::ACROSS }, Axis { varied: true, ..Axis::UPWARDS }] }
    }

    fn chosen(&self) -> &'static [Axis] {
        &[]
    }

    fn is_section(&self) -> bool {
        true
    }

    fn follows_motions(&self) -> bool {
        true
    }

    fn takes_seeds(&self) -> bool {
        false
    }

    fn shows(&self, view: Option<&View>) -> bool {
        view.is_none_or(|view| view.kind == self.name())
    }

    fn offers(&self, physics: Physics<'_>) -> Vec<Offer> {
        let offer = |over: Vec<Variation>, view: Option<usize>| {
            let about = match view.and_then(|view| physics.model.views.get(view)) {
                Some(view) if !view.title.is_empty() => view.title.clone(),
                _ => "the largest exponent of the motion at each place".to_owned(),
            };
            Offer {
                label: format!("map over {}", varied::names(physics, &over)),
                about,
                columns: Vec::new(),
                view,
                over,
            }
        };
        let views = physics.model.views.iter().enumerate();
        let of_file = views.filter(|(_, view)| view.kind == self.name());
        let mut all: Vec<Offer> =
            of_file.map(|(index, view)| offer(view.over.clone(), Some(index))).collect();
        let pairs = |first: usize, count: usize| {
            let last = first + count.min(OFFERED);
            (first..last).flat_map(move |i| (i + 1..last).map(move |j| [i, j]))
        };
        let degrees = physics.model.coordinates.len();
        if physics.model.constraints.is_empty() {
            let conjugate = (0..degrees.min(OFFERED))
                .map(|i| [i, degrees + i])
                .filter(|_| !physics.model.is_poisson());
            let initial = conjugate.chain(pairs(0, degrees));
            all.extend(initial.map(|two| offer(two.map(Variation::Initial).to_vec(), None)));
        }
        let parameters = pairs(0, physics.model.parameters.len());
        all.extend(parameters.map(|two| offer(two.map(Variation::Parameter).to_vec(), None)));
        all
    }

    fn words(&self, plot: &Plot, physics: Physics<'_>) -> String {
        format!("{} over {}", quantity(plot, physics), varied::names(physics, &plot.over))
    }

    fn heading(&self, plot: &Plot, present: &Present<'_>) -> Option<Heading> {
        let entries = vec![Entry::Words(quantity(plot, present.physics))];
        Some(plot.heading(present.physics, "Map", entries))
    }

    fn across(&self, plot: &Plot, present: &Present<'_>, _answer: Option<&Answer>) -> Across {
        let over = plot.over.first().copied().zip(varied::range(plot, present, 0));
        match over {
            None => Across::Nothing,
            Some((over, range)) => match varied::channel(present.physics, over) {
                Some(channel) => Across::Channel(channel, Some(range)),
                None => Across::Named(varied::with_unit(present.physics, over), range),
            },
        }
    }

    fn picture(
        &self,
        plot: &Plot,
        present: &Present<'_>,
        _seen: [f64; 2],
        answer: Option<&Answer>,
    ) -> Option<Picture> {
        let [x, y] = [0, 1].map(|axis| plot.over.get(axis).copied());
        let range = varied::range(plot, present, 1)?;
        let mut layers = Vec::new();
        let (mut lines, mut words) = (Vec::new(), String::new());
        match computed(answer) {
            None => lines.push("being computed".to_owned()),
            Some(ComputedMap { refused: Some(why), .. }) => lines.push(why.clone()),
            Some(found) => {
                layers.push((FIELD, Layer::Field(Arc::clone(&found.field))));
                let [low, high] = found.field.range.map(short);
                words = format!("  faint {low} … strong {high}");
            }
        }
        let upwards = match varied::channel(present.physics, y?) {
            Some(channel) => Upwards::Annotated { channel, range: Some(range), words },
            None => {
                let name = varied::with_unit(present.physics, y?);
                Upwards::Named(format!("{name}{words}"), range)
            }
        };
        let now = [varied::now(present, x?)?, varied::now(present, y?)?];
        layers.push((NOW, Layer::Point(now, Sign::Disc, Ink::Plain)));
        layers.push((NOW, Layer::Legend(lines)));
        Some(Picture::Axes { upwards, layers, occurrences: None })
    }

    fn start(
        &self,
        plot: &Plot,
        present: &Present<'_>,
        at: [f64; 2],
    ) -> Result<Vec<InitialOverride>, NoStart> {
        let system = present.physics.system;
        let initial = plot.over.iter().zip(at).filter_map(|(&over, x)| match over {
            Variation::Initial(index) => Some(system.initial_override(index, x)),
            Variation::Parameter(_) => None,
        });
        let initial: Vec<InitialOverride> = initial.collect();
        if initial.is_empty() { Err(NoStart::Nothing) } else { Ok(initial) }
    }

    fn parameters_at(&self, plot: &Plot, at: [f64; 2]) -> Vec<(usize, f64)> {
        varied::parameters_at(plot, at)
    }

    fn job(&self, plot: &Plot, present: &Present<'_>, answer: Option<&Answer>) -> Need {
        let motions = VariedMotions::of(plot, present);
        let Some(motions) = motions.filter(|motions| motions.conditions.window.len() == 2) else {
            return Need::Nothing;
        };
        let length = length(plot, present);
        let known = computed(answer)
            .filter(|known| known.conditions == motions.conditions && known.length == length);
        let values = known.map_or_else(Vec::new, |known| known.values.clone());
        let whole = values.len() >= LATTICE[0] * LATTICE[1];
        if whole || known.is_some_and(|known| known.refused.is_some()) {
            return Need::Held;
        }
        let task = Task { motions, number: number(plot, present.physics), length, values };
        let first = task.values.len() < AT_ONCE * PART;
        let job = Job::new("map", move |progress| Answer::new(task.next_part(progress)));
        if first { Need::Job(job) } else { Need::Addition(job) }
    }

    fn table(
        &self,
        plot: &Plot,
        present: &Present<'_>,
        answer: Option<&Answer>,
    ) -> Option<PlotTable> {
        let found = computed(answer)?;
        let named = |over: &Variation| varied::written(present.physics, *over).to_owned();
        let columns = plot.over.iter().map(named).chain([quantity(plot, present.physics)]);
        let mut rows: Vec<([usize; 2], Vec<f64>)> = places()
            .into_iter()
            .zip(&found.values)
            .map(|((place, _), &value)| {
                let [x, y] = coordinates(&found.conditions.window, place);
                (place, vec![x, y, value])
            })
            .collect();
        rows.sort_by_key(|(place, _)| *place);
        let rows = rows.into_iter().map(|(_, row)| row).collect();
        Some(PlotTable { columns: columns.collect(), rows })
    }

    fn measures(&self) -> &'static [Measure] {
        &[
            Measure {
                word: "places",
                about: "how many places are there",
                value: |_, _, answer| Some(computed(answer)?.values.len() as f64),
            },
            Measure {
                word: "value",
                about: "the number at the running motion",
                value: |plot, present, answer| {
                    let now = |axis: usize| varied::now(present, *plot.over.get(axis)?);
                    computed(answer)?.field.at([now(0)?, now(1)?])
                },
            },
            Measure {
                word: "greatest",
                about: "the greatest number",
                value: |_, _, answer| {
                    let finite = computed(answer)?.values.iter().filter(|x| x.is_finite());
                    finite.copied().reduce(f64::max)
                },
            },
        ]
    }
}

/// What a job computes: the numbers at the next places.
struct Task {
    motions: VariedMotions,
    number: MapNumber,
    length: f64,
    values: Vec<f64>,
}

impl Task {
    fn next_part(&self, progress: &Progress) -> ComputedMap {
        let system = self.motions.system.with_cancel(progress.token().clone());
        let mut values = self.values.clone();
        let places = places();
        let next = places.get(values.len()..).unwrap_or_default();
        let next = &next[..next.len().min(PART)];
        progress.expect(next.len() as u64);
        let mut refused = None;
        let one = |i: usize| self.value(&system, self.at(next[i].0));
        let take = |i: usize, found: Result<f64, String>| {
            progress.reach(i as u64 + 1);
            // a place without a motion is left blank; the reason is shown where none has one
            values.push(found.unwrap_or_else(|why| {
                refused.get_or_insert(why);
                f64::NAN
            }));
            ControlFlow::Continue(())
        };
        if let Err(why) = in_order(0, next.len(), progress.token(), one, take) {
            refused = Some(why.to_string());
        }
        let nothing = values.iter().all(|x| x.is_nan());
        let refused = refused.filter(|_| nothing);
        let (conditions, length) = (self.motions.conditions.clone(), self.length);
        let field = Arc::new(field(&conditions.window, &places, &values));
        ComputedMap { conditions, length, values, field, refused }
    }

    /// The numbers of a place.
    fn at(&self, place: [usize; 2]) -> [f64; 2] {
        coordinates(&self.motions.conditions.window, place)
    }

    /// The number of the motion that begins at a place.
    fn value(&self, system: &System, at: [f64; 2]) -> Result<f64, String> {
        let VariedMotions { model, method: (method, settings), .. } = &self.motions;
        let start = self.motions.start(&at);
        match self.number {
            MapNumber::Exponent => {
                let found = self.motions.exponent(system, &start, self.length)?;
                Ok(found.unwrap_or(f64::NAN))
            }
            MapNumber::FirstCrossing(section) => {
                let plan = SectionPlan {
                    event: model.sections[section].name.clone(),
                    count: Some(1),
                    until: Some(start.time + self.length),
                    idle: u64::MAX,
                    all_channels: false,
                };
                let found = crossings(system, method, *settings, &start, &plan);
                match (found.rows.first(), found.message) {
                    (Some(row), _) => Ok(row[0] - start.time),
                    (None, Some(why)) => Err(why),
                    (None, None) => Ok(f64::NAN),
                }
            }
            MapNumber::AtTheEnd(channel) => self.at_the_end(system, &start, channel),
        }
    }

    /// A channel at the end of a motion.
    fn at_the_end(&self, system: &System, start: &Start, channel: usize) -> Result<f64, String> {
        let state = start.state(system).map_err(|why| why.to_string())?;
        let flow = SystemFlow {
            system: system.clone(),
            method: self.motions.method,
            parameters: start.parameters.clone(),
            start: start.time,
            effort: None,
        };
        let carried = flow.carry(&state, &[start.time + self.length], &[channel]);
        let value = carried.seen.first().and_then(|row| row.first());
        let value = *value.ok_or("the motion cannot be followed to its end")?;
        Ok(varied::within(value, system.period(channel, &start.parameters)))
    }
}

/// The numbers of a place of a window.
fn coordinates(window: &[[f64; 2]], place: [usize; 2]) -> [f64; 2] {
    [0, 1].map(|axis| {
        let [from, to] = window[axis];
        from + (to - from) * (place[axis] as f64 + 0.5) / LATTICE[axis] as f64
    })
}

/// The places of the lattice in the order in which they are taken, each with the distance to its neighbours of the pass.
fn places() -> Vec<([usize; 2], usize)> {
    let mut all = Vec::new();
    let mut stride = COARSE;
    while stride > 0 {
        for j in (0..LATTICE[1]).step_by(stride) {
            for i in (0..LATTICE[0]).step_by(stride) {
                let before = stride < COARSE && i % (2 * stride) == 0 && j % (2 * stride) == 0;
                if !before {
                    all.push(([i, j], stride));
                }
            }
        }
        stride /= 2;
    }
    all
}

/// The numbers so far, each over the block that is its own until finer ones are there.
fn field(window: &[[f64; 2]], places: &[([usize; 2], usize)], values: &[f64]) -> Field {
    let [columns, rows] = LATTICE;
    let mut lattice = vec![f64::NAN; columns * rows];
    for (&([i, j], stride), &value) in places.iter().zip(values) {
        for row in j..(j + stride).min(rows) {
            lattice[row * columns..][i..(i + stride).min(columns)].fill(value);
        }
    }
    let mut finite: Vec<f64> = values.iter().copied().filter(|x| x.is_finite()).collect();
    finite.sort_by(f64::total_cmp);
    let (low, most) = (finite.first(), finite.last());
    let high = finite.get((SHADED * finite.len() as f64) as usize).filter(|&x| Some(x) > low);
    let range = [low, high.or(most)].map(|x| x.copied().unwrap_or(0.0));
    let window = [0, 1].map(|axis| window.get(axis).copied().unwrap_or_default());
    Field { window, columns, values: lattice, range }
}

fn computed(answer: Option<&Answer>) -> Option<&ComputedMap> {
    answer?.of::<ComputedMap>()
}

/// The view of the file.
fn view<'a>(plot: &Plot, physics: Physics<'a>) -> Option<&'a View> {
    physics.model.views.get(plot.view?)
}

/// What is shown of the motions.
fn number(plot: &Plot, physics: Physics<'_>) -> MapNumber {
    let Some(view) = view(plot, physics) else { return MapNumber::Exponent };
    if let Some(section) = view.section {
        return MapNumber::FirstCrossing(section);
    }
    let of = view.axes.get(2).and_then(|axis| axis.first());
    let channel = of.and_then(|of| physics.system.channel_of(of.expression));
    channel.map_or(MapNumber::Exponent, MapNumber::AtTheEnd)
}

/// The same in words.
fn quantity(plot: &Plot, physics: Physics<'_>) -> String {
    match (number(plot, physics), view(plot, physics)) {
        (MapNumber::FirstCrossing(_), Some(view)) => format!("time until {}", zero(physics, view)),
        (MapNumber::AtTheEnd(channel), _) => format!("{} at the end", physics.shown(channel)),
        _ => "largest exponent λ".to_owned(),
    }
}

/// How long motions are followed.
fn length(plot: &Plot, present: &Present<'_>) -> f64 {
    let model = present.physics.model;
    let until = view(plot, present.physics)
        .and_then(|view| view.until)
        .map(|until| Valuation::of_parameters(model, present.parameters).value(&model.pool, until));
    let until = until.map(|until| until - model.run.start).filter(|x| x.is_finite() && *x > 0.0);
    until.unwrap_or(SECONDS * model.run.speed.abs())
}

fn short(x: f64) -> String {
    significant(x, 3, 1e-3..1e5).replace('-', "−")
}
