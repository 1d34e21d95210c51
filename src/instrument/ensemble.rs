//! `ensemble`: a cloud of starts around the motion carried by the flow, as a density in a plane of two of its variables,
//! and the closed curve around it with ∮ Σ p dq: constant where the motion is Hamilton's (Liouville, Poincaré), shrunk at
//! a known rate under friction that takes the same part of every momentum.
//!
//! The cloud is that of the moment at which it was begun: when the picture is first shown, and anew when a parameter or
//! the initial values change, of the same size after a parameter; another method carries it on from where it is. Its job carries it some time ahead, in parts, so that it is there when the motion
//! is.

mod cloud;
mod frame;
mod leg;
mod origin;

use std::sync::Arc;

use super::conditions::PlotConditions;
use super::phase::initial_values;
use super::{
    Across, Answer, Axis, Entry, Heading, Ink, Instrument, Layer, Level, MarkerShape, Measure,
    Need, NoStart, Offer, Physics, Picture, Plot, PlotContext, Present, Properties, Seed,
    StartValues, Upwards,
};
use crate::expr::{Expr, Symbol};
use crate::integrate::method_named;
use crate::job::Job;
use crate::num::{math, significant};
use crate::system::ChannelKind;

use cloud::{Cloud, CloudTask};
use frame::CloudFrame;
use leg::CloudLeg;
use origin::CloudOrigin;

const CURVE: Level = 0;
const CLOUD: Level = 2;
const NOW: Level = 4;

/// What is beyond the extent of a cloud is this part of it.
const MARGIN: f64 = 0.08;

pub(super) struct Ensemble;

const PROPERTIES: Properties = Properties {
    name: "ensemble",
    written: &[Axis::ACROSS, Axis::UPWARDS],
    takes_seeds: true,
    measures: &[
        Measure::new("points", "how many points of the cloud are there", |context| {
            let points = &shown(context)?.cloud;
            Some(points.iter().filter(|at| at[0].is_finite()).count() as f64)
        }),
        Measure::new(
            "outside",
            "how many points are beyond the window that holds the bulk, or lost",
            |context| outside(context).map(|n| n as f64),
        ),
        Measure::new(
            "lost",
            "how many points came to a collision or to infinity and are not followed farther",
            |context| lost(context).map(|n| n as f64),
        ),
        Measure::new(
            "action",
            "the action ∫ p dq around the cloud: its area, for one degree of freedom",
            |context| Some(shown(context)?.action?.value.abs()),
        ),
        Measure::new(
            "expected",
            "the same as the law of motion predicts it from the beginning",
            |context| expected(context).map(f64::abs),
        ),
        Measure::new("off", "how far the two are apart, as a fraction of the expected value", off),
        Measure::new(
            "rate",
            "the rate at which it is expected to grow: 0 without friction",
            |context| cloud(context.answer)?.rate,
        ),
    ],
    ..Properties::PLAIN
};

