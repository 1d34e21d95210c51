//! Action, period and frequency of one coordinate: J = ∮ p dq, T = dJ/dE, ν = dE/dJ.
//!
//! In: a coordinate with its [`EffectivePotential`], an energy. Out: one row for each region. The period is the time of the
//! return, located on the motion, so that no integrand is singular where the coordinate turns. With one degree of freedom
//! the action is ∮ p dq = ∫ L dt + E T, carried along the same motion (V. I. Arnold, Mathematical Methods of Classical
//! Mechanics, §50); else, and on separatrices, whose motion takes for ever, it is the integral of p over q with
//! q = c + r sin θ, whose integrand is analytic and periodic, by the trapezoidal rule. Never here: names, files.

use std::f64::consts::PI;

use super::no_action::NoAction;
use super::quadrature::{action_between, over_a_period};
use super::{AllowedInterval, EffectivePotential};
use crate::ensemble::{Crossings, NotOnShell, OrbitStatus, Root, SectionPlan, Start, crossings};
use crate::integrate::{Method, Settings};
use crate::system::System;

/// The kind of a motion of one coordinate.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum RegionKind {
    /// To and fro between two turning points.
    Libration,
    /// Round and round.
    Rotation,
    /// Round and round, to the left.
    BackwardRotation,
    /// It goes away and does not return.
    Unbounded,
}

impl RegionKind {
    /// The word in tables.
    pub fn word(self) -> &'static str {
        match self {
            RegionKind::Libration => "libration",
            RegionKind::Rotation => "rotation",
            RegionKind::BackwardRotation => "backward rotation",
            RegionKind::Unbounded => "unbounded",
        }
    }
}

/// One region at one energy.
#[derive(Clone, PartialEq, Debug)]
pub struct ActionRow {
    /// The value of H that all motions of the row have.
    pub energy: f64,
    /// The kind of motion.
    pub kind: RegionKind,
    /// Where the coordinate turns at the left and at the right.
    pub turning_points: [Option<f64>; 2],
    /// ∮ p dq; NaN where the motion is unbounded.
    pub action: f64,
    /// The time of a return, or of a turn; infinite where there is none.
    pub period: f64,
    /// The mean rate of a cyclic coordinate, in its unit per unit of time.
    pub mean_rate: Option<f64>,
    /// Whether the returns take different times, as where the rate of the coordinate depends on another one; `period` is then
    /// that of the first.
    pub is_uneven: bool,
}

impl ActionRow {
    /// The time of every return; `None` if they take different times.
    pub fn even_period(&self) -> Option<f64> {
        (!self.is_uneven).then_some(self.period)
    }

    /// Ω = 2π ν; of a cyclic coordinate without a period, which keeps moving, its mean rate. NaN where the motion does not
    /// return.
    pub fn angular_frequency(&self) -> f64 {
        match (self.kind, self.mean_rate) {
            (RegionKind::Unbounded, rate) => rate.unwrap_or(f64::NAN),
            _ => 2.0 * PI / self.period,
        }
    }
}

/// The system compiled with the two events that a return is located by.
pub struct ActionSystems<'a> {
    /// With q̇ as a section, and `action` as the last column.
    pub turning: &'a System,
    /// The index of the section's event.
    pub turns: usize,
    /// For a periodic coordinate, with sin(π q/P) as a section, and `action` as the last column.
    pub rotating: Option<(&'a System, usize)>,
    /// The column of the coordinate in a row of crossings.
    pub column: usize,
    /// By which periods and actions are integrated.
    pub method: &'static Method,
    /// Those of the method.
    pub settings: Settings,
}

/// Turning points agree to this part of the width of the region.
const RETURNS: f64 = 1e-7;

/// Returns whose times differ by more than this part of them take different times.
const EVEN: f64 = 1e-7;

/// A zero of q̇ at which the momentum is off by more than this part of its typical size is a multiple one.
const MULTIPLE_ZERO: f64 = 1e-9;

/// Two states of rest at a place have energies that differ by more than this part of the depth of the well.
const OTHER_REST: f64 = 1e-3;

