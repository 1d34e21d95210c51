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

mod batch;
mod batch_step_size;
mod branches;
mod collocation_step;
mod kinks;
mod last_orders;
mod onset;
mod steep;
mod step_screen;
mod step_size;
mod sticking;
mod still;
mod trial_velocities;

pub(super) use batch::TaylorBatch;
use collocation_step::CollocationStep;
use kinks::Kinks;
use step_size::{EXACT_BELOW, StepSize};
use sticking::Sticking;
use still::Still;

use super::method::{Method, MethodError, Preserves, Settings, Stepping};
use super::stepper::Stepper;
use crate::num::DoubleDouble;
use crate::system::{ExactRates, Form, MotionError, MotionErrorKind, Series, Side, State, System};

/// The default tolerance. It is far below the last digit shown, so that the results carry the error
/// of one rounding at the end and not of all on the way.
const TOLERANCE: f64 = 1e-18;

/// The number of orders built in double-double: the part left to `f64` is a ten-thousandth of a
/// step.
const EXACT_ORDERS: usize = 8;

pub(super) const METHOD: Method = Method {
    name: "taylor",
    title: "Taylor series",
    order: None,
    stepping: Stepping::Adaptive,
    preserves: Preserves::Nothing,
    locates_kinks: true,
    needs: "",
    about: "Power series in time, of an order that follows the tolerance (28 where none is given), \
            the lowest terms carried in double-double. Errors stay at the last digit shown, kinks \
            are located. Jorba & Zou, Experimental Mathematics 14 (2005) 99.",
    fits: |_| Ok(()),
    leapfrogs: Vec::new,
    make: |system, settings| Ok(Box::new(Taylor::new(system, settings)?)),
};

/// A motion by Taylor series.
#[derive(Debug)]
struct Taylor {
    system: System,
    series: Series,
    step_size: StepSize,
    state: State,
    begin: f64,
    tolerance: f64,
    /// Whether the lowest orders are in double-double.
    exact: bool,
    /// Whether the unit of time in use was determined for this motion.
    scaled: bool,
    /// The size of the last step, from which the next series takes its unit of time. The current
    /// series still represents the states inside that step.
    taken: Option<f64>,
    kinks: Kinks,
    rates: ExactRates,
    bridge: CollocationStep,
    /// The longest step since the last kink, relative to which a step counts as short.
    stride: f64,
    /// The last step, and whether it and those before lead away from a point that was passed.
    last: f64,
    leaving: bool,
    /// Whether no series continues from the current state.
    landed: bool,
    /// Set if the last step was a collocation step from this state, with these rates there if it
    /// has none itself.
    leapt: Option<(State, Option<Vec<DoubleDouble>>)>,
    /// A motion at rest, until it starts moving.
    resting: Option<Still>,
    parameters: Vec<f64>,
    /// The last limit of a step, and the decimal number it is written as.
    limit: (f64, DoubleDouble),
    /// The number of collocation steps, and the time at the end of their last round.
    leaps: (u32, f64),
}

/// A step is well represented in a unit of time between these parts of it.
const NEARBY_UNITS: (f64, f64) = (1e-4, 1e3);

/// This many collocation steps must advance the time by this part of the time that has passed.
const ROUND: u32 = 64;
const LEAST: f64 = 1e-15;

/// A step shorter than this part of those before it ends at a point where a series has no radius of
/// convergence; …
const VANISHING: f64 = 1e-11;

/// … and this is that part where all is in `f64`, whose digits do not tell nearer points apart.
const VANISHING_IN_F64: f64 = 1e-8;

/// So does a step this short relative to the time, which will soon no longer advance it.
const SOON_STALLED: f64 = 1e-15;

/// A point this close, relative to the steps before it, counts as reached.
const TOUCHING: f64 = 1e-15;

/// A step this short relative to the time hardly advances it.
const STALLED: f64 = 5e-17;

/// A step this short relative to the time cannot continue; …
const SMALLEST: f64 = 1e-17;

/// … but a surface where forces grow without bound is approached up to this part, since the time is
/// in double-double. A nearer one counts as reached.
const NEAREST: f64 = 1e-30;