impl Instrument for Ensemble {
    fn properties(&self) -> &'static Properties {
        &PROPERTIES
    }

    fn offers(&self, physics: Physics<'_>) -> Vec<Offer> {
        let mut pairs = physics.phase_planes();
        // variables of brackets have no momenta
        if physics.model.is_poisson() {
            pairs = physics.neighbouring_positions();
        }
        let offer = |(x, y): (usize, usize)| {
            Offer::new(
                format!("ensemble: {} against {}", physics.shown(y), physics.shown(x)),
                "an ensemble of starts carried by the flow, and the action ∫ p dq around it",
                vec![vec![x], vec![y]],
            )
        };
        pairs.into_iter().map(offer).collect()
    }

    fn words(&self, plot: &Plot, physics: Physics<'_>) -> String {
        format!("ensemble, {}", plot.against(physics))
    }

    fn heading(&self, plot: &Plot, present: &Present<'_>) -> Option<Heading> {
        // names alone: a cloud may be behind the motion, whose values are of another moment
        let words = plot.against(present.physics);
        Some(plot.heading(present.physics, "Ensemble", vec![Entry::Words(words)]))
    }

    fn across(&self, context: PlotContext<'_>) -> Across {
        context.plot.across(range(context, 0))
    }

    fn picture(&self, context: PlotContext<'_>, _seen: [f64; 2]) -> Option<Picture> {
        let PlotContext { plot, present, .. } = context;
        let channels = [plot.column(0)?, plot.column(1)?];
        let mut layers = Vec::new();
        if let Some(frame) = shown(context) {
            layers.push((CURVE, Layer::Line(frame.curve.to_vec(), Ink::Curve(1).into())));
            layers.push((CLOUD, Layer::Cloud(Arc::clone(&frame.cloud))));
        }
        // a cloud is drawn with the motion where it was then: its last frame is a little behind, or a lot
        let then = shown(context).filter(|frame| frame.time != present.time);
        let then = then.map(|frame| frame.own);
        let then = then.filter(|at| at.iter().all(|x| x.is_finite()));
        let now = then.unwrap_or_else(|| channels.map(|channel| present.value(channel)));
        layers.push((NOW, Layer::Point(now, MarkerShape::Disc, Ink::Accent)));
        let words = [sentence(context), outside_in_words(context)].concat();
        let lines: Vec<String> = [words].into_iter().chain(since(context)).collect();
        let lines: Vec<String> = lines.into_iter().filter(|line| !line.is_empty()).collect();
        if !lines.is_empty() {
            layers.push((NOW, Layer::Legend(lines)));
        }
        let upwards = Upwards::Channel(channels[1], range(context, 1));
        Some(Picture::Axes { upwards, layers, occurrences: None })
    }

    fn start(&self, context: PlotContext<'_>, at: [f64; 2]) -> StartValues {
        initial_values(context.plot, context.present.physics, at).ok_or(NoStart::Nothing)
    }

    fn seed(&self, context: PlotContext<'_>) -> Option<Seed> {
        let PlotContext { plot, present, .. } = context;
        initial_values(plot, present.physics, [0.0; 2])?;
        let viewport = plot.viewport()?;
        let window = [range(context, 0)?, range(context, 1)?];
        let seen = [0, 1].map(|axis| viewport.part(axis, window[axis]));
        // once more while all of the box is seen: over the energy shell in its place
        let conserved = present.physics.equations.energy_rate == Expr::ZERO;
        let contains = |extent: &[f64; 2], by: &[f64; 2]| by[0] <= extent[0] && extent[1] <= by[1];
        Some(match plot.seeds.last() {
            Some(Seed::Spread(last))
                if conserved && last.iter().zip(&seen).all(|(extent, by)| contains(extent, by)) =>
            {
                Seed::Shell
            }
            _ => Seed::Spread(seen),
        })
    }

    fn job(&self, PlotContext { plot, present, answer }: PlotContext<'_>) -> Need {
        let Physics { model, equations, system } = present.physics;
        if !model.constraints.is_empty() {
            return Need::Nothing;
        }
        let Some(starts) = starts(plot, present.physics) else { return Need::Nothing };
        let Some(method) = method_named(present.method) else { return Need::Nothing };
        let conditions = PlotConditions::of(present, &plot.seeds);
        let before = cloud(answer).filter(|known| known.origin.time <= present.time);
        // by another method a cloud is carried on from where that took over
        let other = before.filter(|known| known.conditions.differ_in_method_alone(&conditions));
        let carried_on = other.and_then(|known| {
            CloudLeg::all((&known.legs, &known.conditions), known.origin.time, present)
                .map(|legs| (known, legs))
        });
        let known = before.filter(|known| {
            known.conditions == conditions && CloudLeg::are_of_the_motion(&known.legs, present)
        });
        let is_there = |known: &Cloud| present.running || known.is_at(present.time);
        if known.is_some_and(|known| known.holds(present.time) && is_there(known)) {
            return Need::Valid;
        }
        let (known, legs) = match (known, carried_on) {
            (None, Some((known, legs))) => (Some(known), legs),
            (known, _) => (known, known.map_or_else(Vec::new, |known| known.legs.clone())),
        };
        // where it is begun again by another method, it begins as before
        let origin = match known.or(other) {
            Some(known) => known.origin.clone(),
            None => match CloudOrigin::of(&starts, present, conditions.seeds.last().copied()) {
                // an ensemble that a parameter has changed the law of keeps its size, also where the change is undone
                Some(origin) => match cloud(answer) {
                    Some(known) if known.conditions.differ_in_parameters_alone(&conditions) => {
                        origin.placed_again(&known.origin)
                    }
                    _ => origin,
                },
                None => return Need::Nothing,
            },
        };
        let task = CloudTask {
            plot: plot.clone(),
            starts,
            model: Arc::clone(model),
            equations: Arc::clone(equations),
            system: Arc::clone(system),
            method: (method, present.settings),
            conditions,
            origin,
            legs,
            now: present.time,
            shown: present.carried,
            // what was known beyond the current time is continued from
            known: answer.filter(|_| known.is_some_and(|known| known.began(present.time))).cloned(),
        };
        let job = Job::new("cloud", move |progress| Answer::new(task.run(progress)));
        // what a person asks for is computed in any case
        if plot.seeds.is_empty() { Need::WhileDrawn(job) } else { Need::Job(job) }
    }

    fn known_until(&self, answer: &Answer) -> Option<f64> {
        let cloud = answer.of::<Cloud>().filter(|cloud| cloud.error.is_none())?;
        cloud.frames.last().map(|frame| frame.time)
    }
}

