//! How far a motion whose time was reversed is expected to miss its way.
//!
//! In: the error of a step, the exponent. Out: a distance. Never here: motions.

use crate::num::math;

/// ε e^{λT} after a time T gone back or, where the error ε of a step of size h was measured, ε Σ e^{λkh} over all steps: each
/// adds its own, which has grown since.
pub fn expected_return((error, step): (f64, Option<f64>), rate: f64, gone: f64) -> f64 {
    let whole = math::exp(rate * gone);
    match step {
        None => error * whole,
        Some(step) if (rate * gone).abs() < 1e-9 => error * gone / step,
        Some(step) => error * (whole - 1.0) / (1.0 - math::exp(-rate * step)),
    }
}
