//! Verdicts on artificial drifts of every kind.

use phaselab::analysis::{Errors, Growth, History, Verdict, rounding_floor};

const FLOOR: f64 = 1e-12;

/// The verdict on `count` values of `drift` at times 0, 0.1, ….
fn verdict(count: u32, drift: impl FnMut(f64) -> f64) -> Verdict {
    let history = history(count, drift);
    Verdict::of(&history, history.peak(), FLOOR, Errors::Accumulated)
}

fn history(count: u32, mut drift: impl FnMut(f64) -> f64) -> History {
    let mut history = History::new();
    for k in 0..count {
        let t = 0.1 * f64::from(k);
        history.push(t, drift(t));
    }
    history
}

fn secular(verdict: &Verdict) -> Option<f64> {
    match verdict {
        Verdict::Secular(slope) => Some(*slope),
        _ => None,
    }
}

/// Uniform noise in [−1, 1), the same in every run (a linear congruential generator with Knuth's constants).
fn noise() -> impl FnMut() -> f64 {
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    move || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / 4_503_599_627_370_496.0 - 1.0
    }
}

#[test]
fn too_short_a_history_stays_open() {
    assert_eq!(verdict(0, |_| 0.0), Verdict::Open);
    assert_eq!(verdict(16, |t| t), Verdict::Open);
    assert_ne!(verdict(40, |t| t), Verdict::Open);
}

#[test]
fn what_never_changes_is_exact_and_level() {
    assert_eq!(verdict(5000, |_| 0.0), Verdict::Exact(Growth::Level));
}

#[test]
fn noise_at_the_floor_is_level_a_walk_a_root_a_bias_faster() {
    let mut white = noise();
    assert_eq!(verdict(5000, |_| 1e-15 * white()), Verdict::Exact(Growth::Level));
    for walk in 0..20 {
        let mut step = noise();
        for _ in 0..walk * 7919 {
            step();
        }
        let mut place = 0.0;
        let found = verdict(20_000, |_| {
            place += 1e-16 * step();
            place
        });
        assert_eq!(found, Verdict::Exact(Growth::Root), "walk {walk}");
    }
    assert_eq!(verdict(5000, |t| 1e-15 * t), Verdict::Exact(Growth::Faster));
}

#[test]
fn what_swings_is_bounded_at_any_rate_and_shape() {
    for rate in [0.09, 0.31, 1.0, 6.3, 17.0, 400.0] {
        assert_eq!(verdict(6000, |t| 1e-4 * (1.0 - (rate * t).cos())), Verdict::Bounded, "{rate}");
    }
    // short spikes, as at the pericentre of a narrow ellipse
    assert_eq!(verdict(6000, |t| 1e-3 / (1.0 + 400.0 * t.sin().powi(2))), Verdict::Bounded);
    // two incommensurable frequencies, and noise above the floor
    assert_eq!(verdict(6000, |t| 1e-6 * (t.sin() + (2_f64.sqrt() * t).sin())), Verdict::Bounded);
    let mut white = noise();
    assert_eq!(verdict(6000, |_| 1e-9 * white()), Verdict::Bounded);
}

/// The energy under a Runge–Kutta method after two, three and four passages: each changes its level by what depends on where
/// the steps fall. Nothing is said of it that the next passage would take back.
#[test]
fn a_few_changes_of_level_are_no_oscillation() {
    for levels in [&[0.0, 1.0, 0.3][..], &[0.0, 1.0, 0.2, 0.9], &[0.0, 0.4, -0.5, 0.6, 0.1]] {
        let level = |t: f64| {
            let k = (t / 600.0 * levels.len() as f64) as usize;
            1e-9 * levels[k.min(levels.len() - 1)]
        };
        assert_eq!(verdict(6000, level), Verdict::Open, "{levels:?}");
    }
}

