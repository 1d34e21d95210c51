//! `family`: the family of the periodic orbit near the motion over the energy or a parameter: how far each orbit goes in a
//! coordinate, stable and unstable ones drawn in two styles, folds, period doublings and branchings marked by their names.
//!
//! The job closes the orbit near the state at which the picture was begun, or was asked for again, and follows its family in
//! both directions by pseudo-arclength ([`FamilyCourse`](crate::dynamics::FamilyCourse)), in parts that are drawn as they come. It begins again where a parameter, the method or the initial values
//! change.

mod members;

use std::collections::BTreeSet;
use std::sync::Arc;

use super::conditions::PlotConditions;
use super::equilibria::start;
use super::{
    Across, Answer, Axis, Entry, Heading, Ink, Instrument, Layer, Level, MarkerShape, Measure,
    Need, Offer, PeriodicOrbits, Physics, Picture, Plot, PlotContext, PlotTable, Present,
    Properties, Seed, Stroke, Upwards, varied,
};
use crate::dynamics::{Bifurcation, NOT_ISOLATED};
use crate::expr::Expr;
use crate::integrate::method_named;
use crate::job::{Job, Progress};
use crate::model::Variation;
use crate::num::significant;
use crate::system::ChannelKind;
use members::{FamilyMember, FollowedFamily, close, follow_on};

const CURVE: Level = 2;
const NOW: Level = 4;

/// The most bifurcations that are listed.
const LISTED: usize = 6;

/// The part of the dots that is drawn of unstable orbits.
const SPARSE: f64 = 0.35;

/// What is beyond the extent of a family is this part of it.
const MARGIN: f64 = 0.1;

pub(super) struct FamilyPlot;

struct ComputedFamily {
    conditions: PlotConditions,
    /// The time of the motion when it was asked for.
    asked: f64,
    outcome: Result<FollowedFamily, String>,
}

const PROPERTIES: Properties = Properties {
    name: "family",
    written: &[Axis::ACROSS, Axis::UPWARDS],
    takes_seeds: true,
    measures: &[
        Measure::new("members", "how many orbits of the family were found", |context| {
            Some(followed(context.answer)?.members.len() as f64)
        }),
        Measure::new("folds", "how often the family turns back", |context| {
            count(context.answer, Bifurcation::Fold)
        }),
        Measure::new(
            "doublings",
            "how often a multiplier passes −1, where orbits of twice the period branch off",
            |context| count(context.answer, Bifurcation::PeriodDoubling),
        ),
        Measure::new("branchings", "how often a multiplier passes 1 without a fold", |context| {
            count(context.answer, Bifurcation::Branching)
        }),
        Measure::new(
            "first",
            "the value at the bifurcation of the family next to the motion",
            |PlotContext { plot, present, answer }| {
                let now = now(plot, present)?;
                let all = followed(answer)?.members.iter();
                let all = all.filter(|member| member.bifurcation.is_some());
                let all = all.map(|member| member.value);
                all.min_by(|a, b| (a - now).abs().total_cmp(&(b - now).abs()))
            },
        ),
    ],
    ..Properties::PLAIN
};

