//! Where lines lie so close together that the time does not tell them apart: one is fitted for them, and what that leaves hides
//! fainter lines around it, but not far from it.
//!
//! In: frequencies at which more is left than fits. Out: which frequencies of a transform are free of it. Never here: fits.

use std::f64::consts::{PI, TAU};

/// The window's own transform reaches so many turns in the whole time to either side.
const LOBE: f64 = 3.0;

/// A wave that changes in the time has skirts that are larger by this factor than those of a line.
const SKIRTS: f64 = 100.0;

/// The places of lines that are not resolved.
#[derive(Debug, Default)]
pub(super) struct UnresolvedLines {
    /// The frequency of what is left there, and its amplitude.
    places: Vec<[f64; 2]>,
}

impl UnresolvedLines {
    pub(super) fn add(&mut self, frequency: f64, amplitude: f64) {
        self.places.push([frequency, amplitude]);
    }

    /// The frequency where most is left.
    pub(super) fn strongest(&self) -> Option<f64> {
        let strongest = self.places.iter().max_by(|a, b| a[1].total_cmp(&b[1]));
        strongest.map(|place| place[0])
    }

    /// A transform, over a time of this length, without what may belong to them.
    pub(super) fn masked(&self, transform: &[[f64; 2]], length: f64) -> Vec<[f64; 2]> {
        let is_hidden = |[frequency, amplitude]: [f64; 2]| {
            self.places
                .iter()
                .any(|[at, left]| amplitude <= left * reach((frequency - at).abs() * length / TAU))
        };
        let free = |&point: &[f64; 2]| if is_hidden(point) { [point[0], 0.0] } else { point };
        transform.iter().map(free).collect()
    }
}

/// The greatest part of an amplitude that is seen so many turns from it, under the square of Hann's window, whose transform is
/// 4 sin πd/(πd (d² − 1)(d² − 4)).
fn reach(turns: f64) -> f64 {
    if turns <= LOBE {
        return f64::INFINITY;
    }
    let square = turns * turns;
    SKIRTS * 4.0 / (PI * turns * (square - 1.0) * (square - 4.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_far_or_strong_is_not_hidden() {
        let mut unresolved = UnresolvedLines::default();
        unresolved.add(1.0, 0.1);
        let transform = [[1.01, 0.5], [1.0 + 5e-2, 4e-3], [1.0 + 5e-2, 6e-3], [1.5, 1e-7]];
        let masked = unresolved.masked(&transform, 100.0 * TAU);
        let left: Vec<f64> = masked.iter().map(|point| point[1]).collect();
        assert_eq!(left, [0.0, 0.0, 6e-3, 1e-7]);
    }
}
