//! The extrema of a sampled potential, and how far from the start they are distinguished.
//!
//! In: places with their energies. Out: places beside an extremum with its kind. Never here: the potential itself.

/// Energies that differ by less than this part are the same to rounding.
pub(super) const NOISE: f64 = 1e-11;

/// So many bottoms and tops in succession without a place between them are an oscillation that is too fast for the places.
const UNRESOLVED: usize = 8;

/// The most tops on one side of the start that are given.
const MOST_TOPS: usize = 8;

/// The places around `at` beyond which extrema follow each other from one sample to the next, or there are too many tops.
pub(super) fn resolved(turns: &[[f64; 3]], at: f64) -> [f64; 2] {
    // two extrema have a sample between them where the second begins behind the first
    let is_fast = |pairs: &[[f64; 3]]| pairs.windows(2).all(|two| two[1][0] < two[0][2]);
    let mut limits = [f64::NEG_INFINITY, f64::INFINITY];
    for fast in turns.windows(UNRESOLVED).filter(|some| is_fast(some)) {
        let [first, last] = [fast[0], fast[UNRESOLVED - 1]];
        if first[0] >= at {
            limits[1] = limits[1].min(first[0]);
        } else if last[2] <= at {
            limits[0] = limits[0].max(last[2]);
        }
    }
    let tops = |side: &dyn Fn(&[f64; 3]) -> bool| {
        turns.iter().filter(|turn| turn[1] > 0.0 && side(turn)).copied().collect::<Vec<_>>()
    };
    if let Some(beyond) = tops(&|turn| turn[0] >= at).get(MOST_TOPS) {
        limits[1] = limits[1].min(beyond[0]);
    }
    if let Some(beyond) = tops(&|turn| turn[2] <= at).iter().rev().nth(MOST_TOPS) {
        limits[0] = limits[0].max(beyond[2]);
    }
    limits
}

/// The extrema of a sampled function beyond rounding: the places on both sides, with +1 for a maximum, −1 for a minimum.
pub(super) fn turns(nodes: &[[f64; 2]]) -> Vec<[f64; 3]> {
    // values that are the same to rounding are one node, from the first of them to the last
    let mut runs: Vec<[f64; 3]> = Vec::new();
    for &[place, value] in nodes.iter().filter(|node| node[1].is_finite()) {
        match runs.last_mut() {
            Some([_, last, level]) if (value - *level).abs() <= NOISE * level.abs() => {
                *last = place;
            }
            _ => runs.push([place, place, value]),
        }
    }
    let turn = |three: &[[f64; 3]]| {
        let [before, here, after] = [three[0][2], three[1][2], three[2][2]];
        let kind = if here > before && here > after {
            1.0
        } else if here < before && here < after {
            -1.0
        } else {
            return None;
        };
        Some([three[0][1], kind, three[2][0]])
    };
    runs.windows(3).filter_map(turn).collect()
}

#[cfg(test)]
mod tests {
    use super::turns;

    /// A hill of this height on a plain of this level.
    fn tops(level: f64, height: f64) -> usize {
        turns(&[[0.0, level], [1.0, level * (1.0 + height)], [2.0, level]]).len()
    }

    #[test]
    fn a_top_rises_by_more_than_a_hundred_billionth() {
        for level in [1e-200, 1.0, -3.0, 1e200] {
            assert_eq!(tops(level, 2e-11), 1, "{level}");
            assert_eq!(tops(level, 0.5e-11), 0, "{level}");
        }
    }
}
