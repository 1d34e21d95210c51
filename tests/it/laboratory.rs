//! The lab with a motion that is computed, and what its pictures show: jobs are done where they are asked for.

use std::sync::Arc;

use phaselab::app::{App, AppEvent, Computation, Effect, Loaded};
use phaselab::diagnostic::Document;
use phaselab::experiment::{Experiment, Prepared};
use phaselab::instrument::{Layer, Picture, Plot};
use phaselab::job::Progress;

use crate::fixtures::{catalog, press};

pub(crate) fn prepared(text: &str) -> Prepared {
    Prepared::of(&Document::new("test", text)).unwrap_or_else(|error| panic!("{error}"))
}

/// The lab with a system whose motion it has not seen yet, and the motion.
pub(crate) fn open(ready: Prepared) -> (App, Experiment) {
    let mut begun = None;
    let loaded = Loaded::of("test".to_owned(), ready, |experiment| {
        begun.insert(experiment).set_epoch(1);
        1
    });
    let (mut app, _) = App::new(catalog(), Some("test"));
    app.jobs.in_background = true;
    let effects = app.update(AppEvent::Loaded(Ok(loaded)));
    finish(&mut app, effects);
    (app, begun.expect("an experiment"))
}

/// Does all jobs that are asked for, and those that follow; the other effects are returned.
pub(crate) fn finish(app: &mut App, mut effects: Vec<Effect>) -> Vec<Effect> {
    let mut others = Vec::new();
    while let Some(effect) = effects.pop() {
        match effect {
            Effect::Compute(Computation { ticket, job, .. }) => {
                let outcome = job.run(&Progress::new());
                effects.extend(app.update(AppEvent::Computed { ticket, outcome }));
            }
            other => others.push(other),
        }
    }
    others
}

/// Presses keys, and waits for the jobs.
pub(crate) fn typed(app: &mut App, keys: &str) -> Vec<Effect> {
    let effects = press(app, keys);
    finish(app, effects)
}

/// Takes the motion to a time, and shows it.
pub(crate) fn see(app: &mut App, experiment: &mut Experiment, time: f64) {
    experiment.advance(time, u64::MAX);
    let effects = app.update(AppEvent::Snapshot(Arc::new(experiment.snapshot())));
    finish(app, effects);
}

/// The first plot of a kind.
pub(crate) fn plot_named<'a>(app: &'a App, kind: &str) -> &'a Plot {
    let plots = &mut app.lab.as_ref().unwrap().plots.iter();
    plots.find(|plot| plot.kind.name() == kind).expect("a plot of this kind")
}

/// What a picture measures.
pub(crate) fn measured(app: &App, plot: &Plot, word: &str) -> Option<f64> {
    let lab = app.lab.as_ref().unwrap();
    let measure = plot.kind.measure(word).unwrap();
    (measure.value)(lab.context(plot, &lab.present().unwrap()))
}

/// A measure that has a value.
pub(crate) fn measure(app: &App, plot: &Plot, word: &str) -> f64 {
    measured(app, plot, word).unwrap()
}

pub(crate) fn layers(app: &App, plot: &Plot) -> Vec<Layer> {
    let lab = app.lab.as_ref().unwrap();
    match plot.kind.picture(lab.context(plot, &lab.present().unwrap()), [f64::NAN; 2]) {
        Some(Picture::Axes { layers, .. }) => layers.into_iter().map(|(_, layer)| layer).collect(),
        other => panic!("{other:?}"),
    }
}

/// The sentences in a picture.
pub(crate) fn legend(app: &App, plot: &Plot) -> String {
    let lines = layers(app, plot).into_iter().find_map(|layer| match layer {
        Layer::Legend(lines) => Some(lines),
        _ => None,
    });
    lines.unwrap().join("\n")
}

/// The first picture of the lab.
pub(crate) fn first(app: &App) -> &Plot {
    &app.lab.as_ref().unwrap().plots[0]
}
