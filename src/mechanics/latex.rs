//! The report on a law of motion as a fragment for LaTeX with amsmath.
//!
//! In: a report. Out: an `align*` environment, with the title in a comment above it. Never here: files, a clipboard.

use super::Holonomy;
use super::further::Further;
use super::report::{LeftSide, Report, ReportedEquation};
use crate::expr::Symbol;

/// Writes the report as a fragment for LaTeX.
pub fn latex(report: &Report<'_>, further: &Further) -> String {
    let pool = &report.equations.pool;
    let mut page = LatexReport { report, lines: Vec::new() };
    page.lines(report.body.iter().flat_map(|body| &body.lines));
    page.lines([&report.law].into_iter().chain(&report.dissipation));
    for ramp in report.model.ramped.named() {
        let parameter = &pool.symbol_info(ramp.parameter).latex;
        page.add(&format!("{parameter}(t)"), &pool.latex(ramp.function));
        for progress in &ramp.progress {
            let symbol = &pool.symbol_info(progress.symbol).latex;
            let [start, end] = progress.times.map(|e| pool.latex(e));
            let mut line = format!(
                "&{symbol} \\text{{ from 0 at }} t = {start} \\text{{ to 1 at }} t = {end}"
            );
            if let Some(time) = progress.stopped {
                line.push_str(&format!(
                    " \\text{{, stays from }} t = {} \\text{{ on}}",
                    pool.latex(time)
                ));
            }
            page.lines.push(line);
        }
    }
    page.lines(report.forces.iter().chain(&report.brackets));
    for (i, (_, casimir)) in report.casimirs.iter().enumerate() {
        page.add(&format!("C_{{{}}}", i + 1), &pool.latex(*casimir));
    }
    for known in &report.constraints {
        page.add(&pool.latex(known.constraint.expression), "0");
        match known.holonomy {
            Holonomy::Holonomic { constant: Some(e), .. } => {
                page.add(&pool.latex(*e), "\\text{constant (holonomic)}");
            }
            Holonomy::Holonomic { .. } => page.lines.push("&\\text{holonomic}".to_owned()),
            Holonomy::Not { .. } => page.lines.push("&\\text{not holonomic}".to_owned()),
            Holonomy::Given | Holonomy::Unknown => {}
        }
    }
    let is_lagrangian = report.model.is_lagrangian();
    if is_lagrangian {
        page.lines(&report.momenta);
    }
    match &report.motion {
        Ok(motion) => page.lines(motion),
        Err(_) => page.unsolved(),
    }
    page.lines(report.impulses.iter().flat_map(|impulse| &impulse.changes));
    for event in &report.model.events {
        // not an equation of motion: only the sign of this expression matters
        let name = event.name.replace(|c: char| !c.is_alphanumeric(), " ");
        let when = pool.latex(event.when);
        page.lines.push(format!("&\\text{{event {name}: sign change of }} {when}"));
    }
    page.lines(report.multipliers.iter().flatten());
    if is_lagrangian {
        page.lines(&report.hamiltonian);
        page.lines([&report.energy]);
    }
    page.add("\\frac{dE}{dt}", &pool.latex(report.energy_rate));
    let answer = report.separation.filter(|_| report.model.coordinates.len() > 1);
    if let Some(separates) = answer.and_then(crate::mechanics::Separation::answer) {
        let words = if separates { "separates" } else { "does not separate" };
        page.lines.push(format!("&\\text{{Hamilton--Jacobi {words} in these coordinates}}"));
    }
    for known in &further.transformations {
        for (symbol, e) in known.map.forwards.iter().flatten() {
            page.add(&pool.symbol_info(*symbol).latex, &pool.latex(*e));
        }
        if let Ok(e) = known.hamiltonian {
            page.add("K", &pool.latex(e));
        }
        if let Some(e) = known.hamiltonian_in_old {
            page.add("K(q, p, t)", &pool.latex(e));
        }
    }
    for known in &further.generators {
        page.add("G", &pool.latex(known.expression));
        if let Ok(e) = known.bracket {
            page.add("[H, G]", &pool.latex(e));
        }
    }
    if let Some(integral) = &report.model.complete_integral {
        page.add("S", &pool.latex(integral.function));
    }
    let title = report.model.info.title.replace('\n', " ");
    format!("% {title}\n\\begin{{align*}}\n{}\n\\end{{align*}}\n", page.lines.join(" \\\\\n"))
}

/// The text so far.
struct LatexReport<'a> {
    report: &'a Report<'a>,
    lines: Vec<String>,
}

impl<'a> LatexReport<'a> {
    fn add(&mut self, left: &str, right: &str) {
        self.lines.push(format!("{left} &= {right}"));
    }

    fn lines(&mut self, lines: impl IntoIterator<Item = &'a ReportedEquation>) {
        for line in lines {
            self.add(&self.left(line.left), &self.report.equations.pool.latex(line.right));
        }
    }

    /// M q̈ = f, with q̇ and ṗ as given.
    fn unsolved(&mut self) {
        let Some((mass, force)) = self.report.unsolved() else { return };
        let pool = &self.report.equations.pool;
        let row = |row: &[_]| row.iter().map(|&e| pool.latex(e)).collect::<Vec<_>>();
        let mass: Vec<String> = mass.iter().map(|m| row(m).join(" & ")).collect();
        let rates: Vec<String> = self.report.rates.iter().map(|&rate| self.left(rate)).collect();
        let left = format!("{} {}", matrix(&mass), matrix(&rates));
        self.add(&left, &matrix(&row(force)));
    }

    fn left(&self, left: LeftSide) -> String {
        let symbol = |s: Symbol| &self.report.equations.pool.symbol_info(s).latex;
        match left {
            LeftSide::Letter(letter) => letter.to_owned(),
            LeftSide::Symbol(s) => symbol(s).clone(),
            LeftSide::Rate(p) => format!("\\dot {}", symbol(p)),
            LeftSide::Added(letter, q) => format!("{letter}_{{{}}}", symbol(q)),
            LeftSide::Bracket(a, b) => format!("\\{{{}, {}\\}}", symbol(a), symbol(b)),
            LeftSide::Jump(s) => format!("\\Delta {}", symbol(s)),
        }
    }
}

fn matrix(rows: &[String]) -> String {
    format!("\\begin{{pmatrix}} {} \\end{{pmatrix}}", rows.join(" \\\\ "))
}
