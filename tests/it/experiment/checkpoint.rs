//! Checkpoints: a motion restored from one is the same to the last bit; in a changed system, as far as names match.

use phaselab::analysis::Verdict;
use phaselab::experiment::{Checkpoint, Command, Experiment, Status};
use phaselab::preset::Catalog;

use super::{PLENTY, build, gauge, run, shipped, value};
use crate::nonempty;

/// A checkpoint after writing and reading.
fn kept(experiment: &Experiment) -> Checkpoint {
    let moment = Checkpoint::of(experiment.model(), experiment.system(), &experiment.snapshot());
    let text = toml::to_string(&moment).expect("it can be written");
    let read: Checkpoint = toml::from_str(&text).expect("it can be read");
    assert_eq!(read, moment, "{text}");
    read
}

/// Everything visible of the current state, bit by bit.
fn present(experiment: &Experiment) -> (u64, Vec<u64>, Vec<(String, u64, u64, u64)>, Status) {
    let snapshot = experiment.snapshot();
    let gauges = snapshot.gauges.iter().map(|g| {
        (g.name.clone(), g.value.to_bits(), g.reference.to_bits(), g.reference_time.to_bits())
    });
    let gauges = gauges.collect();
    let values = snapshot.values.iter().map(|x| x.to_bits()).collect();
    (snapshot.time.to_bits(), values, gauges, snapshot.status)
}

#[test]
fn every_preset_is_restored_to_the_last_bit() {
    for entry in nonempty(Catalog::with_folder(None).entries()) {
        let mut left = shipped(&entry.name);
        let time = left.time() + 0.7 * left.speed();
        left.advance(time, 2_000);
        left.execute(Command::Reference);
        left.advance(time + 0.3 * left.speed(), 2_000);
        left.execute(Command::Pause);
        let mut taken = shipped(&entry.name);
        taken.execute(Command::Restore(Box::new(kept(&left))));
        assert_eq!(present(&taken), present(&left), "{}", entry.name);
    }
}

/// The greatest drift so far is retained for every kind of gauge: a quantity, a constraint or an attitude.
#[test]
fn the_greatest_drift_is_restored() {
    for name in ["pendulum", "turning-wire", "free-rigid-body", "swinging-atwood", "heavy-top"] {
        let mut left = shipped(name);
        run(&mut left, 7.3);
        let mut taken = shipped(name);
        taken.execute(Command::Restore(Box::new(kept(&left))));
        for (a, b) in left.snapshot().gauges.iter().zip(taken.snapshot().gauges.iter()) {
            assert_eq!((&a.name, a.reference_time), (&b.name, b.reference_time), "{name}");
            assert!(b.farthest >= a.farthest, "{name}: {a:?} became {b:?}");
            let (a, b) = (a.max_drift, b.max_drift);
            assert!(
                (a - b).abs() <= 1e-9 * a || (a < 1e-14 && b < 1e-14),
                "{name}: {a:e} became {b:e}"
            );
        }
    }
}

#[test]
fn both_go_on_alike() {
    for (name, time) in
        [("pendulum", 3.3), ("heavy-top", 2.1), ("kicked-rotor", 4.0), ("free-rigid-body", 5.0)]
    {
        let mut left = shipped(name);
        run(&mut left, time);
        let mut taken = shipped(name);
        taken.execute(Command::Restore(Box::new(kept(&left))));
        let later = time + 0.9;
        run(&mut left, later);
        run(&mut taken, later);
        for (a, b) in left.values().iter().zip(taken.values()) {
            let size = a.abs().max(1.0);
            assert!(a == b || (a - b).abs() <= 1e-12 * size, "{name}: {a} and {b}");
        }
    }
}

