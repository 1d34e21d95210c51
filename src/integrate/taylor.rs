//! Taylor series: the default method.
//!
//! Every step builds the series of the motion to an order set by the tolerance, takes as long a
//! step as its last terms allow, and sums it. The polynomial itself is the dense output. Kinks
//! (`abs`, `sign`, `min`, `max`) are located as roots of the series of their switches, and a step
//! ends on each.
//!
//! Sources: À. Jorba, M. Zou, "A software package for the numerical integration of ODEs by means of
//! high-order Taylor methods", Experimental Mathematics 14 (2005) 99; F. Biscani, D. Izzo, Monthly
//! Notices of the Royal Astronomical Society 504 (2021) 2614.

mod approach;
mod approach_watch;
mod argument_step;
mod batch;
mod batch_step_size;
mod branches;
mod collocation_step;
mod decimal_limit;
mod departure;
mod exact_passage;
mod expansion;
mod kinks;
mod last_orders;
mod lowest_steps;
mod onset;
mod order_bounds;
mod rough_logarithms;
mod singular_work;
mod start_slope;
mod static_friction;
mod step_end;
mod step_history;
mod step_screen;
mod step_size;
mod sticking;
mod touch;
mod trial_velocities;
mod unit_of_time;
mod verification;

use approach::Approach;
pub(super) use batch::TaylorBatch;
use collocation_step::CollocationStep;
use decimal_limit::DecimalLimit;
use kinks::Kinks;
use static_friction::RestUnderFriction;
use step_history::StepHistory;
use step_size::{EXACT_BELOW, SeriesOrders, StepSize};

use super::dense_output::DenseOutput;
use super::method::{Method, MethodError, Preserves, Settings, Stepping};
use super::stepper::Stepper;
use crate::num::DoubleDouble;
use crate::system::{
    Enclosure, ExactRates, MotionError, MotionErrorKind, Series, Side, State, StepSeries, System,
};

/// The default tolerance. It is far below the last digit shown, so that the results carry the error
/// of one rounding at the end and not of all on the way.
const TOLERANCE: f64 = 1e-18;

pub(super) const METHOD: Method = Method {
    name: "taylor",
    title: "Taylor series",
    order: None,
    stepping: Stepping::Adaptive,
    preserves: Preserves::Nothing,
    locates_kinks: true,
    stays_within_steps: true,
    needs: "",
    about: "Power series in time, of an order that follows the tolerance (28 where none is given), \
            the lowest terms carried in double-double. Errors stay at the last digit shown, kinks \
            are located. Jorba & Zou, Experimental Mathematics 14 (2005) 99.",
    fits: |_| Ok(()),
    leapfrogs: Vec::new,
    make: |system, settings| Ok(Box::new(Taylor::new(system, settings)?)),
};

#[derive(Debug)]
pub(super) struct Taylor {
    system: System,
    series: Series,
    /// The series in `f64`, while digits of double-double are needed to pass a place.
    plain: Option<Box<Series>>,
    step_size: StepSize,
    state: State,
    begin: f64,
    tolerance: f64,
    /// Whether the lowest orders are in double-double.
    exact: bool,
    history: StepHistory,
    kinks: Kinks,
    rates: ExactRates,
    enclosure: Enclosure,
    bridge: CollocationStep,
    /// The sizes of the numbers where the motion began.
    sizes: Vec<f64>,
    course: StepCourse,
    parameters: Vec<f64>,
    limit: DecimalLimit,
    /// The approach to a singularity that the last steps were short for.
    approach: Option<Approach>,
}

/// What the last step followed, which its dense output follows too.
#[derive(Debug)]
enum StepCourse {
    Series,
    /// A collocation step from this state, with these rates there if it has none itself.
    Collocation(State, Option<Vec<DoubleDouble>>),
    /// A motion at rest, until it starts moving.
    Rest(RestUnderFriction),
}

