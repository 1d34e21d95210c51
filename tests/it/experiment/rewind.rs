//! One step back in time: the state, the rows and the events are those that were there.

use phaselab::experiment::{Command, Experiment, Setup, Status};
use phaselab::system::InitialOverride::Position;

use super::{PLENTY, build, run, shipped};

const FRAME: f64 = 1.0 / 60.0;

/// The state at a time, of a motion that only went forwards.
fn at(name: &str, method: &str, time: f64) -> Experiment {
    let mut experiment = shipped(name);
    experiment.execute(Command::Method(method.to_owned()));
    run(&mut experiment, time);
    experiment
}

#[test]
fn a_step_back_leads_to_the_bits_that_were_there_and_on_again() {
    for name in ["henon-heiles", "pendulum", "heavy-top"] {
        for method in ["taylor", "rk4", "leapfrog", "gauss6"] {
            let mut experiment = shipped(name);
            let before = experiment.snapshot().notices.len();
            experiment.execute(Command::Method(method.to_owned()));
            if experiment.snapshot().method.name != method {
                assert!(experiment.snapshot().notices.len() > before, "{name} refuses {method}");
                continue;
            }
            run(&mut experiment, 3.0);
            let frame = FRAME * experiment.speed();
            let mut forwards = Vec::new();
            for _ in 0..40 {
                forwards.push((experiment.time(), experiment.snapshot().state));
                experiment.execute(Command::Step(1));
            }
            for (time, state) in forwards.iter().rev() {
                experiment.execute(Command::StepBack(1));
                let seen = experiment.snapshot();
                assert_eq!(seen.status, Status::Paused);
                assert!((seen.time - time).abs() < 1e-12, "{} {time}", seen.time);
                let pairs = seen.state.values.iter().zip(&state.values);
                let off = pairs.map(|(a, b)| (a - b).abs() / (1.0 + b.abs())).fold(0.0, f64::max);
                // the times differ in their last digits, and the states by as much
                assert!(off < 1e-13, "{name} by {method} at {time}: {off:e}");
            }
            assert!(experiment.time() < 3.0 + 0.5 * frame);
            run(&mut experiment, 5.0);
            let there = at(name, method, 5.0);
            let (a, b) = (experiment.snapshot().state, there.snapshot().state);
            let pairs = a.values.iter().zip(&b.values);
            let off = pairs.map(|(a, b)| (a - b).abs() / (1.0 + b.abs())).fold(0.0, f64::max);
            assert!(off < 1e-12, "{name} by {method}: {off:e}");
        }
    }
}

#[test]
fn a_step_back_at_times_that_are_numbers_is_exact_to_the_bit() {
    let mut experiment = shipped("henon-heiles");
    // a frame of exactly 2⁻⁴
    experiment.execute(Command::Speed(60.0 / 16.0));
    let mut forwards = Vec::new();
    for _ in 0..400 {
        forwards.push(experiment.snapshot().state);
        experiment.execute(Command::Step(1));
    }
    for state in forwards.iter().rev() {
        experiment.execute(Command::StepBack(1));
        assert_eq!(experiment.snapshot().state.time, state.time);
        assert_eq!(experiment.snapshot().state.values, state.values, "t = {}", state.time);
    }
    experiment.execute(Command::StepBack(1));
    assert_eq!(experiment.time(), 0.0);
    assert_eq!(
        experiment.snapshot().notices.last().unwrap(),
        "this is the beginning of the motion"
    );
}

#[test]
fn rows_and_crossings_after_it_are_gone_and_come_again() {
    let mut experiment = shipped("henon-heiles");
    run(&mut experiment, 30.0);
    let crossed = experiment.crossings().counts()[0];
    assert!(crossed > 3);
    experiment.execute(Command::Speed(600.0));
    experiment.execute(Command::StepBack(1));
    assert_eq!(experiment.time(), 20.0);
    let seen = experiment.snapshot();
    assert!(experiment.crossings().counts()[0] < crossed);
    assert!(seen.trail.rows().all(|row| row[0] <= 20.0));
    assert_eq!(seen.trail.rows().next_back().unwrap()[0], 20.0);
    run(&mut experiment, 30.0);
    assert_eq!(experiment.crossings().counts()[0], crossed);
    let times: Vec<f64> = experiment.snapshot().trail.rows().map(|row| row[0]).collect();
    assert!(times.windows(2).all(|pair| pair[0] < pair[1]));
    assert!(experiment.snapshot().gauges[0].max_drift < 1e-12);
}

#[test]
fn an_impulse_is_taken_back_and_happens_again() {
    let mut experiment = shipped("bouncing-ball");
    run(&mut experiment, 4.0);
    let (count, values) = (experiment.occurrences().count(), experiment.values().to_vec());
    assert!(count > 1);
    experiment.execute(Command::Speed(180.0));
    experiment.execute(Command::StepBack(1));
    assert_eq!(experiment.time(), 1.0);
    assert!(experiment.occurrences().count() < count);
    run(&mut experiment, 4.0);
    assert_eq!(experiment.occurrences().count(), count);
    let off = values.iter().zip(experiment.values()).map(|(a, b)| (a - b).abs());
    assert!(off.filter(|x| x.is_finite()).fold(0.0, f64::max) < 1e-11);
}

