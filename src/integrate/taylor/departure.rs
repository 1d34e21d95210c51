//! Points from which no single series continues: a choice of sides on a surface, and the step that leads away.
//!
//! In: the state, the choices of the kinks. Out: a series that continues, or a step by collocation, or rest. Never here:
//! steps along a series.

use super::step_end::SOON_STALLED;
use super::sticking::{self, Sticking};
use super::{StepCourse, Taylor, kinks, start_slope};
use crate::system::{MotionError, MotionErrorKind, Side};

/// On a surface, a step this short relative to those before it is no better than none.
const HOPELESS: f64 = 1e-9;

/// A step this short relative to those before it may be that of a motion next to rest: friction turns so small a velocity at a rate
/// that no series follows for long.
const IDLE: f64 = 1e-6;

impl Taylor {
    /// On a surface: takes the first choice of sides that continues the motion, and returns the
    /// step there, or `None` if the surface was left without a series.
    pub(super) fn decide(
        &mut self,
        choices: &[Vec<Side>],
        left: f64,
    ) -> Result<Option<f64>, MotionError> {
        let (mut rough, mut massless) = (false, false);
        let before = self.series.sides().to_vec();
        for sides in choices {
            self.set_sides(&before);
            self.kinks.choose(&mut self.series, sides);
            match self.expand_beyond_jumps(left) {
                Ok(step) if self.kinks.leads_on(&self.series, step, self.history.stride) => {
                    self.kinks.begin_beside(&self.series, step);
                    let hopeless = step < HOPELESS * self.history.stride && !rough;
                    if hopeless && self.leap_beside(Some(step), left, 0.0)? {
                        return Ok(None);
                    }
                    return Ok(Some(step));
                }
                Ok(_) => {}
                Err(error) if error.kind == MotionErrorKind::Sticks => {}
                Err(error) if error.kind == MotionErrorKind::Cancelled => return Err(error),
                Err(_) if rough => {}
                Err(error) => {
                    rough = true;
                    massless = error.kind == MotionErrorKind::SingularMass;
                    if self.leap(left, 0.0)? {
                        return Ok(None);
                    }
                }
            }
        }
        if !rough && self.kinks.touch() {
            self.set_sides(&before);
            return self.decide(choices, left);
        }
        let kind = match (rough, massless) {
            (true, true) => MotionErrorKind::SingularMass,
            (true, false) => MotionErrorKind::Rough,
            _ => MotionErrorKind::NoSide,
        };
        Err(self.system.error(kind, self.state.time, &self.state.values))
    }

    /// Comes to rest where friction holds a motion that is next to rest, whose steps are so short that it would take ever so many of
    /// them to arrive. Returns false elsewhere.
    pub(super) fn rest_nearby(&mut self, step: f64) -> Result<bool, MotionError> {
        if step >= IDLE * self.history.stride {
            return Ok(false);
        }
        let (rates, from, stride) = (&mut self.rates, &self.state, self.history.stride);
        let Sticking::Stays { still, dry: true } =
            sticking::of(&self.system, rates, &self.parameters, from, stride)?
        else {
            return Ok(false);
        };
        self.begin = self.state.time;
        self.state = still.at(&mut self.rates, self.state.exact_time())?;
        self.course = StepCourse::Rest(still);
        Ok(true)
    }

    fn set_sides(&mut self, sides: &[Side]) {
        for (i, &side) in sides.iter().enumerate() {
            self.series.set_side(i, side);
        }
    }

