//! What happened on the way of a run.

use serde_json::{Map, Value, json};

use crate::experiment::Chronicle;
use crate::integrate::{Happening, Kind};
use crate::model::Model;

/// One object for each event and each blow, in time: name, time, and of a blow the jump of each
/// momentum (or variable) and the reaction of each constraint.
pub(super) fn of(model: &Model, happenings: &Chronicle) -> Vec<Value> {
    let moved = |i: usize| {
        let c = &model.coordinates[i];
        if model.is_poisson() { c.name.clone() } else { format!("p_{}", c.name) }
    };
    let multiplier = |k: usize| {
        let symbol = model.constraints[k].multiplier;
        model.pool.symbol_info(symbol).name.clone()
    };
    let object = |happening: &Happening| {
        let mut object = json!({ "name": happening.name, "t": happening.time });
        if let Kind::Blow { jump, reaction } = &happening.kind {
            let named = |name: &dyn Fn(usize) -> String, numbers: &[f64]| -> Map<String, Value> {
                numbers.iter().enumerate().map(|(i, &x)| (name(i), Value::from(x))).collect()
            };
            object["jump"] = named(&moved, jump).into();
            object["reaction"] = named(&multiplier, reaction).into();
        }
        object
    };
    happenings.iter().map(object).collect()
}
