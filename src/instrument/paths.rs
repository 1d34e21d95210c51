//! `paths`: every true path found between the ends of the motion, over the time, with its action and its Morse index.
//!
//! The ends are where the running motion began and where it is now. The job begins Newton's method from the straight line
//! between them with ε sin(kπs) added to one coordinate, s from 0 to 1 on the way, and collects the different paths that make
//! the action stationary. Never here: how such a path is found (`dynamics`), nor that there are no others.
//! Source: *The Principles of Dynamics*, §§ 1.4.1, 3.5.

use super::conditions::PlotConditions;
use super::path_so_far::{PathSoFar, duration, nothing_yet};
use super::{
    Across, Answer, Axis, Entry, Heading, Ink, Instrument, Layer, Level, MarkerShape, Measure,
    Need, Offer, Physics, Picture, Plot, PlotContext, Present, Properties, Upwards,
};
use crate::dynamics::{Lagrangian, PathKind, PhaseSpace, StationaryPath, stationary_path};
use crate::ensemble::SystemFlow;
use crate::integrate::Method;
use crate::job::{Job, Progress};
use crate::num::{math, significant};
use crate::system::{ChannelKind, System};

const OTHERS: Level = 1;
const OWN: Level = 2;
const NOW: Level = 3;

/// The half waves, and how far each is taken to either side, in the reach of the coordinate.
const HALF_WAVES: [f64; 2] = [1.0, 2.0];
const FAR: [f64; 3] = [0.5, 1.0, 2.0];

const POINTS: usize = 161;

/// Two paths are the same if they differ by less than this part of their reach everywhere.
const SAME: f64 = 1e-6;

/// The motion is the nearest of the paths, if it is no farther than so many times what its method is wrong by, and the next is
/// farther by this factor at least.
const OF_METHOD: f64 = 4.0;
const FARTHER: f64 = 8.0;

/// The most paths that are named in the corner.
const NAMED: usize = 5;

pub(super) struct PathsPlot;

struct ComputedPaths {
    path: PathSoFar,
    outcome: Result<Vec<TruePath>, String>,
}

/// A path that makes the action stationary.
struct TruePath {
    action: f64,
    index: usize,
    kind: PathKind,
    own: bool,
    /// The coordinate over the time.
    points: Vec<[f64; 2]>,
}

const PROPERTIES: Properties = Properties {
    name: "paths",
    written: &[Axis { heading: "Coordinate", coordinate: true, ..Axis::ACROSS }],
    measures: &[
        Measure::new("count", "how many true paths were found", |context| {
            let known = computed(context.answer)?.outcome.as_ref().ok()?;
            Some(known.len() as f64)
        }),
        Measure::new("least", "the least action of them", |context| {
            Some(found(context.answer).first()?.action)
        }),
        Measure::new("greatest", "the greatest action of them", |context| {
            Some(found(context.answer).last()?.action)
        }),
    ],
    ..Properties::PLAIN
};

