//! Where a cloud begins: a disc or a box in the plane of two quantities, around the motion.
//!
//! In: the plot, the present, a window that was chosen. Out: an [`Origin`]: points within it and on its boundary, and the states
//! they stand for. Never here: how they are carried.

use super::super::equilibria::given;
use super::super::phase::initial_values;
use super::super::{Physics, Plot, Present, Seed};
use crate::ensemble::{Start, spread};
use crate::num::math;
use crate::system::{InitialOverride, State};

/// The size of a cloud: of its values, in a coordinate that is an angle, and where neither has a scale.
const OF_VALUE: f64 = 0.3;
const OF_TURN: f64 = 0.08;

/// Where a cloud began.
#[derive(Clone)]
pub(super) struct Origin {
    pub(super) time: f64,
    /// The motion there.
    base: Vec<InitialOverride>,
    pub(super) centre: [f64; 2],
    radii: [f64; 2],
    boxed: bool,
}

impl Origin {
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

    /// The point of the closed curve at s, counter-clockwise.
    pub(super) fn boundary(&self, s: f64) -> [f64; 2] {
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
    pub(super) fn inside(&self, count: usize) -> impl Iterator<Item = [f64; 2]> + '_ {
        let within = |at: &[f64; 2]| self.boxed || at[0] * at[0] + at[1] * at[1] <= 1.0;
        let all = (0..).map(|index| spread(index, [[-1.0, 1.0]; 2])).filter(within);
        all.take(count).map(|at| self.placed(at))
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