/// The plane in which the starts are spread: that of the picture, if its points are initial values; of two new variables
/// of a transformation that of the coordinate and the momentum which they replace.
fn starts(plot: &Plot, physics: Physics<'_>) -> Option<Plot> {
    if initial_values(plot, physics, [0.0; 2]).is_some() {
        return Some(plot.clone());
    }
    let shown = [plot.column(0)?, plot.column(1)?]
        .map(|channel| physics.system.channels()[channel].name.as_str());
    let model = physics.model;
    let named = |symbol: Symbol| model.pool.symbol_info(symbol).name.as_str();
    let mut pairs = model.transformations.iter().flat_map(|law| law.new.iter().enumerate());
    let (pair, _) = pairs.find(|(_, new)| new.map(named) == shown)?;
    let kinds = [ChannelKind::Position(pair), ChannelKind::Momentum(pair)];
    let columns = kinds.map(|kind| physics.channel(kind).map(|channel| vec![channel]));
    let columns: Vec<Vec<usize>> = columns.into_iter().collect::<Option<_>>()?;
    let starts = Plot::new(plot.kind, (columns, None), model);
    initial_values(&starts, physics, [0.0; 2]).map(|_| starts)
}

fn cloud(answer: Option<&Answer>) -> Option<&Cloud> {
    answer?.of::<Cloud>()
}

/// Since when the cloud is carried, if that is more than a second of the wall clock after the start of the motion.
fn since(PlotContext { present, answer, .. }: PlotContext<'_>) -> Option<String> {
    let run = &present.physics.model.run;
    let (begun, second) = (cloud(answer)?.origin.time, run.speed.abs());
    let second = if second.is_finite() { second } else { 0.0 };
    let again = if cloud(answer)?.origin.again { ", as large as before" } else { "" };
    (begun - run.start > second)
        .then(|| format!("since t = {}{again}", significant(begun, 4, 1e-3..1e5).replace('-', "−")))
}

/// The frame that is shown: the last that is not later than the motion, and than what is known of clouds beside this one.
fn shown(PlotContext { present, answer, .. }: PlotContext<'_>) -> Option<&CloudFrame> {
    let cloud = cloud(answer)?;
    let before = cloud.frames.iter().rfind(|frame| frame.time <= present.carried);
    before.or_else(|| cloud.frames.first())
}

/// Whether it is behind a motion that is faster than the cloud can be carried.
fn is_late(context: PlotContext<'_>) -> bool {
    let (Some(cloud), Some(frame)) = (cloud(context.answer), shown(context)) else { return false };
    context.present.time - frame.time > 2.0 * cloud.spacing
}

