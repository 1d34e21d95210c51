//! Which pane gets the focus: the next one in view, the next tab of a frame, or one by its name, as scripts and lessons name them.
//!
//! In: a direction, or a name. Out: the pane in view. Never here: where a pane is, or its keys.

use super::{App, Lab, Pane};

const LISTS: [(&str, Pane); 4] = [
    ("parameters", Pane::Parameters),
    ("initial", Pane::Initial),
    ("gauges", Pane::Gauges),
    ("law", Pane::Law),
];

impl Lab {
    /// The pane that Tab leads to, or Shift-Tab: among those in view, in the order of their places. Where one pane is in view, it leads through all.
    pub(super) fn pane_beside(&self, forwards: bool) -> Pane {
        let all: Vec<Pane> = self.panes().collect();
        let seen: Vec<Pane> = self.drawn.in_view.iter().filter(|pane| all.contains(pane)).collect();
        turned(if seen.len() > 1 { &seen } else { &all }, self.focus.pane, forwards)
    }

    /// Brings the next pane that is out of view to the front, or the one before it.
    pub fn show_hidden(&mut self, forwards: bool) {
        let all: Vec<Pane> = self.panes().collect();
        let mut pane = self.focus.pane;
        for _ in &all {
            pane = turned(&all, pane, forwards);
            if !self.drawn.in_view.has(pane) {
                self.focus.choose(pane);
                return;
            }
        }
    }

    /// The pane that follows in the frame in which several of the kind of the focused one take turns, or else in that of the
    /// other kind. `None` if each has a frame of its own.
    pub(super) fn next_tab(&self) -> Option<Pane> {
        let plots = matches!(self.focus.pane, Pane::Plot(_));
        self.next_tab_among(plots).or_else(|| self.next_tab_among(!plots))
    }

    fn next_tab_among(&self, plots: bool) -> Option<Pane> {
        let is_plot = |pane: &Pane| matches!(pane, Pane::Plot(_));
        let in_view = |pane: &Pane| self.drawn.in_view.has(*pane);
        let of_kind = |pane: &Pane| is_plot(pane) == plots;
        // the last picture takes turns with those out of view, and so does the list that is not the gauges
        let seen: Vec<Pane> = self.drawn.in_view.iter().filter(of_kind).collect();
        let list = seen.iter().find(|pane| **pane != Pane::Gauges && !plots);
        let host = *list.or(seen.last())?;
        let ring: Vec<Pane> = self
            .panes()
            .filter(|pane| of_kind(pane) && (*pane == host || !in_view(pane)))
            .collect();
        // what was turned to before anything was drawn is turned on
        let from = if ring.contains(&self.focus.pane) { self.focus.pane } else { host };
        (ring.len() > 1).then(|| turned(&ring, from, true))
    }
}

/// The pane after this one, or before it; the first, or the last, if it is not among them.
fn turned(panes: &[Pane], from: Pane, forwards: bool) -> Pane {
    let count = panes.len();
    let at = panes.iter().position(|pane| *pane == from);
    let to = match (at, forwards) {
        (Some(at), true) => (at + 1) % count,
        (Some(at), false) => (at + count - 1) % count,
        (None, true) => 0,
        (None, false) => count - 1,
    };
    panes[to]
}

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
