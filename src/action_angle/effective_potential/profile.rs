//! What is seen of an effective potential from a coordinate's start: its values at places, its tops, its walls.
//!
//! In: the places evaluated, with their energies. Out: tops and bottoms; whether an energy is that of a separatrix. Never here:
//! the potential itself.

use crate::action_angle::extremum::NOISE;

/// An interval in which a coordinate may move.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct AllowedInterval {
    /// Where it turns on the left; `None` where it does not.
    pub left: Option<f64>,
    /// Where it turns on the right.
    pub right: Option<f64>,
}

/// An effective potential as it was sampled. A place with its energy is one pair.
#[derive(Clone, Debug)]
pub struct PotentialProfile {
    /// The places evaluated, from left to right, within the walls around the start.
    pub(super) nodes: Vec<[f64; 2]>,
    /// Where the potential is greatest within a well's sides.
    pub(super) tops: Vec<[f64; 2]>,
    /// The greatest size of an energy at a bottom or a top: beyond them a potential may fall without end.
    pub(super) height: f64,
    pub(super) period: Option<f64>,
    /// Between which places its tops are given.
    pub(super) resolved: [f64; 2],
    /// The walls around the start; infinite where there is none.
    pub(super) walls: [f64; 2],
    pub(super) begin: f64,
}

impl PotentialProfile {
    /// One without any place.
    pub(super) fn unseen(begin: f64, period: Option<f64>) -> PotentialProfile {
        let everywhere = [f64::NEG_INFINITY, f64::INFINITY];
        PotentialProfile {
            nodes: Vec::new(),
            tops: Vec::new(),
            height: 0.0,
            period,
            resolved: everywhere,
            walls: everywhere,
            begin,
        }
    }

    pub(super) fn noise(&self, energy: f64) -> f64 {
        NOISE * (energy.abs() + self.height)
    }

    /// Between which places its wells and tops are given: of a coordinate without its period there may be any number of them,
    /// and those far away may be too narrow to be seen.
    pub fn resolved(&self) -> [f64; 2] {
        self.resolved
    }

    /// Whether two energies are the same to rounding.
    pub fn is_same_energy(&self, one: f64, other: f64) -> bool {
        (one - other).abs() <= self.noise(other)
    }

    /// Whether an energy is that of a separatrix that ends a region, whose motion there takes for ever.
    pub fn is_separatrix(&self, region: AllowedInterval, energy: f64) -> bool {
        let noise = self.noise(energy);
        let width = region.left.zip(region.right).map_or(f64::INFINITY, |(l, r)| r - l);
        let ends = |top: &[f64; 2]| {
            let turns = self.period.map_or(vec![0.0], |period| vec![0.0, period]);
            let near =
                |end: f64| turns.iter().any(|turn| (top[0] + turn - end).abs() < 1e-4 * width);
            (top[1] - energy).abs() <= noise
                && region.left.into_iter().chain(region.right).any(near)
        };
        self.tops.iter().any(ends)
    }

    /// The tops within the walls, from left to right; those of a period once.
    pub fn tops(&self) -> Vec<[f64; 2]> {
        let mut tops = self.tops.clone();
        tops.sort_by(|a, b| a[0].total_cmp(&b[0]));
        tops
    }

    /// The least energy of the places evaluated.
    pub fn bottom(&self) -> f64 {
        self.nodes.iter().map(|node| node[1]).fold(f64::INFINITY, f64::min)
    }

    /// The least energy of the places evaluated between two, if any lies there.
    pub fn bottom_between(&self, [from, to]: [f64; 2]) -> Option<f64> {
        let inside = self.nodes.iter().filter(|node| from <= node[0] && node[0] <= to);
        inside.map(|node| node[1]).reduce(f64::min)
    }
}
