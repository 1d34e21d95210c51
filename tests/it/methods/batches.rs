//! Steps that nobody looks at: taken many at once, with the bits of single ones.

use phaselab::integrate::{Method, Settings, StepBlock, Stepper};
use phaselab::num::accumulate;
use phaselab::system::{Form, Rates, State};

use super::{
    Case, case, double_pendulum, driven, fixed, heavy_top, henon_heiles, kepler, named, pendulum,
};
use crate::build::hamiltonian;

/// Takes steps one by one until a time is reached or passed.
fn one_by_one(stepper: &mut dyn Stepper, time: f64) -> u64 {
    let forwards = time > stepper.time();
    let mut count = 0;
    while stepper.time() != time && (stepper.time() < time) == forwards {
        stepper.step(1e9_f64.copysign(time - stepper.time())).expect("goes on");
        count += 1;
    }
    count
}

fn same(case: &Case, method: &Method, step: f64, times: &[f64]) {
    let (mut single, mut many) = (case.stepper(method, step), case.stepper(method, step));
    for &time in times {
        let count = one_by_one(single.as_mut(), time);
        let mut budget = u64::MAX;
        let limit = 1e9_f64.copysign(time - many.time());
        many.steps(time, limit, &mut budget).expect("goes on");
        assert_eq!(u64::MAX - budget, count, "{}: steps", method.name);
        assert_eq!(many.state(), single.state(), "{}: the state at {time}", method.name);
        assert_eq!(many.interval(), single.interval(), "{}: the last step", method.name);
        assert_eq!(many.unstable(), single.unstable(), "{}", method.name);
        // inside the last step, too
        let (begin, end) = many.interval();
        let (mut a, mut b) = (many.state().clone(), many.state().clone());
        many.at(0.4 * begin + 0.6 * end, &mut a).expect("inside");
        single.at(0.4 * begin + 0.6 * end, &mut b).expect("inside");
        assert_eq!(a, b, "{}", method.name);
    }
}

/// A separable system with functions, powers, a kink and parameters in both halves.
fn rich() -> Case {
    let h = "p_x^2/(2*m) + p_y^4/4 + (p_y^2 + 1)^(3/2) + sin(x)*cosh(y)/m + (x^2 + y^2 + m)^(m/3) \
             + exp(-x^2) + abs(y)*y^2 + atan2(y, x^2 + 2) + 1/sqrt(x^2 + 2)";
    case(hamiltonian(&["x", "y"], &["m"], h), Form::Momentum, &[0.4, -0.3, 0.2, 0.5])
}

#[test]
fn many_steps_at_once_have_the_bits_of_single_ones() {
    let times = [4.0, 4.005, 5.7, 9.0, -4.0, -4.5, 1.0];
    let cases =
        [pendulum(), henon_heiles(), kepler(0.3), rich(), driven(), double_pendulum(), heavy_top()];
    for case in cases {
        for method in fixed().filter(|method| (method.fits)(&case.system).is_ok()) {
            let long = method.preserves.is_symplectic() && case.system.separable().is_ok();
            let times = if long { &times[..] } else { &[0.5, 0.75, -0.25] };
            same(&case, method, 0.01, times);
        }
    }
}

/// Steps of a composition of leapfrogs, operation by operation.
fn by_rates(case: &Case, weights: &[f64], step: f64, count: usize) -> State {
    let (mut drift, mut kick) = case.system.split_rates().expect("separable");
    drift.set_parameters(&case.parameters);
    kick.set_parameters(&case.parameters);
    let mut state = case.system.convert(&case.start, Form::Momentum, &case.parameters).unwrap();
    let part = |rates: &mut Rates, state: &mut State, factor: f64| {
        let mut slope = vec![0.0; state.values.len()];
        rates.evaluate(0.0, &state.values, &mut slope).expect("rates");
        for (i, slope) in slope.into_iter().enumerate().filter(|&(_, slope)| slope != 0.0) {
            accumulate(&mut state.values[i], &mut state.carry[i], factor * slope);
        }
    };
    for _ in 0..count {
        let mut before = 0.0;
        for &w in weights {
            part(&mut kick, &mut state, 0.5 * (before + w) * step);
            part(&mut drift, &mut state, w * step);
            before = w;
        }
        part(&mut kick, &mut state, 0.5 * before * step);
    }
    state
}

