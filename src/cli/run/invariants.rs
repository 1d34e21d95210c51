//! The report of the gauges at the end of a run.

use crate::analysis::{RoundedInput, Unseen, Verdict};
use crate::cli::advice::{advice, size};
use crate::cli::report::Invariant;
use crate::experiment::{Gauge, MethodFact};
use crate::num::short;

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

/// A conserved quantity that has drifted, with advice, on one line.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct DriftedInvariant {
    /// What has drifted, without advice.
    pub(super) drift: String,
    pub(super) line: String,
    /// Whether it is conserved by the law of motion, so that the computed motion violates the law.
    pub(super) proved: bool,
}

impl DriftedInvariant {
    /// The most important departure, if there is any.
    pub(super) fn of(gauges: &[Gauge], method: &MethodFact) -> Option<DriftedInvariant> {
        if let Some(worst) = Gauge::departed(gauges) {
            let others = gauges.iter().filter(|g| g.proved && g.left.is_some()).count() - 1;
            let others = match others {
                0 => String::new(),
                1 => ", and so does another invariant".to_owned(),
                n => format!(", and so do {n} others"),
            };
            let drift = format!("{}{others}", description(worst, ""));
            let line = match &worst.verdict {
                Verdict::Unknown(Unseen::Rounded(input)) => {
                    format!("{drift}{}", by_rounding(input))
                }
                _ => {
                    let advice = advice(method.name, Some(method.step), method.tolerance);
                    format!("{drift}; {advice}")
                }
            };
            return Some(DriftedInvariant { drift, line, proved: true });
        }
        let contradicted = gauges.iter().filter(|g| g.left.is_some());
        let worst = contradicted.max_by(|a, b| a.max_drift.total_cmp(&b.max_drift))?;
        let line = description(worst, &format!(" ({})", worst.reason));
        Some(DriftedInvariant { drift: line.clone(), line, proved: false })
    }
}

/// Lines on the conserved quantities whose drift cannot be known; none if there are none.
pub(super) fn unknown(gauges: &[Gauge]) -> Vec<String> {
    let unresolved = gauges.iter().filter_map(|gauge| match &gauge.verdict {
        Verdict::Unknown(Unseen::Rounded(input)) if gauge.left.is_none() => {
            Some(format!("{}{}", description(gauge, ""), by_rounding(input)))
        }
        Verdict::Unknown(Unseen::Unresolved(factor)) => Some(format!(
            "`{}` cannot resolve the motion: its terms are larger than what moves by a factor {factor:.0e}, and no drift can be seen",
            gauge.name
        )),
        _ => None,
    });
    unresolved.chain(underflowing(gauges)).collect()
}

/// The line on those whose terms underflow.
fn underflowing(gauges: &[Gauge]) -> Option<String> {
    let underflows = |gauge: &&Gauge| gauge.verdict == Verdict::Unknown(Unseen::Underflow);
    let names: Vec<String> =
        gauges.iter().filter(underflows).map(|gauge| format!("`{}`", gauge.name)).collect();
    if names.is_empty() {
        return None;
    }
    Some(format!(
        "it is not known whether {} is conserved: its terms underflow (below {:.1e} numbers lose their digits); other units \
         make them larger",
        names.join(", "),
        f64::MIN_POSITIVE
    ))
}

/// What explains a drift: the digits of this variable.
fn by_rounding(RoundedInput { name, digits }: &RoundedInput) -> String {
    format!(", as rounding of {name} explains, whose digits are {digits:.1e} apart")
}

fn description(gauge: &Gauge, about: &str) -> String {
    let (name, drift) = (&gauge.name, size(gauge.max_drift));
    let since = gauge.left.map_or_else(String::new, |time| format!(" since t = {}", short(time)));
    let name = format!("`{name}`{about}");
    match gauge.verdict {
        Verdict::Lost => format!("{name} is lost: off by {drift} of what moves{since}"),
        Verdict::Bounded => {
            format!("{name} oscillates without trend, by {drift} of what moves{since}")
        }
        Verdict::Secular(_) => format!("{name} drifts away: off by {drift} of what moves{since}"),
        _ => format!("{name} departs from its value by {drift} of what moves{since}"),
    }
}
