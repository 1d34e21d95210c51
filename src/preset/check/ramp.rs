//! Ramps: parameters that change with the time.
//!
//! In: ramps as written. Out: the model's parameters as functions of the time, which every expression but those of initial
//! values is read with. Never here: what follows from a law that depends on the time.

use super::ModelBuilder;
use crate::diagnostic::{Diagnostic, nearest};
use crate::expr::{Expr, Symbol};
use crate::model::{Allowed, Model, RampForm, RampPart, Scope};
use crate::preset::draft::{Draft, DraftRamp};

impl ModelBuilder<'_> {
    /// Reads the ramps, after the parameters and before whatever uses them.
    pub(super) fn ramps(&mut self, draft: &Draft) {
        let mut ways: Vec<(Symbol, Vec<RampPart>)> = Vec::new();
        for written in &draft.ramps {
            let Some((symbol, part)) = self.ramp(written) else { continue };
            if draft.body.is_some() {
                let place = written.parameter.as_ref().map_or(0..0, toml::Spanned::span);
                self.error(place, "a parameter cannot change with the time beside a [body]");
            }
            match ways.iter_mut().find(|(known, _)| *known == symbol) {
                Some((_, parts)) => parts.push(part),
                None => ways.push((symbol, vec![part])),
            }
        }
        let time = self.model.symbols.time;
        // names that come later in the file are not in the pool yet
        let taken = |name: &str| {
            let definitions = draft.definitions.iter().map(|(name, _)| name);
            let observables = draft.observables.iter().filter_map(|o| o.name.as_ref());
            let new = draft.transformations.iter().flat_map(|t| t.new.iter());
            let generators = draft.generators.iter().filter_map(|g| g.name.as_ref());
            let mut all = definitions.chain(observables).chain(new).chain(generators);
            all.any(|other| other.get_ref() == name)
        };
        let Model { ramped, pool, parameters, .. } = &mut self.model;
        for (symbol, parts) in ways {
            let named = parameters.iter().find(|p| p.symbol == symbol && self.keeps_ramps).cloned();
            match named {
                Some(named) => parameters.extend(ramped.keep(pool, time, (&named, &parts), &taken)),
                None => ramped.lead(pool, time, symbol, &parts),
            }
        }
    }

    fn ramp(&mut self, written: &DraftRamp) -> Option<(Symbol, RampPart)> {
        let form = written.form.as_ref().map_or(Some(RampForm::Smooth), |form| {
            let known = RampForm::NAMED.iter().find(|(name, _)| name == form.get_ref());
            if known.is_none() {
                let names = RampForm::NAMED.map(|(name, _)| name);
                let help = match nearest(form.get_ref(), names) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => "a ramp is `smooth`, `cubic` or `linear`".to_owned(),
                };
                let message = format!("unknown ramp form `{}`", form.get_ref());
                self.diagnostics.push(Diagnostic::error(form.span(), message).with_help(help));
            }
            known.map(|(_, form)| *form)
        });
        let name = written.parameter.as_ref()?;
        let known = self.model.parameters.iter().find(|p| p.name == *name.get_ref());
        let symbol = known.map(|parameter| parameter.symbol);
        if symbol.is_none() {
            let names = self.model.parameters.iter().map(|p| p.name.as_str());
            let diagnostic =
                Diagnostic::error(name.span(), format!("unknown parameter `{}`", name.get_ref()));
            self.diagnostics.push(match nearest(name.get_ref(), names) {
                Some(near) => diagnostic.with_help(format!("did you mean `{near}`?")),
                None => diagnostic.with_help("give it a value in [parameters]"),
            });
        }
        let mut scope = Scope::new(&self.model, Allowed::Parameters, "a ramp");
        let mut read = |check: &mut Self, formula: &Option<_>| match formula {
            Some(formula) => check.formula(&mut scope, "a ramp", formula),
            None => Some(Expr::ZERO),
        };
        let [to, start, duration] =
            [&written.to, &written.start, &written.duration].map(|formula| read(self, formula));
        let written = [&written.to, &written.start, &written.duration];
        for (formula, e) in written.iter().zip([to, start, duration]) {
            let depends = |e: &Expr| symbol.is_some_and(|s| self.model.pool.depends(*e, s));
            if let (Some(formula), true) = (formula, e.as_ref().is_some_and(depends)) {
                let message = format!("the ramp of `{}` may not depend on it", name.get_ref());
                let help = "write a number, or another parameter";
                self.diagnostics.push(Diagnostic::error(formula.span(), message).with_help(help));
                return None;
            }
        }
        let part = RampPart { to: to?, start: start?, duration: duration?, form: form? };
        let place = written[2].as_ref()?;
        if self.finite(part.duration, "the duration of this ramp", place)
            && self.at_start(part.duration) <= 0.0
        {
            self.error(place.span(), "the duration of a ramp must be above zero");
            return None;
        }
        Some((symbol?, part))
    }
}
