//! Whether what a search for an equilibrium ends at is one, and which of its images is meant.
//!
//! In: the variables at which the search ended. Out: those of the equilibrium, if it is one in reach. Never here: the search.

use nalgebra::DVector;

use super::search::{EquilibriumSearch, LawAtRest, ZERO, resting_rates, size_of};
use crate::system::Form;

/// A search ends where it began if it moves by no more than this part of the size of the place.
const BEGAN_HERE: f64 = 1e-6;

/// Half a turn itself is not taken for its opposite by rounding.
const HALF_A_TURN: f64 = 0.5 + 1e-9;

/// Next to a zero of the rates they grow over this distance, in the size of the place; next to a pole they fall.
const BEYOND_ROUNDING: f64 = 1e-12;

/// A mass matrix that is singular next to a place is this many times further from it this far beside it, in the size of the place.
const SINGULAR: f64 = 1e-4;
const FALLS_AWAY: f64 = 100.0;

/// Where a rate and its derivative vanish for want of smaller numbers, a place is known to this part of its size.
const NO_DIGITS: f64 = 1e-3;

impl EquilibriumSearch<'_> {
    /// Whether the rates fall away from a place in the direction in which they change most, as they do next to a pole, where they are
    /// as small a part of their derivative as at a zero.
    fn is_pole(&mut self, variables: &[f64]) -> bool {
        let Some((f, df)) = self.equations_in_units(variables) else { return true };
        let size = size_of(&self.in_units(variables));
        let steepest = (0..df.ncols())
            .max_by(|&a, &b| df.column(a).amax().total_cmp(&df.column(b).amax()))
            .unwrap_or(0);
        let beside = [1.0, -1.0].map(|side| {
            let mut there = variables.to_vec();
            let i = self.unknowns[steepest];
            there[i] += side * BEYOND_ROUNDING * size * self.units[i];
            self.equations_in_units(&there).map_or(f64::INFINITY, |(g, _)| g.amax())
        });
        beside.into_iter().all(|g| g < f.amax())
    }

    /// Whether the mass matrix is singular next to a place: velocities per momentum of what rests fall away from it all around.
    fn has_singular_mass(&mut self, variables: &[f64]) -> bool {
        let place = self.in_units(variables);
        let half = self.unknowns.len() / 2;
        if self.space.form() != Form::Momentum || matches!(self.law, LawAtRest::Constrained(_)) {
            return false;
        }
        let mut mobility = |moved: f64| {
            let (_, df) = self.evaluate(&place.add_scalar(moved * size_of(&place)))?;
            Some(df.view((0, half), (half, half)).amax())
        };
        let here = mobility(0.0);
        [SINGULAR, -SINGULAR].into_iter().all(|moved| {
            here.zip(mobility(moved)).is_some_and(|(here, there)| falls_away(here, there))
        })
    }

    /// The same place without the digits of coordinates on which no force depends there but for underflow, as near the zero of V = x⁶⁰.
    fn without_lost_digits(&mut self, place: DVector<f64>) -> DVector<f64> {
        let Some((f, df)) = self.evaluate(&place) else { return place };
        if df.row_iter().all(|row| row.amax() > 0.0) {
            return place;
        }
        let round = without_small(&place);
        let is_zero = self.evaluate(&round).is_some_and(|(g, _)| g.amax() <= f.amax());
        if is_zero { round } else { place }
    }

    /// Takes the place nearest to the start among its periods, with angles within half a turn of zero. Returns whether it is in reach.
    pub(super) fn within_periods(&self, variables: &mut [f64]) -> bool {
        let start = &self.middle;
        let mut in_reach = true;
        for &i in &self.unknowns {
            if let Some(period) = self.space.turns()[i] {
                let turns = ((variables[i] - start[i]) / period).round();
                variables[i] -= turns * period;
            }
            let far = self.radii()[self.radii().len() - 1] * (self.units[i] + start[i].abs());
            if i < self.degrees && (variables[i] - start[i]).abs() > far {
                in_reach = false;
            }
            if let Some(period) = self.space.periods()[i] {
                variables[i] -= period * (variables[i] / period - HALF_A_TURN).ceil();
            }
            // a zero but for rounding
            if variables[i].abs() < 1e-14 * self.units[i] {
                variables[i] = 0.0;
            }
        }
        in_reach
    }

    /// The variables nearest to the start among their periods, if they are in reach; angles within half a turn of zero,
    /// however often the motion has gone round. What the search began at is in reach: the image of a place that is.
    pub(super) fn accepted(&mut self, variables: &[f64], first: &[f64]) -> Option<Vec<f64>> {
        let moved = self.in_units(variables) - self.in_units(first);
        let began_here = begins_there(moved.amax(), size_of(&self.in_units(first)));
        let place = self.approached(&self.in_units(variables), &[])?;
        let place = self.without_lost_digits(place);
        let mut variables = self.unscaled(&place);
        if self.is_pole(&variables) || self.has_singular_mass(&variables) {
            return None;
        }
        if !self.within_periods(&mut variables) && !began_here {
            return None;
        }
        match &mut self.law {
            LawAtRest::Constrained(_) => Some(variables),
            LawAtRest::Free(field) => {
                // a force on a cyclic coordinate, as friction, lets nothing rest
                resting_rates(field, (self.start.time, &variables), &self.unknowns)?;
                let (rate, derivative, units) = (field.rate(), field.derivative(), &self.units);
                let part = |i: usize, j: usize| derivative[(i, j)].abs() * units[j] / units[i];
                let all = 0..units.len();
                let caused = all.clone().flat_map(|i| all.clone().map(move |j| (i, j)));
                let caused = caused.map(|(i, j)| part(i, j)).fold(0.0, f64::max);
                let of = |i: usize| rate[i].abs() / units[i];
                let size = all.map(of).fold(caused, f64::max);
                let pushed = |i: &usize| of(self.degrees + i) > 1e3 * ZERO * size;
                (!self.cyclic.iter().any(pushed)).then_some(variables)
            }
        }
    }
}

fn without_small(place: &DVector<f64>) -> DVector<f64> {
    let within = NO_DIGITS * size_of(place);
    place.map(|x| if x.abs() <= within { 0.0 } else { x })
}

/// Whether a search that has moved so far ends where it began.
fn begins_there(moved: f64, size: f64) -> bool {
    moved <= BEGAN_HERE * size
}

/// Whether velocities per momentum next to a singular place are as much larger there.
fn falls_away(here: f64, beside: f64) -> bool {
    here > FALLS_AWAY * beside
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thresholds_of_acceptance_are_parts_of_what_they_are_compared_with() {
        assert!(begins_there(1.9e-6, 2.0) && !begins_there(2.1e-6, 2.0));
        assert!(falls_away(201.0, 2.0) && !falls_away(199.0, 2.0));
    }

    #[test]
    fn what_is_small_in_a_place_is_a_thousandth_of_its_size() {
        let place = DVector::from_vec(vec![-4.0, 3.9e-3, 4.1e-3]);
        assert_eq!(without_small(&place), DVector::from_vec(vec![-4.0, 0.0, 4.1e-3]));
        // of its units at least
        let place = DVector::from_vec(vec![0.9e-3, -1.1e-3]);
        assert_eq!(without_small(&place), DVector::from_vec(vec![0.0, -1.1e-3]));
    }
}
