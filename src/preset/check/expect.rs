//! The file's claims: read with their ranges, and verified later with the motion.

use toml::Spanned;

use super::ModelBuilder;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::SourceRange;
use crate::diagnostic::nearest;
use crate::expr::Expr;
use crate::model::{
    Allowed, Expect, ExpectedBracket, ExpectedCount, ExpectedEvent, ExpectedInvariants,
    ExpectedStep, ExpectedValue, Mechanics, Scope,
};
use crate::preset::draft::{
    DraftBracketClaim, DraftCount, DraftExpect, DraftOccurrence, DraftStep, DraftValue,
};
use crate::printable::number;

/// How far a step of a method may lie from a transformation if the file does not say.
const TOLERANCE: f64 = 1e-10;

/// The degree up to which constants of the motion are searched if the file gives none.
const DEGREE: u32 = 2;

/// The greatest degree that a file may ask for.
const HIGHEST: f64 = 6.0;

impl ModelBuilder<'_> {
    pub(super) fn expect(&mut self, written: &DraftExpect) {
        let mut scope = Scope::new(&self.model, Allowed::Observable, "an expectation");
        let mut expect = Expect::default();
        for claim in &written.conserves {
            if let Some(e) = self.conserved(claim, &mut scope) {
                expect.conserves.push((claim.get_ref().clone(), e, claim.span()));
            }
        }
        for value in &written.values {
            expect.values.extend(self.expected(value, &mut scope));
        }
        for claim in &written.events {
            expect.events.extend(self.expected_event(claim));
        }
        for claim in &written.counts {
            expect.counts.extend(self.expected_count(claim));
        }
        let mut sides = Scope::new(&self.model, Allowed::Bracket, "a side of a bracket");
        for claim in &written.brackets {
            expect.brackets.extend(self.expected_bracket(claim, &mut sides));
        }
        let mut steps = Scope::new(&self.model, Allowed::Parameters, "the step of a method");
        for claim in &written.steps {
            expect.steps.extend(self.expected_step(claim, &mut steps));
        }
        expect.invariants = self.expected_invariants(written);
        self.model.expect = expect;
    }

    fn expected_event(&mut self, written: &DraftOccurrence) -> Option<ExpectedEvent> {
        let name = written.name.as_ref().and_then(|name| self.occurrence(name));
        let nth = match &written.nth {
            None => Some(1),
            Some(nth) => self.whole(nth, 1, "`nth` must be a whole number, 1 or more"),
        };
        self.not_before_the_start(written.at.as_ref());
        self.tolerance(written.within.as_ref());
        let at = written.at.as_ref()?;
        Some(ExpectedEvent {
            name: name?,
            nth: nth?,
            at: *at.get_ref(),
            within: written.within.as_ref().map(|w| *w.get_ref()),
            source: written.source.clone(),
            place: at.span(),
        })
    }

    fn expected_count(&mut self, written: &DraftCount) -> Option<ExpectedCount> {
        let name = written.name.as_ref().and_then(|name| self.occurrence(name));
        self.not_before_the_start(written.until.as_ref());
        let is = written.is.as_ref()?;
        let count = self.whole(is, 0, "`is` must be a whole number, 0 or more");
        Some(ExpectedCount {
            name: name?,
            until: *written.until.as_ref()?.get_ref(),
            is: count?,
            source: written.source.clone(),
            place: is.span(),
        })
    }

    fn expected_bracket(
        &mut self,
        written: &DraftBracketClaim,
        scope: &mut Scope,
    ) -> Option<ExpectedBracket> {
        let sides = [&written.f, &written.g, &written.is].map(|formula| {
            let formula = formula.as_ref()?;
            let e = self.formula(scope, "a side of a bracket", formula)?;
            Some((e, formula))
        });
        let [Some((f, f_written)), Some((g, g_written)), Some((is, is_written))] = sides else {
            return None;
        };
        Some(ExpectedBracket {
            f,
            g,
            is,
            written: format!("[{}, {}]", f_written.get_ref().trim(), g_written.get_ref().trim()),
            source: written.source.clone(),
            place: is_written.span(),
        })
    }

    fn expected_step(&mut self, written: &DraftStep, scope: &mut Scope) -> Option<ExpectedStep> {
        self.tolerance(written.within.as_ref());
        let name = written.transformation.as_ref().and_then(|name| self.transformation_named(name));
        let formula = written.step.as_ref();
        let step = formula.and_then(|f| self.formula(scope, "the step of a method", f));
        Some(ExpectedStep {
            transformation: name?,
            method: written.method.as_ref()?.get_ref().clone(),
            step: step?,
            within: written.within.as_ref().map_or(TOLERANCE, |w| *w.get_ref()),
            source: written.source.clone(),
            place: written.place.clone(),
        })
    }

    /// The name of a transformation; an unknown name is reported.
    fn transformation_named(&mut self, name: &Spanned<String>) -> Option<String> {
        let known = self.model.transformations.iter().map(|one| one.name.as_str());
        if known.clone().any(|known| known == name.get_ref()) {
            return Some(name.get_ref().clone());
        }
        let help = match nearest(name.get_ref(), known.clone()) {
            Some(near) => format!("did you mean `{near}`?"),
            None if known.len() == 0 => "the file has no [[transformations]]".to_owned(),
            None => format!("there is {}", known.collect::<Vec<_>>().join(", ")),
        };
        let message = format!("unknown transformation `{}`", name.get_ref());
        self.diagnostics.push(Diagnostic::error(name.span(), message).with_help(help));
        None
    }

    /// Reads the number of constants of the motion.
    fn expected_invariants(&mut self, written: &DraftExpect) -> Option<ExpectedInvariants> {
        let degree = match &written.degree {
            None => Some(DEGREE),
            Some(degree) if *degree.get_ref() > HIGHEST => {
                self.error(degree.span(), format!("`degree` is at most {HIGHEST}"));
                None
            }
            Some(degree) => {
                self.whole(degree, 1, "`degree` is a whole number above 0").map(|n| n as u32)
            }
        };
        let is = written.invariants.as_ref()?;
        let count = self.whole(is, 0, "`invariants` must be a whole number, 0 or more")?;
        Some(ExpectedInvariants { is: count, degree: degree?, place: is.span() })
    }

    /// The name of an event or impulse; an unknown name is reported.
    fn occurrence(&mut self, name: &Spanned<String>) -> Option<String> {
        let impulses = self.model.impulses.iter().map(|impulse| impulse.name.as_str());
        let events = self.model.events.iter().map(|event| event.name.as_str());
        let known: Vec<&str> = events.chain(impulses).collect();
        if known.contains(&name.get_ref().as_str()) {
            return Some(name.get_ref().clone());
        }
        let help = match nearest(name.get_ref(), known.iter().copied()) {
            Some(near) => format!("did you mean `{near}`?"),
            None if known.is_empty() => "the file has no [[events]] and no [[impulses]]".to_owned(),
            None => format!("the events and impulses are {}", known.join(", ")),
        };
        let message = format!("unknown event or impulse `{}`", name.get_ref());
        self.diagnostics.push(Diagnostic::error(name.span(), message).with_help(help));
        None
    }

    /// A whole number that is not below the least one.
    fn whole(&mut self, written: &Spanned<f64>, least: u32, otherwise: &str) -> Option<usize> {
        let number = *written.get_ref();
        let fits = number.fract() == 0.0 && (f64::from(least)..=1e9).contains(&number);
        if !fits {
            self.error(written.span(), otherwise);
        }
        fits.then_some(number as usize)
    }

    fn not_before_the_start(&mut self, at: Option<&Spanned<f64>>) {
        let start = self.model.run.start;
        if let Some(at) = at.filter(|at| *at.get_ref() < start) {
            self.error(at.span(), format!("this is before the start, t = {}", number(start)));
        }
    }

    fn tolerance(&mut self, within: Option<&Spanned<f64>>) {
        if let Some(within) = within.filter(|w| *w.get_ref() < 0.0) {
            self.error(within.span(), "`within` is an absolute tolerance and must not be below 0");
        }
    }

    /// The expression of a name in `conserves`: `energy`, a momentum, an observable, or an
    /// expression.
    fn conserved(&mut self, claim: &Spanned<String>, scope: &mut Scope) -> Option<Expr> {
        let name = claim.get_ref().as_str();
        if let Some(observable) = self.model.observables.iter().find(|o| o.name == name) {
            return Some(observable.expression);
        }
        if let Some((_, e, _)) = self.casimirs_by_name().iter().find(|(known, ..)| known == name) {
            return Some(*e);
        }
        let mut trial = scope.clone();
        if let Some(e) = trial.read(&mut self.model.pool, name) {
            self.used.append(&mut trial.used);
            return Some(e);
        }
        let momenta: Vec<String> = match self.model.mechanics {
            Mechanics::Poisson { .. } => Vec::new(),
            _ => self.model.coordinates.iter().map(|c| format!("p_{}", c.name)).collect(),
        };
        let known = ["energy"].into_iter().chain(momenta.iter().map(String::as_str));
        let known = known.chain(self.casimirs_by_name().iter().map(|(name, ..)| name.as_str()));
        let known = known.chain(self.model.observables.iter().map(|o| o.name.as_str()));
        let is_expression = name.contains(['+', '-', '*', '/', '^', '(']);
        match nearest(name, known) {
            None if is_expression => {
                self.formula(scope, "what is conserved", claim);
            }
            near => {
                let message = format!("`{name}` names nothing that could be conserved");
                let help = match near {
                    Some(near) => format!("did you mean `{near}`?"),
                    None if self.model.is_poisson() => {
                        let mut names = vec!["`energy`".to_owned()];
                        let casimirs = self.casimirs_by_name().iter();
                        names.extend(casimirs.map(|(name, ..)| format!("`{name}`")));
                        format!("name {}, or an observable", names.join(", "))
                    }
                    None => "name `energy`, a momentum p_..., or an observable".to_owned(),
                };
                self.diagnostics.push(Diagnostic::error(claim.span(), message).with_help(help));
            }
        }
        None
    }

    fn casimirs_by_name(&self) -> &[(String, Expr, SourceRange)] {
        match &self.model.mechanics {
            Mechanics::Poisson { casimirs, .. } => casimirs,
            _ => &[],
        }
    }

    fn expected(&mut self, written: &DraftValue, scope: &mut Scope) -> Option<ExpectedValue> {
        let formula = written.expression.as_ref();
        let expression = formula.and_then(|f| self.formula(scope, "an expected value", f));
        self.not_before_the_start(written.at.as_ref());
        self.tolerance(written.within.as_ref());
        let (formula, is) = (formula?, written.is.as_ref()?);
        let name =
            if written.name.is_empty() { formula.get_ref().clone() } else { written.name.clone() };
        Some(ExpectedValue {
            name,
            expression: expression?,
            at: *written.at.as_ref()?.get_ref(),
            is: *is.get_ref(),
            within: written.within.as_ref().map(|w| *w.get_ref()),
            source: written.source.clone(),
            place: is.span(),
        })
    }
}