/// The last terms of all series may be this part of their largest at a surface that is reached
/// beyond the step, …
const LAST_DIGIT: f64 = 1e-17;

/// … and this part where it cannot be approached any farther. If they are larger, as at a pole, it
/// cannot be reached.
const NEARLY: f64 = 1e-6;

/// Steps that lead away from a point do not shrink by more than this factor.
const SHRINKING: f64 = 0.1;

/// On a surface, a step this short relative to those before it is no better than none.
const HOPELESS: f64 = 1e-9;

/// How far beyond such a short step the point is searched for, in steps.
const BEYOND: f64 = 8.0;

/// The part of the time to a point that is stepped if a motion passes it closely.
const NEARER: f64 = 0.5;

/// The maximal number of halvings of a step that has left a branch.
const HALVINGS: u32 = 60;

/// A number this small relative to the terms of its series is zero; the rest is rounding.
const ROUNDING: f64 = 1e-18;

impl Taylor {
    fn new(system: &System, settings: &Settings) -> Result<Taylor, MethodError> {
        let tolerance = settings.tolerance.unwrap_or(TOLERANCE);
        if !(1e-30..1.0).contains(&tolerance) {
            let reason = format!("the tolerance {tolerance:e} is not between 1e-30 and 1");
            return Err(MethodError { method: METHOD.name, reason });
        }
        let order = step_size::order_for(tolerance, system.degrees());
        let exact = if tolerance < EXACT_BELOW { EXACT_ORDERS } else { 0 };
        let state = State::new(0.0, system.form(), vec![0.0; system.state_len()]);
        let series = system.series(order, exact);
        let (rates, bridge) =
            (system.exact_rates(), CollocationStep::new(system.state_len(), system.moving()));
        let system = system.clone();
        Ok(Taylor {
            system,
            series,
            tolerance,
            exact: exact > 0,
            step_size: StepSize::new(tolerance, order),
            state,
            begin: 0.0,
            scaled: false,
            taken: None,
            kinks: Kinks::default(),
            rates,
            bridge,
            stride: 0.0,
            last: f64::INFINITY,
            leaving: false,
            landed: false,
            leapt: None,
            resting: None,
            parameters: Vec::new(),
            limit: (f64::NAN, DoubleDouble::ZERO),
            leaps: (0, f64::NAN),
        })
    }

    /// Points the series in the direction of `left`, the time to go.
    fn aim(&mut self, left: f64) {
        let scale = if self.scaled { self.series.scale() } else { left };
        let step = self.taken.take().unwrap_or(scale).abs();
        self.series.set_scale(step.clamp(1e-300, 1e300).copysign(left));
        self.scaled = true;
    }

    /// Builds the series at the current state in a unit of time near the step it allows, and
    /// returns the size of that step, which may be longer than `left`.
    fn expand(&mut self, left: f64) -> Result<f64, MotionError> {
        let (size, direction) = (left.abs(), left.signum());
        let mut units = Units::default();
        let mut known = Vec::new();
        loop {
            self.series.build(&self.state)?;
            let scale = self.series.scale().abs();
            let lost = known.iter().any(|&(i, k)| self.series.coefficient(i, k) == 0.0);
            let found = self.step_size.longest(&self.series);
            let Some(step) = found.map(|step| step * scale) else {
                // a coefficient is out of range, which a smaller unit may avoid
                if scale < 1e-280 || (scale <= 1.0 && !step_size::has_velocity(&self.series)) {
                    return Err(self.not_finite());
                }
                if known.is_empty() {
                    known = self.first_coefficients();
                }
                units.long = scale;
                self.series.set_scale(units.next(scale * 1e-6) * direction);
                if self.series.scale().abs() == scale {
                    // there is no smaller one
                    return Err(self.not_finite());
                }
                continue;
            };
            if lost {
                // where a root has no series it seems to have one once its argument underflows
                return Err(self.not_finite());
            }
            let wanted = step.min(size);
            if (scale * NEARBY_UNITS.0..=scale * NEARBY_UNITS.1).contains(&wanted) {
                return Ok(step);
            }
            if wanted < scale {
                units.long = scale;
            } else {
                units.short = scale;
                if units.long <= 2.0 * scale {
                    // goes no further than the bound found with the unit twice as long
                    return Ok(step.min(units.long));
                }
            }
            let next = units.next(wanted.clamp(scale * 1e-12, scale * 1e12));
            self.series.set_scale(next * direction);
            if self.series.scale().abs() == scale {
                return Ok(step);
            }
        }
    }