#[test]
fn a_constraint_that_was_let_go_stays_so() {
    let mut left = shipped("smooth-sphere");
    while left.snapshot().released.is_empty() {
        left.advance(left.time() + 0.01, PLENTY);
        assert_eq!(left.status(), Status::Running);
    }
    let verdict = |sphere: &Experiment| {
        let seen = sphere.snapshot();
        let gauge = seen.gauges.iter().find(|gauge| gauge.name == "sphere").expect("a residual");
        gauge.verdict.clone()
    };
    let mut taken = shipped("smooth-sphere");
    assert_ne!(verdict(&taken), Verdict::Released);
    assert_eq!(verdict(&left), Verdict::Released, "there is nothing to judge");
    taken.execute(Command::Restore(Box::new(kept(&left))));
    assert_eq!(taken.snapshot().released, [0]);
    let later = left.time() + 0.05;
    run(&mut left, later);
    run(&mut taken, later);
    assert_eq!(taken.snapshot().released, [0]);
    for (a, b) in left.values().iter().zip(taken.values()) {
        assert!(a == b || (a - b).abs() <= 1e-13 * a.abs().max(1.0), "{a} and {b}");
    }
}

/// Changes by impulses remain separate from drift, and drift remains relative to the same reference.
#[test]
fn a_gauge_goes_on_from_its_own_beginning() {
    for (preset, method, time) in
        [("kicked-rotor", "taylor", 5.5), ("restricted-three-body", "rk4", 3.0)]
    {
        let mut left = shipped(preset);
        left.execute(Command::Method(method.to_owned()));
        left.execute(Command::StepSize(0.05));
        left.advance(time, PLENTY);
        let mut taken = shipped(preset);
        taken.execute(Command::Restore(Box::new(kept(&left))));
        let (before, after) = (left.snapshot(), taken.snapshot());
        let energy = &before.gauges[0];
        assert!(energy.reference != energy.initial || energy.max_drift > 0.1, "{energy:?}");
        for (a, b) in before.gauges.iter().zip(after.gauges.iter()) {
            assert_eq!((a.initial, a.reference, a.scale), (b.initial, b.reference, b.scale));
            assert_eq!((a.drift, a.max_drift), (b.drift, b.max_drift), "{a:?} {b:?}");
        }
    }
}

#[test]
fn every_method_is_restored_as_it_is() {
    for method in ["taylor", "dop853", "gauss6", "rk4"] {
        let mut left = shipped("double-pendulum");
        left.execute(Command::Method(method.to_owned()));
        assert_eq!(left.snapshot().method.name, method);
        left.advance(1.234, PLENTY);
        let mut taken = shipped("double-pendulum");
        taken.execute(Command::Restore(Box::new(kept(&left))));
        assert_eq!(present(&taken).1, present(&left).1, "{method}");
        assert_eq!(taken.snapshot().method.name, method);
    }
    let mut left = shipped("henon-heiles");
    left.execute(Command::Method("leapfrog".to_owned()));
    left.execute(Command::StepSize(0.01));
    assert_eq!(left.snapshot().method.name, "leapfrog");
    left.advance(1.234, PLENTY);
    let mut taken = shipped("henon-heiles");
    taken.execute(Command::Restore(Box::new(kept(&left))));
    assert_eq!(present(&taken).1, present(&left).1);
    assert_eq!(taken.snapshot().setup.settings.step, Some(0.01));
}

const SPRING: &str = r#"
title = "Mass on a spring"
[coordinates]
x = { initial = 1.0 }
y = { initial = 2.0, velocity = 0.5 }
[parameters]
k = 4.0
m = 1.0
[lagrangian]
L = "1/2*m*(x'^2 + y'^2) - 1/2*k*(x^2 + y^2)"
"#;

/// The spring at t = 0.8 with k changed to 5, restored in a changed file.
fn carried(change: impl FnOnce(String) -> String) -> (Experiment, Experiment) {
    let mut left = build(SPRING, |_| ());
    let index = left.model().parameter("k").expect("it is there");
    left.execute(Command::Parameter { index, value: 5.0 });
    left.execute(Command::Initial { index: 1, value: 3.0 });
    run(&mut left, 0.8);
    let mut taken = build(&change(SPRING.to_owned()), |_| ());
    taken.execute(Command::Restore(Box::new(kept(&left))));
    (left, taken)
}

