//! The diagram over the selected parameter.
//!
//! In: the parameter that is selected. Out: the pane with its diagram. Never here: what is drawn in it.

use super::{App, Effect, Lab, Pane, ValueId};
use crate::instrument::{Plot, named};
use crate::model::Variation;

impl App {
    /// Shows what becomes of the motion over the range of the selected parameter.
    pub(super) fn show_diagram(&mut self) -> Vec<Effect> {
        let Some(lab) = &mut self.lab else { return Vec::new() };
        let Some(ValueId::Parameter(over)) = lab.selected() else {
            return self.notify("A diagram is over a parameter: choose one.");
        };
        lab.show_over(over);
        Vec::new()
    }
}

impl Lab {
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
