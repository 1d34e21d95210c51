//! What was requested and is not there yet: a system, changes sent to the experiment, and plots that its text has to define.
//!
//! In: changes, snapshots. Out: what was requested last. Never here: how a change is made.

use super::{Saved, ValueId};
use crate::experiment::{Checkpoint, Snapshot};
use crate::instrument::{Plot, SavedPlot};
use crate::integrate::Settings;
use crate::system::InitialOverride;

#[derive(Clone, Debug)]
pub(super) struct LoadRequest {
    pub(super) name: String,
    /// Whether the lab is to open once it is loaded; otherwise it is only previewed.
    pub(super) opens: bool,
}

/// What was asked for and has not come yet.
#[derive(Clone, Debug, Default)]
pub(super) struct Awaited {
    /// The system requested last, until it is loaded.
    pub(super) system: Option<LoadRequest>,
    /// The session to resume once its system is loaded.
    pub(super) session: Option<Saved>,
    /// The motion that begins in the system of a name, if that is the one opened first.
    pub(super) start: Option<(String, Checkpoint)>,
    /// The view of a session that is restored once its text is right.
    pub(super) view: Option<AwaitedView>,
    /// The wrong file whose text was asked for, until its first error is shown.
    pub(super) wrong_file: Option<String>,
    pub(super) plots: AwaitedPlots,
}

/// A view that waits for a text with all that it shows.
#[derive(Clone, Debug)]
pub(super) struct AwaitedView {
    pub(super) saved: Saved,
    /// The pictures until then; where a person has chosen others, these stay.
    pub(super) until: Vec<SavedPlot>,
}

impl AwaitedView {
    /// Returns the session, if nobody has chosen other pictures than these meanwhile.
    pub(super) fn for_plots(&self, shown: &[SavedPlot]) -> Option<&Saved> {
        (self.until == shown).then_some(&self.saved)
    }
}

/// The plots that wait for the text with what they show.
#[derive(Clone, Debug, Default)]
pub(super) struct AwaitedPlots {
    /// The plot with a typed quantity on an axis.
    pub(super) axis: Option<TypedAxis>,
    /// The index of the plot that becomes a section.
    pub(super) section: Option<usize>,
}

impl AwaitedPlots {
    pub(super) fn any(&self) -> bool {
        self.axis.is_some() || self.section.is_some()
    }
}

/// A plot that waits for the text with the quantity that was typed for its next axis.
#[derive(Clone, Debug)]
pub(super) struct TypedAxis {
    pub(super) plot: usize,
    /// The plot so far, the name of each channel of its axes, and its label; nothing on the first axis.
    pub(super) begun: Option<(Plot, Vec<Vec<String>>, String)>,
    pub(super) name: String,
}

/// Changes sent to the experiment and not yet confirmed by a snapshot.
#[derive(Clone, Debug, Default)]
pub(super) struct PendingChanges {
    pub(super) values: Vec<(ValueId, f64)>,
    pub(super) speed: Option<f64>,
    pub(super) method: Option<&'static str>,
    pub(super) settings: Option<Settings>,
    pub(super) given: Option<Vec<InitialOverride>>,
}

impl PendingChanges {
    /// Removes the changes that a snapshot confirms; single values are compared by the lab.
    pub(super) fn see(&mut self, snapshot: &Snapshot) {
        self.speed.take_if(|value| *value == snapshot.speed);
        self.method.take_if(|value| *value == snapshot.method.name);
        self.settings.take_if(|value| *value == snapshot.setup.settings);
        self.given.take_if(|value| *value == snapshot.setup.overrides);
    }

    /// Returns the value that was requested last and is not confirmed.
    pub(super) fn value(&self, id: ValueId) -> Option<f64> {
        self.values.iter().find(|(other, _)| *other == id).map(|(_, value)| *value)
    }

    pub(super) fn set_value(&mut self, id: ValueId, value: f64) {
        self.values.retain(|(other, _)| *other != id);
        self.values.push((id, value));
    }
}
