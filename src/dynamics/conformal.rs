//! How fast the flow shrinks areas: the rate c at which Σ dp ∧ dq changes, where it is one number.
//!
//! With D = ∂f/∂z, the form changes at the rate Dᵀ𝕁 + 𝕁D. It is zero where the motion is Hamilton's, and c𝕁 where friction
//! takes the same part of each momentum: then areas, and ∮ Σ p dq around every closed curve, are multiplied by e^{ct}
//! (R. McLachlan and M. Perlmutter, J. Geom. Phys. 39 (2001) 276). For one degree of freedom c is the trace of D
//! (Liouville).
//!
//! A law that depends on time is evaluated over a period of its drive.
//!
//! In: a phase space and some of its states. Out: the rate. Never here: curves.

use nalgebra::DMatrix;

use super::error::DynamicsError;
use super::phase_space::PhaseSpace;
use crate::system::Form;

/// Rates that differ by less than this part of the size of D are the same.
const SAME: f64 = 1e-10;

/// How many times each state is evaluated over a period of the drive, and the part of it from one time to the next: no
/// harmonic is at all of them what it is at the first.
const TIMES: u8 = 5;
const PART: f64 = 0.618_033_988_749_894_8;

/// The rate c at which areas change along the flow: `None` if it is not the same number everywhere, evaluated in these
/// states, or the variables are not canonical, or the law depends on time without a period.
///
/// # Errors
/// Returns an error if the law of motion cannot be evaluated at one of them.
pub fn conformal_rate<'a>(
    space: &PhaseSpace,
    time: f64,
    states: impl IntoIterator<Item = &'a [f64]>,
) -> Result<Option<f64>, DynamicsError> {
    if space.form() != Form::Momentum {
        return Ok(None);
    }
    if space.is_hamiltonian() {
        return Ok(Some(0.0));
    }
    let period = match space.drive() {
        _ if space.is_autonomous() => 0.0,
        Some(period) => period,
        None => return Ok(None),
    };
    let times = if period > 0.0 { TIMES } else { 1 };
    let size = space.dimension();
    let half = size / 2;
    let unit = DMatrix::from_fn(size, size, |i, j| {
        f64::from(i8::from(j == i + half) - i8::from(i == j + half))
    });
    let mut field = space.vector_field();
    let mut rate: Option<f64> = None;
    let samples = states.into_iter().flat_map(|variables| (0..times).map(move |k| (variables, k)));
    for (variables, k) in samples {
        field.evaluate(time + (PART * f64::from(k)).fract() * period, variables)?;
        let derivative = field.derivative();
        let change = derivative.transpose() * &unit + &unit * &derivative;
        let here = (0..half).map(|i| change[(i, half + i)]).sum::<f64>() / half as f64;
        let rate = *rate.get_or_insert(here);
        let off = (change - &unit * rate).amax();
        if !is_same(off, derivative.amax()) {
            return Ok(None);
        }
    }
    Ok(rate)
}

/// Whether rates that differ by this much are the same, beside the size of D.
fn is_same(off: f64, size: f64) -> bool {
    off <= SAME * size
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_the_same_to_1e_10_of_the_size_of_the_derivative() {
        assert!(is_same(1.9e-10, 2.0) && !is_same(2.1e-10, 2.0));
        assert!(is_same(0.0, 0.0) && !is_same(f64::NAN, 2.0));
    }
}
