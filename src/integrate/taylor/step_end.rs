//! The end of a step along a series: the farthest its terms allow, the limit, a kink, or a point where a series has no
//! radius of convergence.
//!
//! In: the series at the current state, the longest step that it allows, the time to go. Out: where the step ends, and
//! the state there. Never here: building series, and what continues from a point without one.

use super::branches::Passing;
use super::kinks::{KinkCrossing, represents};
use super::{Taylor, branches, snap_to_kinks};
use crate::num::DoubleDouble;
use crate::system::{MotionError, MotionErrorKind};

/// A step shorter than this part of those before it ends at a point where a series has no radius of convergence.
const VANISHING: f64 = 1e-11;

/// The same part where all is in `f64`, whose digits do not tell nearer points apart.
pub(super) const VANISHING_IN_F64: f64 = 1e-8;

/// So does a step this short relative to the time, which will soon no longer advance it.
pub(super) const SOON_STALLED: f64 = 1e-15;

/// A point this close, relative to the steps before it, counts as reached.
const TOUCHING: f64 = 1e-15;

/// A step this short relative to the time hardly advances it.
const STALLED: f64 = 5e-17;

/// A step this short relative to the time cannot continue.
const SMALLEST: f64 = 1e-17;

/// A surface or a point where forces grow without bound is approached up to this part, since the time is in
/// double-double. A nearer one counts as reached.
const NEAREST: f64 = 1e-30;

/// The last terms of all series may be this part of their largest at a surface or point that is reached beyond the
/// step.
const LAST_DIGIT: f64 = 1e-17;

/// The last terms may be this part of the largest where the surface cannot be approached any farther. If they are
/// larger, as at a pole, it cannot be reached.
const NEARLY: f64 = 1e-6;

/// How far beyond such a short step the point is searched for, in steps.
const BEYOND: f64 = 8.0;

/// The part of the time to a point that is stepped if a motion passes it closely.
const NEARER: f64 = 0.5;

/// The zero of a root that only touches zero is known to some of its digits; a kink, or another root's zero, this close behind, in
/// parts of the time to it, may be where it is.
const BEHIND: f64 = 1e-3;

/// The maximal number of halvings of a step that has left a branch.
const HALVINGS: u32 = 60;

/// A number this small relative to the terms of its series is zero; the rest is rounding.
const ROUNDING: f64 = 1e-18;

pub(super) struct StepEnd {
    /// The time from its beginning.
    after: DoubleDouble,
    /// The surface that it ends on.
    crossing: Option<KinkCrossing>,
    /// Whether it ends at the limit.
    last: bool,
    /// Whether no series continues from there.
    landed: bool,
    /// Whether it is so short that it ends at a point where a series has no radius of convergence.
    vanishing: bool,
}

impl StepEnd {
    /// Whether it is a point from which no series continues, which the series here shows.
    pub(super) fn is_branch_point(&self) -> bool {
        self.landed && !self.vanishing
    }
}

impl Taylor {
    /// Takes a step that may be this long, with `left` to go to the limit, where nothing can happen on the way: there are no
    /// kinks and no steep powers, no root may leave its branch, and the steps do not vanish. Returns false elsewhere.
    pub(super) fn take_plain_step(
        &mut self,
        step: f64,
        (left, limit): (DoubleDouble, f64),
    ) -> Result<bool, MotionError> {
        let (time, scale) = (self.state.time.abs(), self.series.scale());
        let may_turn = self.series.switches() > 0 || self.series.is_steep();
        if may_turn || step <= self.smallest() * time || self.vanishes(step) {
            return Ok(false);
        }
        let last = step >= left.high.abs();
        let after = if last { left } else { DoubleDouble::from(step.copysign(left.high)) };
        let x = after.high / scale;
        if branches::may_stray(&self.series, x)
            || self.may_hide(x) && self.agreeing_part(after)? < 1.0
        {
            return Ok(false);
        }
        self.begin = self.state.time;
        self.series.state_after(after, &mut self.state);
        let size = after.high.abs();
        self.history.passed_plainly(size);
        if last {
            self.state.time = limit;
        } else {
            self.history.unit.take(size, step, left.high);
        }
        self.system.check_finite(&self.state)?;
        Ok(true)
    }

    /// Whether a step is so short that it ends at a point where a series has no radius of convergence.
    fn vanishes(&self, step: f64) -> bool {
        let part = if self.exact { VANISHING } else { VANISHING_IN_F64 };
        let stalls = step < SOON_STALLED * self.state.time.abs();
        step < part * self.history.stride || (stalls && !self.history.is_in_narrow_place())
    }

