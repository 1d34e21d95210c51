//! `ensemble`: a cloud of starts around the motion carried by the flow, as a density in a plane of two of its variables,
//! and the closed curve around it with ∮ Σ p dq: constant where the motion is Hamilton's (Liouville, Poincaré), shrunk at
//! a known rate under friction that takes the same part of every momentum.
//!
//! The cloud is that of the moment at which it was begun: when the picture is first shown, and anew when a parameter, the
//! method or the initial values change. Its job carries it some time ahead, in parts, so that it is there when the motion
//! is.

use std::ops::ControlFlow;
use std::sync::Arc;

use super::equilibria::given;
use super::phase::initial_values;
use super::{
    Across, Answer, Axis, Entry, Heading, Ink, Instrument, Layer, Level, Measure, Need, NoStart,
    Offer, Physics, Picture, Plot, Present, Seed, Sign, Upwards,
};
use crate::dynamics::{PhaseSpace, conformal_rate};
use crate::ensemble::{Carried, Circulation, ClosedCurve, Flow, Start, in_order, spread};
use crate::integrate::{Settings, method_named};
use crate::job::{Job, Progress};
use crate::num::{math, significant};
use crate::system::{ChannelKind, Form, InitialOverride, State, System};

/// The levels of the picture.
const CLOUD: Level = 0;
const CURVE: Level = 2;
const NOW: Level = 4;

/// The starts of a cloud.
const COUNT: usize = 2000;

/// The frames that are computed in one part, and how many there are in a second of the wall clock at the file's own speed.
const FRAMES: usize = 32;
const RATE: f64 = 30.0;

/// Those of the first part, so that there is something to see soon.
const FIRST_FRAMES: usize = 4;

/// The size of a cloud: of its values, in a coordinate that is an angle, and where neither has a scale.
const OF_VALUE: f64 = 0.3;
const OF_TURN: f64 = 0.08;

/// What is beyond the extent of a cloud is this part of it.
const MARGIN: f64 = 0.08;

/// The states of a cloud that are looked at for the rate at which areas shrink.
const PROBES: usize = 16;

/// The row.
pub(super) struct Ensemble;

/// A cloud under way.
struct Swarm {
    conditions: Conditions,
    origin: Origin,
    /// The time of the motion when this part was asked for, and the time up to which the cloud is known.
    asked: f64,
    end: f64,
    frames: Vec<Frame>,
    /// Where the points are at the end.
    points: Vec<Option<State>>,
    curve: Option<ClosedCurve>,
    /// ∮ Σ p dq at the beginning.
    first: Option<Circulation>,
    /// The rate at which it changes, if that is known.
    rate: Option<f64>,
    /// The extent of all that was seen.
    extent: [[f64; 2]; 2],
    failure: Option<String>,
}

/// Where a cloud began.
#[derive(Clone)]
struct Origin {
    time: f64,
    /// The motion there.
    base: Vec<InitialOverride>,
    centre: [f64; 2],
    radii: [f64; 2],
    boxed: bool,
}

/// What is seen at one time.
#[derive(Clone)]
struct Frame {
    time: f64,
    cloud: Arc<Vec<[f64; 2]>>,
    curve: Arc<Vec<[f64; 2]>>,
    action: Option<Circulation>,
}

#[derive(Clone, PartialEq)]
struct Conditions {
    parameters: Vec<f64>,
    initial: Vec<f64>,
    method: &'static str,
    settings: Settings,
    seed: Option<Seed>,
}

impl Conditions {
    fn of(plot: &Plot, present: &Present<'_>) -> Self {
        Self {
            parameters: present.parameters.to_vec(),
            initial: present.initial.to_vec(),
            method: present.method,
            settings: present.settings,
            seed: plot.seeds.last().copied(),
        }
    }
}

