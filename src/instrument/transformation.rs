//! `transformation`: the orbit in the new variables of a transformation (q, p) → (Q, P), with the grid of the old ones.
//!
//! In the passive view the point is the same, and its coordinates are others: lines of constant old variables are drawn in
//! the plane of the new ones, parted where these jump. In the active view the map moves the point: (q, p) and its image
//! (Q, P) in one plane. The job finds the lines, whether the map is canonical, and K.
//! Source: *The Principles of Dynamics*, §§ 3.2.2, 3.3.

mod branches;
mod grid;
mod image;
mod judged;
mod point;
mod relations;
mod window;

use std::sync::Arc;

use self::branches::{Branches, OtherImages};
use self::grid::old_variables;
use self::image::{ImageOrigin, beyond, of_branches, outside};
use self::judged::MapVerdict;
use self::relations::{depends_on_time, implicit};
use self::window::ShownCoordinates;
use super::{
    Across, Answer, Axis, Entry, Heading, Ink, Instrument, Layer, Level, MarkerShape, Measure,
    Need, Offer, Physics, Picture, Plot, PlotContext, Present, Properties, Stroke, Upwards,
};
use crate::expr::{Symbol, with_subscripts};
use crate::job::Job;
use crate::mechanics::{TransformationReport, Valuation, relations_of};
use crate::model::Transformation as Law;
use crate::system::ChannelKind;

const GRID: Level = 0;
const TRAIL: Level = 2;
const NOW: Level = 4;

/// The part of the range of the motion that is added on each side.
const MARGIN: f64 = 0.15;

/// The share of the dots of a grid of another branch that is drawn.
const DIM: f64 = 0.35;

/// The grid of a map that depends on the time is found anew after so many seconds of the wall clock at the file's own speed.
const STALE: f64 = 0.1;

pub(super) struct TransformationPlot;

/// What was found of a transformation, and where.
struct Mapped {
    parameters: Vec<f64>,
    /// When it was found, of a map that depends on the time.
    time: Option<f64>,
    /// The range of the two old variables.
    window: Option<[[f64; 2]; 2]>,
    grid: Arc<Vec<Vec<[f64; 2]>>>,
    branches: Option<Arc<Branches>>,
    verdict: Option<MapVerdict>,
}

/// A transformation, and the two of its new variables that are shown.
struct Shown<'a> {
    law: &'a Law,
    new: [Symbol; 2],
}

const PROPERTIES: Properties = Properties {
    name: "transformation",
    written: &[
        Axis { transformed: true, ..Axis::ACROSS },
        Axis { transformed: true, ..Axis::UPWARDS },
    ],
    has_equal_axes: true,
    lead: "transformation ",
    measures: &[
        Measure::new("canonical", "1 if it is canonical, 0 if it is not", |context| {
            judged(context.answer).map(|judged| f64::from(u8::from(judged.canonical)))
        }),
        Measure::new(
            "residual",
            "the largest entry of |M J Mᵀ − J| at points near the start",
            |context| judged(context.answer)?.residual,
        ),
        Measure::new(
            "off_step",
            "how far it is from the step of a method that the file says it is",
            |context| judged(context.answer)?.off_step,
        ),
    ],
    ..Properties::PLAIN
};