    /// How short a step may be relative to the time. The time is in double-double, but only before what is known to be narrow is
    /// it worth while.
    fn smallest(&self) -> f64 {
        if self.history.is_in_narrow_place() { NEAREST } else { SMALLEST }
    }

    /// Where a step ends that may be this long, with `left` to go; `None` if another kind of step was taken instead.
    pub(super) fn end_of_step(
        &mut self,
        step: f64,
        left: DoubleDouble,
    ) -> Result<Option<StepEnd>, MotionError> {
        let time = self.state.time.abs();
        let scale = self.series.scale();
        let vanishing = self.vanishes(step);
        let last = step >= left.high.abs();
        let after = if last { left } else { DoubleDouble::from(step.copysign(left.high)) };
        // what makes the steps vanish lies a little farther than they reach
        let end = if vanishing { BEYOND * step / scale.abs() } else { after.high / scale };
        let end = end.min((left.high / scale).abs());
        let found = self.kinks.first(&self.series, end, self.history.stride);
        let zero = if vanishing && found.is_none() {
            branches::predicted(&self.series, end)
        } else {
            None
        };
        // beside such a point the steps are as short as the distance from it
        self.history.is_passing = zero.is_some() || (self.history.is_passing && vanishing);
        let approaching = self.history.is_passing || (vanishing && found.is_some());
        let nearest = approaching && step <= NEAREST * time;
        let smallest = self.smallest() * time;
        let leaving = self.history.leads_away(step, smallest);
        // nearer than that a number which goes to zero as well has no digits to gain
        let known = if nearest { (NEARLY, Some(&self.sizes[..])) } else { (LAST_DIGIT, None) };
        let crossing = found
            .filter(|crossing| !vanishing || crossing.is_known(&self.series, known.0, known.1));
        let zero = zero.filter(|&x| represents(&self.series, x, known));
        let short = step <= smallest && !approaching && !leaving;
        if short || (nearest && crossing.is_none() && zero.is_none()) {
            let kind = MotionErrorKind::StepUnderflow(step);
            return Err(self.system.error(kind, self.state.time, &self.state.values));
        }
        self.begin = self.state.time;
        let mut end_of_step = match crossing {
            Some(crossing) => {
                let after = crossing.after * scale;
                StepEnd { after, crossing: Some(crossing), last: false, landed: false, vanishing }
            }
            None => StepEnd { after, crossing: None, last, landed: false, vanishing },
        };
        let stalled = step < STALLED * time && !self.history.is_in_narrow_place();
        let hardly_moves = step < TOUCHING * self.history.stride || stalled;
        if let Some(x) = zero {
            (end_of_step.last, end_of_step.landed) = (false, true);
            end_of_step.after = DoubleDouble::from(x * scale);
        } else if vanishing
            && !approaching
            && hardly_moves
            && !self.meets_pole(BEYOND * step / scale.abs())?
            && self.leap(left.high, BEYOND * step)?
        {
            return Ok(None);
        }
        if !(end_of_step.landed || approaching) {
            // near a branch point rounding alone makes steps short
            let reach = if vanishing { 2.0 * step } else { step };
            self.end_at_branch_point(&mut end_of_step, reach, left.high.abs());
        }
        Ok(Some(end_of_step))
    }

    /// Ends a step at a branch point within `reach`, or nearer if the motion only passes it, with `left` to go to the limit.
    fn end_at_branch_point(&mut self, end: &mut StepEnd, reach: f64, left: f64) {
        let scale = self.series.scale();
        let left = left / scale.abs();
        let mut reach = (reach / scale.abs()).min(left);
        if end.crossing.is_some() {
            reach = reach.min(end.after.high.abs() / scale.abs());
        }
        let Some(passing) = branches::first(&self.series, reach) else { return };
        let within = TOUCHING * self.history.stride / scale.abs();
        let behind = self.behind(&passing, end.crossing.take(), (within, left));
        let (passing, crossing) = behind.unwrap_or((passing, None));
        if let Some(crossing) = crossing {
            (end.last, end.landed, end.after) = (false, false, crossing.after * scale);
            end.crossing = Some(crossing);
            return;
        }
        let there = passing.after * scale;
        end.landed = self.is_zero_at(&passing, passing.after, within) == Some(true)
            || there.high.abs() < TOUCHING * self.history.stride;
        (end.last, end.crossing) = (false, None);
        end.after = if end.landed { there } else { there * NEARER };
    }