    /// The variables that change, each with its first coefficient that is not zero.
    fn first_coefficients(&self) -> Vec<(usize, usize)> {
        let first = |i: usize| {
            let changes = self.series.coefficients(i).iter().skip(1);
            let k = 1 + changes.take_while(|&&c| c == 0.0).count();
            let c = self.series.coefficients(i).get(k)?;
            c.is_finite().then_some((i, k))
        };
        (0..self.series.inputs()).filter_map(first).collect()
    }

    /// On a surface: takes the first choice of sides that continues the motion, and returns the
    /// step there, or `None` if the surface was left without a series.
    fn decide(&mut self, choices: &[Vec<Side>], left: f64) -> Result<Option<f64>, MotionError> {
        let mut rough = false;
        for sides in choices {
            self.kinks.choose(&mut self.series, sides);
            match self.expand(left) {
                Ok(step) if self.kinks.leads_on(&self.series, step, self.stride) => {
                    let hopeless = step < HOPELESS * self.stride && !rough;
                    return Ok(if hopeless && self.leap(left, 0.0)? { None } else { Some(step) });
                }
                Ok(_) => {}
                Err(fault) if fault.kind == MotionErrorKind::Sticks => {}
                Err(fault) if fault.kind == MotionErrorKind::Cancelled => return Err(fault),
                Err(_) if rough => {}
                Err(_) => {
                    rough = true;
                    if self.leap(left, 0.0)? {
                        return Ok(None);
                    }
                }
            }
        }
        if !rough && self.kinks.touch() {
            return self.decide(choices, left);
        }
        let kind = if rough { MotionErrorKind::Rough } else { MotionErrorKind::Sticks };
        Err(self.system.fault(kind, self.state.time, &self.state.values))
    }

    /// Leaves a point from which no series continues, or continues by no more than `least`. Returns
    /// false if that is not possible.
    fn leap(&mut self, left: f64, least: f64) -> Result<bool, MotionError> {
        self.leaps.0 += 1;
        if self.leaps.0.is_multiple_of(ROUND) {
            let (before, now) = (self.leaps.1, self.state.time);
            self.leaps.1 = now;
            if (now - before).abs() <= LEAST * (now.abs() + left.abs()) {
                return Ok(false);
            }
        }
        let stride = if self.stride > 0.0 { self.stride.min(left.abs()) } else { left.abs() };
        let wanted = stride.copysign(left);
        let mut from = self.state.clone();
        let mut toward = None;
        let rates = &mut self.rates;
        let mut found = self.bridge.cross(rates, &from, (wanted, least), None, &mut self.state)?;
        if found.is_none() {
            match sticking::of(&self.system, rates, &self.parameters, &from, stride)? {
                Sticking::Unknown => return Ok(false),
                Sticking::Stays(still) => {
                    self.state = still.at(rates, from.exact_time())?;
                    self.begin = self.state.time;
                    self.resting = Some(still);
                    return Ok(true);
                }
                Sticking::SetsOut(state, rates) => {
                    (from, toward) = (state, Some(rates));
                    let (rates, toward) = (&mut self.rates, toward.as_deref());
                    found =
                        self.bridge.cross(rates, &from, (wanted, 0.0), toward, &mut self.state)?;
                    if found.is_none() {
                        let first = sticking::set_out(
                            &self.system,
                            rates,
                            &self.parameters,
                            &from,
                            (wanted, self.limit.0),
                        )?;
                        let Some((still, state)) = first else { return Ok(false) };
                        self.begin = from.time;
                        self.state = state;
                        self.resting = Some(still);
                        return Ok(true);
                    }
                }
            }
        }
        let Some(step) = found else { return Ok(false) };
        self.kinks.begin(&mut self.series, &mut self.rates, &self.state)?;
        self.begin = from.time;
        self.leapt = Some((from, toward));
        self.landed = false;
        self.stride = step.abs();
        self.last = step.abs();
        self.leaving = true;
        self.taken = Some(step.abs());
        Ok(true)
    }

