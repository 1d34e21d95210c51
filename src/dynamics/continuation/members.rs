//! The members of a family between two of its points: those at given values, folds, and bifurcations.
//!
//! In: two points, one step apart. Out: the members between them, in their order. Never here: the step.

use nalgebra::{DMatrix, DVector};

use super::super::error::DynamicsError;
use super::super::family::{Along, Bifurcation, Member};
use super::super::flow_direction::FlowDirection;
use super::family_end::FamilyEnd;
use super::{Continuation, FamilyPoint};

/// A bifurcation is located to this part of a step, in so many tries at most.
const LOCATED: f64 = 1e-9;
const MOST: usize = 40;

/// So often a step is halved to come near the orbit that others shrink to.
const HALVINGS: usize = 12;

/// One beside an orbit that is the only one known of its family is this part of a step away.
const BESIDE: f64 = 0.1;

/// Then it is come nearer so often, by this part of the way that is left.
const SECANTS: usize = 3;
const NEARER: f64 = 0.75;

/// No more than so many times the way between two orbits is extrapolated.
const FARTHEST: f64 = 100.0;

/// An orbit on which nothing moves faster than this part of what does on one beside it is an equilibrium; one whose neighbours
/// move by no more in a period is what they have shrunk to.
const SLOW: f64 = 0.1;

/// How far the map across an orbit is from the identity, which it is where orbits beside each other shrink to one: like their
/// distance from that in energy and period it falls with the square of their size.
fn moved(point: &FamilyPoint) -> f64 {
    let across = &point.orbit.transverse;
    (across - DMatrix::identity(across.nrows(), across.ncols())).amax()
}

/// The angle by which what is across an orbit is turned, where that is small, but for a factor: Π (μᵢ − 1) is its square. Of a single
/// pair it has a sign.
fn rotation(point: &FamilyPoint) -> Option<f64> {
    let across = &point.orbit.transverse;
    let sense = if across.nrows() == 2 { across[(0, 1)] - across[(1, 0)] } else { 1.0 };
    point.unit().map(|square| square.abs().sqrt().copysign(sense))
}

/// Whether what is across an orbit is turned, and not only sheared, as on a torus, where the rest is rounding.
fn is_turned(point: &FamilyPoint) -> bool {
    let sheared = if point.orbit.transverse.nrows() == 2 { SLOW * moved(point) } else { 0.0 };
    rotation(point).is_some_and(|angle| angle.abs() > sheared)
}

/// The orbit to which these have shrunk where their family turns back at one of them, if they have: the way past that orbit comes
/// near it, not onto it.
fn shrunk_to(turn: &FamilyPoint, beside: [&FamilyPoint; 3]) -> Option<FamilyPoint> {
    let left = moved(turn);
    if left > SLOW * beside.into_iter().map(moved).fold(0.0, f64::max) {
        return None;
    }
    let mut end = turn.clone();
    if let Some(other) = beside.into_iter().find(|other| moved(other) > 2.0 * left) {
        let part = left / (moved(other) - left);
        end.value += part * (turn.value - other.value);
        end.period += part * (turn.period - other.period);
    }
    Some(end)
}