impl Instrument for TransformationPlot {
    fn properties(&self) -> &'static Properties {
        &PROPERTIES
    }

    fn offers(&self, physics: Physics<'_>) -> Vec<Offer> {
        let channel = |law: &Law, symbol: Symbol| {
            let name = physics.model.new_variable_name(law, symbol);
            physics.named().find(|(_, channel)| channel.name == name)
        };
        let pairs = physics.model.transformations.iter().flat_map(|law| {
            law.new.iter().filter_map(move |&[position, momentum]| {
                let (x, across) = channel(law, position)?;
                let (y, upwards) = channel(law, momentum)?;
                Some(Offer::new(
                    format!("{} against {}", upwards.shown, across.shown),
                    format!("the transformation {}, with the grid of (q, p)", law.name),
                    vec![vec![x], vec![y]],
                ))
            })
        });
        pairs.collect()
    }

    fn is_plane(&self, plot: &Plot, physics: Physics<'_>) -> Option<bool> {
        Some(point::is_plane(plot, physics))
    }

    fn words(&self, plot: &Plot, physics: Physics<'_>) -> String {
        match shown(plot, physics) {
            Some(shown) => format!("{}, {}", shown.law.name, plot.against(physics)),
            None => plot.against(physics),
        }
    }

    fn heading(&self, plot: &Plot, present: &Present<'_>) -> Option<Heading> {
        let name = shown(plot, present.physics).map(|shown| with_subscripts(&shown.law.name));
        let columns = [plot.column(0)?, plot.column(1)?];
        // without an image the variables have no numbers
        let entry = |channel: usize| match present.value(channel) {
            value if value.is_finite() => Entry::Channel(channel),
            _ => Entry::Words(present.physics.shown(channel).to_owned()),
        };
        let mut entries = vec![Entry::Words(name.unwrap_or_default())];
        entries.extend(columns.map(entry));
        let moved = moved(plot, present.physics).is_some();
        let kind = if moved { "Transformation, active" } else { "Transformation" };
        Some(plot.heading(present.physics, kind, entries))
    }

    fn across(&self, context: PlotContext<'_>) -> Across {
        let PlotContext { plot, present, answer } = context;
        if let Some([q, _]) = moved(plot, present.physics) {
            return Across::Channel(q, both(plot, present, q, 0));
        }
        let images = images(context).all();
        let range = range(plot, present, (answer, &images), 0);
        plot.column(0).map_or(Across::Nothing, |x| Across::Channel(x, range))
    }

    fn picture(&self, context: PlotContext<'_>, _seen: [f64; 2]) -> Option<Picture> {
        let PlotContext { plot, present, answer } = context;
        let [x, y] = [plot.column(0)?, plot.column(1)?];
        let mapped = mapped(answer);
        if let Some(old) = moved(plot, present.physics) {
            return Some(active(context, (old, [x, y])));
        }
        let stroke = Stroke::from(Ink::Level);
        let now = [x, y].map(|k| present.value(k));
        let grid = mapped.into_iter().flat_map(|mapped| mapped.grid.iter());
        let mut layers: Vec<(Level, Layer)> =
            grid.map(|line| (GRID, Layer::Line(line.clone(), stroke))).collect();
        let branches = mapped.and_then(|mapped| mapped.branches.as_deref());
        let images = images(context);
        let rings = [images.on_grids.len(), images.beside.len()];
        let images = images.all();
        if let Some(branches) = branches {
            let dim = Stroke { ink: Ink::Level, covering: Some(DIM) };
            layers.extend(branches.lines.iter().map(|line| (GRID, Layer::Line(line.clone(), dim))));
            let ring = |&image| (NOW, Layer::Point(image, MarkerShape::Ring, Ink::Level));
            layers.extend(images.iter().map(ring));
        }
        layers.extend([
            (TRAIL, Layer::Companions([x, y])),
            (TRAIL, Layer::RecentTrail([x, y], present.changed_at())),
            (NOW, Layer::Point(now, MarkerShape::Disc, Ink::Accent)),
        ]);
        let mut lines = match mapped {
            _ if shown(plot, present.physics).is_none() => {
                vec!["these are not two new variables of one transformation".to_owned()]
            }
            _ => judged(answer).map_or_else(Vec::new, |judged| judged.lines.clone()),
        };
        let image = of_image(plot, present).iter().map(|line| (*line).to_owned());
        // that there is none comes first, as what is at the end may have no room
        let place = if now.iter().all(|x| x.is_finite()) { lines.len() } else { 0 };
        lines.splice(place..place, image);
        lines.extend(of_branches(branches.map_or(0, Branches::others), rings[0], rings[1]));
        let ranges = [0, 1].map(|axis| range(plot, present, (answer, &images), axis));
        lines.extend(outside(&images, &ranges));
        for (channel, range) in [x, y].into_iter().zip(ranges) {
            let reached = present.bounds.get(channel).map(|&(lo, hi)| [lo, hi]);
            lines.extend(beyond(present.physics.shown(channel), range, reached));
        }
        layers.push((NOW, Layer::Legend(lines)));
        let upwards = Upwards::Channel(y, ranges[1]);
        Some(Picture::Axes { upwards, layers, occurrences: None })
    }

    fn job(&self, PlotContext { plot, present, answer }: PlotContext<'_>) -> Need {
        let Physics { model, equations, .. } = present.physics;
        let Some(Shown { law, new }) = shown(plot, present.physics) else { return Need::Nothing };
        let place = model.transformations.iter().position(|one| one.name == law.name);
        let known = place.and_then(|place| equations.supplements.maps.written.get(place));
        let old = known.and_then(Option::as_ref).and_then(|forwards| {
            let of = |symbol: Symbol| forwards.iter().find(|(s, _)| *s == symbol).map(|(_, e)| *e);
            let images = [of(new[0])?, of(new[1])?];
            let old = old_variables(&equations.pool, present.physics, &images)?;
            Some((images, old))
        });
        let unwritten = implicit(equations, new)
            .filter(|map| map.new.len() == 2 || model.coordinates.len() == 1)
            .and_then(|map| old_variables(&equations.pool, present.physics, &map.relations));
        let timed = depends_on_time(equations, model, (place, new));
        let axes = old.map(|(_, old)| old).or(unwritten);
        let wanted = axes.and_then(|old| {
            let [u, v] = old.map(|(_, channel)| present.bounds.get(channel).copied());
            Some([u?, v?].map(|(lo, hi)| [lo, hi]))
        });
        let known = mapped(answer).filter(|known| known.parameters == present.parameters);
        let verdict = known.and_then(|known| known.verdict.clone());
        let (parameters, name) = (present.parameters.to_vec(), law.name.clone());
        let stays = |known: &&Mapped| {
            let at = || with_image(plot, present);
            let left = |branches: &Arc<Branches>| old.is_none() && branches.has_left(&at());
            known.covers(wanted) && !known.branches.as_ref().is_some_and(left)
        };
        let late = STALE * model.run.speed.abs();
        let fresh = |known: &&Mapped| {
            known.time.is_none_or(|time| (time..=time + late).contains(&present.time))
        };
        // the verdict does not wait for a grid that is found again and again
        let known = known.filter(|known| stays(known) && (fresh(known) || verdict.is_none()));
        if let Some(known) = known {
            if verdict.is_some() {
                return Need::Valid;
            }
            let (window, grid) = (known.window, Arc::clone(&known.grid));
            let (branches, time) = (known.branches.clone(), known.time);
            let (model, equations) = (Arc::clone(model), Arc::clone(equations));
            let system = Arc::clone(present.physics.system);
            return Need::Job(Job::new("verdict", move |progress| {
                let mut equations = (*equations).clone();
                equations.pool.set_cancel(progress.token().clone());
                // what holds at some values of the parameters only is said of those that they have
                let mut model = (*model).clone();
                let values = model.parameters.iter_mut().zip(&parameters);
                values.for_each(|(parameter, &value)| parameter.value = value);
                let report = TransformationReport::named(&model, &mut equations, &name);
                let judged = MapVerdict::of(&model, &equations, report.as_ref());
                let system = system.with_cancel(progress.token().clone());
                let verdict = judged.beside_its_step((&model, &mut equations, &system), &name);
                let verdict = Some(verdict);
                let (parameters, grid) = (parameters.clone(), Arc::clone(&grid));
                Answer::new(Mapped {
                    parameters,
                    time,
                    window,
                    grid,
                    branches: branches.clone(),
                    verdict,
                })
            }));
        }
        let window = wanted.map(|window| {
            window.map(|[lo, hi]| {
                let margin = MARGIN * if hi > lo { hi - lo } else { lo.abs().max(1.0) };
                [lo - margin, hi + margin]
            })
        });
        let (model, equations) = (Arc::clone(model), Arc::clone(equations));
        let (at, written) = (with_image(plot, present), old.map(|(images, _)| images));
        let period = |axis| present.physics.system.period(plot.column(axis)?, present.parameters);
        let (periods, time) = ([period(0), period(1)], present.time);
        Need::Job(Job::new("grid", move |progress| {
            let axes = axes.zip(window).map(|(old, window)| (old.map(|(s, _)| s), window));
            let known = place.zip(axes).and_then(|(place, axes)| {
                let mut own = (*equations).clone();
                own.pool.set_cancel(progress.token().clone());
                let map = relations_of(&model, &mut own, place)?;
                // maps of several pairs one after the other have no plane of old variables
                if map.new.len() > 2 && model.coordinates.len() > 1 {
                    return None;
                }
                Branches::around((Arc::new(own), map), &at, (new, periods), axes)
            });
            let (solved, branches) = known.unzip();
            let grid = match (written, axes) {
                (Some(images), Some(old)) => grid::written(&equations.pool, &at, images, old),
                _ => solved.unwrap_or_default(),
            };
            Answer::new(Mapped {
                parameters: parameters.clone(),
                time: timed.then_some(time),
                window,
                grid: Arc::new(grid),
                branches: branches.map(Arc::new),
                verdict: verdict.clone(),
            })
        }))
    }
}

