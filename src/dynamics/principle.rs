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

/// The abbreviated action ∫ Σ p dq, p = ∂L/∂q̇, along a path traversed in this duration.
///
/// # Errors
/// Returns an error if p is not finite on the path, or the integral does not settle.
pub fn abbreviated_action(
    lagrangian: &mut Lagrangian,
    path: &mut dyn Path,
    duration: f64,
) -> Result<f64, DynamicsError> {
    lagrangian.integral(path, duration, &mut |lagrangian, time, state| {
        let momenta = lagrangian.momenta(time, state);
        momenta.iter().zip(&state[lagrangian.degrees()..]).map(|(p, v)| p * v).sum()
    })
}

/// The abbreviated action along the same curve when it is traversed at a given energy, whatever time that takes: ∫ (2
/// √((E + L₀) L₂) + L₁) dt, where L_k is the part of L of degree k in the velocities; ∫ 2 √((E − V) T) dt for L = T − V.
/// It is stationary on the curve of a motion of that energy, among all curves between its ends (Jacobi).
///
/// # Errors
/// Returns an error if L has other parts, or the way leaves the region that the energy allows.
pub fn action_at_energy(
    lagrangian: &mut Lagrangian,
    path: &mut dyn Path,
    duration: f64,
    energy: f64,
) -> Result<f64, DynamicsError> {
    let mut lost = None;
    let mut integrand = |lagrangian: &mut Lagrangian, time: f64, at: &[f64]| {
        rate_at_energy(lagrangian, (time, at), energy).unwrap_or_else(|why| {
            lost.get_or_insert(why);
            f64::NAN
        })
    };
    let found = lagrangian.integral_across_corners(path, duration, SETTLED, &mut integrand);
    match lost {
        Some(why) => Err(why.into()),
        None => found,
    }
}

/// Why a way has no abbreviated action at an energy.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum NotOnEnergy {
    Law,
    /// The energy forbids a place of it.
    Forbidden,
}

impl From<NotOnEnergy> for DynamicsError {
    fn from(why: NotOnEnergy) -> Self {
        unsuited(match why {
            NotOnEnergy::Law => {
                "L is not of the second degree in the velocities, or depends on the time"
            }
            NotOnEnergy::Forbidden => "the path leaves the region that its energy allows",
        })
    }
}

/// 2 √((E + L₀) L₂) + L₁ at a time and a state of a path.
pub(super) fn rate_at_energy(
    lagrangian: &mut Lagrangian,
    (time, at): (f64, &[f64]),
    energy: f64,
) -> Result<f64, NotOnEnergy> {
    let n = lagrangian.degrees();
    let mut state = at.to_vec();
    let mut with = |factor: f64| {
        (n..2 * n).for_each(|i| state[i] = factor * at[i]);
        lagrangian.value(time, &state)
    };
    let at_multiples = [with(0.0), with(1.0), with(-1.0), with(2.0)];
    let parts = quadratic_parts(at_multiples).filter(|_| !lagrangian.timed);
    let Some([rest, odd, even]) = parts else { return Err(NotOnEnergy::Law) };
    let left = energy + rest;
    // at the ends of the region E − V is zero, but for rounding
    if left < -SETTLED * (energy.abs() + rest.abs()) {
        return Err(NotOnEnergy::Forbidden);
    }
    Ok(2.0 * (left.max(0.0) * even.max(0.0)).sqrt() + odd)
}

/// The parts of degree 0, 1 and 2 of a function of the velocities, by its values at 0, 1, −1 and 2 times some; nothing if it has others.
fn quadratic_parts([rest, once, back, twice]: [f64; 4]) -> Option<[f64; 3]> {
    let (even, odd) = (f64::midpoint(once, back) - rest, 0.5 * (once - back));
    let off = (twice - rest - 4.0 * even - 2.0 * odd).abs();
    let size = twice.abs() + once.abs() + back.abs() + rest.abs();
    // what is not a number is no other part
    let has_others = off > QUADRATIC * size;
    (!has_others).then_some([rest, odd, even])
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

    /// This Hamiltonian for paths that begin at this time instead of the start of the file.
    #[must_use]
    pub fn beginning_at(self, start: f64) -> Hamiltonian {
        Hamiltonian { start, ..self }
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
        lagrangian.integral(path, duration, &mut |_, time, at| {
            let (velocities, momenta) = (&at[n..2 * n], &at[2 * n..]);
            let product: f64 = momenta.iter().zip(velocities).map(|(p, v)| p * v).sum();
            product - self.value(time, &[&at[..n], momenta].concat())
        })
    }

    /// H at a time from the beginning of a path; NaN where it has no value.
    pub(super) fn value(&mut self, time: f64, point: &[f64]) -> f64 {
        match self.value.evaluate(self.start + time, point) {
            Ok(()) => self.value.output(0),
            Err(_) => f64::NAN,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1/2 + v + 2v² + δv⁴ is a form of second degree as long as 12δ is less than 1e-9 of the sum of its values 0.5, 3.5, 1.5 and 10.5.
    #[test]
    fn a_form_is_quadratic_to_1e_9_of_its_values() {
        let parts = |quartic: f64| {
            let value = |v: f64| 0.5 + v + 2.0 * v * v + quartic * v * v * v * v;
            quadratic_parts([0.0, 1.0, -1.0, 2.0].map(value))
        };
        assert_eq!(parts(0.0), Some([0.5, 1.0, 2.0]));
        assert!(parts(1.3e-9).is_some());
        assert_eq!(parts(1.4e-9), None);
    }
}