impl Instrument for Ensemble {
    fn name(&self) -> &'static str {
        "ensemble"
    }

    fn written(&self) -> &'static [Axis] {
        &[Axis::ACROSS, Axis::UPWARDS]
    }

    fn takes_seeds(&self) -> bool {
        true
    }

    fn offers(&self, physics: Physics<'_>) -> Vec<Offer> {
        let rate = |i: usize| {
            let of = |kind| physics.channel(kind);
            of(ChannelKind::Momentum(i)).or_else(|| of(ChannelKind::Velocity(i)))
        };
        let pairs: Vec<(usize, usize)> = match physics.system.form() {
            // variables of brackets have no momenta
            Form::Variables => {
                let all: Vec<usize> = physics.positions().map(|(_, x)| x).collect();
                all.windows(2).map(|pair| (pair[0], pair[1])).collect()
            }
            _ => physics.positions().filter_map(|(i, x)| Some((x, rate(i)?))).collect(),
        };
        let offer = |(x, y): (usize, usize)| Offer {
            label: format!("ensemble: {} against {}", physics.shown(y), physics.shown(x)),
            about: "a cloud of starts carried by the flow, and ∮ p dq around it".to_owned(),
            columns: vec![vec![x], vec![y]],
            view: None,
        };
        pairs.into_iter().map(offer).collect()
    }

    fn words(&self, plot: &Plot, physics: Physics<'_>) -> String {
        let [x, y] = [0, 1].map(|k| plot.column(k).map_or("?", |channel| physics.shown(channel)));
        format!("ensemble, {y} against {x}")
    }

    fn heading(&self, plot: &Plot, present: &Present<'_>) -> Option<Heading> {
        let title = plot.title(present.physics);
        let of = |k| Some(Entry::Channel(plot.column(k)?));
        Some(Heading {
            title: title.unwrap_or("Ensemble").to_owned(),
            given: title.is_some(),
            entries: vec![of(0)?, of(1)?],
        })
    }

    fn across(&self, plot: &Plot, present: &Present<'_>, answer: Option<&Answer>) -> Across {
        let range = range(plot, present, answer, 0);
        plot.column(0).map_or(Across::Nothing, |x| Across::Channel(x, range))
    }

    fn picture(
        &self,
        plot: &Plot,
        present: &Present<'_>,
        _seen: [f64; 2],
        answer: Option<&Answer>,
    ) -> Option<Picture> {
        let channels = [plot.column(0)?, plot.column(1)?];
        let mut layers = Vec::new();
        if let Some(frame) = shown(present, answer) {
            layers.push((CLOUD, Layer::Cloud(Arc::clone(&frame.cloud))));
            layers.push((CURVE, Layer::Line(frame.curve.to_vec(), Ink::Curve(1).into())));
        }
        let now = channels.map(|channel| present.value(channel));
        layers.push((NOW, Layer::Point(now, Sign::Disc, Ink::Accent)));
        let upwards = Upwards::Annotated {
            channel: channels[1],
            range: range(plot, present, answer, 1),
            words: told(present, answer),
        };
        Some(Picture::Axes { upwards, layers, occurrences: None })
    }

    fn start(
        &self,
        plot: &Plot,
        present: &Present<'_>,
        at: [f64; 2],
    ) -> Result<Vec<InitialOverride>, NoStart> {
        initial_values(plot, present.physics, at).ok_or(NoStart::Nothing)
    }

    fn seed(&self, plot: &Plot, present: &Present<'_>, answer: Option<&Answer>) -> Option<Seed> {
        initial_values(plot, present.physics, [0.0; 2])?;
        let viewport = plot.viewport()?;
        let window = [range(plot, present, answer, 0)?, range(plot, present, answer, 1)?];
        Some(Seed::Spread([0, 1].map(|axis| {
            let [from, to] = window[axis];
            let half = (to - from) / viewport.zoom[axis] / 2.0;
            let middle = f64::midpoint(from, to) + viewport.pan[axis] * 2.0 * half;
            [middle - half, middle + half]
        })))
    }

    fn job(&self, plot: &Plot, present: &Present<'_>, answer: Option<&Answer>) -> Need {
        let Physics { model, equations, system } = present.physics;
        if !model.constraints.is_empty()
            || initial_values(plot, present.physics, [0.0; 2]).is_none()
        {
            return Need::Nothing;
        }
        let Some(method) = method_named(present.method) else { return Need::Nothing };
        let conditions = Conditions::of(plot, present);
        let known = swarm(answer)
            .filter(|known| known.conditions == conditions && known.origin.time <= present.time);
        if known.is_some_and(|known| known.holds(present.time)) {
            return Need::Held;
        }
        let origin = match known {
            Some(known) => known.origin.clone(),
            None => match Origin::of(plot, present, conditions.seed) {
                Some(origin) => origin,
                None => return Need::Nothing,
            },
        };
        let task = Task {
            plot: plot.clone(),
            model: Arc::clone(model),
            equations: Arc::clone(equations),
            system: Arc::clone(system),
            method: (method, present.settings),
            conditions,
            origin,
            now: present.time,
            // what was known beyond the present time is gone on from
            known: answer.filter(|_| known.is_some_and(|known| known.began(present.time))).cloned(),
        };
        let job = Job::new("cloud", move |progress| Answer::new(task.swarm(progress)));
        // what a person asks for is computed in any case
        if plot.seeds.is_empty() { Need::Addition(job) } else { Need::Job(job) }
    }

    fn measures(&self) -> &'static [Measure] {
        &[
            Measure {
                word: "points",
                about: "how many points of the cloud are there",
                value: |_, present, answer| {
                    let cloud = &shown(present, answer)?.cloud;
                    Some(cloud.iter().filter(|at| at[0].is_finite()).count() as f64)
                },
            },
            Measure {
                word: "action",
                about: "∮ p dq around the cloud: its area, for one degree of freedom",
                value: |_, present, answer| Some(shown(present, answer)?.action?.value.abs()),
            },
            Measure {
                word: "expected",
                about: "the same as the law of motion predicts it from the beginning",
                value: |_, present, answer| expected(present, answer).map(f64::abs),
            },
            Measure {
                word: "off",
                about: "how far the two are apart, as a part of what is expected",
                value: |_, present, answer| off(present, answer),
            },
            Measure {
                word: "rate",
                about: "the rate at which it is expected to grow: 0 without friction",
                value: |_, _, answer| swarm(answer)?.rate,
            },
        ]
    }
}

