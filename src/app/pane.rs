//! The panes of the lab, and what is selected in their lists.
//!
//! In: nothing. Out: [`Pane`]s by name. Never here: where a pane is, or what it shows.

use serde::{Deserialize, Serialize};

/// A pane of the lab.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Pane {
    /// A picture, by its index among the plots.
    Plot(usize),
    /// The parameters.
    Parameters,
    /// The initial values.
    Initial,
    /// The gauges.
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