/// ∮ Σ p dq as it is expected.
fn expected(context: PlotContext<'_>) -> Option<f64> {
    let (cloud, frame) = (cloud(context.answer)?, shown(context)?);
    let since = frame.time - cloud.origin.time;
    Some(cloud.first?.value * math::exp(cloud.rate? * since))
}

fn off(context: PlotContext<'_>) -> Option<f64> {
    let (expected, action) = (expected(context)?, shown(context)?.action?);
    Some(((action.value - expected) / expected).abs()).filter(|off| off.is_finite())
}

/// The integral in words, beside what is expected.
fn sentence(context: PlotContext<'_>) -> String {
    let Some(cloud) = cloud(context.answer) else { return String::new() };
    if let Some(why) = &cloud.error {
        return why.clone();
    }
    let short = |x: f64| significant(x, 4, 1e-3..1e5).replace('-', "−");
    let Some(frame) = shown(context) else { return String::new() };
    let late = is_late(context);
    let at = if late { format!(" at t = {}", short(frame.time)) } else { String::new() };
    if let Some(energy) = cloud.origin.energy() {
        return format!("energy {}{at}", short(energy));
    }
    let Some(action) = frame.action else {
        let known = match cloud.curve() {
            None if late => "the cloud",
            None => return String::new(),
            Some(curve) if curve.is_whole() => "action: stretched too far to be known",
            Some(_) => "action: a part of the curve is lost",
        };
        return format!("{known}{at}");
    };
    let value = format!("action {}{at}", short(action.value.abs()));
    match (cloud.rate, off(context)) {
        (Some(rate), Some(off)) => {
            let law = if rate == 0.0 {
                "constant".to_owned()
            } else {
                format!("∝ e^({} t)", short(rate))
            };
            format!("{value}, {law} to {}", significant(off.max(1e-16), 1, 1e-3..1e3))
        }
        _ => value,
    }
}

/// How many points of the cloud could not be followed farther: they came to a collision, or to infinity.
fn lost(context: PlotContext<'_>) -> Option<usize> {
    let frame = shown(context)?;
    Some(frame.cloud.iter().filter(|at| at.iter().any(|x| !x.is_finite())).count())
}

/// How many points of the cloud are outside the window, or lost.
fn outside(context: PlotContext<'_>) -> Option<usize> {
    let PlotContext { plot, present, .. } = context;
    let frame = shown(context)?;
    let window = [range(context, 0)?, range(context, 1)?];
    let turns = [0, 1].map(|axis| {
        let channel = plot.column(axis)?;
        present.physics.system.period(channel, present.parameters)
    });
    let holds = |(axis, x): (usize, &f64)| {
        let [lo, hi] = window[axis];
        (lo..=hi).contains(x) || turns[axis].is_some() && x.is_finite()
    };
    Some(frame.cloud.iter().filter(|at| !at.iter().enumerate().all(holds)).count())
}

fn outside_in_words(context: PlotContext<'_>) -> String {
    let lost = lost(context).unwrap_or(0);
    let far = outside(context).unwrap_or(0) - lost;
    let counted = [(far, "outside"), (lost, "lost")].into_iter().filter(|(count, _)| *count > 0);
    let counted: Vec<String> = counted.map(|(count, word)| format!(", {count} {word}")).collect();
    counted.concat()
}

/// The range of an axis: of all that was seen of the bulk of the cloud, or a turn.
fn range(PlotContext { plot, present, answer }: PlotContext<'_>, axis: usize) -> Option<[f64; 2]> {
    let channel = plot.column(axis)?;
    let [lo, hi] = cloud(answer)?.extent[axis];
    if !(lo < hi && lo.is_finite() && hi.is_finite()) {
        return None;
    }
    let margin = MARGIN * (hi - lo);
    let [lo, hi] = [lo - margin, hi + margin];
    present.turn_within(channel, [lo, hi]).or(Some([lo, hi]))
}