/// A value that moves to another level once is not bounded: it neither oscillates nor returns.
#[test]
fn what_leaves_for_another_level_is_secular() {
    for start in [3.0, 100.0, 300.0, 500.0] {
        let jump = |t: f64| if t < start { 0.0 } else { 1e-5 };
        let rate = secular(&verdict(6000, jump)).expect("a jump that stays");
        assert!((0.0..1e-5 / 100.0).contains(&rate), "{rate}");
        let uneven = |t: f64| jump(t) + 2e-6 * (3.0 * t).sin();
        assert!(secular(&verdict(6000, uneven)).is_some(), "{start}");
        // a function of the state may change its level with every passage through a narrow place
        let history = history(6000, uneven);
        let of_state = Verdict::of(&history, history.peak(), FLOOR, Errors::OfState);
        assert_eq!(of_state, Verdict::Bounded, "{start}");
    }
    assert!(secular(&verdict(6000, |t| -1e-5 * (1.0 - (-t / 10.0).exp()))).unwrap() < 0.0);
    // a loss that alternates between much and little
    let lost = |t: f64| {
        [(40.0, 3.0), (220.0, 0.3), (430.0, 4.0)]
            .iter()
            .filter(|l| t > l.0)
            .map(|l| l.1)
            .sum::<f64>()
    };
    let uneven = |t: f64| -1e-6 * (lost(t) + 0.2 * (1.3 * t).sin());
    assert!(secular(&verdict(6000, uneven)).is_some_and(|rate| rate < 0.0));
}

/// An uneven oscillation about a level is bounded, whatever its beginning.
#[test]
fn what_begins_at_its_extreme_and_stays_away_is_bounded() {
    let swing = |t: f64| 1.0 + 0.5 * t.sin() + 0.3 * (2.7 * t).sin() * (0.31 * t).cos();
    let away = |t: f64| 1e-5 * swing(t) * (1.0 - (-t).exp());
    for count in [300, 1000, 6000, 60_000] {
        assert_eq!(verdict(count, away), Verdict::Bounded, "{count}");
    }
}

#[test]
fn what_grows_is_secular_with_its_slope() {
    for slope in [-3e-7, 2e-9, 1e-3] {
        let found = secular(&verdict(6000, |t| slope * t)).expect("a straight line is a trend");
        assert!((found / slope - 1.0).abs() < 1e-9, "{found} for {slope}");
    }
    // a staircase, one step a period
    let stairs = secular(&verdict(6000, |t| -1e-6 * (t / 7.3).floor()));
    assert!((stairs.expect("a staircase is a trend") / (-1e-6 / 7.3) - 1.0).abs() < 0.05);
}

/// Under a symplectic method an error that only goes one way may be that of a state that only goes one way. A staircase with a
/// step in each of twenty periods is not: the state has returned, and its error has not.
#[test]
fn a_staircase_of_a_function_of_the_state_is_secular_where_the_motion_has_returned() {
    let verdict = |drift: &dyn Fn(f64) -> f64| {
        let history = history(6000, drift);
        Verdict::of(&history, history.peak(), FLOOR, Errors::OfState)
    };
    // a step of this part of a period, as a passage through the pericentre
    let stairs = |periods: f64, t: f64| {
        let phase = periods * t / 600.0;
        phase.floor() + (phase.fract() / 0.2).min(1.0)
    };
    for periods in [10.0, 20.0, 29.3] {
        let slope = secular(&verdict(&|t| -1e-7 * stairs(periods, t)));
        let expected = -1e-7 * periods / 600.0;
        assert!((slope.expect("a staircase") / expected - 1.0).abs() < 0.05, "{periods}");
    }
    // with few steps their chance may be that of the places where the method's steps fall
    assert_eq!(verdict(&|t| 1e-7 * stairs(4.0, t)), Verdict::Open);
    // a part of a swing, with ripples much smaller than its bend, and a line
    for width in [0.4, 0.8, 1.4] {
        let swing = |t: f64| 1e-6 * (width * (t / 300.0 - 1.0)).sin();
        assert_eq!(verdict(&swing), Verdict::Open, "{width}");
        let bend = 1e-6 * width.powi(3) / 30.0;
        let rippled = |t: f64| swing(t) + 0.1 * bend * (0.3 * t).sin();
        assert_eq!(verdict(&rippled), Verdict::Open, "{width}");
    }
    assert_eq!(verdict(&|t| 1e-7 * t), Verdict::Open);
}

#[test]
fn a_trend_is_found_under_a_swing_ten_times_its_size() {
    let found = verdict(6000, |t| 1e-8 * t + 6e-5 * (2.0 * t).sin());
    let slope = secular(&found).expect("600 time units of 1e-8 against 6e-5");
    assert!((slope / 1e-8 - 1.0).abs() < 0.05, "{slope}");
    // the same oscillation without the trend has none
    assert_eq!(verdict(6000, |t| 6e-5 * (2.0 * t).sin()), Verdict::Bounded);
}

