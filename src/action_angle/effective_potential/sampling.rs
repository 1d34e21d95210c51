//! Places at which an effective potential is evaluated, and its extrema between them.
//!
//! In: where the coordinate begins, its period. Out: the profile of the potential. Never here: what an energy allows.

use std::convert::Infallible;

use super::EffectivePotential;
use crate::action_angle::extremum::{resolved, turns};
use crate::num::{golden_section, math};

/// The number of places evaluated first.
const PLACES: usize = 4001;

/// How far they reach on each side: sinh of this, in units of the distance of the start from zero (1 if it is at zero).
const REACH: f64 = 12.0;

/// A top or a bottom that is greater by this factor than what is around it is a pole.
const POLE: f64 = 1e12;

/// Golden sections for the place of an extremum.
const SECTIONS: u32 = 90;

impl EffectivePotential<'_> {
    /// Evaluates the potential around the start.
    pub(super) fn sample(&mut self) {
        let (at, period) = (self.profile.begin, self.profile.period);
        let places: Vec<f64> = match period {
            Some(period) => {
                let even = |i: usize| at + period * (i as f64 / (PLACES - 1) as f64 - 0.5);
                let places: Vec<f64> = (0..PLACES).map(even).collect();
                // the period begins at its top, so that no well is cut in two
                let values: Vec<f64> = places.iter().map(|&q| self.at(q)).collect();
                let top = (0..PLACES).max_by(|&i, &j| values[i].total_cmp(&values[j]));
                let step = period / (PLACES - 1) as f64;
                let top = places[top.unwrap_or(0)];
                let top = self.extremum(top - step, top + step, -1.0);
                let top = if top > at { top - period } else { top };
                (0..PLACES).map(|i| top + period * i as f64 / (PLACES - 1) as f64).collect()
            }
            None => {
                let unit = if at == 0.0 { 1.0 } else { at.abs() };
                let u = |i: usize| REACH * (2.0 * i as f64 / (PLACES - 1) as f64 - 1.0);
                (0..PLACES).map(|i| at + unit * math::sinh(u(i))).collect()
            }
        };
        let mut nodes: Vec<[f64; 2]> = places.into_iter().map(|q| [q, self.at(q)]).collect();
        let (mut extrema, mut walls) = (Vec::new(), Vec::new());
        let turns = turns(&nodes);
        self.profile.resolved =
            if period.is_some() { self.profile.resolved } else { resolved(&turns, at) };
        let [first, last] = self.profile.resolved;
        for [low, middle, high] in
            turns.into_iter().filter(|turn| first <= turn[0] && turn[2] <= last)
        {
            let sign = if middle > 0.0 { -1.0 } else { 1.0 };
            let place = self.extremum(low, high, sign);
            let energy = self.at(place);
            let around = self.at(low).abs().min(self.at(high).abs()) + self.at(at).abs();
            if energy.abs() > POLE * (around + f64::MIN_POSITIVE) {
                // a pole: upwards it is a wall, downwards no bottom
                if sign < 0.0 {
                    walls.push(place);
                }
                continue;
            }
            // zero to rounding
            let energy = if energy.abs() <= f64::EPSILON * around { 0.0 } else { energy };
            extrema.push([place, energy]);
            if sign < 0.0 {
                self.profile.tops.push([place, energy]);
            }
        }
        if period.is_some()
            && let Some(&top) = nodes.first()
        {
            self.profile.tops.push(top);
        }
        let turned = extrema.iter().chain(&self.profile.tops).map(|place| place[1].abs());
        self.profile.height = turned.filter(|energy| energy.is_finite()).fold(0.0, f64::max);
        nodes.extend(extrema);
        nodes.sort_by(|a, b| a[0].total_cmp(&b[0]));
        walls.extend(nodes.iter().filter(|node| node[1] == f64::INFINITY).map(|node| node[0]));
        let left = walls.iter().copied().filter(|&w| w < at).fold(f64::NEG_INFINITY, f64::max);
        let right = walls.iter().copied().filter(|&w| w > at).fold(f64::INFINITY, f64::min);
        self.profile.walls = [left, right];
        let inside = |place: f64| (left..=right).contains(&place);
        // nothing is beyond a wall
        self.profile.resolved = [
            if inside(first) { first } else { f64::NEG_INFINITY },
            if inside(last) { last } else { f64::INFINITY },
        ];
        nodes.retain(|node| inside(node[0]));
        self.profile.tops.retain(|top| inside(top[0]));
        self.profile.nodes = nodes;
    }

    /// The place of the least value of `sign` times the potential.
    fn extremum(&mut self, low: f64, high: f64, sign: f64) -> f64 {
        let value = |q| Ok::<_, Infallible>(sign * self.at(q));
        let Ok([low, high]) = golden_section([low, high], SECTIONS, value);
        f64::midpoint(low, high)
    }
}
