//! Where a cloud begins: a disc or a box in the plane of two quantities, around the motion, or the shell of its energy.
//!
//! In: the plot, the current state, a window that was chosen. Out: an [`CloudOrigin`]: points within it and on its boundary, and the states
//! they stand for. Never here: how they are carried.

use super::super::equilibria::given;
use super::super::phase::initial_values;
use super::super::{Physics, Plot, Present, Seed};
use crate::ensemble::{EnergyShell, Root, Start, spread};
use crate::expr::Expr;
use crate::num::math;
use crate::system::{ChannelKind, Form, InitialOverride, State, System};

/// The size of a cloud: of its values, in a coordinate that is an angle, and where neither has a scale.
const OF_VALUE: f64 = 0.3;
const OF_TURN: f64 = 0.08;

/// The range of a shell beyond what the motion has reached, and how many places are tried for each that is on it.
const AROUND: f64 = 1.5;
const TRIES: usize = 64;

#[derive(Clone)]
pub(super) struct CloudOrigin {
    pub(super) time: f64,
    base: Vec<InitialOverride>,
    pub(super) centre: [f64; 2],
    radii: [f64; 2],
    shape: CloudShape,
    /// Whether it is laid about the motion once more, after a parameter was changed.
    pub(super) again: bool,
}

#[derive(Clone)]
enum CloudShape {
    Disc,
    Box,
    /// The states of an energy, within a range of each coordinate and rate.
    Shell {
        energy: f64,
        ranges: Vec<[f64; 2]>,
    },
}

impl CloudOrigin {
    /// A cloud around the motion, or around what was chosen.
    pub(super) fn of(plot: &Plot, present: &Present<'_>, seed: Option<Seed>) -> Option<Self> {
        let physics = present.physics;
        let base = given(physics, |channel| present.value(channel));
        let channels = [plot.column(0)?, plot.column(1)?];
        let own = channels.map(|channel| present.value(channel));
        let origin = Self {
            time: present.time,
            base,
            centre: own,
            radii: [1.0; 2],
            again: false,
            shape: match seed {
                Some(Seed::Spread(_) | Seed::Fill(_)) => CloudShape::Box,
                Some(Seed::Shell) => shell(present)?,
                _ => CloudShape::Disc,
            },
        };
        Some(match seed {
            Some(Seed::Spread(window) | Seed::Fill(window)) => Self {
                centre: window.map(|[from, to]| f64::midpoint(from, to)),
                radii: window.map(|[from, to]| (to - from) / 2.0),
                ..origin
            },
            Some(Seed::Through(at)) => {
                Self { radii: radii(&origin, plot, present, channels), centre: at, ..origin }
            }
            Some(Seed::Shell) => origin,
            None => Self { radii: radii(&origin, plot, present, channels), ..origin },
        })
    }

    /// The same about the motion as it is now, of the size that `before` has.
    pub(super) fn placed_again(self, before: &CloudOrigin) -> Self {
        // a shell is as large as the motion
        let is_alike = matches!(
            (&self.shape, &before.shape),
            (CloudShape::Disc, CloudShape::Disc) | (CloudShape::Box, CloudShape::Box)
        );
        if is_alike { Self { radii: before.radii, again: true, ..self } } else { self }
    }

