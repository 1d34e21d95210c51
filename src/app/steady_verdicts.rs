//! The verdicts on drifts as they are told: a word once given changes only when another one has held for some looks, or when
//! the drift is clearly beyond its limit.
//!
//! In: snapshots, one after the other. Out: their gauges with the verdicts that are told. Never here: how a verdict is reached
//! (`analysis`), what it is called (`view`).

use std::sync::Arc;

use crate::analysis::{LEFT, Verdict};
use crate::experiment::{Gauge, Growth, Snapshot};

/// The number of looks at a moving system for which another verdict must hold: two or three seconds.
const LOOKS: u32 = 90;

/// The verdicts that are told.
#[derive(Clone, Debug, Default)]
pub(super) struct SteadyVerdicts {
    told: Vec<Told>,
    /// The time of the last look.
    time: f64,
}

/// What is told of one gauge.
#[derive(Clone, Debug)]
struct Told {
    name: String,
    /// When its reference was taken.
    since: f64,
    verdict: Verdict,
    /// Another verdict, and the number of looks for which it has held.
    other: Option<(Verdict, u32)>,
}

impl SteadyVerdicts {
    /// Takes in a snapshot. Returns its gauges with the verdicts that are told, if these differ from its own.
    pub(super) fn see(&mut self, snapshot: &Snapshot) -> Option<Arc<[Gauge]>> {
        let moved = snapshot.time != self.time;
        self.time = snapshot.time;
        let gauges = &snapshot.gauges;
        self.told.retain(|told| gauges.iter().any(|gauge| told.is_of(gauge)));
        let mut differs = false;
        let told = gauges.iter().map(|gauge| {
            let Some(told) = self.told.iter_mut().find(|told| told.is_of(gauge)) else {
                self.told.push(Told::of(gauge));
                return gauge.clone();
            };
            told.look(gauge, moved);
            differs |= !is_alike(&told.verdict, &gauge.verdict);
            Gauge { verdict: told.verdict.clone(), ..gauge.clone() }
        });
        let told = told.collect();
        differs.then_some(told)
    }
}

impl Told {
    fn of(gauge: &Gauge) -> Self {
        Self {
            name: gauge.name.clone(),
            since: gauge.reference_time,
            verdict: gauge.verdict.clone(),
            other: None,
        }
    }

    fn is_of(&self, gauge: &Gauge) -> bool {
        self.name == gauge.name && self.since == gauge.reference_time
    }

    fn look(&mut self, gauge: &Gauge, moved: bool) {
        let new = &gauge.verdict;
        let last = self.other.as_ref().map_or(&self.verdict, |(other, _)| other);
        // what changes while nothing moves is judged anew, and does not flicker
        let is_anew = !moved && !is_alike(last, new);
        if is_alike(&self.verdict, new) || is_anew || changes_at_once(&self.verdict, gauge) {
            (self.verdict, self.other) = (new.clone(), None);
            return;
        }
        let held = match &self.other {
            Some((other, looks)) if is_alike(other, new) => looks + u32::from(moved),
            _ => 1,
        };
        if held < LOOKS {
            self.other = Some((new.clone(), held));
        } else {
            (self.verdict, self.other) = (new.clone(), None);
        }
    }
}

/// Whether two verdicts are told in the same words, apart from their numbers.
fn is_alike(one: &Verdict, other: &Verdict) -> bool {
    match (one, other) {
        (Verdict::Exact(one), Verdict::Exact(other)) => one == other,
        _ => std::mem::discriminant(one) == std::mem::discriminant(other),
    }
}

/// Whether the verdict on a gauge is told at once in place of this one.
fn changes_at_once(told: &Verdict, gauge: &Gauge) -> bool {
    let is_final = |verdict: &Verdict| {
        matches!(verdict, Verdict::Lost | Verdict::Broken(_) | Verdict::Unknown(_))
    };
    let is_beyond = gauge.max_drift > LEFT && !matches!(gauge.verdict, Verdict::Open);
    // in a short history rounding may seem to grow
    let is_first = *told == Verdict::Open && gauge.verdict != Verdict::Exact(Growth::Faster);
    is_first || is_final(told) || is_final(&gauge.verdict) || is_beyond
}

#[cfg(test)]
mod tests {
    use super::*;

    const EXACT: Verdict = Verdict::Exact(Growth::Root);
    const GROWS: Verdict = Verdict::Exact(Growth::Faster);

    /// The verdict told after each of these looks, at a gauge of this drift whose reference is as old as the motion.
    fn told(looks: impl IntoIterator<Item = Verdict>, max_drift: f64) -> Vec<Verdict> {
        let mut steady = SteadyVerdicts::default();
        let tell = |(k, verdict): (usize, Verdict)| {
            let mut snapshot = Snapshot::empty(0);
            snapshot.time = 1.0 + k as f64;
            snapshot.gauges = Arc::new([gauge(verdict, max_drift)]);
            let told = steady.see(&snapshot);
            told.unwrap_or(snapshot.gauges)[0].verdict.clone()
        };
        looks.into_iter().enumerate().map(tell).collect()
    }

    fn gauge(verdict: Verdict, max_drift: f64) -> Gauge {
        Gauge {
            name: "energy".to_owned(),
            shown: "E".to_owned(),
            reason: String::new(),
            proved: true,
            value: 1.0,
            initial: 1.0,
            scale: 1.0,
            farthest: max_drift,
            reference: 1.0,
            reference_time: 0.0,
            drift: max_drift,
            max_drift,
            left: None,
            history: Arc::default(),
            verdict,
        }
    }

    #[test]
    fn a_verdict_that_comes_and_goes_is_not_told() {
        let looks = (0..600).map(|k| if k / 20 % 2 == 0 { EXACT } else { GROWS });
        assert!(told(looks, 1e-14).iter().all(|verdict| *verdict == EXACT));
    }

    #[test]
    fn a_verdict_that_holds_is_told_once_and_for_good() {
        let looks = (0..300).map(|k| if k < 100 { EXACT } else { GROWS });
        let told = told(looks, 1e-14);
        let changes = told.windows(2).filter(|pair| pair[0] != pair[1]).count();
        assert_eq!((changes, &told[0], &told[299]), (1, &EXACT, &GROWS));
    }

    #[test]
    fn what_is_beyond_its_limit_or_comes_first_is_told_at_once() {
        let secular = |slope| Verdict::Secular(slope);
        let after = |first: Verdict, second: Verdict, drift| told([first, second], drift).pop();
        assert_eq!(after(Verdict::Open, EXACT, 1e-15), Some(EXACT));
        assert_eq!(after(Verdict::Open, GROWS, 1e-15), Some(Verdict::Open));
        assert_eq!(after(EXACT, secular(1e-4), 1e-3), Some(secular(1e-4)));
        assert_eq!(after(EXACT, secular(1e-14), 1e-12), Some(EXACT));
        assert_eq!(after(EXACT, Verdict::Lost, 0.5), Some(Verdict::Lost));
        // the numbers of a verdict are those of the last look
        assert_eq!(after(secular(1e-4), secular(2e-4), 1e-3), Some(secular(2e-4)));
    }
}
