//! A cloud under way: its points, the closed curve around it, and the job that carries both on, in parts.
//!
//! In: an [`CloudOrigin`], or a [`Cloud`] that was carried so far. Out: the next [`Cloud`]. Never here: how it is drawn.

use std::sync::Arc;

use super::super::conditions::PlotConditions;
use super::super::{Answer, Physics, Plot};
use super::frame::{CloudFrame, extent};
use super::leg::CloudLeg;
use super::origin::CloudOrigin;
use crate::dynamics::{PhaseSpace, conformal_rate};
use crate::ensemble::{Carried, Circulation, ClosedCurve, SystemFlow};
use crate::integrate::{Method, Settings, Stepping};
use crate::job::Progress;
use crate::mechanics::Equations;
use crate::model::Model;
use crate::system::{ChannelKind, State, System};

/// The starts of a cloud.
const COUNT: usize = 2000;

/// The frames that are computed in one part, and how many there are in a second of the wall clock at the file's own speed.
const FRAMES: usize = 32;
const RATE: f64 = 30.0;

/// Those of the first part, so that there is something to see soon.
const FIRST_FRAMES: usize = 4;

/// The most steps of a point for each second of the wall clock at the file's own speed. One that comes so close to a
/// collision, or to infinity in a finite time, that it takes more would hold up all others, and is given up.
const EFFORT: f64 = 1000.0;

/// The states of a cloud that are evaluated for the rate at which areas shrink.
const PROBES: usize = 16;

/// A cloud under way.
pub(super) struct Cloud {
    pub(super) conditions: PlotConditions,
    pub(super) origin: CloudOrigin,
    /// The time of the motion when this part was asked for, and the time up to which the cloud is known.
    asked: f64,
    pub(super) end: f64,
    pub(super) frames: Vec<CloudFrame>,
    /// The time between the newest frames.
    pub(super) spacing: f64,
    /// The ends of the parts so far, from the last that nothing earlier is shown of: from these it can be carried on.
    stages: Vec<Arc<CloudStage>>,
    /// ∮ Σ p dq at the beginning.
    pub(super) first: Option<Circulation>,
    /// The rate at which it changes, if that is known.
    pub(super) rate: Option<f64>,
    /// The extent of the bulk in all that was seen.
    pub(super) extent: [[f64; 2]; 2],
    pub(super) error: Option<String>,
    /// The methods by which it was carried before that of now.
    pub(super) legs: Vec<CloudLeg>,
}

/// Where a cloud is at one time, to be carried on from.
struct CloudStage {
    time: f64,
    points: Vec<Option<State>>,
    /// The motion that they were spread around.
    own: Option<State>,
    curve: Option<ClosedCurve>,
}

impl Cloud {
    /// Whether the motion at this time has all that a picture needs for some time.
    pub(super) fn holds(&self, now: f64) -> bool {
        let beyond = self.end - now;
        self.error.is_some() || self.began(now) && beyond > 0.5 * (self.end - self.asked)
    }

    pub(super) fn began(&self, now: f64) -> bool {
        self.frames.first().is_some_and(|frame| frame.time <= now)
    }

    /// Whether there is a frame at this very time.
    pub(super) fn is_at(&self, now: f64) -> bool {
        self.error.is_some() || self.frames.iter().any(|frame| frame.time == now)
    }

    /// The closed curve at the end, if there is one.
    pub(super) fn curve(&self) -> Option<&ClosedCurve> {
        self.stages.last()?.curve.as_ref()
    }
}

/// What a job computes: a cloud from its beginning, or from where it was left.
pub(super) struct CloudTask {
    pub(super) plot: Plot,
    /// The plane in which the starts are spread.
    pub(super) starts: Plot,
    pub(super) model: Arc<Model>,
    pub(super) equations: Arc<Equations>,
    pub(super) system: Arc<System>,
    pub(super) method: (&'static Method, Settings),
    pub(super) conditions: PlotConditions,
    pub(super) origin: CloudOrigin,
    pub(super) legs: Vec<CloudLeg>,
    pub(super) now: f64,
    /// The time of what is shown, which is earlier where clouds are behind the motion.
    pub(super) shown: f64,
    pub(super) known: Option<Answer>,
}

impl CloudTask {
    fn physics(&self) -> Physics<'_> {
        Physics { model: &self.model, equations: &self.equations, system: &self.system }
    }

