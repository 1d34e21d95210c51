//! Orbits along a resonance of tori, where closure hardly depends on where along the torus the motion begins.
//!
//! In: where Newton's method has stalled. Out: where less is missing. Never here: whether that is an orbit.
//!
//! Where a torus with commensurate frequencies was, only a few orbits are left (Poincaré and Birkhoff; A. J. Lichtenberg,
//! M. A. Lieberman, Regular and Chaotic Dynamics, §3.2). The equations of an orbit have then as many small singular values as
//! there are phases to be found: what is missing in their directions is small everywhere and vanishes only at the orbits, and
//! a straight step along them soon violates the others. So the motion is led along the curve on which the others
//! hold: a step in the small directions, limited in length, then corrections in the others (inexact restoration, J. M.
//! Martínez, E. A. Pilotta, J. Optim. Theory Appl. 104 (2000) 135); what leaves less missing is kept. Between two orbits what
//! is missing has no minimum other than zero, for it is the slope of the action along the torus.

use nalgebra::{DMatrix, DVector};

use super::error::DynamicsError;
use super::linear::{self, SingularValues};
use super::newton::{Newton, NewtonIterate, SYMMETRY};

/// What is missing may be this part of the size of an orbit for it to be near a resonance.
const NEAR: f64 = 0.1;

/// The longest step in the small directions, the first, and the least that is tried, in units of the orbit.
const LONGEST: f64 = 0.5;
const FIRST: f64 = 0.1;
const LEAST: f64 = 1e-5;

/// The maximal number of steps, and of corrections after each.
const STEPS: usize = 60;
const CORRECTIONS: usize = 6;

/// The others hold when they miss less than this part of what the small directions do.
const RESTORED: f64 = 0.1;

/// A step that leaves more than this part missing is no progress.
const PROGRESS: f64 = 0.999;

/// The small directions are smaller than the others by this factor at least.
const GAP: f64 = 0.2;

/// Follows the resonance near which a search has stalled, with as many small directions as the gap between singular values says.
///
/// # Errors
/// Returns an error on cancellation.
pub(super) fn along_resonance(
    newton: &Newton<'_>,
    mut here: NewtonIterate,
    first: f64,
) -> Result<NewtonIterate, DynamicsError> {
    if here.residual > NEAR * here.circuit.size {
        return Ok(here);
    }
    let mut longest = FIRST;
    for _ in 0..STEPS {
        if here.is_exact() || longest < LEAST {
            break;
        }
        let Some(split) = Split::of(newton, &here) else { break };
        let mut step = split.small_step();
        let length = step.norm();
        let limited = length > longest;
        if limited {
            step *= longest / length;
        }
        let there = match newton.stepped(&here, &step, first)? {
            Some(there) => restored(newton, there, (split.count, first))?,
            None => None,
        };
        match there.filter(|there| there.residual < PROGRESS * here.residual) {
            Some(there) => {
                here = there;
                longest = if limited { (2.0 * longest).min(LONGEST) } else { longest };
            }
            None => longest = 0.25 * longest.min(length),
        }
    }
    Ok(here)
}

/// After corrections in all but the small directions, until what is missing is missing in these.
fn restored(
    newton: &Newton<'_>,
    mut here: NewtonIterate,
    (count, first): (usize, f64),
) -> Result<Option<NewtonIterate>, DynamicsError> {
    let mut before = f64::INFINITY;
    for _ in 0..CORRECTIONS {
        let Some(split) = Split::with(newton, &here, count) else { return Ok(None) };
        let (small, others) = split.missing();
        if others <= RESTORED * small || others >= 0.5 * before || here.is_exact() {
            break;
        }
        before = others;
        match newton.stepped(&here, &split.step_of_the_others(), first)? {
            Some(there) => here = there,
            None => return Ok(None),
        }
    }
    Ok(Some(here))
}

/// The equations of an orbit by singular values, the small ones apart from the others.
struct Split {
    values: SingularValues,
    /// What is missing in each direction.
    parts: DVector<f64>,
    /// The number of singular values that are not those of symmetries.
    rank: usize,
    /// The number of small ones among them.
    count: usize,
}

impl Split {
    /// With the small ones that the widest gap separates.
    fn of(newton: &Newton<'_>, here: &NewtonIterate) -> Option<Split> {
        let all = Split::with(newton, here, 0)?;
        let sizes = &all.values.sizes;
        let ratio = |k: usize| sizes[k] / sizes[k - 1];
        let gap = (1..all.rank).min_by(|&a, &b| ratio(a).total_cmp(&ratio(b)))?;
        (ratio(gap) < GAP).then(|| Split { count: all.rank - gap, ..all })
    }

    fn with(newton: &Newton<'_>, here: &NewtonIterate, count: usize) -> Option<Split> {
        let (matrix, right) = newton.equations(&here.circuit);
        let values = linear::singular_values(&matrix)?;
        let parts = values.left.transpose() * &right;
        let largest = values.sizes.iter().copied().fold(0.0, f64::max);
        let rank = values.sizes.iter().filter(|&&size| size > SYMMETRY * largest).count();
        (count < rank).then_some(Split { values, parts, rank, count })
    }

    /// Newton's step in these directions.
    fn step(&self, which: core::ops::Range<usize>) -> DVector<f64> {
        let right: &DMatrix<f64> = &self.values.right;
        let mut step = DVector::zeros(right.nrows());
        for k in which {
            step.axpy(self.parts[k] / self.values.sizes[k], &right.column(k), 1.0);
        }
        step
    }

    fn small_step(&self) -> DVector<f64> {
        self.step(self.rank - self.count..self.rank)
    }

    fn step_of_the_others(&self) -> DVector<f64> {
        self.step(0..self.rank - self.count)
    }

    /// What is missing in the small directions, and in the others.
    fn missing(&self) -> (f64, f64) {
        let steep = self.rank - self.count;
        (self.parts.rows(steep, self.count).norm(), self.parts.rows(0, steep).norm())
    }
}
