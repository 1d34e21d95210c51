//! The occurrences of a run, written one by one because there may be a million of them.

use std::sync::Arc;

use serde::{Serialize, Serializer};
use serde_json::{Map, Value, json};

use crate::experiment::EventLog;
use crate::integrate::{Occurrence, OccurrenceKind};
use crate::model::Model;

/// The events and impulses of a run.
#[derive(Clone, Debug)]
pub(super) struct Events {
    /// `None` if nothing is known of them.
    of: Option<(Arc<Model>, EventLog)>,
}

impl Events {
    pub(super) fn of(model: &Arc<Model>, occurrences: &EventLog) -> Events {
        Events { of: Some((Arc::clone(model), occurrences.clone())) }
    }

    pub(super) fn unknown() -> Events {
        Events { of: None }
    }

    /// One object for each event and impulse, in order of time: name and time, and for an impulse the jump of each
    /// momentum (or variable) and the reaction of each constraint.
    pub(super) fn iter(&self) -> impl Iterator<Item = Value> {
        self.of.iter().flat_map(|(model, occurrences)| {
            occurrences.iter().map(move |occurrence| Events::object(model, occurrence))
        })
    }

    fn object(model: &Model, occurrence: &Occurrence) -> Value {
        let mut object = json!({ "name": occurrence.name, "t": occurrence.time });
        if let OccurrenceKind::Impulse { jump, reaction } = &occurrence.kind {
            let moved = |i: usize| {
                let c = &model.coordinates[i];
                if model.is_poisson() { c.name.clone() } else { format!("p_{}", c.name) }
            };
            let multiplier = |k: usize| {
                let symbol = model.constraints[k].multiplier;
                model.pool.symbol_info(symbol).name.clone()
            };
            let named = |name: &dyn Fn(usize) -> String, numbers: &[f64]| -> Map<String, Value> {
                numbers.iter().enumerate().map(|(i, &x)| (name(i), Value::from(x))).collect()
            };
            object["jump"] = named(&moved, jump).into();
            object["reaction"] = named(&multiplier, reaction).into();
        }
        object
    }
}

impl Serialize for Events {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.iter())
    }
}
