//! The page of equations: what follows from L or H, in the mathematical notation this terminal can show.
//!
//! In: the derived equations. Out: a page of text. Never here: derivations.

use super::RenderStyle;
use super::constants;
use super::further;
use super::text_page::TextPage;
use super::theme::Role;
use crate::app::Lab;
use crate::expr::{Expr, Symbol};
use crate::mechanics::{
    ConservedKind, Flow, Holonomy, LeftSide, NoClosedForm, Report, ReportedEquation,
};
use crate::model::Coordinate;
use crate::num::significant;

/// Expressions with more nodes than this are not written out.
const MOST: u64 = 4_000;

/// The most characters of the solved equations of motion on the page, and in the small pane.
const LONGEST_ON_PAGE: usize = 10_000;
const LONGEST_IN_PANE: usize = 1_500;

/// Definitions of more characters than this, with all others substituted into them, are named but not written out.
const LONGEST_DEFINITION: usize = 200;

pub(super) fn document(lab: &Lab, style: &RenderStyle) -> TextPage {
    let report = Report::readable(&lab.loaded.model, &lab.loaded.equations);
    let mut writer = EquationRows { report: &report, style, page: TextPage::default() };
    if !is_derived(lab) {
        writer.is_being_derived();
        return writer.page;
    }
    constants::verdict(lab, &mut writer.page);
    writer.law();
    writer.constraints();
    writer.occurrences();
    writer.motion(lab);
    writer.hamiltonian();
    writer.conserved();
    further::rows(lab, style, &mut writer.page);
    constants::found(lab, style, &mut writer.page);
    writer.definitions();
    writer.page.balanced()
}

/// The law of motion, the solved equations and the notes of the file, for a small pane.
pub(super) fn law(lab: &Lab, style: &RenderStyle) -> TextPage {
    let report = Report::readable(&lab.loaded.model, &lab.loaded.equations);
    let mut writer = EquationRows { report: &report, style, page: TextPage::default() };
    if is_derived(lab) {
        writer.lines(&[report.law]);
        writer.ramps();
        writer.page.gap();
        writer.released(lab);
        writer.motion_in_pane(lab);
    } else {
        writer.is_being_derived();
    }
    for paragraph in report.model.info.notes.split("\n\n").map(str::trim) {
        writer.page.gap();
        writer.page.notes(Role::Dim, paragraph);
    }
    writer.page
}

/// Says where equations that are too long for the page can be seen.
fn solved_elsewhere(length: usize, lab: &Lab) -> String {
    let name = &lab.loaded.name;
    format!(
        "Solved for the accelerations they have {length} characters: phaselab derive {name} prints them."
    )
}

/// Whether the law is there as one reads it.
fn is_derived(lab: &Lab) -> bool {
    lab.loaded.equations.supplements.law_with_ramps_named.is_none()
}

struct EquationRows<'a> {
    report: &'a Report<'a>,
    style: &'a RenderStyle,
    page: TextPage,
}

