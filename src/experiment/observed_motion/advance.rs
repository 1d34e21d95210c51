//! An observed motion advanced: its steps, with the gauges and the step log observing each.
//!
//! In: a time, a budget of steps. Out: what was reached. Never here: rows.

use super::super::gathered_states::ObservedAt;
use super::super::gauges::{Gauges, by_rounding_of_state};
use super::super::step_sampler::StepSampler;
use super::{EQUAL_STEPS, ObservedMotion, mark_lost};
use crate::integrate::{OccurrenceKind, Reached, Stepping};
use crate::system::MotionError;

/// A method whose dense output is as accurate as its steps is observed inside one of so many steps.
const OBSERVED_INSIDE: u64 = 4;

impl ObservedMotion {
    /// Advances to `time`, or to the first occurrence before it, in at most `budget` steps, which are subtracted from
    /// it. No step reaches beyond `limit`, unless the method's step is fixed. The gauges sample every step; rows are
    /// `spacing` apart.
    pub(in crate::experiment) fn reach(
        &mut self,
        time: f64,
        limit: f64,
        budget: &mut u64,
        (gauges, spacing): (&mut Gauges, f64),
    ) -> Result<Reached, MotionError> {
        self.watch.prepare(self.inner.system(), self.inner.computed().form);
        let reached = self.reach_unrecorded(time, limit, budget, (gauges, spacing));
        self.watch.record_gathered(gauges);
        reached
    }

    /// The same, but the terms at the last states may not have been recorded yet.
    fn reach_unrecorded(
        &mut self,
        time: f64,
        limit: f64,
        budget: &mut u64,
        (gauges, spacing): (&mut Gauges, f64),
    ) -> Result<Reached, MotionError> {
        loop {
            *budget -= self.several_steps(time, *budget, gauges, spacing)?;
            let (before, mut one) = (self.inner.steps(), (*budget).min(1));
            let reached = self.inner.reach(time, limit, &mut one)?;
            let new = self.inner.steps() != before;
            if new {
                *budget -= 1;
                self.log_step();
            }
            // an impulse ends the step where it acts, and the state there is that after it
            if let Reached::Occurred(occurrence) = &reached
                && !matches!(occurrence.kind, OccurrenceKind::Mark | OccurrenceKind::Crossing(_))
            {
                self.watch.pending = false;
            }
            self.observe_step(gauges, spacing, new)?;
            match &reached {
                Reached::OutOfBudget if *budget > 0 => continue,
                Reached::Occurred(occurrence) => self.record(occurrence)?,
                Reached::Arrived => self.observe()?,
                Reached::OutOfBudget | Reached::Ended => {}
            }
            return Ok(reached);
        }
    }

    /// Takes several steps at once until `time` is reached or passed, where only the gauges observe the states between
    /// them. Returns their number.
    fn several_steps(
        &mut self,
        time: f64,
        budget: u64,
        gauges: &mut Gauges,
        spacing: f64,
    ) -> Result<u64, MotionError> {
        if self.inner.method().stepping != Stepping::Fixed {
            return Ok(0);
        }
        // what waits was before
        self.watch.record_gathered(gauges);
        let time = time.min(self.watch.next);
        let mut left = budget;
        while left > 0 && !self.watch.pending && self.inner.computed().time < time {
            let StepSampler { batch_terms: Some(terms), block, next, terms: single, .. } =
                &mut self.watch
            else {
                break;
            };
            let steps = self.inner.steps();
            let most = left.min(self.log.steps_to_next(steps, EQUAL_STEPS));
            let taken = self.inner.steps_seen(time, most, block);
            if taken == 0 {
                break;
            }
            left -= taken;
            let (block, sign) = (&*block, self.sign);
            let dense = |step: usize| {
                let (begin, end) = block.interval(step);
                (end - begin).abs() >= spacing
            };
            // the step after which the channels are sampled is the last
            let last = block.count - 1;
            let due = !dense(last) && block.times.0[last] >= *next;
            let count = if due { last } else { block.count };
            let form = self.inner.computed().form;
            terms.evaluate_numbers(block.times, &block.numbers);
            if terms.are_regular(count) {
                let ends = (0..count).zip(steps + 1..);
                let ends = ends.map(|(i, steps)| (sign * block.times.0[i], steps, dense(i)));
                gauges.steps(ends, terms, &mut |lane, quantity| {
                    single
                        .observe(&block.state(lane, form))
                        .then(|| by_rounding_of_state(single, quantity))?
                });
            } else {
                for (i, steps) in (0..count).zip(steps + 1..) {
                    if single.observe(&block.state(i, form)) {
                        gauges.step(sign * block.times.0[i], steps, single, dense(i));
                    }
                }
            }
            if due {
                self.observe_step(gauges, spacing, true)?;
                self.watch.record_gathered(gauges);
            }
            self.log_step();
        }
        Ok(budget - left)
    }

    /// Lets the gauges sample the last step: at its end, and also within it if rows may be farther apart than steps
    /// and the method is as accurate there as at the ends. A state that cannot be observed is skipped; its error
    /// appears again when it is requested. Where events are searched for in several pieces of a step, its end is free of
    /// them only after the last.
    fn observe_step(
        &mut self,
        gauges: &mut Gauges,
        spacing: f64,
        new: bool,
    ) -> Result<(), MotionError> {
        let (begin, end) = self.inner.undisturbed();
        let steps = self.inner.steps();
        self.watch.pending |= new;
        // exactly at a step in time its law has two values
        let whole = self.watch.pending
            && end == self.inner.computed().time
            && !self.inner.ends_at_step_in_time()?;
        if !new && !whole {
            return Ok(());
        }
        self.watch.pending &= !whole;
        if !self.watch.resolves([begin, end], spacing) {
            return Ok(());
        }
        let sparse = (end - begin).abs() < spacing;
        let due = sparse && end >= self.watch.next;
        if due {
            self.watch.next = end + spacing * (0.5 + self.watch.next_weyl());
        }
        let ObservedMotion { inner, watch, observer, lost, inside, sign, .. } = self;
        let at = |clock: f64, dense| ObservedAt { clock, time: *sign * clock, steps, dense };
        let of_series = inner.method().order.is_none();
        // the state of a series is as accurate within a step as at its end
        let observes_inside = new && sparse && (due || steps.is_multiple_of(OBSERVED_INSIDE));
        if observes_inside && of_series {
            let time = begin + watch.next_weyl() * (end - begin);
            if inner.anywhere_inside(time, inside).is_ok() {
                if due && watch.observe_channels(inside, at(time, false), observer, gauges) {
                    mark_lost(lost, &watch.values);
                }
                watch.observe(inside, at(time, false), gauges);
            }
        }
        if whole {
            let (state, at) = (inner.computed(), at(end, !sparse));
            if due && !of_series && watch.observe_channels(state, at, observer, gauges) {
                mark_lost(lost, &watch.values);
            }
            watch.observe(state, at, gauges);
        }
        Ok(())
    }

    /// Logs the state at the end of the last step. Equal steps are short, and any of them can be taken again.
    fn log_step(&mut self) {
        if self.log.is_off() {
            return;
        }
        let steps = self.inner.steps();
        let is_logged = match self.inner.method().stepping {
            Stepping::Adaptive => true,
            Stepping::Fixed => steps.is_multiple_of(EQUAL_STEPS),
        };
        if is_logged {
            self.log.push(self.inner.computed(), steps, self.inner.step_size().abs());
        }
    }
}
