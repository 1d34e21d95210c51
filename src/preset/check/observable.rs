//! Observables in order, each with a unique name.

use toml::Spanned;

use super::ModelBuilder;
use super::names::Names;
use crate::expr::Expr;
use crate::model::{Allowed, Observable, Scope};
use crate::preset::draft::DraftObservable;

impl ModelBuilder<'_> {
    /// Reads the observables in order; each may use those above it.
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
            // one that cannot be read is replaced by its own symbol, so that its uses are not
            // reported as well
            let e = read.unwrap_or_else(|| self.model.pool.named(&name));
            scope.define(&name, e);
            let place = observable.conserved.as_ref().map(Spanned::span);
            let place = place.or(observable.name.as_ref().map(Spanned::span)).unwrap_or(0..0);
            let conserved = observable.conserved.as_ref().map(|c| *c.get_ref());
            let unit = observable.unit.clone();
            self.model.observables.push(Observable { name, expression: e, conserved, unit, place });
        }
    }

    /// Claims the name of an observable or Casimir. If it shows a definition under the definition's
    /// own name, it adds no second meaning.
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
            names.claim(written, kind, self.diagnostics);
        }
        Some(name.to_owned())
    }
}
