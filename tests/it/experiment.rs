//! Experiments: what commands do, what gauges say, what is recorded. No thread, no clock.

mod cancel;
mod checkpoint;
mod commands;
mod export;
mod gauges;
mod record;
mod verdicts;

use std::sync::Arc;

use phaselab::experiment::{Experiment, Gauge, Progress, Setup, Snapshot};
use phaselab::mechanics;
use phaselab::preset::{self, Catalog};
use phaselab::system::System;

/// More steps than any test needs.
pub(crate) const PLENTY: u64 = 10_000_000;

/// An experiment of a file's text, set up as `change` says.
pub(crate) fn build(text: &str, change: impl FnOnce(&mut Setup)) -> Experiment {
    let model = preset::read(text).unwrap_or_else(|mistakes| panic!("{mistakes:?}")).model;
    let equations = mechanics::derive(&model).expect("it derives");
    let system = System::compile(&model, &equations, &[]).expect("it compiles");
    let mut setup = Setup::of(&model);
    change(&mut setup);
    Experiment::new(&Arc::new(model), &Arc::new(equations), &system, setup)
        .expect("its method fits")
}

/// An experiment of a shipped preset.
pub(crate) fn shipped(name: &str) -> Experiment {
    let document = Catalog::with_folder(None).find(name).expect("it is shipped");
    build(&document.text, |_| ())
}

/// Carries an experiment to a time.
pub(crate) fn run(experiment: &mut Experiment, time: f64) {
    assert_eq!(experiment.advance(time, PLENTY), Progress::Arrived);
    assert_eq!(experiment.time(), time);
}

/// The value of a channel now.
pub(crate) fn value(experiment: &Experiment, name: &str) -> f64 {
    let place = experiment.system().channels().iter().position(|c| c.name == name);
    experiment.values()[place.unwrap_or_else(|| panic!("no channel {name}"))]
}

/// The gauge of a name.
pub(crate) fn gauge(snapshot: &Snapshot, name: &str) -> Gauge {
    let gauge = snapshot.gauges.iter().find(|gauge| gauge.name == name);
    gauge.unwrap_or_else(|| panic!("no gauge {name}")).clone()
}