#[test]
fn a_trend_is_the_same_however_long_the_history() {
    for count in [200, 1_000, 30_000, 1_000_000] {
        assert!(secular(&verdict(count, |t| 1e-6 * t)).is_some(), "{count}");
        assert_eq!(verdict(count, |t| 1e-6 * (5.0 * t).sin()), Verdict::Bounded, "{count}");
    }
}

#[test]
fn a_drift_above_the_floor_is_never_exact() {
    let mut step = noise();
    let mut place = 0.0;
    let found = verdict(6000, |_| {
        place += 1e-9 * step();
        place
    });
    assert!(matches!(found, Verdict::Bounded | Verdict::Secular(_)), "{found:?}");
}

#[test]
fn values_that_are_not_finite_are_passed_over() {
    let found = verdict(6000, |t| if (t - 30.0).abs() < 1.0 { f64::NAN } else { 0.0 });
    assert_eq!(found, Verdict::Exact(Growth::Level));
}

#[test]
fn a_history_keeps_its_extremes_in_bounded_memory() {
    let history = history(1_000_000, |t| if t == 1234.5 { 9.0 } else { (3.0 * t).sin() });
    assert_eq!(history.peak(), 9.0);
    assert_eq!(history.len(), 1_000_000);
    assert!((64..=128).contains(&history.stretches().len()));
    assert_eq!(history.stretches()[0].start, 0.0);
    assert!(history.stretches().windows(2).all(|pair| pair[0].end < pair[1].start));
}

#[test]
fn the_floor_rises_like_brouwers_walk() {
    assert!(rounding_floor(0) < 4e-15);
    let ratio = rounding_floor(100_000_000) / rounding_floor(1_000_000);
    assert!((9.0..10.1).contains(&ratio), "{ratio}");
}

/// The verdict on 8192 values, 64 to an interval: values that alternate in sign have zero mean in it. What is almost a trend is
/// nothing yet: under a method whose errors accumulate it may become one.
fn alternating(swing: f64, of: impl Fn(f64) -> f64) -> Verdict {
    let mut sign = -1.0;
    verdict(8192, |t| {
        sign = -sign;
        sign * swing + of(t / 819.2)
    })
}

/// Where an oscillation has a period in each of the parts that are compared, or nearly so, their means change slowly.
#[test]
fn no_oscillation_inclines() {
    for tenth in 37..370 {
        for phase in 0..8 {
            let turns = f64::from(tenth) / 10.0;
            let of = |t: f64| {
                (std::f64::consts::TAU * (turns * t / 819.2 + f64::from(phase) / 8.0)).sin()
            };
            assert_eq!(verdict(8192, of), Verdict::Bounded, "{turns} {phase}");
        }
    }
}

/// The mean rises by 0.75 s from the first quarter to the last; within a quarter the values vary by 2 + 0.25 s.
#[test]
fn a_rise_of_a_hundredth_of_the_swing_is_a_trend() {
    let total = |share: f64| 2.0 * share / (0.75 - 0.25 * share);
    assert!(secular(&alternating(1.0, |t| total(0.0105) * t)).is_some());
    assert_eq!(alternating(1.0, |t| total(0.0095) * t), Verdict::Bounded);
}

/// The means of the intervals alternate: six of their standard errors in a quarter of 31 are 1.08.
#[test]
fn a_rise_clears_the_scatter() {
    let scattered = |rise: f64| {
        let mut count = 0;
        verdict(8192, |t| {
            count += 1;
            let side = if ((count - 1) / 64) % 2 == 0 { 1.0 } else { -1.0 };
            side + rise * 128.0 / 96.0 * t / 819.2
        })
    };
    assert!(secular(&scattered(1.3)).is_some());
    assert_eq!(scattered(0.9), Verdict::Open);
}

/// The minima rise by 0.3, the maxima by a fraction of that.
#[test]
fn both_extremes_rise_with_a_trend() {
    let drawn = |part: f64| {
        let mut low = false;
        verdict(8192, |t| {
            low = !low;
            if low { 0.3 * t / 819.2 } else { 1.0 + part * 0.3 * t / 819.2 }
        })
    };
    // 2 part/(1 + part) of the mean: a fifth at 1/9
    assert!(secular(&drawn(0.13)).is_some());
    assert_eq!(drawn(0.09), Verdict::Open);
}

/// In the middle half the rise is a fraction of what it is at the ends.
#[test]
fn a_trend_does_not_rest() {
    let resting = |part: f64| {
        alternating(1.0, move |t| match t {
            ..0.25 => t,
            0.25..0.75 => 0.25 + part * (t - 0.25),
            _ => t - 0.5 + 0.5 * part,
        })
    };
    assert!(secular(&resting(0.22)).is_some());
    assert_eq!(resting(0.13), Verdict::Open);
}