    /// Builds the series at a state on a surface. The other switches have the side of their value, which jumps where a switch in
    /// them has changed its side.
    fn expand_beyond_jumps(&mut self, left: f64) -> Result<f64, MotionError> {
        let mut step = self.expand_on_surface(left)?;
        for _ in 0..self.series.switches() {
            let opposite = self.kinks.opposite(&self.series);
            if opposite.is_empty() {
                break;
            }
            let sides = self.series.sides().to_vec();
            for &(i, side) in &opposite {
                self.series.set_side(i, side);
            }
            let tried = self.expand_on_surface(left);
            // a motion on a surface is on neither side of it, and there may be no law beside it
            let slides = opposite.iter().all(|&(i, _)| sides[i] == Side::Between);
            let back: Vec<usize> = match tried {
                Err(error) if error.kind == MotionErrorKind::Cancelled => return Err(error),
                Err(_) if slides => opposite.iter().map(|&(i, _)| i).collect(),
                Err(error) => return Err(error),
                Ok(longest) => {
                    step = longest;
                    let is_off = |i: usize| {
                        kinks::is_off_surface(&self.series, i, longest, self.history.stride)
                    };
                    // what is exactly zero has no rounding
                    let is_exact = |i: usize| {
                        let levels = [sides[i], self.series.sides()[i]].contains(&Side::Level);
                        let switch = self.series.switch(i);
                        let is_zero = levels || switch[0] == 0.0;
                        let (found, before) = (kinks::side_of(switch), sides[i]);
                        // what is not level in the mean of both branches may be in one of them
                        let is_level = before == Side::Level && found == Side::Level;
                        is_zero && (found == self.series.sides()[i] || is_level)
                    };
                    let is_back = |&i: &usize| !is_exact(i) && !is_off(i);
                    opposite.iter().map(|&(i, _)| i).filter(is_back).collect()
                }
            };
            for &i in &back {
                self.series.set_side(i, sides[i]);
            }
            if !back.is_empty() {
                step = self.expand_on_surface(left)?;
            }
            if back.len() == opposite.len() {
                break;
            }
        }
        Ok(step)
    }

    /// Builds the series at a state on a surface. Where the motion begins there, what is certain of the switches is found
    /// out as well.
    fn expand_on_surface(&mut self, left: f64) -> Result<f64, MotionError> {
        let step = self.expand(left)?;
        if self.history.stride == 0.0 {
            let here = self.kinks.on_surface(&self.series);
            let beside = start_slope::beside(&self.state, &self.sizes);
            let known = match self.series.build(&beside) {
                Err(error) if error.kind == MotionErrorKind::Cancelled => return Err(error),
                outcome => outcome.is_ok(),
            };
            let beside = if known { self.kinks.on_surface(&self.series) } else { Vec::new() };
            self.series.build(&self.state)?;
            self.kinks.learn(&here, &beside);
        }
        Ok(step)
    }

    /// Leaves a point from which no series continues, or continues by no more than `least`. Returns
    /// false if that is not possible.
    pub(super) fn leap(&mut self, left: f64, least: f64) -> Result<bool, MotionError> {
        self.leap_beside(None, left, least)
    }

    /// The same, where a series represents the motion for a time: a step that misses what happens within it is none.
    fn leap_beside(
        &mut self,
        series: Option<f64>,
        left: f64,
        least: f64,
    ) -> Result<bool, MotionError> {
        if !self.history.count_leap(self.state.time, left) {
            return Ok(false);
        }
        let longest = self.history.stride;
        let stride = if longest > 0.0 { longest.min(left.abs()) } else { left.abs() };
        let wanted = stride.copysign(left);
        let mut from = self.state.clone();
        let mut toward = None;
        let rates = &mut self.rates;
        let mut found = self.bridge.cross(rates, &from, (wanted, least), None, &mut self.state)?;
        // nothing can be seen within a step that does not advance the time
        let series = series.filter(|series| *series >= SOON_STALLED * from.time.abs());
        if let (Some(series), Some(step)) = (series, found)
            && self.bridge.misses(rates, &from, step, series / step.abs())?
        {
            self.state = from;
            return Ok(false);
        }
        // next to rest, dry friction leaves steps that lead nowhere; at the start of a motion no step has shown what is short
        let is_hopeless = |step: f64| longest > 0.0 && step.abs() < HOPELESS * stride;
        if found.is_none_or(is_hopeless) {
            match sticking::of(&self.system, rates, &self.parameters, &from, stride)? {
                Sticking::Unknown | Sticking::SetsOut(..) | Sticking::Stays { dry: false, .. }
                    if found.is_some() => {}
                Sticking::Unknown => return Ok(false),
                Sticking::Stays { still, .. } => {
                    self.state = still.at(rates, from.exact_time())?;
                    self.begin = self.state.time;
                    self.course = StepCourse::Rest(still);
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
                            (wanted, self.limit.rounded),
                        )?;
                        let Some((still, state)) = first else { return Ok(false) };
                        self.begin = from.time;
                        self.state = state;
                        self.course = StepCourse::Rest(still);
                        return Ok(true);
                    }
                }
            }
        }
        let Some(step) = found else { return Ok(false) };
        self.take_work_of_departure(&from);
        self.kinks.begin(&mut self.series, &mut self.rates, &self.state)?;
        self.begin = from.time;
        self.course = StepCourse::Collocation(from, toward);
        self.history.leapt(step.abs());
        Ok(true)
    }
}