    /// What is wanted of a cloud: the next part, or the frame of this very time where time does not run.
    pub(super) fn run(&self, progress: &Progress) -> Cloud {
        let known = self.known.as_ref().and_then(Answer::of::<Cloud>);
        match known {
            Some(known) if known.conditions != self.conditions => {
                self.next(Some(&self.up_to_here(known)), progress)
            }
            Some(known) if known.holds(self.now) => self.exact(known, progress),
            _ => self.next(known, progress),
        }
    }

    /// A cloud that another method carries on: what is known of it up to where that took over.
    fn up_to_here(&self, known: &Cloud) -> Cloud {
        let until = self.legs.last().map_or(self.origin.time, |leg| leg.until);
        let stages = known.stages.iter().filter(|stage| stage.time <= until).cloned().collect();
        let frames = known.frames.iter().filter(|frame| frame.time <= until).cloned().collect();
        Cloud {
            conditions: self.conditions.clone(),
            origin: known.origin.clone(),
            asked: known.asked,
            end: known.end.min(until),
            frames,
            spacing: known.spacing,
            stages,
            first: known.first,
            rate: known.rate,
            extent: known.extent,
            error: None,
            legs: self.legs.clone(),
        }
    }

    /// The methods in their order, each with the time up to which it carries the cloud.
    fn methods(&self) -> Vec<CloudLeg> {
        let now = CloudLeg { until: f64::INFINITY, method: self.method };
        self.legs.iter().cloned().chain([now]).collect()
    }

    /// The shortest time of a part.
    fn least(&self) -> f64 {
        let speed = Some(self.model.run.speed).filter(|s| s.is_finite() && *s > 0.0);
        FRAMES as f64 * speed.unwrap_or(1.0) / RATE
    }

