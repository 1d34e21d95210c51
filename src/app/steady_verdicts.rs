//! The verdicts on drifts as they are shown: a word changes only when it has not held for some time, or when the drift is clearly
//! beyond its limit.
//!
//! In: snapshots, one after the other, and the time between them. Out: their gauges with the verdicts that are shown. Never here:
//! how a verdict is reached (`analysis`), what it is called (`view`).

use std::sync::Arc;
use std::time::Duration;

use crate::analysis::{LEFT, Verdict};
use crate::experiment::{Gauge, Growth, Snapshot};

/// How long a verdict on a moving system is shown that no longer holds.
const LASTING: Duration = Duration::from_millis(2500);

#[derive(Clone, Debug, Default)]
pub(super) struct SteadyVerdicts {
    shown: Vec<SteadyVerdict>,
    /// The motion's time at the last observation.
    time: f64,
    /// The time that has passed since then.
    elapsed: Duration,
}

/// What is shown of one gauge.
#[derive(Clone, Debug)]
struct SteadyVerdict {
    name: String,
    /// When its reference was taken.
    since: f64,
    verdict: Verdict,
    /// The last verdict of its own, and for how long it has differed from the one that is shown.
    other: Option<(Verdict, Duration)>,
}

impl SteadyVerdicts {
    pub(super) fn tick(&mut self, elapsed: Duration) {
        self.elapsed = self.elapsed.saturating_add(elapsed);
    }

    /// Takes in a snapshot. Returns its gauges with the verdicts that are shown, if these differ from its own.
    pub(super) fn see(&mut self, snapshot: &Snapshot) -> Option<Arc<[Gauge]>> {
        let elapsed = std::mem::take(&mut self.elapsed);
        let elapsed = (snapshot.time != self.time).then_some(elapsed);
        self.time = snapshot.time;
        let gauges = &snapshot.gauges;
        self.shown.retain(|shown| gauges.iter().any(|gauge| shown.is_of(gauge)));
        let mut differs = false;
        let steady = gauges.iter().map(|gauge| {
            let Some(shown) = self.shown.iter_mut().find(|shown| shown.is_of(gauge)) else {
                self.shown.push(SteadyVerdict::of(gauge));
                return gauge.clone();
            };
            shown.observe(gauge, elapsed);
            differs |= !is_alike(&shown.verdict, &gauge.verdict);
            Gauge { verdict: shown.verdict.clone(), ..gauge.clone() }
        });
        let steady = steady.collect();
        differs.then_some(steady)
    }
}

impl SteadyVerdict {
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

    /// Observes the gauge after this time of motion, or without any.
    fn observe(&mut self, gauge: &Gauge, elapsed: Option<Duration>) {
        let new = &gauge.verdict;
        let (last, differed) = match &self.other {
            Some((other, differed)) => (other, *differed),
            None => (&self.verdict, Duration::ZERO),
        };
        // what changes while nothing moves is judged anew, and does not flicker
        let is_anew = elapsed.is_none() && !is_alike(last, new);
        if is_alike(&self.verdict, new) || is_anew || changes_at_once(&self.verdict, gauge) {
            (self.verdict, self.other) = (new.clone(), None);
            return;
        }
        // whichever others there were meanwhile
        let differed = differed.saturating_add(elapsed.unwrap_or_default());
        if differed < LASTING {
            self.other = Some((new.clone(), differed));
        } else {
            (self.verdict, self.other) = (new.clone(), None);
        }
    }
}

/// Whether two verdicts are the same words, apart from their numbers.
fn is_alike(one: &Verdict, other: &Verdict) -> bool {
    match (one, other) {
        (Verdict::Exact(one), Verdict::Exact(other)) => one == other,
        _ => std::mem::discriminant(one) == std::mem::discriminant(other),
    }
}

/// Whether the verdict on a gauge is shown at once in place of this one.
fn changes_at_once(shown: &Verdict, gauge: &Gauge) -> bool {
    // what is no estimate from a history
    let is_final = |verdict: &Verdict| {
        matches!(
            verdict,
            Verdict::Lost
                | Verdict::Broken(_)
                | Verdict::Unknown(_)
                | Verdict::OtherBranch
                | Verdict::Released
        )
    };
    let was_near = matches!(shown, Verdict::Exact(_) | Verdict::Open);
    let is_beyond = gauge.max_drift > LEFT && was_near && gauge.verdict != Verdict::Open;
    // in a short history rounding may seem to grow
    let is_first = *shown == Verdict::Open && gauge.verdict != Verdict::Exact(Growth::Faster);
    is_first || is_final(shown) || is_final(&gauge.verdict) || is_beyond
}

