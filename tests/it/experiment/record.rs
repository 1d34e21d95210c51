//! The record, which depends on nothing but the commands.

use phaselab::experiment::{AdvanceOutcome, Command, Experiment};

use super::{PLENTY, build, run, shipped};

fn rows(experiment: &Experiment) -> Vec<Vec<u64>> {
    let trail = experiment.snapshot().trail;
    trail.rows().map(|row| row.iter().map(|x| x.to_bits()).collect()).collect()
}

#[test]
fn the_same_commands_give_the_same_bits() {
    let drive = || {
        let mut system = shipped("double-pendulum");
        run(&mut system, 2.0);
        system.execute(Command::Parameter { index: 0, value: 1.5 });
        run(&mut system, 4.0);
        system.execute(Command::Initial { index: 0, value: 1.0 });
        run(&mut system, 3.0);
        system
    };
    let (one, other) = (drive(), drive());
    assert_eq!(rows(&one), rows(&other));
    assert_eq!(format!("{:?}", one.snapshot().gauges), format!("{:?}", other.snapshot().gauges));
}

#[test]
fn small_slices_give_the_same_rows_as_one_large_one() {
    let mut whole = shipped("henon-heiles");
    let mut sliced = shipped("henon-heiles");
    run(&mut whole, 20.0);
    let mut slices = 0;
    while sliced.advance(20.0, 3) == AdvanceOutcome::Underway {
        slices += 1;
    }
    assert!(slices > 100);
    assert_eq!(rows(&whole), rows(&sliced));
    // and taking snapshots on the way changes nothing either
    let mut watched = shipped("henon-heiles");
    for k in 1..=2000 {
        run(&mut watched, 0.01 * f64::from(k));
    }
    assert_eq!(rows(&whole), rows(&watched));
}

#[test]
fn rows_rise_in_time_and_lie_within_the_bounds() {
    let mut system = shipped("planet");
    run(&mut system, 3.0);
    let snapshot = system.snapshot();
    let times: Vec<f64> = snapshot.trail.rows().map(|row| row[0]).collect();
    assert_eq!(times[0], 0.0);
    assert!(times.windows(2).all(|pair| pair[0] < pair[1]));
    assert!(times[times.len() - 1] > 2.9);
    for row in snapshot.trail.rows() {
        for (x, (least, greatest)) in row[1..].iter().zip(snapshot.bounds.iter()) {
            assert!((least..=greatest).contains(&x) || x.is_nan());
        }
    }
    assert_eq!(snapshot.bounds.len(), system.system().channels().len());
    // r runs between a(1 − e) and a(1 + e)
    let (least, greatest) = snapshot.bounds[0];
    assert!(least == 0.4 && (1.5999..=1.6).contains(&greatest), "{least} {greatest}");
}

#[test]
fn a_curve_is_smooth_at_every_speed() {
    for speed in [0.01, 1.0, 1e3, f64::INFINITY] {
        let mut system = shipped("harmonic-oscillator");
        system.execute(Command::Speed(speed));
        system.execute(Command::Reset);
        run(&mut system, 30.0);
        let trail = system.snapshot().trail;
        let times: Vec<f64> = trail.rows().map(|row| row[0]).collect();
        let widest = times.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
        assert!(widest < 0.12, "{widest} at speed {speed}");
    }
}

#[test]
fn flat_out_a_frame_gets_no_more_rows_than_it_can_show() {
    for method in ["taylor", "yoshida4"] {
        let mut system = shipped("henon-heiles");
        system.execute(Command::Method(method.to_owned()));
        system.execute(Command::Speed(f64::INFINITY));
        let mut rows = Vec::new();
        let mut drifts = Vec::new();
        for _ in 0..12 {
            // all steps that a frame has time for: rows count among them
            let begin = system.time();
            for _ in 0..8 {
                assert_eq!(system.advance(f64::INFINITY, 1000), AdvanceOutcome::Underway);
            }
            let trail = system.snapshot().trail;
            rows.push(trail.rows().filter(|row| row[0] > begin).count());
            drifts.push(system.snapshot().gauges[0].drift);
            system.shown();
        }
        assert!(rows[0] > 3000, "{method}: {rows:?}");
        assert!(rows[8..].iter().all(|rows| (100..4200).contains(rows)), "{method}: {rows:?}");
        // what is conserved is looked at all the same
        assert!(drifts.iter().all(|drift| drift.abs() < 1e-3), "{method}: {drifts:?}");
        // at a finite speed the curve is smooth again
        system.execute(Command::Speed(1.0));
        let begin = system.time();
        run(&mut system, begin + 20.0);
        let times: Vec<f64> = system.snapshot().trail.rows().map(|row| row[0]).collect();
        let late = times.windows(2).filter(|pair| pair[0] > begin + 1.0);
        let widest = late.map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
        assert!(widest < 0.12, "{method}: {widest}");
    }
}

#[test]
fn a_motion_of_another_time_scale_is_recorded_alike() {
    // a period of a year in seconds, and of a femtosecond
    for (k, period) in [("4e-14", 31_415_926.5), ("4e31", 1e-15)] {
        let text = format!(
            "title = \"T\"\n[coordinates]\nx = {{ initial = 1 }}\n[parameters]\nk = {k}\n\
             [lagrangian]\nL = \"1/2*x'^2 - 1/2*k*x^2\"\n[run]\nspeed = {}\n",
            period / 10.0
        );
        let mut system = build(&text, |_| ());
        run(&mut system, 3.0 * period);
        let rows = system.snapshot().trail.len();
        assert!((100..10_000).contains(&rows), "{rows} rows for a period of {period}");
    }
}

#[test]
fn a_motion_that_is_a_polynomial_is_not_over_in_one_row() {
    let text = "title = \"T\"\n[coordinates]\nx = { initial = 0, velocity = 1 }\n\
                [lagrangian]\nL = \"1/2*x'^2 - x\"\n";
    let mut system = build(text, |_| ());
    run(&mut system, 100.0);
    assert!(system.snapshot().trail.len() > 1000);
    system.execute(Command::Speed(f64::INFINITY));
    assert_eq!(system.advance(f64::INFINITY, 1000), AdvanceOutcome::Underway);
    assert!(system.time().is_finite());
}

#[test]
fn memory_is_bounded_in_a_long_run() {
    let mut system = shipped("harmonic-oscillator");
    run(&mut system, 3000.0);
    let trail = system.snapshot().trail;
    assert!((5_000..=25_000).contains(&trail.len()), "{}", trail.len());
    assert!(trail.rows().next_back().expect("rows")[0] > 2999.9);
}

#[test]
fn a_budget_is_kept() {
    let mut system = shipped("double-pendulum");
    assert_eq!(system.advance(1e6, 50), AdvanceOutcome::Underway);
    assert!(system.time() > 0.0 && system.time() < 100.0);
    assert!(system.snapshot().method.steps <= 50);
    assert_eq!(system.advance(system.time(), PLENTY), AdvanceOutcome::Arrived);
}
