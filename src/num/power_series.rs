//! Functions of power series, order by order.

use super::math;

/// The coefficients of √(Σ cₖ xᵏ), from r² = c order by order: 2 r₀ r_k = c_k − Σ r_j r_{k−j}. They are not finite where c₀
/// has no positive root.
pub fn square_root(coefficients: &[f64]) -> Vec<f64> {
    let mut root: Vec<f64> = Vec::with_capacity(coefficients.len());
    for (k, &c) in coefficients.iter().enumerate() {
        let next = match root.first() {
            None => c.sqrt(),
            Some(first) => {
                let inner: f64 = (1..k).map(|j| root[j] * root[k - j]).sum();
                (c - inner) / (2.0 * first)
            }
        };
        root.push(next);
    }
    root
}

/// The coefficients of 1/√(1 + (Σ cₖ xᵏ)²): the cosine of the arctangent, which passes zero at a simple pole of the series.
pub fn cosine_of_arctangent(coefficients: &[f64]) -> Vec<f64> {
    let c = coefficients;
    let square = |k: usize| -> f64 { (0..=k).map(|j| c[j] * c[k - j]).sum() };
    let one = |k: usize| if k == 0 { 1.0 } else { 0.0 };
    let secant = square_root(&(0..c.len()).map(|k| one(k) + square(k)).collect::<Vec<f64>>());
    let mut cosine: Vec<f64> = Vec::with_capacity(c.len());
    for k in 0..c.len() {
        let inner: f64 = (0..k).map(|j| cosine[j] * secant[k - j]).sum();
        cosine.push((one(k) - inner) / secant[0]);
    }
    cosine
}

/// The coefficients of cos(½ Σ cₖ xᵏ), from cos′ = −sin · u′ and sin′ = cos · u′: it passes zero where the angle is ±π.
pub fn cosine_of_half(coefficients: &[f64]) -> Vec<f64> {
    let half = |k: usize| 0.5 * coefficients[k];
    let Some(first) = coefficients.first() else { return Vec::new() };
    let (mut cosine, mut sine) = (vec![math::cos(0.5 * first)], vec![math::sin(0.5 * first)]);
    for k in 1..coefficients.len() {
        let slope = |other: &[f64]| {
            (1..=k).map(|j| j as f64 * half(j) * other[k - j]).sum::<f64>() / k as f64
        };
        let next = (-slope(&sine), slope(&cosine));
        cosine.push(next.0);
        sine.push(next.1);
    }
    cosine
}

#[cfg(test)]
mod tests {
    use super::{cosine_of_arctangent, cosine_of_half, square_root};

    fn near(found: &[f64], expected: &[f64]) {
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-16, "{found}, not {expected}");
        }
    }

    /// cos(π/2 + x) = −sin x = −x + x³/6 − x⁵/120, which passes zero where the angle is π.
    #[test]
    fn the_cosine_of_half_an_angle_passes_zero_at_the_cut() {
        let angle = [core::f64::consts::PI, 2.0, 0.0, 0.0, 0.0, 0.0];
        let expected = [0.0, -1.0, 0.0, 1.0 / 6.0, 0.0, -1.0 / 120.0];
        near(&cosine_of_half(&angle), &expected);
    }

    /// tan x = x + x³/3 + 2x⁵/15 + …, and cos x.
    #[test]
    fn the_cosine_of_an_angle_follows_from_its_tangent() {
        let tangent = [0.0, 1.0, 0.0, 1.0 / 3.0, 0.0, 2.0 / 15.0, 0.0];
        let cosine = [1.0, 0.0, -0.5, 0.0, 1.0 / 24.0, 0.0, -1.0 / 720.0];
        near(&cosine_of_arctangent(&tangent), &cosine);
    }

    #[test]
    fn the_root_of_a_square_is_what_was_squared() {
        // (2 − 3x + x²)², and the binomial series of √(1 + x)
        let root = square_root(&[4.0, -12.0, 13.0, -6.0, 1.0, 0.0, 0.0]);
        assert_eq!(root, [2.0, -3.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(square_root(&[1.0, 1.0, 0.0, 0.0]), [1.0, 0.5, -0.125, 0.0625]);
        assert!(square_root(&[0.0, 1.0])[1].is_infinite() && square_root(&[-1.0])[0].is_nan());
    }
}
