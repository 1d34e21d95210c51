//! `map`: a number of the motion over a plane of two parameters, two initial values, or one of each: its largest Lyapunov
//! exponent, the time of its first crossing of a surface, or a quantity at its end.
//!
//! The job follows one motion for each place of a lattice, coarsely first and ever more finely, so that the picture sharpens
//! as one looks and a zoom refines it. The running motion is a point of the plane, and any other point begins a motion.

mod lattice;

use std::sync::Arc;

use lattice::{ComputedMap, LATTICE, MapNumber, MapTask, PART, coordinates, places};

use super::section::zero;
use super::varied::{self, VariedMotions};
use super::{
    Across, Answer, Axis, Entry, Heading, Ink, Instrument, Layer, Level, MarkerShape, Measure,
    Need, NoStart, Offer, Physics, Picture, Plot, PlotContext, PlotTable, Present, Properties,
    StartValues, Upwards,
};
use crate::job::Job;
use crate::mechanics::Valuation;
use crate::model::{Variation, View};
use crate::system::InitialOverride;

const FIELD: Level = 0;
const NOW: Level = 2;

/// The parts that are waited for where there is no background.
const AT_ONCE: usize = 2;

/// Motions are followed over so many seconds of the wall clock at the file's own speed, where it does not say how long.
const SECONDS: f64 = 60.0;

/// The numbers of coordinates and of parameters of which all pairs are offered.
const OFFERED: usize = 3;

pub(super) struct Map;

const PROPERTIES: Properties = Properties {
    name: "map",
    written: &[Axis { varied: true, ..Axis::ACROSS }, Axis { varied: true, ..Axis::UPWARDS }],
    chosen: Some(&[]),
    is_section: true,
    follows_motions: true,
    shows_a_view: true,
    measures: &[
        Measure::new("places", "how many places are there", |context| {
            Some(computed(context.answer)?.values.len() as f64)
        }),
        Measure::new(
            "value",
            "the number at the running motion",
            |PlotContext { plot, present, answer }| {
                let now = |axis: usize| varied::now(present, *plot.over.get(axis)?);
                computed(answer)?.field.at([now(0)?, now(1)?])
            },
        ),
        Measure::new("greatest", "the greatest number", |context| {
            let finite = computed(context.answer)?.values.iter().filter(|x| x.is_finite());
            finite.copied().reduce(f64::max)
        }),
    ],
    ..Properties::PLAIN
};

impl Instrument for Map {
    fn properties(&self) -> &'static Properties {
        &PROPERTIES
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

    fn across(&self, PlotContext { plot, present, .. }: PlotContext<'_>) -> Across {
        let over = plot.over.first().copied().zip(varied::range(plot, present, 0));
        match over {
            None => Across::Nothing,
            Some((over, range)) => match varied::channel(present.physics, over) {
                Some(channel) => Across::Channel(channel, Some(range)),
                None => Across::Named(varied::with_unit(present.physics, over), range),
            },
        }
    }

    fn picture(&self, context: PlotContext<'_>, _seen: [f64; 2]) -> Option<Picture> {
        let PlotContext { plot, present, answer } = context;
        let [x, y] = [0, 1].map(|axis| plot.over.get(axis).copied());
        let range = varied::range(plot, present, 1)?;
        let mut layers = Vec::new();
        let mut lines = Vec::new();
        match computed(answer) {
            None => lines.push("being computed".to_owned()),
            Some(ComputedMap { refused: Some(why), .. }) => lines.push(why.clone()),
            Some(found) => {
                layers.push((FIELD, Layer::Field(Arc::clone(&found.field))));
            }
        }
        let upwards = match varied::channel(present.physics, y?) {
            Some(channel) => Upwards::Channel(channel, Some(range)),
            None => Upwards::Named(varied::with_unit(present.physics, y?), range),
        };
        let now = [varied::now(present, x?)?, varied::now(present, y?)?];
        layers.push((NOW, Layer::Point(now, MarkerShape::Disc, Ink::Plain)));
        layers.push((NOW, Layer::Legend(lines)));
        Some(Picture::Axes { upwards, layers, occurrences: None })
    }

    fn start(&self, context: PlotContext<'_>, at: [f64; 2]) -> StartValues {
        let PlotContext { plot, present, .. } = context;
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

    fn job(&self, PlotContext { plot, present, answer }: PlotContext<'_>) -> Need {
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
            return Need::Valid;
        }
        let task = MapTask { motions, number: number(plot, present.physics), length, values };
        let first = task.values.len() < AT_ONCE * PART;
        let job = Job::new("map", move |progress| Answer::new(task.next_part(progress)));
        if first { Need::Job(job) } else { Need::Addition(job) }
    }

    fn table(&self, PlotContext { plot, present, answer }: PlotContext<'_>) -> Option<PlotTable> {
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
        Some(PlotTable { columns: columns.collect(), counts: 0, rows })
    }
}

fn computed(answer: Option<&Answer>) -> Option<&ComputedMap> {
    answer?.of::<ComputedMap>()
}

fn view<'a>(plot: &Plot, physics: Physics<'a>) -> Option<&'a View> {
    physics.model.views.get(plot.view?)
}

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