impl Instrument for PathsPlot {
    fn properties(&self) -> &'static Properties {
        &PROPERTIES
    }

    fn offers(&self, physics: Physics<'_>) -> Vec<Offer> {
        let offer = |(index, channel): (usize, usize)| {
            Offer::new(
                format!("true paths of {}", physics.model.coordinates[index].shown),
                "all paths found between the ends of the motion, with their actions",
                vec![vec![channel]],
            )
        };
        physics.positions().map(offer).collect()
    }

    fn words(&self, plot: &Plot, physics: Physics<'_>) -> String {
        let name = plot.column(0).map_or("?", |channel| physics.shown(channel));
        format!("true paths of {name}")
    }

    fn heading(&self, plot: &Plot, present: &Present<'_>) -> Option<Heading> {
        let from = if present.changed.is_some() { "the last change" } else { "the start" };
        let entries = vec![Entry::Words(format!("between {from} and now"))];
        Some(plot.heading(present.physics, "True paths", entries))
    }

    fn across(&self, PlotContext { present, answer, .. }: PlotContext<'_>) -> Across {
        let begin = present.began();
        let span =
            |known: &ComputedPaths| [known.path.begin, known.path.begin + known.path.duration];
        let none = || [begin, begin + duration(present).unwrap_or(1.0)];
        let range = computed(answer).map_or_else(none, span);
        Across::Named("t".to_owned(), range)
    }

    fn awaits(&self, PlotContext { present, answer, .. }: PlotContext<'_>) -> Option<String> {
        let what = "All true paths from where the motion began to where it is, in the same time";
        match (nothing_yet(present), computed(answer).map(|known| &known.outcome)) {
            (Some(why), _) => Some(format!("{what}: {why}.{}", present.how_to_begin())),
            (None, None) => Some(format!("{what}. They are being computed.")),
            (None, Some(Err(why))) => Some(why.clone()),
            (None, Some(Ok(_))) => None,
        }
    }

    fn picture(&self, context: PlotContext<'_>, _seen: [f64; 2]) -> Option<Picture> {
        let PlotContext { plot, present, answer } = context;
        let column = plot.column(0)?;
        let mut layers = Vec::new();
        let mut ends = [f64::INFINITY, f64::NEG_INFINITY];
        let mut others = 0;
        for path in found(answer) {
            for point in &path.points {
                ends = [ends[0].min(point[1]), ends[1].max(point[1])];
            }
            let (level, ink) = if path.own {
                (OWN, Ink::Accent)
            } else {
                others += 1;
                (OTHERS, Ink::Curve(others))
            };
            layers.push((level, Layer::Line(path.points.clone(), ink.into())));
            let marks = [path.points.first(), path.points.last()].into_iter().flatten();
            layers.extend(marks.map(|&at| (NOW, Layer::Point(at, MarkerShape::Ring, Ink::Level))));
        }
        let lines = nothing_yet(present).map_or_else(|| lines(answer), |line| vec![line]);
        layers.push((NOW, Layer::Legend(lines)));
        let range = if ends[0] < ends[1] { ends } else { [-1.0, 1.0] };
        let name = present.physics.shown(column).to_owned();
        Some(Picture::Axes { upwards: Upwards::Named(name, range), layers, occurrences: None })
    }

    fn job(&self, PlotContext { plot, present, answer }: PlotContext<'_>) -> Need {
        let Physics { model, equations, system } = present.physics;
        let (Some(channel), Some((path, method))) = (plot.column(0), PathSoFar::of(plot, present))
        else {
            return Need::Nothing;
        };
        if computed(answer).is_some_and(|known| known.path == path) {
            return Need::Valid;
        }
        let reach = reach(present, channel);
        let (model, equations, system) = (model.clone(), equations.clone(), system.clone());
        Need::Job(Job::new("paths", move |progress: &Progress| {
            let system = system.with_cancel(progress.token().clone());
            let mut own = (*equations).clone();
            let PathSoFar { conditions, coordinate, begin, duration } = path.clone();
            let parameters = &conditions.parameters;
            let space = PhaseSpace::without_end((&model, &equations, &system), parameters);
            let outcome = space.map_err(|why| why.to_string()).and_then(|space| {
                if !space.is_hamiltonian() {
                    return Err("not stationary: forces act that have no potential".to_owned());
                }
                let lagrangian = Lagrangian::of(&model, &mut own, parameters);
                let lagrangian = lagrangian.map_err(|why| why.to_string())?;
                let lagrangian = lagrangian.beginning_at(begin);
                let mut lagrangian = lagrangian.with_cancel(progress.token().clone());
                let start = (begin, model.run.start);
                let of = (method, &conditions, start);
                let (motion, method_error) = motion(space.system(), of, duration)?;
                let way = Way { motion, method_error, coordinate, reach, begin, duration };
                Ok(way.paths(&mut lagrangian))
            });
            Answer::new(ComputedPaths { path: path.clone(), outcome })
        }))
    }
}

/// The motion between whose ends paths are searched for.
struct Way {
    /// The coordinates at evenly spaced times.
    motion: Vec<Vec<f64>>,
    /// How far they are from those of a motion without the errors of the method.
    method_error: f64,
    coordinate: usize,
    reach: f64,
    begin: f64,
    duration: f64,
}

