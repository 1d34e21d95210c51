//! What happened on the way of a run, written one by one: there may be a million of them.

use std::sync::Arc;

use serde::{Serialize, Serializer};
use serde_json::{Map, Value, json};

use crate::experiment::Chronicle;
use crate::integrate::{Happening, Kind};
use crate::model::Model;

/// The events and blows of a run.
#[derive(Clone, Debug)]
pub(super) struct Events {
    model: Arc<Model>,
    happenings: Chronicle,
}

impl Events {
    pub(super) fn of(model: &Arc<Model>, happenings: &Chronicle) -> Events {
        Events { model: Arc::clone(model), happenings: happenings.clone() }
    }

    /// One object for each event and each blow, in time: name, time, and of a blow the jump of each
    /// momentum (or variable) and the reaction of each constraint.
    pub(super) fn iter(&self) -> impl Iterator<Item = Value> {
        self.happenings.iter().map(|happening| self.object(happening))
    }

    fn object(&self, happening: &Happening) -> Value {
        let model = &self.model;
        let mut object = json!({ "name": happening.name, "t": happening.time });
        if let Kind::Blow { jump, reaction } = &happening.kind {
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
