//! What follows from a law of motion as mathematics to be read.

use std::fmt::Write;

use unicode_width::UnicodeWidthStr;

use super::super::script::Script;
use super::body::Numbers;
use crate::expr::{Expr, Symbol};
use crate::mechanics::{Class, Classed, Equations, Flow, NoClosedForm, Reason, widened};
use crate::model::{Mechanics, Model};

pub(super) fn write(
    model: &Model,
    equations: &Equations,
    classes: &[Classed],
    script: Script,
) -> String {
    let mut page = Page { equations, script, text: String::new() };
    page.head(model);
    page.body(model);
    page.law(model);
    page.constraints(model);
    page.momenta(model);
    page.motion(model);
    page.multipliers();
    page.vakonomic(model);
    page.occurrences(model);
    page.energy();
    page.conserved(model);
    page.changing(classes);
    page.text
}

/// The text so far.
struct Page<'a> {
    equations: &'a Equations,
    script: Script,
    text: String,
}

impl Page<'_> {
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
    fn body(&mut self, model: &Model) {
        let Some(body) = Numbers::of(model, self.equations) else { return };
        let names = body.names;
        let whole = body.whole;
        let numbers = |all: &[f64]| {
            let all: Vec<String> = all.iter().map(f64::to_string).collect();
            format!("({})", all.join(", "))
        };
        let mut rows = vec![(self.symbol(names.mass), self.math(whole.mass))];
        for (symbol, e) in names.centre.into_iter().zip(whole.centre) {
            rows.push((self.symbol(symbol), self.math(e)));
        }
        for (symbol, e) in names.inertia.into_iter().zip(whole.inertia) {
            rows.push((self.symbol(symbol), self.math(e)));
        }
        self.section("Body", &rows);
        let mut rows = vec![
            ("mass".to_owned(), body.mass.to_string()),
            ("centre of mass".to_owned(), numbers(&body.centre)),
        ];
        let mark = |i: usize| format!("inertia, row {}", i + 1);
        rows.extend(body.inertia.iter().enumerate().map(|(i, row)| (mark(i), numbers(row))));
        for (i, (moment, axis)) in body.moments.iter().zip(&body.axes).enumerate() {
            let name = self.symbol(names.principal[i]);
            // twelve digits of a direction are enough to read, and hide what rounding left of a zero
            let axis: Vec<f64> = axis.iter().map(|x| (x * 1e12).round() / 1e12 + 0.0).collect();
            rows.push((name, format!("{moment} about {}", numbers(&axis))));
        }
        self.section("Its numbers at these parameters", &rows);
    }

    fn law(&mut self, model: &Model) {
        let (name, law) = model.mechanics.function();
        let title = if model.is_lagrangian() { "Lagrangian" } else { "Hamiltonian" };
        let mut rows = vec![(name.to_owned(), self.math(law))];
        let dissipation = model.mechanics.dissipation();
        if dissipation != Expr::ZERO {
            rows.push(("F".to_owned(), self.math(dissipation)));
        }
        let letter = if model.is_poisson() { 'f' } else { 'Q' };
        for (c, &force) in model.coordinates.iter().zip(model.mechanics.forces()) {
            if force != Expr::ZERO {
                rows.push((format!("{letter}_{}", self.symbol(c.position)), self.math(force)));
            }
        }
        self.section(title, &rows);
        let widened = widened(model, self.equations);
        if !widened.is_empty() {
            self.line("");
            self.line("Holds where");
            for e in widened {
                let e = self.math(e);
                self.line(&format!("  {e} ≥ 0   (its root is squared away)"));
            }
        }
        self.structure(model);
    }

    /// The brackets that do not vanish, and the Casimirs.
    fn structure(&mut self, model: &Model) {
        let Mechanics::Poisson { casimirs, .. } = &model.mechanics else { return };
        let symbol = |i: usize| self.symbol(model.coordinates[i].position);
        let brackets = model.mechanics.brackets().into_iter();
        let rows: Vec<_> = brackets
            .map(|(i, j, e)| (format!("{{{}, {}}}", symbol(i), symbol(j)), self.math(e)))
            .collect();
        self.section("Brackets", &rows);
        if !casimirs.is_empty() {
            let rows: Vec<_> =
                casimirs.iter().map(|(name, e, _)| (self.words(name), self.math(*e))).collect();
            self.section("Casimirs", &rows);
        }
    }

    fn constraints(&mut self, model: &Model) {
        if model.constraints.is_empty() {
            return;
        }
        self.line("");
        self.line("Constraints");
        for (c, row) in model.constraints.iter().zip(&self.equations.constraints) {
            let kind = match (row.position.is_some(), row.rate == Expr::ZERO) {
                (true, true) => "holonomic",
                (true, false) => "holonomic, moving",
                (false, true) => "on the velocities",
                (false, false) => "on the velocities, moving",
            };
            let line = format!("  {} = 0   ({}; {kind})", self.math(c.expression), c.name);
            self.line(&line);
        }
    }

    /// λ in closed form, and the force it makes on each coordinate.
    fn multipliers(&mut self) {
        let equations = self.equations;
        if equations.constraints.is_empty() {
            return;
        }
        match &equations.multipliers {
            Ok(solved) => {
                let rows = equations.constraints.iter().zip(solved);
                let rows: Vec<_> =
                    rows.map(|(row, &e)| (self.symbol(row.multiplier), self.math(e))).collect();
                self.section("Multipliers", &rows);
            }
            Err(why) => self.why_not("Multipliers", why),
        }
        let mut rows = Vec::new();
        for row in &equations.constraints {
            for (c, &a) in equations.coordinates.iter().zip(&row.row) {
                if a != Expr::ZERO {
                    let left = format!("on {}", self.symbol(c.position));
                    let factor = match self.math(a) {
                        one if one == "1" => String::new(),
                        other => format!("({other}) "),
                    };
                    rows.push((left, format!("{factor}{}", self.symbol(row.multiplier))));
                }
            }
        }
        self.section("Forces of constraint", &rows);
        self.line(
            "  (they stand beside the other forces, each constraint as written; many programs have the \
             opposite sign)",
        );
    }

    /// The Lagrangian that has the constraints put into it, and what it is not.
    fn vakonomic(&mut self, model: &Model) {
        let (Some(vakonomic), Some(comparison)) =
            (&self.equations.beside.vakonomic, &model.comparison)
        else {
            return;
        };
        let title =
            "The wrong mechanics, for comparison: the constraints put into L before it varies";
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

    fn occurrences(&mut self, model: &Model) {
        if !model.impulses.is_empty() {
            self.line("");
            self.line("Impulses");
        }
        for impulse in &model.impulses {
            let changes = model.coordinates.iter().zip(&impulse.change);
            let changes = changes.filter(|(_, e)| **e != Expr::ZERO).map(|(c, &e)| {
                let moved = if model.is_poisson() { c.position } else { c.momentum };
                format!("Δ{} = {}", self.symbol(moved), self.math(e))
            });
            let changes = self.words(&changes.collect::<Vec<_>>().join(", "));
            let line = format!("  {changes}   ({})", impulse.name);
            self.line(&line);
        }
        if !model.events.is_empty() {
            self.line("");
            self.line("Events");
        }
        for event in &model.events {
            let when = self.math(event.when);
            let line = format!("  {when} = 0   ({})", event.name);
            self.line(&line);
        }
    }

    fn momenta(&mut self, model: &Model) {
        if model.is_lagrangian() {
            let momenta = model.coordinates.iter().zip(&self.equations.momenta);
            let rows: Vec<_> =
                momenta.map(|(c, &p)| (self.symbol(c.momentum), self.math(p))).collect();
            self.section("Momenta", &rows);
        }
    }

    fn motion(&mut self, model: &Model) {
        let rates = rates(model, self.script, &|symbol| self.symbol(symbol));
        match &self.equations.solved {
            Ok(solved) => {
                let rows: Vec<_> =
                    rates.into_iter().zip(solved.iter().map(|&e| self.math(e))).collect();
                self.section("Equations of motion", &rows);
            }
            Err(why) => {
                self.why_not("Equations of motion", why);
                self.unsolved(&rates);
            }
        }
    }

    /// M q̈ = f, row by row.
    fn unsolved(&mut self, rates: &[String]) {
        let Flow::Lagrange { mass, force, .. } = &self.equations.flow else { return };
        for (row, &f) in mass.iter().zip(force) {
            let terms = row.iter().zip(rates).filter(|(m, _)| **m != Expr::ZERO);
            let terms: Vec<String> =
                terms.map(|(&m, rate)| format!("({}) {rate}", self.math(m))).collect();
            let line = format!("  {} = {}", terms.join(" + "), self.math(f));
            self.line(&line);
        }
    }

    fn energy(&mut self) {
        let equations = self.equations;
        if equations.is_lagrangian() {
            match &equations.hamiltonian {
                Ok(h) => self.section("Hamiltonian", &[("H".to_owned(), self.math(*h))]),
                Err(why) => self.why_not("Hamiltonian", why),
            }
            self.section("Energy", &[("E".to_owned(), self.math(equations.energy))]);
        }
        if equations.energy_rate != Expr::ZERO {
            let rate = [("dE/dt".to_owned(), self.math(equations.energy_rate))];
            self.section("The energy's change", &rate);
        }
    }

    fn conserved(&mut self, model: &Model) {
        let cyclic = self.equations.cyclic.iter();
        let cyclic: Vec<String> =
            cyclic.map(|&i| self.symbol(model.coordinates[i].position)).collect();
        let cyclic = if cyclic.is_empty() { "none".to_owned() } else { cyclic.join(", ") };
        if !model.is_poisson() {
            self.line("");
            self.line(&format!("Cyclic coordinates: {cyclic}"));
        }
        self.line("");
        if self.equations.conserved.is_empty() {
            return self.line("Conserved: nothing that is known");
        }
        self.line("Conserved");
        for conserved in &self.equations.conserved {
            let reason = self.words(&conserved.reason.to_string());
            let momentum =
                model.coordinates.iter().find(|c| conserved.name == format!("p_{}", c.name));
            // what stands above needs no second formula
            let line = match momentum {
                Some(c) => format!("  {}   ({reason})", self.symbol(c.momentum)),
                None if conserved.name == "energy" => format!("  E   ({reason})"),
                None if conserved.reason == Reason::Casimir => {
                    format!("  {}   ({reason})", self.words(&conserved.name))
                }
                None => {
                    let name = self.words(&conserved.name);
                    format!("  {name} = {}   ({reason})", self.math(conserved.expression))
                }
            };
            self.line(&line);
        }
    }

    /// The observables that are not conserved, with their rates.
    fn changing(&mut self, classes: &[Classed]) {
        let unknown = classes.iter().filter(|c| c.class == Class::Unknown);
        let unknown: Vec<String> = unknown
            .map(|c| {
                let name = self.words(&c.name);
                match &c.rate {
                    Ok(rate) => format!("  d({name})/dt = {}", self.math(*rate)),
                    Err(why) => format!("  {name}   ({})", self.words(&why.0)),
                }
            })
            .collect();
        let here = classes.iter().filter(|c| c.class == Class::AtTheseParameters);
        let here: Vec<String> = here
            .map(|c| {
                let name = self.words(&c.name);
                match &c.rate {
                    Ok(rate) => format!("  {name}, for d({name})/dt = {}", self.math(*rate)),
                    Err(_) => format!("  {name}"),
                }
            })
            .collect();
        let changing = classes.iter().filter(|c| c.class == Class::Changing);
        let rows: Vec<String> = changing
            .map(|c| {
                let name = self.words(&c.name);
                match &c.rate {
                    Ok(rate) => format!("  d({name})/dt = {}", self.math(*rate)),
                    Err(why) => format!("  {name}   ({}; {})", c.class, self.words(&why.0)),
                }
            })
            .collect();
        let rounded = classes.iter().filter(|c| c.class == Class::Numerically && c.rate.is_err());
        let rounded: Vec<String> =
            rounded.map(|c| format!("  {}   ({})", self.words(&c.name), c.class)).collect();
        let sections = [
            ("Conserved to rounding", rounded),
            ("Conserved at the file's values of the parameters", here),
            ("Not conserved", rows),
            ("Not known to be conserved or not", unknown),
        ];
        for (title, rows) in sections {
            if !rows.is_empty() {
                self.line("");
                self.line(title);
                for row in &rows {
                    self.line(row);
                }
            }
        }
    }

    /// A title and lines `name = value`, the signs of equality below each other.
    fn section(&mut self, title: &str, rows: &[(String, String)]) {
        self.line("");
        self.line(title);
        let width = rows.iter().map(|(name, _)| name.width()).max().unwrap_or(0);
        for (name, value) in rows {
            let gap = " ".repeat(width - name.width());
            self.line(&format!("  {name}{gap} = {value}"));
        }
    }

    fn why_not(&mut self, title: &str, why: &NoClosedForm) {
        self.line("");
        self.line(title);
        let why = self.words(&why.to_string());
        self.line(&format!("  {why}"));
    }

    fn line(&mut self, line: &str) {
        // writing to a string cannot fail
        let _ = writeln!(self.text, "{line}");
    }

    fn math(&self, e: Expr) -> String {
        self.script.math(&self.equations.pool, e)
    }

    fn symbol(&self, symbol: Symbol) -> String {
        self.script.symbol(&self.equations.pool, symbol)
    }

    /// Words as the reader's terminal can show them.
    fn words(&self, text: &str) -> String {
        self.script.words(text)
    }
}

/// The left sides of the equations of motion.
fn rates(model: &Model, script: Script, symbol: &dyn Fn(Symbol) -> String) -> Vec<String> {
    let all = model.coordinates.iter();
    if model.is_lagrangian() {
        return all.map(|c| symbol(c.acceleration)).collect();
    }
    let velocities = all.clone().map(|c| symbol(c.velocity));
    let mark = |p: String| match script {
        Script::Ascii => format!("{p}'"),
        // the dot stands over the letter p
        Script::Unicode => p.replacen('p', "ṗ", 1),
    };
    velocities.chain(all.map(|c| mark(symbol(c.momentum)))).collect()
}