impl Swarm {
    /// Whether the motion at this time has all that a picture needs for some time.
    fn holds(&self, now: f64) -> bool {
        let beyond = self.end - now;
        self.failure.is_some() || self.began(now) && beyond > 0.5 * (self.end - self.asked)
    }

    /// Whether it is known from this time on.
    fn began(&self, now: f64) -> bool {
        self.frames.first().is_some_and(|frame| frame.time <= now)
    }
}

impl Origin {
    /// A cloud around the motion, or around what was chosen.
    fn of(plot: &Plot, present: &Present<'_>, seed: Option<Seed>) -> Option<Self> {
        let physics = present.physics;
        let base = given(physics, |channel| present.value(channel));
        let channels = [plot.column(0)?, plot.column(1)?];
        let own = channels.map(|channel| present.value(channel));
        let origin = Self {
            time: present.time,
            base,
            centre: own,
            radii: [1.0; 2],
            boxed: matches!(seed, Some(Seed::Spread(_))),
        };
        Some(match seed {
            Some(Seed::Spread(window)) => Self {
                centre: window.map(|[from, to]| f64::midpoint(from, to)),
                radii: window.map(|[from, to]| (to - from) / 2.0),
                ..origin
            },
            Some(Seed::Through(at)) => {
                Self { radii: radii(&origin, plot, present, channels), centre: at, ..origin }
            }
            None => Self { radii: radii(&origin, plot, present, channels), ..origin },
        })
    }

    /// The state of the motion with two of its values replaced.
    fn state(
        &self,
        at: [f64; 2],
        plot: &Plot,
        physics: Physics<'_>,
        parameters: &[f64],
    ) -> Option<State> {
        let (time, parameters) = (self.time, parameters.to_vec());
        let mut start = Start { time, parameters, overrides: self.base.clone() };
        for given in initial_values(plot, physics, at)? {
            start.replace(given);
        }
        start.state(physics.system).ok()
    }

