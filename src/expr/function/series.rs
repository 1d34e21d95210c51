//! Sums shared by the Taylor rules. All series are normalised: `u[j] = u⁽ʲ⁾/j!`.

use crate::num::Real;

/// `Σ_{j=1}^{k} j u_j w_{k−j}`: k times the k-th coefficient of ∫ u′ w.
pub(super) fn chain<R: Real>(k: usize, u: &[R], w: &[R]) -> R {
    (1..=k).fold(R::ZERO, |sum, j| sum + u[j] * w[k - j] * j as f64)
}

/// `Σ_{j=1}^{k−1} j y_j w_{k−j}`: the part of the k (y′ w) coefficients that is known before `y_k`.
pub(super) fn known<R: Real>(k: usize, y: &[R], w: &[R]) -> R {
    (1..k).fold(R::ZERO, |sum, j| sum + y[j] * w[k - j] * j as f64)
}

/// `Σ_{j=0}^{k} a_j b_{k−j}`: the k-th coefficient of a product.
pub(super) fn product<R: Real>(k: usize, a: &[R], b: &[R]) -> R {
    (0..=k).fold(R::ZERO, |sum, j| sum + a[j] * b[k - j])
}
