//! The orbits of a family, as they are drawn and written.
//!
//! In: a state near a periodic orbit, what changes along the family. Out: its orbits with their greatest values, and why it
//! ends. Never here: how a family is followed (`dynamics`), pictures.

use std::sync::Arc;

use super::super::closed_orbit::{ClosedOrbit, closed_orbit};
use super::super::conditions::PlotConditions;
use super::super::orbit_crossings::periodic_points;
use super::super::{PeriodicOrbits, PeriodicPoints, Physics};
use crate::dynamics::{
    Along, Bifurcation, DrivePeriod, FamilyCourse, Fixed, Member, Orbit, PhaseSpace, drive_period,
};
use crate::ensemble::{Start, SystemFlow};
use crate::integrate::{Method, Settings};
use crate::job::Progress;
use crate::num::DoubleDouble;
use crate::system::{ChannelKind, Form, System};

/// The intervals of the range at whose ends orbits are asked for.
const INTERVALS: usize = 40;

/// A family over the energy is followed from this part of its distance from the bottom, taken off and put on.
const BELOW: f64 = 0.9;
const ABOVE: f64 = 1.0;

/// The parts in which progress is reported, and those of them for the orbit at which the family begins.
const PARTS: u64 = 1000;
const CLOSING: u64 = 100;

/// The points of an orbit of which the greatest is taken.
const POINTS: usize = 512;

/// The steps to either side in the first part, after the orbit alone, and the most in one.
const FIRST_STEPS: usize = 2;
const MOST_STEPS: usize = 64;

/// A family, in the order along it.
pub(super) struct FollowedFamily {
    pub(super) range: [f64; 2],
    /// What changes along the family, of the orbit that it was followed from.
    pub(super) first: f64,
    /// The channel whose greatest value on each orbit is taken.
    pub(super) channel: usize,
    pub(super) members: Vec<FamilyMember>,
    /// Why it cannot be continued, at either end.
    pub(super) ended: Vec<String>,
    /// Whether each orbit is the only one beside it of its value.
    pub(super) isolated: bool,
    /// Where its orbits cross the surfaces of section.
    pub(super) periodic: Arc<PeriodicOrbits>,
    /// What it is followed on from; `None` once that is done.
    way: Option<FamilyWay>,
}

#[derive(Clone)]
struct FamilyWay {
    space: PhaseSpace,
    fixed: Fixed,
    course: FamilyCourse,
    /// The steps of the next part.
    steps: usize,
    /// Where the orbit begun with crosses the surfaces of section.
    orbit: PeriodicPoints,
}

impl FollowedFamily {
    /// Whether there is no more to follow.
    pub(super) fn is_complete(&self) -> bool {
        self.way.is_none()
    }
}

/// What is drawn and written of an orbit.
pub(super) struct FamilyMember {
    pub(super) value: f64,
    pub(super) greatest: f64,
    pub(super) period: f64,
    pub(super) energy: f64,
    pub(super) trace: f64,
    /// Whether it is stable; `None` where that is not known.
    pub(super) stable: Option<bool>,
    pub(super) bifurcation: Option<Bifurcation>,
}