#[test]
fn steps_have_the_bits_of_their_operations_one_by_one() {
    let tangent = henon_heiles();
    let system = tangent.system.with_tangents(2);
    let mut start = system.extended(&tangent.start, &tangent.system);
    start.values[system.tangent_place(0)] = 1.0;
    start.values[system.tangent_place(1) + 3] = 1.0;
    let tangent = Case { system, start, parameters: tangent.parameters };
    for case in [pendulum(), henon_heiles(), kepler(0.3), rich(), tangent] {
        for name in ["leapfrog", "yoshida4", "yoshida6", "yoshida8"] {
            let method = named(name);
            let weights = (method.leapfrogs)();
            for count in [1, 2, 300] {
                let mut stepper = case.stepper(method, 0.01);
                stepper.steps(1e9, 1e9, &mut (count as u64)).expect("goes on");
                let by_hand = by_rates(&case, &weights, 0.01, count);
                let bits = |x: &[f64]| x.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
                let state = stepper.state();
                assert_eq!(bits(&state.values), bits(&by_hand.values), "{name} {count}");
                assert_eq!(bits(&state.carry), bits(&by_hand.carry), "{name} {count}");
            }
        }
    }
}

#[test]
fn steps_are_seen_at_the_end_of_each() {
    for case in [henon_heiles(), pendulum(), rich()] {
        let mut single = case.stepper(named("yoshida4"), 0.01);
        let mut many = case.stepper(named("yoshida4"), 0.01);
        let (mut block, mut longest) = (StepBlock::default(), 0);
        while single.time() < 6.0 {
            let time = single.time() + 0.037;
            let mut taken = many.steps_seen(time, 1000, &mut block) as usize;
            longest = longest.max(taken);
            let counted = taken;
            if taken == 0 {
                many.step(1e9).expect("goes on");
                taken = 1;
            }
            for step in 0..taken {
                assert!(single.time() < time, "stops at the time");
                single.step(1e9).expect("goes on");
                if counted > 0 {
                    assert_eq!(block.count, counted);
                    assert_eq!(block.interval(step), single.interval());
                    assert_eq!(block.state(step, Form::Momentum).values, single.state().values);
                }
            }
            assert_eq!((many.state(), many.interval()), (single.state(), single.interval()));
        }
        assert_eq!(longest, 4);
    }
}

#[test]
fn tangent_vectors_too() {
    let case = henon_heiles();
    let system = case.system.with_tangents(4);
    let mut start = system.extended(&case.start, &case.system);
    for j in 0..4 {
        start.values[system.tangent_place(j) + j] = 1.0;
    }
    let case = Case { system, start, parameters: case.parameters };
    same(&case, named("yoshida4"), 0.02, &[8.0, 14.0]);
}

#[test]
fn a_budget_ends_a_batch_and_a_motion_that_breaks_off_is_reported_as_by_single_steps() {
    let case = henon_heiles();
    let mut many = case.stepper(named("leapfrog"), 0.01);
    let mut budget = 5000;
    many.steps(1e6, 1e6, &mut budget).expect("goes on");
    assert_eq!((budget, many.time()), (0, 50.0));
    // y beyond the saddle: the motion escapes to infinity in a finite time
    let mut escaping = henon_heiles();
    escaping.start.values = vec![0.0, 1.5, 0.0, 1.0, 0.0];
    escaping.start.values.truncate(escaping.system.state_len());
    for name in ["leapfrog", "yoshida8"] {
        let (mut single, mut many) =
            (escaping.stepper(named(name), 0.003), escaping.stepper(named(name), 0.003));
        let alone = loop {
            if let Err(error) = single.step(1e9) {
                break error;
            }
        };
        let error = many.steps(1e9, 1e9, &mut u64::MAX.clone()).expect_err("escapes");
        assert_eq!(error, alone, "{name}");
        assert_eq!(many.state(), single.state(), "{name}");
    }
}

#[test]
fn an_unstable_step_is_found_in_a_batch() {
    // a spring that becomes stiffer than the step bears, long after the start
    let case = case(
        hamiltonian(&["x", "y"], &[], "p_x^2/2 + p_y^2/2 + y^2*(1 + x^4)/2"),
        Form::Momentum,
        &[0.0, 1e-100, 0.01, 0.0],
    );
    let settings = Settings { step: Some(0.1), tolerance: None };
    let mut many = case.stepper_with(named("leapfrog"), settings);
    many.steps(465.0, 1e9, &mut u64::MAX.clone()).expect("goes on");
    let mut single = case.stepper_with(named("leapfrog"), settings);
    one_by_one(single.as_mut(), 465.0);
    assert!(single.unstable().is_some(), "the case is to become unstable");
    assert_eq!(many.unstable(), single.unstable());
}
