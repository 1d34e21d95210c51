//! Taylor series: the default method.
//!
//! Every step builds the series of the motion to an order that the tolerance asks for, takes as
//! long a step as its last terms allow, and sums it. The polynomial itself is the dense output.
//! Kinks (`abs`, `sign`, `min`, `max`) are found as roots of the series of what switches there,
//! and a step ends on each.
//!
//! Sources: À. Jorba, M. Zou, "A software package for the numerical integration of ODEs by means
//! of high-order Taylor methods", Experimental Mathematics 14 (2005) 99; F. Biscani, D. Izzo,
//! Monthly Notices of the Royal Astronomical Society 504 (2021) 2614.

mod kinks;
mod step_size;

use kinks::Kinks;

use super::method::{Method, Preserves, Refusal, Settings, Stepping};
use super::stepper::Stepper;
use crate::expr::Double;
use crate::system::{Fault, FaultKind, Form, Series, Side, State, System};

/// The tolerance where none is asked for. It lies far below the last digit shown, so that what
/// is shown carries the error of one rounding at the end and not of all on the way.
const TOLERANCE: f64 = 1e-18;

/// Below this tolerance the lowest orders are built in double-double.
const EXACT_BELOW: f64 = 1e-16;

/// The orders built in double-double: what is left to `f64` is a ten-thousandth of a step.
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
    make: |system, settings| Ok(Box::new(Taylor::new(system, settings)?)),
};

/// A motion by Taylor series.
#[derive(Debug)]
struct Taylor {
    system: System,
    series: Series,
    tolerance: f64,
    state: State,
    begin: f64,
    /// The unit of time in use was found for this motion.
    scaled: bool,
    /// The step last taken, near which the next series takes its unit of time; the present one
    /// still tells the states inside that step.
    taken: Option<f64>,
    kinks: Kinks,
}

impl Taylor {
    fn new(system: &System, settings: &Settings) -> Result<Taylor, Refusal> {
        let tolerance = settings.tolerance.unwrap_or(TOLERANCE);
        if !(1e-30..1.0).contains(&tolerance) {
            let reason = format!("the tolerance {tolerance:e} is not between 1e-30 and 1");
            return Err(Refusal { method: METHOD.name, reason });
        }
        let order = step_size::order_for(tolerance);
        let exact = if tolerance < EXACT_BELOW { EXACT_ORDERS } else { 0 };
        let state = State::new(0.0, system.form(), vec![0.0; system.state_len()]);
        let series = system.series(order, exact);
        let system = system.clone();
        Ok(Taylor {
            system,
            series,
            tolerance,
            state,
            begin: 0.0,
            scaled: false,
            taken: None,
            kinks: Kinks::default(),
        })
    }

    /// Points the series in the direction of `left`, the time there is to go.
    fn aim(&mut self, left: f64) {
        let scale = if self.scaled { self.series.scale() } else { left };
        let step = self.taken.take().unwrap_or(scale).abs();
        self.series.set_scale(step.clamp(1e-300, 1e300).copysign(left));
        self.scaled = true;
    }

    /// Builds the series at the present state in a unit of time near the step it allows, and
    /// gives the size of that step; it may be longer than `left`.
    fn expand(&mut self, left: f64) -> Result<f64, Fault> {
        let (size, direction) = (left.abs(), left.signum());
        loop {
            self.series.build(&self.state)?;
            let scale = self.series.scale().abs();
            let Some(step) = step_size::longest(&self.series, self.tolerance) else {
                // some coefficient is beyond all range: with a smaller unit it need not be
                if scale < 1e-280 || (scale <= 1.0 && !step_size::has_velocity(&self.series)) {
                    return Err(self.not_finite());
                }
                self.series.set_scale(scale * 1e-6 * direction);
                continue;
            };
            let step = step * scale;
            let wanted = step.min(size);
            if (scale * 1e-4..=scale * 1e3).contains(&wanted) {
                return Ok(step);
            }
            self.series.set_scale(wanted.clamp(scale * 1e-12, scale * 1e12) * direction);
            if self.series.scale().abs() == scale {
                return Ok(step);
            }
        }
    }

