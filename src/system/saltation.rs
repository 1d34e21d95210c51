//! How an impulse carries tangent vectors on: the saltation matrix.
//!
//! An impulse on the surface g(z, t) = 0 takes z⁻ to z⁺ = R(z⁻, t). A motion displaced by δz⁻ meets
//! the surface earlier or later by δt = −∇g·δz⁻/ġ, so that δz⁺ = S δz⁻ with
//!
//! ```text
//! S = ∂R/∂z + (f⁺ − Ṙ) ∇gᵀ/ġ,   Ṙ = ∂R/∂z f⁻ + ∂R/∂t,   ġ = ∇g·f⁻ + ∂g/∂t,
//! ```
//!
//! f⁻ and f⁺ the rates before and after. An impulse at a given time has S = ∂R/∂z.
//!
//! In: the states before and after an impulse, and the event that caused it. Out: S in the canonical
//! variables, or those of brackets. Never here: when an impulse is due.
//!
//! Sources: M. A. Aizerman, F. R. Gantmakher, Quart. J. Mech. Appl. Math. 11 (1958) 225; R. I. Leine,
//! H. Nijmeijer, Dynamics and Bifurcations of Non-Smooth Mechanical Systems (2004), 7.3; for
//! collisions Ch. Dellago, H. A. Posch, W. G. Hoover, Phys. Rev. E 53 (1996) 1485.

use super::error::MotionErrorKind;
use super::program::{Op, Program};
use super::rates::Rates;
use super::value::Evaluator;
use super::{CompiledEvent, Form, MotionError, State, System};
use crate::model::EventAction;
use crate::num::DoubleDouble;

/// A surface is grazed if the rate of its function changes by its own size within this part of the
/// time scale of the motion: a crossing of order three is located to the third root of the rounding.
const GRAZING: f64 = 1e-5;

/// The derivatives of the impulses of one system at one set of parameters.
#[derive(Clone, Debug)]
pub struct Saltation {
    system: System,
    /// The system with as many tangent vectors as dynamical variables.
    carrying: System,
    parameters: Vec<f64>,
    change: Evaluator<DoubleDouble>,
    when: Evaluator<DoubleDouble>,
    native: Rates,
    canonical: Rates,
}

