//! The direction of a motion in its phase space, also where constraints hold it.
//!
//! In: a state. Out: its rates of change, in the variables of the space, and whether it moves at all. Never here: steps.

use nalgebra::{DMatrix, DVector};

use super::phase_space::PhaseSpace;
use super::vector_field::VectorField;
use crate::system::{Form, MotionError, Rates, State, System};

/// A motion is at rest if each of its rates is less than this part of what its variables, by their size, may add to it.
const AT_REST: f64 = 1e-13;

/// The rates of change of the variables of a phase space.
pub(super) struct FlowDirection {
    space: PhaseSpace,
    source: RateSource,
}

enum RateSource {
    /// The variables are independent.
    Free(VectorField),
    /// Constraints hold them. Rates are those of (q, q̇), carried to (q, p) as a displacement of the state, which they are
    /// where the momenta do not depend on the time.
    Constrained { rates: Rates, carrying: System },
}

impl FlowDirection {
    pub(super) fn new(space: &PhaseSpace) -> FlowDirection {
        let source = if space.is_constrained() {
            let mut rates = space.system().native_rates();
            rates.set_parameters(space.parameters());
            RateSource::Constrained { rates, carrying: space.system().with_tangents(1) }
        } else {
            RateSource::Free(space.vector_field())
        };
        FlowDirection { space: space.clone(), source }
    }

    /// The rates at a state of the space.
    pub(super) fn at(&mut self, state: &State) -> Result<DVector<f64>, MotionError> {
        let (space, n) = (&self.space, self.space.dimension());
        match &mut self.source {
            RateSource::Free(field) => {
                field.evaluate(state.time, space.variables(state))?;
                Ok(field.rate())
            }
            RateSource::Constrained { rates, carrying } => {
                let (system, parameters) = (space.system(), space.parameters());
                let native = system.convert(state, Form::Velocity, parameters)?;
                let mut out = vec![0.0; system.state_len()];
                rates.evaluate(native.time, &native.values, &mut out)?;
                let mut full = carrying.extended(&native, system);
                let first = carrying.tangent_place(0);
                full.values[first..first + n].copy_from_slice(&out[..n]);
                let full = carrying.convert(&full, space.form(), parameters)?;
                Ok(DVector::from_column_slice(&full.values[first..first + n]))
            }
        }
    }

    /// The derivatives of the rates evaluated last by the variables; nothing under constraints, which hold the variables together.
    pub(super) fn derivative(&self) -> Option<DMatrix<f64>> {
        match &self.source {
            RateSource::Free(field) => Some(field.derivative()),
            RateSource::Constrained { .. } => None,
        }
    }

    /// Whether the motion through a state moves, in any units: one of its rates is more than rounding of the variables would
    /// explain, by its linear rates or, under constraints, over this length of time.
    pub(super) fn moves(&mut self, state: &State, length: f64) -> Result<bool, MotionError> {
        let rates = self.at(state)?;
        let sizes = self.sizes(state);
        let add = |i: usize| match &self.source {
            RateSource::Free(field) => {
                let derivative = field.derivative();
                sizes.iter().enumerate().map(|(j, size)| derivative[(i, j)].abs() * size).sum()
            }
            RateSource::Constrained { .. } => sizes[i] / length,
        };
        Ok((0..rates.len()).any(|i| exceeds_rounding(rates[i], add(i))))
    }

    /// The sizes of the variables; one that is zero counts as large as the largest of its kind.
    fn sizes(&self, state: &State) -> Vec<f64> {
        let variables = self.space.variables(state);
        let kinds = if self.space.is_hamiltonian() { 2 } else { 1 };
        let largest = |part: &[f64]| part.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let of = |part: &[f64]| {
            let largest = largest(part);
            part.iter().map(|x| if *x == 0.0 { largest } else { x.abs() }).collect::<Vec<_>>()
        };
        variables.chunks((variables.len() / kinds).max(1)).flat_map(of).collect()
    }
}

/// Whether a rate is more than rounding of what may add to it.
fn exceeds_rounding(rate: f64, terms: f64) -> bool {
    rate.abs() > AT_REST * terms
}

/// An orthonormal basis of the range of a matrix, whose rank is known.
pub(super) fn basis_of_range(matrix: &DMatrix<f64>, rank: usize) -> DMatrix<f64> {
    matrix.clone().col_piv_qr().q().columns(0, rank).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rate_moves_beyond_1e_13_of_what_adds_to_it() {
        assert!(exceeds_rounding(-2.1e-13, 2.0) && !exceeds_rounding(-1.9e-13, 2.0));
        assert!(exceeds_rounding(1e-300, 0.0) && !exceeds_rounding(0.0, 0.0));
    }
}