impl Continuation<'_> {
    /// Whether orbits with others of the same value beside them are isolated at the second point: what they have shrunk to, as
    /// rosettes to a circle, belongs to another family of the same system.
    fn isolates(&self, from: &FamilyPoint, to: &FamilyPoint) -> bool {
        let is_same_system = !matches!(self.along, Along::Parameter(_));
        is_same_system && from.unit().is_none() && is_turned(to)
    }

    /// Collects the members between two points, a step apart, in their order. Returns where the family ends between them, if it
    /// does: beyond that come the same orbits, half a period later, or those to which they have shrunk. It began at `begin`.
    pub(super) fn between(
        &self,
        (from, to, step): (&FamilyPoint, &FamilyPoint, f64),
        begin: &FamilyPoint,
        members: &mut Vec<Member>,
    ) -> Result<Option<FamilyEnd>, DynamicsError> {
        let (low, high) = self.range();
        let equilibrium = self.equilibrium(from, to, step)?;
        let mut until = equilibrium.as_ref().map_or(f64::INFINITY, |(part, _)| *part);
        let mut end = equilibrium.as_ref().map(|(_, point)| FamilyEnd::Equilibrium(point.clone()));
        let mut found: Vec<(f64, Member)> = Vec::new();
        let [before, after] = [self.slope(from)?, self.slope(to)?];
        let folds = equilibrium.is_none() && (before < 0.0) != (after < 0.0);
        let mut specials: Vec<(
            Bifurcation,
            Box<dyn Fn(&FamilyPoint) -> Result<f64, DynamicsError> + '_>,
        )> = Vec::new();
        if folds {
            specials.push((Bifurcation::Fold, Box::new(|point: &FamilyPoint| self.slope(point))));
        }
        // what is rounding at either end has no sign
        let changes =
            |ends: [Option<f64>; 2]| matches!(ends, [Some(a), Some(b)] if (a < 0.0) != (b < 0.0));
        if changes([from.doubling(), to.doubling()]) {
            let test = |point: &FamilyPoint| Ok(point.doubling().unwrap_or(0.0));
            specials.push((Bifurcation::PeriodDoubling, Box::new(test)));
        }
        if !folds && changes([from.unit(), to.unit()]) {
            let test = |point: &FamilyPoint| Ok(point.unit().unwrap_or(0.0));
            specials.push((Bifurcation::Branching, Box::new(test)));
        }
        for (kind, test) in specials {
            let close = |_: &FamilyPoint, moved: f64| moved <= LOCATED * step;
            let located = self.located((from, to, step), &*test, &close)?;
            if let Some((part, point)) = &located
                && kind == Bifurcation::Fold
                && begin.directions > 1
            {
                // what is found may be on the family of the orbit that these shrink to
                let shrunk = if self.isolates(from, point) {
                    Some(self.shrunk(from, point, *part)?)
                } else {
                    shrunk_to(point, [from, to, begin]).map(|orbit| (*part, orbit))
                };
                if let Some((place, orbit)) = shrunk {
                    until = place;
                    end = Some(FamilyEnd::Branching(orbit));
                    continue;
                }
            }
            if let Some((part, point)) = located
                && (low..=high).contains(&point.value)
            {
                let value = point.value;
                let orbit = self.member(from, point)?;
                found.push((part, Member { value, orbit, bifurcation: Some(kind) }));
            }
        }
        if begin.directions > 1 && end.is_none() && self.isolates(from, to) {
            let (part, point) = self.shrunk(from, to, step)?;
            until = part;
            end = Some(FamilyEnd::Branching(point));
        }
        for &value in self.values {
            if (from.value < value) == (to.value < value) || from.value == value {
                continue;
            }
            let unit = value.abs().max(1e-2);
            let close = |point: &FamilyPoint, _: f64| (point.value - value).abs() <= 1e-12 * unit;
            let off = |point: &FamilyPoint| Ok(point.value - value);
            let has_value = |point: &FamilyPoint| (point.value - value).abs() <= 1e-9 * unit;
            let mut located = self.located((from, to, step), &off, &close)?;
            // where an orbit has neighbours in many directions, rounding may leave this method no such digits
            if let Some(exact) = self.exact()
                && !located.as_ref().is_some_and(|(_, point)| has_value(point))
            {
                located = exact.located((from, to, step), &off, &close)?;
            }
            let (part, point) = located.unwrap_or_else(|| (step, to.clone()));
            // a member that was not found is left out
            if !has_value(&point) {
                continue;
            }
            let orbit = self.member(from, point)?;
            found.push((part, Member { value, orbit, bifurcation: None }));
        }
        found.retain(|(part, _)| *part < until);
        found.sort_by(|x, y| x.0.total_cmp(&y.0));
        members.extend(found.into_iter().map(|(_, member)| member));
        Ok(end)
    }

    /// The orbit to which those at the first of two points have shrunk before the second, which is on the family of that orbit. A
    /// point between them leads to either family, so that the orbit itself is extrapolated along its own: the rotation across
    /// it, whose square Π (μᵢ − 1) is, vanishes there to first order.
    fn shrunk(
        &self,
        from: &FamilyPoint,
        to: &FamilyPoint,
        step: f64,
    ) -> Result<(f64, FamilyPoint), DynamicsError> {
        let (mut low, mut high, mut end, mut before) = (0.0, step, to.clone(), to.clone());
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let by = from.part_way(to, step, middle / step);
            let Some((point, _)) = self.corrected(from, &by)? else { break };
            if is_turned(&point) {
                high = middle;
                before = std::mem::replace(&mut end, point);
            } else {
                low = middle;
            }
        }
        if high == step
            && let Some((beside, _)) = self.corrected(&end, &(&end.tangent * (BESIDE * step)))?
        {
            before = beside;
        }
        // the part of the way from the one to the other that is left; back, where the orbit lies between or behind them
        let left = |before: &FamilyPoint, end: &FamilyPoint| {
            let part = rotation(end).zip(rotation(before)).map(|(near, far)| near / (far - near));
            part.filter(|part| part.abs() <= FARTHEST).unwrap_or(0.0)
        };
        for _ in 0..SECANTS {
            let part = NEARER * left(&before, &end);
            let by = before.change(&end) * part;
            match self.corrected(&end, &by)? {
                Some((point, _)) if part != 0.0 && point.unit().is_some() => {
                    before = std::mem::replace(&mut end, point);
                }
                _ => break,
            }
        }
        let part = left(&before, &end);
        end.value += part * (end.value - before.value);
        end.period += part * (end.period - before.period);
        Ok((high, end))
    }

    /// Where between two points, a step apart, the orbits shrink to an equilibrium: there the direction in which they begin is
    /// reversed.
    fn equilibrium(
        &self,
        from: &FamilyPoint,
        to: &FamilyPoint,
        step: f64,
    ) -> Result<Option<(f64, FamilyPoint)>, DynamicsError> {
        if !self.space.is_autonomous() {
            return Ok(None);
        }
        let rate = |point: &FamilyPoint| -> Result<DVector<f64>, DynamicsError> {
            Ok(FlowDirection::new(&self.space_at(point.parameter)).at(&point.state)?)
        };
        let along = rate(from)?;
        let speed = |point: &FamilyPoint| Ok(rate(point)?.dot(&along));
        if speed(to)? >= 0.0 {
            return Ok(None);
        }
        let close = |_: &FamilyPoint, moved: f64| moved <= LOCATED * step;
        let found = self.located((from, to, step), &speed, &close)?;
        let is_slow = |point: &FamilyPoint| {
            Ok::<_, DynamicsError>(rate(point)?.norm() <= SLOW * along.norm())
        };
        match found {
            Some((part, point)) if is_slow(&point)? => Ok(Some((part, point))),
            _ => Ok(None),
        }
    }

    /// Where between two points, a step apart, a function changes its sign, by the rule of false position with the weight of
    /// an end that stays halved, until `close` says of a point, and of how far it lies from the one before, that it is near
    /// enough. `None` if the family cannot be followed there at all.
    fn located(
        &self,
        (from, to, step): (&FamilyPoint, &FamilyPoint, f64),
        test: &dyn Fn(&FamilyPoint) -> Result<f64, DynamicsError>,
        close: &dyn Fn(&FamilyPoint, f64) -> bool,
    ) -> Result<Option<(f64, FamilyPoint)>, DynamicsError> {
        let (mut a, mut b) = (0.0, step);
        let (mut fa, mut fb) = (test(from)?, test(to)?);
        let mut last = None;
        let (mut before, mut moved_end) = (f64::INFINITY, None);
        for _ in 0..MOST {
            if fb == 0.0 && last.is_none() {
                return Ok(Some((step, to.clone())));
            }
            let middle = a + (b - a) * fa / (fa - fb);
            let by = from.part_way(to, step, middle / step);
            let Some((point, _)) = self.corrected(from, &by)? else { break };
            let value = test(&point)?;
            let is_close = value == 0.0 || close(&point, (middle - before).abs());
            last = Some((middle, point));
            before = middle;
            if is_close {
                break;
            }
            let moves_end = (value < 0.0) == (fb < 0.0);
            // an end that stays twice counts half
            let weight = if moved_end == Some(moves_end) { 0.5 } else { 1.0 };
            if moves_end {
                (b, fb, fa) = (middle, value, weight * fa);
            } else {
                (a, fa, fb) = (middle, value, weight * fb);
            }
            moved_end = Some(moves_end);
        }
        Ok(last)
    }
}
