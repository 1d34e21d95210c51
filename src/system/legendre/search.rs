//! The search for solutions of the Legendre transformation: from a guess, along a branch, or all that there are.
//!
//! In: a state, the momenta or velocities that it shall have. Out: the states that have them. Never here: one iteration.

use super::{HALVINGS, Legendre, LegendreError};
use crate::num::{DoubleDouble, math};

/// If the first step leaves at most this part of the residual, it leads to the solution nearest to
/// the guess: the relation is nearly linear between them.
const TAME: f64 = 0.25;

/// A single solution is searched for between this power of two and its inverse.
const FARTHEST: i32 = 64;

/// The numbers of parts into which the path to a solution is divided if it is too long for one
/// step.
const PARTS: [u32; 3] = [4, 16, 64];

/// Two solutions whose numbers differ by less than this part of their size are equal.
const ALIKE: f64 = 1e-8;

/// Momenta that differ by more than this part are others: those of a second solution.
const OTHER: f64 = 0.5;

/// Momenta that differ by more than this part are those of no first solution, where the velocity has too few digits
/// for them.
const ROUGH: f64 = 1e-6;

/// The starting points of the search for other solutions: the first one with one of its numbers
/// multiplied by these factors.
const ELSEWHERE: [f64; 10] = [-1.0, 0.5, -0.5, 2.0, -2.0, 0.1, -0.1, 10.0, -10.0, 0.0];

impl Legendre {
    /// Changes the native rates of `state`, at the indices where `targets` has a value, until the
    /// other rates there have that value. The values in `state` are the first guess; if that does
    /// not lead to a solution, zero rates are tried.
    pub(in crate::system) fn solve(
        &mut self,
        time: DoubleDouble,
        state: &mut [DoubleDouble],
        targets: &[Option<DoubleDouble>],
    ) -> Result<(), LegendreError> {
        let n = self.degrees;
        let unknown: Vec<usize> = (0..n).filter(|&i| targets[i].is_some()).collect();
        self.state.copy_from_slice(&state[..2 * n]);
        let mut found = self.iterate(time, targets, &unknown);
        if found.is_err() && !self.near_only {
            self.state.copy_from_slice(&state[..2 * n]);
            for &i in &unknown {
                self.state[n + i] = DoubleDouble::ZERO;
            }
            found = self.iterate(time, targets, &unknown);
        }
        if let (Err(LegendreError::NotConverging | LegendreError::Singular), [only], false) =
            (&found, &unknown[..], self.near_only)
        {
            // what is wrong at the guess explains more than a search that found nothing
            found = self.between_signs(time, state, targets, *only).or(found);
        }
        found?;
        state[n..2 * n].copy_from_slice(&self.state[n..]);
        Ok(())
    }

    /// The solution nearest to the guess for a single unknown, at a change of sign of the residual.
    /// The search covers both sides of zero and of the guess, far and near.
    fn between_signs(
        &mut self,
        time: DoubleDouble,
        state: &[DoubleDouble],
        targets: &[Option<DoubleDouble>],
        i: usize,
    ) -> Result<f64, LegendreError> {
        let n = self.degrees;
        let guess = state[n + i].high;
        let far = (-FARTHEST..=FARTHEST).map(|k| math::powi(2.0, k));
        let mut places: Vec<f64> =
            far.flat_map(|x| [x, -x, guess + x, guess - x]).chain([0.0, guess]).collect();
        places.sort_by(f64::total_cmp);
        places.dedup();
        self.state.copy_from_slice(&state[..2 * n]);
        let missed = |own: &mut Legendre, x: f64| {
            own.state[n + i] = DoubleDouble::from(x);
            let mut out = [DoubleDouble::ZERO];
            own.missing(time, targets, &[i], &mut [0.0], &mut out).ok()?;
            Some(out[0].high).filter(|x| !x.is_nan())
        };
        let values: Vec<Option<f64>> = places.iter().map(|&x| missed(self, x)).collect();
        let mut pairs: Vec<[f64; 2]> = Vec::new();
        for (place, value) in places.windows(2).zip(values.windows(2)) {
            if let [Some(a), Some(b)] = value
                && (*a < 0.0) != (*b < 0.0)
            {
                pairs.push([place[0], place[1]]);
            }
        }
        let distance = |pair: &[f64; 2]| (0.5 * (pair[0] + pair[1]) - guess).abs();
        pairs.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
        for [mut a, mut b] in pairs {
            let Some(below) = missed(self, a).map(|x| x < 0.0) else { continue };
            for _ in 0..HALVINGS {
                let middle = 0.5 * (a + b);
                match missed(self, middle) {
                    Some(x) if (x < 0.0) == below => a = middle,
                    Some(_) => b = middle,
                    None => break,
                }
            }
            self.state[n + i] = DoubleDouble::from(0.5 * (a + b));
            // the sign also changes at a pole
            if let Ok(left) = self.iterate(time, targets, &[i]) {
                return Ok(left);
            }
        }
        Err(LegendreError::NotConverging)
    }