/// A method that chooses its step does so anew at each impulse. Before an impulse the step was another one.
#[test]
fn before_an_impulse_the_steps_are_those_that_were_taken_there() {
    let text = "title = \"Struck\"\n[coordinates]\nx = { initial = 2 }\n[lagrangian]\nL = \"1/2*x'^2 - 1/4*x^4\"\n\
                [[impulses]]\nname = \"push\"\nevery = 3\nchange = { p_x = \"5*(t - 2)\" }\n";
    for method in ["rk4", "leapfrog", "gauss4", "yoshida4"] {
        let begun = || build(text, |setup| setup.method = method.into());
        let (mut back, mut alone) = (begun(), begun());
        run(&mut alone, 2.125);
        let (there, step) = (alone.snapshot().state, alone.snapshot().method.step);
        run(&mut back, 4.125);
        assert!(back.snapshot().method.step != step, "{method}: no other step after the impulse");
        back.execute(Command::ScrubTo(2.125));
        assert_eq!(back.snapshot().state.values, there.values, "{method}, looked at");
        back.execute(Command::ScrubTo(f64::INFINITY));
        // a frame of one second
        back.execute(Command::Speed(60.0));
        back.execute(Command::StepBack(2));
        let seen = back.snapshot();
        assert_eq!((seen.time, seen.method.step), (2.125, step), "{method}");
        assert_eq!(seen.state.values, there.values, "{method}, carried back");
        run(&mut back, 7.5);
        run(&mut alone, 7.5);
        assert_eq!(back.snapshot().state, alone.snapshot().state, "{method}, on again");
        assert_eq!(back.snapshot().method.step, alone.snapshot().method.step, "{method}");
    }
}

/// A mass that is halved at t = 1, where the velocity jumps: before and after it the past is what it was, and time can be reversed.
#[test]
fn a_step_in_time_is_gone_back_over_and_taken_again() {
    let text = "title = \"Halved\"\n[coordinates]\nx = { initial = 2 }\n[lagrangian]\n\
                L = \"1/4*(3 - sign(t - 1))*x'^2 - 1/2*x^2\"\n";
    for method in ["taylor", "dop853", "rk4"] {
        let begun = || build(text, |setup| setup.method = method.into());
        let there = |time: f64| {
            let mut alone = begun();
            run(&mut alone, time);
            alone.snapshot().state.values.clone()
        };
        let mut back = begun();
        run(&mut back, 3.0);
        // a frame of half a second
        back.execute(Command::Speed(30.0));
        let same = |found: &[f64], time: f64, what: &str| {
            for (a, b) in found.iter().zip(there(time)) {
                assert!((a - b).abs() < 1e-11, "{method}, {what} {time}: {a} and {b}");
            }
        };
        for time in [1.25, 0.75, 1.0, 2.0] {
            back.execute(Command::ScrubTo(time));
            same(&back.snapshot().state.values, time, "looked at");
        }
        back.execute(Command::ScrubTo(f64::INFINITY));
        for time in [2.5, 2.0, 1.5, 1.0, 0.5] {
            back.execute(Command::StepBack(1));
            assert_eq!(back.time(), time);
            same(&back.snapshot().state.values, time, "carried back to");
        }
        run(&mut back, 2.0);
        same(&back.snapshot().state.values, 2.0, "on again to");
    }
    let mut back = build(text, |setup| setup.method = "taylor".into());
    run(&mut back, 2.0);
    back.execute(Command::Play);
    back.execute(Command::Reverse);
    assert!(back.is_backwards(), "{:?}", back.snapshot().notices);
    back.advance(f64::INFINITY, PLENTY);
    let seen = back.snapshot();
    let returned = seen.returned.clone().expect("it has returned");
    assert!(returned.error.is_some_and(|error| error < 1e-13), "{returned:?}");
}

#[test]
fn what_came_before_another_law_is_not_gone_back_to() {
    let mut experiment = shipped("pendulum");
    run(&mut experiment, 2.0);
    experiment.execute(Command::Parameter { index: 0, value: 2.0 });
    run(&mut experiment, 2.01);
    let values = experiment.values().to_vec();
    experiment.execute(Command::StepBack(1));
    assert_eq!((experiment.time(), experiment.values()), (2.01, &values[..]));
    let said = experiment.snapshot().notices.last().unwrap().clone();
    assert_eq!(said, "the motion before t = 2 is no longer recorded");
    run(&mut experiment, 2.1);
    experiment.execute(Command::StepBack(1));
    assert!(experiment.time() < 2.1 && experiment.time() > 2.0);
}