    /// Evaluates the rates at the current state.
    fn evaluate_rates(&mut self) -> Result<(), MotionError> {
        let state = &self.state;
        let numbers: Vec<DoubleDouble> = (0..state.values.len()).map(|i| state.exact(i)).collect();
        self.rates.evaluate(state.exact_time(), &numbers)
    }

    /// Advances along the series and shortens the step until no root has left its branch there, and
    /// no steep power is missed.
    /// Returns the part of the time that is left.
    fn advance(&mut self, after: DoubleDouble) -> Result<f64, MotionError> {
        let (mut part, scale) = (1.0, self.series.scale());
        let steep = self.series.is_steep() && !self.series.sides().contains(&Side::Between);
        if self.series.guards() == 0 && !steep {
            self.series.state_after(after, &mut self.state);
            return Ok(part);
        }
        let from = self.state.clone();
        for _ in 0..HALVINGS {
            let x = after.high * part / scale;
            if !(steep && self.misses_a_steep_power(after * part)?) {
                self.series.state_after(after * part, &mut self.state);
                if self.series.guards() == 0 {
                    return Ok(part);
                }
                let outcome = self.evaluate_rates();
                if outcome.is_ok() && !branches::strayed(&self.series, x, &self.rates) {
                    return Ok(part);
                }
            }
            part *= 0.5;
        }
        self.state = from;
        let kind = MotionErrorKind::StepUnderflow(after.high * part);
        Err(self.system.fault(kind, self.state.time, &self.state.values))
    }

    /// Whether the rates near the end of a step, where kinks are, are not those of the series.
    fn misses_a_steep_power(&mut self, after: DoubleDouble) -> Result<bool, MotionError> {
        let near = after * steep::NEAR_THE_END;
        self.series.state_after(near, &mut self.state);
        match self.evaluate_rates() {
            Err(fault) if fault.kind == MotionErrorKind::Cancelled => Err(fault),
            Err(_) => Ok(true),
            Ok(()) => {
                let x = near.high / self.series.scale();
                Ok(steep::missed(&self.series, x, &self.rates, self.tolerance))
            }
        }
    }

    /// Sets numbers that have reached zero to exactly zero.
    fn clear(&mut self, x: f64) {
        for i in 0..self.series.inputs() {
            let terms = self.series.coefficients(i).iter();
            let powers = std::iter::successors(Some(1.0), |power| Some(power * x));
            let largest = terms.zip(powers).fold(0.0_f64, |m, (c, p)| m.max((c * p).abs()));
            if self.state.values[i].abs() <= ROUNDING * largest {
                self.state.set(i, DoubleDouble::ZERO);
            }
        }
    }

    fn not_finite(&self) -> MotionError {
        let names = self.system.channels();
        let n = self.system.degrees();
        let culprit =
            (0..self.system.moving()).find(|&i| !self.series.coefficient(i, 1).is_finite());
        let name = match culprit {
            Some(i) if i < n => format!("the velocity of {}", names[i].shown),
            Some(i) => format!("the force on {}", names[i - n].shown),
            None => "the motion".to_owned(),
        };
        self.system.fault(MotionErrorKind::NotFinite(name), self.state.time, &self.state.values)
    }
}

/// The units of time tried for one series. Each trial narrows the interval between those found too
/// short and those found too long, so the search ends.
struct Units {
    short: f64,
    long: f64,
    tried: u32,
}

/// The number of units taken as the series suggests; after that the interval is bisected.
const ASKED_FOR: u32 = 12;

impl Default for Units {
    fn default() -> Units {
        Units { short: 0.0, long: f64::INFINITY, tried: 0 }
    }
}

