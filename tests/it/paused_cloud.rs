//! A cloud beside a motion that is paused is seen at the very time of the motion; its job never says that all is done
//! while something is left to do.

use std::sync::Arc;

use phaselab::app::{App, AppEvent, Computation, Effect};
use phaselab::experiment::{Command, Experiment};
use phaselab::instrument::{Layer, MarkerShape, Picture};
use phaselab::job::Progress;

use crate::ensemble::{cloud, measure, opened};
use crate::laboratory::{prepared, see};

/// A harmonic oscillator, of which every cloud turns rigidly, and a pendulum, which stretches them.
const OSCILLATOR: &str = "title = \"one\"\n[coordinates]\nq = { initial = 1.0, velocity = 0.0 }\n[lagrangian]\n\
    L = \"1/2*q'^2 - 1/2*q^2\"\n[run]\nuntil = 100.0\n";
const PENDULUM: &str = "title = \"one\"\n[coordinates]\nq = { initial = 2.2, velocity = 0.0 }\n[lagrangian]\n\
    L = \"1/2*q'^2 + cos(q)\"\n[run]\nuntil = 100.0\n";

/// Where the motion is drawn, the legend, and where the motion is.
fn drawn(app: &App) -> ([f64; 2], Vec<String>, [f64; 2]) {
    let lab = app.lab.as_ref().unwrap();
    let (plot, present) = (&lab.plots[0], lab.present().unwrap());
    let picture = plot.kind.picture(lab.context(plot, &present), [f64::NAN; 2]);
    let Some(Picture::Axes { layers, .. }) = picture else { panic!("no picture") };
    let mut at = [f64::NAN; 2];
    let mut legend = Vec::new();
    for (_, layer) in layers {
        match layer {
            Layer::Point(point, MarkerShape::Disc, _) => at = point,
            Layer::Legend(words) => legend = words,
            _ => {}
        }
    }
    (at, legend, [0, 1].map(|axis| present.value(plot.column(axis).unwrap())))
}

fn off(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).abs().max((a[1] - b[1]).abs())
}

fn begin(text: &str) -> (App, Experiment) {
    let (app, _, mut experiment) = opened(prepared(text));
    experiment.execute(Command::Play);
    (app, experiment)
}

#[test]
fn a_paused_cloud_is_at_the_time_of_the_motion() {
    let (mut app, mut experiment) = begin(OSCILLATOR);
    see(&mut app, &mut experiment, 0.01);
    let begun = (cloud(&app), drawn(&app).2);
    // times between the frames of the cloud, of a part that is asked for and of one that is there for long
    for time in [0.5003, 0.5217, 3.0041, 3.0107, 7.777] {
        see(&mut app, &mut experiment, time);
        experiment.execute(Command::Pause);
        see(&mut app, &mut experiment, time);
        // the linear map that carried the motion carries every point
        let (sin, cos) = (time - 0.01).sin_cos();
        let turned = |[q, p]: [f64; 2]| [q * cos + p * sin, p * cos - q * sin];
        let (at, legend, own) = drawn(&app);
        assert!(off(own, turned(begun.1)) < 1e-12, "{time}");
        assert_eq!(at, own, "{time}");
        assert!(!legend.concat().contains("at t"), "{legend:?}");
        let points = cloud(&app);
        let far = points.iter().zip(&begun.0).map(|(now, then)| off(*now, turned(*then)));
        let far = far.fold(0.0, f64::max);
        assert!(far < 1e-11, "{time}: {far:e}");
        assert!(measure(&app, "off").unwrap() < 1e-9);
        experiment.execute(Command::Play);
    }
    // looked at in the past
    experiment.execute(Command::Pause);
    experiment.execute(Command::ScrubTo(2.3456));
    see(&mut app, &mut experiment, 7.777);
    let (sin, cos) = (2.3456_f64 - 0.01).sin_cos();
    let turned = |[q, p]: [f64; 2]| [q * cos + p * sin, p * cos - q * sin];
    let far = cloud(&app).into_iter().zip(&begun.0).map(|(now, then)| off(now, turned(*then)));
    assert!(far.fold(0.0, f64::max) < 1e-11);
}

/// The area of a cloud of which the curve is stretched.
#[test]
fn a_paused_curve_has_its_area() {
    let (mut app, mut experiment) = begin(PENDULUM);
    see(&mut app, &mut experiment, 0.01);
    let action = measure(&app, "action").unwrap();
    for time in [1.0, 3.013] {
        see(&mut app, &mut experiment, time);
    }
    experiment.execute(Command::Pause);
    see(&mut app, &mut experiment, 3.013);
    let now = measure(&app, "action").unwrap();
    assert!((now / action - 1.0).abs() < 1e-6, "{now} {action}");
    // once it is there nothing more is asked for
    let effects = app.update(AppEvent::Snapshot(Arc::new(experiment.snapshot())));
    assert!(!effects.iter().any(|effect| matches!(effect, Effect::Compute(_))));
}

/// Whether its job, at its end, says that everything is done; and whether it ever asked for more starts of the curve.
fn ends_with_all_done(text: &str, times: [f64; 2]) -> [bool; 2] {
    let (mut app, mut experiment) = begin(text);
    see(&mut app, &mut experiment, times[0]);
    experiment.advance(times[1], u64::MAX);
    let mut effects = app.update(AppEvent::Snapshot(Arc::new(experiment.snapshot())));
    let mut seen = [false; 2];
    while let Some(effect) = effects.pop() {
        let Effect::Compute(Computation { ticket, job, .. }) = effect else { continue };
        let progress = Progress::new();
        let outcome = job.run(&progress);
        let share = progress.share();
        seen[0] |= share.total == Some(share.done);
        seen[1] |= share.total.is_none();
        effects.extend(app.update(AppEvent::Computed { ticket, outcome }));
    }
    seen
}

#[test]
fn no_job_of_a_cloud_says_that_all_is_done_while_its_curve_is_carried() {
    assert_eq!(ends_with_all_done(OSCILLATOR, [0.01, 5.0]), [false, false]);
    assert_eq!(ends_with_all_done(PENDULUM, [0.01, 3.0]), [false, true]);
}