/// The values of all symbols now, those of the two new variables that are shown among them.
fn with_image(plot: &Plot, present: &Present<'_>) -> Valuation {
    let new = shown(plot, present.physics).map(|shown| shown.new).into_iter().flatten();
    let image = [0, 1].map(|axis| plot.column(axis).map_or(f64::NAN, |c| present.value(c)));
    present.valuation().with(new.zip(image))
}

fn of_image(plot: &Plot, present: &Present<'_>) -> &'static [&'static str] {
    let (Some(Shown { law, new }), Some(x), Some(y)) =
        (shown(plot, present.physics), plot.column(0), plot.column(1))
    else {
        return &[];
    };
    let solved = implicit(present.physics.equations, new).is_some();
    let exists = [x, y].into_iter().all(|channel| present.value(channel).is_finite());
    ImageOrigin { solved, exists }.lines(law)
}

/// The channels of the old variables of the pair that is shown, where the point is moved and not its coordinates.
fn moved(plot: &Plot, physics: Physics<'_>) -> Option<[usize; 2]> {
    let shown = shown(plot, physics).filter(|_| plot.viewport().is_some_and(|v| v.active))?;
    let pair = shown.law.new.iter().position(|new| *new == shown.new)?;
    Some([
        physics.channel(ChannelKind::Position(pair))?,
        physics.channel(ChannelKind::Momentum(pair))?,
    ])
}

/// What the motion and its image have reached along an axis.
fn both(plot: &Plot, present: &Present<'_>, old: usize, axis: usize) -> Option<[f64; 2]> {
    let of = |channel: usize| present.bounds.get(channel).copied();
    let (own, image) = (of(old)?, of(plot.column(axis)?)?);
    let (lo, hi) = (own.0.min(image.0), own.1.max(image.1));
    let margin = MARGIN * if hi > lo { hi - lo } else { lo.abs().max(1.0) };
    Some([lo - margin, hi + margin])
}

/// The point (q, p) of the motion and its image, in one plane, with the past of both.
fn active(
    PlotContext { plot, present, answer }: PlotContext<'_>,
    (old, new): ([usize; 2], [usize; 2]),
) -> Picture {
    let at = |channels: [usize; 2]| channels.map(|channel| present.value(channel));
    let (point, image) = (at(old), at(new));
    let faint = Stroke { ink: Ink::Level, covering: Some(0.5) };
    let [[q, p], [new_q, new_p]] = [old, new].map(|pair| pair.map(|c| present.physics.shown(c)));
    // few words, so that they hide neither point
    let verdict = judged(answer).and_then(|judged| judged.lines.first()?.split(": ").next());
    let mut lines = vec![format!("({q}, {p}) → ({new_q}, {new_p}), the ring")];
    lines.extend(verdict.map(str::to_owned));
    if !image.iter().all(|x| x.is_finite()) {
        lines.extend(of_image(plot, present).iter().map(|line| (*line).to_owned()));
    }
    let layers = vec![
        (TRAIL, Layer::Companions(new)),
        (TRAIL, Layer::Companions(old)),
        (TRAIL, Layer::RecentTrail(new, present.changed_at())),
        (TRAIL, Layer::Trail(old)),
        (GRID, Layer::Line(vec![point, image], faint)),
        (NOW, Layer::Point(image, MarkerShape::Ring, Ink::Warn)),
        (NOW, Layer::Point(point, MarkerShape::Disc, Ink::Accent)),
        (NOW, Layer::Legend(lines)),
    ];
    let upwards = Upwards::Channel(old[1], both(plot, present, old[1], 1));
    Picture::Axes { upwards, layers, occurrences: None }
}

fn mapped(answer: Option<&Answer>) -> Option<&Mapped> {
    answer?.of::<Mapped>()
}

fn judged(answer: Option<&Answer>) -> Option<&MapVerdict> {
    mapped(answer)?.verdict.as_ref()
}

/// The range of an axis: a turn, or what is shown of the grid, of the motion, and of other images.
fn range(
    plot: &Plot,
    present: &Present<'_>,
    (answer, images): (Option<&Answer>, &[[f64; 2]]),
    axis: usize,
) -> Option<[f64; 2]> {
    let turns = present.physics.system.period(plot.column(axis)?, present.parameters).is_some();
    let mapped = mapped(answer).filter(|_| !turns)?;
    let (lo, hi) = *present.bounds.get(plot.column(axis)?)?;
    let others = mapped.branches.as_deref().map_or(&[][..], |branches| &branches.lines);
    ShownCoordinates { own: &mapped.grid, others, images, reached: [lo, hi] }.range(axis)
}

/// The images of the moving point on other branches: to which their grids lead, and the others.
fn images(PlotContext { plot, present, answer }: PlotContext<'_>) -> OtherImages {
    let branches = mapped(answer).and_then(|mapped| mapped.branches.as_deref());
    branches.map_or_else(OtherImages::default, |b| b.images(&with_image(plot, present)))
}

impl Mapped {
    /// Whether the motion has not left the window of the grid.
    fn covers(&self, motion: Option<[[f64; 2]; 2]>) -> bool {
        match (self.window, motion) {
            (Some(window), Some(motion)) => {
                window.iter().zip(motion).all(|(w, m)| w[0] <= m[0] && m[1] <= w[1])
            }
            (None, None) => true,
            _ => false,
        }
    }
}

/// The transformation whose new variables a plot shows.
fn shown<'a>(plot: &Plot, physics: Physics<'a>) -> Option<Shown<'a>> {
    let name = |axis| Some(physics.system.channels().get(plot.column(axis)?)?.name.as_str());
    let (x, y) = (name(0)?, name(1)?);
    let model: &'a crate::model::Model = physics.model;
    model.transformations.iter().find_map(|law| {
        let of = |name: &str| {
            let mut all = law.new.iter().flatten();
            all.find(|&&s| model.new_variable_name(law, s) == name).copied()
        };
        Some(Shown { law, new: [of(x)?, of(y)?] })
    })
}