impl Saltation {
    /// The derivatives of the impulses of a system.
    ///
    /// # Errors
    /// Returns the reason, as a sentence, if an impulse or the event that causes it depends on more
    /// than the state and the time: the action, the work, an auxiliary number.
    pub fn new(system: &System, parameters: &[f64]) -> Result<Saltation, &'static str> {
        let system = system.without_tangents();
        let discontinuities = system.discontinuities();
        let events = discontinuities.events.iter().enumerate();
        let acts =
            |event: &CompiledEvent| matches!(event.action.written(), Some(EventAction::Impulse(_)));
        let acting = events.filter(|(_, event)| acts(event));
        let acting: Vec<usize> = acting.map(|(i, _)| i).collect();
        let all: Vec<usize> = (0..discontinuities.change.outputs()).collect();
        let moving = system.moving();
        for (program, outputs) in
            [(&discontinuities.when, &acting), (&discontinuities.change, &all)]
        {
            if depends_on_more(program, outputs, moving) {
                return Err("an impulse depends on the action, the work or an auxiliary number, \
                            and its derivative is not computed");
            }
        }
        let inputs = system.inputs(parameters);
        let of = |program: &Program| {
            let mut values = Evaluator::new(timed(program).with_tangents(moving + 1));
            values.set_parameters(&inputs);
            values
        };
        let (change, when) = (of(&discontinuities.change), of(&discontinuities.when));
        let (mut native, mut canonical) = (system.native_rates(), system.canonical_rates());
        native.set_parameters(parameters);
        canonical.set_parameters(parameters);
        let carrying = system.with_tangents(moving);
        let parameters = parameters.to_vec();
        Ok(Saltation { system, carrying, parameters, change, when, native, canonical })
    }

    /// The saltation matrix, row by row, of an impulse between two states in the system's native
    /// form, caused by an event of this index or by the clock. `scale` is a time in which the motion
    /// changes.
    ///
    /// # Errors
    /// Returns an error if the motion grazes the surface of the event, where the derivative is
    /// infinite, or if the states have no momenta.
    pub fn matrix(
        &mut self,
        (impulse, event): (usize, Option<usize>),
        (before, after): (&State, &State),
        scale: f64,
    ) -> Result<Vec<f64>, MotionError> {
        let (n, d) = (self.system.moving(), self.system.degrees());
        let first = if self.system.form() == Form::Variables { 0 } else { n - d };
        let columns = self.native_columns(before)?;
        let motion = self.rates_of(before, true)?;
        let change = self.along(false, &columns, &motion, before)?;
        let (own, total) = (self.system.discontinuities().change.outputs(), n + 1);
        let jump = |i: usize, vector: usize| change[own * (1 + vector) + impulse * d + i].high;
        let mut matrix = vec![0.0; n * n];
        for j in 0..n {
            matrix[j * n + j] = 1.0;
            for i in 0..d {
                matrix[(first + i) * n + j] += jump(i, j);
            }
        }
        let Some(event) = event else { return Ok(matrix) };
        let function = self.along(true, &columns, &motion, before)?;
        let own = self.system.discontinuities().when.outputs();
        let slopes: Vec<f64> = (0..n).map(|j| function[own * (1 + j) + event].high).collect();
        let rate = function[own * total + event].high;
        let [mut rates_before, rates_after] =
            [self.rates_of(before, false)?, self.rates_of(after, false)?];
        if self.grazes((event, rate), &columns, &motion, before, scale)? {
            let name = self.system.discontinuities().events[event].name.clone();
            let kind = MotionErrorKind::Grazes(name);
            return Err(self.system.error(kind, before.time, &before.values));
        }
        for i in 0..d {
            rates_before[first + i] += jump(i, n);
        }
        for (i, (after, before)) in rates_after.iter().zip(&rates_before).enumerate() {
            for (j, slope) in slopes.iter().enumerate() {
                matrix[i * n + j] += (after - before) * slope / rate;
            }
        }
        Ok(matrix)
    }

    /// Whether the rate of an event's function, `rate` here, is another a moment before or after.
    fn grazes(
        &mut self,
        (event, rate): (usize, f64),
        columns: &[Vec<DoubleDouble>],
        motion: &[f64],
        here: &State,
        scale: f64,
    ) -> Result<bool, MotionError> {
        let own = self.system.discontinuities().when.outputs();
        for moment in moments_beside(scale) {
            let mut there = here.clone();
            let time = here.exact_time() + DoubleDouble::from(moment);
            (there.time, there.time_carry) = (time.high, time.low);
            for (i, rate) in motion.iter().enumerate() {
                there.set(i, here.exact(i) + DoubleDouble::from(rate * moment));
            }
            let function = self.along(true, columns, motion, &there)?;
            let change = (function[own * (columns.len() + 1) + event].high - rate).abs();
            // nor is there a derivative where nothing is a number
            if change.is_nan() || is_as_large(change, rate) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// The displacements in the native form that are unit vectors in the canonical variables.
    fn native_columns(&self, before: &State) -> Result<Vec<Vec<DoubleDouble>>, MotionError> {
        let n = self.system.moving();
        let mut full = self.carrying.extended(before, &self.system);
        let form = self.system.form();
        if form == Form::Velocity {
            full = self.carrying.convert(&full, Form::Momentum, &self.parameters)?;
        }
        for j in 0..n {
            for i in 0..n {
                let unit = DoubleDouble::from(f64::from(u8::from(i == j)));
                full.set(self.carrying.tangent_place(j) + i, unit);
            }
        }
        let full = self.carrying.convert(&full, form, &self.parameters)?;
        let column = |j: usize| {
            let first = self.carrying.tangent_place(j);
            (first..first + n).map(|i| full.exact(i)).collect()
        };
        Ok((0..n).map(column).collect())
    }

    /// The rates of a state in the native form: of that form, or of the canonical variables.
    fn rates_of(&mut self, state: &State, native: bool) -> Result<Vec<f64>, MotionError> {
        let mut out = vec![0.0; self.system.state_len()];
        if native {
            self.native.evaluate(state.time, &state.values, &mut out)?;
        } else {
            let form = self.canonical.form();
            let own = self.system.convert(state, form, &self.parameters)?;
            self.canonical.evaluate(own.time, &own.values, &mut out)?;
        }
        out.truncate(self.system.moving());
        Ok(out)
    }

    /// The outputs of the program of the events or of the impulses, then their derivatives along
    /// each column, then along the motion.
    fn along(
        &mut self,
        events: bool,
        columns: &[Vec<DoubleDouble>],
        motion: &[f64],
        before: &State,
    ) -> Result<Vec<DoubleDouble>, MotionError> {
        let own = self.system.motion_len() + 2;
        let mut inputs = vec![DoubleDouble::ZERO; own];
        self.system.inputs_of(before, &mut inputs);
        inputs.push(before.exact_time());
        let rest = |vector: &mut Vec<DoubleDouble>, end| vector.resize(end, DoubleDouble::ZERO);
        for column in columns {
            let end = inputs.len() + own + 1;
            inputs.extend_from_slice(column);
            rest(&mut inputs, end);
        }
        let end = inputs.len() + own;
        inputs.extend(motion.iter().map(|&x| DoubleDouble::from(x)));
        rest(&mut inputs, end);
        inputs.push(DoubleDouble::ONE);
        let discontinuities = self.system.discontinuities();
        let (program, values) = if events {
            (&discontinuities.when, &mut self.when)
        } else {
            (&discontinuities.change, &mut self.change)
        };
        let found = values.evaluate(before.exact_time(), &inputs);
        found.map_err(|why| self.system.singular(program, why, before.time, &before.values))?;
        Ok((0..program.outputs() * (columns.len() + 2)).map(|i| values.output(i)).collect())
    }
}

/// The moments before and after an event at which its rate is evaluated, where the motion changes in a time of `scale`.
fn moments_beside(scale: f64) -> [f64; 2] {
    [-GRAZING * scale, GRAZING * scale]
}

/// Whether a rate changes by its own size.
fn is_as_large(change: f64, rate: f64) -> bool {
    change >= rate.abs() || rate == 0.0
}

/// A program whose last input is the time, so that it can be differentiated by it.
fn timed(program: &Program) -> Program {
    let mut timed = program.clone();
    let input = Op::Input(timed.inputs.len() as u32);
    let place = timed.ops.iter().position(|op| *op == Op::Time).unwrap_or_else(|| {
        timed.fixed.push(false);
        timed.ops.push(input);
        timed.ops.len() - 1
    });
    timed.ops[place] = input;
    timed.inputs.push(place as u32);
    timed
}

/// Whether some outputs of a program change with inputs beyond the first ones.
fn depends_on_more(program: &Program, outputs: &[usize], first: usize) -> bool {
    let mut chosen = program.clone();
    chosen.outputs = outputs.iter().map(|&i| program.outputs[i]).collect();
    let needed = chosen.needed(outputs.len());
    program.inputs.iter().skip(first).any(|&r| needed[r as usize])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// g = b t + t² has the rate b at the event, and b ± 2·10⁻⁵ a hundred-thousandth of the time scale beside it.
    #[test]
    fn a_surface_is_grazed_if_the_rate_vanishes_a_hundred_thousandth_of_the_time_scale_away() {
        let grazes = |b: f64, scale: f64| {
            moments_beside(scale).into_iter().all(|t| is_as_large((2.0 * t).abs(), b))
        };
        assert!(grazes(-1.9e-5, 1.0) && !grazes(-2.1e-5, 1.0));
        assert!(grazes(5.9e-5, 3.0) && !grazes(6.1e-5, 3.0));
        assert!(is_as_large(0.0, 0.0));
    }
}
