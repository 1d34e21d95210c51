//! One step back in time: the state, the rows and the events are those that were there.

use phaselab::experiment::{Command, Experiment, Status};

use super::{run, shipped};

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
        for method in ["taylor", "rk4", "verlet", "gauss6"] {
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