impl Way {
    /// The different paths, that of the least action first.
    fn paths(&self, lagrangian: &mut Lagrangian) -> Vec<TruePath> {
        let mut known: Vec<StationaryPath> = Vec::new();
        let [from, to] = [&self.motion[0], &self.motion[POINTS - 1]];
        let amplitudes = FAR.into_iter().flat_map(|far| [far, -far]);
        let waves = HALF_WAVES.into_iter().flat_map(|k| amplitudes.clone().map(move |a| (k, a)));
        for (k, amplitude) in std::iter::once((1.0, 0.0)).chain(waves) {
            if lagrangian.is_cancelled() {
                break;
            }
            let guess = |t: f64| -> Vec<f64> {
                let s = t / self.duration;
                let straight = |(a, b): (&f64, &f64)| if s == 1.0 { *b } else { a + s * (b - a) };
                let mut at: Vec<f64> = from.iter().zip(to).map(straight).collect();
                if s > 0.0 && s < 1.0 {
                    let wave = math::sin(k * std::f64::consts::PI * s);
                    at[self.coordinate] += amplitude * self.reach * wave;
                }
                at
            };
            let found = stationary_path(lagrangian, &guess, self.duration).ok();
            known.extend(found.filter(|path| known.iter().all(|other| !self.same(path, other))));
        }
        let own = self.own(&known);
        let seen = known.iter().enumerate().map(|(i, path)| self.seen(path, Some(i) == own));
        let mut all: Vec<TruePath> = seen.collect();
        all.sort_by(|a, b| a.action.total_cmp(&b.action));
        all
    }

    fn times(&self) -> impl Iterator<Item = f64> + '_ {
        (0..POINTS).map(|k| self.duration * k as f64 / (POINTS - 1) as f64)
    }

    fn same(&self, path: &StationaryPath, other: &StationaryPath) -> bool {
        let n = self.motion[0].len();
        self.times().all(|t| self.near(&path.at(t)[..n], &other.at(t)[..n]))
    }

    fn near(&self, a: &[f64], b: &[f64]) -> bool {
        is_same(distance(a, b), self.reach)
    }

    /// Which of the paths the motion takes, up to what its method is wrong by.
    fn own(&self, known: &[StationaryPath]) -> Option<usize> {
        let n = self.motion[0].len();
        let away = |path: &StationaryPath| {
            let along = self.times().zip(&self.motion);
            along.map(|(t, at)| distance(&path.at(t)[..n], at)).fold(0.0, f64::max)
        };
        let mut nearest: Vec<(f64, usize)> = known.iter().map(away).zip(0..).collect();
        nearest.sort_by(|a, b| a.0.total_cmp(&b.0));
        let &(away, index) = nearest.first()?;
        let next = nearest.get(1).map_or(f64::INFINITY, |next| next.0);
        let is_own = is_same(away, self.reach) || is_of_method([away, next], self.method_error);
        is_own.then_some(index)
    }

    fn seen(&self, path: &StationaryPath, own: bool) -> TruePath {
        let points = self.times().map(|t| [self.begin + t, path.at(t)[self.coordinate]]).collect();
        TruePath { action: path.action, index: path.index, kind: path.kind, own, points }
    }
}

/// Whether places so far from each other are the same, beside the reach of the coordinate.
fn is_same(apart: f64, reach: f64) -> bool {
    apart <= SAME * reach
}

/// Whether a motion is on the nearer of two paths that are so far from it, up to what its method is wrong by.
fn is_of_method([away, next]: [f64; 2], method_error: f64) -> bool {
    away <= OF_METHOD * method_error && FARTHER * away <= next
}

