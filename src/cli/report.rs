//! What a run reports besides its rows: the setup before them and the outcome after them. The field names are the
//! keys of the JSON and do not change.

use serde::Serialize;
use serde_json::{Map, Value};

use super::events::Events;
use crate::printable;

/// The report before the rows.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Header {
    /// The version of the program.
    pub(super) phaselab: &'static str,
    /// The system's title.
    pub(super) title: String,
    pub(super) parameters: Map<String, Value>,
    /// The method and its settings.
    pub(super) method: Map<String, Value>,
    /// The names of the columns.
    pub(super) columns: Vec<String>,
}

impl Header {
    /// The members of a report that come first: version, title, parameters, method.
    pub(super) fn members(&self) -> Map<String, Value> {
        let mut members = Map::new();
        members.insert("phaselab".to_owned(), self.phaselab.into());
        members.insert("title".to_owned(), self.title.clone().into());
        members.insert("parameters".to_owned(), self.parameters.clone().into());
        members.insert("method".to_owned(), self.method.clone().into());
        members
    }

    /// The same as `#` lines before comma-separated values.
    pub(super) fn lines(&self) -> String {
        let fields = |fields: &Map<String, Value>| {
            let fields = fields.iter().map(|(key, value)| match value {
                Value::String(text) => format!("{key}={text}"),
                other => format!("{key}={other}"),
            });
            fields.collect::<Vec<_>>().join(" ")
        };
        format!(
            "# phaselab {}: {}\n# parameters: {}\n# method: {}\n",
            self.phaselab,
            one_line(&self.title),
            fields(&self.parameters),
            fields(&self.method)
        )
    }
}

/// Removes line breaks, because a `#` line must remain one line.
pub(super) fn one_line(text: &str) -> String {
    printable::line(&text.split_whitespace().collect::<Vec<_>>().join(" ")).into_owned()
}

/// The report after the rows.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Closing {
    /// The quantities that should have been constant, with their drift.
    pub(super) invariants: Vec<Invariant>,
    /// The events and impulses.
    pub(super) events: Events,
    /// How the run ended.
    pub(super) status: RunStatus,
    /// Why the run ended, if that needs a sentence.
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
    /// Its value at the end; impulses may change it without counting as drift.
    #[serde(rename = "final")]
    pub(super) last: f64,
    /// Its greatest distance from the initial value over all steps, relative to the moving part of its terms. The
    /// jumps of impulses do not count. Not a number (`null`) where the terms underflow.
    pub(super) max_drift: f64,
    /// `exact`, `bounded`, `secular`, `lost`, `not conserved`, `open`, `unknown`, `other branch`, `adiabatic`.
    pub(super) verdict: &'static str,
}

/// How a run ended.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum RunStatus {
    /// The run reached its end.
    Completed,
    /// An event or the user stopped it.
    Stopped,
    /// The motion could not continue.
    #[serde(rename = "faulted")]
    Failed,
}

impl RunStatus {
    pub(super) fn word(self) -> &'static str {
        match self {
            RunStatus::Completed => "completed",
            RunStatus::Stopped => "stopped",
            RunStatus::Failed => "faulted",
        }
    }
}
