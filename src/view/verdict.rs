//! The verdict on a gauge in words, and its reason, as far as a row has room for them.
//!
//! In: gauges, a width. Out: words and lines. Never here: how a verdict is reached, or where it is drawn.

use super::glyphs::{Glyphs, TextWidth};
use super::number;
use super::theme::Role;
use super::wrap::words;
use crate::analysis::{Growth, Unseen, Verdict};
use crate::app::Lab;
use crate::experiment::{ATTITUDE_GAUGE, Gauge};

/// The width, in columns, of a verdict in full.
pub(super) const IN_FULL: u16 = 17;

/// The least width at which the columns get headings.
pub(super) const HEADED: u16 = 34;

/// The most rows that a reason takes below its gauge.
const MOST: usize = 2;

/// The verdict on what impulses change and the motion between them does not; their sign comes after it.
pub(super) const BETWEEN: &str = "conserved between";

/// Whether a gauge shows the residual of a constraint, or of A Aᵀ = 1 of an attitude: a value that is its own distance from zero.
pub(super) fn is_residual(lab: &Lab, gauge: &Gauge) -> bool {
    let model = &lab.loaded.model;
    model.constraints.iter().any(|constraint| constraint.name == gauge.name)
        || model.attitude.is_some() && gauge.name == ATTITUDE_GAUGE
}

pub(super) fn in_full(verdict: &Verdict) -> (&'static str, Role) {
    let (word, role) = word(verdict);
    let words = match verdict {
        Verdict::Exact(Growth::Faster) => "grows (rounding)",
        Verdict::Exact(_) => "conserved (exact)",
        Verdict::Broken(_) => "not conserved",
        _ => word,
    };
    (words, role)
}

/// The words for a verdict, short enough for a column, and their role.
pub(super) fn word(verdict: &Verdict) -> (&'static str, Role) {
    match verdict {
        Verdict::Open => ("open", Role::Dim),
        Verdict::Unknown(_) => ("unknown", Role::Warn),
        Verdict::Exact(Growth::Level | Growth::Root) => ("exact", Role::Good),
        Verdict::Exact(Growth::Faster) => ("grows", Role::Warn),
        Verdict::Bounded => ("bounded", Role::Good),
        Verdict::Secular(_) => ("drifting", Role::Bad),
        Verdict::Lost => ("lost", Role::Bad),
        Verdict::Broken(_) => ("varies", Role::Warn),
        Verdict::OtherBranch => ("other branch", Role::Dim),
        Verdict::Released => ("released", Role::Dim),
    }
}

/// Whether a gauge's name leaves room for its verdict in full, in a row of this width.
fn fits_in_full(width: u16, gauge: &Gauge, glyphs: Glyphs) -> bool {
    let name = glyphs.pick(&gauge.shown, &gauge.name).width();
    let sign = if given_by_impulses(gauge).is_some() { 2 } else { 0 };
    width >= HEADED - 3 && name + 1 + usize::from(IN_FULL + sign) <= width.into()
}

/// The change of the value by impulses since the reference was taken, or `None` if it is within rounding.
pub(super) fn given_by_impulses(gauge: &Gauge) -> Option<f64> {
    let given = gauge.reference - gauge.initial;
    (given.abs() > ROUNDING * gauge.scale).then_some(given)
}

/// Changes below this, relative to the terms of a quantity, are rounding errors.
pub(super) const ROUNDING: f64 = 1e-12;

/// Whether all verdicts of a list of this width are given in full: one verdict is given in the same words throughout.
pub(super) fn all_in_full(lab: &Lab, gauges: &[Gauge], width: u16, glyphs: Glyphs) -> bool {
    let fits = |gauge: &Gauge| fits_in_full(width, gauge, glyphs) && !is_residual(lab, gauge);
    gauges.iter().all(fits)
}

/// The words for the verdict beside a name, and their role.
pub(super) fn beside_name(gauge: &Gauge, full: bool) -> (&'static str, Role) {
    match (full, &gauge.verdict) {
        (false, verdict) => word(verdict),
        (true, Verdict::Exact(_)) if given_by_impulses(gauge).is_some() => {
            (BETWEEN, word(&gauge.verdict).1)
        }
        (true, verdict) => in_full(verdict),
    }
}

/// The reason for the conservation of a quantity, as a whole.
pub(super) fn reason(gauge: &Gauge, residual: bool, glyphs: Glyphs) -> String {
    let reason = number::with_minus_signs(&gauge.reason, glyphs);
    let reason = glyphs.text(&reason);
    match gauge.verdict {
        Verdict::Released => reason.into_owned(),
        _ if residual => format!("residual; {reason}"),
        _ => reason.into_owned(),
    }
}

pub(super) fn reason_in_a_word(gauge: &Gauge, residual: bool) -> &'static str {
    match (residual, gauge.proved) {
        _ if gauge.verdict == Verdict::Released => "",
        (true, _) => "residual",
        _ if gauge.verdict == Verdict::Unknown(Unseen::Underflow) => "underflow",
        _ if matches!(gauge.verdict, Verdict::Unknown(Unseen::Rounded(_))) => "rounding",
        _ if matches!(gauge.verdict, Verdict::Unknown(_)) => "not resolved",
        (false, true) => "proved",
        (false, false) => "",
    }
}

/// The rows of each reason that has no room between the name and the verdict in a row of this width: none where it has, or where
/// it takes too many.
pub(super) fn reasons_below(
    lab: &Lab,
    gauges: &[Gauge],
    width: u16,
    glyphs: Glyphs,
) -> Vec<Vec<String>> {
    let full = all_in_full(lab, gauges, width, glyphs);
    let below = |gauge: &Gauge| {
        let sign = if given_by_impulses(gauge).is_some() { 2 } else { 0 };
        let name = glyphs.pick(&*gauge.shown, &*gauge.name).width();
        let used = name + 2 + beside_name(gauge, full).0.width() + sign + 1;
        let whole = reason(gauge, is_residual(lab, gauge), glyphs);
        if used + whole.width() <= width.into() {
            return Vec::new();
        }
        let lines = words(&whole, usize::from(width.saturating_sub(2)));
        if lines.len() > MOST { Vec::new() } else { lines }
    };
    gauges.iter().map(below).collect()
}
