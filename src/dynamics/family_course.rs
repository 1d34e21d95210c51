//! A family of periodic orbits followed to both sides of one of them, at once or in parts.
//!
//! In: an orbit, what changes along its family, the values that are asked for. Out: a [`Family`]. Never here: how a step along
//! a family is taken (`continuation`).

use super::continuation::{Continuation, DrivePeriod, FamilySide, SideEnd};
use super::error::DynamicsError;
use super::family::{Along, Family, Member};
use super::newton::Fixed;
use super::orbit::Orbit;
use super::phase_space::PhaseSpace;
use crate::integrate::{Method, Settings};

/// Follows the family of an orbit in both directions, as far as its values lie between the first
/// and the last of `values`. `report` is given the part of this range that is behind it.
///
/// # Errors
/// Returns an error if the family has no such values.
pub fn family(
    space: &PhaseSpace,
    method: (&'static Method, Settings),
    orbit: &Orbit,
    (along, fixed): (Along, Fixed),
    (values, report): (&[f64], &dyn Fn(f64)),
) -> Result<Family, DynamicsError> {
    let mut course = FamilyCourse::new(orbit);
    course.follow(space, method, (along, fixed, None), (values, report), usize::MAX)?;
    Ok(course.family())
}

/// Follows a family as [`family`] does, under a drive whose period at some parameters `drive` gives: the orbits keep
/// their multiple of it, also along a parameter on which it depends.
///
/// # Errors
/// Returns an error if the family has no such values.
pub fn driven_family(
    space: &PhaseSpace,
    method: (&'static Method, Settings),
    orbit: &Orbit,
    (along, drive): (Along, &dyn Fn(&[f64]) -> Option<f64>),
    (values, report): (&[f64], &dyn Fn(f64)),
) -> Result<Family, DynamicsError> {
    let mut course = FamilyCourse::new(orbit);
    let what = (along, Fixed::Period(orbit.period), Some(drive));
    course.follow(space, method, what, (values, report), usize::MAX)?;
    Ok(course.family())
}

/// Whether a number is a whole one above zero but for rounding.
fn is_whole(x: f64) -> bool {
    x.round() >= 1.0 && (x - x.round()).abs() <= 1e-9 * x
}

/// A family under way, which can be followed in parts.
#[derive(Clone)]
pub struct FamilyCourse {
    orbit: Orbit,
    /// The orbit itself as a member, once it is known to be one of those asked for.
    own: Option<Member>,
    /// Towards lower values, and towards higher ones; none before the first part.
    sides: Option<[FamilySide; 2]>,
    cancelled: bool,
}

impl FamilyCourse {
    /// The family of an orbit, of which nothing else is known.
    pub fn new(orbit: &Orbit) -> FamilyCourse {
        FamilyCourse { orbit: orbit.clone(), own: None, sides: None, cancelled: false }
    }

    /// The orbit that it begins with.
    pub fn orbit(&self) -> &Orbit {
        &self.orbit
    }

    /// Whether it has been followed to its ends.
    pub fn is_complete(&self) -> bool {
        let ended = |sides: &[FamilySide; 2]| sides.iter().all(|side| side.ended.is_some());
        self.cancelled || self.sides.as_ref().is_some_and(ended)
    }

    /// Follows it on by at most so many steps on each side. What changes and what is held fixed, and the drive, are to be the
    /// same for all parts.
    ///
    /// # Errors
    /// Returns an error if the family has no such values.
    pub fn follow(
        &mut self,
        space: &PhaseSpace,
        method: (&'static Method, Settings),
        (along, fixed, drive): (Along, Fixed, Option<DrivePeriod<'_>>),
        (values, report): (&[f64], &dyn Fn(f64)),
        steps: usize,
    ) -> Result<(), DynamicsError> {
        let ratio = drive.and_then(|drive| drive(space.parameters()));
        let ratio = ratio.map(|period| self.orbit.period / period);
        // a period that is not a multiple of the drive's is kept
        let ratio = ratio.filter(|ratio| is_whole(*ratio)).map(f64::round);
        let drive = ratio.zip(drive);
        // only the members are to have all digits
        let (exact, method) = (method, (method.0, method.0.fast(method.1)));
        let casimirs = &space.casimirs(&self.orbit.state)?;
        let continuation =
            Continuation { space, method, exact, along, fixed, values, casimirs, drive };
        let (low, high) = continuation.range();
        let mut sides = match self.sides.take() {
            Some(sides) => sides,
            None => {
                let first = continuation.begun(&self.orbit)?;
                if values.contains(&first.value) && (low..=high).contains(&first.value) {
                    let (value, orbit) = (first.value, first.orbit.clone());
                    self.own = Some(Member { value, orbit, bifurcation: None });
                }
                let mut backwards = first.clone();
                backwards.tangent.neg_mut();
                [backwards, first].map(|begin| continuation.side(begin))
            }
        };
        let first = sides[0].begin.value;
        let lengths = [first - low, high - first].map(|length| length.max(0.0));
        let done = |side: &FamilySide, length: f64| match side.ended {
            Some(_) => length,
            None => (side.here.value - first).abs().min(length),
        };
        for which in 0..2 {
            for _ in 0..steps {
                if sides[which].ended.is_some() || self.cancelled {
                    break;
                }
                match continuation.advance(&mut sides[which]) {
                    Ok(()) => {}
                    Err(error) if error.is_cancelled() => self.cancelled = true,
                    Err(error) => {
                        let why = Continuation::failed(&sides[which], &error);
                        sides[which].ended = Some(SideEnd::Before(why));
                    }
                }
                let behind: f64 = (0..2).map(|k| done(&sides[k], lengths[k])).sum();
                report(behind / (high - low));
            }
        }
        self.sides = Some(sides);
        Ok(())
    }

    /// The family as far as it is known.
    pub fn family(&self) -> Family {
        let mut members: Vec<Member> = Vec::new();
        let mut ended = Vec::new();
        if let Some([before, after]) = &self.sides {
            // backwards first, so that the members follow each other
            members.extend(before.members.iter().rev().cloned());
            members.extend(self.own.clone());
            members.extend(after.members.iter().cloned());
            ended.extend([before, after].iter().filter_map(|side| match &side.ended {
                Some(SideEnd::Before(why)) => Some(why.clone()),
                _ => None,
            }));
        }
        let alone = |side: &FamilySide| side.begin.directions == 1 || side.here.directions == 1;
        let isolated = self.sides.as_ref().is_none_or(|sides| sides.iter().any(alone));
        Family { members, ended, isolated }
    }
}
