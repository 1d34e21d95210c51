//! Evaluates the value of every channel at a state.

use super::batch_values::BatchValues;
use super::image::MapImage;
use super::native_states::NativeStates;
use super::program::Register;
use super::value::Evaluator;
use super::{Form, MotionError, State, System};
use crate::num::{BATCH, Batch, DoubleDouble, Real};
use std::sync::Arc;

/// Where a grid has this many points without an energy, no velocity is searched for far from the guess at the others: a
/// search takes a hundred times as long as finding one.
const MOST_EMPTY: usize = 64;

/// The input of the energy that is the rate, of one degree of freedom.
const RATE: usize = 1;

/// Evaluates the channels of one system at one set of parameters. It owns its registers.
#[derive(Clone, Debug)]
pub struct Observer {
    system: System,
    precise: Evaluator<DoubleDouble>,
    drawn: Evaluator<f64>,
    energy: Evaluator<f64>,
    /// The energies of several points at these parameters, once a grid was asked for.
    energies: Option<Box<GridEnergies>>,
    native: NativeStates,
    inputs: Vec<DoubleDouble>,
    rounded: Vec<f64>,
    images: Vec<MapImage>,
}

/// What evaluates the energy at several points.
#[derive(Clone, Debug)]
struct GridEnergies {
    /// `None` where they are evaluated one by one.
    values: Option<BatchValues>,
    /// The operations that depend on the rate.
    of_rate: Vec<Register>,
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
            energies: None,
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
        self.energies = None;
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
        if form == self.system.form() {
            self.energies(time, positions, None, rates, out);
        } else if self.is_linear(form) {
            let lines: Vec<(f64, f64)> = positions.iter().map(|&x| self.line(time, x)).collect();
            self.energies(time, positions, Some(&lines), rates, out);
        } else {
            let rows = out.chunks_exact_mut(positions.len().max(1)).zip(rates);
            let mut empty = 0;
            for (row, &rate) in rows {
                for (x, &position) in row.iter_mut().zip(positions) {
                    let energy = self.energy_at(time, form, position, rate);
                    empty += usize::from(energy.is_none());
                    self.native.legendre.near_only = empty >= MOST_EMPTY;
                    *x = energy.unwrap_or(f64::NAN);
                }
            }
            self.native.legendre.near_only = false;
        }
    }

    /// The other rate at a position where the native one is zero, and its slope; NaN where nothing follows from them.
    fn line(&mut self, time: f64, position: f64) -> (f64, f64) {
        let at = (DoubleDouble::from(time), DoubleDouble::from(position));
        let line = self.native.legendre.line(at);
        line.map_or((f64::NAN, f64::NAN), |(at_rest, slope)| (at_rest.high, slope.high))
    }

    /// Writes the energies on a grid into `out`, those of several positions at once; NaN where there is none. The rates are native
    /// ones, or those of which the native one is 0 and the slope at each position are given. What depends on a position alone is
    /// evaluated once for all rates.
    fn energies(
        &mut self,
        time: f64,
        positions: &[f64],
        lines: Option<&[(f64, f64)]>,
        rates: &[f64],
        out: &mut [f64],
    ) {
        let mut energies = self.energies.take().unwrap_or_else(|| {
            let program = &self.system.shared.energy;
            let mut values = BatchValues::new(program);
            if let Some(values) = &mut values {
                values.set_parameters_of_all(&self.system.inputs(self.native.parameters()));
            }
            Box::new(GridEnergies { values, of_rate: program.body_of_input(RATE) })
        });
        let GridEnergies { values, of_rate } = &mut *energies;
        for first in (0..positions.len()).step_by(BATCH) {
            let count = BATCH.min(positions.len() - first);
            // lanes beyond the end of the row repeat its last point
            let place = |lane: usize| first + lane.min(count - 1);
            let q = Batch(std::array::from_fn(|lane| positions[place(lane)]));
            let line = |lane: usize| lines.map_or((0.0, 1.0), |lines| lines[place(lane)]);
            let at_rest = Batch(std::array::from_fn(|lane| line(lane).0));
            let slope = Batch(std::array::from_fn(|lane| line(lane).1));
            for (j, &rate) in rates.iter().enumerate() {
                let given = Batch::splat(rate);
                let v = if lines.is_some() { (given - at_rest) / slope } else { given };
                let out = &mut out[j * positions.len() + first..][..count];
                let mut regular = [false; BATCH];
                if let Some(values) = values {
                    match j {
                        0 => values.evaluate(Batch::splat(time), [q, v].into_iter()),
                        _ => values.evaluate_with((RATE, v), of_rate),
                    }
                    if let Some(found) = values.outputs_from(0).next() {
                        out.copy_from_slice(&found.0[..count]);
                    }
                    if values.is_regular() {
                        continue;
                    }
                    regular = values.regular_lanes();
                }
                for (lane, out) in out.iter_mut().enumerate().filter(|(lane, _)| !regular[*lane]) {
                    let known = !v.0[lane].is_nan();
                    let energy = known.then(|| self.native_energy_at(time, q.0[lane], v.0[lane]));
                    *out = energy.flatten().unwrap_or(f64::NAN);
                }
            }
        }
        self.energies = Some(energies);
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
