//! The directions across a motion: those in which neighbouring motions of the same energy differ
//! from it by more than a shift in time.
//!
//! In: the rates f at a state. Out: an orthonormal frame of the directions that are left when f,
//! and with a conserved H also ∇H = −𝕁f, are taken out. Where both are, the frame is symplectic,
//! e₁ … eₘ, 𝕁eₘ … 𝕁e₁, in that order: a triangular matrix between two such frames has reciprocal
//! diagonal entries in pairs, so that exponents come in pairs ±λ at every time. Under constraints the frame is one of the
//! displacements that they allow, and pairs hold in the mean. Where a motion is given by brackets the gradients of H and of the
//! Casimirs are taken out as they are. Never here: how the directions move.

use nalgebra::{DMatrix, DVector};

use super::flow_direction::basis_of_range;

/// A gradient of which no more than this part lies outside others depends on them.
const DEPENDENT: f64 = 1e-6;

/// Which directions are taken out.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Removed {
    /// None: the law of motion depends on time, or motions come to rest.
    Nothing,
    /// That of the motion itself.
    Flow,
    /// That of the motion and that of the energy.
    FlowAndEnergy,
}

impl Removed {
    /// The number of directions taken out.
    pub fn count(self) -> usize {
        match self {
            Removed::Nothing => 0,
            Removed::Flow => 1,
            Removed::FlowAndEnergy => 2,
        }
    }
}

/// 𝕁 v for v = (δq, δp): (δp, −δq).
fn rotated(v: &DVector<f64>) -> DVector<f64> {
    let n = v.len() / 2;
    DVector::from_fn(v.len(), |i, _| if i < n { v[i + n] } else { -v[i - n] })
}

/// The unit vectors of what is taken out at a place with these rates.
pub(super) fn removed(rates: &DVector<f64>, what: Removed) -> Vec<DVector<f64>> {
    let Some(along) = rates.try_normalize(0.0) else { return Vec::new() };
    match what {
        Removed::Nothing => Vec::new(),
        Removed::Flow => vec![along],
        Removed::FlowAndEnergy => vec![along.clone(), rotated(&along)],
    }
}

/// Takes the components along orthonormal vectors out of a vector, twice against rounding.
fn project_out(v: &mut DVector<f64>, of: &[DVector<f64>]) {
    for _ in 0..2 {
        for unit in of {
            let part = unit.dot(v);
            v.axpy(-part, unit, 1.0);
        }
    }
}

/// An orthonormal frame across a motion with these rates; symplectic if `canonical`.
pub(super) fn frame(rates: &DVector<f64>, what: Removed, canonical: bool) -> DMatrix<f64> {
    frame_outside(rates.len(), removed(rates, what), canonical && what != Removed::Flow)
}

/// An orthonormal frame across a motion with these rates and within the level sets of functions with these gradients, and which
/// of them are independent.
pub(super) fn frame_within_levels(
    rates: &DVector<f64>,
    what: Removed,
    gradients: &[DVector<f64>],
) -> (DMatrix<f64>, Vec<bool>) {
    let mut taken = removed(rates, what);
    let independent = |gradient: &DVector<f64>| {
        let mut across = gradient.clone();
        project_out(&mut across, &taken);
        let is_one = across.norm() > DEPENDENT * gradient.norm();
        taken.extend(is_one.then(|| across.normalize()));
        is_one
    };
    let independent: Vec<bool> = gradients.iter().map(independent).collect();
    (frame_outside(rates.len(), taken, false), independent)
}

/// An orthonormal frame of what is outside orthonormal vectors; symplectic if they are and it is asked for.
fn frame_outside(n: usize, mut taken: Vec<DVector<f64>>, symplectic: bool) -> DMatrix<f64> {
    let wanted = n - taken.len();
    let mut first = Vec::new();
    let mut last = Vec::new();
    while first.len() + last.len() < wanted {
        // the unit vector that lies farthest outside what there is
        let outside = |i: usize| {
            let mut v = DVector::zeros(n);
            v[i] = 1.0;
            project_out(&mut v, &taken);
            v
        };
        let Some(found) = (0..n).map(outside).max_by(|a, b| a.norm().total_cmp(&b.norm())) else {
            break;
        };
        let unit = found.normalize();
        taken.push(unit.clone());
        if symplectic {
            let partner = rotated(&unit);
            taken.push(partner.clone());
            last.push(partner);
        }
        first.push(unit);
    }
    first.extend(last.into_iter().rev());
    DMatrix::from_fn(n, first.len(), |i, j| first[j][i])
}

