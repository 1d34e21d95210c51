//! The page of equations: what follows from L or H, in the mathematics this terminal can show.
//!
//! In: the derived equations. Out: a page of text. Never here: derivations.

use super::RenderStyle;
use super::text_page::TextPage;
use super::theme::Role;
use crate::app::Lab;
use crate::expr::{Expr, Symbol};
use crate::mechanics::{Equations, Flow};
use crate::model::{Mechanics, Model};

/// More pieces than this are not written out on a screen.
const MOST: u64 = 4_000;

/// The page.
pub(super) fn document(lab: &Lab, look: &RenderStyle) -> TextPage {
    let writer = Writer { equations: &lab.loaded.equations, model: &lab.loaded.model, look };
    let mut page = TextPage::default();
    writer.law(&mut page);
    writer.constraints(&mut page);
    writer.occurrences(&mut page);
    writer.motion(&mut page);
    writer.hamiltonian(&mut page);
    writer.conserved(&mut page);
    writer.definitions(&mut page);
    page
}

/// The law of motion and what to look for, for a small pane.
pub(super) fn law(lab: &Lab, look: &RenderStyle) -> TextPage {
    let writer = Writer { equations: &lab.loaded.equations, model: &lab.loaded.model, look };
    let mut page = TextPage::default();
    let (name, law) = writer.model.mechanics.function();
    writer.put(&mut page, name, law);
    page.gap();
    writer.solved(&mut page);
    for paragraph in writer.model.info.notes.split("\n\n").map(str::trim) {
        page.gap();
        page.words(Role::Dim, paragraph);
    }
    page
}

struct Writer<'a> {
    equations: &'a Equations,
    model: &'a Model,
    look: &'a RenderStyle,
}

