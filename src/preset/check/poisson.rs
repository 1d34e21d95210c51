//! Brackets of variables, made antisymmetric, and Casimirs. Whether the Jacobi identity holds, and
//! whether a Casimir is one, is not checked here.

use toml::Spanned;

use super::ModelBuilder;
use super::names::Names;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::SourceRange;
use crate::diagnostic::nearest;
use crate::expr::Expr;
use crate::model::{Allowed, Scope};
use crate::preset::draft::{DraftBracket, NamedFormula};

impl ModelBuilder<'_> {
    /// {x_i, x_j} for all i and j; zero if the file gives none.
    pub(super) fn brackets(&mut self, written: &[DraftBracket]) -> Vec<Vec<Expr>> {
        let count = self.model.coordinates.len();
        let mut scope = Scope::new(&self.model, Allowed::Poisson, "a bracket");
        let mut matrix = vec![vec![Expr::ZERO; count]; count];
        let mut given: Vec<Vec<Option<SourceRange>>> = vec![vec![None; count]; count];
        for bracket in written {
            let value = self.formula(&mut scope, "a bracket", &bracket.value);
            let [first, second] = &bracket.pair;
            let (i, j) = (self.variable(first), self.variable(second));
            let (Some(i), Some(j)) = (i, j) else { continue };
            if let Some(before) = &given[i][j] {
                let message = format!(
                    "the bracket of `{}` and `{}` is given twice",
                    first.get_ref(),
                    second.get_ref()
                );
                let help = "{b, a} is -{a, b}: one of them gives both";
                let diagnostic = Diagnostic::error(bracket.place.clone(), message).with_help(help);
                self.diagnostics.push(diagnostic.with_also(before.clone(), "the first time"));
                continue;
            }
            given[i][j] = Some(bracket.place.clone());
            given[j][i] = Some(bracket.place.clone());
            let Some(value) = value else { continue };
            if i != j {
                matrix[i][j] = value;
                matrix[j][i] = self.model.pool.neg(value);
            } else if value != Expr::ZERO {
                let message = format!("the bracket of `{}` with itself is 0", first.get_ref());
                let diagnostic = Diagnostic::error(bracket.value.span(), message);
                self.diagnostics
                    .push(diagnostic.with_help("brackets are antisymmetric: leave it out"));
            }
        }
        matrix
    }

    fn variable(&mut self, name: &Spanned<String>) -> Option<usize> {
        let found = self.model.coordinate(name.get_ref());
        if found.is_none() {
            let known: Vec<&str> = self.model.coordinates.iter().map(|c| c.name.as_str()).collect();
            let help = match nearest(name.get_ref(), known.iter().copied()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("the variables are {}", known.join(", ")),
            };
            let message = format!("unknown variable `{}`", name.get_ref());
            self.diagnostics.push(Diagnostic::error(name.span(), message).with_help(help));
        }
        found
    }

    /// Reads the expressions that the file declares as Casimirs.
    pub(super) fn casimirs(
        &mut self,
        written: &[NamedFormula],
        names: &mut Names,
    ) -> Vec<(String, Expr, SourceRange)> {
        let mut scope = Scope::new(&self.model, Allowed::Casimir, "a Casimir");
        let mut all = Vec::new();
        for (name, formula) in written {
            let read = formula.as_ref().and_then(|f| self.formula(&mut scope, "a Casimir", f));
            if let Some(shown) = self.name_shown(name, "a Casimir", read, names) {
                let place = formula.as_ref().map_or(name.span(), Spanned::span);
                // one that cannot be read is replaced by its own symbol, so that its uses are not
                // reported as well
                let e = read.unwrap_or_else(|| self.model.pool.named(&shown));
                all.push((shown, e, place));
            }
        }
        all
    }
}
