//! Events of several orbits side by side that change nothing in their motion.
//!
//! In: orbits by Taylor series that have taken a step. Out: the events in it, in order, at the times that a
//! [`Propagator`](super::Propagator) of that orbit alone finds, to the last bit. Never here: what is done at an event.

use super::clock::spacing;
use super::dense_output::DenseOutput;
use super::event_location::EventLocator;
use super::lane_status::LaneStatus;
use super::roots::CUT_OFF;
use super::taylor::TaylorBatch;
use super::zeno::AccumulationDetector;
use crate::model::EventAction;
use crate::num::{Analytic, BATCH, Batch, DoubleDouble};
use crate::system::{
    BatchEventSigns, LaneSeries, MotionError, MotionErrorKind, State, StepSeries, System,
};

/// An event of one orbit.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct LaneEvent {
    /// Its index among those of the system.
    pub event: usize,
    /// The zero of its function.
    pub time: f64,
}

/// The search for the events of all lanes.
pub(super) struct BatchEvents {
    system: System,
    signs: Option<BatchEventSigns>,
    /// The last known sides of each function, in all lanes.
    sides: Vec<Batch>,
    lanes: [Option<LaneSearch>; BATCH],
    series: LaneSeries,
    tolerance: Option<f64>,
}

struct LaneSearch {
    locator: EventLocator,
    start: f64,
    /// The time up to which the events are known.
    clear: f64,
    accumulation: Vec<AccumulationDetector>,
}

/// The last step of a lane.
struct EventStep<'a> {
    motion: &'a mut TaylorBatch,
    lane: usize,
    series: &'a LaneSeries,
}

impl BatchEvents {
    /// Those of a system whose events are all without effect.
    pub(super) fn new(system: &System, order: usize, tolerance: f64) -> BatchEvents {
        BatchEvents {
            system: system.clone(),
            signs: system.batch_event_signs(order),
            sides: vec![Batch::ZERO; system.discontinuities().events.len()],
            lanes: std::array::from_fn(|_| None),
            series: LaneSeries::EMPTY,
            tolerance: Some(tolerance),
        }
    }

    /// Begins the search along an orbit.
    pub(super) fn begin(&mut self, lane: usize, state: &State, parameters: &[f64]) {
        let events = &self.system.discontinuities().events;
        let blank = State::new(0.0, self.system.form(), Vec::new());
        let functions = self.system.event_functions(parameters);
        self.lanes[lane] = functions.map(|functions| {
            let mut locator = EventLocator::new(functions, events, blank);
            if let Ok(native) = self.system.convert(state, self.system.form(), parameters) {
                locator.find_vanishing(&self.system, &native, parameters);
            }
            let accumulation = vec![AccumulationDetector::NONE; events.len()];
            LaneSearch { locator, start: state.time, clear: state.time, accumulation }
        });
        if let Some(signs) = &mut self.signs {
            signs.set_parameters(lane, &self.system.inputs(parameters));
        }
    }

    /// Passes over the last step in every lane where the sizes of the functions' terms show that there is no event.
    pub(super) fn pass(&mut self, motion: &TaylorBatch) {
        let Some(signs) = &mut self.signs else { return };
        let series = motion.series();
        let mut time = Batch::ZERO;
        let searches = self.lanes.iter().enumerate();
        for (lane, search) in searches.filter_map(|(lane, search)| Some((lane, search.as_ref()?))) {
            let end = motion.time(lane);
            let whole = end - search.clear + 2.0 * spacing(end);
            let begins = search.clear == series.time(lane).high;
            let unit = series.scale().0[lane];
            time.0[lane] = if begins && unit > 0.0 { whole / unit } else { f64::NAN };
            for (sides, &side) in self.sides.iter_mut().zip(search.locator.sides()) {
                sides.0[lane] = side;
            }
        }
        let unchanged = signs.keep_signs(series, &self.sides, (CUT_OFF, time));
        for (lane, search) in self.lanes.iter_mut().enumerate() {
            if let Some(search) = search
                .as_mut()
                .filter(|_| motion.status(lane) == LaneStatus::Underway && unchanged.0[lane] == 1.0)
            {
                search.locator.pass();
                search.clear = motion.time(lane);
            }
        }
    }

    /// The next event of a lane within its last step, whose state is written into `out`.
    pub(super) fn next(
        &mut self,
        motion: &mut TaylorBatch,
        lane: usize,
        out: &mut State,
    ) -> Result<Option<LaneEvent>, MotionError> {
        let Some(search) = &mut self.lanes[lane] else { return Ok(None) };
        let end = motion.time(lane);
        search.locator.note_departures(motion.state(lane), self.tolerance);
        // what else is at the time of the last event comes before what lies beyond
        let mut waiting = search.locator.next_at(search.clear);
        if waiting.is_none() && search.clear >= end {
            return Ok(None);
        }
        self.series.take(motion.series(), lane);
        let mut step = EventStep { motion, lane, series: &self.series };
        while waiting.is_some() || search.clear < end {
            let found = match waiting.take() {
                Some(found) => found,
                None => match search.locator.scan(&mut step, search.clear, end)? {
                    (Some(found), _) => found,
                    (None, clear) => {
                        search.clear = clear;
                        continue;
                    }
                },
            };
            search.clear = found.exact.high;
            step.at_exactly(found.exact, out)?;
            let (event, time) = (found.event, found.exact.high);
            let happened = &self.system.discontinuities().events[event];
            if happened.action.written() == Some(EventAction::Mark)
                && search.accumulation[event].record(time, search.start)
            {
                let kind = MotionErrorKind::EventsAccumulate(happened.name.clone());
                return Err(self.system.error(kind, time, &out.values));
            }
            return Ok(Some(LaneEvent { event, time }));
        }
        Ok(None)
    }
}

impl DenseOutput for EventStep<'_> {
    fn interval(&self) -> (f64, f64) {
        (self.series.time().high, self.motion.time(self.lane))
    }

    fn at(&mut self, time: f64, out: &mut State) -> Result<(), MotionError> {
        self.motion.at(self.lane, time, out);
        Ok(())
    }

    fn at_exactly(&mut self, time: DoubleDouble, out: &mut State) -> Result<(), MotionError> {
        self.motion.at_exactly(self.lane, time, out);
        Ok(())
    }

    fn exact_end(&self) -> Option<DoubleDouble> {
        Some(self.motion.states().time(self.lane))
    }

    fn series(&self) -> Option<&dyn StepSeries> {
        Some(self.series)
    }
}
