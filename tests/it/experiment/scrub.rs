//! The recorded past looked at: what is seen is what was there, and nothing is changed by looking.

use phaselab::experiment::{Command, Status};

use super::{run, shipped};

#[test]
fn what_is_seen_of_the_past_is_what_a_run_to_that_time_gives() {
    for name in ["henon-heiles", "pendulum", "heavy-top", "duffing", "bouncing-ball"] {
        let mut experiment = shipped(name);
        run(&mut experiment, 4.0);
        for time in [0.0, 0.7, 3.1, 1.9, 2.0] {
            experiment.execute(Command::ScrubTo(time));
            let seen = experiment.snapshot();
            assert_eq!((seen.time, &seen.status), (time, &Status::Paused));
            assert!(seen.recorded.scrubbed);
            assert_eq!((seen.recorded.from, seen.recorded.to), (0.0, 4.0));
            let mut alone = shipped(name);
            run(&mut alone, time);
            let there = alone.snapshot();
            let pairs = seen.values.iter().zip(there.values.iter());
            let off = pairs.filter(|(a, _)| a.is_finite());
            let off = off.map(|(a, b)| (a - b).abs() / (1.0 + b.abs())).fold(0.0, f64::max);
            assert!(off < 4e-15, "{name} at {time}: {off:e}");
            let rows = |s: &phaselab::experiment::Snapshot| {
                s.trail.rows().filter(|row| row[0] < time).count()
            };
            assert_eq!(
                rows(&seen),
                seen.trail.rows().filter(|row| row[0] <= time).count().min(rows(&seen))
            );
            assert!(seen.trail.rows().all(|row| row[0] <= time));
            assert_eq!(seen.crossings.counts(), there.crossings.counts(), "{name} at {time}");
            for surface in 0..seen.crossings.counts().len() {
                let channels = seen.values.len();
                let times = |s: &phaselab::experiment::Snapshot| -> Vec<f64> {
                    s.crossings.rows(surface, channels).map(|row| row[0]).collect()
                };
                assert_eq!(times(&seen), times(&there), "{name} at {time}");
            }
        }
    }
}

#[test]
fn looking_changes_nothing_to_the_last_bit() {
    let (mut looked, mut alone) = (shipped("henon-heiles"), shipped("henon-heiles"));
    run(&mut looked, 20.0);
    run(&mut alone, 20.0);
    for time in [3.0, 17.5, 0.0] {
        looked.execute(Command::ScrubTo(time));
        assert_eq!(looked.snapshot().time, time);
    }
    looked.execute(Command::ScrubTo(99.0));
    let (seen, there) = (looked.snapshot(), alone.snapshot());
    assert!(!seen.recorded.scrubbed);
    assert_eq!((seen.time, &seen.values), (20.0, &there.values));
    assert_eq!(seen.trail, there.trail);
    run(&mut looked, 31.0);
    run(&mut alone, 31.0);
    assert_eq!(looked.values(), alone.values());
    assert_eq!(looked.snapshot().trail, alone.snapshot().trail);
}

#[test]
fn an_action_takes_the_motion_up_where_it_is_looked_at() {
    let mut experiment = shipped("henon-heiles");
    run(&mut experiment, 20.0);
    experiment.execute(Command::ScrubTo(5.0));
    experiment.execute(Command::Step(1));
    let seen = experiment.snapshot();
    assert!(seen.recorded.scrubbed && seen.time > 5.0 && seen.recorded.to == 20.0);
    experiment.execute(Command::StepBack(1));
    assert!((experiment.snapshot().time - 5.0).abs() < 1e-14);
    experiment.execute(Command::ScrubTo(5.0));
    experiment.execute(Command::Play);
    let seen = experiment.snapshot();
    assert_eq!((seen.time, seen.status, seen.recorded.to), (5.0, Status::Running, 5.0));
    run(&mut experiment, 20.0);
    let mut alone = shipped("henon-heiles");
    run(&mut alone, 20.0);
    let pairs = experiment.values().iter().zip(alone.values());
    assert!(pairs.filter(|(a, _)| a.is_finite()).all(|(a, b)| (a - b).abs() < 1e-13));
}

#[test]
fn what_is_not_known_any_more_is_said_and_the_first_time_that_is_shown() {
    let mut experiment = shipped("pendulum");
    run(&mut experiment, 2.0);
    experiment.execute(Command::Parameter { index: 0, value: 2.0 });
    run(&mut experiment, 3.0);
    experiment.execute(Command::ScrubTo(1.0));
    let seen = experiment.snapshot();
    assert_eq!((seen.time, seen.recorded.from), (2.0, 2.0));
    assert_eq!(seen.notices.last().unwrap(), "the motion before t = 2 is no longer recorded");
}

#[test]
fn the_way_back_can_be_looked_at_too() {
    let mut experiment = shipped("henon-heiles");
    run(&mut experiment, 10.0);
    experiment.execute(Command::Reverse);
    experiment.advance(-2.0, super::PLENTY);
    experiment.execute(Command::ScrubTo(6.0));
    let seen = experiment.snapshot();
    assert_eq!((seen.time, seen.recorded.from, seen.recorded.to), (6.0, 10.0, 2.0));
    let mut alone = shipped("henon-heiles");
    run(&mut alone, 6.0);
    let pairs = seen.values.iter().zip(alone.values());
    assert!(pairs.filter(|(a, _)| a.is_finite()).all(|(a, b)| (a - b).abs() < 1e-13));
    assert!(seen.trail.rows().all(|row| row[0] >= 6.0));
}

#[test]
fn the_motions_beside_it_have_their_crossings_up_to_there() {
    let mut experiment = shipped("henon-heiles");
    experiment.execute(Command::AddNeighbour);
    run(&mut experiment, 60.0);
    let crossed = |experiment: &phaselab::experiment::Experiment, until: f64| {
        let seen = experiment.snapshot();
        let one = &seen.companions[0];
        let rows = one.crossings.rows(0, one.values.len());
        rows.map(|row| row[0]).filter(|time| *time <= until).collect::<Vec<_>>()
    };
    let (all, early) = (crossed(&experiment, 60.0), crossed(&experiment, 25.0));
    assert!(!early.is_empty() && early.len() < all.len());
    experiment.execute(Command::ScrubTo(25.0));
    assert_eq!(crossed(&experiment, 60.0), early);
    experiment.execute(Command::ScrubTo(60.0));
    assert_eq!(crossed(&experiment, 60.0), all);
}