    /// The point of the closed curve at s, counter-clockwise.
    fn boundary(&self, s: f64) -> [f64; 2] {
        let at = if self.boxed {
            let (side, along) = ((4.0 * s).floor(), 2.0 * (4.0 * s).fract() - 1.0);
            match side as u8 {
                0 => [along, -1.0],
                1 => [1.0, along],
                2 => [-along, 1.0],
                _ => [-1.0, -along],
            }
        } else {
            let (sin, cos) = math::sin_cos(std::f64::consts::TAU * s);
            [cos, sin]
        };
        self.placed(at)
    }

    /// Points within it, evenly.
    fn inside(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        let within = |at: &[f64; 2]| self.boxed || at[0] * at[0] + at[1] * at[1] <= 1.0;
        let all = (0..).map(|index| spread(index, [[-1.0, 1.0]; 2])).filter(within);
        all.take(COUNT).map(|at| self.placed(at))
    }

    fn placed(&self, at: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|k| self.centre[k] + self.radii[k] * at[k])
    }
}

/// The size of a cloud in both directions: by the coordinate, and by how much as much energy changes the other.
fn radii(origin: &Origin, plot: &Plot, present: &Present<'_>, channels: [usize; 2]) -> [f64; 2] {
    let physics = present.physics;
    let sized = |k: usize| {
        let (lo, hi) = present.bounds.get(channels[k]).copied().unwrap_or_default();
        let range = Some(OF_VALUE * (hi - lo) / 2.0).filter(|r| r.is_finite() && *r > 0.0);
        let value = Some(OF_VALUE * origin.centre[k].abs()).filter(|r| *r > 0.0);
        let period = physics.system.period(channels[k], present.parameters);
        (period.map(|period| OF_TURN * period), range, value)
    };
    let (turn, range, value) = sized(0);
    let across = turn.or(value).or(range).unwrap_or(OF_VALUE);
    let energy = |by: [f64; 2]| {
        let at = [0, 1].map(|k| origin.centre[k] + by[k]);
        let state = origin.state(at, plot, physics, present.parameters)?;
        physics.system.energy(&state, present.parameters).ok()
    };
    let curvature = |axis: usize, by: f64| {
        let mut to = [0.0; 2];
        to[axis] = by;
        let from = to.map(|x| -x);
        Some((energy(to)? - 2.0 * energy([0.0; 2])? + energy(from)?).abs() / (by * by))
    };
    let (_, wide, high) = sized(1);
    let alike = || {
        let step = 1e-3 * across;
        let ratio = curvature(0, step)? / curvature(1, step)?;
        Some(across * ratio.sqrt()).filter(|r| r.is_finite() && *r > 0.0)
    };
    [across, alike().or(wide).or(high).unwrap_or(across)]
}

/// What a job computes: a cloud from its beginning, or from where it was left.
struct Task {
    plot: Plot,
    model: Arc<crate::model::Model>,
    equations: Arc<crate::mechanics::Equations>,
    system: Arc<System>,
    method: (&'static crate::integrate::Method, Settings),
    conditions: Conditions,
    origin: Origin,
    now: f64,
    known: Option<Answer>,
}

impl Task {
    fn physics(&self) -> Physics<'_> {
        Physics { model: &self.model, equations: &self.equations, system: &self.system }
    }