#[test]
fn a_changed_law_keeps_the_state_and_measures_anew() {
    let (left, taken) = carried(|text| text.replace("(x^2 + y^2)", "(x^2 + y^2 + x^4)"));
    for name in ["x", "y", "x'", "y'"] {
        assert_eq!(value(&taken, name), value(&left, name), "{name}");
    }
    assert_eq!(taken.time(), 0.8);
    let energy = gauge(&taken.snapshot(), "energy");
    assert_eq!((energy.reference, energy.drift), (energy.value, 0.0));
    assert!(energy.value != value(&left, "energy"));
    // a value set by the user is retained, also for the next reset
    let parameters = taken.snapshot().parameters;
    assert_eq!(parameters[0], 5.0);
    assert_eq!(taken.snapshot().initial[1], 3.0);
}

#[test]
fn a_value_changed_in_the_file_wins() {
    let (_, taken) = carried(|text| text.replace("k = 4.0", "k = 7.0"));
    assert_eq!(taken.snapshot().parameters[0], 7.0);
}

#[test]
fn what_is_no_longer_there_is_reported() {
    let (left, taken) = carried(|text| {
        let text =
            text.replace("y = { initial = 2.0, velocity = 0.5 }\n", "z = { initial = 9.0 }\n");
        text.replace("y'^2", "z'^2")
            .replace("y^2", "z^2")
            .replace("k = 4.0", "c = 4.0")
            .replace("1/2*k*", "1/2*c*")
    });
    assert_eq!(value(&taken, "x"), value(&left, "x"));
    assert_eq!((value(&taken, "z"), value(&taken, "z'")), (9.0, 0.0));
    let notices = taken.snapshot().notices;
    assert_eq!(notices.last().map(String::as_str), Some("no longer there: k, y"));
}

#[test]
fn a_lagrangian_goes_on_as_a_hamiltonian() {
    let (left, taken) = carried(|text| {
        let law = "[hamiltonian]\nH = \"(p_x^2 + p_y^2)/(2*m) + 1/2*k*(x^2 + y^2)\"\n";
        let text = text.replace("velocity", "momentum");
        text[..text.find("[lagrangian]").expect("it has one")].to_owned() + law
    });
    for name in ["x", "y", "p_x", "p_y"] {
        assert_eq!(value(&taken, name), value(&left, name), "{name}");
    }
}

#[test]
fn a_constraint_that_the_state_misses_begins_anew_and_says_why() {
    let (_, taken) = carried(|text| {
        text.replace("y = { initial = 2.0, velocity = 0.5 }", "y = { initial = 0.0 }")
            + "[[constraints]]\nname = \"line\"\nexpression = \"y\"\n"
    });
    assert_eq!(taken.time(), 0.0);
    let notices = taken.snapshot().notices;
    assert!(notices.iter().any(|n| n.starts_with("the motion starts again: ")), "{notices:?}");
}

#[test]
fn an_ended_motion_is_still_ended() {
    let mut left = shipped("rolling-race");
    assert_eq!(left.advance(1e3, PLENTY), phaselab::experiment::AdvanceOutcome::Ended);
    let mut taken = shipped("rolling-race");
    taken.execute(Command::Restore(Box::new(kept(&left))));
    assert_eq!(taken.status(), left.status());
    assert_eq!(present(&taken), present(&left));
}

#[test]
fn a_method_that_is_refused_leaves_the_one_that_runs_with_its_settings() {
    let method = Some("leapfrog".to_owned());
    let moment = Checkpoint { method, step: Some(0.01), ..kept(&shipped("double-pendulum")) };
    let mut taken = shipped("double-pendulum");
    let before = taken.snapshot();
    taken.execute(Command::Restore(Box::new(moment)));
    let after = taken.snapshot();
    assert_eq!(after.method.name, before.method.name);
    assert_eq!(after.setup.method, before.setup.method);
    assert_eq!(after.setup.settings, before.setup.settings);
    assert!(after.notices.iter().any(|notice| notice.contains("leapfrog")), "{:?}", after.notices);
}