impl Instrument for FamilyPlot {
    fn properties(&self) -> &'static Properties {
        &PROPERTIES
    }

    fn offers(&self, physics: Physics<'_>) -> Vec<Offer> {
        let Some(energy) = physics.channel(ChannelKind::Energy) else { return Vec::new() };
        let offer = |x: usize, over: Option<Variation>| {
            let along = over.map_or_else(
                || physics.shown(energy).to_owned(),
                |over| varied::names(physics, &[over]),
            );
            Offer {
                label: format!("family of orbits: {} over {along}", physics.shown(x)),
                about: "the family of the periodic orbit near the motion, with its bifurcations"
                    .to_owned(),
                columns: vec![vec![energy], vec![x]],
                view: None,
                over: over.into_iter().collect(),
            }
        };
        let places: Vec<usize> = physics.positions().map(|(_, x)| x).collect();
        let conserved =
            physics.equations.energy_rate == Expr::ZERO && physics.model.impulses.is_empty();
        let of_energy = places.iter().filter(|_| conserved).map(|&x| offer(x, None));
        let parameters = (0..physics.model.parameters.len()).filter(|&i| is_in_law(physics, i));
        let of_parameters = parameters
            .filter_map(|index| Some(offer(*places.first()?, Some(Variation::Parameter(index)))));
        of_energy.chain(of_parameters).collect()
    }

    fn words(&self, plot: &Plot, physics: Physics<'_>) -> String {
        let x = plot.column(1).map_or("?", |x| physics.shown(x));
        format!("family of orbits, {x} over {}", along_in_words(plot, physics))
    }

    fn heading(&self, plot: &Plot, present: &Present<'_>) -> Option<Heading> {
        let entry = Entry::Number(along_in_words(plot, present.physics), now(plot, present)?);
        Some(plot.heading(present.physics, "Family", vec![entry]))
    }

    fn across(&self, PlotContext { plot, present, answer }: PlotContext<'_>) -> Across {
        let range = followed(answer).map(|found| found.range);
        match (plot.over.first(), plot.column(0)) {
            (None, Some(energy)) => {
                let shown = followed(answer).and_then(|found| width(found, present.value(energy)));
                Across::Channel(energy, shown.or(range))
            }
            (Some(&over), _) => {
                let now = varied::now(present, over);
                let shown = followed(answer).zip(now).and_then(|(found, now)| width(found, now));
                let range = shown.or(range).or_else(|| varied::range(plot, present, 0));
                let name = varied::with_unit(present.physics, over);
                range.map_or(Across::Nothing, |range| Across::Named(name, range))
            }
            (None, None) => Across::Nothing,
        }
    }

    fn picture(&self, context: PlotContext<'_>, _seen: [f64; 2]) -> Option<Picture> {
        let PlotContext { plot, present, answer } = context;
        let x = quantity(plot, answer)?;
        let now = now(plot, present)?;
        let members = followed(answer).map_or(&[][..], |found| &found.members);
        let [low, high] = heights(members).unwrap_or([-1.0, 1.0]);
        let mut layers = vec![(NOW, Layer::Line(vec![[now, low], [now, high]], Ink::Level.into()))];
        layers.extend(curves(members).into_iter().map(|curve| (CURVE, curve)));
        if let [alone] = members {
            let at = [alone.value, alone.greatest];
            layers.push((CURVE, Layer::Point(at, MarkerShape::Disc, Ink::Accent)));
        }
        for member in members {
            let Some(bifurcation) = member.bifurcation else { continue };
            let at = [member.value, member.greatest];
            layers.push((NOW, Layer::Point(at, MarkerShape::Ring, Ink::Accent)));
            layers.push((NOW, Layer::Name(at, bifurcation.word().to_owned())));
        }
        layers.push((NOW, Layer::Legend(legend(plot, present.physics, answer))));
        let name = format!("greatest {}", present.physics.shown(x));
        let upwards = Upwards::Named(name, [low, high]);
        Some(Picture::Axes { upwards, layers, occurrences: None })
    }

    /// The time at which the family is asked for again.
    fn seed(&self, PlotContext { present, .. }: PlotContext<'_>) -> Option<Seed> {
        Some(Seed::Through([present.time, 0.0]))
    }

    fn job(&self, PlotContext { plot, present, answer }: PlotContext<'_>) -> Need {
        let conditions = PlotConditions::of(present, &plot.seeds);
        let known = answer.and_then(Answer::of::<ComputedFamily>);
        let holds =
            |known: &&ComputedFamily| known.conditions == conditions && known.asked <= present.time;
        let known = known.filter(holds);
        // what is there of a family under way is followed on
        let under_way = match known.map(|known| &known.outcome) {
            Some(Ok(found)) if !found.is_complete() => answer.cloned(),
            Some(_) => return Need::Valid,
            None => None,
        };
        let (Some(channel), Some(method)) = (plot.column(1), method_named(present.method)) else {
            return Need::Nothing;
        };
        if !is_followed(plot, present.physics) {
            return Need::Nothing;
        }
        let parameter = match plot.over.first() {
            Some(&Variation::Parameter(index)) => match varied::range(plot, present, 0) {
                Some(range) => Some((index, range)),
                None => return Need::Nothing,
            },
            Some(Variation::Initial(_)) => return Need::Nothing,
            None => None,
        };
        let Physics { model, equations, system } = present.physics;
        let (model, equations, system) = (model.clone(), equations.clone(), system.clone());
        // a picture shows no more, and a family has many orbits
        let settings = method.fast(present.settings);
        let asked = known.map_or(present.time, |known| known.asked);
        let start = start(present, asked);
        let job = Job::new("family of orbits", move |progress: &Progress| {
            let system = system.with_cancel(progress.token().clone());
            let physics = Physics { model: &model, equations: &equations, system: &system.into() };
            let (of, method) = ((&start, &conditions), (method, settings));
            let known = under_way.as_ref().and_then(Answer::of::<ComputedFamily>);
            let outcome = match known.and_then(|known| known.outcome.as_ref().ok()) {
                Some(known) => {
                    let over = parameter.map(|(index, _)| index);
                    follow_on(physics, method, (known, &start), over, progress)
                }
                None => close(physics, method, of, (parameter, channel), progress),
            };
            Answer::new(ComputedFamily { conditions: conditions.clone(), asked, outcome })
        });
        // what a person asks for is computed in any case
        if plot.seeds.is_empty() { Need::WhileDrawn(job) } else { Need::Job(job) }
    }

    fn table(&self, PlotContext { plot, present, answer }: PlotContext<'_>) -> Option<PlotTable> {
        let physics = present.physics;
        let along = match plot.over.first() {
            Some(&over) => varied::written(physics, over).to_owned(),
            None => "energy".to_owned(),
        };
        let greatest = &physics.system.channels().get(quantity(plot, answer)?)?.name;
        let mut columns = vec![along, format!("greatest {greatest}"), "period".to_owned()];
        let over_energy = plot.over.is_empty();
        columns.extend((!over_energy).then(|| "energy".to_owned()));
        columns.push("trace".to_owned());
        let row = |member: &FamilyMember| {
            let mut row = vec![member.value, member.greatest, member.period];
            row.extend((!over_energy).then_some(member.energy));
            row.push(member.trace);
            row
        };
        let rows = followed(answer)?.members.iter().map(row).collect();
        Some(PlotTable { columns, counts: 0, rows })
    }

    fn periodic(&self, answer: &Answer) -> Option<Arc<PeriodicOrbits>> {
        Some(Arc::clone(&followed(Some(answer))?.periodic))
    }
}