    /// The same, but along the branch of solutions on which the first guess lies, which must belong
    /// to momenta nearby. If the branch ends, there is no solution.
    pub(in crate::system) fn follow(
        &mut self,
        time: DoubleDouble,
        state: &mut [DoubleDouble],
        targets: &[Option<DoubleDouble>],
    ) -> Result<(), LegendreError> {
        let n = self.degrees;
        let unknown: Vec<usize> = (0..n).filter(|&i| targets[i].is_some()).collect();
        self.state.copy_from_slice(&state[..2 * n]);
        let direct = self.iterate(time, targets, &unknown);
        if !direct.as_ref().is_ok_and(|&left| left <= TAME) {
            self.go_in_parts(time, state, targets, &unknown)?;
        }
        state[n..2 * n].copy_from_slice(&self.state[n..]);
        Ok(())
    }

    /// Goes from the momenta of the guess to the target in ever smaller parts.
    fn go_in_parts(
        &mut self,
        time: DoubleDouble,
        guess: &[DoubleDouble],
        targets: &[Option<DoubleDouble>],
        unknown: &[usize],
    ) -> Result<(), LegendreError> {
        let n = self.degrees;
        self.values.evaluate(time, &guess[..2 * n])?;
        let begin: Vec<DoubleDouble> = (0..n).map(|i| self.values.output(i)).collect();
        let mut outcome = Err(LegendreError::NotConverging);
        for parts in PARTS {
            self.state.copy_from_slice(&guess[..2 * n]);
            for part in 1..=parts {
                let share = f64::from(part) / f64::from(parts);
                let between = |i: usize| targets[i].map(|p| begin[i] + (p - begin[i]) * share);
                let targets: Vec<_> = (0..n).map(between).collect();
                outcome = match self.iterate(time, &targets, unknown) {
                    Ok(left) if left <= TAME => Ok(()),
                    Ok(_) => Err(LegendreError::NotConverging),
                    Err(why) => Err(why),
                };
                if outcome.is_err() {
                    break;
                }
            }
            if outcome.is_ok() {
                break;
            }
        }
        outcome
    }

    /// Whether a solution that was found has the momenta asked for in so few digits that they are others.
    pub(in crate::system) fn is_rough(
        &mut self,
        time: DoubleDouble,
        state: &[DoubleDouble],
        targets: &[Option<DoubleDouble>],
    ) -> bool {
        let n = self.degrees;
        let unknown: Vec<usize> = (0..n).filter(|&i| targets[i].is_some()).collect();
        self.state.copy_from_slice(&state[..2 * n]);
        self.misses(time, targets, &unknown, ROUGH)
    }

    /// Whether what the iteration came to has momenta that differ by more than this part: next to a pole of p(v), as at the velocity of
    /// light, the terms are so large that any difference counts as rounding.
    fn misses(
        &mut self,
        time: DoubleDouble,
        targets: &[Option<DoubleDouble>],
        unknown: &[usize],
        part: f64,
    ) -> bool {
        let mut missed = vec![DoubleDouble::ZERO; unknown.len()];
        let mut scales = vec![0.0; unknown.len()];
        if self.missing(time, targets, unknown, &mut scales, &mut missed).is_err() {
            return true;
        }
        let target = |i: usize| targets[i].map_or(0.0, |p| p.high.abs());
        // beside others a small momentum has the digits of these
        let largest = unknown.iter().map(|&i| target(i)).fold(0.0, f64::max);
        let allowed = |i: usize| part * target(i).max(f64::EPSILON * largest);
        let mut pairs = unknown.iter().zip(&missed);
        pairs.any(|(&i, missed)| target(i) > 0.0 && missed.high.abs() > allowed(i))
    }

    /// Returns all solutions that can be found if one is known, which is in `state` and comes
    /// first. The search starts far from it along one of the unknown numbers, and with the signs of
    /// all of them changed.
    pub(in crate::system) fn solutions(
        &mut self,
        time: DoubleDouble,
        state: &[DoubleDouble],
        targets: &[Option<DoubleDouble>],
    ) -> Vec<Vec<DoubleDouble>> {
        let n = self.degrees;
        let unknown: Vec<usize> = (0..n).filter(|&i| targets[i].is_some()).collect();
        let first = state[..2 * n].to_vec();
        let size = |x: &[DoubleDouble], i: usize| x[n + i].high.abs();
        let largest = unknown.iter().map(|&i| size(&first, i)).fold(0.0, f64::max);
        let largest = if largest > 0.0 { largest } else { 1.0 };
        let mut starts = Vec::new();
        for &i in &unknown {
            let own = if size(&first, i) > 0.0 { size(&first, i) } else { largest };
            for part in ELSEWHERE {
                let mut start = first.clone();
                start[n + i] = DoubleDouble::from(part * own);
                starts.push(start);
            }
        }
        let mut turned = first.clone();
        for &i in &unknown {
            turned[n + i] = -turned[n + i];
        }
        starts.push(turned);
        let mut found = vec![first];
        for start in starts {
            self.state.copy_from_slice(&start);
            if self.iterate(time, targets, &unknown).is_err()
                || self.misses(time, targets, &unknown, OTHER)
            {
                continue;
            }
            let alike = |known: &Vec<DoubleDouble>| {
                unknown.iter().all(|&i| {
                    let apart = (known[n + i] - self.state[n + i]).high.abs();
                    apart <= ALIKE * size(known, i).max(size(&self.state, i)).max(ALIKE * largest)
                })
            };
            if !found.iter().any(alike) {
                found.push(self.state.clone());
            }
        }
        found
    }
}