    /// The next part, about twice as long as the motion took since the last was asked for.
    fn swarm(&self, progress: &Progress) -> Swarm {
        let parameters = &self.conditions.parameters;
        let system = self.system.with_cancel(progress.token().clone());
        let flow = Flow {
            system,
            method: self.method,
            parameters: parameters.clone(),
            start: self.model.run.start,
        };
        let flow = match self.state(self.origin.centre) {
            Some(centre) => flow.settled(&centre),
            None => flow,
        };
        let known = self.known.as_ref().and_then(Answer::of::<Swarm>);
        let speed = Some(self.model.run.speed).filter(|s| s.is_finite() && *s > 0.0);
        let least = FRAMES as f64 * speed.unwrap_or(1.0) / RATE;
        let passed = known.map_or(0.0, |known| self.now - known.asked);
        let spacing = (2.0 * passed).max(least) / FRAMES as f64;
        let first = match known {
            Some(known) if known.end > self.now => known.end + spacing,
            _ => self.now,
        };
        let frames = if known.is_some() { FRAMES } else { FIRST_FRAMES };
        let times: Vec<f64> = (0..frames).map(|k| first + k as f64 * spacing).collect();
        let points = match known {
            Some(known) => known.points.clone(),
            None => self.origin.inside().map(|at| self.state(at)).collect(),
        };
        let mut carried: Vec<Carried> = Vec::with_capacity(points.len());
        progress.expect(points.len() as u64);
        let axes = self.axes();
        let one = |i: usize| {
            let from = points[i].as_ref();
            from.map_or_else(Carried::default, |from| flow.carry(from, &times, &axes))
        };
        let threads = in_order(0, points.len(), progress.token(), one, |i, result| {
            progress.reach(i as u64);
            carried.push(result);
            ControlFlow::Continue(())
        });
        let start = |s: f64| self.state(self.origin.boundary(s));
        let mut curve = match known {
            Some(known) => known.curve.clone(),
            None => self.channels().and_then(|all| ClosedCurve::new(&start, all, self.scales())),
        };
        let mut failure = threads.err().map(|why| why.to_string());
        if let Some(curve) = &mut curve
            && let Err(why) = curve.carry(&flow, &times, &start)
        {
            failure = Some(why.to_string());
        }
        let frame = |(k, &time): (usize, &f64)| {
            let at = |one: &Carried| one.seen.get(k).map_or([f64::NAN; 2], |row| [row[0], row[1]]);
            Frame {
                time,
                cloud: Arc::new(carried.iter().map(at).collect()),
                curve: Arc::new(curve.as_ref().map_or_else(Vec::new, |curve| curve.points(k))),
                action: curve.as_ref().and_then(|curve| curve.circulation(k)),
            }
        };
        let new: Vec<Frame> = times.iter().enumerate().map(frame).collect();
        let extent = extent(known.map(|known| known.extent), &new);
        let known_frames = known.map_or(&[][..], |known| &known.frames);
        let seen = known_frames.iter().rposition(|frame| frame.time <= self.now).unwrap_or(0);
        let old = known_frames.iter().skip(seen).filter(|frame| frame.time < first).cloned();
        Swarm {
            conditions: self.conditions.clone(),
            origin: self.origin.clone(),
            asked: self.now,
            end: times.last().copied().unwrap_or(self.now),
            frames: old.chain(new).collect(),
            points: carried.into_iter().map(|one| one.end).collect(),
            first: known.map_or_else(|| self.first(&start), |known| known.first),
            rate: known.map_or_else(|| self.rate(&points), |known| known.rate),
            curve,
            extent,
            failure,
        }
    }

    fn state(&self, at: [f64; 2]) -> Option<State> {
        self.origin.state(at, &self.plot, self.physics(), &self.conditions.parameters)
    }

    fn axes(&self) -> Vec<usize> {
        [0, 1].into_iter().filter_map(|k| self.plot.column(k)).collect()
    }

    /// The periods of the two quantities.
    fn scales(&self) -> [f64; 2] {
        [0, 1].map(|k| {
            let channel = self.plot.column(k);
            let period = channel.and_then(|c| self.system.period(c, &self.conditions.parameters));
            period.unwrap_or(f64::INFINITY)
        })
    }

    /// The two quantities, the coordinates, the momenta; without momenta there is no integral.
    fn channels(&self) -> Option<Vec<usize>> {
        let physics = self.physics();
        let degrees = 0..self.system.degrees();
        let kinds = degrees.clone().map(ChannelKind::Position);
        let kinds = kinds.chain(degrees.map(ChannelKind::Momentum));
        let pairs: Vec<usize> = kinds.map(|kind| physics.channel(kind)).collect::<Option<_>>()?;
        Some([self.axes(), pairs].concat())
    }

    /// The integral around the curve where it began.
    fn first(&self, start: &(dyn Fn(f64) -> Option<State> + Sync)) -> Option<Circulation> {
        let mut curve = ClosedCurve::new(start, self.channels()?, self.scales())?;
        let flow = Flow {
            system: System::clone(&self.system),
            method: self.method,
            parameters: self.conditions.parameters.clone(),
            start: self.model.run.start,
        };
        curve.carry(&flow, &[self.origin.time], start).ok()?;
        curve.circulation(0)
    }

