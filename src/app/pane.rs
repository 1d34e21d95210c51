//! The panes of the lab, which of them has the focus, and what is selected in their lists.
//!
//! In: nothing. Out: [`Pane`]s by name, the [`Focus`]. Never here: where a pane is, or what it shows.

use serde::{Deserialize, Serialize};

/// A pane of the lab.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Pane {
    /// A picture, by its index among the plots.
    Plot(usize),
    /// The list of what can be changed while the system runs.
    Parameters,
    /// The initial values.
    Initial,
    /// The list of conserved quantities and their drifts.
    Gauges,
    /// The law of motion, which has the focus only where not all of it is in view.
    Law,
}

/// The selected lines of the lists.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Selection {
    /// Among the parameters.
    pub parameter: usize,
    /// Among the initial values.
    pub initial: usize,
    /// Among the gauges.
    pub gauge: usize,
}

/// The pane with the keyboard focus, and the pictures that had it.
#[derive(Clone, Debug)]
pub struct Focus {
    /// The focused pane.
    pub pane: Pane,
    /// Whether that pane is zoomed to fill the page.
    pub zoomed: bool,
    /// The indices of the pictures that were focused, the last one first.
    pub recent: Vec<usize>,
    /// Whether no key has been pressed yet: the focus is where the program put it.
    pub untouched: bool,
}

impl Default for Focus {
    fn default() -> Self {
        Self { pane: Pane::Parameters, zoomed: false, recent: Vec::new(), untouched: true }
    }
}

impl Focus {
    /// Focuses a pane that was asked for; of the pictures it is then the one focused last.
    pub(super) fn choose(&mut self, pane: Pane) {
        (self.pane, self.untouched) = (pane, false);
        if let Pane::Plot(index) = pane {
            self.bring_to_front(index);
        }
    }

    /// Remembers a picture as the one focused last.
    pub fn bring_to_front(&mut self, index: usize) {
        self.recent.retain(|other| *other != index);
        self.recent.insert(0, index);
    }
}