impl Units {
    /// The next unit to try after the one that the series suggests.
    fn next(&mut self, wanted: f64) -> f64 {
        self.tried += 1;
        let (least, most) = (2.0 * self.short, 0.5 * self.long);
        if self.short == 0.0 || self.long == f64::INFINITY {
            return wanted;
        }
        if most < least {
            return self.short;
        }
        if self.tried < ASKED_FOR && (least..=most).contains(&wanted) {
            return wanted;
        }
        // bisects the interval of exponents
        (self.short.sqrt() * self.long.sqrt()).clamp(least, most)
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
    /// Writes the state at a time within the last step into `out`.
    fn write_state(&mut self, time: DoubleDouble, out: &mut State) -> Result<(), MotionError> {
        if let Some(still) = &self.resting {
            let begin = still.step_begin();
            let after = part_of_step(time - begin, self.state.exact_time() - begin);
            out.copy_from(&still.at(&mut self.rates, begin + after)?);
            return Ok(());
        }
        let Some((from, toward)) = &self.leapt else {
            let begin = self.series.time();
            let after = part_of_step(time - begin, self.state.exact_time() - begin);
            self.series.state_after(after, out);
            return Ok(());
        };
        let begin = from.exact_time();
        let after = part_of_step(time - begin, self.state.exact_time() - begin);
        if after.high == 0.0 {
            out.copy_from(from);
            return Ok(());
        }
        self.bridge.inside(&mut self.rates, from, after, toward.as_deref(), out)
    }
}

impl Stepper for Taylor {
    fn start(&mut self, state: &State, parameters: &[f64]) -> Result<(), MotionError> {
        self.state = self.system.convert(state, self.system.form(), parameters)?;
        self.begin = self.state.time;
        self.scaled = false;
        self.taken = None;
        self.stride = 0.0;
        self.last = f64::INFINITY;
        self.leaving = false;
        self.landed = false;
        self.leapt = None;
        self.resting = None;
        self.parameters = parameters.to_vec();
        self.leaps = (0, f64::NAN);
        let parameters = self.system.inputs(parameters);
        self.series.set_parameters(&parameters);
        self.series.set_scale(1.0);
        self.rates.set_parameters(&parameters);
        self.kinks.begin(&mut self.series, &mut self.rates, &self.state)
    }

