//! Panes focused by their names, as scripts and lessons name them.
//!
//! In: a name. Out: the pane in view. Never here: the keys that lead from pane to pane.

use super::{App, Pane};

/// The names of the lists.
const LISTS: [(&str, Pane); 4] = [
    ("parameters", Pane::Parameters),
    ("initial", Pane::Initial),
    ("gauges", Pane::Gauges),
    ("law", Pane::Law),
];

impl App {
    /// The names by which the panes of the loaded system can be focused: the kinds of its pictures, and its lists.
    pub fn names_of_panes(&self) -> Vec<&str> {
        let plots = self.lab.iter().flat_map(|lab| lab.plots.iter().map(|plot| plot.kind.name()));
        let mut names: Vec<&str> = plots.chain(LISTS.map(|(name, _)| name)).collect();
        let all = names.clone();
        let mut place = 0..;
        names.retain(|name| place.next().is_some_and(|place| !all[..place].contains(name)));
        names
    }

    /// Where there is room for one pane only, shows the parameters.
    pub fn show_parameters(&mut self) {
        if let Some(lab) = self.lab.as_mut().filter(|lab| lab.drawn.single) {
            lab.focus.choose(Pane::Parameters);
        }
    }

    /// Focuses a pane by its name, a picture by its kind, and brings it into view. Returns whether it is there.
    pub fn focus_on(&mut self, name: &str) -> bool {
        let Some(lab) = &mut self.lab else { return false };
        let plot = lab.plots.iter().position(|plot| plot.kind.name() == name).map(Pane::Plot);
        let list = || LISTS.iter().find(|(list, _)| *list == name).map(|(_, pane)| *pane);
        let Some(pane) = plot.or_else(list) else { return false };
        lab.focus.choose(pane);
        true
    }
}