fn followed(answer: Option<&Answer>) -> Option<&FollowedFamily> {
    answer?.of::<ComputedFamily>()?.outcome.as_ref().ok()
}

fn count(answer: Option<&Answer>, which: Bifurcation) -> Option<f64> {
    let members = followed(answer)?.members.iter();
    Some(members.filter(|member| member.bifurcation == Some(which)).count() as f64)
}

/// Whether it is over the energy or a parameter: a view of a file may ask for something else.
fn is_followed(plot: &Plot, physics: Physics<'_>) -> bool {
    let across = plot.column(0).and_then(|x| physics.system.channels().get(x));
    !plot.over.is_empty() || across.is_some_and(|channel| channel.kind == ChannelKind::Energy)
}

/// Whether a parameter stands in the law: one of initial values, observables or pictures alone changes nothing along a family.
fn is_in_law(physics: Physics<'_>, index: usize) -> bool {
    let model = physics.model;
    let Some(parameter) = model.parameters.get(index) else { return false };
    let mut law: Vec<Expr> = model.mechanics.forces().to_vec();
    law.extend([model.mechanics.function().1, model.mechanics.dissipation()]);
    for impulse in &model.impulses {
        law.extend(impulse.times.iter().chain(&impulse.period).chain(&impulse.change));
    }
    law.extend(model.constraints.iter().map(|constraint| constraint.expression));
    law.extend(model.events.iter().map(|event| event.when));
    law.iter().any(|&expression| model.pool.depends(expression, parameter.symbol))
}

/// The quantity whose greatest value is drawn: the one chosen, or the momentum of an angle that rotates.
fn quantity(plot: &Plot, answer: Option<&Answer>) -> Option<usize> {
    followed(answer).map(|found| found.channel).or_else(|| plot.column(1))
}

/// What changes along the family, by its name.
fn along_in_words(plot: &Plot, physics: Physics<'_>) -> String {
    match (plot.over.first(), plot.column(0)) {
        (Some(_), _) => varied::names(physics, &plot.over),
        (None, Some(energy)) => physics.shown(energy).to_owned(),
        (None, None) => "?".to_owned(),
    }
}

fn now(plot: &Plot, present: &Present<'_>) -> Option<f64> {
    match plot.over.first() {
        Some(&over) => varied::now(present, over),
        None => Some(present.value(plot.column(0)?)),
    }
}

