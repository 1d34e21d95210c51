//! The names of equilibria: their coordinates found, their places read.

use super::ModelBuilder;
use super::names::report_twice;
use crate::diagnostic::{Diagnostic, nearest};
use crate::model::{Allowed, NamedEquilibrium, Scope};
use crate::preset::draft::DraftEquilibrium;

impl ModelBuilder<'_> {
    /// Reads the names of equilibria and where these are, by the parameters.
    pub(super) fn equilibria(&mut self, written: &[DraftEquilibrium]) {
        let mut scope = Scope::new(&self.model, Allowed::Parameters, "the place of an equilibrium");
        let mut taken: Vec<&toml::Spanned<String>> = Vec::new();
        for one in written {
            let mut near = Vec::new();
            for (coordinate, formula) in &one.near {
                let Some(formula) = formula else { continue };
                let e = self.formula(&mut scope, "the place of an equilibrium", formula);
                let all = &self.model.coordinates;
                let index = all.iter().position(|c| c.name == *coordinate.get_ref());
                match (index, e) {
                    (Some(index), Some(e)) => near.push((index, e)),
                    (None, _) => {
                        let names: Vec<&str> = all.iter().map(|c| c.name.as_str()).collect();
                        let help = match nearest(coordinate.get_ref(), names.iter().copied()) {
                            Some(near) => format!("did you mean `{near}`?"),
                            None => format!("the coordinates are {}", names.join(", ")),
                        };
                        let message = format!("unknown coordinate `{}`", coordinate.get_ref());
                        let error = Diagnostic::error(coordinate.span(), message);
                        self.diagnostics.push(error.with_help(help));
                    }
                    (Some(_), None) => {}
                }
            }
            let Some(name) = &one.name else { continue };
            if let Some(first) = taken.iter().find(|first| first.get_ref() == name.get_ref()) {
                report_twice(name, first.span(), "an equilibrium", self.diagnostics);
            }
            taken.push(name);
            self.model.equilibria.push(NamedEquilibrium { name: name.get_ref().clone(), near });
        }
    }
}