#[cfg(test)]
mod tests {
    use super::*;

    const EXACT: Verdict = Verdict::Exact(Growth::Root);
    const GROWS: Verdict = Verdict::Exact(Growth::Faster);

    /// The verdict shown after each of these, 40 in a second, at a gauge of this drift whose reference is as old as the motion.
    fn shown(verdicts: impl IntoIterator<Item = Verdict>, max_drift: f64) -> Vec<Verdict> {
        let mut steady = SteadyVerdicts::default();
        let observe = |(k, verdict): (usize, Verdict)| {
            let mut snapshot = Snapshot::empty(0);
            snapshot.time = 1.0 + k as f64;
            snapshot.gauges = Arc::new([gauge(verdict, max_drift)]);
            steady.tick(Duration::from_millis(25));
            let shown = steady.see(&snapshot);
            shown.unwrap_or(snapshot.gauges)[0].verdict.clone()
        };
        verdicts.into_iter().enumerate().map(observe).collect()
    }

    fn gauge(verdict: Verdict, max_drift: f64) -> Gauge {
        Gauge { verdict, ..Gauge::drifted(max_drift) }
    }

    #[test]
    fn a_verdict_that_comes_and_goes_is_not_shown() {
        let verdicts = (0..600).map(|k| if k / 20 % 2 == 0 { EXACT } else { GROWS });
        assert!(shown(verdicts, 1e-14).iter().all(|verdict| *verdict == EXACT));
    }

    #[test]
    fn a_verdict_that_holds_is_shown_once_and_for_good() {
        let verdicts = (0..300).map(|k| if k < 100 { EXACT } else { GROWS });
        let shown = shown(verdicts, 1e-14);
        let changes = shown.windows(2).filter(|pair| pair[0] != pair[1]).count();
        assert_eq!((changes, &shown[0], &shown[299]), (1, &EXACT, &GROWS));
    }

    /// Two that take turns are no reason to keep a third; and beyond the limit a word is kept as well.
    #[test]
    fn a_verdict_that_changes_back_is_dropped() {
        let secular = Verdict::Secular(1e-9);
        let turns =
            |k: usize| if (k / 4).is_multiple_of(2) { Verdict::Bounded } else { secular.clone() };
        let verdicts = (0..200).map(|k| if k < 20 { EXACT } else { turns(k) });
        let all = shown(verdicts, 1e-9);
        assert!(all[..110].iter().all(|verdict| *verdict == EXACT));
        assert!(all[130..].iter().all(|verdict| *verdict != EXACT));
        let verdicts = (0..200).map(|k| if k < 20 { Verdict::Bounded } else { turns(k) });
        assert!(shown(verdicts, 1e-3).iter().all(|verdict| *verdict == Verdict::Bounded));
    }

    #[test]
    fn what_is_beyond_its_limit_or_comes_first_is_shown_at_once() {
        let secular = |slope| Verdict::Secular(slope);
        let after = |first: Verdict, second: Verdict, drift| shown([first, second], drift).pop();
        assert_eq!(after(Verdict::Open, EXACT, 1e-15), Some(EXACT));
        assert_eq!(after(Verdict::Open, GROWS, 1e-15), Some(Verdict::Open));
        assert_eq!(after(EXACT, secular(1e-4), 1e-3), Some(secular(1e-4)));
        assert_eq!(after(EXACT, secular(1e-14), 1e-12), Some(EXACT));
        assert_eq!(after(EXACT, Verdict::Lost, 0.5), Some(Verdict::Lost));
        assert_eq!(after(EXACT, Verdict::OtherBranch, f64::NAN), Some(Verdict::OtherBranch));
        assert_eq!(after(Verdict::OtherBranch, EXACT, 1e-15), Some(EXACT));
        // the numbers of a verdict are those of the last observation
        assert_eq!(after(secular(1e-4), secular(2e-4), 1e-3), Some(secular(2e-4)));
    }
}
