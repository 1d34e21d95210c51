//! What the job of the action plot has found: the curve J(E), and where the motion is on it.
//!
//! In: a motion of one coordinate, frozen at an instant. Out: lines through (E, J), and what has changed since. Never here: how it
//! is drawn.

use super::action_at_time::ActionAtTime;
use crate::action_angle::{FrozenMotion, OwnMotion, RegionKind, Separatrix};
use crate::instrument::motion_state::{CoordinateState, FrozenCourse};
use crate::num::math;

/// The energies of the curve, and how many more stand on each side of a separatrix, ever closer to it.
const ENERGIES: usize = 40;
const BESIDE: u32 = 5;

/// The part of the range above the motion and the separatrices.
const ABOVE: f64 = 0.4;

/// Beyond this energy, relative to the motion's, a top is out of the picture.
const FAR: f64 = 20.0;

/// A change of the energy by more than this part of its height is no swing within the steps of a method: the motion is
/// another one.
const ANOTHER_ENERGY: f64 = 0.02;

/// The part of the time since the start, and of the period, after which a moving law is evaluated again.
const LATER: f64 = 0.01;
const OF_A_PERIOD: f64 = 0.25;

pub(super) struct ComputedActions {
    pub(super) course: FrozenCourse<ActionAtTime>,
    pub(super) found: Result<Found, String>,
    /// The instants at which another law took the place of the one before, as a ramp by a key does.
    pub(super) replaced: Vec<ActionAtTime>,
}

/// The curve and the motion.
pub(super) struct Found {
    /// Lines through (E, J), one for each kind of motion.
    pub(super) curves: Vec<Vec<[f64; 2]>>,
    pub(super) separatrices: Vec<Separatrix>,
    pub(super) own: OwnMotion,
    /// Its energy above the least one of the coordinate where it moves.
    pub(super) height: f64,
}

impl ComputedActions {
    pub(super) fn holds_at(&self, now: &CoordinateState) -> bool {
        let FrozenCourse { state, .. } = &self.course;
        if !self.course.is_of_this_law() {
            return false;
        }
        if !self.course.moves() {
            // an impulse or friction changes it
            let height = self.found.as_ref().map_or(f64::INFINITY, |found| found.height);
            return now.has_energy_of(state, (ANOTHER_ENERGY, height));
        }
        state.time <= now.time && !self.is_behind(now.time)
    }

    /// Whether the motion has come so much further that it has to be computed again.
    pub(super) fn is_behind(&self, time: f64) -> bool {
        let FrozenCourse { state, past, .. } = &self.course;
        let period = self.found.as_ref().ok().and_then(|found| found.own.row.as_ref().ok());
        let period = period.map(|row| row.period).filter(|period| period.is_finite());
        let since = past.first().map_or(0.0, |first| (time - first.time).abs());
        let later = (LATER * since).max(OF_A_PERIOD * period.unwrap_or(0.0));
        time - state.time > later
    }

    /// By which part the action, and the height of the energy, have changed since the first instant.
    pub(super) fn changes(&self) -> Option<[f64; 2]> {
        self.changes_since(self.course.past.first()?)
    }

    /// By which part they have changed since an instant; of nothing there is no part.
    pub(super) fn changes_since(&self, first: &ActionAtTime) -> Option<[f64; 2]> {
        self.course.past.last()?.changes_since(first)
    }
}

impl Found {
    pub(super) fn of(motion: &mut FrozenMotion<'_>) -> Result<Found, String> {
        let own = motion.own().map_err(|why| why.to_string())?;
        let separatrices = motion.separatrices().map_err(|why| why.to_string())?;
        let bottom = motion.bottom(&own);
        let reach = (own.energy - bottom).max(f64::MIN_POSITIVE);
        let separatrices: Vec<Separatrix> = separatrices
            .into_iter()
            .filter(|s| s.energy.is_finite() && s.energy > bottom)
            .filter(|s| bottom.is_infinite() || s.energy - bottom < FAR * reach)
            .collect();
        let tops: Vec<f64> = separatrices.iter().map(|s| s.energy).collect();
        let highest = tops.iter().copied().fold(own.energy, f64::max);
        let from = if bottom.is_finite() { bottom } else { own.energy - own.energy.abs().max(1.0) };
        let span = if highest > from { highest - from } else { from.abs().max(1.0) };
        let to = highest + ABOVE * span;
        let mut energies: Vec<f64> =
            (1..=ENERGIES).map(|i| from + (to - from) * i as f64 / ENERGIES as f64).collect();
        for &top in &tops {
            let step = |k: u32| span * math::exp(-1.6 * f64::from(k + 1));
            energies.extend((1..=BESIDE).flat_map(|k| [top - step(k), top + step(k)]));
        }
        energies.retain(|energy| *energy > from && !tops.contains(energy));
        energies.sort_by(f64::total_cmp);
        let mut curves: Vec<Vec<[f64; 2]>> = Vec::new();
        let mut open: Vec<(RegionKind, usize)> = Vec::new();
        let mut before = from;
        for energy in energies {
            // an energy at which a motion is lost has no point
            let Ok(rows) = motion.rows(energy) else { continue };
            let kinds: Vec<RegionKind> = rows.iter().map(|row| row.kind).collect();
            let crossed = tops.iter().any(|top| before < *top && *top < energy);
            let same = open.iter().map(|(kind, _)| *kind).eq(kinds.iter().copied());
            if crossed || !same {
                let begin = curves.len();
                open = kinds.iter().enumerate().map(|(i, &kind)| (kind, begin + i)).collect();
                curves.extend(kinds.iter().map(|_| Vec::new()));
            }
            for ((_, curve), row) in open.iter().zip(&rows) {
                curves[*curve].push([energy, row.action]);
            }
            before = energy;
        }
        Ok(Found { curves, separatrices, height: own.energy - bottom, own })
    }

    /// The motion at a time, if it returns.
    pub(super) fn moment(&self, time: f64) -> Option<ActionAtTime> {
        let row = self.own.row.as_ref().ok().filter(|row| row.kind != RegionKind::Unbounded)?;
        Some(ActionAtTime {
            time,
            energy: self.own.energy,
            height: self.height,
            action: row.action,
        })
    }
}
