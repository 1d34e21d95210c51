//! The report on a law of motion as readable mathematics.

mod further;

use std::fmt::Write;

use unicode_width::UnicodeWidthStr;

use super::super::script::MathScript;
use crate::expr::{Expr, Symbol};
use crate::mechanics::{
    ConservedKind, Further, Holonomy, LeftSide, NoClosedForm, Report, ReportedEquation, Separation,
};
use crate::model::Model;

pub(super) fn write(report: &Report<'_>, further: &Further, script: MathScript) -> String {
    let mut page = TextReport { report, script, text: String::new() };
    page.head(report.model);
    page.body();
    page.law();
    page.constraints();
    page.momenta();
    page.motion();
    page.multipliers();
    page.vakonomic();
    page.occurrences();
    page.energy();
    page.conserved();
    page.changing(&further.classes);
    page.separation();
    page.transformations(further);
    page.generators(further);
    page.hamilton_jacobi(further);
    page.text
}

struct TextReport<'a> {
    report: &'a Report<'a>,
    script: MathScript,
    text: String,
}

impl TextReport<'_> {
    fn head(&mut self, model: &Model) {
        let info = &model.info;
        for line in [&info.title, &info.summary, &info.source] {
            if !line.is_empty() {
                let line = self.words(line);
                self.line(&line);
            }
        }
    }

    /// The body of the file: expressions, and numbers at the file's parameters.
    fn body(&mut self) {
        let Some(body) = &self.report.body else { return };
        let numbers = |all: &[f64]| {
            let all: Vec<String> = all.iter().map(f64::to_string).collect();
            format!("({})", all.join(", "))
        };
        self.lines("Body", &body.lines);
        let moments = body.moments;
        let body = body.numbers(self.report.model, self.report.equations);
        let mut rows = vec![
            ("mass".to_owned(), body.mass.to_string()),
            ("centre of mass".to_owned(), numbers(&body.centre)),
        ];
        let mark = |i: usize| format!("inertia, row {}", i + 1);
        rows.extend(body.inertia.iter().enumerate().map(|(i, row)| (mark(i), numbers(row))));
        for (i, (moment, axis)) in body.moments.iter().zip(&body.axes).enumerate() {
            let name = self.symbol(moments[i]);
            // twelve digits of a direction are enough to read, and hide the rounding error of a
            // zero
            let axis: Vec<f64> = axis.iter().map(|x| (x * 1e12).round() / 1e12 + 0.0).collect();
            rows.push((name, format!("{moment} about {}", numbers(&axis))));
        }
        self.section("Its numbers at these parameters", &rows);
    }

    fn law(&mut self) {
        let report = self.report;
        let title = if report.model.is_lagrangian() { "Lagrangian" } else { "Hamiltonian" };
        let beside = report.dissipation.iter().chain(&report.forces);
        let law: Vec<ReportedEquation> = [report.law].iter().chain(beside).copied().collect();
        self.lines(title, &law);
        self.ramps();
        if report.model.is_poisson() {
            self.lines("Brackets", &report.brackets);
        }
        if !report.domain.is_empty() {
            self.line("");
            self.line("Holds where");
            for &e in &report.domain {
                let e = self.math(e);
                let line = format!("  {e} ≥ 0   (its root is squared away)");
                self.line(&self.script.words(&line));
            }
        }
        if !report.casimirs.is_empty() {
            let casimirs = report.casimirs.iter();
            let rows: Vec<_> =
                casimirs.map(|&(name, e)| (self.words(name), self.math(e))).collect();
            self.section("Casimirs", &rows);
        }
    }

    /// The functions of the time behind the names of parameters.
    fn ramps(&mut self) {
        let ramps = self.report.model.ramped.named();
        if ramps.is_empty() {
            return;
        }
        let mut rows = Vec::new();
        for ramp in ramps {
            let left = format!("{}(t)", self.symbol(ramp.parameter));
            rows.push((left, self.math(ramp.function)));
            for progress in &ramp.progress {
                let [start, end] = progress.times.map(|e| self.math(e));
                let mut words = format!("0 … 1 from t = {start} to t = {end}");
                if let Some(time) = progress.stopped {
                    words.push_str(&format!(", stays from t = {} on", self.math(time)));
                }
                rows.push((self.symbol(progress.symbol), self.words(&words)));
            }
        }
        self.section("Ramps", &rows);
    }

    fn constraints(&mut self) {
        if !self.report.constraints.is_empty() {
            self.heading("Constraints");
        }
        for known in &self.report.constraints {
            let kind = match (known.row.position.is_some(), known.row.rate == Expr::ZERO) {
                (true, true) => "holonomic",
                (true, false) => "holonomic, moving",
                (false, true) => "on the velocities",
                (false, false) => "on the velocities, moving",
            };
            let (name, e) = (&known.constraint.name, self.math(known.constraint.expression));
            self.line(&format!("  {e} = 0   ({name}; {kind})"));
            if let Some(words) = self.holonomy(known.holonomy) {
                self.line(&format!("    {words}"));
            }
        }
    }

    /// Whether a constraint on the velocities is holonomic, and why.
    fn holonomy(&self, known: &Holonomy) -> Option<String> {
        let words = match known {
            Holonomy::Given => return None,
            Holonomy::Holonomic { constant, together, at_these_parameters } => {
                let with = if *together { " with the other constraints" } else { "" };
                let here = if *at_these_parameters {
                    " at the file's values of the parameters"
                } else {
                    ""
                };
                let constant = constant.map(|e| format!(": {} is constant", self.math(e)));
                let constant = constant.unwrap_or_default();
                format!("holonomic{with}{here}, proved (Frobenius){constant}")
            }
            Holonomy::Not { variables, component } => {
                let variables: Vec<String> =
                    variables.iter().map(|&s| format!("d{}", self.symbol(s))).collect();
                let product = match self.report.constraints.len() {
                    1 => "its form ω",
                    _ => "the product of all their forms",
                };
                format!(
                    "not holonomic, proved (Frobenius): dω times {product} has the component {} in {}",
                    self.math(*component),
                    variables.join(" ")
                )
            }
            Holonomy::Unknown => "whether it is holonomic is not known".to_owned(),
        };
        Some(self.words(&words))
    }

    /// Whether Hamilton–Jacobi separates in the file's coordinates.
    fn separation(&mut self) {
        let report = self.report;
        let Some(known) = report.separation.filter(|_| report.model.coordinates.len() > 1) else {
            return;
        };
        let words = match known {
            Separation::Separates { at_these_parameters: false } => {
                "separates in these coordinates (Levi-Civita's conditions, proved)".to_owned()
            }
            Separation::Separates { at_these_parameters: true } => {
                "separates in these coordinates at the file's values of the parameters \
                 (Levi-Civita's conditions, proved)"
                    .to_owned()
            }
            Separation::Not(a, b) => format!(
                "does not separate in these coordinates: Levi-Civita's condition fails for {} and {}",
                self.symbol(*a),
                self.symbol(*b)
            ),
            Separation::Unknown(why) => {
                let why = self.words(why);
                format!("whether it separates is not known: {why}")
            }
        };
        self.heading("The Hamilton-Jacobi equation");
        let words = self.words(&words);
        self.line(&format!("  {words}"));
    }

    /// λ in closed form, and its force on each coordinate.
    fn multipliers(&mut self) {
        let report = self.report;
        if report.constraints.is_empty() {
            return;
        }
        self.lines_or_why("Multipliers", &report.multipliers);
        let rows = report.reactions.iter().map(|reaction| {
            let factor = self.math(reaction.factor);
            let force = scaled(&factor, &self.symbol(reaction.multiplier));
            (format!("on {}", self.symbol(reaction.on)), force)
        });
        let rows: Vec<_> = rows.collect();
        self.section("Forces of constraint", &rows);
        self.line(
            "  (added to the other forces, each constraint as written; many programs use the opposite \
             sign)",
        );
    }

    /// The Lagrangian with the constraints substituted, with the note that it gives the wrong
    /// motion.
    fn vakonomic(&mut self) {
        let model = self.report.model;
        let vakonomic = &self.report.equations.supplements.vakonomic;
        let (Some(vakonomic), Some(comparison)) = (vakonomic, &model.comparison) else { return };
        let title =
            "The wrong mechanics, for comparison: the constraints put into L before it is varied";
        match &vakonomic.lagrangian {
            Ok(l) => {
                let eliminated = comparison.eliminate.iter();
                let eliminated: Vec<String> =
                    eliminated.map(|&i| self.symbol(model.coordinates[i].velocity)).collect();
                let name = format!("L without {}", eliminated.join(", "));
                self.section(title, &[(name, self.math(*l))]);
            }
            Err(why) => self.why_not(title, why),
        }
    }

    fn occurrences(&mut self) {
        let report = self.report;
        if !report.impulses.is_empty() {
            self.heading("Impulses");
        }
        for impulse in &report.impulses {
            let changes = impulse.changes.iter();
            let changes: Vec<String> = changes
                .map(|line| format!("{} = {}", self.left(line.left), self.math(line.right)))
                .collect();
            let changes = self.words(&changes.join(", "));
            self.line(&format!("  {changes}   ({})", impulse.impulse.name));
        }
        if !report.model.events.is_empty() {
            self.heading("Events");
        }
        for event in &report.model.events {
            let when = self.math(event.when);
            self.line(&format!("  {when} = 0   ({})", event.name));
        }
    }

    fn momenta(&mut self) {
        if self.report.model.is_lagrangian() {
            self.lines("Momenta", &self.report.momenta);
        }
    }

    fn motion(&mut self) {
        self.lines_or_why("Equations of motion", &self.report.motion);
        if self.report.motion.is_err() {
            self.unsolved();
        }
    }

    /// M q̈ = f, row by row.
    fn unsolved(&mut self) {
        let Some((mass, force)) = self.report.unsolved() else { return };
        for (row, &f) in mass.iter().zip(force) {
            let terms = row.iter().zip(&self.report.rates).filter(|(m, _)| **m != Expr::ZERO);
            let terms: Vec<String> = terms
                .map(|(&m, rate)| format!("({}) {}", self.math(m), self.left(*rate)))
                .collect();
            let line = format!("  {} = {}", terms.join(" + "), self.math(f));
            self.line(&line);
        }
    }

    fn energy(&mut self) {
        let report = self.report;
        if report.model.is_lagrangian() {
            let hamiltonian = report.hamiltonian.as_ref().map(|&h| vec![h]);
            self.lines_or_why("Hamiltonian", &hamiltonian.map_err(|why| *why));
            self.lines("Energy", &[report.energy]);
        }
        if report.energy_rate != Expr::ZERO {
            let rate = [("dE/dt".to_owned(), self.math(report.energy_rate))];
            self.section("How the energy changes", &rate);
        }
    }

    fn conserved(&mut self) {
        let report = self.report;
        let cyclic: Vec<String> = report.cyclic.iter().map(|&q| self.symbol(q)).collect();
        let cyclic = if cyclic.is_empty() { "none".to_owned() } else { cyclic.join(", ") };
        if !report.model.is_poisson() {
            self.heading(&format!("Cyclic coordinates: {cyclic}"));
        }
        // what is only declared is listed where it is judged
        let known = report.conserved.iter().filter(|conserved| !conserved.reason.is_declared());
        let known: Vec<_> = known.collect();
        if known.is_empty() {
            return self.heading("Conserved: nothing known");
        }
        self.heading("Conserved");
        for conserved in known {
            let reason = self.words(&conserved.reason.to_string());
            // a formula shown above needs no repetition
            let what = match conserved.constant {
                ConservedKind::Momentum(p) => self.symbol(p),
                ConservedKind::Energy => "E".to_owned(),
                ConservedKind::Casimir(name) => self.words(name),
                ConservedKind::Other(name) => {
                    format!("{} = {}", self.words(name), self.math(conserved.expression))
                }
            };
            self.line(&format!("  {what}   ({reason})"));
        }
    }

    /// A title and lines `name = value`, with the equals signs aligned.
    fn section(&mut self, title: &str, rows: &[(String, String)]) {
        self.heading(title);
        let width = rows.iter().map(|(name, _)| name.width()).max().unwrap_or(0);
        for (name, value) in rows {
            let gap = " ".repeat(width - name.width());
            self.line(&format!("  {name}{gap} = {value}"));
        }
    }

    fn why_not(&mut self, title: &str, why: &NoClosedForm) {
        self.heading(title);
        let why = self.words(&why.to_string());
        self.line(&format!("  {why}"));
    }

    fn lines(&mut self, title: &str, lines: &[ReportedEquation]) {
        let rows = lines.iter().map(|line| (self.left(line.left), self.math(line.right)));
        let rows: Vec<_> = rows.collect();
        self.section(title, &rows);
    }

    fn lines_or_why(&mut self, title: &str, lines: &Result<Vec<ReportedEquation>, &NoClosedForm>) {
        match lines {
            Ok(lines) => self.lines(title, lines),
            Err(why) => self.why_not(title, why),
        }
    }

    fn heading(&mut self, title: &str) {
        self.line("");
        self.line(title);
    }

    fn left(&self, left: LeftSide) -> String {
        match left {
            LeftSide::Letter(letter) => letter.to_owned(),
            LeftSide::Symbol(symbol) => self.symbol(symbol),
            LeftSide::Rate(p) => match self.script {
                MathScript::Ascii => format!("{}'", self.symbol(p)),
                // p_x′ would be the p of another coordinate
                MathScript::Unicode => format!("d{}/dt", self.symbol(p)),
            },
            LeftSide::Added(letter, q) => format!("{letter}_{}", self.symbol(q)),
            LeftSide::Bracket(a, b) => format!("{{{}, {}}}", self.symbol(a), self.symbol(b)),
            LeftSide::Jump(symbol) => format!("Δ{}", self.symbol(symbol)),
        }
    }

    fn line(&mut self, line: &str) {
        // writing to a String cannot fail
        let _ = writeln!(self.text, "{line}");
    }

    fn math(&self, e: Expr) -> String {
        self.script.math(&self.report.equations.pool, e)
    }

    fn symbol(&self, symbol: Symbol) -> String {
        self.script.symbol(&self.report.equations.pool, symbol)
    }

    /// Text as the reader's terminal can show it.
    fn words(&self, text: &str) -> String {
        self.script.words(text)
    }
}

/// A symbol times a factor that is already written: `−λ`, `2 x λ`, `−λ sin φ`.
fn scaled(factor: &str, symbol: &str) -> String {
    let (minus, size) = match factor.strip_prefix(['−', '-']) {
        Some(size) => (&factor[..factor.len() - size.len()], size),
        None => ("", factor),
    };
    let words = size.split(' ').count();
    let function = ["sin", "cos", "tan", "cot"].iter().any(|name| size.contains(name));
    let sum = [" + ", " − ", " - "].iter().any(|sign| size.contains(sign));
    if size == "1" {
        format!("{minus}{symbol}")
    } else if function && words == 2 {
        format!("{minus}{symbol} {size}")
    } else if function || sum || size.contains('/') {
        format!("({factor}) {symbol}")
    } else {
        format!("{minus}{size} {symbol}")
    }
}
