//! Units in which an orbit is of size one, so that closing it does not depend on those of the file.
//!
//! In: a motion over about a period. Out: [`OrbitUnits`]: one unit for each variable and one of time. Those of canonical variables
//! are conformally symplectic: the product of a coordinate's and its momentum's is the same for all, so that gradients and
//! rates stay each other's images under 𝕁. Never here: how the orbit is closed.

use nalgebra::{DMatrix, DVector};

use super::carrier::Carrier;
use super::error::DynamicsError;
use super::phase_space::PhaseSpace;
use crate::integrate::{Method, Settings, Stepping};
use crate::num::math;
use crate::system::State;

/// What moves by less than this part of its size does not move.
const MOVED: f64 = 1e-12;

/// A unit for each variable, and one of time.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct OrbitUnits {
    variables: DVector<f64>,
    time: f64,
}

impl OrbitUnits {
    pub(super) fn of_file(dimension: usize) -> OrbitUnits {
        OrbitUnits { variables: DVector::repeat(dimension, 1.0), time: 1.0 }
    }

    /// Those of the motion from a state over a period: how far it goes in each variable, by `apart` from its start.
    pub(super) fn of_motion(
        space: &PhaseSpace,
        (method, settings): (&'static Method, Settings),
        (start, period): (&State, f64),
        apart: impl Fn(&State) -> DVector<f64>,
    ) -> Result<OrbitUnits, DynamicsError> {
        let mut carrier = Carrier::new(space, method, settings, 0)?;
        carrier.start(start, &DMatrix::zeros(space.dimension(), 0))?;
        let parts = if method.stepping == Stepping::Fixed { 1 } else { 16 };
        let until = start.time + period;
        let mut extents = DVector::zeros(space.dimension());
        while carrier.time() < until {
            carrier.step(until)?;
            let (begin, end) = carrier.interval();
            for part in 1..=parts {
                let now = begin + (end.min(until) - begin) * f64::from(part) / f64::from(parts);
                let (state, _) = carrier.at(now)?;
                extents = extents.sup(&apart(&state).abs());
            }
        }
        // what a conserved quantity moves by is rounding
        for (extent, &variable) in extents.iter_mut().zip(space.variables(start)) {
            if !moves(*extent, variable) {
                *extent = 0.0;
            }
        }
        let variables = if space.is_hamiltonian() { conformal(&extents) } else { filled(&extents) };
        Ok(OrbitUnits { variables, time: period })
    }

    /// Displacements, or rates, in these units.
    pub(super) fn scaled(&self, z: &DVector<f64>) -> DVector<f64> {
        z.component_div(&self.variables)
    }

    /// What displacements in these units are in those of the file.
    pub(super) fn unscaled(&self, z: &DVector<f64>) -> DVector<f64> {
        z.component_mul(&self.variables)
    }

    /// Rates in these units.
    pub(super) fn rates(&self, rates: &DVector<f64>) -> DVector<f64> {
        self.scaled(rates) * self.time
    }

    /// A linear map of displacements in these units.
    pub(super) fn map(&self, matrix: &DMatrix<f64>) -> DMatrix<f64> {
        let unit = &self.variables;
        DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
            matrix[(i, j)] * (unit[j] / unit[i])
        })
    }

    /// The gradient of the energy in the units of the variables, from rates in these units: ∇H = −𝕁 ż.
    pub(super) fn gradient(&self, rates: &DVector<f64>) -> DVector<f64> {
        let half = rates.len() / 2;
        let raw = self.unscaled(rates) / self.time;
        let gradient =
            DVector::from_fn(
                rates.len(),
                |i, _| {
                    if i < half { -raw[half + i] } else { raw[i - half] }
                },
            );
        self.unscaled(&gradient)
    }

    /// A gradient of the file in these units.
    pub(super) fn covector(&self, gradient: &DVector<f64>) -> DVector<f64> {
        self.unscaled(gradient)
    }

    /// The unit of time.
    pub(super) fn time(&self) -> f64 {
        self.time
    }
}

/// Whether a variable that goes this far from its start moves by more than rounding.
fn moves(extent: f64, variable: f64) -> bool {
    extent > MOVED * variable.abs()
}

/// Extents with those that are zero, or not finite, as the largest.
fn filled(extents: &DVector<f64>) -> DVector<f64> {
    let good = |x: f64| x > 0.0 && x.is_finite();
    let largest = extents.iter().copied().filter(|x| good(*x)).fold(0.0, f64::max);
    let largest = if good(largest) { largest } else { 1.0 };
    extents.map(|x| if good(x) { x } else { largest })
}

/// Units of canonical variables in which the motion is about of size one: u_q u_p is the largest product of extents,
/// u_q / u_p the ratio of the two.
fn conformal(extents: &DVector<f64>) -> DVector<f64> {
    let half = extents.len() / 2;
    let good = |x: f64| x > 0.0 && x.is_normal();
    let ratios: Vec<f64> = (0..half).map(|i| extents[i] / extents[half + i]).collect();
    let known: Vec<f64> = ratios.iter().copied().filter(|x| good(*x)).map(math::ln).collect();
    let common = math::exp(known.iter().sum::<f64>() / known.len().max(1) as f64);
    let product = (0..half).map(|i| extents[i] * extents[half + i]).fold(0.0, f64::max);
    if !good(product) {
        return filled(extents);
    }
    DVector::from_fn(extents.len(), |k, _| {
        let ratio = ratios[k % half];
        let ratio = if good(ratio) { ratio } else { common };
        let root = product.sqrt();
        if k < half { root * ratio.sqrt() } else { root / ratio.sqrt() }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_moves_by_a_trillionth_of_its_size_moves_by_rounding() {
        assert!(!moves(0.8e-12 * 3.0, -3.0) && moves(1.25e-12 * 3.0, -3.0));
        assert!(!moves(0.0, 0.0) && moves(1e-300, 0.0));
    }
}
