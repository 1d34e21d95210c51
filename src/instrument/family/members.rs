//! The orbits of a family, as they are drawn and written.
//!
//! In: a state near a periodic orbit, what changes along the family. Out: its orbits with their greatest values, and why it
//! ends. Never here: how a family is followed (`dynamics`), pictures.

use std::sync::Arc;

use super::super::closed_orbit::{ClosedOrbit, closed_orbit};
use super::super::conditions::PlotConditions;
use super::super::orbit_crossings::periodic_points;
use super::super::{PeriodicOrbits, Physics};
use crate::dynamics::{Along, Bifurcation, Member, Orbit, drive_period, driven_family, family};
use crate::ensemble::{Start, SystemFlow};
use crate::integrate::{Method, Settings};
use crate::job::Progress;
use crate::system::{ChannelKind, System};

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

/// A family, in the order along it.
pub(super) struct FollowedFamily {
    pub(super) range: [f64; 2],
    /// What changes along the family, of the orbit that it was followed from.
    pub(super) first: f64,
    /// The channel whose greatest value on each orbit is taken.
    pub(super) channel: usize,
    pub(super) members: Vec<FamilyMember>,
    /// Why it does not go on, at either end.
    pub(super) ended: Vec<String>,
    /// Where its orbits cross the surfaces of section.
    pub(super) periodic: Arc<PeriodicOrbits>,
}

/// What is drawn and written of an orbit.
pub(super) struct FamilyMember {
    pub(super) value: f64,
    /// The greatest value of the quantity.
    pub(super) greatest: f64,
    pub(super) period: f64,
    pub(super) energy: f64,
    pub(super) trace: f64,
    /// Whether it is stable; `None` where that is not known.
    pub(super) stable: Option<bool>,
    pub(super) bifurcation: Option<Bifurcation>,
}

/// Closes the orbit near a start, and follows its family.
pub(super) fn follow(
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
    let look = |part: f64| progress.reach(CLOSING + ((PARTS - CLOSING) as f64 * part) as u64);
    let (along, range) = match parameter {
        Some((index, range)) => (Along::Parameter(index), range),
        None => {
            // of a small oscillation this is its energy above the bottom
            let height = orbit.action.map(|action| (action / orbit.period).abs());
            let height = height.filter(|height| height.is_normal());
            let height = height.ok_or("without the action of the orbit no range of E is known")?;
            (Along::Energy, [orbit.energy - BELOW * height, orbit.energy + ABOVE * height])
        }
    };
    let first = match along {
        Along::Parameter(index) => start.parameters[index],
        Along::Energy | Along::Period => orbit.energy,
    };
    let [from, to] = range;
    let value = |k: usize| from + (to - from) * k as f64 / INTERVALS as f64;
    let values: Vec<f64> = (0..=INTERVALS).map(value).collect();
    let drive = |parameters: &[f64]| {
        drive_period(physics.model, physics.equations, space.system(), parameters)
    };
    let found = if space.is_autonomous() {
        family(&space, method, &orbit, (along, fixed), (&values, &look))
    } else {
        driven_family(&space, method, &orbit, (along, &drive), (&values, &look))
    };
    let found = found.map_err(|why| why.to_string())?;
    let channel = if rotates(physics, (method.0, &start.parameters), &orbit, coordinate) {
        rate(physics, coordinate)
    } else {
        coordinate
    };
    let parameters = |member: &Member| {
        let mut parameters = start.parameters.clone();
        if let Along::Parameter(index) = along {
            parameters[index] = member.value;
        }
        parameters
    };
    let seen = |member: &Member| FamilyMember {
        value: member.value,
        greatest: greatest(physics.system, (method.0, parameters(member)), member, channel),
        period: member.orbit.period,
        energy: member.orbit.energy,
        trace: member.orbit.transverse.trace(),
        stable: member.orbit.is_stable(),
        bifurcation: member.bifurcation,
    };
    let members = found.members.iter().map(seen).collect();
    let crossed =
        |orbit: &Orbit, parameters: &[f64]| periodic_points(physics, method.0, orbit, parameters);
    let family = found.members.iter().map(|member| crossed(&member.orbit, &parameters(member)));
    let periodic =
        PeriodicOrbits { orbit: crossed(&orbit, &start.parameters), family: family.collect() };
    Ok(FollowedFamily {
        range,
        first,
        channel,
        members,
        ended: found.ended,
        periodic: Arc::new(periodic),
    })
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

/// The momentum of a coordinate, or else its velocity; for anything else the same channel.
fn rate(physics: Physics<'_>, channel: usize) -> usize {
    let Some((i, _)) = physics.positions().find(|(_, place)| *place == channel) else {
        return channel;
    };
    let of = |kind| physics.channel(kind);
    let found = of(ChannelKind::Momentum(i)).or_else(|| of(ChannelKind::Velocity(i)));
    found.unwrap_or(channel)
}

/// The flow along an orbit.
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
