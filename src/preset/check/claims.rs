//! Observables and what the file claims: read and kept with their places, to be verified by
//! whoever has the motion.

use toml::Spanned;

use super::Check;
use super::names::Names;
use crate::expr::{Expr, nearest};
use crate::model::{Allowed, Expect, ExpectedValue, Mechanics, Observable, Place, Scope};
use crate::preset::draft::{DraftExpect, DraftObservable, DraftValue};
use crate::preset::mistake::Mistake;

/// The absolute tolerance of a claimed value where the file gives none.
const TOLERANCE: f64 = 1e-10;

impl Check<'_> {
    /// Observables in order; each may use those above it.
    pub(super) fn observables(&mut self, written: &[DraftObservable], names: &mut Names) {
        let mut scope = Scope::new(&self.model, Allowed::Observable, "an observable");
        for name in written.iter().filter_map(|o| o.name.as_ref()) {
            scope.announce(name.get_ref());
        }
        for observable in written {
            let read = observable
                .expression
                .as_ref()
                .and_then(|f| self.formula(&mut scope, "an observable", f));
            let Some(written) = &observable.name else { continue };
            let shown = self.name_shown(written, "an observable", read, names);
            let Some(name) = shown else { continue };
            // one that cannot be read stands for itself, so that its uses are no mistakes
            let e = read.unwrap_or_else(|| self.model.pool.named(&name));
            scope.define(&name, e);
            let place = observable.conserved.as_ref().map(Spanned::span);
            let place = place.or(observable.name.as_ref().map(Spanned::span)).unwrap_or(0..0);
            let conserved = observable.conserved.as_ref().map(|c| *c.get_ref());
            self.model.observables.push(Observable { name, expression: e, conserved, place });
        }
    }

    /// The name of an observable or Casimir, claimed for it. One that shows a definition under the
    /// definition's own name gives that name no second meaning.
    pub(super) fn name_shown(
        &mut self,
        written: &Spanned<String>,
        kind: &'static str,
        read: Option<Expr>,
        names: &mut Names,
    ) -> Option<String> {
        let name = written.get_ref().trim();
        if name.is_empty() || name.chars().any(char::is_control) {
            self.error(written.span(), format!("{kind} needs a name that can be shown"));
            return None;
        }
        let same = self.model.definitions.iter().any(|(n, e)| n == name && Some(*e) == read);
        let again = self.model.observables.iter().any(|o| o.name == name);
        if !(same && !again && names.kind(name) == Some("a definition")) {
            names.claim(written, kind, self.mistakes);
        }
        Some(name.to_owned())
    }

    /// What the file claims of the motion.
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
        self.model.expect = expect;
    }

    /// What a name in `conserves` stands for: `energy`, a momentum, an observable; or an
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
                        "name `energy`, a Casimir, or an observable".to_owned()
                    }
                    None => "name `energy`, a momentum p_..., or an observable".to_owned(),
                };
                self.mistakes.push(Mistake::error(claim.span(), message).with_help(help));
            }
        }
        None
    }

    /// The Casimirs of the file.
    fn casimirs_by_name(&self) -> &[(String, Expr, Place)] {
        match &self.model.mechanics {
            Mechanics::Poisson { casimirs, .. } => casimirs,
            _ => &[],
        }
    }

    fn expected(&mut self, written: &DraftValue, scope: &mut Scope) -> Option<ExpectedValue> {
        let formula = written.expression.as_ref();
        let expression = formula.and_then(|f| self.formula(scope, "an expected value", f));
        let start = self.model.run.start;
        if let Some(at) = written.at.as_ref().filter(|at| *at.get_ref() < start) {
            self.error(at.span(), format!("this is before the start, t = {start}"));
        }
        if let Some(within) = written.within.as_ref().filter(|w| *w.get_ref() < 0.0) {
            self.error(within.span(), "`within` is an absolute tolerance and must not be below 0");
        }
        let (formula, is) = (formula?, written.is.as_ref()?);
        let name =
            if written.name.is_empty() { formula.get_ref().clone() } else { written.name.clone() };
        Some(ExpectedValue {
            name,
            expression: expression?,
            at: *written.at.as_ref()?.get_ref(),
            is: *is.get_ref(),
            within: written.within.as_ref().map_or(TOLERANCE, |w| *w.get_ref()),
            source: written.source.clone(),
            place: is.span(),
        })
    }
}
