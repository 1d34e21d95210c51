//! The weighted Birkhoff average, which converges faster than any power of the number of values where these are a smooth
//! function along a rotation.
//!
//! In: values, one for each turn. Out: their average. Never here: its error.
//! Source: S. Das, Y. Saiki, E. Sander, J. A. Yorke, Nonlinearity 30 (2017) 4111.

use super::math;

/// Σ w x / Σ w with the weights e^{−1/(u(1−u))}, u from 0 to 1 along the values.
pub fn birkhoff_average(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let (mut sum, mut weights) = (0.0, 0.0);
    for (k, value) in values.iter().enumerate() {
        let u = (k as f64 + 0.5) / count;
        let weight = math::exp(-1.0 / (u * (1.0 - u)));
        sum += weight * value;
        weights += weight;
    }
    sum / weights
}
