//! What is known of a transformation, in words and numbers.
//!
//! In: a report. Out: the lines of the legend, whether the map is canonical, its residual. Never here: how that is found
//! (`mechanics`).

use crate::expr::Pool;
use crate::mechanics::TransformationReport;
use crate::num::significant;

/// What is known of a map.
#[derive(Clone)]
pub(super) struct Judged {
    /// The verdict, and K, in lines.
    pub(super) lines: Vec<String>,
    pub(super) canonical: bool,
    pub(super) residual: Option<f64>,
}

impl Judged {
    /// Nothing is said of what is no map.
    pub(super) fn of(pool: &Pool, report: Option<&TransformationReport>) -> Self {
        Self {
            lines: report.map_or_else(Vec::new, |report| lines(pool, report)),
            canonical: report.is_some_and(|report| report.verdict.canonical),
            residual: report.and_then(|report| report.verdict.residual),
        }
    }
}

/// What is said of a transformation.
fn lines(pool: &Pool, report: &TransformationReport) -> Vec<String> {
    let verdict = &report.verdict;
    let off = verdict.residual.map_or_else(String::new, |x| significant(x, 1, 1e-3..1e3));
    let mut lines = vec![match (verdict.canonical, verdict.proved) {
        (true, true) => "canonical, proved".to_owned(),
        (true, false) => format!("canonical to rounding: |M 𝕁 Mᵀ − 𝕁| = {off}"),
        (false, _) => "not canonical".to_owned(),
    }];
    let failing = verdict.failing.iter().map(|bracket| {
        let [a, b] = bracket.pair.map(|s| pool.symbol_info(s).unicode.clone());
        format!("[{a}, {b}] = {}, not {}", pool.unicode(bracket.is), pool.unicode(bracket.expected))
    });
    lines.extend(failing);
    lines.extend(verdict.valence.map(|c| format!("of valence {}", pool.unicode(c))));
    lines.extend(report.hamiltonian.as_ref().ok().map(|k| format!("K = {}", pool.unicode(*k))));
    lines
}