/// A jump in the middle of an oscillation of 2.
#[test]
fn a_level_that_is_left_lies_more_than_a_swing_away() {
    let jump = |height: f64| alternating(1.0, move |t| if t < 0.5 { 0.0 } else { height });
    assert!(secular(&jump(2.5)).is_some());
    assert_eq!(jump(2.3), Verdict::Open);
}

#[test]
fn a_level_that_is_left_lies_far_above_rounding() {
    let jump = |height: f64| verdict(8192, |t| if t < 400.0 { 0.0 } else { height * FLOOR });
    assert!(secular(&jump(8.2)).is_some());
    assert_eq!(jump(7.8), Verdict::Bounded);
    assert!(matches!(jump(0.99), Verdict::Exact(_)));
    assert_eq!(jump(1.01), Verdict::Bounded);
}

#[test]
fn seventeen_stretches_are_enough() {
    assert_eq!(verdict(16, |t| t), Verdict::Open);
    assert_ne!(verdict(17, |t| t), Verdict::Open);
}

/// A thousand times as many samples in one part of the time do not give that part more weight.
#[test]
fn stretches_are_of_time_and_not_of_looks() {
    let mut history = History::new();
    for k in 0..1000 {
        history.push(f64::from(k), 0.0);
    }
    for k in 0..100_000 {
        history.push(1000.0 + 0.001 * f64::from(k), 1e-3);
    }
    assert_eq!(history.len(), 101_000);
    let late = history.stretches().iter().filter(|s| s.start >= 1000.0).count();
    assert!((5..=8).contains(&late), "{late}");
    assert!(secular(&Verdict::of(&history, 1e-3, FLOOR, Errors::Accumulated)).is_some());
}

#[test]
fn an_older_value_goes_where_it_belongs() {
    let mut history = History::new();
    for time in [0.0, 1.0, 2.0, 5.0, 3.0, 4.2, 5.5] {
        history.push(time, time);
    }
    let starts: Vec<f64> = history.stretches().iter().map(|s| s.start).collect();
    assert_eq!(starts, [0.0, 1.0, 2.0, 3.0, 4.2, 5.0]);
}

#[test]
fn the_floor_is_a_few_units_and_a_walk_of_four_deviations() {
    assert_eq!(rounding_floor(0), 16.0 * f64::EPSILON);
    assert_eq!(rounding_floor(10_000), 416.0 * f64::EPSILON);
}

#[test]
fn what_left_at_once_and_stays_away_is_secular_where_errors_accumulate() {
    let verdict = |errors, drift: &dyn Fn(f64) -> f64| {
        let history = history(5000, drift);
        Verdict::of(&history, history.peak(), FLOOR, errors)
    };
    // it leaves in the first step and wobbles by this much
    let left = |wobble: f64| {
        move |t: f64| if t == 0.0 { 0.0 } else { 1.0 + 0.5 * wobble * (3.0 * t).sin() }
    };
    assert!(secular(&verdict(Errors::Accumulated, &left(0.01))).is_some());
    // 1.2 of its swing
    assert!(secular(&verdict(Errors::Accumulated, &left(1.0 / 1.25))).is_some());
    assert_eq!(verdict(Errors::Accumulated, &left(1.0 / 1.15)), Verdict::Bounded);
    // under a symplectic method it returns where the state does
    assert_eq!(verdict(Errors::OfState, &left(0.01)), Verdict::Bounded);
    // where it returns before the end it has not left
    let back = |t: f64| if t == 0.0 || t > 400.0 && t < 401.0 { 0.0 } else { 1.0 };
    assert_eq!(verdict(Errors::Accumulated, &back), Verdict::Open);
    let often = |t: f64| if t == 0.0 || t % 100.0 > 99.0 { 0.0 } else { 1.0 };
    assert_eq!(verdict(Errors::Accumulated, &often), Verdict::Bounded);
    // beyond the rounding floor
    let rounding = |size: f64| {
        let history = history(5000, move |t| size * f64::from(u8::from(t > 0.0)));
        Verdict::of(&history, 0.0, 1.0, Errors::Accumulated)
    };
    assert!(matches!(rounding(0.95), Verdict::Exact(_)));
    assert!(secular(&rounding(1.05)).is_some());
}
