//! A change of a value undone brings back the motion from before it, held against a motion that was never changed.

use phaselab::experiment::{Command, Experiment, Setup, Status};
use phaselab::num::short;

use super::real::Real;
use crate::fixtures::loaded;

/// The same system, never changed, advanced as [`Real::run`] does.
fn undisturbed(name: &str, frames: &[u32]) -> Experiment {
    let loaded = loaded(name, 1);
    let setup = Setup::of(&loaded.model);
    let mut experiment =
        Experiment::new(&loaded.model, &loaded.equations, &loaded.system, setup).unwrap();
    for frames in frames {
        let time = experiment.time() + f64::from(*frames) / 60.0 * experiment.speed();
        experiment.advance(time, u64::MAX);
    }
    experiment
}

fn said(real: &Real) -> String {
    real.app.notifications.shown.as_ref().map(|notice| notice.text.clone()).unwrap_or_default()
}

/// The state, bit by bit.
fn bits(experiment: &Experiment) -> Vec<u64> {
    let state = &experiment.snapshot().state;
    state.values.iter().chain([&state.time]).map(|value| value.to_bits()).collect()
}

#[test]
fn a_parameter_undone_brings_back_the_motion_and_its_past() {
    for name in ["pendulum", "double-pendulum", "rod-on-ice"] {
        let mut real = Real::of(name);
        real.run(90);
        let (before, recorded) = (bits(&real.experiment), real.seen().recorded.clone());
        let rows = |real: &Real| {
            let earlier = |row: &&[f64]| row[0] < recorded.to;
            real.seen().trail.rows().filter(earlier).map(<[f64]>::to_vec).collect::<Vec<_>>()
        };
        let trail = rows(&real);
        real.press("Right");
        real.run(200);
        let (changed, other) = (bits(&real.experiment), real.seen().parameters.clone());
        assert_ne!(before, changed);
        real.press("u");
        assert_eq!(bits(&real.experiment), before, "{name}");
        let time = short(real.seen().time);
        assert!(said(&real).ends_with(&format!(", the motion of t = {time}")), "{}", said(&real));
        let again = real.seen().recorded.clone();
        assert_eq!((again.from, again.to), (recorded.from, recorded.to), "{name}");
        assert!(rows(&real) == trail, "{name}");
        // it goes on as if nothing had been changed, and so does a look at its past
        real.run(60);
        let mut never = undisturbed(name, &[90, 60]);
        assert_eq!(bits(&real.experiment), bits(&never), "{name}");
        for experiment in [&mut real.experiment, &mut never] {
            experiment.execute(Command::ScrubTo(0.4 * recorded.to));
        }
        assert_eq!(bits(&real.experiment), bits(&never), "{name}");
        never.execute(Command::ScrubTo(f64::MAX));
        // redone, the motion is where it was when it was undone
        let mut real = Real::of(name);
        real.run(90);
        real.press("Right");
        real.run(200);
        real.press("u");
        real.run(60);
        real.press("U");
        assert_eq!(bits(&real.experiment), changed, "{name}");
        assert_eq!(real.seen().parameters, other, "{name}");
        real.press("u");
        assert_eq!(real.seen().time, never.time(), "{name}");
    }
}

#[test]
fn an_initial_value_undone_brings_back_the_motion() {
    let mut real = Real::of("pendulum");
    real.run(90);
    let before = bits(&real.experiment);
    real.press("Tab Right");
    real.run(30);
    real.press("u");
    assert_eq!(bits(&real.experiment), before);
    real.run(60);
    assert_eq!(bits(&real.experiment), bits(&undisturbed("pendulum", &[90, 60])));
}

/// A motion that was added beside this one, and a run that is gone back over, are of now: a value is undone, and they stay.
#[test]
fn what_was_added_since_stays() {
    for (command, is_reversed) in [(Command::AddNeighbour, false), (Command::Reverse, true)] {
        let mut real = Real::of("pendulum");
        real.run(90);
        let before = real.seen().parameters.clone();
        real.press("Right");
        real.run(60);
        real.experiment.execute(command);
        real.run(30);
        let time = real.seen().time;
        real.press("u");
        assert_eq!(real.seen().parameters, before);
        assert_eq!(real.seen().time, time);
        assert_eq!(real.seen().companions.len(), usize::from(!is_reversed));
        assert_eq!(real.seen().backwards, is_reversed);
    }
}

#[test]
fn undo_leaves_time_running_or_paused_as_it_is() {
    let mut real = Real::of("pendulum");
    real.press("Space");
    let first = real.seen().status.clone();
    real.press("Right Space");
    let second = real.seen().status.clone();
    assert_ne!(first, second);
    real.press("u");
    assert_eq!(real.seen().status, second);
    real.press("Space U");
    assert_eq!(real.seen().status, first);
    assert!([first, second].contains(&Status::Paused));
}

#[test]
fn crossings_of_a_section_return_with_the_motion() {
    let mut real = Real::of("double-pendulum");
    real.run(600);
    let count = |real: &Real| real.seen().crossings.counts()[0];
    let before = count(&real);
    assert!(before > 3, "{before}");
    real.press("Right");
    assert_eq!(count(&real), 0, "what crossed belongs to another law");
    real.press("u");
    assert_eq!(count(&real), before);
}

#[test]
fn changes_undone_at_once_lead_back_one_by_one() {
    let mut real = Real::of("pendulum");
    real.run(60);
    let first = bits(&real.experiment);
    let file = real.seen().parameters.clone();
    // no snapshot comes between the keys
    let keys = "Right Down Right u u".split_whitespace();
    let effects: Vec<_> = keys
        .flat_map(|word| {
            let key = crate::fixtures::key(word);
            real.app.update(phaselab::app::AppEvent::Key(key))
        })
        .collect();
    real.execute(effects);
    real.look();
    assert_eq!(bits(&real.experiment), first);
    assert_eq!(real.seen().parameters, file);
    real.press("U");
    let changed = real.seen().parameters.iter().zip(&*file).filter(|(now, old)| now != old);
    assert_eq!(changed.count(), 1);
}

/// A held key is pressed again and again, thirty times a second.
#[test]
fn a_held_key_is_one_change() {
    for (keys, name) in [("Right", "pendulum"), ("Tab Right", "pendulum"), ("Right", "spin-up")] {
        let mut real = Real::of(name);
        real.run(60);
        let start = real.seen().parameters.clone();
        let (held, before) =
            (keys.rsplit(' ').next().unwrap(), keys.strip_suffix("Right").unwrap());
        real.press(before);
        for _ in 0..20 {
            real.press(held);
            real.run(2);
        }
        let values =
            |real: &Real| (real.seen().parameters.clone(), real.seen().setup.overrides.clone());
        let (changed, given) = values(&real);
        assert!(changed != start || !given.is_empty());
        real.press("u");
        assert_eq!(values(&real), (start, Vec::new()), "{keys} in {name}");
        real.press("u");
        assert!(said(&real).starts_with("Nothing to undo"), "{}", said(&real));
    }
}