/// A spring that has moved for a while, restored with its past in the system of a changed text.
fn recalled(change: impl Fn(String) -> String) -> (Experiment, Experiment) {
    let mut left = build(SPRING, |_| ());
    run(&mut left, 2.0);
    let snapshot = left.snapshot();
    let moment = Checkpoint::of(left.model(), left.system(), &snapshot);
    let moment = moment.with_past(left.system(), &snapshot);
    let mut taken = build(&change(SPRING.to_owned()), |_| ());
    taken.execute(Command::Restore(Box::new(moment)));
    (left, taken)
}

/// The record of a channel: times and values as bits.
fn recorded(experiment: &Experiment, name: &str) -> Vec<(u64, u64)> {
    let channels = experiment.system().channels();
    let place = channels.iter().position(|channel| channel.name == name).expect("a channel");
    let trail = experiment.snapshot().trail;
    trail.rows().map(|row| (row[0].to_bits(), row[1 + place].to_bits())).collect()
}

#[test]
fn what_was_drawn_stays_where_the_coordinates_are_the_same() {
    let observed = |text: String| text + "[[observables]]\nname = \"new\"\nexpression = \"2*x\"\n";
    let (left, mut taken) = recalled(observed);
    for name in ["x", "y'", "energy"] {
        let (before, after) = (recorded(&left, name), recorded(&taken, name));
        let whole = before.iter().filter(|(time, _)| *time < 2.0_f64.to_bits()).count();
        assert!(whole > 50 && after.len() > whole, "{name}: {whole} of {}", after.len());
        assert_eq!(before[..whole], after[..whole], "{name}");
    }
    // a new channel has no past
    let new = recorded(&taken, "new");
    assert!(f64::from_bits(new[0].1).is_nan() && f64::from_bits(new[new.len() - 1].1).is_finite());
    let bounds = taken.snapshot().bounds;
    assert!(bounds.iter().all(|(least, most)| least.is_finite() && most.is_finite()));
    // and the following rows are in order
    run(&mut taken, 3.0);
    let times: Vec<f64> =
        recorded(&taken, "x").iter().map(|(time, _)| f64::from_bits(*time)).collect();
    assert!(times.is_sorted(), "{times:?}");
}

#[test]
fn what_was_drawn_of_other_coordinates_goes() {
    let (_, taken) = recalled(|text| {
        let text =
            text.replace("y = { initial = 2.0, velocity = 0.5 }\n", "z = { initial = 9.0 }\n");
        text.replace("y'^2", "z'^2").replace("y^2", "z^2")
    });
    assert!(recorded(&taken, "x").len() <= 2);
}

