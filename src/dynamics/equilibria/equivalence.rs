//! When two places that a search finds are one equilibrium.
//!
//! In: two places at which the rates vanish. Out: whether they differ by rounding alone. Never here: families, whose members are
//! equilibria each.

use nalgebra::DVector;

use super::search::{EquilibriumSearch, LawAtRest, size_of};
use crate::dynamics::equilibrium::Equilibrium;
use crate::dynamics::equilibrium_kind::EquilibriumKind;
use crate::dynamics::linear;

/// Two energies are the same up to this part of what V changes by in the next unit beyond the two places, on the line through them.
const SAME_ENERGY: f64 = 1e-7;

/// The rounding error of an energy, as a part of it.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Places nearer to each other than this, in their size, may differ by rounding alone: where the rates between them are no more
/// than this multiple of their rounding error, and the places no farther apart than it leaves them uncertain. It is seen in so many
/// places that are the same as one.
const NEAR: f64 = 1e-3;
const ABOVE_NOISE: f64 = 4.0;
const NOISE_SAMPLES: u32 = 8;

/// Two places are the same up to this distance relative to their size plus their unit.
const SAME: f64 = 1e-7;

impl EquilibriumSearch<'_> {
    /// Whether two equilibria at which V changes by less than a square differ by rounding alone: V is the same between them.
    pub(super) fn is_flat_between(&self, known: &Equilibrium, one: &Equilibrium) -> bool {
        let degenerate = |one: &Equilibrium| one.kind == Some(EquilibriumKind::Degenerate);
        if !degenerate(known) || !degenerate(one) {
            return false;
        }
        let energy = |part: f64| {
            let pairs = known.variables.iter().zip(&one.variables);
            let variables: Vec<f64> = pairs.map(|(a, b)| a + part * (b - a)).collect();
            let state = self.space.state_at(self.start, &variables);
            self.space.system().energy(&state, self.space.parameters()).ok()
        };
        let change = |part: f64| energy(part).map(|energy| (energy - known.energy).abs());
        let apart = self.in_units(&known.variables) - self.in_units(&one.variables);
        let apart = apart.amax().max(f64::MIN_POSITIVE);
        let beyond = [-1.0 / apart, 1.0 + 1.0 / apart].map(|part| change(part).unwrap_or(0.0));
        let within = same_energy(beyond[0].max(beyond[1]), known.energy);
        [1.0, 0.75, 0.5, 0.25].into_iter().all(|part| change(part).is_some_and(|x| x <= within))
    }

    /// Whether two places near each other, at which the rates vanish to rounding, differ by rounding alone: the rates between
    /// them are no more than what rounding leaves of them.
    pub(super) fn is_lost_between(&mut self, known: &[f64], one: &[f64]) -> bool {
        let size = size_of(&self.in_units(known));
        let apart = (self.in_units(known) - self.in_units(one)).amax();
        if !is_near(apart, size) {
            return false;
        }
        let Some((f, df)) = self.equations_in_units(known) else { return false };
        let mut noise = 0.0_f64;
        for step in 1..=NOISE_SAMPLES {
            let mut there = known.to_vec();
            let moved = SAME * size * f64::from(step) / f64::from(NOISE_SAMPLES);
            self.unknowns.iter().for_each(|&i| there[i] += moved * self.units[i]);
            let Some((g, _)) = self.equations_in_units(&there) else { return false };
            let linear = &f + &df * DVector::from_element(df.ncols(), moved);
            noise = noise.max((g - linear).amax());
        }
        let Some(slopes) = linear::singular_values(&df) else { return false };
        is_noise(apart * slopes.sizes.min(), noise)
            && [0.25, 0.5, 0.75].into_iter().all(|part| {
                let pairs = known.iter().zip(one);
                let there: Vec<f64> = pairs.map(|(a, b)| a + part * (b - a)).collect();
                self.equations_in_units(&there).is_some_and(|(g, _)| is_noise(g.amax(), noise))
            })
    }

    pub(super) fn alike(&self, a: &[f64], b: &[f64]) -> bool {
        // velocities follow from the coordinates
        let places = matches!(self.law, LawAtRest::Constrained(_));
        let mut unknowns = self.unknowns.iter().filter(|&&i| !places || i < self.degrees);
        unknowns.all(|&i| {
            let mut apart = a[i] - b[i];
            if let Some(period) = self.space.turns()[i] {
                apart -= (apart / period).round() * period;
            }
            is_same(apart, self.units[i] + a[i].abs())
        })
    }
}

/// By how much the energies of one equilibrium may differ, where V changes by `beyond` in the next unit.
fn same_energy(beyond: f64, energy: f64) -> f64 {
    SAME_ENERGY * beyond + ROUNDING * energy.abs()
}

/// Whether places may differ by rounding alone, beside their size.
fn is_near(apart: f64, size: f64) -> bool {
    apart <= NEAR * size
}

/// Whether rates are no more than what rounding leaves of them.
fn is_noise(rates: f64, noise: f64) -> bool {
    rates <= ABOVE_NOISE * noise
}

/// Whether places are the same, beside their size and unit.
fn is_same(apart: f64, size: f64) -> bool {
    apart.abs() <= SAME * size
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_places_are_one_equilibrium_to_1e_7_of_their_size() {
        assert!(is_same(-1.9e-7, 2.0) && !is_same(-2.1e-7, 2.0));
        assert!(is_near(1.9e-3, 2.0) && !is_near(2.1e-3, 2.0));
        assert!(is_noise(7.9, 2.0) && !is_noise(8.1, 2.0));
    }

    #[test]
    fn energies_are_the_same_to_1e_7_of_their_change_and_to_rounding() {
        let change = same_energy(2.0, 0.0);
        assert!((1.9e-7..2.1e-7).contains(&change), "{change}");
        // sixteen units in the last place of the energy, 3.6e-15
        let rounding = same_energy(0.0, -2.0);
        assert!((7.0e-15..7.2e-15).contains(&rounding), "{rounding}");
    }
}
