//! `phase`: one quantity against another with a fading trail and, for one degree of freedom, the level curves of the
//! energy.
//!
//! The level curves are its job. They are recomputed only if a parameter has changed or the motion has left the
//! window.

use std::sync::Arc;

use super::equilibria::marks;
use super::field_plane::{NULLCLINES, nullcline_names};
use super::{
    Across, Answer, Axis, Columns, Entry, Heading, Ink, Instrument, Layer, Level, MarkerShape,
    Measure, MotionCurve, Need, NoStart, Offer, Physics, Picture, PlaneField, Plot, PlotContext,
    Present, Properties, StartValues, Upwards, value_at,
};
use crate::analysis::{Landscape, Plane};
use crate::dynamics::Equilibrium;
use crate::job::Job;
use crate::system::{ChannelKind, Form, InitialOverride, System};

/// The levels of the picture; separatrices lie between those of the level curves and of the nullclines.
const FIELD: Level = 0;
const LEVELS: Level = 1;
const NULLCLINE: Level = 3;
const TRAIL: Level = 4;
const MARK: Level = 5;
const NOW: Level = 6;

/// One in so many levels is drawn beside a vector field.
const FEWER_LEVELS: usize = 4;

pub(super) struct Phase;

/// A landscape and the conditions it was computed for.
struct Survey {
    /// `None` if there are no level curves to draw.
    landscape: Option<Arc<Landscape>>,
    parameters: Vec<f64>,
    motion: [[f64; 2]; 2],
    periodic: bool,
}

const PROPERTIES: Properties = Properties {
    name: "phase",
    written: &[Axis::ACROSS, Axis::UPWARDS],
    curve: Some(MotionCurve::Portrait),
    has_vector_field: true,
    has_equal_axes: true,
    lead: "phase plane, ",
    measures: &[
        Measure::new(
            "equilibria",
            "how many equilibria are marked on it",
            |PlotContext { plot, present, .. }| Some(marked(plot, present).count() as f64),
        ),
        Measure::new(
            "stable",
            "how many of them are stable",
            |PlotContext { plot, present, .. }| {
                let stable = marked(plot, present).filter(|stable| *stable == Some(true));
                Some(stable.count() as f64)
            },
        ),
        Measure::new("saddles", "how many saddles the energy has in the window", |context| {
            landscape(context.answer).map(|l| l.saddles.len() as f64)
        }),
        Measure::new("separatrices", "how many curves separate kinds of motion there", |context| {
            landscape(context.answer).map(|l| l.separatrices.len() as f64)
        }),
    ],
    ..Properties::PLAIN
};

impl Instrument for Phase {
    fn properties(&self) -> &'static Properties {
        &PROPERTIES
    }

    fn opening(&self, physics: Physics<'_>) -> Vec<Columns> {
        let pair = |(i, x)| Some(vec![vec![x], vec![physics.channel(ChannelKind::Momentum(i))?]]);
        physics.positions().filter_map(pair).collect()
    }

    fn offers(&self, physics: Physics<'_>) -> Vec<Offer> {
        let offer = |(index, channel): (usize, &crate::system::Channel)| {
            let unit = match channel.unit.as_str() {
                "" => String::new(),
                unit => format!(" [{unit}]"),
            };
            Offer::new(channel.shown.clone(), format!("{}{unit}", channel.name), vec![vec![index]])
        };
        physics.named().map(offer).collect()
    }

    fn words(&self, plot: &Plot, physics: Physics<'_>) -> String {
        plot.against(physics)
    }

    fn heading(&self, plot: &Plot, present: &Present<'_>) -> Option<Heading> {
        let otherwise = if plot.is_plane(present.physics) { "Plane" } else { "Phase" };
        let names = Some(plot).filter(|plot| plot.shows_field());
        let names = names.and_then(|plot| nullcline_names(plot, present.physics));
        let nullclines = names.into_iter().flat_map(|names| NULLCLINES.into_iter().zip(names));
        let entries = [Entry::Channel(plot.column(0)?), Entry::Channel(plot.column(1)?)]
            .into_iter()
            .chain(nullclines.map(|(index, name)| Entry::Line(index, name)))
            .chain([Entry::Occurrences])
            .collect();
        Some(plot.heading(present.physics, otherwise, entries))
    }

    fn across(&self, context: PlotContext<'_>) -> Across {
        context
            .plot
            .column(0)
            .map_or(Across::Nothing, |x| Across::Channel(x, window(context, (0, x))))
    }

    fn picture(&self, context: PlotContext<'_>, _seen: [f64; 2]) -> Option<Picture> {
        let PlotContext { plot, present, answer } = context;
        let [x, y] = [plot.column(0)?, plot.column(1)?];
        let landscape = landscape(answer);
        // a field needs room between them
        let every = if plot.shows_field() { FEWER_LEVELS } else { 1 };
        let levels = landscape.map(|l| (LEVELS, Layer::Landscape(Arc::clone(l), every)));
        let now = Layer::Point([x, y].map(|k| present.value(k)), MarkerShape::Disc, Ink::Accent);
        let equilibria = marks(present, MARK, |one| {
            let at = |channel| value_at(present.physics, one, channel);
            Some([at(x)?, at(y)?])
        });
        let field = plot.shows_field().then(|| PlaneField::of(context).ok()).flatten();
        let field = field.map(Arc::new);
        let nullclines = field.clone().map(|field| Layer::Nullclines(field, NULLCLINES));
        let strokes = field.map(|field| (FIELD, Layer::VectorField(field)));
        let levels = strokes.into_iter().chain(levels);
        let layers = levels.chain(nullclines.map(|layer| (NULLCLINE, layer))).chain([
            (TRAIL, Layer::Companions([x, y])),
            (TRAIL, Layer::Trail([x, y])),
            (NOW, now),
        ]);
        let layers = layers.chain(equilibria);
        Some(Picture::Axes {
            upwards: Upwards::Channel(y, window(context, (1, y))),
            layers: layers.collect(),
            occurrences: Some((MARK, [Some(x), Some(y)])),
        })
    }

    /// A point represents initial values if both axes belong to the state and are not the same.
    fn start(&self, context: PlotContext<'_>, at: [f64; 2]) -> StartValues {
        initial_values(context.plot, context.present.physics, at).ok_or(NoStart::Nothing)
    }

    fn job(&self, PlotContext { plot, present, answer }: PlotContext<'_>) -> Need {
        let Physics { model, equations, system } = present.physics;
        let Some((form, channels)) = plane(system, plot) else { return Need::Nothing };
        let bounds = channels.map(|channel| present.bounds.get(channel).map(|(lo, hi)| [*lo, *hi]));
        let [Some(x), Some(y)] = bounds else { return Need::Nothing };
        let motion = [x, y];
        if let Some(survey) = answer.and_then(Answer::of::<Survey>)
            && survey.still_holds(present.parameters, motion)
        {
            return Need::Valid;
        }
        // With more degrees of freedom the plane is only a projection of phase space; with explicit time its curves
        // would move.
        if system.degrees() != 1 || equations.pool.depends(equations.energy, model.symbols.time) {
            return Need::Nothing;
        }
        let (system, parameters, time) =
            (Arc::clone(system), present.parameters.to_vec(), present.time);
        let period = system.period(channels[0], &parameters);
        let at = channels.map(|channel| present.value(channel));
        Need::Job(Job::new("level curves of the energy", move |_| {
            let parameters = &parameters;
            let plane = Plane { system: &system, parameters, time, form, period };
            Answer::new(Survey {
                landscape: Landscape::survey(&plane, motion, at).map(Arc::new),
                parameters: parameters.clone(),
                motion,
                periodic: period.is_some(),
            })
        }))
    }
}

