//! Evaluates the value of every channel at a state.

use super::image::MapImage;
use super::native_states::NativeStates;
use super::value::Evaluator;
use super::{Form, MotionError, State, System};
use crate::num::{DoubleDouble, Real};
use std::sync::Arc;

/// Where a grid has this many points without an energy, no velocity is searched for far from the guess at the others: a
/// search takes a hundred times as long as finding one.
const MOST_EMPTY: usize = 64;

/// Evaluates the channels of one system at one set of parameters. It owns its registers.
#[derive(Clone, Debug)]
pub struct Observer {
    system: System,
    precise: Evaluator<DoubleDouble>,
    drawn: Evaluator<f64>,
    energy: Evaluator<f64>,
    native: NativeStates,
    inputs: Vec<DoubleDouble>,
    rounded: Vec<f64>,
    images: Vec<MapImage>,
}

impl Observer {
    fn new(system: System, parameters: &[f64]) -> Observer {
        let watch = &system.shared.observables;
        let images: Vec<MapImage> = watch.images.iter().map(MapImage::new).collect();
        let inputs = system.motion_len() + 2 + images.iter().map(MapImage::len).sum::<usize>();
        let mut observer = Observer {
            precise: Evaluator::new(Arc::clone(&watch.precise)),
            drawn: Evaluator::new(Arc::clone(&watch.drawn)),
            energy: Evaluator::new(Arc::clone(&system.shared.energy)),
            native: NativeStates::new(&system),
            inputs: vec![DoubleDouble::ZERO; inputs],
            rounded: vec![0.0; inputs],
            images,
            system,
        };
        observer.set_parameters(parameters);
        observer
    }

    /// Takes other values, in the order of the model, for all evaluations to come.
    pub fn set_parameters(&mut self, parameters: &[f64]) {
        let inputs = self.system.inputs(parameters);
        self.precise.set_parameters(&inputs);
        self.drawn.set_parameters(&inputs);
        self.energy.set_parameters(&inputs);
        self.native.set_parameters(parameters, &inputs);
        for image in &mut self.images {
            image.set_parameters(&inputs);
        }
    }

    /// The parameters in use.
    pub fn parameters(&self) -> &[f64] {
        self.native.parameters()
    }

    /// Writes the value of every channel, in order, into `out`, which must be as long as the channels.
    /// The state may have either form. Undefined values are NaN.
    ///
    /// # Errors
    /// Returns an error only if the state has no velocities (or momenta), or no accelerations although a channel needs them.
    pub fn observe(&mut self, state: &State, out: &mut [f64]) -> Result<(), MotionError> {
        let precise = self.system.shared.observables.precise.outputs();
        let (first, others) = out.split_at_mut(precise);
        self.observe_leading(state, first)?;
        for (rounded, x) in self.rounded.iter_mut().zip(&self.inputs) {
            *rounded = x.high;
        }
        let outcome = self.drawn.evaluate(state.time, &self.rounded);
        outcome.map_err(|singular| {
            let program = &self.system.shared.observables.drawn;
            self.system.singular(program, singular, state.time, &state.values)
        })?;
        for (i, x) in others.iter_mut().enumerate() {
            *x = self.drawn.output(i);
        }
        Ok(())
    }

    /// Writes the values of the columns only into `out`, which must be as long as they are.
    ///
    /// # Errors
    /// As for [`Observer::observe`].
    pub fn observe_columns(&mut self, state: &State, out: &mut [f64]) -> Result<(), MotionError> {
        self.observe_leading(state, out)
    }

    fn observe_leading(&mut self, state: &State, out: &mut [f64]) -> Result<(), MotionError> {
        let n = self.system.degrees();
        self.native.write(state, &mut self.inputs)?;
        let (own, mut images) = self.inputs.split_at_mut(self.system.motion_len() + 2);
        for image in &mut self.images {
            let (first, others) = images.split_at_mut(image.len());
            image.write(state.exact_time(), &own[..self.system.motion_len()], first);
            images = others;
        }
        let outcome = self.precise.evaluate(state.exact_time(), &self.inputs);
        outcome.map_err(|singular| {
            let program = &self.system.shared.observables.precise;
            self.system.singular(program, singular, state.time, &state.values)
        })?;
        for (i, x) in out.iter_mut().enumerate() {
            *x = self.precise.output(i).value();
        }
        if state.form == Form::Momentum && out.len() >= 3 * n {
            // the momenta are those of the state
            out[2 * n..3 * n].copy_from_slice(&state.values[n..2 * n]);
        }
        Ok(())
    }

    /// For one degree of freedom: the energy on a grid over (q, q̇) or (q, p) at one time, for
    /// level curves. The values are in row-major order: `out[j * positions.len() + i]` belongs to
    /// `positions[i]` and `rates[j]`; it is NaN where there is no energy.
    pub fn energy_on_grid(
        &mut self,
        time: f64,
        form: Form,
        positions: &[f64],
        rates: &[f64],
        out: &mut [f64],
    ) {
        let mut empty = 0;
        let linear: Option<Vec<_>> = self.is_linear(form).then(|| {
            let exactly = |&x: &f64| (DoubleDouble::from(time), DoubleDouble::from(x));
            positions.iter().map(|x| self.native.legendre.line(exactly(x))).collect()
        });
        for (row, &rate) in out.chunks_exact_mut(positions.len().max(1)).zip(rates) {
            for (i, (x, &position)) in row.iter_mut().zip(positions).enumerate() {
                let energy = match &linear {
                    Some(lines) => lines[i].and_then(|(at_rest, slope)| {
                        let velocity = (DoubleDouble::from(rate) - at_rest) / slope;
                        self.native_energy_at(time, position, velocity.high)
                    }),
                    None => self.energy_at(time, form, position, rate),
                };
                empty += usize::from(energy.is_none());
                self.native.legendre.near_only = empty >= MOST_EMPTY;
                *x = energy.unwrap_or(f64::NAN);
            }
        }
        self.native.legendre.near_only = false;
    }

    fn energy_at(&mut self, time: f64, form: Form, position: f64, rate: f64) -> Option<f64> {
        let mut state = [DoubleDouble::from(position), DoubleDouble::from(rate)];
        if form != self.system.form() {
            let target = [Some(state[1])];
            state[1] = DoubleDouble::ZERO;
            self.native.legendre.solve(DoubleDouble::from(time), &mut state, &target).ok()?;
        }
        self.native_energy_at(time, position, state[1].high)
    }

    fn native_energy_at(&mut self, time: f64, position: f64, rate: f64) -> Option<f64> {
        self.energy.evaluate(time, &[position, rate]).ok()?;
        Some(self.energy.output(0))
    }

    /// Whether states of this form are converted to the native one by a relation that is linear in the rates.
    fn is_linear(&self, form: Form) -> bool {
        let conversion = (form, self.system.form());
        conversion == (Form::Momentum, Form::Velocity)
            && self.system.discontinuities().is_quadratic()
    }
}

impl System {
    /// Returns an observer of this system's states.
    pub fn observer(&self, parameters: &[f64]) -> Observer {
        Observer::new(self.clone(), parameters)
    }
}