/// The greatest difference of two places in a coordinate.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// The coordinates of the motion at evenly spaced times up to a duration, and how far its method leads it away.
fn motion(
    system: &System,
    (method, conditions, (begin, start)): (&'static Method, &PlotConditions, (f64, f64)),
    duration: f64,
) -> Result<(Vec<Vec<f64>>, f64), String> {
    let first = conditions.state(system, begin).map_err(|error| error.to_string())?;
    let (parameters, method) = (conditions.parameters.clone(), (method, conditions.settings));
    let flow = SystemFlow { system: system.clone(), method, parameters, start, effort: None };
    let position = |i| system.channels().iter().position(|c| c.kind == ChannelKind::Position(i));
    let channels: Option<Vec<usize>> = (0..system.degrees()).map(position).collect();
    let channels = channels.ok_or("the motion has no coordinates")?;
    let time = |k: usize| begin + duration * k as f64 / (POINTS - 1) as f64;
    let times: Vec<f64> = (0..POINTS).map(time).collect();
    let followed = |flow: &SystemFlow| {
        let carried = flow.carry(&first, &times, &channels);
        carried.end.map(|_| carried.seen)
    };
    let seen = followed(&flow).ok_or("the motion cannot be followed up to now")?;
    let exact = flow.by_default_method().and_then(|exact| followed(&exact)).unwrap_or_default();
    let away = exact.iter().zip(&seen).map(|(a, b)| distance(a, b)).fold(0.0, f64::max);
    Ok((seen, away))
}

/// How far a coordinate may be thought to go: a quarter turn, or what the motion has reached.
fn reach(present: &Present<'_>, channel: usize) -> f64 {
    if let Some(turn) = present.physics.system.period(channel, present.parameters) {
        return 0.25 * turn.abs();
    }
    let (low, high) = present.bounds.get(channel).copied().unwrap_or((0.0, 0.0));
    let reached = low.abs().max(high.abs());
    if reached.is_normal() { reached } else { 1.0 }
}

fn computed(answer: Option<&Answer>) -> Option<&ComputedPaths> {
    answer?.of::<ComputedPaths>()
}

fn found(answer: Option<&Answer>) -> &[TruePath] {
    computed(answer).and_then(|known| known.outcome.as_deref().ok()).unwrap_or(&[])
}

fn lines(answer: Option<&Answer>) -> Vec<String> {
    let all = match computed(answer).map(|known| &known.outcome) {
        None => return vec!["being computed".to_owned()],
        Some(Err(why)) => return vec![why.clone()],
        Some(Ok(all)) if all.is_empty() => return vec!["no true path was found".to_owned()],
        Some(Ok(all)) => all,
    };
    let until = computed(answer).map(|known| {
        let end =
            significant(known.path.begin + known.path.duration, 5, 1e-3..1e5).replace('-', "−");
        format!("up to t = {end}")
    });
    let since = computed(answer).and_then(|known| known.path.conditions.since());
    let mut lines: Vec<(String, usize)> = Vec::new();
    for path in all {
        let action = significant(path.action, 5, 1e-3..1e5).replace('-', "−");
        let nature = match path.kind {
            PathKind::Minimum => "least nearby".to_owned(),
            PathKind::Saddle => format!("Morse index {}", path.index),
            PathKind::Degenerate => "at a kinetic focus".to_owned(),
        };
        let own = if path.own { ", the motion" } else { "" };
        let line = format!("S = {action}, {nature}{own}");
        // a path and its mirror image have the same action
        match lines.iter_mut().find(|(known, _)| *known == line) {
            Some((_, count)) => *count += 1,
            None => lines.push((line, 1)),
        }
    }
    named(lines).into_iter().chain(until).chain(since).collect()
}

/// The first of several lines, with how many paths each stands for, and how many more there are.
fn named(lines: Vec<(String, usize)>) -> Vec<String> {
    let more = lines.len().saturating_sub(NAMED);
    let named = lines.into_iter().take(NAMED).map(|(line, count)| match count {
        1 => line,
        count => format!("{line} ({count} paths)"),
    });
    named.chain((more > 0).then(|| format!("and {more} more"))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn five_paths_are_named() {
        let lines = |count: usize| (0..count).map(|k| (format!("S = {k}"), 1 + k)).collect();
        assert_eq!(named(lines(5)).len(), 5);
        let all = named(lines(7));
        assert_eq!((all.len(), all[1].as_str()), (6, "S = 1 (2 paths)"));
        assert_eq!(all[5], "and 2 more");
    }

    #[test]
    fn paths_are_the_same_to_a_millionth_of_their_reach() {
        assert!(is_same(1.9e-6, 2.0) && !is_same(2.1e-6, 2.0));
    }

    #[test]
    fn a_motion_is_on_a_path_within_four_errors_of_its_method_if_the_next_is_eight_times_farther() {
        assert!(is_of_method([0.39, f64::INFINITY], 0.1));
        assert!(!is_of_method([0.41, f64::INFINITY], 0.1));
        assert!(is_of_method([0.1, 0.81], 0.1) && !is_of_method([0.1, 0.79], 0.1));
    }
}