    /// Where a root is zero that passes or touches zero near a point: at a kink close behind it, of which one is known already, or at
    /// the zero of another root, if it is zero there as well.
    fn behind(
        &mut self,
        passing: &Passing,
        known: Option<KinkCrossing>,
        (within, left): (f64, f64),
    ) -> Option<(Passing, Option<KinkCrossing>)> {
        let end = (passing.after.high * (1.0 + BEHIND)).min(left);
        let crossing = known.or_else(|| self.kinks.first(&self.series, end, self.history.stride));
        let crossing = crossing.filter(|crossing| crossing.after.high <= end);
        if let Some(crossing) = crossing
            && self.is_zero_at(passing, crossing.after, within) != Some(false)
        {
            return Some((passing.at(crossing.after), Some(crossing)));
        }
        let other = branches::first_behind(&self.series, passing, end)?;
        let coincide = self.is_zero_at(passing, other.after, within) != Some(false);
        coincide.then_some((other, None))
    }

    /// Whether the root that passes or touches zero is zero at a time after the origin of the series, in its unit; `None` where
    /// the rates have no value.
    fn is_zero_at(&mut self, passing: &Passing, after: DoubleDouble, within: f64) -> Option<bool> {
        let origin = self.state.clone();
        self.series.state_after(after * self.series.scale(), &mut self.state);
        let known = self.evaluate_rates().is_ok();
        self.state = origin;
        known.then(|| branches::is_exact(&self.series, &passing.at(after), &self.rates, within))
    }

    /// Takes a step that could be this long to its end, with `left` to go to the limit.
    pub(super) fn go_to(
        &mut self,
        mut end: StepEnd,
        step: f64,
        (left, limit): (f64, f64),
    ) -> Result<(), MotionError> {
        let begin = self.state.time;
        // on the surface itself a root may be beyond its branch by rounding
        let is_there =
            end.crossing.is_some() && end.after.high.abs() < TOUCHING * self.history.stride;
        if end.landed || end.vanishing || is_there {
            let from = self.system.work_place().map(|_| self.state.clone());
            self.series.state_after(end.after, &mut self.state);
            self.clear(end.after.high / self.series.scale());
            if let Some(from) = from {
                self.take_work_of_arrival(&from)?;
            }
        } else {
            let part = self.advance(end.after)?;
            if part < 1.0 {
                (end.last, end.crossing, end.after) = (false, None, end.after * part);
            }
        }
        let size = end.after.high.abs();
        let turned = end.crossing.is_some() && !(end.vanishing || is_there);
        self.history.stepped(size, end.landed, turned);
        if end.last {
            self.state.time = limit;
        } else {
            self.history.unit.take(size, step, left);
        }
        snap_to_kinks(&self.series, &mut self.state);
        if !self.kinks.arrive(end.crossing, &self.series, &mut self.state) {
            return Err(self.system.error(MotionErrorKind::Sticks, begin, &self.state.values));
        }
        self.system.check_finite(&self.state)
    }

    pub(super) fn evaluate_rates(&mut self) -> Result<(), MotionError> {
        let state = &self.state;
        let numbers: Vec<DoubleDouble> = (0..state.values.len()).map(|i| state.exact(i)).collect();
        self.rates.evaluate(state.exact_time(), &numbers)
    }

    /// Advances along the series and shortens the step until no root has left its branch there, and
    /// the law within it does not contradict its series.
    /// Returns the part of the time that is left.
    fn advance(&mut self, after: DoubleDouble) -> Result<f64, MotionError> {
        let (mut part, scale) = (1.0, self.series.scale());
        if self.may_hide(after.high / scale) {
            part = self.agreeing_part(after)?;
        }
        if !branches::may_stray(&self.series, after.high * part / scale) {
            self.series.state_after(after * part, &mut self.state);
            return Ok(part);
        }
        let from = self.state.clone();
        for _ in 0..HALVINGS {
            let x = after.high * part / scale;
            self.series.state_after(after * part, &mut self.state);
            if self.series.guards() == 0 {
                return Ok(part);
            }
            let outcome = self.evaluate_rates();
            if outcome.is_ok() && !branches::strayed(&self.series, x, &self.rates) {
                return Ok(part);
            }
            part *= 0.5;
        }
        self.state = from;
        let kind = MotionErrorKind::StepUnderflow(after.high * part);
        Err(self.system.error(kind, self.state.time, &self.state.values))
    }

    /// Sets numbers that have reached zero to exactly zero.
    fn clear(&mut self, x: f64) {
        for i in 0..self.series.inputs() {
            let terms = self.series.coefficients(i).iter();
            let powers = std::iter::successors(Some(1.0), |power| Some(power * x));
            let largest = terms.zip(powers).fold(0.0_f64, |m, (c, p)| m.max((c * p).abs()));
            if self.state.values[i].abs() <= ROUNDING * largest * self.series.unit(i) {
                self.state.set(i, DoubleDouble::ZERO);
            }
        }
    }
}
