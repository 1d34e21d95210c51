//! The incorrect mechanics for comparison: as many velocities to eliminate as there are
//! constraints. Whether the constraints can be solved for them is not checked here.

use toml::Spanned;

use super::ModelBuilder;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::nearest;
use crate::expr::{Rank, latex_of_unicode};
use crate::model::Comparison;
use crate::preset::draft::DraftComparison;

impl ModelBuilder<'_> {
    /// Declares the other motion: `other_x` and `other_x'` of every coordinate, shown as `x (wrong)`.
    pub(super) fn comparison(&mut self, written: &DraftComparison) {
        let mut symbols = Vec::new();
        for c in &self.model.coordinates {
            let pool = &mut self.model.pool;
            let wrong = |latex: &str| format!("{latex}\\text{{ (wrong)}}");
            let shown = format!("{} (wrong)", c.shown);
            let position = pool.symbol(&format!("other_{}", c.name));
            pool.describe(position, &shown, &wrong(&latex_of_unicode(&c.shown)), Rank::Variable);
            let rate = pool.symbol_info(c.velocity);
            let (shown, latex) = (format!("{} (wrong)", rate.unicode), wrong(&rate.latex));
            let velocity = pool.symbol(&format!("other_{}'", c.name));
            pool.describe(velocity, &shown, &latex, Rank::Rate);
            symbols.push((position, velocity));
        }
        let mut eliminate = Vec::new();
        let mut seen: Vec<&Spanned<String>> = Vec::new();
        for name in &written.eliminate {
            match self.model.coordinate(name.get_ref()) {
                Some(index) => match seen.iter().find(|n| n.get_ref() == name.get_ref()) {
                    Some(first) => {
                        let message = format!("`{}` is eliminated twice", name.get_ref());
                        let diagnostic = Diagnostic::error(name.span(), message);
                        self.diagnostics.push(diagnostic.with_also(first.span(), "the first time"));
                    }
                    None => eliminate.push(index),
                },
                None => self.diagnostics.push(self.not_eliminated(name)),
            }
            seen.push(name);
        }
        let place = if written.list == (0..0) { &written.place } else { &written.list }.clone();
        self.model.comparison = Some(Comparison { eliminate, symbols, place });
    }

    fn not_eliminated(&self, name: &Spanned<String>) -> Diagnostic {
        let known: Vec<&str> = self.model.coordinates.iter().map(|c| c.name.as_str()).collect();
        let message = format!("unknown coordinate `{}`", name.get_ref());
        Diagnostic::error(name.span(), message).with_help(
            match nearest(name.get_ref().trim_end_matches('\''), known.iter().copied()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("the coordinates are {}", known.join(", ")),
            },
        )
    }

    /// A comparison eliminates as many velocities as there are constraints.
    pub(super) fn compared(&mut self, written: &DraftComparison) {
        let constraints = self.model.constraints.len();
        if constraints == 0 || !self.model.is_lagrangian() {
            let message = "there is nothing to compare: the file has no constraints";
            let help = "[comparison] puts the [[constraints]] of a Lagrangian into it";
            self.diagnostics
                .push(Diagnostic::error(written.place.clone(), message).with_help(help));
        } else if written.eliminate.len() != constraints && written.list != (0..0) {
            let count =
                |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
            let message = format!(
                "{} to eliminate for {}",
                count(written.eliminate.len(), "coordinate"),
                count(constraints, "constraint")
            );
            let help = "each constraint is solved for the velocity of one coordinate";
            self.diagnostics.push(Diagnostic::error(written.list.clone(), message).with_help(help));
        }
    }
}