impl Taylor {
    pub(super) fn new(system: &System, settings: &Settings) -> Result<Taylor, MethodError> {
        let tolerance = settings.tolerance.unwrap_or(TOLERANCE);
        if !(1e-30..1.0).contains(&tolerance) {
            let reason = format!("the tolerance {tolerance:e} is not between 1e-30 and 1");
            return Err(MethodError { method: METHOD.name, reason });
        }
        let orders = SeriesOrders::of(tolerance, system);
        let state = State::new(0.0, system.form(), vec![0.0; system.state_len()]);
        let series = system.series(orders.highest, orders.exact);
        let (rates, bridge) =
            (system.exact_rates(), CollocationStep::new(system.state_len(), system.moving()));
        let enclosure = system.enclosure();
        let system = system.clone();
        Ok(Taylor {
            system,
            series,
            plain: None,
            tolerance,
            exact: orders.exact > 0,
            step_size: StepSize::new(tolerance, orders),
            state,
            begin: 0.0,
            history: StepHistory::default(),
            kinks: Kinks::default(),
            rates,
            enclosure,
            bridge,
            sizes: Vec::new(),
            course: StepCourse::Series,
            parameters: Vec::new(),
            limit: DecimalLimit::NONE,
            approach: None,
        })
    }

    /// Whether the motion is beside all kinks at the end of the last step, and not at rest on one.
    pub(super) fn is_beside_kinks(&self) -> bool {
        matches!(self.course, StepCourse::Series)
            && !self.kinks.is_on_surface()
            && !self.series.sides().contains(&Side::Between)
    }

    /// The state of the last step at the time of another, if it has one: that before an impulse. Else the other itself.
    fn before(&mut self, start: &State) -> Result<State, MotionError> {
        let (begin, end) = (self.begin.min(self.state.time), self.begin.max(self.state.time));
        let alike = start.form == self.state.form && start.values.len() == self.state.values.len();
        let mut before = start.clone();
        if alike && start.exact_time() == self.state.exact_time() {
            before.copy_from(&self.state);
        } else if alike && begin < end && (begin..=end).contains(&start.time) {
            self.write_state(start.exact_time(), &mut before)?;
        }
        Ok(before)
    }

    /// Writes the state at a time within the last step into `out`.
    fn write_state(&mut self, time: DoubleDouble, out: &mut State) -> Result<(), MotionError> {
        let begin = match &self.course {
            StepCourse::Series => self.series.time(),
            StepCourse::Collocation(from, _) => from.exact_time(),
            StepCourse::Rest(still) => still.step_begin(),
        };
        let after = part_of_step(time - begin, self.state.exact_time() - begin);
        match &self.course {
            StepCourse::Series => {
                self.series.state_after(after, out);
                snap_to_kinks(&self.series, out);
            }
            StepCourse::Collocation(from, _) if after.high == 0.0 => out.copy_from(from),
            StepCourse::Collocation(from, toward) => {
                self.bridge.inside(&mut self.rates, from, after, toward.as_deref(), out)?;
            }
            StepCourse::Rest(still) => out.copy_from(&still.at(&mut self.rates, begin + after)?),
        }
        Ok(())
    }
}

/// Where a motion is held on a kink by a number that is zero there, as a velocity at rest, that is zero and no rounding.
fn snap_to_kinks(series: &Series, state: &mut State) {
    for (i, side) in series.sides().iter().enumerate() {
        if let (Side::Between, Some(number)) = (side, series.switch_number(i)) {
            state.set(number, DoubleDouble::ZERO);
        }
    }
}

/// The time after the beginning of a step at which it is looked at. An `f64` may lie just outside a
/// step that is shorter than its last digit, near a point where the series has no radius of
/// convergence.
fn part_of_step(after: DoubleDouble, step: DoubleDouble) -> DoubleDouble {
    let part = after.high / step.high;
    if part > 1.0 {
        step
    } else if part < 0.0 {
        DoubleDouble::ZERO
    } else {
        after
    }
}

