//! `dop853` compared with an independent program of the same method on every shipped preset: its error is at most ten
//! times as large, at every tolerance.
//!
//! The independent program is the plain method of Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I,
//! II.4 and II.5: one tolerance for absolute and relative errors, mean square norm, step controller h (0.9 err^(−1/8))
//! within (1/3, 6), no compensated summation. Only the coefficients are shared; other tests check them against the order
//! conditions.

use phaselab::app::Loaded;
use phaselab::experiment::Setup;
use phaselab::integrate::{METHODS, Propagator, Reached, Settings, method_named};
use phaselab::model::EventAction;
use phaselab::system::{Rates, State, System};

#[path = "../../../src/integrate/dop853/tableau.rs"]
#[allow(dead_code, reason = "the interpolant is not looked at")]
mod tableau;

use crate::fixtures::{catalog, compiled};
use tableau::{FIFTH, METHOD_STAGES, STAGES, THIRD};

/// The number of steps of the default method over which a motion is followed, so few that none becomes chaotic.
const STEPS: u32 = 6;

/// The error allowed for rounding.
const FLOOR: f64 = 2e-12;

fn sum(terms: &[(usize, f64)], slopes: &[Vec<f64>], i: usize) -> f64 {
    terms.iter().map(|&(stage, a)| a * slopes[stage][i]).sum()
}

/// The numbers at a time, or `None` if a stage has no rates or there are very many steps.
fn plain(rates: &mut Rates, start: &State, end: f64, tolerance: f64) -> Option<Vec<f64>> {
    let n = start.values.len();
    let (mut time, mut y) = (start.time, start.values.clone());
    let mut slopes = vec![vec![0.0; n]; STAGES.len()];
    let mut evaluate = |t: f64, y: &[f64], out: &mut Vec<f64>| rates.evaluate(t, y, out).ok();
    evaluate(time, &y, &mut slopes[0])?;
    let scale = |y: f64| tolerance + tolerance * y.abs();
    let norm = |v: &[f64]| {
        let squares: f64 = v.iter().zip(&y).map(|(v, y)| (v / scale(*y)).powi(2)).sum();
        (squares / n as f64).sqrt()
    };
    let (size, speed) = (norm(&y), norm(&slopes[0]));
    let mut step = if size < 1e-5 || speed < 1e-5 { 1e-6 } else { 0.01 * size / speed };
    let mut failed = false;
    for _ in 0..100_000 {
        if time == end {
            return Some(y);
        }
        let last = time + 1.01 * step >= end;
        let h = if last { end - time } else { step };
        for stage in 1..=METHOD_STAGES {
            let at: Vec<f64> =
                (0..n).map(|i| y[i] + h * sum(STAGES[stage].from, &slopes, i)).collect();
            let mut slope = vec![0.0; n];
            evaluate(time + STAGES[stage].at * h, &at, &mut slope)?;
            slopes[stage] = slope;
        }
        let whole = |i: usize| sum(STAGES[METHOD_STAGES].from, &slopes, i);
        let next: Vec<f64> = (0..n).map(|i| y[i] + h * whole(i)).collect();
        let (mut fifth, mut third) = (0.0, 0.0);
        for i in 0..n {
            let scale = scale(y[i].abs().max(next[i].abs()));
            fifth += (sum(FIFTH, &slopes, i) / scale).powi(2);
            third += ((whole(i) - sum(THIRD, &slopes, i)) / scale).powi(2);
        }
        let both = fifth + 0.01 * third;
        let both = if both > 0.0 { both } else { 1.0 };
        let error = h.abs() * fifth / (both * n as f64).sqrt();
        if !error.is_finite() {
            return None;
        }
        let most = if failed { 1.0 } else { 6.0 };
        let factor = (0.9 * error.powf(-1.0 / 8.0)).clamp(1.0 / 3.0, most);
        failed = error > 1.0;
        step = h * factor;
        if !failed {
            time = if last { end } else { time + h };
            y = next;
            slopes.swap(0, METHOD_STAGES);
        }
    }
    None
}

/// The state at a time by a method, including impulses and events.
fn by(
    system: &System,
    setup: &Setup,
    start: &State,
    method: &str,
    tolerance: Option<f64>,
    end: f64,
) -> Result<State, String> {
    let method = method_named(method).expect("in the table");
    let settings = Settings { step: None, tolerance };
    let mut motion = Propagator::new(system, method, settings, &setup.parameters)
        .map_err(|why| why.to_string())?;
    motion.begin(start, &setup.parameters).map_err(|error| error.to_string())?;
    let mut budget = 200_000;
    loop {
        match motion.reach(end, end, &mut budget).map_err(|error| error.to_string())? {
            Reached::Arrived | Reached::Ended => return Ok(motion.state().clone()),
            Reached::Occurred(_) => {}
            Reached::OutOfBudget => return Err("it takes too many steps".to_owned()),
        }
    }
}

/// The distance of two states, each number scaled as tolerances are: by its own size and by 1.
fn apart(a: &[f64], b: &[f64], moving: usize) -> f64 {
    let parts = a.iter().zip(b).take(moving).map(|(a, b)| (a - b).abs() / (1.0 + b.abs()));
    parts.fold(0.0, f64::max)
}

