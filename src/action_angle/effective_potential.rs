//! One coordinate of a system that conserves its energy, with the other coordinates as they are at the start: the least
//! energy at each place, where the motion of the coordinate turns, and the tops that separate its kinds of motion.
//!
//! In: a system, a start, a coordinate. Out: regions and tops at an energy. Never here: times, actions.

mod rest;

use super::extremum::{NOISE, resolved, turns};
use crate::ensemble::{EnergyShell, NotOnShell, Root, Start};
use crate::num::math;
use crate::system::{ChannelKind, Form, InitialOverride, MotionError, Observer, System};

/// The number of places evaluated first.
const PLACES: usize = 4001;

/// How far they reach on each side: sinh of this, in units of the distance of the start from zero (1 if it is at zero).
const REACH: f64 = 12.0;

/// Where the energy is not reached so far, places are this many times as far from the start each, up to this distance.
const FARTHER: f64 = 4.0;
const FARTHEST: f64 = 1e150;

/// A top or a bottom that is greater by this factor than what is around it is a pole.
const POLE: f64 = 1e12;

/// Halvings of an interval, and sections by the golden ratio.
const HALVINGS: usize = 200;
const SECTIONS: usize = 90;

/// One coordinate as a system of its own.
pub struct EffectivePotential<'a> {
    system: &'a System,
    base: Start,
    coordinate: usize,
    observer: Observer,
    values: Vec<f64>,
    /// The places evaluated, from left to right, within the walls around the start.
    nodes: Vec<[f64; 2]>,
    /// Where the potential is greatest within a well's sides.
    tops: Vec<[f64; 2]>,
    /// The greatest size of an energy at a bottom or a top: beyond them a potential may fall without end.
    height: f64,
    period: Option<f64>,
    /// The momentum of rest at the last place, where that is not zero everywhere, as with terms odd in p.
    rest_elsewhere: Option<f64>,
    /// Between which places its tops are given.
    resolved: [f64; 2],
    /// The walls around the start; infinite where there is none.
    walls: [f64; 2],
    /// Where the coordinate begins.
    begin: f64,
    /// Where the coordinate begins, with its momentum of rest, if the energy is greatest there.
    greatest: Option<[f64; 2]>,
}

/// An interval in which a coordinate may move.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct AllowedInterval {
    /// Where it turns on the left; `None` where it does not.
    pub left: Option<f64>,
    /// Where it turns on the right.
    pub right: Option<f64>,
}

