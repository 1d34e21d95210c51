//! The square root of a power series.

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

#[cfg(test)]
mod tests {
    use super::square_root;

    #[test]
    fn the_root_of_a_square_is_what_was_squared() {
        // (2 − 3x + x²)², and the binomial series of √(1 + x)
        let root = square_root(&[4.0, -12.0, 13.0, -6.0, 1.0, 0.0, 0.0]);
        assert_eq!(root, [2.0, -3.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(square_root(&[1.0, 1.0, 0.0, 0.0]), [1.0, 0.5, -0.125, 0.0625]);
        assert!(square_root(&[0.0, 1.0])[1].is_infinite() && square_root(&[-1.0])[0].is_nan());
    }
}
