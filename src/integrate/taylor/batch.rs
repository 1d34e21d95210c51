//! Taylor series of several orbits at once.
//!
//! In: a state, parameters and a limit for each lane. Out: the steps that [`Taylor`](super::Taylor)
//! takes in `f64` where nothing on the way is out of the ordinary. What else that does (another unit
//! of time, points that a series cannot pass, numbers out of range) it does alone, so the orbit is
//! given back as [`LaneStatus::Irregular`]. Never here: kinks, occurrences.

use super::batch_step_size::BatchStepSize;
use super::decimal_limit::DecimalLimit;
use super::expansion::{NEARBY_UNITS, UnitTrial, UnitTrials};
use super::step_end::{SOON_STALLED, VANISHING_IN_F64};
use super::step_size::SeriesOrders;
use super::unit_of_time::UnitOfTime;
use super::verification::may_hide_in_lane;
use super::{EXACT_BELOW, METHOD, part_of_step};
use crate::integrate::lane_status::LaneStatus;
use crate::integrate::method::{Method, Settings};
use crate::num::{BATCH, DoubleDouble};
use crate::system::{BatchSeries, BatchStates, State, System};

#[derive(Clone, Debug)]
struct TaylorLane {
    status: LaneStatus,
    unit: UnitOfTime,
    /// The longest step.
    stride: f64,
    limit: DecimalLimit,
}

/// Orbits by Taylor series, side by side.
pub(in crate::integrate) struct TaylorBatch {
    system: System,
    series: BatchSeries,
    rule: BatchStepSize,
    /// Whether the law has poles that a series may not show.
    has_poles: bool,
    states: BatchStates,
    lanes: [TaylorLane; BATCH],
    /// The state that was asked for last.
    shown: State,
}

impl TaylorBatch {
    /// Room for orbits of a system; `None` where they have to be followed one by one.
    pub(in crate::integrate) fn new(
        system: &System,
        method: &Method,
        settings: &Settings,
    ) -> Option<TaylorBatch> {
        let tolerance = settings.tolerance?;
        if method.name != METHOD.name || !(EXACT_BELOW..1.0).contains(&tolerance) {
            return None;
        }
        let orders = SeriesOrders::of(tolerance, system);
        let series = system.batch_series(orders.highest)?;
        let lane = TaylorLane {
            status: LaneStatus::Empty,
            unit: UnitOfTime::default(),
            stride: 0.0,
            limit: DecimalLimit::NONE,
        };
        let state = State::new(0.0, system.form(), vec![0.0; system.state_len()]);
        Some(TaylorBatch {
            system: system.clone(),
            has_poles: series.divisors().next().is_some() || series.tangents().next().is_some(),
            series,
            rule: BatchStepSize::new(tolerance, orders),
            states: BatchStates::new(system.form(), system.state_len()),
            lanes: std::array::from_fn(|_| lane.clone()),
            shown: state,
        })
    }

    pub(in crate::integrate) fn start(
        &mut self,
        lane: usize,
        state: &State,
        parameters: &[f64],
    ) -> LaneStatus {
        let regular = self.series.set_parameters(lane, &self.system.inputs(parameters));
        let own = &mut self.lanes[lane];
        own.status = match self.system.convert(state, self.system.form(), parameters) {
            Ok(state) if regular => {
                self.states.set(lane, &state);
                LaneStatus::Underway
            }
            _ => LaneStatus::Irregular,
        };
        (own.unit, own.stride) = (UnitOfTime::default(), 0.0);
        self.series.set_scale(lane, 1.0);
        own.status
    }

    pub(in crate::integrate) fn clear(&mut self, lane: usize) {
        self.lanes[lane].status = LaneStatus::Empty;
    }

    #[inline]
    pub(in crate::integrate) fn status(&self, lane: usize) -> LaneStatus {
        self.lanes[lane].status
    }

    pub(in crate::integrate) fn state(&mut self, lane: usize) -> &State {
        self.states.write(lane, &mut self.shown);
        &self.shown
    }

    #[inline]
    pub(in crate::integrate) fn time(&self, lane: usize) -> f64 {
        self.states.time(lane).high
    }

    /// The states of all lanes.
    pub(in crate::integrate) fn states(&self) -> &BatchStates {
        &self.states
    }