impl Taylor {
    /// Takes a step no farther than a limit.
    fn step_to(&mut self, limit: f64) -> Result<(), MotionError> {
        if self.state.time == limit {
            return Ok(());
        }
        let time = self.state.exact_time();
        let left = self.limit.exact(limit) - time;
        if matches!(&self.course, StepCourse::Rest(still) if still.is_over()) {
            self.course = StepCourse::Series;
            self.kinks.begin(&mut self.series, &mut self.rates, &self.state)?;
            self.history.stride = 0.0;
        }
        if let StepCourse::Rest(still) = &mut self.course {
            let (rates, parameters) = (&mut self.rates, &self.parameters);
            let place = (&self.state, limit);
            let state = still.advance(&self.system, rates, parameters, place)?;
            self.begin = self.state.time;
            self.state = state;
            return Ok(());
        }
        self.aim(left.high);
        if self.history.landed {
            if self.leap(left.high, 0.0)? {
                return Ok(());
            }
            return Err(match self.evaluate_rates() {
                // no kink, but a mass that vanishes there
                Err(error) if error.kind == MotionErrorKind::SingularMass => error,
                _ => self.system.error(MotionErrorKind::Rough, time.high, &self.state.values),
            });
        }
        let longest = match self.kinks.undecided(&self.series) {
            Some(sides) => self.decide(&sides, left.high)?,
            None => match self.expand(left.high) {
                Ok(step) => Some(step),
                Err(error) if error.kind == MotionErrorKind::Cancelled => return Err(error),
                Err(error) => return if self.leap(left.high, 0.0)? { Ok(()) } else { Err(error) },
            },
        };
        let Some(step) = longest else { return Ok(()) };
        if self.cross_near_touch(step, limit)? || self.rest_nearby(step)? {
            return Ok(());
        }
        self.course = StepCourse::Series;
        if self.take_plain_step(step, (left, limit))? {
            return Ok(());
        }
        match self.end_of_step(step, left)? {
            Some(end) if end.is_branch_point() && self.cross_touch(step, limit)? => Ok(()),
            Some(end) => self.go_to(end, step, (left.high, limit)),
            None => Ok(()),
        }
    }
}

impl Stepper for Taylor {
    fn start(&mut self, state: &State, parameters: &[f64]) -> Result<(), MotionError> {
        let mut state = self.system.convert(state, self.system.form(), parameters)?;
        let before = self.before(&state)?;
        if self.series.switches() > 0 {
            start_slope::clear_rounding(&mut state, &before);
        }
        self.end_passage(true);
        self.sizes = start_slope::sizes(&state, &before);
        self.state = state;
        self.begin = self.state.time;
        (self.history, self.course) = (StepHistory::default(), StepCourse::Series);
        self.approach = None;
        self.parameters = parameters.to_vec();
        let parameters = self.system.inputs(parameters);
        self.series.set_parameters(&parameters);
        self.series.set_scale(1.0);
        self.rates.set_parameters(&parameters);
        self.enclosure.set_parameters(&parameters);
        self.kinks.begin(&mut self.series, &mut self.rates, &self.state)
    }

    fn step(&mut self, limit: f64) -> Result<(), MotionError> {
        self.end_passage(false);
        match self.step_to(limit) {
            Err(error) if self.wants_digits(&error) => {
                self.begin_passage()?;
                self.step_to(limit)?;
            }
            outcome => outcome?,
        }
        self.watch_approach(limit)
    }

    fn replace_state(&mut self, state: &State) {
        self.state.copy_from(state);
    }

    fn state(&self) -> &State {
        &self.state
    }

    fn tolerance(&self) -> Option<f64> {
        Some(self.tolerance)
    }
}

impl DenseOutput for Taylor {
    fn interval(&self) -> (f64, f64) {
        (self.begin, self.state.time)
    }

    fn at(&mut self, time: f64, out: &mut State) -> Result<(), MotionError> {
        out.copy_from(&self.state);
        if time != self.state.time {
            self.write_state(DoubleDouble::from_decimal(time), out)?;
            out.time = time;
        }
        Ok(())
    }

    fn at_exactly(&mut self, time: DoubleDouble, out: &mut State) -> Result<(), MotionError> {
        let inside = time != self.state.exact_time();
        // the sums of a series are written over all numbers
        let alike = out.form == self.state.form && out.values.len() == self.state.values.len();
        if !(inside && alike && matches!(self.course, StepCourse::Series)) {
            out.copy_from(&self.state);
        }
        if inside {
            self.write_state(time, out)?;
        }
        Ok(())
    }

    fn exact_end(&self) -> Option<DoubleDouble> {
        Some(self.state.exact_time())
    }

    fn series(&self) -> Option<&dyn StepSeries> {
        let taken = matches!(self.course, StepCourse::Series) && self.begin != self.state.time;
        taken.then_some(&self.series as &dyn StepSeries)
    }
}