/// Sessions keep the motions beside the main one: they go on to the last bit.
#[test]
fn companions_are_restored_to_the_last_bit() {
    use phaselab::system::InitialOverride;
    let mut experiment = shipped("henon-heiles");
    run(&mut experiment, 6.0);
    experiment.execute(Command::AddStart(vec![InitialOverride::Position(1, 0.2)]));
    experiment.execute(Command::AddNeighbour);
    experiment.execute(Command::Pin);
    experiment.execute(Command::Method("gauss6".to_owned()));
    experiment.execute(Command::StepSize(0.125));
    run(&mut experiment, 10.0);
    let seen = experiment.snapshot();
    assert!(!experiment.is_behind());
    let moment = Checkpoint::of(experiment.model(), experiment.system(), &seen);
    let text = toml::to_string(&moment).expect("it is written");
    let read: Checkpoint = toml::from_str(&text).expect("it is read");
    assert_eq!(read, moment);
    let mut other = shipped("henon-heiles");
    other.execute(Command::Restore(Box::new(read)));
    let there = other.snapshot();
    let words = |s: &phaselab::experiment::Snapshot| -> Vec<(usize, &'static str, &'static str)> {
        s.companions.iter().map(|one| (one.number, one.origin.word(), one.method)).collect()
    };
    assert_eq!(words(&there), words(&seen));
    assert_eq!(words(&seen)[2], (3, "pinned run", "taylor"));
    for (a, b) in seen.companions.iter().zip(there.companions.iter()) {
        assert_eq!((&a.state.values, &a.state.carry), (&b.state.values, &b.state.carry));
        assert_eq!((a.time, &a.origin, &a.parameters), (b.time, &b.origin, &b.parameters));
    }
    run(&mut experiment, 16.0);
    run(&mut other, 16.0);
    let (seen, there) = (experiment.snapshot(), other.snapshot());
    for (a, b) in seen.companions.iter().zip(there.companions.iter()) {
        let pairs = a.values.iter().zip(b.values.iter());
        assert!(pairs.filter(|(a, _)| a.is_finite()).all(|(a, b)| (a - b).abs() < 1e-13));
    }
    // a name that is not there loses the motion, and says so
    let mut broken = Checkpoint::of(experiment.model(), experiment.system(), &seen);
    broken.companions[0].initial[0].name = "nowhere".to_owned();
    let mut third = shipped("henon-heiles");
    third.execute(Command::Restore(Box::new(broken)));
    let seen = third.snapshot();
    assert_eq!(seen.companions.len(), 2);
    assert_eq!(seen.notices.last().unwrap(), "no longer there: motion 1");
}

/// A session that is left while time runs backwards goes on backwards.
#[test]
fn a_motion_that_goes_back_is_restored_going_back() {
    let mut experiment = shipped("pendulum");
    run(&mut experiment, 5.0);
    experiment.execute(Command::Reverse);
    experiment.advance(-3.0, super::PLENTY);
    let seen = experiment.snapshot();
    let moment = Checkpoint::of(experiment.model(), experiment.system(), &seen);
    assert!(moment.backwards);
    let mut other = shipped("pendulum");
    other.execute(Command::Restore(Box::new(moment)));
    assert!(other.is_backwards());
    assert_eq!(other.snapshot().state.values, seen.state.values);
    other.advance(-1.0, super::PLENTY);
    let mut alone = shipped("pendulum");
    run(&mut alone, 1.0);
    let pairs = alone.values().iter().zip(other.values());
    assert!(pairs.filter(|(a, _)| a.is_finite()).all(|(a, b)| (a - b).abs() < 1e-13));
}

/// A session keeps no past, and the motion is run once more: the picture of a resumed motion is the same as before, and it goes on as
/// if it had never been left, also where a parameter was changed on the way.
#[test]
fn the_past_of_a_resumed_motion_is_computed_once_more() {
    for (name, change) in [("pendulum", None), ("henon-heiles", None), ("duffing", Some(0.2))] {
        let mut left = shipped(name);
        run(&mut left, 4.0);
        if let Some(value) = change {
            left.execute(Command::Parameter { index: 0, value });
        }
        left.execute(Command::Pause);
        run(&mut left, 7.3);
        let mut taken = shipped(name);
        taken.execute(Command::Restore(Box::new(kept(&left))));
        assert_eq!(present(&taken), present(&left), "{name}");
        let since = if change.is_some() { 4.0 } else { 0.0 };
        let rows = |experiment: &Experiment| -> Vec<Vec<f64>> {
            let trail = experiment.snapshot().trail;
            trail.rows().filter(|row| row[0] > since).map(<[f64]>::to_vec).collect()
        };
        let (found, expected) = (rows(&taken), rows(&left));
        assert!(found.len() > 50 && taken.snapshot().notices.is_empty(), "{name}");
        assert_eq!(found.len(), expected.len(), "{name}");
        // times count from where the law was changed, or from the start
        let within = if change.is_some() { 1e-12 } else { 0.0 };
        for (x, y) in found.iter().flatten().zip(expected.iter().flatten()) {
            assert!((x - y).abs() <= within || x.is_nan() && y.is_nan(), "{name}: {x} {y}");
        }
        for experiment in [&mut left, &mut taken] {
            run(experiment, 9.1);
        }
        assert_eq!(present(&taken), present(&left), "{name}");
    }
}

