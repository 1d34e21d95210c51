//! The greatest drift of a quantity over all looks, each distance held against how much moved at that time.
//!
//! A comet's energy is off by a part of the great terms that meet at its perihelion; it is lost where it is off by a part
//! of what moves *then*, or on the mean. What moves on the mean is known at the end only, so the greatest distance is kept
//! for each octave of what moved.

/// The most octaves that are kept.
const OCTAVES: usize = 64;

/// Distances by what moved.
#[derive(Clone, Debug, Default)]
pub(super) struct Excursions {
    octaves: Vec<Octave>,
}

#[derive(Clone, Copy, Debug)]
struct Octave {
    exponent: u64,
    moving: f64,
    distance: f64,
}

impl Excursions {
    /// Takes note of a distance while so much moved; both are sizes.
    pub(super) fn note(&mut self, distance: f64, moving: f64) {
        let moving = if moving.is_nan() { 0.0 } else { moving };
        let exponent = moving.to_bits() >> 52;
        let new = Octave { exponent, moving, distance };
        match self.octaves.iter_mut().find(|octave| octave.exponent == exponent) {
            // the quotients compared without dividing by zero
            Some(octave) if distance * octave.moving < octave.distance * moving => {}
            Some(octave) if moving == 0.0 && distance <= octave.distance => {}
            Some(octave) => *octave = new,
            None => {
                self.octaves.push(new);
                if self.octaves.len() > OCTAVES {
                    let least = |a: &usize, b: &usize| {
                        self.octaves[*a].distance.total_cmp(&self.octaves[*b].distance)
                    };
                    if let Some(least) = (0..self.octaves.len()).min_by(least) {
                        self.octaves.swap_remove(least);
                    }
                }
            }
        }
    }

    /// The greatest drift, where so much moves on the mean.
    pub(super) fn drift(&self, mean: f64) -> f64 {
        let drift = |octave: &Octave| octave.distance / octave.moving.max(mean);
        self.octaves.iter().map(drift).filter(|drift| !drift.is_nan()).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_distance_is_held_against_what_moved_then_or_moves_on_the_mean() {
        let mut excursions = Excursions::default();
        assert_eq!(excursions.drift(1.0), 0.0);
        excursions.note(5.0, 1000.0);
        assert_eq!(excursions.drift(1.0), 0.005);
        excursions.note(0.5, 1.0);
        assert_eq!(excursions.drift(1.0), 0.5);
        assert_eq!(excursions.drift(100.0), 0.005);
        excursions.note(0.25, 0.0);
        assert_eq!(excursions.drift(2.0), 0.25);
        assert_eq!(excursions.drift(0.0), f64::INFINITY);
    }

    #[test]
    fn within_an_octave_the_greatest_quotient_stays() {
        let mut excursions = Excursions::default();
        for (distance, moving) in [(1.0, 8.0), (1.5, 15.0), (0.9, 9.0), (1.1, 8.5)] {
            excursions.note(distance, moving);
        }
        assert_eq!(excursions.drift(0.0), 1.1 / 8.5);
    }

    #[test]
    fn its_memory_is_bounded_and_keeps_the_greatest() {
        let mut excursions = Excursions::default();
        for k in 0..2000 {
            excursions.note(f64::from(k + 1), (f64::from(k) - 1000.0).exp2());
        }
        assert_eq!(excursions.octaves.len(), OCTAVES);
        assert_eq!(excursions.drift(1e300), 1997.0 / 1e300);
    }
}