    fn flow(&self, method: (&'static Method, Settings), progress: &Progress) -> SystemFlow {
        let flow = SystemFlow {
            system: self.system.with_cancel(progress.token().clone()),
            method,
            parameters: self.conditions.parameters.clone(),
            start: self.model.run.start,
            effort: None,
        };
        match self.state(self.origin.centre) {
            Some(centre) => flow.settled(&centre).fast(),
            None => flow.fast(),
        }
    }

    /// The next part, about twice as long as the motion took since the last was asked for.
    fn next(&self, known: Option<&Cloud>, progress: &Progress) -> Cloud {
        let passed = known.map_or(0.0, |known| self.now - known.asked);
        let spacing = frame_spacing(passed, self.least());
        // clouds of the same beginning have frames at the same times
        let place = |time: f64| ((time - self.origin.time) / spacing + 1e-6).floor();
        let place =
            known.map_or(place(self.now), |known| place(self.now).max(place(known.end) + 1.0));
        let first = self.origin.time + place * spacing;
        let frames = if known.is_some() { FRAMES } else { FIRST_FRAMES };
        let times: Vec<f64> = (0..frames).map(|k| first + k as f64 * spacing).collect();
        let mut stages = known.map_or_else(Vec::new, |known| known.stages.clone());
        let begin = stages.last().map_or_else(|| Arc::new(self.beginning()), Arc::clone);
        if stages.is_empty() {
            stages.push(Arc::clone(&begin));
        }
        let (end, new, error) = self.carry(&begin, &times, progress);
        let known_frames = known.map_or(&[][..], |known| &known.frames);
        let seen = known_frames.iter().rposition(|frame| frame.time <= self.shown).unwrap_or(0);
        let old = known_frames.iter().skip(seen).filter(|frame| frame.time < first).cloned();
        let extent = extent(known.map(|known| known.extent), &new);
        let frames: Vec<CloudFrame> = old.chain(new).collect();
        // what was before all that is shown is not begun at again
        let earliest = frames.first().map_or(first, |frame| frame.time);
        let needed = stages.iter().rposition(|stage| stage.time <= earliest).unwrap_or(0);
        stages.drain(..needed);
        stages.push(end);
        let start = |s: f64| self.state(self.origin.boundary(s));
        Cloud {
            conditions: self.conditions.clone(),
            origin: self.origin.clone(),
            asked: self.now,
            end: times.last().copied().unwrap_or(self.now),
            frames,
            spacing,
            first: match known {
                Some(known) => known.first,
                None if !self.origin.has_boundary() => None,
                None => self.first(&start),
            },
            rate: known.map_or_else(|| self.rate(&begin.points), |known| known.rate),
            stages,
            extent,
            error,
            legs: self.legs.clone(),
        }
    }

    /// The same cloud with a frame at this very time.
    fn exact(&self, known: &Cloud, progress: &Progress) -> Cloud {
        let before = known.stages.iter().rfind(|stage| stage.time <= self.now);
        let begin = before.map_or_else(|| Arc::new(self.beginning()), Arc::clone);
        let (_, new, error) = self.carry(&begin, &[self.now], progress);
        let mut frames = known.frames.clone();
        frames.extend(new);
        frames.sort_by(|a, b| a.time.total_cmp(&b.time));
        Cloud {
            conditions: known.conditions.clone(),
            origin: known.origin.clone(),
            asked: known.asked,
            end: known.end,
            extent: extent(Some(known.extent), &frames),
            frames,
            spacing: known.spacing,
            stages: known.stages.clone(),
            first: known.first,
            rate: known.rate,
            error,
            legs: self.legs.clone(),
        }
    }

    fn beginning(&self) -> CloudStage {
        let parameters = &self.conditions.parameters;
        let start = |s: f64| self.state(self.origin.boundary(s));
        let curve = || self.channels().and_then(|all| ClosedCurve::new(&start, all, self.scales()));
        CloudStage {
            time: self.origin.time,
            points: self.origin.states(COUNT, &self.starts, self.physics(), parameters),
            own: self.origin.own(self.physics(), parameters),
            curve: if self.origin.has_boundary() { curve() } else { None },
        }
    }

    /// A cloud carried on through these times, by each method as far as that goes: where it is then, what is seen of it, and
    /// what failed.
    fn carry(
        &self,
        begin: &Arc<CloudStage>,
        times: &[f64],
        progress: &Progress,
    ) -> (Arc<CloudStage>, Vec<CloudFrame>, Option<String>) {
        let (mut here, mut frames) = (Arc::clone(begin), Vec::new());
        let last = times.last().copied().unwrap_or(begin.time);
        for (number, leg) in self.methods().iter().enumerate() {
            let seen = frames.len();
            let within = times[seen..].iter().copied().take_while(|&time| time <= leg.until);
            let mut part: Vec<f64> = within.collect();
            let count = part.len();
            if leg.until < last && leg.until > here.time && part.last() != Some(&leg.until) {
                part.push(leg.until);
            }
            if part.is_empty() {
                continue;
            }
            let (end, new, error) = self.carry_by((number, leg), &here, &part, progress);
            here = Arc::new(end);
            frames.extend(new.into_iter().take(count));
            if error.is_some() {
                return (here, frames, error);
            }
        }
        (here, frames, None)
    }

    /// The start of the curve at s where a method took over: carried there by those before it.
    fn start(&self, s: f64, before: &[(f64, SystemFlow)]) -> Option<State> {
        let state = self.state(self.origin.boundary(s))?;
        before.iter().try_fold(state, |state, (until, flow)| flow.carry(&state, &[*until], &[]).end)
    }

    /// The same by one method.
    fn carry_by(
        &self,
        (number, leg): (usize, &CloudLeg),
        begin: &CloudStage,
        times: &[f64],
        progress: &Progress,
    ) -> (CloudStage, Vec<CloudFrame>, Option<String>) {
        let mut flow = self.flow(leg.method, progress);
        let before: Vec<(f64, SystemFlow)> = self.legs[..number]
            .iter()
            .map(|leg| (leg.until, self.flow(leg.method, progress)))
            .collect();
        let least = self.least();
        let end = times.last().copied().unwrap_or(begin.time);
        let seconds = |from: f64| (end - from) / least * FRAMES as f64 / RATE;
        flow.effort = effort(leg.method.0, seconds(begin.time));
        let count = begin.points.len() as u64;
        let on_curve = begin.curve.as_ref().map_or(0, |curve| curve.len() as u64);
        // one more for what is left to do at the end
        progress.expect(count + on_curve + 1);
        let from: Vec<Option<&State>> = begin.points.iter().map(Option::as_ref).collect();
        let outcome = flow.carry_all(&from, times, &self.axes(), |done| progress.reach(done));
        let (carried, mut error) = match outcome {
            Ok(carried) => (carried, None),
            Err(why) => (Vec::new(), Some(why.to_string())),
        };
        let own = begin.own.as_ref();
        let own = own.map_or_else(Carried::default, |own| flow.carry(own, times, &self.axes()));
        let start = |s: f64| self.start(s, &before);
        // starts that are put between others come from the beginning
        flow.effort = effort(leg.method.0, seconds(self.origin.time));
        let mut curve = begin.curve.clone();
        let mut report = |done: Option<u64>| match done {
            Some(done) => progress.reach(count + done),
            None => progress.expect(0),
        };
        if let Some(curve) = &mut curve
            && let Err(why) = curve.carry_reporting(&flow, times, &start, &mut report)
        {
            error = Some(why.to_string());
        }
        let frame = |(k, &time): (usize, &f64)| {
            let at = |one: &Carried| match one.seen.get(k).map(Vec::as_slice) {
                Some(&[x, y]) => [x, y],
                _ => [f64::NAN; 2],
            };
            CloudFrame {
                time,
                cloud: Arc::new(carried.iter().map(at).collect()),
                curve: Arc::new(curve.as_ref().map_or_else(Vec::new, |curve| curve.points(k))),
                action: curve.as_ref().and_then(|curve| curve.circulation(k)),
                own: at(&own),
            }
        };
        let frames = times.iter().enumerate().map(frame).collect();
        let points = carried.into_iter().map(|one| one.end).collect();
        (CloudStage { time: end, points, own: own.end, curve }, frames, error)
    }

    fn state(&self, at: [f64; 2]) -> Option<State> {
        self.origin.state(at, &self.starts, self.physics(), &self.conditions.parameters)
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
        let flow = SystemFlow {
            system: System::clone(&self.system),
            method: self.method,
            parameters: self.conditions.parameters.clone(),
            start: self.model.run.start,
            effort: None,
        };
        curve.carry(&flow, &[self.origin.time], start).ok()?;
        curve.circulation(0)
    }

    /// The rate at which the integral changes, where it is one number.
    fn rate(&self, points: &[Option<State>]) -> Option<f64> {
        let parameters = &self.conditions.parameters;
        let space = PhaseSpace::of((&self.model, &self.equations, &self.system), parameters);
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

/// The most steps of a point in so many seconds of the wall clock; those of a fixed step are known beforehand.
fn effort(method: &Method, seconds: f64) -> Option<u64> {
    let adapts = method.stepping == Stepping::Adaptive;
    adapts.then(|| (EFFORT * seconds.max(1.0)).ceil() as u64)
}

/// The time between frames of a part that is twice as long as the time `passed`, or `least`: the shortest, or so often twice as
/// long that the frames of every part are among those of the shortest.
fn frame_spacing(passed: f64, least: f64) -> f64 {
    let shortest = least / FRAMES as f64;
    let mut spacing = shortest;
    while spacing * FRAMES as f64 <= passed * 2.0 && spacing.is_finite() {
        spacing *= 2.0;
    }
    spacing
}