impl Writer<'_> {
    fn write(&self, e: Expr) -> String {
        let pool = &self.equations.pool;
        if pool.weight(e) > MOST {
            return format!("… ({} pieces: phaselab derive prints them)", pool.weight(e));
        }
        if self.look.glyphs.is_ascii() { pool.text(e) } else { pool.unicode(e) }
    }

    fn symbol(&self, symbol: Symbol) -> String {
        let info = self.equations.pool.symbol_info(symbol);
        self.look.glyphs.pick(&info.unicode, &info.name).clone()
    }

    /// `d/dt x`, written as the terminal can.
    fn rate(&self, symbol: Symbol) -> String {
        let name = self.symbol(symbol);
        format!("d{name}/dt")
    }

    fn put(&self, page: &mut TextPage, label: &str, e: Expr) {
        page.formula(label, self.write(e), "");
    }

    fn law(&self, page: &mut TextPage) {
        match &self.model.mechanics {
            Mechanics::Lagrangian { lagrangian, dissipation, forces } => {
                page.heading("Lagrangian");
                self.put(page, "L", *lagrangian);
                if *dissipation != Expr::ZERO {
                    page.heading("Rayleigh's function");
                    self.put(page, "F", *dissipation);
                }
                self.forces(page, forces);
            }
            Mechanics::Hamiltonian { hamiltonian, forces } => {
                page.heading("Hamiltonian");
                self.put(page, "H", *hamiltonian);
                self.forces(page, forces);
            }
            Mechanics::Poisson { hamiltonian, casimirs, forces, .. } => {
                page.heading("Hamiltonian");
                self.put(page, "H", *hamiltonian);
                page.heading("Brackets");
                let q = &self.model.coordinates;
                for (i, j, bracket) in self.model.mechanics.brackets() {
                    let (x, y) = (self.symbol(q[i].position), self.symbol(q[j].position));
                    self.put(page, &format!("{{{x}, {y}}}"), bracket);
                }
                if !casimirs.is_empty() {
                    page.heading("Casimirs");
                }
                for (name, casimir, _) in casimirs {
                    self.put(page, &self.look.glyphs.text(name), *casimir);
                }
                self.forces(page, forces);
            }
        }
    }

    /// Impulses, and the events that are looked for.
    fn occurrences(&self, page: &mut TextPage) {
        if !self.model.impulses.is_empty() {
            page.heading("Impulses");
        }
        for impulse in &self.model.impulses {
            let changes = self.model.coordinates.iter().zip(&impulse.change);
            for (c, e) in changes.filter(|(_, e)| **e != Expr::ZERO) {
                let moved = if self.model.is_poisson() { c.position } else { c.momentum };
                let lead = self.look.glyphs.pick("Δ", "jump of ");
                let label = format!("{lead}{}", self.symbol(moved));
                page.formula(&label, self.write(*e), &impulse.name);
            }
        }
        if !self.model.events.is_empty() {
            page.heading("Events: where these cross zero");
        }
        for event in &self.model.events {
            page.formula("0", self.write(event.when), &event.name);
        }
    }

    /// Constraints and their multipliers.
    fn constraints(&self, page: &mut TextPage) {
        if self.model.constraints.is_empty() {
            return;
        }
        page.heading("Constraints");
        for constraint in &self.model.constraints {
            page.formula("0", self.write(constraint.expression), &constraint.name);
        }
        page.heading("Multipliers: the force on each coordinate is +λ times the slope of the constraint as written");
        match &self.equations.multipliers {
            Ok(solved) => {
                for ((row, e), c) in
                    self.equations.constraints.iter().zip(solved).zip(&self.model.constraints)
                {
                    page.formula(&self.symbol(row.multiplier), self.write(*e), &c.about);
                }
            }
            Err(why) => page.words(Role::Dim, format!("Not in closed form: {why}.")),
        }
    }

    fn forces(&self, page: &mut TextPage, forces: &[Expr]) {
        if forces.iter().all(|force| *force == Expr::ZERO) {
            return;
        }
        let poisson = self.model.is_poisson();
        page.heading(if poisson { "Added to the rates" } else { "Forces without a potential" });
        for (coordinate, force) in self.model.coordinates.iter().zip(forces) {
            if *force != Expr::ZERO {
                let name = self.look.glyphs.pick(&coordinate.shown, &coordinate.name);
                let letter = if poisson { "f" } else { "Q" };
                self.put(page, &format!("{letter}_{name}"), *force);
            }
        }
    }

    fn motion(&self, page: &mut TextPage) {
        if self.equations.is_lagrangian() {
            page.heading("Momenta");
            for (coordinate, momentum) in self.model.coordinates.iter().zip(&self.equations.momenta)
            {
                self.put(page, &self.symbol(coordinate.momentum), *momentum);
            }
        }
        page.heading("Equations of motion");
        self.solved(page);
        if let (Flow::Lagrange { momentum_rates, .. }, Err(_)) =
            (&self.equations.flow, &self.equations.solved)
        {
            for (coordinate, rate) in self.model.coordinates.iter().zip(momentum_rates) {
                self.put(page, &self.rate(coordinate.momentum), *rate);
            }
        }
    }

    /// q̈, or q̇ and ṗ, solved.
    fn solved(&self, page: &mut TextPage) {
        let solved = match &self.equations.solved {
            Ok(solved) => solved,
            Err(why) => {
                page.words(Role::Dim, format!("Not solved for the accelerations: {why}."));
                return;
            }
        };
        let q = &self.model.coordinates;
        let labels: Vec<String> = if self.equations.is_lagrangian() {
            q.iter().map(|c| self.symbol(c.acceleration)).collect()
        } else {
            let rates = q.iter().map(|c| self.symbol(c.velocity));
            rates.chain(q.iter().map(|c| self.rate(c.momentum))).collect()
        };
        for (label, e) in labels.iter().zip(solved) {
            self.put(page, label, *e);
        }
    }

    fn hamiltonian(&self, page: &mut TextPage) {
        if self.equations.is_lagrangian() {
            page.heading("Hamiltonian");
            match &self.equations.hamiltonian {
                Ok(h) => self.put(page, "H", *h),
                Err(why) => page.words(Role::Dim, format!("Not in closed form: {why}.")),
            }
            page.heading("Energy function");
        } else if self.model.is_poisson() {
            page.heading("Energy");
        } else {
            page.heading("Lagrangian");
            match &self.equations.lagrangian {
                Ok(l) => self.put(page, "L", *l),
                Err(why) => page.words(Role::Dim, format!("Not in closed form: {why}.")),
            }
            page.heading("Energy");
        }
        self.put(page, "h", self.equations.energy);
        let known = self.equations.conserved.iter().any(|c| c.name == "energy");
        let remark = match (
            known && self.equations.energy_rate == Expr::ZERO,
            self.model.impulses.is_empty(),
        ) {
            (true, true) => "conserved",
            (true, false) => "conserved between impulses",
            _ => "",
        };
        page.formula("dh/dt", self.write(self.equations.energy_rate), remark);
    }

    fn conserved(&self, page: &mut TextPage) {
        page.heading("Conserved");
        if self.equations.conserved.is_empty() {
            page.words(Role::Dim, "Nothing that could be found.");
        }
        for conserved in &self.equations.conserved {
            let name = &conserved.name;
            let symbol = self.equations.pool.find_symbol(name).filter(|_| name.starts_with("p_"));
            let shown = match symbol {
                Some(symbol) => self.symbol(symbol),
                None if name == "energy" => self.look.glyphs.pick("E", "energy").to_owned(),
                None => name.clone(),
            };
            page.formula(&shown, self.write(conserved.expression), &conserved.reason.to_string());
        }
    }

    fn definitions(&self, page: &mut TextPage) {
        if !self.model.definitions.is_empty() {
            page.heading("Definitions of the file");
            for (name, e) in &self.model.definitions {
                let shown = self.look.glyphs.pick(crate::expr::unicode_name(name), name.clone());
                self.put(page, &shown, *e);
            }
        }
    }
}