/// Where the motion was led by hand, or its past is too long to be computed at once, the state alone is there, and that is said.
#[test]
fn a_past_that_is_not_found_again_is_said_to_be_lost() {
    let mut left = shipped("pendulum");
    run(&mut left, 4.0);
    let mut saved = kept(&left);
    let state = &mut saved.present.as_mut().unwrap().state;
    state[0][0] += 0.25;
    let mut taken = shipped("pendulum");
    taken.execute(Command::Restore(Box::new(saved)));
    assert_eq!(taken.snapshot().trail.len(), 1);
    let notices = taken.snapshot().notices;
    assert!(
        notices.iter().any(|one| one.contains("past of this motion was not kept")),
        "{notices:?}"
    );
    // a little beside it the past is that of the same motion
    let mut saved = kept(&left);
    saved.present.as_mut().unwrap().state[0][1] += 1e-18;
    let mut taken = shipped("pendulum");
    taken.execute(Command::Restore(Box::new(saved)));
    assert!(taken.snapshot().trail.len() > 50 && taken.snapshot().notices.is_empty());
}

/// A motion that goes back comes home with its return error.
#[test]
fn a_resumed_motion_that_goes_back_is_compared_with_the_run_before() {
    let mut left = shipped("henon-heiles");
    run(&mut left, 5.0);
    left.execute(Command::Reverse);
    left.advance(-3.0, super::PLENTY);
    let mut taken = shipped("henon-heiles");
    taken.execute(Command::Restore(Box::new(kept(&left))));
    for experiment in [&mut left, &mut taken] {
        experiment.advance(0.0, super::PLENTY);
    }
    let [one, other] = [&left, &taken].map(|experiment| experiment.snapshot().returned.unwrap());
    assert!(one.error.is_some_and(|error| error < 1e-12));
    assert_eq!(
        (one.error, one.step_error, one.turned),
        (other.error, other.step_error, other.turned)
    );
}

/// Another law with another auxiliary number, here the work that a ramp does, takes the action up where it was: S goes on
/// through the change, and is ∫ L dt over both parts of the motion.
#[test]
fn the_action_goes_on_in_a_changed_system() {
    let text = |ramp: &str| {
        format!(
            "title = \"t\"\n[coordinates]\nq = {{ initial = 1.0, velocity = 0.5 }}\n[parameters]\nw = 1.0\n{ramp}\
             [lagrangian]\nL = \"q'^2/2 - w^2*q^2/2\"\n[[observables]]\nname = \"S\"\nexpression = \"action\"\n"
        )
    };
    let mut left = build(&text(""), |_| {});
    run(&mut left, 2.0);
    let before = value(&left, "S");
    // ∫ ½(q̇² − q²) dt = ½ [q q̇]
    let (q, v) = (2.0_f64.cos() + 0.5 * 2.0_f64.sin(), 0.5 * 2.0_f64.cos() - 2.0_f64.sin());
    assert!((before - 0.5 * (q * v - 0.5)).abs() < 1e-13, "{before}");
    let ramp = "[[ramps]]\nparameter = \"w\"\nto = 2\nstart = 2\nduration = 3\n";
    let mut taken = build(&text(ramp), |_| {});
    let mut whole = build(&text(ramp), |_| {});
    taken.execute(Command::Restore(Box::new(kept(&left))));
    assert_eq!(value(&taken, "S").to_bits(), before.to_bits());
    run(&mut taken, 6.0);
    run(&mut whole, 6.0);
    let (taken, whole) = (value(&taken, "S"), value(&whole, "S"));
    assert!((taken - whole).abs() < 1e-12, "{taken} and {whole}");
}