/// The same of displacements that constraints allow, those in the range of an orthonormal `basis`, in which the rates lie.
pub(super) fn frame_within(
    basis: &DMatrix<f64>,
    rates: &DVector<f64>,
    what: Removed,
) -> DMatrix<f64> {
    let mut left = DMatrix::identity(basis.ncols(), basis.ncols());
    let taken = removed_within(basis, rates, what);
    for unit in &taken {
        left -= unit * unit.transpose();
    }
    let count = basis.ncols().saturating_sub(taken.len());
    basis * basis_of_range(&left, count)
}

/// The unit vectors of what is taken out, in coordinates of an orthonormal basis. Of the gradient of H only what lies in the
/// space matters, and there it is orthogonal to the rates too: fᵀ𝕁f = 0.
fn removed_within(basis: &DMatrix<f64>, rates: &DVector<f64>, what: Removed) -> Vec<DVector<f64>> {
    let inside = removed(rates, what).into_iter().map(|v| basis.transpose() * v);
    inside.filter_map(|v| v.try_normalize(0.0)).collect()
}

/// Makes the columns of `vectors` orthonormal, one after the other, outside what is taken out at a
/// place with these rates. Returns their lengths after those before them were taken out.
pub(super) fn orthonormalise(
    vectors: &mut DMatrix<f64>,
    rates: &DVector<f64>,
    what: Removed,
) -> Vec<f64> {
    orthonormal(vectors, removed(rates, what))
}

/// The same of displacements that constraints allow: what rounding has left outside the range of `basis` is dropped.
pub(super) fn orthonormalise_within(
    vectors: &mut DMatrix<f64>,
    basis: &DMatrix<f64>,
    rates: &DVector<f64>,
    what: Removed,
) -> Vec<f64> {
    let mut inside = basis.transpose() * &*vectors;
    let lengths = orthonormal(&mut inside, removed_within(basis, rates, what));
    *vectors = basis * inside;
    lengths
}

/// Makes columns orthonormal, one after the other, outside the vectors `taken`.
fn orthonormal(vectors: &mut DMatrix<f64>, mut taken: Vec<DVector<f64>>) -> Vec<f64> {
    let mut lengths = Vec::with_capacity(vectors.ncols());
    for mut column in vectors.column_iter_mut() {
        let mut v = DVector::from_column_slice(column.as_slice());
        project_out(&mut v, &taken);
        let length = v.norm();
        lengths.push(length);
        let unit = v / length;
        column.copy_from(&unit);
        taken.push(unit);
    }
    lengths
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gradient_is_independent_from_a_millionth_of_it_outside_the_others_on() {
        let rates = DVector::from_vec(vec![1.0, 0.0, 0.0]);
        for (part, is_one) in [(0.9e-6, false), (1.1e-6, true)] {
            for size in [1e-30, 1.0, 1e30] {
                let gradients = [[0.0, 1.0, 0.0], [0.0, 1.0, part]];
                let gradients = gradients.map(|g| DVector::from_vec(g.to_vec()) * size);
                let (frame, found) = frame_within_levels(&rates, Removed::Flow, &gradients);
                assert_eq!(found, [true, is_one], "{part} {size}");
                assert_eq!(frame.ncols(), usize::from(!is_one), "{part} {size}");
            }
        }
    }

    #[test]
    fn frames_are_symplectic_and_outside_what_is_taken_out() {
        let rates = DVector::from_vec(vec![0.3, -1.0, 0.2, 0.5, 2.0, -0.7]);
        let frame = frame(&rates, Removed::FlowAndEnergy, true);
        assert_eq!(frame.ncols(), 4);
        let one = frame.transpose() * &frame;
        assert!((one - DMatrix::identity(4, 4)).amax() < 1e-14);
        assert!((frame.transpose() * &rates).amax() < 1e-14);
        let form = |a: usize, b: usize| {
            (0..3)
                .map(|i| frame[(i, a)] * frame[(i + 3, b)] - frame[(i + 3, a)] * frame[(i, b)])
                .sum::<f64>()
        };
        for (a, b) in [(0, 3), (1, 2)] {
            assert!((form(a, b).abs() - 1.0).abs() < 1e-14);
        }
        for (a, b) in [(0, 1), (0, 2), (1, 3), (2, 3)] {
            assert!(form(a, b).abs() < 1e-14);
        }
    }
}
