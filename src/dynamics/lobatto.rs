//! Legendre–Gauss–Lobatto nodes: quadrature, differentiation and interpolation by polynomials.
//!
//! In: a number of intervals N. Out: N + 1 nodes on [−1, 1] with both ends, weights exact up to
//! degree 2N − 1, the matrix of derivatives (C. Canuto et al., Spectral Methods, 2006, § 2.3).
//! Never here: what is integrated.

use nalgebra::DMatrix;

use crate::num::{legendre, math, newton};

/// Nodes with what belongs to them.
#[derive(Clone, Debug)]
pub(super) struct Lobatto {
    /// The nodes, ascending.
    pub(super) nodes: Vec<f64>,
    pub(super) weights: Vec<f64>,
    /// D_ij = ℓ_j′(x_i).
    pub(super) derivative: DMatrix<f64>,
    barycentric: Vec<f64>,
}

impl Lobatto {
    /// The nodes of a polynomial of degree `n` ≥ 2.
    pub(super) fn new(n: usize) -> Lobatto {
        let degree = n as f64;
        let mut nodes: Vec<f64> =
            (0..=n).map(|i| -math::cos(std::f64::consts::PI * i as f64 / degree)).collect();
        for x in &mut nodes[1..n] {
            // zeros of P_n′, by (1 − x²) P_n″ = 2x P_n′ − n(n+1) P_n
            *x = newton(*x, 50, |x| {
                let (value, last) = legendre(n, x);
                let rest = 1.0 - x * x;
                let slope = degree * (last - x * value) / rest;
                let curvature = (2.0 * x * slope - degree * (degree + 1.0) * value) / rest;
                slope / curvature
            });
        }
        (nodes[0], nodes[n]) = (-1.0, 1.0);
        let values: Vec<f64> = nodes.iter().map(|&x| legendre(n, x).0).collect();
        let total = degree * (degree + 1.0);
        let weights = values.iter().map(|p| 2.0 / (total * p * p)).collect();
        let mut derivative = DMatrix::from_fn(n + 1, n + 1, |i, j| {
            if i == j { 0.0 } else { values[i] / (values[j] * (nodes[i] - nodes[j])) }
        });
        for i in 0..=n {
            // rows of derivatives of the constant vanish
            derivative[(i, i)] = -derivative.row(i).sum();
        }
        let barycentric = values.iter().map(|p| 1.0 / p).collect();
        Lobatto { nodes, weights, derivative, barycentric }
    }

    /// The coefficients by which values at the nodes give that at x.
    pub(super) fn interpolation(&self, x: f64) -> Vec<f64> {
        if let Some(i) = self.nodes.iter().position(|&node| node == x) {
            return (0..self.nodes.len()).map(|j| if i == j { 1.0 } else { 0.0 }).collect();
        }
        let terms: Vec<f64> =
            self.barycentric.iter().zip(&self.nodes).map(|(w, node)| w / (x - node)).collect();
        let sum: f64 = terms.iter().sum();
        terms.into_iter().map(|term| term / sum).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_integrated_differentiated_and_interpolated_exactly() {
        for n in [2, 3, 8, 21, 40] {
            let rule = Lobatto::new(n);
            for power in 0..2 * n {
                let terms = rule.nodes.iter().zip(&rule.weights);
                let sum: f64 = terms.map(|(x, w)| w * math::powi(*x, power as i32)).sum();
                let exact = if power % 2 == 0 { 2.0 / (power as f64 + 1.0) } else { 0.0 };
                assert!((sum - exact).abs() < 1e-14, "{n}: ∫x^{power} = {sum}");
            }
            let sum: f64 = rule
                .nodes
                .iter()
                .zip(&rule.weights)
                .map(|(x, w)| w * math::powi(*x, 2 * n as i32))
                .sum();
            assert!(n > 8 || (sum - 2.0 / (2 * n + 1) as f64).abs() > 1e-9, "{n}");
            for (i, &x) in rule.nodes.iter().enumerate() {
                let power = n as i32;
                let slope: f64 = rule
                    .nodes
                    .iter()
                    .enumerate()
                    .map(|(j, node)| rule.derivative[(i, j)] * math::powi(*node, power))
                    .sum();
                let exact = f64::from(power) * math::powi(x, power - 1);
                assert!((slope - exact).abs() < 1e-11 * n as f64, "{n}: {slope} {exact}");
            }
            for x in [-0.93, 0.11, 0.7] {
                let at = rule.interpolation(x);
                let value: f64 = at
                    .iter()
                    .zip(&rule.nodes)
                    .map(|(c, node)| c * math::powi(*node, n as i32))
                    .sum();
                assert!((value - math::powi(x, n as i32)).abs() < 1e-13, "{n}: at {x}");
            }
        }
    }
}
