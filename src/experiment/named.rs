//! Numbers by names: initial values as expressions name them.
//!
//! In: a model, an initial value or a name. Out: the other. Never here: what the names are kept for.

use serde::{Deserialize, Serialize};

use crate::model::Model;
use crate::system::InitialOverride;

/// A named number.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Named {
    /// As expressions have it.
    pub name: String,
    /// The number.
    pub value: f64,
}

/// Names an initial value as expressions do.
pub(super) fn named(model: &Model, given: InitialOverride) -> Option<Named> {
    let (index, value) = match given {
        InitialOverride::Position(i, x)
        | InitialOverride::Velocity(i, x)
        | InitialOverride::Momentum(i, x) => (i, x),
    };
    let name = &model.coordinates.get(index)?.name;
    let name = match given {
        InitialOverride::Position(..) => name.clone(),
        InitialOverride::Velocity(..) => format!("{name}'"),
        InitialOverride::Momentum(..) => format!("p_{name}"),
    };
    Some(Named { name, value })
}

/// Finds the initial value of a name, if the model has it.
pub(super) fn given(model: &Model, named: &Named) -> Option<InitialOverride> {
    let place = |name: &str| model.coordinates.iter().position(|c| c.name == name);
    let (name, value) = (named.name.as_str(), named.value);
    if let Some(i) = place(name) {
        return Some(InitialOverride::Position(i, value));
    }
    if model.is_poisson() {
        return None;
    }
    if let Some(i) = name.strip_suffix('\'').and_then(place) {
        return Some(InitialOverride::Velocity(i, value));
    }
    let i = name.strip_prefix("p_").and_then(place)?;
    Some(InitialOverride::Momentum(i, value))
}
