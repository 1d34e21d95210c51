//! The picture of a motion whose time was reversed.

use std::sync::Arc;

use phaselab::app::{Computation, Effect, Event};
use phaselab::instrument::{Ink, Layer, Picture};
use phaselab::job::Progress;

use super::real::Real;
use crate::hand::key;

/// The line of what is expected lies near the curve, and is told from it by its colour.
#[test]
fn the_expected_return_error_has_a_colour_of_its_own() {
    let mut real = Real::of("pendulum");
    real.run(60);
    let effects = real.app.update(Event::Key(key("Z")));
    real.execute(effects);
    real.experiment.advance(0.4, u64::MAX);
    let mut effects = real.app.update(Event::Snapshot(Arc::new(real.experiment.snapshot())));
    while let Some(effect) = effects.pop() {
        if let Effect::Compute(Computation { ticket, job, .. }) = effect {
            let outcome = job.run(&Progress::new());
            effects.extend(real.app.update(Event::Computed { ticket, outcome }));
        }
    }
    let lab = real.lab();
    let (_, plot) = lab.focused_plot().unwrap();
    let present = lab.present().unwrap();
    let picture = plot.kind.picture(plot, &present, [f64::NAN; 2], lab.answer(plot));
    let Some(Picture::Axes { layers, .. }) = picture else { panic!("{picture:?}") };
    let inks = layers.iter().filter_map(|(_, layer)| match layer {
        Layer::Line(_, stroke) => Some(stroke.ink),
        _ => None,
    });
    let inks: Vec<Ink> = inks.collect();
    assert!(matches!(inks[..], [Ink::Companion(_), Ink::Curve(1)]), "{inks:?}");
}