/// The longest time followed: impulses multiply errors, and they may be the only thing that happens in it.
const LONGEST: f64 = 10.0;

#[test]
fn dop853_is_as_accurate_as_an_independent_one_on_every_preset() {
    let mut worse = Vec::new();
    let (mut compared, mut held) = (0, 0);
    for entry in catalog().entries() {
        let name = &entry.name;
        let Loaded { model, system, .. } = compiled(name);
        let setup = Setup::of(&model);
        let start = system.initial(setup.start, &setup.parameters, &[]).expect("begins");
        // in its own unit of time
        let mut ahead = (METHODS[0].make)(&system, &Settings::default()).expect("fits");
        ahead.start(&start, &setup.parameters).expect("starts");
        let longest = setup.end.unwrap_or(f64::INFINITY).min(start.time + LONGEST);
        for _ in 0..STEPS {
            ahead.step(longest).expect("goes on");
        }
        let end = ahead.time();
        let exact =
            by(&system, &setup, &start, "taylor", None, end).expect("the default method goes on");
        // the independent program supports no constraints, impulses or events but sections; for these the tolerance is the bound
        let discontinuities = system.discontinuities();
        let is_plain = system.constraints() == 0
            && discontinuities
                .events
                .iter()
                .all(|e| matches!(e.action.written(), Some(EventAction::Section(_))))
            && discontinuities.impulses.is_empty();
        for tolerance in [1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13] {
            let ours = match by(&system, &setup, &start, "dop853", Some(tolerance), end) {
                Ok(state) => apart(&state.values, &exact.values, system.moving()),
                Err(why) => {
                    worse.push(format!("{name} at {tolerance:e}: {why}"));
                    continue;
                }
            };
            let mut rates = system.native_rates();
            rates.set_parameters(&setup.parameters);
            let other = if is_plain { plain(&mut rates, &start, end, tolerance) } else { None };
            let allowed = match other {
                // an error below the tolerance is what was asked for, however lucky the other program was
                Some(other) => {
                    (10.0 * apart(&other, &exact.values, system.moving())).max(tolerance)
                }
                // times of events are good to some digits of the clock
                None => 10.0 * tolerance.max(1e-12),
            };
            if is_plain {
                compared += 1;
            } else {
                held += 1;
            }
            if ours.is_nan() || ours > allowed + FLOOR {
                worse.push(format!("{name} at {tolerance:e}, until {end:.3}: {ours:.1e} for {allowed:.1e} ({is_plain})"));
            }
        }
    }
    assert!(worse.is_empty(), "{}", worse.join("\n"));
    assert!(compared > 200 && 2 * held < compared, "{compared} compared, {held} held");
}

/// The error of a step from one state to the next, relative to the tolerance: at most 1 if it was accepted, and near 0.9⁸
/// if the step was chosen by it.
#[test]
fn dop853_takes_no_step_whose_error_is_more_than_is_allowed() {
    let text = "title = 'Kepler'\n[coordinates]\nx = { initial = 1 }\ny = { initial = 0, velocity = 0.4 }\n[lagrangian]\n\
                L = \"1/2*(x'^2 + y'^2) + 1/sqrt(x^2 + y^2)\"";
    let (model, system) = crate::system::compile(text);
    let parameters = model.parameter_values();
    let tolerance = 1e-6;
    let settings = Settings { step: None, tolerance: Some(tolerance) };
    let mut stepper = (method_named("dop853").unwrap().make)(&system, &settings).unwrap();
    stepper.start(&system.initial(0.0, &parameters, &[]).unwrap(), &parameters).unwrap();
    let mut rates = system.native_rates();
    rates.set_parameters(&parameters);
    let mut errors = Vec::new();
    while stepper.time() < 30.0 {
        let before = stepper.state().clone();
        stepper.step(1e6).unwrap();
        let (begin, end) = stepper.interval();
        let h = end - begin;
        let n = before.values.len();
        let mut slopes = vec![vec![0.0; n]; STAGES.len()];
        for stage in 0..METHOD_STAGES {
            let at: Vec<f64> = (0..n)
                .map(|i| before.values[i] + h * sum(STAGES[stage].from, &slopes, i))
                .collect();
            let mut slope = vec![0.0; n];
            rates.evaluate(begin + STAGES[stage].at * h, &at, &mut slope).unwrap();
            slopes[stage] = slope;
        }
        let (mut fifth, mut third) = (0.0, 0.0);
        for i in 0..n {
            let [from, to] = [before.values[i].abs(), stepper.state().values[i].abs()];
            let allowed = tolerance * from.max(to).max((h * slopes[0][i]).abs());
            let whole = sum(STAGES[METHOD_STAGES].from, &slopes, i);
            fifth += (sum(FIFTH, &slopes, i) / allowed).powi(2);
            third += ((whole - sum(THIRD, &slopes, i)) / allowed).powi(2);
        }
        errors.push(h * fifth / ((fifth + 0.01 * third) * n as f64).sqrt());
    }
    let most = errors.iter().copied().fold(0.0, f64::max);
    assert!(most <= 1.001 && most > 0.5, "{most}: {errors:?}");
}