impl<'a> EffectivePotential<'a> {
    /// Surveys a coordinate.
    ///
    /// # Errors
    /// Returns an error if there is no state at the start.
    pub fn survey(
        system: &'a System,
        start: &Start,
        coordinate: usize,
    ) -> Result<EffectivePotential<'a>, MotionError> {
        let mut observer = system.observer(&start.parameters);
        let mut values = vec![0.0; system.columns()];
        observer.observe_columns(&start.state(system)?, &mut values)?;
        let mut base = start.clone();
        // the other coordinates keep their places and momenta, of which those of cyclic ones are constant
        for i in (0..system.degrees()).filter(|&i| i != coordinate) {
            let momentum = values[column(system, ChannelKind::Momentum(i))];
            base.replace(InitialOverride::Momentum(i, momentum));
        }
        let place = column(system, ChannelKind::Position(coordinate));
        let period = system.period(place, &start.parameters);
        let at = values[place];
        let (nodes, tops) = (Vec::new(), Vec::new());
        let mut potential = EffectivePotential {
            system,
            base,
            coordinate,
            observer,
            values,
            nodes,
            tops,
            height: 0.0,
            period,
            rest_elsewhere: None,
            resolved: [f64::NEG_INFINITY, f64::INFINITY],
            walls: [f64::NEG_INFINITY, f64::INFINITY],
            begin: at,
            greatest: None,
        };
        // a velocity without a value is no reason to refuse anything
        let greatest = potential.greatest_at_rest(at).ok().flatten();
        potential.greatest = greatest.map(|rest| [at, rest]);
        potential.sample_around(at);
        Ok(potential)
    }

    /// The period of the coordinate.
    pub fn period(&self) -> Option<f64> {
        self.period
    }

    /// Where the coordinate begins, and its momentum of rest there, if that has the greatest energy and not the least: then the
    /// energies at rest are no effective potential.
    pub fn greatest(&self) -> Option<[f64; 2]> {
        self.greatest
    }

    /// Between which places its wells and tops are given: of a coordinate without its period there may be any number of them,
    /// and those far away may be too narrow to be seen.
    pub fn resolved(&self) -> [f64; 2] {
        self.resolved
    }

    /// The energy with the coordinate at rest; infinite where there is none.
    pub fn at(&mut self, place: f64) -> f64 {
        let energy = match self.rest_elsewhere {
            Some(_) => self.resting(place).and_then(|momentum| {
                let mut start = self.base.clone();
                start.replace(InitialOverride::Position(self.coordinate, place));
                start.replace(InitialOverride::Momentum(self.coordinate, momentum));
                self.observed(&start, ChannelKind::Energy)
            }),
            None => {
                let start = self.at_rest(place);
                self.observed(&start, ChannelKind::Energy)
            }
        };
        energy.ok().filter(|energy| !energy.is_nan()).unwrap_or(f64::INFINITY)
    }

    /// The momentum of the coordinate, as a channel.
    pub(super) fn momentum(&self) -> ChannelKind {
        ChannelKind::Momentum(self.coordinate)
    }

    /// The velocity of the coordinate at a start.
    pub(super) fn velocity(&mut self, start: &Start) -> Result<f64, MotionError> {
        self.observed(start, ChannelKind::Velocity(self.coordinate))
    }

    pub(super) fn observed(
        &mut self,
        start: &Start,
        kind: ChannelKind,
    ) -> Result<f64, MotionError> {
        let state = start.state(self.system)?;
        self.observer.observe_columns(&state, &mut self.values)?;
        Ok(self.values[column(self.system, kind)])
    }

    /// The start that moves through a place with this energy, to the right or to the left.
    ///
    /// # Errors
    /// Returns an error if the energy forbids the place.
    pub fn moving(&mut self, place: f64, energy: f64, root: Root) -> Result<Start, NotOnShell> {
        let about = self.resting(place)?;
        self.moving_about(about, place, energy, root)
    }

    fn moving_about(
        &mut self,
        about: f64,
        place: f64,
        energy: f64,
        root: Root,
    ) -> Result<Start, NotOnShell> {
        let mut start = self.base.clone();
        start.replace(InitialOverride::Position(self.coordinate, place));
        let by = match self.system.form() {
            Form::Momentum => InitialOverride::Momentum(self.coordinate, 0.0),
            Form::Velocity | Form::Variables => InitialOverride::Velocity(self.coordinate, 0.0),
        };
        EnergyShell { energy, by, root, about }.complete_by(
            self.system,
            &mut self.observer,
            &mut start,
        )?;
        Ok(start)
    }

    /// |q̇| through a place with this energy.
    pub(super) fn speed(&mut self, place: f64, energy: f64, root: Root) -> Result<f64, NotOnShell> {
        let start = self.moving(place, energy, root)?;
        Ok(self.observed(&start, ChannelKind::Velocity(self.coordinate))?.abs())
    }

    /// p to the right less p to the left at a place, zero where the energy forbids it by rounding.
    pub(super) fn width(&mut self, place: f64, energy: f64) -> Result<f64, NotOnShell> {
        let right = self.momentum_at(place, energy, Root::Positive)?;
        let left = self.momentum_at(place, energy, Root::Negative)?;
        Ok(right.zip(left).map_or(0.0, |(right, left)| right - left))
    }

    /// p to the right or to the left at a place, `None` where the energy forbids it by rounding.
    pub(super) fn momentum_at(
        &mut self,
        place: f64,
        energy: f64,
        root: Root,
    ) -> Result<Option<f64>, NotOnShell> {
        match self.moving(place, energy, root) {
            Ok(start) => Ok(Some(self.observed(&start, ChannelKind::Momentum(self.coordinate))?)),
            Err(NotOnShell::Forbidden { .. } | NotOnShell::NotFound { .. }) => Ok(None),
            Err(why) => Err(why),
        }
    }

    fn sample_around(&mut self, at: f64) {
        let places: Vec<f64> = match self.period {
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
        self.resolved = if self.period.is_some() { self.resolved } else { resolved(&turns, at) };
        let [first, last] = self.resolved;
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
                self.tops.push([place, energy]);
            }
        }
        if self.period.is_some()
            && let Some(&top) = nodes.first()
        {
            self.tops.push(top);
        }
        let turned = extrema.iter().chain(&self.tops).map(|place| place[1].abs());
        self.height = turned.filter(|energy| energy.is_finite()).fold(0.0, f64::max);
        nodes.extend(extrema);
        nodes.sort_by(|a, b| a[0].total_cmp(&b[0]));
        walls.extend(nodes.iter().filter(|node| node[1] == f64::INFINITY).map(|node| node[0]));
        let left = walls.iter().copied().filter(|&w| w < at).fold(f64::NEG_INFINITY, f64::max);
        let right = walls.iter().copied().filter(|&w| w > at).fold(f64::INFINITY, f64::min);
        self.walls = [left, right];
        let inside = |place: f64| (left..=right).contains(&place);
        // nothing is beyond a wall
        self.resolved = [
            if inside(self.resolved[0]) { self.resolved[0] } else { f64::NEG_INFINITY },
            if inside(self.resolved[1]) { self.resolved[1] } else { f64::INFINITY },
        ];
        nodes.retain(|node| inside(node[0]));
        self.tops.retain(|top| inside(top[0]));
        self.nodes = nodes;
    }

    /// The place of the least value of `sign` times the potential, by the golden ratio.
    fn extremum(&mut self, mut low: f64, mut high: f64, sign: f64) -> f64 {
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        let (mut a, mut b) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
        let (mut at_a, mut at_b) = (sign * self.at(a), sign * self.at(b));
        for _ in 0..SECTIONS {
            if at_a < at_b {
                (high, b, at_b) = (b, a, at_a);
                a = high - GOLDEN * (high - low);
                at_a = sign * self.at(a);
            } else {
                (low, a, at_a) = (a, b, at_b);
                b = low + GOLDEN * (high - low);
                at_b = sign * self.at(b);
            }
        }
        f64::midpoint(low, high)
    }

    /// All regions that an energy allows, from left to right; those of a rotation have no ends. Beyond the places between which
    /// wells are [seen](Self::resolved) there is only that of the start.
    pub fn regions(&mut self, energy: f64) -> Vec<AllowedInterval> {
        // on a separatrix the top itself is out of reach, on whichever side of the energy rounding has put it
        let noise = NOISE * (energy.abs() + self.height);
        let at_a_top = self.tops.iter().any(|top| (top[1] - energy).abs() <= noise);
        let level = if at_a_top { energy - noise } else { energy };
        let mut nodes = self.nodes.clone();
        if let (None, Some(&[first, ..]), Some(&[last, ..])) =
            (self.period, nodes.first(), nodes.last())
        {
            let ends = [self.end_beyond(first, level), self.end_beyond(last, level)];
            nodes.splice(0..0, ends[0]);
            nodes.extend(ends[1]);
        }
        let mut regions = Vec::new();
        let mut open: Option<Option<f64>> = None;
        let mut last: Option<[f64; 2]> = None;
        // the energy of infinity is that of the places from which it cannot be distinguished, and ends no region
        let digits = 8.0 * f64::EPSILON * (energy.abs() + self.height);
        let level_from = |nodes: &[[f64; 2]]| nodes.iter().all(|n| (n[1] - energy).abs() <= digits);
        for (k, &node) in nodes.iter().enumerate() {
            let allowed = node[1] < level;
            match (open, allowed) {
                (None, true) => {
                    let ends = self.period.is_some() || !level_from(&nodes[..k]);
                    let before = last.filter(|_| ends);
                    open = Some(before.map(|[q, _]| self.crossing(node[0], q, energy)));
                }
                (Some(_), false) if self.period.is_none() && level_from(&nodes[k..]) => break,
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
        if self.period.is_some() {
            let whole =
                regions.len() == 1 && regions[0] == AllowedInterval { left: None, right: None };
            if !whole {
                regions.retain(|region| region.left.is_some() && region.right.is_some());
            }
            return regions;
        }
        let [first, last] = self.resolved;
        let (begin, seen) = (self.begin, |end: f64| (first..=last).contains(&end));
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
        let mut distance = outermost - self.begin;
        let side = usize::from(distance > 0.0);
        let is_resolved = self.resolved[side].is_infinite() && self.walls[side].is_infinite();
        let mut before = self.at(outermost);
        while is_resolved && before < level && distance.abs() < FARTHEST {
            distance *= FARTHER;
            let place = self.begin + distance;
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
        let noise = NOISE * (energy.abs() + self.height);
        let mut lobes = Vec::new();
        let nodes = self.nodes.clone();
        let beside = nodes.iter().position(|node| node[0] >= place).unwrap_or(0);
        let walks: [Vec<[f64; 2]>; 2] = [
            nodes[..beside].iter().rev().copied().collect(),
            nodes[beside..].iter().filter(|node| node[0] > place).copied().collect(),
        ];
        for (side, walk) in walks.iter().enumerate() {
            let mut last = place;
            let (mut inside, mut end) = (false, None);
            for &[q, value] in walk {
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

    /// Whether two energies are the same to rounding.
    pub fn is_same_energy(&self, one: f64, other: f64) -> bool {
        (one - other).abs() <= NOISE * (other.abs() + self.height)
    }

    /// Whether an energy is that of a separatrix that ends a region, whose motion there takes for ever.
    pub fn is_separatrix(&self, region: AllowedInterval, energy: f64) -> bool {
        let noise = NOISE * (energy.abs() + self.height);
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

    /// The place between two at which the potential is the energy; `inside` has less, `outside` has not.
    fn crossing(&mut self, mut inside: f64, mut outside: f64, energy: f64) -> f64 {
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(inside, outside);
            if middle == inside || middle == outside {
                break;
            }
            if self.at(middle) < energy { inside = middle } else { outside = middle }
        }
        inside
    }
}

/// The column of a channel.
fn column(system: &System, kind: ChannelKind) -> usize {
    system.channels().iter().position(|channel| channel.kind == kind).unwrap_or(0)
}
