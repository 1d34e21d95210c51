//! The regions in which a coordinate may move, and the lobes of the separatrices between them.
//!
//! In: an energy, or a top. Out: intervals with the places at which the coordinate turns. Never here: the motion in them.

use std::convert::Infallible;

use super::{AllowedInterval, EffectivePotential};
use crate::num::bisect;

/// Where the energy is not reached so far, places are this many times as far from the start each, up to this distance.
const FARTHER: f64 = 4.0;
const FARTHEST: f64 = 1e150;

const HALVINGS: u32 = 200;

impl EffectivePotential<'_> {
    /// All regions that an energy allows, from left to right; those of a rotation have no ends. Beyond the places between which
    /// wells are [seen](super::PotentialProfile::resolved) there is only that of the start.
    pub fn regions(&mut self, energy: f64) -> Vec<AllowedInterval> {
        // on a separatrix the top itself is out of reach, on whichever side of the energy rounding has put it
        let noise = self.profile.noise(energy);
        let at_a_top = self.profile.tops.iter().any(|top| (top[1] - energy).abs() <= noise);
        let level = if at_a_top { energy - noise } else { energy };
        let mut nodes = self.profile.nodes.clone();
        if let (None, Some(&[first, ..]), Some(&[last, ..])) =
            (self.profile.period, nodes.first(), nodes.last())
        {
            let ends = [self.end_beyond(first, level), self.end_beyond(last, level)];
            nodes.splice(0..0, ends[0]);
            nodes.extend(ends[1]);
        }
        let mut regions = Vec::new();
        let mut open: Option<Option<f64>> = None;
        let mut last: Option<[f64; 2]> = None;
        // the energy of infinity is that of the places from which it cannot be distinguished, and ends no region
        let digits = 8.0 * f64::EPSILON * (energy.abs() + self.profile.height);
        let level_from = |nodes: &[[f64; 2]]| nodes.iter().all(|n| (n[1] - energy).abs() <= digits);
        for (k, &node) in nodes.iter().enumerate() {
            let allowed = node[1] < level;
            match (open, allowed) {
                (None, true) => {
                    let ends = self.profile.period.is_some() || !level_from(&nodes[..k]);
                    let before = last.filter(|_| ends);
                    open = Some(before.map(|[q, _]| self.crossing(node[0], q, energy)));
                }
                (Some(_), false) if self.profile.period.is_none() && level_from(&nodes[k..]) => {
                    break;
                }
                (Some(left), false) => {
                    let inside = last.map_or(node[0], |[q, _]| q);
                    let right = Some(self.crossing(inside, node[0], energy));
                    regions.push(AllowedInterval { left, right });
                    open = None;
                }
                _ => {}
            }
            last = Some(node);
        }
        if let Some(left) = open {
            regions.push(AllowedInterval { left, right: None });
        }
        // of a period both ends are the top, and what is open at one is open at the other
        if self.profile.period.is_some() {
            let whole =
                regions.len() == 1 && regions[0] == AllowedInterval { left: None, right: None };
            if !whole {
                regions.retain(|region| region.left.is_some() && region.right.is_some());
            }
            return regions;
        }
        let [first, last] = self.profile.resolved;
        let (begin, seen) = (self.profile.begin, |end: f64| (first..=last).contains(&end));
        regions.retain(|region| {
            let holds_start = region.left.is_none_or(|left| left <= begin)
                && region.right.is_none_or(|right| begin <= right);
            holds_start || region.left.into_iter().chain(region.right).all(seen)
        });
        regions
    }

    /// A place beyond one of the outermost, in ever larger distances from the start, with more than an energy; `None` where the
    /// energy at rest does not come to it, where it is not resolved so far away, or where a wall is.
    fn end_beyond(&mut self, outermost: f64, level: f64) -> Option<[f64; 2]> {
        let mut distance = outermost - self.profile.begin;
        let side = usize::from(distance > 0.0);
        let is_resolved =
            self.profile.resolved[side].is_infinite() && self.profile.walls[side].is_infinite();
        let mut before = self.at(outermost);
        while is_resolved && before < level && distance.abs() < FARTHEST {
            distance *= FARTHER;
            let place = self.profile.begin + distance;
            let value = self.at(place);
            // a bottom without end, or the energy of infinity
            if value <= before {
                return None;
            }
            if value > level {
                return Some([place, value]);
            }
            before = value;
        }
        None
    }

    /// The lobes of the separatrix through a top: the regions at its energy that end there.
    pub fn lobes(&mut self, top: [f64; 2]) -> Vec<AllowedInterval> {
        let [place, energy] = top;
        let noise = self.profile.noise(energy);
        let mut lobes = Vec::new();
        let nodes = self.profile.nodes.clone();
        let beside = nodes.iter().position(|node| node[0] >= place).unwrap_or(0);
        let sides: [Vec<[f64; 2]>; 2] = [
            nodes[..beside].iter().rev().copied().collect(),
            nodes[beside..].iter().filter(|node| node[0] > place).copied().collect(),
        ];
        for (side, places) in sides.iter().enumerate() {
            let mut last = place;
            let (mut inside, mut end) = (false, None);
            for &[q, value] in places {
                if value < energy - noise {
                    inside = true;
                } else if inside {
                    let same = (value - energy).abs() <= noise;
                    end = Some(if same { q } else { self.crossing(last, q, energy) });
                    break;
                }
                last = q;
            }
            if inside {
                lobes.push(match side {
                    0 => AllowedInterval { left: end, right: Some(place) },
                    _ => AllowedInterval { left: Some(place), right: end },
                });
            }
        }
        lobes
    }

    /// The place between two at which the potential is the energy; `inside` has less, `outside` has not.
    fn crossing(&mut self, inside: f64, outside: f64, energy: f64) -> f64 {
        let allowed = |place| Ok::<_, Infallible>(self.at(place) < energy);
        let Ok([inside, _]) = bisect([inside, outside], HALVINGS, allowed);
        inside
    }
}
