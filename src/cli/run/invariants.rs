//! What the gauges say at the end of a run.

use crate::cli::report::Invariant;
use crate::experiment::Gauge;

/// One invariant a gauge.
pub(super) fn of(gauges: &[Gauge]) -> Vec<Invariant> {
    let invariant = |gauge: &Gauge| Invariant {
        name: gauge.name.clone(),
        reason: gauge.reason.clone(),
        initial: gauge.initial,
        last: gauge.value,
        max_drift: gauge.max_drift,
        verdict: gauge.verdict.word(),
    };
    gauges.iter().map(invariant).collect()
}