    /// The rate at which the integral changes, where it is one number.
    fn rate(&self, points: &[Option<State>]) -> Option<f64> {
        let parameters = &self.conditions.parameters;
        let space = PhaseSpace::of(&self.model, &self.equations, &self.system, parameters);
        let space = space.ok()?;
        let states: Vec<State> = points
            .iter()
            .flatten()
            .step_by((COUNT / PROBES).max(1))
            .filter_map(|state| space.state(state).ok())
            .collect();
        let variables = states.iter().map(|state| space.variables(state));
        conformal_rate(&space, self.origin.time, variables).ok()?
    }
}

/// The extent of all that was seen, with what is in these frames.
fn extent(known: Option<[[f64; 2]; 2]>, frames: &[Frame]) -> [[f64; 2]; 2] {
    let mut extent = known.unwrap_or([[f64::INFINITY, f64::NEG_INFINITY]; 2]);
    for frame in frames {
        for at in frame.cloud.iter().chain(frame.curve.iter()) {
            for (ends, x) in extent.iter_mut().zip(at) {
                *ends = [ends[0].min(*x), ends[1].max(*x)];
            }
        }
    }
    extent
}

fn swarm(answer: Option<&Answer>) -> Option<&Swarm> {
    answer?.of::<Swarm>()
}

/// The frame that is shown: the last that is not later than the motion.
fn shown<'a>(present: &Present<'_>, answer: Option<&'a Answer>) -> Option<&'a Frame> {
    let swarm = swarm(answer)?;
    let before = swarm.frames.iter().rfind(|frame| frame.time <= present.time);
    before.or_else(|| swarm.frames.first())
}

/// ∮ Σ p dq as it is expected.
fn expected(present: &Present<'_>, answer: Option<&Answer>) -> Option<f64> {
    let (swarm, frame) = (swarm(answer)?, shown(present, answer)?);
    let since = frame.time - swarm.origin.time;
    Some(swarm.first?.value * math::exp(swarm.rate? * since))
}

/// How far it is from that.
fn off(present: &Present<'_>, answer: Option<&Answer>) -> Option<f64> {
    let (expected, action) = (expected(present, answer)?, shown(present, answer)?.action?);
    Some(((action.value - expected) / expected).abs()).filter(|off| off.is_finite())
}

/// The integral in words, beside what is expected.
fn told(present: &Present<'_>, answer: Option<&Answer>) -> String {
    let Some(swarm) = swarm(answer) else { return String::new() };
    if let Some(why) = &swarm.failure {
        return why.clone();
    }
    let short = |x: f64| significant(x, 4, 1e-3..1e5).replace('-', "−");
    let Some(frame) = shown(present, answer) else { return String::new() };
    let Some(action) = frame.action else {
        return match &swarm.curve {
            None => String::new(),
            Some(curve) if curve.is_whole() => "∮ p dq: stretched too far to be known".to_owned(),
            Some(_) => "∮ p dq: a part of the curve is lost".to_owned(),
        };
    };
    // behind a motion that is faster than it can be carried
    let spacing = swarm.frames.windows(2).next().map_or(0.0, |pair| pair[1].time - pair[0].time);
    let late = present.time - frame.time > 2.0 * spacing;
    let at = if late { format!(" at t = {}", short(frame.time)) } else { String::new() };
    let value = format!("∮ p dq {}{at}", short(action.value.abs()));
    match (swarm.rate, off(present, answer)) {
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

/// The range of an axis: of all that was seen of the cloud, or a turn.
fn range(
    plot: &Plot,
    present: &Present<'_>,
    answer: Option<&Answer>,
    axis: usize,
) -> Option<[f64; 2]> {
    let channel = plot.column(axis)?;
    let [lo, hi] = swarm(answer)?.extent[axis];
    if !(lo < hi && lo.is_finite() && hi.is_finite()) {
        return None;
    }
    let margin = MARGIN * (hi - lo);
    let [lo, hi] = [lo - margin, hi + margin];
    match present.physics.system.period(channel, present.parameters) {
        Some(period) if lo < -period / 2.0 || hi > period / 2.0 => {
            Some([-period / 2.0, period / 2.0])
        }
        _ => Some([lo, hi]),
    }
}
