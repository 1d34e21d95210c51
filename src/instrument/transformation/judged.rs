//! What is known of a transformation, in words and numbers.
//!
//! In: a report. Out: the lines of the legend, whether the map is canonical, its residual. Never here: how that is found
//! (`mechanics`).

use nalgebra::DMatrix;

use crate::dynamics::MethodStep;
use crate::expr::Pool;
use crate::integrate::method_named;
use crate::mechanics::{
    CanonicalVerdict, Equations, FailingBracket, TransformationReport, Valuation,
};
use crate::model::{GeneratingType, Model};
use crate::num::significant;
use crate::system::System;

#[derive(Clone)]
pub(super) struct MapVerdict {
    /// The verdict, and K, in lines.
    pub(super) lines: Vec<String>,
    pub(super) canonical: bool,
    pub(super) residual: Option<f64>,
    /// How far it is from the step of a method that the file says it is: the images, and M.
    pub(super) off_step: Option<f64>,
}

impl MapVerdict {
    /// Nothing is said of what is no map.
    pub(super) fn of(
        model: &Model,
        equations: &Equations,
        report: Option<&TransformationReport>,
    ) -> Self {
        let lines = |report: &TransformationReport| {
            let mut lines = lines(&equations.pool, report);
            // a map that is not canonical has no generating functions
            let may_have = report.verdict.canonical || is_unknown(&report.verdict);
            let missing = may_have.then(|| report.map.missing_functions(model, equations));
            let missing = missing.and_then(|missing| none_of(&missing));
            match (lines.first_mut(), missing) {
                // where the function of the file is one of them, that is why no map is known
                (Some(first), Some(missing)) if is_unknown(&report.verdict) => *first = missing,
                (_, missing) => lines.extend(missing),
            }
            lines
        };
        Self {
            lines: report.map_or_else(Vec::new, lines),
            canonical: report.is_some_and(|report| report.verdict.canonical),
            residual: report.and_then(|report| report.verdict.residual),
            off_step: None,
        }
    }

    /// With the step of a method beside it, if the file says that it is one; its parameters are those of now.
    pub(super) fn beside_its_step(
        mut self,
        (model, equations, system): (&Model, &mut Equations, &System),
        name: &str,
    ) -> Self {
        let Some(claim) = model.expect.steps.iter().find(|s| s.transformation == name) else {
            return self;
        };
        let Some(method) = method_named(&claim.method) else { return self };
        let parameters = Valuation::of_parameters(model, &model.parameter_values());
        let step = parameters.value(&model.pool, claim.step);
        match MethodStep::beside((model, equations, system), name, (method, step)) {
            Err(why) => self.lines.push(format!("a step of {}: {why}", claim.method)),
            Ok(found) => {
                self.off_step = Some(found.image.max(found.derivative));
                // first what may not be cut off where there is little room
                let lines = step_lines(&found, &claim.method, claim.within);
                let rest = self.lines.split_off(self.lines.len().min(1));
                self.lines.extend(lines);
                self.lines.extend(rest);
            }
        }
        self
    }
}

/// The most entries of M in a line.
const ENTRIES: usize = 4;

/// What is said of a step of a method beside a map.
fn step_lines(found: &MethodStep, method: &str, within: f64) -> Vec<String> {
    let short = |x: f64| significant(x, 3, 1e-3..1e3).replace('-', "−");
    let written = |matrix: &DMatrix<f64>| {
        let rows = matrix.row_iter();
        let rows = rows.map(|row| row.iter().map(|&x| short(x)).collect::<Vec<_>>().join(" "));
        rows.collect::<Vec<_>>().join(" | ")
    };
    let off = |x: f64| if x == 0.0 { "0".to_owned() } else { significant(x, 2, 1e-3..1e3) };
    let is = if found.image <= within && found.derivative <= within { "is" } else { "is not" };
    let (image, derivative) = (off(found.image), off(found.derivative));
    let mut lines = vec![
        format!("{is} one step of {method}"),
        format!("differences: {image}, in M {derivative} ({} points)", found.points),
    ];
    let [map, step] = &found.first;
    if map.len() <= ENTRIES {
        lines.push(format!("map: M = ({})", written(map)));
        lines.push(format!("step: M = ({})", written(step)));
    }
    lines
}

/// What is said of the generating functions that a map does not have at these values of the parameters.
fn none_of(missing: &[(GeneratingType, String)]) -> Option<String> {
    let types: Vec<&str> = missing.iter().map(|(of, _)| of.shown()).collect();
    let zeros: Vec<&str> = missing.iter().map(|(_, determinant)| determinant.as_str()).collect();
    (!types.is_empty()).then(|| format!("no {}: {} = 0", types.join(", "), zeros.join(" = ")))
}

/// Whether nothing was found of a map, neither that it is canonical nor that it is not.
fn is_unknown(verdict: &CanonicalVerdict) -> bool {
    verdict.residual.is_none() && verdict.failing.is_empty()
}

fn lines(pool: &Pool, report: &TransformationReport) -> Vec<String> {
    let verdict = &report.verdict;
    let off = verdict.residual.map_or_else(String::new, |x| significant(x, 1, 1e-3..1e3));
    let brackets = |all: &[FailingBracket], sign: &str| -> Vec<String> {
        let written = all.iter().map(|bracket| {
            let [a, b] = bracket.pair.map(|s| pool.symbol_info(s).unicode.clone());
            let (is, expected) = (pool.unicode(bracket.is), pool.unicode(bracket.expected));
            format!("[{a}, {b}] = {is} {sign} {expected}")
        });
        written.collect()
    };
    let mut lines = vec![match (verdict.canonical, verdict.proved) {
        (true, true) => "canonical, proved".to_owned(),
        (true, false) if !verdict.only_here.is_empty() => "canonical at these values".to_owned(),
        (true, false) => format!("canonical to rounding: |M J Mᵀ − J| = {off}"),
        (false, _) if is_unknown(verdict) => {
            let why = verdict.why.as_ref().map_or_else(String::new, |why| format!(": {why}"));
            format!("no map is known here{why}")
        }
        (false, _) => "not canonical".to_owned(),
    }];
    let mut failing = brackets(&verdict.failing, "≠").into_iter();
    // the first of them beside the verdict, so that a low plot has it too
    if let Some((line, first)) = lines.first_mut().zip(failing.next()) {
        *line = format!("{line}: {first}");
    }
    lines.extend(failing);
    lines.extend(brackets(&verdict.only_here, "="));
    lines.extend(verdict.valence.map(|c| format!("of valence {}", pool.unicode(c))));
    let parameters = report.canonical_where.iter();
    let parameters: Vec<String> = parameters
        .map(|&(s, e)| format!("{} = {}", pool.symbol_info(s).unicode, pool.unicode(e)))
        .collect();
    let with = if parameters.is_empty() {
        String::new()
    } else {
        format!(", with {}", parameters.join(", "))
    };
    let hamiltonian = report.hamiltonian.as_ref().ok();
    let near = if report.is_local { " near the start" } else { "" };
    lines.extend(hamiltonian.map(|k| format!("K = {}{near}{with}", pool.unicode(*k))));
    let in_old = report.hamiltonian_in_old;
    lines.extend(in_old.map(|k| format!("K = {} at (q, p){with}", pool.unicode(k))));
    lines
}