    fn step(&mut self, limit: f64) -> Result<(), MotionError> {
        if self.state.time == limit {
            return Ok(());
        }
        let time = self.state.exact_time();
        if self.limit.0 != limit {
            self.limit = (limit, DoubleDouble::written(limit));
        }
        let left = self.limit.1 - time;
        if self.resting.as_ref().is_some_and(Still::is_over) {
            self.resting = None;
            self.kinks.begin(&mut self.series, &mut self.rates, &self.state)?;
            self.stride = 0.0;
        }
        if let Some(still) = &mut self.resting {
            let (rates, parameters) = (&mut self.rates, &self.parameters);
            let place = (&self.state, limit);
            let state = still.go_on(&self.system, rates, parameters, place)?;
            self.begin = self.state.time;
            self.state = state;
            return Ok(());
        }
        self.aim(left.high);
        if self.landed {
            if self.leap(left.high, 0.0)? {
                return Ok(());
            }
            return Err(self.system.fault(MotionErrorKind::Rough, time.high, &self.state.values));
        }
        let step = match self.kinks.undecided(&self.series) {
            Some(sides) => match self.decide(&sides, left.high)? {
                Some(step) => step,
                None => return Ok(()),
            },
            None => match self.expand(left.high) {
                Ok(step) => step,
                Err(fault) if fault.kind == MotionErrorKind::Cancelled => return Err(fault),
                Err(fault) => return if self.leap(left.high, 0.0)? { Ok(()) } else { Err(fault) },
            },
        };
        self.leapt = None;
        let mut last = step >= left.high.abs();
        let mut after = if last { left } else { DoubleDouble::from(step.copysign(left.high)) };
        let scale = self.series.scale();
        let part = if self.exact { VANISHING } else { VANISHING_IN_F64 };
        let vanishing = step < part * self.stride || step < SOON_STALLED * time.high.abs();
        // what makes the steps vanish lies a little farther than they reach
        let end = if vanishing { BEYOND * step / scale.abs() } else { after.high / scale };
        let end = end.min((left.high / scale).abs());
        let mut crossing = self.kinks.first(&self.series, end, self.stride);
        let approaching = vanishing && crossing.is_some();
        let nearest = approaching && step <= NEAREST * time.high.abs();
        // steps away from a point that was passed become longer by themselves
        let leaving = self.leaving && step > SHRINKING * self.last;
        self.leaving &= step <= SMALLEST * time.high.abs();
        let known = if nearest { NEARLY } else { LAST_DIGIT };
        if vanishing {
            crossing = crossing.filter(|crossing| crossing.is_known(&self.series, known));
        }
        let short = step <= SMALLEST * time.high.abs() && !approaching && !leaving;
        if short || (nearest && crossing.is_none()) {
            let kind = MotionErrorKind::StepUnderflow(step);
            return Err(self.system.fault(kind, time.high, &self.state.values));
        }
        if let Some(crossing) = &crossing {
            (last, after) = (false, crossing.after * scale);
        }
        self.begin = self.state.time;
        let mut landed = false;
        if vanishing && crossing.is_none() && !approaching {
            if let Some(x) = branches::predicted(&self.series, end) {
                (last, landed, after) = (false, true, DoubleDouble::from(x * scale));
            } else if (step < TOUCHING * self.stride || step < STALLED * time.high.abs())
                && self.leap(left.high, BEYOND * step)?
            {
                return Ok(());
            }
        }
        // near a branch point rounding alone makes steps short
        let reach = if vanishing { 2.0 * step } else { step };
        let reach = reach.min(left.high.abs()) / scale.abs();
        let reach =
            if crossing.is_some() { reach.min(after.high.abs() / scale.abs()) } else { reach };
        let passing =
            if landed || approaching { None } else { branches::first(&self.series, reach) };
        if let Some(passing) = passing {
            let origin = self.state.clone();
            let there = passing.after * scale;
            self.series.state_after(there, &mut self.state);
            let known = self.evaluate_rates().is_ok();
            let within = TOUCHING * self.stride / scale.abs();
            landed = (known && branches::is_exact(&self.series, &passing, &self.rates, within))
                || there.high.abs() < TOUCHING * self.stride;
            (last, crossing) = (false, None);
            after = if landed { there } else { there * NEARER };
            self.state = origin;
        }
        if landed || vanishing {
            self.series.state_after(after, &mut self.state);
            self.clear(after.high / scale);
        } else {
            let part = self.advance(after)?;
            if part < 1.0 {
                (last, crossing, after) = (false, None, after * part);
            }
        }
        self.last = after.high.abs();
        self.landed = landed;
        self.stride = if crossing.is_some() && !vanishing { 0.0 } else { self.stride };
        self.stride = self.stride.max(after.high.abs());
        if last {
            self.state.time = limit;
        } else {
            self.taken = Some(step.min(left.high.abs()).min(4.0 * after.high.abs()));
        }
        if !self.kinks.arrive(crossing, &self.series, &mut self.state) {
            return Err(self.system.fault(MotionErrorKind::Sticks, time.high, &self.state.values));
        }
        self.system.check_finite(&self.state)
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

    fn interval(&self) -> (f64, f64) {
        (self.begin, self.state.time)
    }

    fn at(&mut self, time: f64, out: &mut State) -> Result<(), MotionError> {
        out.copy_from(&self.state);
        if time != self.state.time {
            self.write_state(DoubleDouble::written(time), out)?;
            out.time = time;
        }
        Ok(())
    }

    fn at_exactly(&mut self, time: DoubleDouble, out: &mut State) -> Result<(), MotionError> {
        out.copy_from(&self.state);
        if time != self.state.exact_time() {
            self.write_state(time, out)?;
        }
        Ok(())
    }

    fn series(&self) -> Option<&Series> {
        let taken = self.resting.is_none() && self.leapt.is_none() && self.begin != self.state.time;
        taken.then_some(&self.series)
    }

    fn form(&self) -> Form {
        self.system.form()
    }
}