/// Closes the orbit near a start.
pub(super) fn close(
    physics: Physics<'_>,
    method: (&'static Method, Settings),
    (start, conditions): (&Start, &PlotConditions),
    (parameter, coordinate): (Option<(usize, [f64; 2])>, usize),
    progress: &Progress,
) -> Result<FollowedFamily, String> {
    progress.expect(PARTS);
    let closing = |done: u64, all: u64| progress.reach(CLOSING * done / all.max(1));
    let found = closed_orbit(physics, method, (start, conditions), &closing);
    let ClosedOrbit { space, orbit, fixed } = found.map_err(|why| why.to_string())?;
    let (first, range) = match parameter {
        Some((index, range)) => (start.parameters[index], range),
        None => {
            // of a small oscillation this is its energy above the bottom
            let height = orbit.action.map(|action| (action / orbit.period).abs());
            let height = height.or_else(|| above_mean(physics, (method.0, start), &orbit));
            let height = height.filter(|height| height.is_normal());
            let height = height.ok_or("no range of E is known: the orbit has neither an action nor an energy other than that of its mean state")?;
            (orbit.energy, [orbit.energy - BELOW * height, orbit.energy + ABOVE * height])
        }
    };
    let channel = if rotates(physics, (method.0, &start.parameters), &orbit, coordinate) {
        rate(physics, coordinate)
    } else {
        coordinate
    };
    let points = periodic_points(physics, method.0, &orbit, &start.parameters);
    let alone = Member { value: first, orbit: orbit.clone(), bifurcation: None };
    let members = vec![seen((physics.system, method.0), &start.parameters, &alone, channel)];
    let periodic = PeriodicOrbits { orbit: points.clone(), family: Vec::new() };
    let course = FamilyCourse::new(&orbit);
    Ok(FollowedFamily {
        range,
        first,
        channel,
        members,
        ended: Vec::new(),
        isolated: true,
        periodic: Arc::new(periodic),
        way: Some(FamilyWay { space, fixed, course, steps: FIRST_STEPS, orbit: points }),
    })
}

/// Follows a family on, by twice as many steps as before.
pub(super) fn follow_on(
    physics: Physics<'_>,
    method: (&'static Method, Settings),
    (known, start): (&FollowedFamily, &Start),
    parameter: Option<usize>,
    progress: &Progress,
) -> Result<FollowedFamily, String> {
    progress.expect(PARTS);
    progress.reach(CLOSING);
    let report = |part: f64| progress.reach(CLOSING + ((PARTS - CLOSING) as f64 * part) as u64);
    let mut way = known.way.clone().ok_or("there is no more to follow")?;
    let space = way.space.with_cancel(progress.token());
    let along = parameter.map_or(Along::Energy, Along::Parameter);
    let [from, to] = known.range;
    let value = |k: usize| from + (to - from) * k as f64 / INTERVALS as f64;
    let values: Vec<f64> = (0..=INTERVALS).map(value).collect();
    let drive = |parameters: &[f64]| {
        drive_period(physics.model, physics.equations, physics.system, parameters)
    };
    let (fixed, drive) = if space.is_autonomous() {
        (way.fixed, None)
    } else {
        (Fixed::Period(way.course.orbit().period), Some(&drive as DrivePeriod<'_>))
    };
    let asked = (&values[..], &report as &dyn Fn(f64));
    let followed = way.course.follow(&space, method, (along, fixed, drive), asked, way.steps);
    followed.map_err(|why| why.to_string())?;
    way.steps = (2 * way.steps).min(MOST_STEPS);
    let found = way.course.family();
    let parameters = |member: &Member| {
        let mut parameters = start.parameters.clone();
        if let Along::Parameter(index) = along {
            parameters[index] = member.value;
        }
        parameters
    };
    let of: (&System, _) = (physics.system, method.0);
    let members = found.members.iter();
    let members = members.map(|member| seen(of, &parameters(member), member, known.channel));
    let members = members.collect();
    let is_complete = way.course.is_complete();
    // drawn on sections, where a part of it would be as long to compute each time
    let crossed =
        |member: &Member| periodic_points(physics, method.0, &member.orbit, &parameters(member));
    let family = if is_complete { found.members.iter().map(crossed).collect() } else { Vec::new() };
    let periodic = PeriodicOrbits { orbit: way.orbit.clone(), family };
    Ok(FollowedFamily {
        range: known.range,
        first: known.first,
        channel: known.channel,
        members,
        ended: found.ended,
        isolated: found.isolated,
        periodic: Arc::new(periodic),
        way: (!is_complete).then_some(way),
    })
}

/// What is drawn and written of a member at some parameters.
fn seen(
    (system, method): (&System, &'static Method),
    parameters: &[f64],
    member: &Member,
    channel: usize,
) -> FamilyMember {
    FamilyMember {
        value: member.value,
        greatest: greatest(system, (method, parameters.to_vec()), member, channel),
        period: member.orbit.period,
        energy: member.orbit.energy,
        trace: member.orbit.transverse.trace(),
        stable: member.is_stable(),
        bifurcation: member.bifurcation,
    }
}

/// Whether a coordinate is another after a period: an angle that rotates has no greatest value.
fn rotates(
    physics: Physics<'_>,
    (method, parameters): (&'static Method, &[f64]),
    orbit: &Orbit,
    channel: usize,
) -> bool {
    let Some(turn) = physics.system.period(channel, parameters) else { return false };
    let ends = [orbit.state.time, orbit.state.time + orbit.period];
    let flow = flow(physics.system, (method, parameters.to_vec()), orbit);
    let seen = flow.carry(&orbit.state, &ends, &[channel]).seen;
    matches!(&seen[..], [from, to] if (to[0] - from[0]).abs() > turn.abs() / 2.0)
}

/// How far the energy of an orbit without an action, as of a system given by brackets, lies from that of its mean state: of a small
/// oscillation this is its energy above the bottom, too.
fn above_mean(
    physics: Physics<'_>,
    (method, start): (&'static Method, &Start),
    orbit: &Orbit,
) -> Option<f64> {
    let channels: Vec<usize> = physics.positions().map(|(_, channel)| channel).collect();
    let mut mean = orbit.state.clone();
    if physics.system.form() != Form::Variables {
        return None;
    }
    let time = |k: usize| orbit.state.time + orbit.period * k as f64 / POINTS as f64;
    let times: Vec<f64> = (0..POINTS).map(time).collect();
    let flow = flow(physics.system, (method, start.parameters.clone()), orbit);
    let rows = flow.carry(&orbit.state, &times, &channels).seen;
    for i in 0..channels.len() {
        let sum: f64 = rows.iter().map(|row| row[i]).sum();
        mean.set(i, DoubleDouble::from(sum / rows.len() as f64));
    }
    let energy = physics.system.energy(&mean, &start.parameters).ok()?;
    Some((orbit.energy - energy).abs())
}

/// The momentum of a coordinate, or else its velocity; for anything else the same channel.
fn rate(physics: Physics<'_>, channel: usize) -> usize {
    let Some((i, _)) = physics.positions().find(|(_, place)| *place == channel) else {
        return channel;
    };
    let of = |kind| physics.channel(kind);
    let found = of(ChannelKind::Momentum(i)).or_else(|| of(ChannelKind::Velocity(i)));
    found.unwrap_or(channel)
}

fn flow(
    system: &System,
    (method, parameters): (&'static Method, Vec<f64>),
    orbit: &Orbit,
) -> SystemFlow {
    SystemFlow {
        system: System::clone(system),
        method: (method, orbit.settings),
        parameters,
        start: orbit.state.time,
        effort: None,
    }
}

/// The greatest value of a channel along an orbit, by the parabola through the greatest of many and its neighbours.
fn greatest(
    system: &System,
    (method, parameters): (&'static Method, Vec<f64>),
    member: &Member,
    channel: usize,
) -> f64 {
    let orbit = &member.orbit;
    let flow = flow(system, (method, parameters), orbit);
    let time = |k: usize| orbit.state.time + orbit.period * k as f64 / POINTS as f64;
    let times: Vec<f64> = (0..POINTS).map(time).collect();
    let all: Vec<f64> =
        flow.carry(&orbit.state, &times, &[channel]).seen.iter().map(|row| row[0]).collect();
    let Some(top) = (0..all.len()).max_by(|a, b| all[*a].total_cmp(&all[*b])) else {
        return f64::NAN;
    };
    let beside = |by: usize| all[(top + by) % all.len()];
    let [before, here, after] = [beside(all.len() - 1), all[top], beside(1)];
    let bend = before - 2.0 * here + after;
    let rise = (after - before) * (after - before) / (8.0 * bend);
    let is_top = bend < 0.0 && before <= here && after <= here;
    if is_top { here - rise } else { here }
}
