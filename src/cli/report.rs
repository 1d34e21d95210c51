//! What a run tells beside its rows: what was run before them, how it went after them. The field
//! names are the keys of the JSON and do not change.

use serde::Serialize;
use serde_json::{Map, Value};

use super::events::Events;

/// What stands before the rows.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Header {
    /// The version of the program.
    pub(super) phaselab: &'static str,
    /// The system's title.
    pub(super) title: String,
    /// Every parameter and its value.
    pub(super) parameters: Map<String, Value>,
    /// The method and its settings.
    pub(super) method: Map<String, Value>,
    /// The names of the columns.
    pub(super) columns: Vec<String>,
}

/// What stands after the rows.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Closing {
    /// What should have stayed constant, and how well it did.
    pub(super) invariants: Vec<Invariant>,
    /// What happened on the way.
    pub(super) events: Events,
    /// How it ended.
    pub(super) status: Status,
    /// Why it ended, where that needs a sentence.
    pub(super) message: Option<String>,
}

/// One invariant over the whole run.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Invariant {
    /// `energy`, `p_phi`, an observable's name.
    pub(super) name: String,
    /// Why it should be constant.
    pub(super) reason: String,
    /// Its value at the start.
    pub(super) initial: f64,
    /// Its value at the end; with impulses it may be another, and drift is what there is beside them.
    #[serde(rename = "final")]
    pub(super) last: f64,
    /// Its greatest distance from the initial value over all steps, relative to what of its terms moves; what impulses
    /// give does not count.
    pub(super) max_drift: f64,
    /// `exact`, `bounded`, `secular`, `lost`, `broken by the physics`, `open`.
    pub(super) verdict: &'static str,
}

/// How a run ended.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Status {
    /// At its end.
    Completed,
    /// Where an event or the user stopped it.
    Stopped,
    /// Where it could not go on.
    #[serde(rename = "faulted")]
    Failed,
}

impl Status {
    /// The word for it.
    pub(super) fn word(self) -> &'static str {
        match self {
            Status::Completed => "completed",
            Status::Stopped => "stopped",
            Status::Failed => "faulted",
        }
    }
}