/// The distance over which a slope of the potential is taken, as a part of the width of the region.
const SLOPE_STEP: f64 = 1e-5;

/// The steps after which a return is given up.
const MOST_IDLE_STEPS: u64 = 1_000_000;

/// The rotations to both sides are the same if action and period differ by less than this part.
pub(super) const SAME: f64 = 1e-9;

/// The row of a region; a rotation goes this way.
///
/// # Errors
/// Returns an error if the motion does not return to where it began.
pub fn action_row(
    potential: &mut EffectivePotential<'_>,
    systems: &ActionSystems<'_>,
    region: AllowedInterval,
    (energy, way): (f64, Root),
) -> Result<ActionRow, NoAction> {
    if let Some([place, rest]) = potential.greatest() {
        return Err(NoAction::GreatestAtRest { place, rest });
    }
    match (region.left, region.right, potential.period()) {
        (Some(left), Some(right), _) => libration(potential, systems, [left, right], energy),
        (None, None, Some(period)) => rotation(potential, systems, period, (energy, way)),
        (left, right, _) => Ok(ActionRow {
            energy,
            kind: RegionKind::Unbounded,
            turning_points: [left, right],
            action: f64::NAN,
            period: f64::INFINITY,
            mean_rate: None,
            is_uneven: false,
        }),
    }
}

/// The rows of a region: of a rotation that differs from the one to the left, both.
///
/// # Errors
/// Returns an error if a motion does not return to where it began.
pub fn action_rows(
    potential: &mut EffectivePotential<'_>,
    systems: &ActionSystems<'_>,
    region: AllowedInterval,
    energy: f64,
) -> Result<Vec<ActionRow>, NoAction> {
    let row = action_row(potential, systems, region, (energy, Root::Positive))?;
    if row.kind != RegionKind::Rotation {
        return Ok(vec![row]);
    }
    let other = action_row(potential, systems, region, (energy, Root::Negative))?;
    let differs = |one: f64, other: f64| (one - other).abs() > SAME * one.abs();
    let is_another = differs(row.action, other.action) || differs(row.period, other.period);
    Ok(if is_another { vec![row, other] } else { vec![row] })
}

fn libration(
    potential: &mut EffectivePotential<'_>,
    systems: &ActionSystems<'_>,
    [left, right]: [f64; 2],
    energy: f64,
) -> Result<ActionRow, NoAction> {
    let region = AllowedInterval { left: Some(left), right: Some(right) };
    if potential.profile.is_separatrix(region, energy) {
        let action = action_between(potential, left, right, energy)?;
        let turning_points = [Some(left), Some(right)];
        let (kind, period) = (RegionKind::Libration, f64::INFINITY);
        return Ok(ActionRow {
            energy,
            kind,
            turning_points,
            action,
            period,
            mean_rate: None,
            is_uneven: false,
        });
    }
    let from = flatter_end(potential, [left, right]);
    let start = potential.at_rest(from);
    let one = systems.turning.degrees() == 1;
    // of several coordinates, a second return shows whether it takes as long
    let mut found =
        follow(systems, (systems.turning, systems.turns), &start, if one { 2 } else { 4 })?;
    let other = if from == left { right } else { left };
    for (row, expected) in found.iter().zip([other, from, other, from]) {
        let place = row[systems.column];
        if is_elsewhere(place - expected, right - left) {
            if !one {
                return Err(NoAction::NotSeparable { found: place, expected });
            }
            let several = other_rest(potential, systems, [left, right], (row, energy));
            return Err(several.unwrap_or(NoAction::NarrowWells { found: place, expected }));
        }
    }
    let is_uneven = !one && differs(found[3][0] - found[1][0], found[1][0]);
    found.truncate(2);
    let (located, carried) = end(&found);
    let action = if one {
        carried + energy * located
    } else {
        action_between(potential, left, right, energy)?
    };
    let period = located + late(potential, systems, &start, &found, (from, other, action))?;
    let turning_points = [Some(left), Some(right)];
    let kind = RegionKind::Libration;
    Ok(ActionRow { energy, kind, turning_points, action, period, mean_rate: None, is_uneven })
}