/// The equilibria that have a place on a plot: whether each is stable.
fn marked(plot: &Plot, present: &Present<'_>) -> impl Iterator<Item = Option<bool>> {
    let columns = [plot.column(0), plot.column(1)];
    let physics = present.physics;
    let there = move |one: &&Equilibrium| {
        columns.iter().all(|c| c.is_some_and(|c| value_at(physics, one, c).is_some()))
    };
    present.equilibria.iter().filter(there).map(|one| one.stable)
}

fn landscape(answer: Option<&Answer>) -> Option<&Arc<Landscape>> {
    answer?.of::<Survey>()?.landscape.as_ref()
}

/// The range of an axis that has level curves: their window and, until they are computed for a larger one, whatever the
/// motion has reached beyond it. A periodic coordinate wraps, so its window stays.
fn window(
    PlotContext { present, answer, .. }: PlotContext<'_>,
    (axis, channel): (usize, usize),
) -> Option<[f64; 2]> {
    let survey = answer?.of::<Survey>()?;
    let [from, to] = survey.landscape.as_ref()?.window[axis];
    let (lo, hi) = present.bounds.get(channel).copied().unwrap_or((from, to));
    let wraps = axis == 0 && survey.periodic;
    Some(if wraps { [from, to] } else { [from.min(lo), to.max(hi)] })
}

/// The form of the phase plane that a plot shows, and its channels.
fn plane(system: &System, plot: &Plot) -> Option<(Form, [usize; 2])> {
    let channels = [plot.column(0)?, plot.column(1)?];
    let [x, y] = channels.map(|channel| system.channels().get(channel).map(|c| c.kind));
    match (x?, y?) {
        (ChannelKind::Position(0), ChannelKind::Velocity(0)) => Some((Form::Velocity, channels)),
        (ChannelKind::Position(0), ChannelKind::Momentum(0)) => Some((Form::Momentum, channels)),
        _ => None,
    }
}

/// The initial values of a point, if both axes belong to the state and are not the same.
pub(super) fn initial_values(
    plot: &Plot,
    physics: Physics<'_>,
    at: [f64; 2],
) -> Option<Vec<InitialOverride>> {
    let kind = |axis| Some(physics.system.channels().get(plot.column(axis)?)?.kind);
    let given = |kind: ChannelKind, value: f64| match kind {
        ChannelKind::Position(i) => Some(((i, false), InitialOverride::Position(i, value))),
        ChannelKind::Velocity(i) => Some(((i, true), InitialOverride::Velocity(i, value))),
        ChannelKind::Momentum(i) => Some(((i, true), InitialOverride::Momentum(i, value))),
        _ => None,
    };
    let ((place, first), (other, second)) = (given(kind(0)?, at[0])?, given(kind(1)?, at[1])?);
    (place != other).then(|| vec![first, second])
}

impl Survey {
    /// Whether the parameters are the same and the motion neither left the window nor shrank to a small part of it. A
    /// periodic coordinate wraps, so its window stays.
    fn still_holds(&self, parameters: &[f64], motion: [[f64; 2]; 2]) -> bool {
        let Some(landscape) = &self.landscape else {
            return self.parameters == parameters && self.motion == motion;
        };
        let fits = |axis: usize| {
            let [lo, hi] = motion[axis];
            let [from, to] = landscape.window[axis];
            let before = self.motion[axis];
            lo >= from && hi <= to && (hi - lo) >= 0.3 * (before[1] - before[0])
        };
        self.parameters == parameters && (self.periodic || fits(0)) && fits(1)
    }
}
