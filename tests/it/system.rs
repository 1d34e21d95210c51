//! From equations to numbers: the program and its two evaluators, states, conversions, channels.

mod channels;
mod images;
mod machine_code;
mod program;
mod rates;
mod series;
mod states;

use phaselab::mechanics::derive;
use phaselab::model::Model;
use phaselab::preset;
use phaselab::system::System;

/// The model and system of a file's text.
pub(crate) fn compile(text: &str) -> (Model, System) {
    let checked = preset::read(text).unwrap_or_else(|diagnostics| panic!("{diagnostics:?}"));
    let equations = derive(&checked.model).expect("small enough");
    let system = System::compile(&checked.model, &equations, &[]).expect("complete");
    (checked.model, system)
}

/// The parameters of a model.
pub(crate) fn parameters(model: &Model) -> Vec<f64> {
    model.parameter_values()
}
