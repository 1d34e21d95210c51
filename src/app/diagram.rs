//! The diagram over the selected parameter or initial value.
//!
//! In: the value that is selected. Out: the pane with its diagram. Never here: what is drawn in it.

use super::{App, Effect, Lab, Pane, ValueId};
use crate::expr::Expr;
use crate::instrument::{Physics, Plot, named};
use crate::model::Variation;

impl App {
    /// Shows what becomes of the motion over the range of the selected parameter or initial value.
    pub(super) fn show_diagram(&mut self) -> Vec<Effect> {
        let Some(lab) = &mut self.lab else { return Vec::new() };
        let over = match lab.selected() {
            Some(ValueId::Parameter(index)) => Variation::Parameter(index),
            Some(ValueId::Initial(index)) => Variation::Initial(index),
            None => {
                return self
                    .notify("A diagram is over a parameter or an initial value: choose one.");
            }
        };
        if matches!(over, Variation::Initial(_))
            && !lab.loaded.physics().model.constraints.is_empty()
        {
            return self.notify("Constraints tie the initial values together: choose a parameter.");
        }
        lab.show_over(over);
        if lab.is_always_regular() {
            return self.notify(
                "With one coordinate and a constant energy every motion is regular, and its exponent 0 except at a saddle: \
                 the frequency is shown, and Q shows the period.",
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

    /// Focuses the diagram over a parameter or an initial value, which takes the place of another one. Its surface of section is
    /// the first of the file; without one it is of the Lyapunov exponent, and where that is always 0, of the frequency.
    fn show_over(&mut self, over: Variation) {
        let name = if self.is_always_regular() { "frequency" } else { "diagram" };
        let Some(kind) = named(name) else { return };
        let physics = self.loaded.physics();
        let views = &physics.model.views;
        let of_file = views.iter().position(|view| view.over == [over]);
        let view = of_file.or_else(|| views.iter().position(|view| view.section.is_some()));
        let mut plot = Plot::new(kind, (Vec::new(), view), physics.model).opened(physics);
        plot.over = vec![over];
        let known = self.plots.iter().position(|shown| shown.kind == kind);
        let index = known.unwrap_or(self.plots.len());
        match self.plots.get(index) {
            Some(shown) if shown.over == plot.over => {}
            Some(_) => self.redraw(index, |shown, _| *shown = plot),
            None => self.plots.push(plot),
        }
        self.focus.pane = Pane::Plot(index);
        self.answers.stale = true;
    }
}
