//! Motions beside the main one: against experiments of their own, known exponents, and the main motion without them.

use phaselab::experiment::{
    AdvanceOutcome, Checkpoint, Command, CompanionOrigin, Experiment, MOST_COMPANIONS, Setup,
};
use phaselab::system::InitialOverride::{Momentum, Position};

use super::{PLENTY, build, run, shipped};
use crate::fixtures::loaded;

/// An experiment of a preset that begins elsewhere, with other parameters.
fn begun(name: &str, change: impl FnOnce(&mut Setup)) -> Experiment {
    let loaded = loaded(name, 1);
    let mut setup = Setup::of(&loaded.model);
    change(&mut setup);
    Experiment::new(&loaded.model, &loaded.equations, &loaded.system, setup).unwrap()
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).filter(|(a, _)| a.is_finite()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn an_added_start_is_the_motion_of_an_experiment_of_its_own() {
    let mut both = shipped("henon-heiles");
    run(&mut both, 12.0);
    // it begins where all began, and catches up
    let given = vec![Position(1, 0.483), Momentum(0, 0.27898039)];
    both.execute(Command::AddStart(given.clone()));
    assert!(both.is_behind());
    run(&mut both, 20.0);
    assert!(!both.is_behind());
    let mut alone = begun("henon-heiles", |setup| setup.overrides.clone_from(&given));
    run(&mut alone, 20.0);
    let seen = both.snapshot();
    let one = &seen.companions[0];
    assert_eq!((one.number, one.time, &one.message), (1, 20.0, &None));
    assert!(apart(&one.values, alone.values()) < 1e-12, "{:?}", one.values);
    // rows at the times of the main motion
    let times = |trail: &phaselab::experiment::Trail| -> Vec<f64> {
        trail.rows().map(|row| row[0]).collect()
    };
    assert_eq!(times(&one.trail), times(&seen.trail));
    assert!(one.crossings.counts()[0] > 2);
}

#[test]
fn the_main_motion_is_the_same_with_and_without_others() {
    let (mut alone, mut among) = (shipped("henon-heiles"), shipped("henon-heiles"));
    among.execute(Command::AddNeighbour);
    among.execute(Command::AddStart(vec![Position(1, 0.1)]));
    for time in [3.0, 7.5, 30.0] {
        run(&mut alone, time);
        run(&mut among, time);
        assert_eq!(alone.values(), among.values());
    }
    assert_eq!(alone.snapshot().trail, among.snapshot().trail);
    assert_eq!(alone.crossings().counts(), among.crossings().counts());
}

#[test]
fn a_slice_of_work_is_bounded_and_what_is_behind_catches_up() {
    let mut experiment = shipped("henon-heiles");
    run(&mut experiment, 200.0);
    experiment.execute(Command::AddStart(vec![Position(1, 0.1)]));
    assert_eq!(experiment.advance(200.0, 20), AdvanceOutcome::Underway);
    let first = experiment.snapshot().companions[0].time;
    assert!(first < 30.0, "{first}");
    let mut slices = 1;
    while experiment.is_behind() {
        experiment.advance(200.0, 20);
        slices += 1;
        assert!(slices < 100_000);
    }
    assert!(slices > 20, "{slices}");
    assert_eq!(experiment.snapshot().companions[0].time, 200.0);
}

/// Hénon–Heiles on the periodic orbit B at E = 1/8.
fn on_orbit_b(setup: &mut Setup) {
    setup.overrides = vec![
        Position(0, 0.0),
        Position(1, -0.185_405_087_090_802_14),
        Momentum(0, 0.459_756_545_767_957_59),
        Momentum(1, 0.0),
    ];
}

#[test]
fn a_neighbour_of_an_unstable_periodic_orbit_parts_with_its_exponent() {
    let mut experiment = begun("henon-heiles", on_orbit_b);
    experiment.execute(Command::AddNeighbour);
    run(&mut experiment, 120.0);
    let seen = experiment.snapshot();
    let slope = seen.separations[0].1.slope().unwrap();
    // λ = 0.19195453623623, from the trace of its monodromy; what oscillates within a period is left
    assert!((slope.rate - 0.191_954_536).abs() < 0.006, "{slope:?}");
    assert!(slope.grown > 10.0 && slope.to < 110.0, "{slope:?}");
}

#[test]
fn a_neighbour_of_a_regular_orbit_parts_no_faster_than_time() {
    let mut experiment = begun("henon-heiles", |setup| {
        setup.overrides = vec![Position(1, 0.483), Momentum(0, 0.278_980_39), Momentum(1, 0.0)];
    });
    experiment.execute(Command::AddNeighbour);
    run(&mut experiment, 300.0);
    let slope = experiment.snapshot().separations[0].1.slope().unwrap();
    // in proportion to time it would be about 2 over a line in t
    assert!(slope.grown < 5.0 && slope.to > 290.0, "{slope:?}");
}

#[test]
fn a_pinned_run_keeps_its_parameters_and_its_method_and_its_past() {
    let mut experiment = shipped("pendulum");
    run(&mut experiment, 2.0);
    let rows = experiment.snapshot().trail.len();
    experiment.execute(Command::Pin);
    assert_eq!(experiment.snapshot().companions[0].trail.len(), rows);
    let g = experiment.model().parameters.iter().position(|p| p.name == "g").unwrap();
    experiment.execute(Command::Parameter { index: g, value: 3.0 });
    experiment.execute(Command::Method("rk4".to_owned()));
    run(&mut experiment, 5.0);
    let mut before = shipped("pendulum");
    run(&mut before, 5.0);
    let seen = experiment.snapshot();
    let one = &seen.companions[0];
    assert!(matches!(one.origin, CompanionOrigin::Pinned(_)));
    assert_eq!((one.method, seen.method.name), ("taylor", "rk4"));
    assert_ne!(one.parameters[g], seen.parameters[g]);
    assert!(apart(&one.values, before.values()) < 1e-12);
    assert!(apart(&one.values, &seen.values) > 0.1, "the main motion has gone another way");
    assert!(one.trail.len() > rows);
}

/// Impulses at intervals are counted from where the motion began, and not from where another one joined it.
#[test]
fn motions_that_join_on_the_way_are_kicked_with_the_main_one() {
    let mut experiment = shipped("kicked-rotor");
    run(&mut experiment, 2.3);
    experiment.execute(Command::Pin);
    experiment.execute(Command::AddNeighbour);
    let moment = Checkpoint::of(experiment.model(), experiment.system(), &experiment.snapshot());
    run(&mut experiment, 12.0);
    let mut restored = shipped("kicked-rotor");
    restored.execute(Command::Restore(Box::new(moment)));
    run(&mut restored, 12.0);
    for seen in [experiment.snapshot(), restored.snapshot()] {
        let [pinned, neighbour] = &seen.companions[..] else { panic!("two motions") };
        assert_eq!((pinned.time, neighbour.time), (12.0, 12.0));
        assert!(apart(&pinned.values, &seen.values) < 1e-9, "the same run");
        // on an island, where neighbours part no faster than the time
        let beside = apart(&neighbour.values, &seen.values);
        assert!(beside > 0.0 && beside < 1e-5, "{beside:e}");
    }
}

#[test]
fn all_begin_again_with_the_main_motion_and_follow_its_parameters() {
    let mut experiment = shipped("pendulum");
    experiment.execute(Command::AddStart(vec![Position(0, 0.5)]));
    experiment.execute(Command::AddNeighbour);
    run(&mut experiment, 3.0);
    let g = experiment.model().parameters.iter().position(|p| p.name == "g").unwrap();
    experiment.execute(Command::Parameter { index: g, value: 3.0 });
    run(&mut experiment, 4.0);
    experiment.execute(Command::Reset);
    let seen = experiment.snapshot();
    assert!(seen.companions.iter().all(|one| one.time == 0.0 && one.parameters[g] == 3.0));
    let beside = seen.companions[1].values[0] - seen.values[0];
    assert!(beside != 0.0 && beside.abs() < 1e-7, "{beside}");
    run(&mut experiment, 1.0);
    let mut alone = begun("pendulum", |setup| {
        setup.parameters[g] = 3.0;
        setup.overrides = vec![Position(0, 0.5)];
    });
    run(&mut alone, 1.0);
    assert!(apart(&experiment.snapshot().companions[0].values, alone.values()) < 1e-13);
    experiment.execute(Command::ClearCompanions);
    assert!(experiment.snapshot().companions.is_empty());
}

#[test]
fn more_than_the_most_and_neighbours_under_constraints_are_refused_in_words() {
    let mut experiment = shipped("pendulum");
    for _ in 0..=MOST_COMPANIONS {
        experiment.execute(Command::Pin);
    }
    let seen = experiment.snapshot();
    assert_eq!(seen.companions.len(), MOST_COMPANIONS);
    assert_eq!(seen.notices.last().unwrap(), "there can be at most 6 motions beside the main one");
    let numbers: Vec<usize> = seen.companions.iter().map(|one| one.number).collect();
    assert_eq!(numbers, [1, 2, 3, 4, 5, 6]);
    let mut held = shipped("rolling-coin");
    assert!(held.system().constraints() > 0);
    held.execute(Command::AddNeighbour);
    let seen = held.snapshot();
    assert!(seen.companions.is_empty());
    assert!(seen.notices.last().unwrap().contains("constraints"), "{:?}", seen.notices);
    // a start where there is no motion says why it does not go on
    let mut planet = shipped("planet");
    planet.execute(Command::AddStart(vec![Position(0, 0.0)]));
    assert_eq!(planet.advance(0.5, PLENTY), AdvanceOutcome::Arrived);
    assert!(planet.snapshot().companions[0].message.is_some());
}

/// Two methods side by side from the same start: the pinned run loses energy at every step of Runge and Kutta, by the
/// factor 1 − (ωh)⁶/72 + (ωh)⁸/576, and the leapfrog swings about its level as far at the end as at the start.
#[test]
fn methods_are_compared_side_by_side_from_one_start() {
    const STEP: f64 = 0.5;
    const END: f64 = 100.0;
    let mut both = shipped("harmonic-oscillator");
    let loaded = loaded("harmonic-oscillator", 1);
    let channel = loaded.system.channels().iter().position(|c| c.name == "energy").unwrap();
    for command in [Command::Method("rk4".into()), Command::StepSize(STEP), Command::Pin] {
        both.execute(command);
    }
    both.execute(Command::Method("leapfrog".into()));
    both.execute(Command::StepSize(STEP));
    both.execute(Command::Reset);
    run(&mut both, END);
    let seen = both.snapshot();
    let pinned = &seen.companions[0];
    assert_eq!((pinned.method, seen.method.name), ("rk4", "leapfrog"));
    assert_eq!((pinned.time, &pinned.message), (END, &None));
    let rows = |trail: &phaselab::experiment::Trail| -> Vec<[f64; 2]> {
        trail.rows().map(|row| [row[0], row[1 + channel]]).collect()
    };
    let (lossy, level) = (rows(&pinned.trail), rows(&seen.trail));
    assert_eq!((lossy[0], lossy.len()), (level[0], level.len()), "one start, the same times");

    let (m, k) = (seen.parameters[0], seen.parameters[1]);
    let square = STEP * STEP * k / m;
    let factor = 1.0 - square.powi(3) / 72.0 + square.powi(4) / 576.0;
    let at_steps: Vec<[f64; 2]> = lossy
        .iter()
        .copied()
        .filter(|[time, _]| (time / STEP - (time / STEP).round()).abs() < 1e-9)
        .collect();
    assert!(at_steps.len() > 100, "{} rows at the ends of steps", at_steps.len());
    for [time, found] in at_steps {
        let expected = lossy[0][1] * factor.powf(time / STEP);
        assert!((found / expected - 1.0).abs() < 1e-9, "{found} and not {expected} at {time}");
    }
    let swing = |part: &[[f64; 2]]| {
        part.iter().map(|[_, e]| (e / level[0][1] - 1.0).abs()).fold(0.0, f64::max)
    };
    let tenth = level.len() / 10;
    let (first, last) = (swing(&level[..tenth]), swing(&level[9 * tenth..]));
    assert!(first > 1e-3 && (last / first - 1.0).abs() < 0.05, "{first} and {last}");
    let lost = 1.0 - lossy.last().unwrap()[1] / lossy[0][1];
    assert!(lost > 0.005, "{lost}");
}

#[test]
fn what_is_added_is_said_in_a_whole_sentence() {
    let mut experiment = begun("pendulum", |_| {});
    run(&mut experiment, 0.5);
    let mut said = |command: Command, sentence: &str| {
        experiment.execute(command);
        assert_eq!(experiment.snapshot().notices.last().map(String::as_str), Some(sentence));
    };
    said(Command::AddStart(vec![Position(0, 0.5)]), "motion 1 begins there, beside the main one");
    said(Command::AddNeighbour, "motion 2 begins close beside the main one");
    said(Command::Pin, "motion 3 is this run, pinned; what changes from now on is seen beside it");
}

/// A copy of an experiment made from its checkpoint, as a session is continued.
fn continued(experiment: &Experiment, name: &str) -> Experiment {
    let seen = experiment.snapshot();
    let checkpoint = Checkpoint::of(experiment.model(), experiment.system(), &seen);
    let text = toml::to_string(&checkpoint).expect("it is written");
    let mut other = shipped(name);
    other.execute(Command::Restore(Box::new(toml::from_str(&text).expect("it is read"))));
    other
}

/// A pinned run that has left its surface does not return to it when the session is continued.
#[test]
fn a_pinned_run_keeps_its_released_constraints_when_it_is_restored() {
    let mut sphere = shipped("smooth-sphere");
    while sphere.snapshot().released.is_empty() {
        sphere.advance(sphere.time() + 0.01, PLENTY);
    }
    sphere.execute(Command::Pin);
    let mut taken = continued(&sphere, "smooth-sphere");
    assert_eq!(taken.snapshot().companions[0].released[..], [0]);
    let end = sphere.time() + 0.05;
    run(&mut sphere, end);
    run(&mut taken, end);
    let [one, other] = [&sphere, &taken].map(|motion| motion.snapshot().companions[0].clone());
    assert_eq!((one.time, &other.message), (other.time, &None));
    assert_eq!(one.state.values, other.state.values);
}

/// A step that a method has chosen at the beginning of a pinned run is not chosen anew when the session is continued.
#[test]
fn a_pinned_run_keeps_its_step_when_it_is_restored() {
    let mut pendulum = shipped("pendulum");
    pendulum.execute(Command::Method("rk4".into()));
    pendulum.execute(Command::Reset);
    run(&mut pendulum, 1.3);
    pendulum.execute(Command::Pin);
    let taken = continued(&pendulum, "pendulum");
    let [one, other] = [&pendulum, &taken].map(|motion| motion.snapshot().companions[0].clone());
    assert!(one.fixed_step.is_some() && one.settings.step.is_none());
    assert_eq!((one.fixed_step, one.settings), (other.fixed_step, other.settings));
}

/// The step that a method has chosen at the last impulse is that of the resumed motion and of a pinned run beside it, up to the next
/// impulse, at which both choose as a motion does that was not interrupted.
#[test]
fn a_chosen_step_lasts_until_the_next_impulse_when_a_motion_is_restored() {
    let text = "title = \"Struck\"\n[coordinates]\nx = { initial = 2 }\n[lagrangian]\nL = \"1/2*x'^2 - 1/4*x^4\"\n\
                [[impulses]]\nname = \"push\"\nevery = 3\nchange = { p_x = \"5*(t - 3)\" }\n";
    let begun = || build(text, |setup| setup.method = "rk4".into());
    let mut left = begun();
    run(&mut left, 4.1);
    left.execute(Command::Pin);
    let seen = left.snapshot();
    // with its past it is not computed once more
    let checkpoint = Checkpoint::of(left.model(), left.system(), &seen);
    let checkpoint = checkpoint.with_past(left.system(), &seen);
    let mut taken = begun();
    taken.execute(Command::Restore(Box::new(checkpoint)));
    let steps = |motion: &Experiment| {
        let seen = motion.snapshot();
        (seen.method.step, seen.companions[0].fixed_step)
    };
    let before = steps(&left);
    assert_eq!(steps(&taken), before);
    for time in [5.9, 7.0] {
        run(&mut left, time);
        run(&mut taken, time);
        assert_eq!(steps(&taken), steps(&left), "{time}");
    }
    assert!(steps(&left).0 != before.0 && steps(&left).1 != before.1, "{before:?}");
}

/// What a session of the first text is when it is continued with the second: the step of the main motion, and of each beside it.
fn steps_of_continued([first, second]: [&str; 2], another_law: bool) -> (f64, Vec<Option<f64>>) {
    let mut left = build(first, |_| {});
    run(&mut left, 0.5);
    left.execute(Command::Pin);
    left.execute(Command::AddNeighbour);
    let seen = left.snapshot();
    let checkpoint = Checkpoint::of(left.model(), left.system(), &seen);
    let checkpoint = if another_law { checkpoint.with_another_law("the text") } else { checkpoint };
    let mut taken = build(second, |_| {});
    taken.execute(Command::Restore(Box::new(checkpoint)));
    let seen = taken.snapshot();
    assert_eq!(seen.companions.len(), 2);
    (seen.method.step, seen.companions.iter().map(|one| one.fixed_step).collect())
}

fn spring(stiffness: f64, run: &str) -> String {
    format!(
        "title = \"A spring\"\n[coordinates]\nx = {{ initial = 1 }}\n[lagrangian]\nL = \"1/2*x'^2 - 1/2*{stiffness}*x^2\"\n\
         [run]\n{run}\n"
    )
}

/// A step that was chosen for a soft spring is far beyond stability for a stiff one.
#[test]
fn under_another_law_every_motion_chooses_its_step_anew() {
    let texts = [spring(1.0, "method = \"rk4\""), spring(1e4, "method = \"rk4\"")];
    let (step, beside) = steps_of_continued([&texts[0], &texts[1]], true);
    let [pinned, neighbour] = beside[..] else { panic!("{beside:?}") };
    assert_eq!(pinned, Some(step));
    assert!((neighbour.unwrap() / step - 1.0).abs() < 1e-3, "{neighbour:?}, {step}");
    let (soft, _) = steps_of_continued([&texts[0], &texts[0]], false);
    assert!(soft > 50.0 * step, "{soft}, {step}");
    // what a person has set stays
    let set = texts.map(|text| text + "step = 0.001\n");
    assert_eq!(steps_of_continued([&set[0], &set[1]], true), (0.001, vec![Some(0.001); 2]));
}

/// A neighbour has the method of the main motion, and its step where one is set: a step that another method has chosen is not
/// its own, nor is one that was set before.
#[test]
fn a_neighbour_does_not_keep_the_step_of_another_method() {
    let [rk4, leapfrog, set] =
        ["method = \"rk4\"", "method = \"leapfrog\"", "method = \"rk4\"\nstep = 0.003"]
            .map(|run| spring(1.0, run));
    let (step, beside) = steps_of_continued([&rk4, &leapfrog], false);
    assert!((beside[1].unwrap() / step - 1.0).abs() < 1e-3, "{beside:?}, {step}");
    let (step, beside) = steps_of_continued([&rk4, &set], false);
    assert_eq!((step, beside[1]), (0.003, Some(0.003)));
    let (step, beside) = steps_of_continued([&set, &rk4], false);
    assert!((beside[1].unwrap() / step - 1.0).abs() < 1e-3, "{beside:?}, {step}");
}