    /// The state of the motion with two of its values replaced.
    pub(super) fn state(
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

    /// The state of the motion itself.
    pub(super) fn own(&self, physics: Physics<'_>, parameters: &[f64]) -> Option<State> {
        let (time, parameters) = (self.time, parameters.to_vec());
        let start = Start { time, parameters, overrides: self.base.clone() };
        start.state(physics.system).ok()
    }

    /// Whether it has a closed curve around it.
    pub(super) fn has_boundary(&self) -> bool {
        !matches!(self.shape, CloudShape::Shell { .. })
    }

    /// The energy of all its states, if they have one.
    pub(super) fn energy(&self) -> Option<f64> {
        match self.shape {
            CloudShape::Shell { energy, .. } => Some(energy),
            CloudShape::Disc | CloudShape::Box => None,
        }
    }

    /// So many states within it; `None` for one that is no state.
    pub(super) fn states(
        &self,
        count: usize,
        plot: &Plot,
        physics: Physics<'_>,
        parameters: &[f64],
    ) -> Vec<Option<State>> {
        match &self.shape {
            CloudShape::Shell { energy, ranges } => {
                self.on_shell((*energy, ranges), count, physics.system, parameters)
            }
            CloudShape::Disc | CloudShape::Box => {
                let points = self.inside(count);
                points.map(|at| self.state(at, plot, physics, parameters)).collect()
            }
        }
    }

    /// States of an energy: all numbers but the last rate are spread evenly, and that completes them, by either root.
    fn on_shell(
        &self,
        (energy, ranges): (f64, &[[f64; 2]]),
        count: usize,
        system: &System,
        parameters: &[f64],
    ) -> Vec<Option<State>> {
        let Some((&by, others)) = self.base.split_last() else { return Vec::new() };
        let mut observer = system.observer(parameters);
        let (time, parameters) = (self.time, parameters.to_vec());
        let mut start = Start { time, parameters, overrides: self.base.clone() };
        let state = |index: usize| {
            for ((&given, range), share) in others.iter().zip(ranges).zip(shares(index)) {
                start.replace(given.with_value(range[0] + share * (range[1] - range[0])));
            }
            let root = if index.is_multiple_of(2) { Root::Positive } else { Root::Negative };
            let shell = EnergyShell { energy, by, root, about: 0.0 };
            shell.complete_by(system, &mut observer, &mut start).ok()?;
            start.state(system).ok()
        };
        // most places may be beyond what the energy allows
        (0..TRIES * count).filter_map(state).take(count).map(Some).collect()
    }

    /// The point of the closed curve at s, counter-clockwise.
    pub(super) fn boundary(&self, s: f64) -> [f64; 2] {
        let at = if matches!(self.shape, CloudShape::Box) {
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
    fn inside(&self, count: usize) -> impl Iterator<Item = [f64; 2]> + '_ {
        let boxed = matches!(self.shape, CloudShape::Box);
        let within = move |at: &[f64; 2]| boxed || at[0] * at[0] + at[1] * at[1] <= 1.0;
        let all = (0..).map(|index| spread(index, [[-1.0, 1.0]; 2])).filter(within);
        all.take(count).map(|at| self.placed(at))
    }

    fn placed(&self, at: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|k| self.centre[k] + self.radii[k] * at[k])
    }
}

/// The shell of the motion's energy, around what it has reached; `None` where its energy is not constant.
fn shell(present: &Present<'_>) -> Option<CloudShape> {
    let physics = present.physics;
    if physics.equations.energy_rate != Expr::ZERO || physics.system.form() == Form::Variables {
        return None;
    }
    let energy = present.value(physics.channel(ChannelKind::Energy)?);
    let n = physics.system.degrees();
    let rate = |i: usize| match physics.system.form() {
        Form::Velocity => ChannelKind::Velocity(i),
        Form::Momentum | Form::Variables => ChannelKind::Momentum(i),
    };
    let kinds = (0..n).map(ChannelKind::Position).chain((0..n).map(rate));
    let range = |kind: ChannelKind| {
        let channel = physics.channel(kind)?;
        if let Some(period) = physics.system.period(channel, present.parameters) {
            return Some([-period / 2.0, period / 2.0]);
        }
        let (lo, hi) = *present.bounds.get(channel)?;
        let (middle, half) = (f64::midpoint(lo, hi), 0.5 * (hi - lo));
        let reach = AROUND * half.max(lo.abs()).max(hi.abs());
        let reach = if reach > 0.0 { reach } else { 1.0 };
        Some([middle - reach, middle + reach])
    };
    Some(CloudShape::Shell { energy, ranges: kinds.map(range).collect::<Option<_>>()? })
}

/// Numbers from 0 to 1, those of each place spread evenly with the index: multiples of the powers of 1/φ, where φ is the
/// root of φ^{d+1} = φ + 1 for d = 7 (M. Roberts, 2018).
fn shares(index: usize) -> impl Iterator<Item = f64> {
    const ROOT: f64 = 1.096_981_557_798_559_8;
    let steps = std::iter::successors(Some(1.0 / ROOT), |step| Some(step / ROOT));
    steps.map(move |step| (0.5 + step * (index + 1) as f64).fract())
}

/// The size of a cloud in both directions: by the coordinate, and by how much as much energy changes the other.
fn radii(
    origin: &CloudOrigin,
    plot: &Plot,
    present: &Present<'_>,
    channels: [usize; 2],
) -> [f64; 2] {
    let physics = present.physics;
    let sized = |k: usize| {
        let (lo, hi) = present.bounds.get(channels[k]).copied().unwrap_or_default();
        let range = Some(OF_VALUE * (hi - lo) / 2.0).filter(|r| r.is_finite() && *r > 0.0);
        let value = Some(OF_VALUE * origin.centre[k].abs()).filter(|r| *r > 0.0);
        let period = physics.system.period(channels[k], present.parameters);
        (period.map(|period| OF_TURN * period), range, value)
    };
    let (turn, range, value) = sized(0);
    // where it passes near zero the value is no measure of it
    let extent = value.into_iter().chain(range).reduce(f64::max);
    let across = turn.or(extent).unwrap_or(OF_VALUE);
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
