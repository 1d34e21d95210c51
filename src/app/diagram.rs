//! The diagram over the selected parameter.
//!
//! In: the parameter that is selected. Out: the pane with its diagram. Never here: what is drawn in it.

use super::{App, Effect, Lab, Pane, ValueId};
use crate::expr::Expr;
use crate::instrument::{Physics, Plot, named};
use crate::model::Variation;

impl App {
    /// Shows what becomes of the motion over the range of the selected parameter.
    pub(super) fn show_diagram(&mut self) -> Vec<Effect> {
        let Some(lab) = &mut self.lab else { return Vec::new() };
        let Some(ValueId::Parameter(over)) = lab.selected() else {
            return self.notify("A diagram is over a parameter: choose one.");
        };
        lab.show_over(over);
        if lab.is_always_regular() {
            return self.notify(
                "With one coordinate and a constant energy every motion is regular: the exponent is 0, except at a saddle.",
            );
        }
        Vec::new()
    }
}

impl Lab {
    /// Whether there is nothing but regular motion, whatever the parameters, and no section that shows more of it.
    fn is_always_regular(&self) -> bool {
        let Physics { model, equations, .. } = self.loaded.physics();
        model.coordinates.len() == 1
            && model.impulses.is_empty()
            && model.sections.is_empty()
            && equations.energy_rate == Expr::ZERO
    }

    /// Focuses the diagram over a parameter, which takes the place of another one. Its surface of section is the first of
    /// the file; without one it is of the Lyapunov exponent.
    fn show_over(&mut self, over: usize) {
        let Some(kind) = named("diagram") else { return };
        let physics = self.loaded.physics();
        let views = &physics.model.views;
        let of_file = views.iter().position(|view| view.over == [Variation::Parameter(over)]);
        let view = of_file.or_else(|| views.iter().position(|view| view.section.is_some()));
        let mut plot = Plot::new(kind, (Vec::new(), view), physics.model).opened(physics);
        plot.over = vec![Variation::Parameter(over)];
        let known = self.plots.iter().position(|shown| shown.kind == kind);
        let index = known.unwrap_or(self.plots.len());
        match self.plots.get(index) {
            Some(shown) if shown.over == plot.over => {}
            Some(_) => self.redraw(index, |shown, _| *shown = plot),
            None => self.plots.push(plot),
        }
        self.focus = Pane::Plot(index);
        self.answers.stale = true;
    }
}