/// The error if the only coordinate has turned where at rest it would have another energy: with another momentum.
fn other_rest(
    potential: &mut EffectivePotential<'_>,
    systems: &ActionSystems<'_>,
    ends: [f64; 2],
    (row, energy): (&[f64], f64),
) -> Option<NoAction> {
    let kind = potential.momentum();
    let column = systems.turning.channels().iter().position(|channel| channel.kind == kind)?;
    let (place, momentum) = (row[systems.column], row[1 + column]);
    let depth = energy - potential.profile.bottom_between(ends)?;
    let start = potential.at_rest(place);
    let rest = potential.observed(&start, kind).ok()?;
    let differs = potential.at(place) - energy;
    is_another_rest(differs, depth).then_some(NoAction::SeveralRests { place, momentum, rest })
}

/// How much later than located the return is. Where q̇ vanishes as a power of p − p₀, as in H = p⁴ + V, its zero is a multiple
/// one, known to a part of the digits only; the momentum has a simple zero there, of slope −∂H/∂q.
fn late(
    potential: &mut EffectivePotential<'_>,
    systems: &ActionSystems<'_>,
    start: &Start,
    found: &[Vec<f64>],
    (from, other, action): (f64, f64, f64),
) -> Result<f64, NoAction> {
    let kind = potential.momentum();
    let column = systems.turning.channels().iter().position(|channel| channel.kind == kind);
    let (Some(column), Some(row)) = (column, found.last()) else { return Ok(0.0) };
    let begun = potential.observed(start, kind).map_err(NotOnShell::from)?;
    let missing = begun - row[1 + column];
    let width = (other - from).abs();
    let typical = 0.5 * action.abs() / width;
    if is_simple_zero(missing, typical) {
        return Ok(0.0);
    }
    let step = SLOPE_STEP * width;
    let slope = (potential.at(from + step) - potential.at(from - step)) / (2.0 * step);
    Ok(-missing / slope)
}

/// The end of a region from which the motion sets out: that at which the rounding of the place changes the energy by much less, or
/// the left one. Next to a separatrix the period is the logarithm of a difference of energies.
fn flatter_end(potential: &mut EffectivePotential<'_>, [left, right]: [f64; 2]) -> f64 {
    let step = SLOPE_STEP * (right - left);
    let mut change =
        |place: f64, inside: f64| ((potential.at(inside) - potential.at(place)) * place).abs();
    let is_flatter = change(right, right - step) < 0.1 * change(left, left + step);
    if is_flatter { right } else { left }
}

/// The row of a cyclic coordinate while another one librates: the action is its momentum times a turn, and the frequency
/// is its mean rate, in turns, by the advance from one return of the other to the next. `columns` are those of the cyclic
/// coordinate and its momentum in a row of crossings; `turn` is the period of the coordinate: without one it has a mean
/// rate, and no action.
///
/// # Errors
/// Returns an error if the other coordinate does not librate, or does not return.
pub fn cyclic_row(
    potential: &mut EffectivePotential<'_>,
    systems: &ActionSystems<'_>,
    region: AllowedInterval,
    energy: f64,
    [position, momentum]: [usize; 2],
    turn: Option<f64>,
) -> Result<ActionRow, NoAction> {
    let (Some(left), Some(right)) = (region.left, region.right) else {
        return Err(NoAction::NoReturn("the other coordinate does not return".to_owned()));
    };
    if potential.profile.is_separatrix(region, energy) {
        return Err(NoAction::NoReturn("the other coordinate is on a separatrix".to_owned()));
    }
    let start = potential.at_rest(left);
    let found = follow(systems, (systems.turning, systems.turns), &start, 3)?;
    for (row, expected) in found.iter().zip([right, left, right]) {
        let place = row[systems.column];
        if is_elsewhere(place - expected, right - left) {
            return Err(NoAction::NotSeparable { found: place, expected });
        }
    }
    let (first, last) = (&found[0], &found[2]);
    let (advance, time) = (last[position] - first[position], last[0] - first[0]);
    let kind = if turn.is_some() { RegionKind::Rotation } else { RegionKind::Unbounded };
    Ok(ActionRow {
        energy,
        kind,
        turning_points: [None, None],
        action: turn.map_or(f64::NAN, |turn| (last[momentum] * turn).abs()),
        period: turn.map_or(f64::INFINITY, |turn| time * turn / advance.abs()),
        mean_rate: Some(advance / time),
        is_uneven: false,
    })
}

