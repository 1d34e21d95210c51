//! The part of the page of equations that takes longer to find: transformations, generators, the complete integral.
//!
//! In: what a job has found. Out: blocks of a page. Never here: derivations.

use super::RenderStyle;
use super::text_page::TextPage;
use super::theme::Role;
use crate::app::{FurtherForms, Lab};
use crate::expr::{Expr, Symbol};

/// Expressions with more nodes than this are not written out.
const MOST: u64 = 1_000;

pub(super) fn rows(lab: &Lab, style: &RenderStyle, page: &mut TextPage) {
    if !lab.has_further() {
        return;
    }
    let Some(forms) = lab.further() else {
        page.heading("Transformations, generators, complete integral");
        page.words(Role::Dim, "Computing…");
        return;
    };
    let mut rows = FurtherRows { forms, style, page };
    rows.transformations();
    rows.generators();
    rows.complete_integral(lab);
}

struct FurtherRows<'a> {
    forms: &'a FurtherForms,
    style: &'a RenderStyle,
    page: &'a mut TextPage,
}

impl FurtherRows<'_> {
    fn write(&self, e: Expr) -> String {
        let pool = &self.forms.equations.pool;
        if pool.weight(e) > MOST {
            return format!("… ({} pieces: phaselab derive prints them)", pool.weight(e));
        }
        self.style.glyphs.formula(pool, e)
    }

    fn symbol(&self, symbol: Symbol) -> String {
        let info = self.forms.equations.pool.symbol_info(symbol);
        self.style.glyphs.pick(&info.unicode, &info.name).clone()
    }

    fn put(&mut self, label: &str, e: Expr, remark: &str) {
        let written = self.write(e);
        self.page.formula(label, written, remark);
    }

    fn transformations(&mut self) {
        let forms = self.forms;
        for known in &forms.further.transformations {
            let verdict = &known.verdict;
            let judged = match (verdict.canonical, verdict.proved) {
                (true, true) => "canonical, proved",
                (true, false) if !verdict.only_here.is_empty() => {
                    "canonical at the values of the file"
                }
                (true, false) => "canonical to rounding",
                (false, _) if verdict.residual.is_none() && verdict.failing.is_empty() => {
                    "no map is known"
                }
                (false, _) => "not canonical",
            };
            self.page.heading(&format!("Transformation {}: {judged}", known.map.name));
            for &(s, e) in known.map.forwards.iter().flatten() {
                self.put(&self.symbol(s), e, "");
            }
            if known.map.forwards.is_none() {
                let words = "The new variables are not known in closed form.";
                self.page.words(Role::Dim, words);
            }
            for bracket in &verdict.only_here {
                let [a, b] = bracket.pair.map(|s| self.symbol(s));
                let here = format!("which is {} there", self.write(bracket.expected));
                self.put(&format!("[{a}, {b}]"), bracket.is, &here);
            }
            for failing in &verdict.failing {
                let [a, b] = failing.pair.map(|s| self.symbol(s));
                let expected = format!("and not {}", self.write(failing.expected));
                self.put(&format!("[{a}, {b}]"), failing.is, &expected);
            }
            if let Some(valence) = verdict.valence {
                self.put("valence", valence, "a scale transformation");
            }
            for &(parameter, e) in &known.canonical_where {
                self.put(&self.symbol(parameter), e, "in what follows");
            }
            for one in &known.functions {
                match &one.function {
                    Ok(e) => {
                        self.put(&one.shown(), *e, if one.proved { "" } else { "near the start" });
                    }
                    Err(why) => {
                        self.page.words(Role::Dim, format!("{}: {why}.", one.shown()));
                    }
                }
            }
            if verdict.canonical && known.functions.is_empty() {
                self.page.words(Role::Dim, known.without_functions());
            }
            match &known.hamiltonian {
                Ok(e) => self.put("K", *e, if known.is_local { "near the start" } else { "" }),
                Err(why) if verdict.canonical => self.page.words(Role::Dim, format!("K: {why}.")),
                Err(_) => {}
            }
            if let Some(e) = known.hamiltonian_in_old {
                self.put("K", e, "in the old variables");
            }
        }
    }

    fn generators(&mut self) {
        let forms = self.forms;
        if !forms.further.generators.is_empty() {
            self.page.heading("Generators");
        }
        for known in &forms.further.generators {
            self.put("G", known.expression, &known.name);
            let verdict = if known.conserved { "conserved" } else { "not conserved" };
            match &known.bracket {
                Ok(bracket) => self.put("[H, G]", *bracket, verdict),
                Err(why) => self.page.words(Role::Dim, format!("[H, G]: {why}; {verdict}.")),
            }
        }
    }

    fn complete_integral(&mut self, lab: &Lab) {
        let forms = self.forms;
        let (model, Some(known)) = (&lab.loaded.model, &forms.further.hamilton_jacobi) else {
            return;
        };
        let complete = if known.complete { "complete" } else { "not complete" };
        self.page.heading(&format!("Integral of the Hamilton–Jacobi equation: {complete}"));
        if let Some(why) = &known.why {
            self.page.words(Role::Dim, format!("{why}."));
        }
        let constants = model.complete_integral.iter().flat_map(|s| &s.constants);
        let momenta = model.coordinates.iter().zip(&known.momenta);
        for (coordinate, &e) in momenta {
            self.put(&self.symbol(coordinate.momentum), e, "= ∂S/∂q");
        }
        for (constant, &e) in constants.zip(&known.beta) {
            self.put(&self.symbol(constant.conjugate), e, "= ∂S/∂α, constant");
        }
    }
}
