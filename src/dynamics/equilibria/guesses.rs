//! Where the search for equilibria begins.
//!
//! In: a search, the number of a guess, or an equilibrium. Out: variables near which there may be another. Never here: the search.

use super::search::{EquilibriumSearch, LawAtRest, size_of};
use crate::dynamics::halton::halton;
use crate::system::Form;

const GUESSES: usize = 200;

/// The number of the guess at the origin.
const ORIGIN: usize = 1;

/// How far around its centre a coordinate without period is searched, in its size there plus its
/// unit.
const RADII: [f64; 5] = [0.5, 1.5, 4.0, 12.0, 40.0];

/// How many of these are searched where the units are ordinary. In other units a start says how large a coordinate is there,
/// which may be a small part of what the forces reach over.
const ORDINARY_RADII: usize = 3;

/// Of no more than this number of coordinates every choice is mirrored.
const MOST_MIRRORED: usize = 8;

/// At the image of an equilibrium in a symmetry of the law the rates are no larger than this part of what the variables can cause.
const NEARLY_ZERO: f64 = 1e-10;

/// How far beside an equilibrium others are searched for, in units: nearer than most guesses are to each other.
const BESIDE: [f64; 6] = [1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1];

impl EquilibriumSearch<'_> {
    /// How far around its centre a coordinate is searched.
    pub(super) fn radii(&self) -> &'static [f64] {
        let mut lengths = (0..self.degrees).filter(|&i| self.space.turns()[i].is_none());
        let ordinary = lengths.all(|i| self.units[i] == 1.0);
        if ordinary { &RADII[..ORDINARY_RADII] } else { &RADII }
    }

    pub(super) fn guesses(&self) -> usize {
        GUESSES * self.radii().len()
    }

    /// The variables at which a search begins: the start itself, the origin, in which many laws are symmetric, then places around the start.
    pub(super) fn guess(&self, index: usize) -> Vec<f64> {
        let mut variables = self.middle.clone();
        let canonical = self.space.form() == Form::Momentum;
        // all radii have the whole sequence of places
        let radii = self.radii();
        let (place, radius) = (index.div_ceil(radii.len()), radii[index % radii.len()]);
        for (k, &i) in self.unknowns.iter().enumerate() {
            if canonical && i >= self.degrees {
                // velocities of cyclic coordinates are those of the start
                if matches!(self.law, LawAtRest::Free(_)) {
                    let many = self.has_many_momenta && place % 2 == 1;
                    let part = if many { 2.0 * halton(place, k) - 1.0 } else { 0.0 };
                    variables[i] = part * radius * self.units[i];
                }
            } else if index == ORIGIN {
                variables[i] = 0.0;
            } else if index > 0 {
                let part = halton(place, k);
                let centre = variables[i];
                variables[i] += match self.space.turns()[i] {
                    Some(period) => (part - 0.5) * period,
                    None => (2.0 * part - 1.0) * radius * (self.units[i] + centre.abs()),
                };
            }
        }
        variables
    }

    /// The images of a place in each coordinate and momentum that rests, in all coordinates, and in all of both; and those in several
    /// coordinates at which nothing moves either.
    pub(super) fn images(&mut self, variables: &[f64]) -> Vec<Vec<f64>> {
        let moved = self.unknowns.iter().copied().filter(|&i| variables[i] != 0.0);
        let (coordinates, momenta): (Vec<usize>, Vec<usize>) =
            moved.partition(|&i| i < self.degrees);
        let image = |mirrored: &[usize]| {
            let mut image = variables.to_vec();
            for &i in mirrored {
                image[i] = -image[i];
            }
            image
        };
        let mut images: Vec<Vec<f64>> = coordinates.iter().map(|&i| image(&[i])).collect();
        images.push(image(&coordinates));
        if matches!(self.law, LawAtRest::Free(_)) && !momenta.is_empty() {
            images.extend(momenta.iter().map(|&i| image(&[i])));
            images.push(image(&[coordinates.clone(), momenta].concat()));
        }
        if (3..=MOST_MIRRORED).contains(&coordinates.len()) {
            for subset in 1_u32..(1 << coordinates.len()) - 1 {
                let within = |k: &usize| subset >> k & 1 == 1;
                let mirrored = (0..coordinates.len()).filter(within).map(|k| coordinates[k]);
                let mirrored: Vec<usize> = mirrored.collect();
                let place = image(&mirrored);
                if mirrored.len() > 1 && self.rests(&place) {
                    images.push(place);
                }
            }
        }
        images
    }

    /// Whether the rates at a place are no more than rounding of it causes.
    fn rests(&mut self, variables: &[f64]) -> bool {
        let size = size_of(&self.in_units(variables));
        let rates = self.equations_in_units(variables);
        rates.is_some_and(|(f, df)| f.amax() <= NEARLY_ZERO * size * df.amax())
    }

    /// Places close to one, along each coordinate.
    pub(super) fn beside(&self, variables: &[f64]) -> Vec<Vec<f64>> {
        let resting = self.unknowns.iter().copied().filter(|&i| i < self.degrees);
        let beside = |i: usize, distance: f64| {
            let mut place = variables.to_vec();
            place[i] += distance * (self.units[i] + variables[i].abs());
            place
        };
        let sides = |distance: f64| [distance, -distance];
        let distances: Vec<f64> = BESIDE.into_iter().flat_map(sides).collect();
        resting.flat_map(|i| distances.iter().map(move |&by| beside(i, by))).collect()
    }
}