fn rotation(
    potential: &mut EffectivePotential<'_>,
    systems: &ActionSystems<'_>,
    period: f64,
    (energy, way): (f64, Root),
) -> Result<ActionRow, NoAction> {
    let Some(rotating) = systems.rotating else {
        return Err(NoAction::NoReturn("the coordinate has no period".to_owned()));
    };
    let start = potential.moving(0.0, energy, way)?;
    let one = rotating.0.degrees() == 1;
    let mut found = follow(systems, rotating, &start, if one { 1 } else { 2 })?;
    let is_uneven = !one && differs(found[1][0] - found[0][0], found[0][0]);
    found.truncate(1);
    let (time, carried) = end(&found);
    let (kind, sign) = match way {
        Root::Positive => (RegionKind::Rotation, 1.0),
        Root::Negative => (RegionKind::BackwardRotation, -1.0),
    };
    let action = if one {
        carried + energy * time
    } else {
        sign * over_a_period(period, |place| {
            Ok(potential.momentum_at(place, energy, way)?.unwrap_or(0.0))
        })?
    };
    let turning_points = [None, None];
    let (period, mean_rate) = (time, None);
    Ok(ActionRow { energy, kind, turning_points, action, period, mean_rate, is_uneven })
}

/// Whether a coordinate has turned so far from where it should that it is another place, beside the width of the region.
fn is_elsewhere(off: f64, width: f64) -> bool {
    off.abs() > RETURNS * width
}

/// Whether an energy at rest differs from that of the motion, beside the depth of the well.
fn is_another_rest(differs: f64, depth: f64) -> bool {
    differs.abs() > OTHER_REST * depth
}

/// Whether a zero of q̇ is a simple one by the momentum there, which is off by `missing`.
fn is_simple_zero(missing: f64, typical: f64) -> bool {
    missing.abs() <= MULTIPLE_ZERO * typical
}

/// Whether the times of two returns differ.
fn differs(one: f64, other: f64) -> bool {
    (one - other).abs() > EVEN * other
}

/// The first crossings after a start.
pub(super) fn follow(
    systems: &ActionSystems<'_>,
    (system, event): (&System, usize),
    start: &Start,
    count: u64,
) -> Result<Vec<Vec<f64>>, NoAction> {
    let plan = SectionPlan {
        event,
        count: Some(count),
        until: None,
        idle: MOST_IDLE_STEPS,
        all_channels: false,
    };
    let Crossings { rows, status, message } =
        crossings(system, systems.method, systems.settings, start, &plan);
    if status == OrbitStatus::Completed {
        return Ok(rows);
    }
    let why = message.unwrap_or_default();
    Err(NoAction::NoReturn(format!("the coordinate did not return: {why}")))
}

/// The time and the carried action at the last crossing, from the start of the motion at time zero.
fn end(found: &[Vec<f64>]) -> (f64, f64) {
    let last = found.last().map_or(&[][..], |row| row);
    (last.first().copied().unwrap_or(f64::NAN), last.last().copied().unwrap_or(f64::NAN))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thresholds_of_a_return_are_parts_of_what_they_are_compared_with() {
        assert!(is_elsewhere(-2.1e-7, 2.0) && !is_elsewhere(-1.9e-7, 2.0));
        assert!(differs(2.0 + 2.1e-7, 2.0) && !differs(2.0 + 1.9e-7, 2.0));
        assert!(is_simple_zero(-1.9e-9, 2.0) && !is_simple_zero(-2.1e-9, 2.0));
        assert!(is_another_rest(-2.1e-3, 2.0) && !is_another_rest(-1.9e-3, 2.0));
    }
}