    /// Takes a step in every lane that is under way. Returns false if it was cancelled.
    #[must_use]
    pub(in crate::integrate) fn step(&mut self, limits: &[f64; BATCH]) -> bool {
        let mut left = [DoubleDouble::ZERO; BATCH];
        let mut going = [false; BATCH];
        for (i, lane) in self.lanes.iter_mut().enumerate() {
            let time = self.states.time(i);
            going[i] = lane.status == LaneStatus::Underway && time.high != limits[i];
            if going[i] {
                left[i] = lane.limit.exact(limits[i]) - time;
                let scale = lane.unit.next(self.series.scale().0[i], left[i].high);
                self.series.set_scale(i, scale);
            }
        }
        self.series.set_states(&self.states, &going);
        let Some(steps) = self.expand(going, &left) else { return false };
        let hides = |lane: usize, after: DoubleDouble, scale: f64| {
            self.has_poles && may_hide_in_lane(&self.series, lane, (after.high / scale).abs())
        };
        let mut after = [DoubleDouble::ZERO; BATCH];
        let mut moving = [false; BATCH];
        for (i, lane) in self.lanes.iter_mut().enumerate() {
            if going[i] {
                let scale = self.series.scale().0[i].abs();
                match lane.choose(steps[i], scale, (self.states.time(i).high, left[i])) {
                    Some(chosen) if self.series.keeps_digits(i) && !hides(i, chosen, scale) => {
                        (after[i], moving[i]) = (chosen, true);
                    }
                    _ => lane.status = LaneStatus::Irregular,
                }
            }
        }
        self.series.states_after(&after, &moving, &mut self.states);
        let finite = self.states.finite();
        for (i, lane) in self.lanes.iter_mut().enumerate().filter(|(i, _)| moving[*i]) {
            let (begin, mut end) = (self.series.time(i), self.states.time(i));
            if lane.unit.taken.is_none() {
                end.high = limits[i];
                self.states.set_time(i, end);
            }
            let moved = (end - begin).high.abs() > 0.0;
            if finite.0[i] != 0.0 || !(moved || left[i].high == 0.0) {
                lane.status = LaneStatus::Irregular;
            }
        }
        true
    }

    /// Builds the series of the lanes that go, in units of time near the steps they allow, and returns these steps; `None` if
    /// it was cancelled. A lane that needs no other unit gets the same series again where another one does.
    fn expand(
        &mut self,
        going: [bool; BATCH],
        left: &[DoubleDouble; BATCH],
    ) -> Option<[f64; BATCH]> {
        let mut units = [const { UnitTrials::NONE }; BATCH];
        let mut steps = [f64::NAN; BATCH];
        let mut searching = going;
        loop {
            if !self.series.build() {
                return None;
            }
            let found = self.rule.longest(&self.series, searching);
            for (i, searches) in searching.iter_mut().enumerate().filter(|(_, on)| **on) {
                let scale = self.series.scale().0[i];
                steps[i] = found.0[i] * scale.abs();
                *searches = false;
                // what is out of range is left to the orbit alone
                if steps[i].is_nan() {
                    continue;
                }
                match units[i].judge(steps[i], left[i].high.abs(), scale.abs()) {
                    UnitTrial::Fits(step) => steps[i] = step,
                    UnitTrial::Try(unit) => {
                        self.series.set_scale(i, unit.copysign(scale));
                        *searches = self.series.scale().0[i] != scale;
                    }
                }
            }
            if !searching.contains(&true) {
                return Some(steps);
            }
        }
    }

    pub(in crate::integrate) fn interval(&self, lane: usize) -> (f64, f64) {
        (self.series.time(lane).high, self.time(lane))
    }

    /// The series of the last step.
    pub(in crate::integrate) fn series(&self) -> &BatchSeries {
        &self.series
    }

    /// Writes the state of a lane at a time within its last step, known beyond the last digit of an `f64`, into `out`.
    pub(in crate::integrate) fn at_exactly(
        &mut self,
        lane: usize,
        time: DoubleDouble,
        out: &mut State,
    ) {
        self.states.write(lane, out);
        if time != self.states.time(lane) {
            self.write_state(lane, time, out);
        }
    }

    fn write_state(&mut self, lane: usize, time: DoubleDouble, out: &mut State) {
        let begin = self.series.time(lane);
        let step = self.states.time(lane) - begin;
        self.series.state_after(lane, part_of_step(time - begin, step), out);
    }

    /// Writes the state of a lane at a time within its last step into `out`.
    pub(in crate::integrate) fn at(&mut self, lane: usize, time: f64, out: &mut State) {
        self.states.write(lane, out);
        if time != self.time(lane) {
            self.write_state(lane, DoubleDouble::from_decimal(time), out);
            out.time = time;
        }
    }
}

impl TaylorLane {
    /// The time to step from a time with so much `left`, where the series allows `step` in its unit `scale`; `None` where that is
    /// out of the ordinary.
    #[inline]
    fn choose(
        &mut self,
        step: f64,
        scale: f64,
        (time, left): (f64, DoubleDouble),
    ) -> Option<DoubleDouble> {
        let wanted = step.min(left.high.abs());
        let near = (scale * NEARBY_UNITS.0..=scale * NEARBY_UNITS.1).contains(&wanted);
        let vanishing = step < VANISHING_IN_F64 * self.stride || step < SOON_STALLED * time.abs();
        if step.is_nan() || !near || vanishing {
            return None;
        }
        let last = step >= left.high.abs();
        let after = if last { left } else { DoubleDouble::from(step.copysign(left.high)) };
        self.stride = self.stride.max(after.high.abs());
        if !last {
            self.unit.take(after.high.abs(), step, left.high);
        }
        Some(after)
    }
}
