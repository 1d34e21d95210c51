//! The actions of the principles beside Hamilton's: the abbreviated action of Maupertuis and Jacobi, and the action in phase
//! space.
//!
//! In: a Lagrangian or a Hamiltonian, a path. Out: numbers. Never here: which paths.
//! Source: *The Principles of Dynamics*, §§ 1.4.1, 3.5; L. D. Landau and E. M. Lifshitz, Mechanics, §§ 43, 44.

use super::action::{Lagrangian, Path, compiled, unsuited};
use super::error::DynamicsError;
use crate::expr::Symbol;
use crate::mechanics::Equations;
use crate::model::Model;
use crate::system::Evaluator;

/// The kinetic energy is a quadratic form of the velocities if it is one to this part of its terms.
const QUADRATIC: f64 = 1e-9;

/// An integral of a root, which has no derivatives where the velocity vanishes, is settled to this part.
const SETTLED: f64 = 1e-10;

/// ∫ Σ p dq along a path of a duration, p = ∂L/∂q̇.
///
/// # Errors
/// Returns an error if p is not finite on the path, or the integral does not settle.
pub fn abbreviated_action(
    lagrangian: &mut Lagrangian,
    path: &mut dyn Path,
    duration: f64,
) -> Result<f64, DynamicsError> {
    lagrangian.integral(path, duration, None, &mut |lagrangian, time, state| {
        let momenta = lagrangian.momenta(time, state);
        momenta.iter().zip(&state[lagrangian.degrees()..]).map(|(p, v)| p * v).sum()
    })
}

/// The same along the way of a path that is gone with an energy, at whatever time: ∫ 2 √((E − V) T) dt, where L = T − V. It is
/// stationary on the way of a motion of that energy, among all ways between its ends (Jacobi).
///
/// # Errors
/// Returns an error if L is no such difference, or the way leaves the region that the energy allows.
pub fn action_at_energy(
    lagrangian: &mut Lagrangian,
    path: &mut dyn Path,
    duration: f64,
    energy: f64,
) -> Result<f64, DynamicsError> {
    let n = lagrangian.degrees();
    let mut natural = !lagrangian.timed;
    let mut allowed = true;
    let found = lagrangian.integral(path, duration, Some(SETTLED), &mut |lagrangian, time, at| {
        let mut state = at.to_vec();
        let mut with = |factor: f64| {
            (n..2 * n).for_each(|i| state[i] = factor * at[i]);
            lagrangian.value(time, &state)
        };
        let (rest, once, back, twice) = (with(0.0), with(1.0), with(-1.0), with(2.0));
        let kinetic = once - rest;
        let off = (once - back).abs().max((twice - rest - 4.0 * kinetic).abs());
        natural &= off <= QUADRATIC * (once.abs() + rest.abs() + twice.abs());
        let left = energy + rest;
        // at the ends of the region E − V is zero, but for rounding
        let rounding = SETTLED * (energy.abs() + rest.abs());
        allowed &= left >= -rounding;
        2.0 * (left.max(0.0) * kinetic.max(0.0)).sqrt()
    });
    match found {
        _ if !natural => Err(unsuited(
            "L is not T − V with T of the second degree in the velocities, or depends on the time",
        )),
        _ if !allowed => Err(unsuited("the path leaves the region that its energy allows")),
        found => found,
    }
}

/// A Hamiltonian at fixed parameters, as a function of (t, q, p).
pub struct Hamiltonian {
    degrees: usize,
    value: Evaluator<f64>,
    start: f64,
}

impl Hamiltonian {
    /// The Hamiltonian of a model; of a Lagrangian system by the Legendre transform.
    ///
    /// # Errors
    /// Returns an error if there is none in closed form.
    pub fn of(
        model: &Model,
        equations: &mut Equations,
        parameters: &[f64],
    ) -> Result<Hamiltonian, DynamicsError> {
        let hamiltonian = equations.hamiltonian().clone();
        let hamiltonian = hamiltonian
            .map_err(|why| unsuited(&format!("there is no Hamiltonian in closed form: {why}")))?;
        let positions = model.coordinates.iter().map(|c| c.position);
        let inputs: Vec<Symbol> =
            positions.chain(model.coordinates.iter().map(|c| c.momentum)).collect();
        let at = (model, parameters);
        let value = compiled(&mut equations.pool, at, &inputs, &[hamiltonian])?;
        Ok(Hamiltonian { degrees: model.coordinates.len(), value, start: model.run.start })
    }

    /// ∫ (Σ p q̇ − H) dt along a path of a duration in phase space, which gives q, q̇ and then p at a time: stationary on a
    /// motion for variations of q with fixed ends and of p alike.
    ///
    /// # Errors
    /// Returns an error if H is not finite on the path, or the integral does not settle.
    pub fn phase_action(
        &mut self,
        lagrangian: &mut Lagrangian,
        path: &mut dyn Path,
        duration: f64,
    ) -> Result<f64, DynamicsError> {
        let n = self.degrees;
        lagrangian.integral(path, duration, None, &mut |_, time, at| {
            let (velocities, momenta) = (&at[n..2 * n], &at[2 * n..]);
            let product: f64 = momenta.iter().zip(velocities).map(|(p, v)| p * v).sum();
            let point = [&at[..n], momenta].concat();
            match self.value.evaluate(self.start + time, &point) {
                Ok(()) => product - self.value.output(0),
                Err(_) => f64::NAN,
            }
        })
    }
}