#[test]
fn motions_beside_it_are_seen_where_they_were() {
    let mut experiment = shipped("henon-heiles");
    experiment.execute(Command::AddNeighbour);
    run(&mut experiment, 3.0);
    let known: Vec<(f64, f64)> =
        experiment.snapshot().companions[0].trail.rows().map(|row| (row[0], row[1])).collect();
    experiment.execute(Command::Speed(60.0));
    experiment.execute(Command::StepBack(1));
    let seen = experiment.snapshot();
    assert_eq!(seen.time, 2.0);
    let one = &seen.companions[0];
    assert!(one.time <= 2.0 && one.time > 1.9);
    assert!(known.contains(&(one.time, one.values[0])));
    run(&mut experiment, 5.0);
    let times: Vec<f64> =
        experiment.snapshot().companions[0].trail.rows().map(|row| row[0]).collect();
    assert!(times.windows(2).all(|pair| pair[0] <= pair[1]));
    assert_eq!(experiment.snapshot().companions[0].time, 5.0);
}

/// A pendulum with a motion from ½ beside it and a neighbour, and one of its own from ½, which has never gone back.
fn beside_the_pendulum() -> (Experiment, Experiment, usize) {
    let mut main = shipped("pendulum");
    let g = main.model().parameters.iter().position(|p| p.name == "g").expect("it has a weight");
    main.execute(Command::AddStart(vec![Position(0, 0.5)]));
    main.execute(Command::AddNeighbour);
    let loaded = crate::fixtures::loaded("pendulum", 1);
    let setup = Setup { overrides: vec![Position(0, 0.5)], ..Setup::of(&loaded.model) };
    let alone = Experiment::new(&loaded.model, &loaded.equations, &loaded.system, setup);
    (main, alone.expect("its method fits"), g)
}

/// After a step back the motions beside the main one are farther than it is. A law that is changed there is changed for them at
/// the same time, not where they had come to.
#[test]
fn motions_beside_it_meet_another_law_where_it_does() {
    let (mut main, mut alone, g) = beside_the_pendulum();
    run(&mut main, 3.0);
    // a frame of one second
    main.execute(Command::Speed(60.0));
    main.execute(Command::StepBack(1));
    assert_eq!(main.time(), 2.0);
    main.execute(Command::Parameter { index: g, value: 3.0 });
    run(&mut alone, 2.0);
    alone.execute(Command::Parameter { index: g, value: 3.0 });
    for time in [2.5, 4.0] {
        run(&mut main, time);
        run(&mut alone, time);
        let seen = main.snapshot();
        let [start, neighbour] = &seen.companions[..] else { panic!("two are beside it") };
        assert_eq!((start.time, neighbour.time), (time, time));
        let off = start.values[0] - alone.values()[0];
        assert!(off.abs() < 1e-11, "{time}: {off:e}");
        let beside = neighbour.values[0] - seen.values[0];
        assert!(beside != 0.0 && beside.abs() < 1e-7, "{time}: {beside:e}");
        let times: Vec<f64> = start.trail.rows().map(|row| row[0]).collect();
        assert!(times.windows(2).all(|pair| pair[0] <= pair[1]), "{time}");
        assert!(start.trail.rows().all(|row| row[0] <= time));
    }
}

/// What is still on its way to where the main motion is changes its law where that did.
#[test]
fn motions_that_are_behind_meet_another_law_at_its_time() {
    let (_, mut alone, g) = beside_the_pendulum();
    let mut main = shipped("pendulum");
    run(&mut main, 3.0);
    main.execute(Command::AddStart(vec![Position(0, 0.5)]));
    assert!(main.is_behind());
    main.execute(Command::Parameter { index: g, value: 3.0 });
    run(&mut main, 4.0);
    run(&mut alone, 3.0);
    alone.execute(Command::Parameter { index: g, value: 3.0 });
    run(&mut alone, 4.0);
    let seen = main.snapshot();
    let off = seen.companions[0].values[0] - alone.values()[0];
    assert!(off.abs() < 1e-11, "{off:e}");
    assert_eq!(seen.companions[0].parameters[g], 3.0);
}

/// A neighbour that joined later is not there where the main motion has gone back to, which is said of it.
#[test]
fn before_it_joined_nothing_is_known_of_a_neighbour() {
    let mut main = shipped("pendulum");
    run(&mut main, 2.5);
    main.execute(Command::AddNeighbour);
    run(&mut main, 3.0);
    main.execute(Command::Speed(60.0));
    main.execute(Command::StepBack(1));
    main.execute(Command::Pin);
    main.execute(Command::Parameter { index: 0, value: 1.5 });
    run(&mut main, 4.0);
    let seen = main.snapshot();
    let said = seen.companions[0].message.as_deref();
    assert_eq!(said, Some("nothing is known of it before t = 2.5"));
    assert_eq!((&seen.companions[1].message, seen.companions[1].time), (&None, 4.0));
}
