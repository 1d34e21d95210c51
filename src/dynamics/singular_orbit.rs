//! Orbits that come so close to a singularity of their law that rounding leaves nothing of their multipliers.
//!
//! In: a motion that closes. Out: what is said of it where its monodromy matrix is not known. Never here: how an orbit is
//! searched for.
//!
//! Beside a collision, or where an angle is undefined, neighbouring states part and come together again by factors far larger
//! than those of the whole period. What rounding is there, amplified by the flow that follows, may be all that is left of the
//! matrix, although the motion itself closes to the last digit.

use super::error::DynamicsError;
use super::flow_map::flow_map;
use super::newton::{Newton, NewtonIterate};
use crate::num::short;

/// A monodromy matrix whose error is this part of its largest singular value is not known.
const UNKNOWN: f64 = 1e-3;

/// Whether a matrix with this largest singular value is known that has this error.
fn is_known(error: f64, growth: f64) -> bool {
    error <= UNKNOWN * growth
}

impl Newton<'_> {
    /// Why the multipliers of the orbit are not known; nothing where they are.
    pub(super) fn singular(&self, closed: &NewtonIterate) -> Result<Option<String>, DynamicsError> {
        let circuit = &closed.circuit;
        let Some(rounding) = &circuit.rounding else { return Ok(None) };
        let error = self.units.map(&rounding.error).amax();
        if is_known(error, circuit.growth()) {
            return Ok(None);
        }
        let start = &closed.state;
        let near = flow_map(self.space, self.method, start, rounding.worst, &mut |_| {})?;
        let values = self.space.variables(&near.state);
        let place: Vec<String> = (self.space.names().iter().zip(values))
            .map(|(name, value)| format!("{name} = {}", short(*value)))
            .collect();
        Ok(Some(format!(
            "the orbit that closes near the start, after {}, passes close to a singularity of its law, at {} after its \
             start: {}. Neighbouring motions separate there so far that rounding may change the matrix of its multipliers by \
             {:.0e} of its size, so that they are not known. Begin farther from it, or with another period or energy",
            short(closed.period),
            short(rounding.worst - start.time),
            place.join(", "),
            error / circuit.growth()
        )))
    }
}

#[cfg(test)]
mod tests {
    use super::is_known;

    #[test]
    fn a_matrix_is_known_to_a_thousandth_or_not_at_all() {
        assert!(is_known(0.8e-3 * 20.0, 20.0) && !is_known(1.25e-3 * 20.0, 20.0));
        assert!(!is_known(f64::NAN, 20.0));
    }
}