/// What changes along it, from its orbits to the motion, with a margin: it may end long before its range does.
fn width(found: &FollowedFamily, now: f64) -> Option<[f64; 2]> {
    let all = found.members.iter().map(|member| member.value).filter(|x| x.is_finite());
    let (low, high) = all.fold((now, now), |(lo, hi), x| (lo.min(x), hi.max(x)));
    let margin = MARGIN * (high - low);
    (low < high).then_some([low - margin, high + margin])
}

/// The vertical range, with a margin.
fn heights(members: &[FamilyMember]) -> Option<[f64; 2]> {
    let finite = members.iter().map(|member| member.greatest).filter(|x| x.is_finite());
    let (low, high) =
        finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), x| (lo.min(x), hi.max(x)));
    // one orbit alone is in the middle
    let margin = match (high - low, high.abs()) {
        (extent, _) if extent > 0.0 => MARGIN * extent,
        (_, size) if size > 0.0 => size / 2.0,
        _ => 1.0,
    };
    (low <= high).then_some([low - margin, high + margin])
}

/// The family as curves, one for each part of the same stability. Between two orbits it is that of the one at which nothing
/// happens.
fn curves(members: &[FamilyMember]) -> Vec<Layer> {
    let style = |stable: Option<bool>| match stable {
        Some(true) => Stroke::from(Ink::Curve(0)),
        Some(false) => Stroke { ink: Ink::Separatrix, covering: Some(SPARSE) },
        None => Stroke::from(Ink::Curve(2)),
    };
    let mut parts: Vec<(Option<bool>, Vec<[f64; 2]>)> = Vec::new();
    for pair in members.windows(2) {
        let of = if pair[1].bifurcation.is_some() { &pair[0] } else { &pair[1] };
        let ends = [&pair[0], &pair[1]].map(|member| [member.value, member.greatest]);
        match parts.last_mut() {
            Some((stable, points)) if *stable == of.stable => points.push(ends[1]),
            _ => parts.push((of.stable, ends.to_vec())),
        }
    }
    parts.into_iter().map(|(stable, points)| Layer::Line(points, style(stable))).collect()
}

/// What is said of the family, or why there is none.
fn legend(plot: &Plot, physics: Physics<'_>, answer: Option<&Answer>) -> Vec<String> {
    if !is_followed(plot, physics) {
        return vec!["a family of a file is drawn over the energy: x = \"energy\"".to_owned()];
    }
    let found = match answer.and_then(Answer::of::<ComputedFamily>) {
        None => {
            return vec![
                "searching for the periodic orbit near the motion, and for its family".to_owned(),
            ];
        }
        Some(ComputedFamily { outcome: Err(why), .. }) => return vec![why.clone()],
        Some(ComputedFamily { outcome: Ok(found), .. }) => found,
    };
    let short = |x: f64| significant(x, 6, 1e-4..1e6).replace('-', "−");
    let along = along_in_words(plot, physics);
    let members = &found.members;
    let has = |stable: bool| members.iter().any(|member| member.stable == Some(stable));
    let mut lines = match (members.is_empty(), has(true), has(false)) {
        (true, _, _) => {
            let [from, to] = found.range.map(short);
            let first = short(found.first);
            vec![format!(
                "no orbit was found with {along} from {from} to {to}, on the family of the one with {along} = {first}"
            )]
        }
        (_, true, true) => vec!["solid: stable, dotted: unstable".to_owned()],
        (_, true, false) => vec!["solid: stable".to_owned()],
        (_, false, true) => vec!["dotted: unstable".to_owned()],
        (_, false, false) => vec!["neither stable nor unstable to first order".to_owned()],
    };
    let all = members.iter().filter_map(|member| Some((member.bifurcation?, member.value)));
    let mut all: Vec<String> =
        all.map(|(what, value)| format!("{} at {along} = {}", what.word(), short(value))).collect();
    // a family that closes is followed to the same places from both sides
    let mut seen = BTreeSet::new();
    all.retain(|one| seen.insert(one.clone()));
    lines.extend(all.iter().take(LISTED).cloned());
    if all.len() > LISTED {
        lines.push(format!("and {} more", all.len() - LISTED));
    }
    if !found.is_complete() {
        lines.push("being followed".to_owned());
    }
    if !found.isolated {
        lines.push(NOT_ISOLATED.to_owned());
    }
    lines.extend(found.ended.iter().cloned());
    lines
}