impl EquationRows<'_> {
    fn write(&self, e: Expr) -> String {
        let pool = &self.report.equations.pool;
        if pool.weight(e) > MOST {
            return format!("… ({} pieces: phaselab derive prints them)", pool.weight(e));
        }
        self.style.glyphs.formula(pool, e)
    }

    /// A time, that of a key to as many digits as one reads.
    fn time(&self, e: Expr) -> String {
        match self.report.equations.pool.as_number(e) {
            Some(number) => significant(number.value(), 6, 1e-3..1e6),
            None => self.write(e),
        }
    }

    fn symbol(&self, symbol: Symbol) -> String {
        let info = self.report.equations.pool.symbol_info(symbol);
        self.style.glyphs.pick(&info.unicode, &info.name).clone()
    }

    fn left(&self, left: LeftSide) -> String {
        match left {
            LeftSide::Letter(letter) => letter.to_owned(),
            LeftSide::Symbol(symbol) => self.symbol(symbol),
            // d/dt x, in this terminal's notation
            LeftSide::Rate(symbol) => format!("d{}/dt", self.symbol(symbol)),
            LeftSide::Added(letter, q) => format!("{letter}_{}", self.symbol(q)),
            LeftSide::Bracket(x, y) => format!("{{{}, {}}}", self.symbol(x), self.symbol(y)),
            LeftSide::Jump(symbol) => {
                format!("{}{}", self.style.glyphs.pick("Δ", "jump of "), self.symbol(symbol))
            }
        }
    }

    fn put(&mut self, label: &str, e: Expr, remark: &str) {
        let written = self.write(e);
        self.page.formula(label, written, remark);
    }

    fn line(&mut self, line: &ReportedEquation, remark: &str) {
        self.put(&self.left(line.left), line.right, remark);
    }

    fn lines<'l>(&mut self, lines: impl IntoIterator<Item = &'l ReportedEquation>) {
        lines.into_iter().for_each(|line| self.line(line, ""));
    }

    fn is_being_derived(&mut self) {
        self.page.words(Role::Dim, "The equations are being derived.");
    }

    fn not_closed(&mut self, why: &NoClosedForm) {
        self.page.words(Role::Dim, format!("Not in closed form: {why}."));
    }

    fn law(&mut self) {
        let report = self.report;
        let poisson = report.model.is_poisson();
        let lagrangian = report.model.is_lagrangian();
        self.page.heading(if lagrangian { "Lagrangian" } else { "Hamiltonian" });
        self.lines([&report.law]);
        self.ramps();
        if report.dissipation.is_some() {
            self.page.heading("Rayleigh's function");
            self.lines(&report.dissipation);
        }
        if poisson {
            self.page.heading("Brackets");
            self.lines(&report.brackets);
        }
        if !report.casimirs.is_empty() {
            self.page.heading("Casimirs");
        }
        for (name, casimir) in &report.casimirs {
            self.put(&self.style.glyphs.text(name), *casimir, "");
        }
        if !report.forces.is_empty() {
            let title = if poisson { "Added to the rates" } else { "Forces without a potential" };
            self.page.heading(title);
            self.lines(&report.forces);
        }
    }

    /// Adds the functions of the time behind the names of parameters.
    fn ramps(&mut self) {
        for ramp in self.report.model.ramped.named() {
            self.put(&format!("{}(t)", self.symbol(ramp.parameter)), ramp.function, "");
            for progress in &ramp.progress {
                let [start, end] = progress.times.map(|e| self.time(e));
                let range = self.style.glyphs.text("0 … 1").into_owned();
                let mut words = format!("from t = {start} to t = {end}");
                if let Some(time) = progress.stopped {
                    words.push_str(&format!(", stays from t = {} on", self.time(time)));
                }
                self.page.formula(&self.symbol(progress.symbol), range, &words);
            }
        }
    }

    /// Adds the impulses and the events.
    fn occurrences(&mut self) {
        let report = self.report;
        if !report.impulses.is_empty() {
            self.page.heading("Impulses");
        }
        for impulse in &report.impulses {
            impulse.changes.iter().for_each(|line| self.line(line, &impulse.impulse.name));
        }
        if !report.model.events.is_empty() {
            self.page.heading("Events: where these cross zero");
        }
        for event in &report.model.events {
            self.put("0", event.when, &event.name);
        }
    }

    /// Adds the constraints and their multipliers.
    fn constraints(&mut self) {
        let report = self.report;
        if report.constraints.is_empty() {
            return;
        }
        self.page.heading("Constraints");
        for known in &report.constraints {
            let remark = self.constraint_remark(&known.constraint.name, known.holonomy);
            self.put("0", known.constraint.expression, &remark);
        }
        self.page.heading("Multipliers: the force on each coordinate is +λ times the slope of the constraint as written");
        match &report.multipliers {
            Ok(multipliers) => {
                for (line, known) in multipliers.iter().zip(&report.constraints) {
                    self.line(line, &known.constraint.about);
                }
            }
            Err(why) => self.not_closed(why),
        }
    }

    /// The name of a constraint, and whether it is holonomic where that is a question.
    fn constraint_remark(&self, name: &str, holonomy: &Holonomy) -> String {
        let words = match holonomy {
            Holonomy::Given => return name.to_owned(),
            Holonomy::Holonomic { constant, at_these_parameters, .. } => {
                let constant = constant
                    .map_or_else(String::new, |e| format!(": {} is constant", self.write(e)));
                let here = if *at_these_parameters { " at the file's parameters" } else { "" };
                format!("holonomic{here}{constant}")
            }
            Holonomy::Not { .. } => "not holonomic: proved".to_owned(),
            Holonomy::Unknown => "holonomic or not: not known".to_owned(),
        };
        format!("{name}; {words}")
    }

    fn motion(&mut self, lab: &Lab) {
        let report = self.report;
        if report.model.is_lagrangian() {
            self.page.heading("Momenta");
            self.lines(&report.momenta);
        }
        self.page.heading("Equations of motion");
        match &report.motion {
            Ok(motion) => {
                let length = self.length(motion);
                let lagrange = self.lagrange();
                if length <= LONGEST_ON_PAGE || lagrange.is_empty() {
                    return self.lines(motion);
                }
                self.lines(&lagrange);
                self.page.words(Role::Dim, solved_elsewhere(length, lab));
            }
            Err(why) => {
                let words = format!("Not solved for the accelerations: {why}.");
                self.page.words(Role::Dim, words);
                self.lines(&self.lagrange());
            }
        }
    }

    /// Adds the equations solved for q̈, or for q̇ and ṗ; where they are long, Lagrange's equations, or where all are.
    fn motion_in_pane(&mut self, lab: &Lab) {
        let report = self.report;
        let motion = match &report.motion {
            Ok(motion) => motion,
            Err(why) => {
                let words = format!("Not solved for the accelerations: {why}.");
                return self.page.words(Role::Dim, words);
            }
        };
        let length = self.length(motion);
        if length <= LONGEST_IN_PANE {
            return self.lines(motion);
        }
        let lagrange: Vec<ReportedEquation> =
            report.momenta.iter().copied().chain(self.lagrange()).collect();
        if lagrange.len() > report.momenta.len() && self.length(&lagrange) <= LONGEST_IN_PANE {
            self.lines(&lagrange);
            self.page.words(Role::Dim, solved_elsewhere(length, lab));
        } else {
            let words = format!("{} equations of motion: page 2 has them.", motion.len());
            self.page.words(Role::Dim, words);
        }
    }

    /// Lagrange's equations as rates of the momenta; none of another law.
    fn lagrange(&self) -> Vec<ReportedEquation> {
        let Flow::Lagrange { momentum_rates, .. } = &self.report.equations.flow else {
            return Vec::new();
        };
        let equation = |(coordinate, &right): (&Coordinate, &Expr)| ReportedEquation {
            left: LeftSide::Rate(coordinate.momentum),
            right,
        };
        self.report.model.coordinates.iter().zip(momentum_rates).map(equation).collect()
    }

    /// How many characters equations have on their right.
    fn length(&self, lines: &[ReportedEquation]) -> usize {
        let of = |line: &ReportedEquation| self.write(line.right).chars().count();
        lines.iter().map(of).sum()
    }

    /// Says of which constraints the motion has left the equations are.
    fn released(&mut self, lab: &Lab) {
        let constraints = &lab.loaded.model.constraints;
        let released = lab.seen().map_or(&[][..], |snapshot| &snapshot.released);
        let names: Vec<&str> =
            released.iter().filter_map(|&k| Some(&*constraints.get(k)?.name)).collect();
        let (constraint, verb) = match names.as_slice() {
            [] => return,
            [_] => ("constraint", "holds"),
            _ => ("constraints", "hold"),
        };
        let names = names.join(", ");
        let words = format!("While the {constraint} {names} {verb}, which the motion has left:");
        self.page.words(Role::Warn, words);
    }

    fn hamiltonian(&mut self) {
        let report = self.report;
        if report.model.is_lagrangian() {
            self.page.heading("Hamiltonian");
            match &report.hamiltonian {
                Ok(h) => self.lines([h]),
                Err(why) => self.not_closed(why),
            }
            self.page.heading("Energy function");
        } else if report.model.is_poisson() {
            self.page.heading("Energy");
        } else {
            self.page.heading("Lagrangian");
            match &report.equations.lagrangian {
                Ok(l) => self.put("L", *l, ""),
                Err(why) => self.not_closed(why),
            }
            self.page.heading("Energy");
        }
        let rate = if self.is_law(report.energy.right) {
            "dH/dt"
        } else {
            self.put("h", report.energy.right, "");
            "dh/dt"
        };
        let known = report.conserved.iter().any(|known| known.constant == ConservedKind::Energy);
        let rests = known && report.energy_rate == Expr::ZERO;
        let remark = match (rests, report.impulses.is_empty()) {
            (true, true) => "conserved",
            (true, false) => "conserved between impulses",
            _ => "",
        };
        self.put(rate, report.energy_rate, remark);
    }

    /// Whether an expression is the Hamiltonian that the file gives, which has been written.
    fn is_law(&self, e: Expr) -> bool {
        !self.report.model.is_lagrangian() && e == self.report.law.right
    }

    fn conserved(&mut self) {
        let report = self.report;
        self.page.heading("Conserved");
        if report.conserved.is_empty() {
            self.page.words(Role::Dim, "Nothing that could be found.");
        }
        for known in &report.conserved {
            let shown = match known.constant {
                ConservedKind::Momentum(p) => self.symbol(p),
                ConservedKind::Energy => self.style.glyphs.pick("E", "energy").to_owned(),
                ConservedKind::Casimir(name) | ConservedKind::Other(name) => name.to_owned(),
            };
            let reason = known.reason.to_string();
            match known.constant {
                ConservedKind::Energy if self.is_law(known.expression) => {
                    self.page.formula(&shown, "H".to_owned(), &reason);
                }
                ConservedKind::Energy if known.expression == report.energy.right => {
                    self.page.formula(&shown, "h".to_owned(), &reason);
                }
                _ => self.put(&shown, known.expression, &reason),
            }
        }
    }

    fn definitions(&mut self) {
        let report = self.report;
        if !report.model.definitions.is_empty() {
            self.page.heading("Definitions of the file");
            let mut long = Vec::new();
            for (name, e) in &report.model.definitions {
                let shown = self.style.glyphs.pick(crate::expr::unicode_name(name), name.clone());
                let written = self.write(*e);
                if written.chars().count() > LONGEST_DEFINITION {
                    long.push(shown);
                } else {
                    self.page.formula(&shown, written, "");
                }
            }
            if !long.is_empty() {
                let names = long.join(", ");
                let sentence = format!("{names}: too long when written out; E shows the file.");
                self.page.words(Role::Dim, sentence);
            }
        }
    }
}