    /// On a surface: takes the first choice of sides that leads on.
    fn decide(&mut self, choices: &[Vec<Side>], left: f64) -> Result<(), Fault> {
        for sides in choices {
            self.kinks.choose(&mut self.series, sides);
            match self.expand(left) {
                Ok(step) if self.kinks.leads_on(&self.series, step) => return Ok(()),
                Err(fault) if fault.kind != FaultKind::Sticks => return Err(fault),
                _ => {}
            }
        }
        Err(self.system.fault(FaultKind::Sticks, self.state.time, &self.state.values))
    }

    fn not_finite(&self) -> Fault {
        let names = self.system.channels();
        let n = self.system.degrees();
        let culprit =
            (0..self.system.moving()).find(|&i| !self.series.coefficient(i, 1).is_finite());
        let name = match culprit {
            Some(i) if i < n => format!("the velocity of {}", names[i].shown),
            Some(i) => format!("the force on {}", names[i - n].shown),
            None => "the motion".to_owned(),
        };
        self.system.fault(FaultKind::NotFinite(name), self.state.time, &self.state.values)
    }
}

impl Stepper for Taylor {
    fn start(&mut self, state: &State, parameters: &[f64]) -> Result<(), Fault> {
        self.state = self.system.convert(state, self.system.form(), parameters)?;
        self.begin = self.state.time;
        self.scaled = false;
        self.taken = None;
        let parameters = self.system.inputs(parameters);
        self.series.set_parameters(&parameters);
        self.series.set_scale(1.0);
        self.kinks.begin(&mut self.series, &self.state)
    }

    fn step(&mut self, limit: f64) -> Result<(), Fault> {
        if self.state.time == limit {
            return Ok(());
        }
        let time = self.state.exact_time();
        let left = Double::written(limit) - time;
        self.aim(left.high);
        if let Some(sides) = self.kinks.undecided(&self.series) {
            self.decide(&sides, left.high)?;
        }
        let step = self.expand(left.high)?;
        if step <= 1e-17 * time.high.abs() {
            let kind = FaultKind::StepUnderflow(step);
            return Err(self.system.fault(kind, time.high, &self.state.values));
        }
        let mut last = step >= left.high.abs();
        let mut after = if last { left } else { Double::from(step.copysign(left.high)) };
        let scale = self.series.scale();
        let crossing = self.kinks.first(&self.series, after.high / scale);
        if let Some(crossing) = &crossing {
            (last, after) = (false, crossing.after * scale);
        }
        self.begin = self.state.time;
        self.series.state_after(after, &mut self.state);
        if last {
            self.state.time = limit;
        } else {
            self.taken = Some(step.min(left.high.abs()));
        }
        if !self.kinks.arrive(crossing, &self.series, &mut self.state) {
            return Err(self.system.fault(FaultKind::Sticks, time.high, &self.state.values));
        }
        self.system.check_finite(&self.state)
    }

    fn settle(&mut self, state: &State) {
        self.state.copy_from(state);
    }

    fn state(&self) -> &State {
        &self.state
    }

    fn interval(&self) -> (f64, f64) {
        (self.begin, self.state.time)
    }

    fn at(&mut self, time: f64, out: &mut State) -> Result<(), Fault> {
        out.copy_from(&self.state);
        if time != self.state.time {
            self.series.state_after(Double::written(time) - self.series.time(), out);
            out.time = time;
        }
        Ok(())
    }

    fn at_exactly(&mut self, time: Double, out: &mut State) -> Result<(), Fault> {
        out.copy_from(&self.state);
        if time != self.state.exact_time() {
            self.series.state_after(time - self.series.time(), out);
        }
        Ok(())
    }

    fn form(&self) -> Form {
        self.system.form()
    }
}
