//! Experiments: commands, gauges and records. There is no thread and no clock.

mod cancel;
mod checkpoint;
mod commands;
mod companions;
mod export;
mod gauges;
mod offsets;
mod passages;
mod record;
mod reverse;
mod rewind;
mod scrub;
mod verdicts;

use std::sync::Arc;

use phaselab::app::Loaded;
use phaselab::experiment::{AdvanceOutcome, Experiment, Gauge, Setup, Snapshot};
use phaselab::mechanics;
use phaselab::preset;
use phaselab::system::System;

use crate::fixtures::loaded;

/// More steps than any test needs.
pub(crate) const PLENTY: u64 = 10_000_000;

/// Builds an experiment from a file's text, with a setup changed by `change`.
pub(crate) fn build(text: &str, change: impl FnOnce(&mut Setup)) -> Experiment {
    let model = preset::read(text).unwrap_or_else(|diagnostics| panic!("{diagnostics:?}")).model;
    let equations = mechanics::derive(&model).expect("it derives");
    let system = System::compile(&model, &equations, &[]).expect("it compiles");
    let mut setup = Setup::of(&model);
    change(&mut setup);
    Experiment::new(&Arc::new(model), &Arc::new(equations), &system, setup)
        .expect("its method fits")
}

/// Builds an experiment from a shipped preset.
pub(crate) fn shipped(name: &str) -> Experiment {
    let Loaded { model, equations, system, .. } = loaded(name, 1);
    let setup = Setup::of(&model);
    Experiment::new(&model, &equations, &system, setup).expect("its method fits")
}

/// Advances an experiment to a time.
pub(crate) fn run(experiment: &mut Experiment, time: f64) {
    assert_eq!(experiment.advance(time, PLENTY), AdvanceOutcome::Arrived);
    assert_eq!(experiment.time(), time);
}

/// The current value of a channel.
pub(crate) fn value(experiment: &Experiment, name: &str) -> f64 {
    let place = experiment.system().channels().iter().position(|c| c.name == name);
    experiment.values()[place.unwrap_or_else(|| panic!("no channel {name}"))]
}

/// The gauge with this name.
pub(crate) fn gauge(snapshot: &Snapshot, name: &str) -> Gauge {
    let gauge = snapshot.gauges.iter().find(|gauge| gauge.name == name);
    gauge.unwrap_or_else(|| panic!("no gauge {name}")).clone()
}
