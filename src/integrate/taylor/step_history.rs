//! What is remembered of the steps of a motion, until it begins again.
//!
//! In: the size of each step, and where it ended. Out: what the next steps are compared with. Never here: where a step ends.

use super::unit_of_time::UnitOfTime;

/// This many collocation steps must advance the time by this part of the time that has passed.
const ROUND: u32 = 64;
const LEAST: f64 = 1e-15;

/// Steps that lead away from a point do not shrink by more than this factor.
const SHRINKING: f64 = 0.1;

#[derive(Debug)]
pub(super) struct StepHistory {
    pub(super) unit: UnitOfTime,
    /// The longest step since the last kink, relative to which a step counts as short.
    pub(super) stride: f64,
    /// The last step, and whether it and those before lead away from a point that was passed.
    last: f64,
    is_leaving: bool,
    /// Whether the motion approaches, or passes closely, a point where a power is zero.
    pub(super) is_passing: bool,
    /// How wide the place in the law is before which the last step had to end.
    pub(super) narrow: Option<f64>,
    /// The size of the steps from which on the motion is no longer in a narrow place.
    out_of: f64,
    /// How many steps in succession had to end before such a place.
    shortened: u32,
    /// How many steps have been taken in it, and how long steps were before it.
    inside: u32,
    outside: f64,
    /// Whether no series continues from the current state.
    pub(super) landed: bool,
    /// The step before which the motion was last taken to touch rest, and did not.
    pub(super) touch_tried: f64,
    /// The number of collocation steps, and the time at the end of their last round.
    leaps: (u32, f64),
}

impl Default for StepHistory {
    fn default() -> StepHistory {
        StepHistory {
            unit: UnitOfTime::default(),
            stride: 0.0,
            last: f64::INFINITY,
            is_leaving: false,
            is_passing: false,
            narrow: None,
            out_of: 0.0,
            shortened: 0,
            inside: 0,
            outside: 0.0,
            landed: false,
            touch_tried: f64::INFINITY,
            leaps: (0, f64::NAN),
        }
    }
}

/// A step is long from this part of the longest one on.
const LONG: f64 = 0.1;

/// A motion is out of a narrow place when its steps are this many times as long as that is wide.
const OUT_OF: f64 = 10.0;

/// So many steps in succession end before a narrow place; the next one is taken as its series allows. From the foot of a wall on
/// the series shows it, so that a few are enough.
const SHORTENED: u32 = 64;

/// No narrow place takes more steps than this. What does is a point that steps only come closer to, and they vanish beside those
/// before it.
const INSIDE: u32 = 500;

impl StepHistory {
    /// Whether a step may end before a narrow place.
    pub(super) fn may_be_shortened(&mut self) -> bool {
        self.narrow = None;
        self.shortened < SHORTENED
    }

    /// Whether the motion is in a place of the law that is narrow, where steps may be short.
    pub(super) fn is_in_narrow_place(&self) -> bool {
        self.out_of > 0.0
    }

    /// Whether the last step was about as long as any since the last kink.
    pub(super) fn is_long(&self) -> bool {
        self.last >= LONG * self.stride
    }

    /// Whether a step leads away from a point that was passed: such steps become longer by themselves. Those after one that is
    /// not `tiny` do not count as such.
    pub(super) fn leads_away(&mut self, step: f64, tiny: f64) -> bool {
        let leads_away = self.is_leaving && step > SHRINKING * self.last;
        self.is_leaving &= step <= tiny;
        leads_away
    }

    /// Records a step of this size on whose way nothing could happen.
    pub(super) fn passed_plainly(&mut self, size: f64) {
        (self.is_leaving, self.is_passing) = (false, false);
        self.stepped(size, false, false);
    }

    /// Counts a collocation step at a time. Returns false if these no longer advance the time.
    pub(super) fn count_leap(&mut self, time: f64, left: f64) -> bool {
        self.leaps.0 += 1;
        if !self.leaps.0.is_multiple_of(ROUND) {
            return true;
        }
        let before = std::mem::replace(&mut self.leaps.1, time);
        // the time of the round before is not a number in the first one
        let stands = (time - before).abs() <= LEAST * (time.abs() + left.abs());
        !stands
    }

    /// Records a collocation step of this size.
    pub(super) fn leapt(&mut self, size: f64) {
        self.landed = false;
        (self.stride, self.last, self.is_leaving) = (size, size, true);
        self.unit.taken = Some(size);
    }

    /// Records a step along a series of this size, which may have `landed` where no series continues, or `turned` on a kink.
    pub(super) fn stepped(&mut self, size: f64, landed: bool, turned: bool) {
        (self.last, self.landed) = (size, landed);
        self.stride = if turned { size } else { self.stride.max(size) };
        if let Some(width) = self.narrow.take() {
            if !self.is_in_narrow_place() {
                (self.inside, self.outside) = (0, self.stride);
            }
            // what follows is as short as that place is narrow
            (self.stride, self.out_of) = (width, OUT_OF * width);
            self.shortened += 1;
            return;
        }
        self.shortened = 0;
        if !self.is_in_narrow_place() {
            return;
        }
        self.inside += 1;
        if size > self.out_of {
            self.out_of = 0.0;
        } else if self.inside > INSIDE {
            (self.out_of, self.stride) = (0.0, self.outside);
        } else {
            // nothing there is short beside the steps before
            self.stride = size;
        }
    }
}
