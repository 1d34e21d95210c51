//! Series by machine code compared with those of the jet, bit by bit: of every operation, and of whole orbits.

use phaselab::integrate::{METHODS, Settings};
use phaselab::num::{BATCH, DoubleDouble};
use phaselab::system::{BatchSeries, BatchStates, Series, State, System};

use super::compile;

/// Kinetic energies and potentials that contain every operation and every function without kinks.
const LAWS: &[(&str, &str)] = &[
    ("1/2*x'^2 + 1/2*y'^2", "x^2*y - y^3/3 + 1/2*(x^2 + y^2)"),
    ("1/2*x'^2 + 1/2*y'^2", "-1/sqrt(x^2 + y^2 + 1)"),
    ("1/2*x'^2 + 1/2*y'^2", "(x^2 + 3)^(1/3)*y + (y^2 + 2)^(-1.7)"),
    ("1/2*x'^2 + 1/2*y'^2", "x/(3 + y) + a*x^3/(x^2 + 2)"),
    ("1/2*x'^2 + 1/2*y'^2", "sin(x)*cos(2*y) + exp(x*y/3)"),
    ("1/2*x'^2 + 1/2*y'^2", "ln(3 + x)*y + tan(x/3) + cot(y/3 + 1)"),
    ("1/2*x'^2 + 1/2*y'^2", "atan(x*y) + asin(x/9)*acos(y/9) + atan2(x + 3, y)"),
    ("1/2*x'^2 + 1/2*y'^2", "sinh(x)*cosh(y) + tanh(x + y)"),
    ("1/2*x'^2 + 1/2*y'^2", "x*cos(3*t) + t*y^2 + x^4*exp(-t)"),
    ("1/2*x'^2 + 1/2*y'^2", "1/2*x^2"),
    ("x'^2 + 1/2*y'^2 + x'*y'*cos(x - y)", "-2*a*cos(x) - a*cos(y)"),
    ("1/2*x'^2*(1 + y^2) + 1/2*y'^2*sin(x)^2 + y'^2", "a*x^2 + x*y"),
    ("x'^2 + y'^2 + z'^2 + x'*y'*cos(x - y) + y'*z'*cos(y - z)/2 + x'*z'*sin(z)/3", "cos(x + y)*z"),
];

/// So many series are wanted before they are built by machine code.
const WANTED: usize = 200;

fn file(kinetic: &str, potential: &str) -> String {
    let z = if kinetic.contains('z') { "z = { initial = 0.3, velocity = 0.1 }\n" } else { "" };
    format!(
        "title = \"Law\"\n[coordinates]\nx = {{ initial = 0.4, velocity = 0.2 }}\ny = {{ initial = 0.1, velocity = \
         -0.3 }}\n{z}[parameters]\na = 0.7\n[lagrangian]\nL = \"{kinetic} - ({potential})\"\n"
    )
}

/// Numbers in [−1, 1) without a pattern.
fn noise(seed: u64) -> impl Iterator<Item = f64> {
    let next =
        |x: &u64| Some(x.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407));
    let bits = std::iter::successors(Some(seed), next).skip(1);
    bits.map(|x| (x >> 11) as f64 / (1_u64 << 52) as f64 - 1.0)
}

/// The bits of all coefficients, with those of the arguments of functions.
fn bits(series: &Series) -> Vec<Vec<u64>> {
    let of = |c: &[f64]| c.iter().map(|c| c.to_bits()).collect();
    let numbers = (0..series.len()).map(|i| of(series.coefficients(i)));
    let arguments = series.arguments().map(|(_, u, _)| of(&u[..series.order()]));
    numbers.chain(arguments).collect()
}

/// Builds series at random states until they are built by machine code, and compares them.
#[track_caller]
fn compare(system: &System, parameters: &[DoubleDouble], (order, exact): (usize, usize)) {
    let mut compiled = system.series(order, exact);
    let mut interpreted = system.interpreted().series(order, exact);
    let mut numbers = noise(order as u64);
    let mut state = State::new(0.3, system.form(), vec![0.0; system.state_len()]);
    for series in [&mut compiled, &mut interpreted] {
        series.set_parameters(parameters);
    }
    let mut by_code = 0;
    (0..WANTED).for_each(|_| compiled.build(&state).expect("regular"));
    for i in 0..16 {
        state.values.fill_with(|| numbers.next().expect("endless"));
        for series in [&mut compiled, &mut interpreted] {
            series.set_scale(if i % 2 == 0 { 0.25 } else { -0.5 });
            series.build(&state).expect("regular");
        }
        by_code += u32::from(compiled.is_compiled());
        assert!(!interpreted.is_compiled());
        assert_eq!(bits(&compiled), bits(&interpreted), "order {order}, state {:?}", state.values);
    }
    assert!(by_code > 5, "{by_code} of order {order}");
}

#[test]
fn code_is_written_after_the_first_series_where_many_are_expected() {
    for (expected, soon) in [(0.0, false), (100.0, false), (1000.0, true), (f64::INFINITY, true)] {
        let (model, system) = compile(&file(LAWS[0].0, LAWS[0].1));
        let mut series = system.series(20, 0);
        series.set_parameters(&system.inputs(&model.parameter_values()));
        let state = State::new(0.3, system.form(), vec![0.1; system.state_len()]);
        series.expect(expected);
        // a motion of few steps is left to the jet, whatever its first steps let expect
        for _ in 0..8 {
            series.build(&state).expect("regular");
            assert!(!series.is_compiled(), "{expected}");
        }
        series.build(&state).expect("regular");
        assert_eq!(series.is_compiled(), soon, "{expected}");
        let mut interpreted = system.interpreted().series(20, 0);
        interpreted.set_parameters(&system.inputs(&model.parameter_values()));
        interpreted.build(&state).expect("regular");
        assert_eq!(bits(&series), bits(&interpreted), "{expected}");
    }
}

#[test]
fn every_operation_has_the_bits_of_the_jet_at_all_orders() {
    for (i, (kinetic, potential)) in LAWS.iter().enumerate() {
        let (model, system) = compile(&file(kinetic, potential));
        let parameters = system.inputs(&model.parameter_values());
        // all orders for one of them, some for each
        for order in (1..=30).filter(|order| i == 0 || order % 7 == i % 7) {
            compare(&system, &parameters, (order, 0));
        }
        compare(&system, &parameters, (28, 8));
    }
}

/// The bits of all coefficients of several orbits.
fn bits_of_all(series: &BatchSeries) -> Vec<u64> {
    let numbers = (0..series.len()).flat_map(|i| series.coefficients(i));
    let arguments = series.arguments().flat_map(|(_, u)| &u[..series.order()]);
    numbers.chain(arguments).flat_map(|c| c.0.map(f64::to_bits)).collect()
}

#[test]
fn every_operation_has_the_bits_of_the_jet_in_all_lanes() {
    let mut compiled_laws = Vec::new();
    for (i, (kinetic, potential)) in LAWS.iter().enumerate() {
        let (model, system) = compile(&file(kinetic, potential));
        let parameters = system.inputs(&model.parameter_values());
        let order = 8 + 2 * i;
        let interpreted = system.interpreted();
        let series = [&system, &interpreted].map(|system| system.batch_series(order));
        let [Some(mut compiled), Some(mut interpreted)] = series else { continue };
        let mut numbers = noise(order as u64);
        let mut by_code = 0;
        let mut states = BatchStates::new(system.form(), system.state_len());
        // where instructions take four numbers at once, a batch counts for four orbits
        for step in 0..2 * WANTED / BATCH + 10 {
            for lane in 0..BATCH {
                let values = numbers.by_ref().take(system.state_len()).collect();
                states.set(lane, &State::new(0.3 * lane as f64, system.form(), values));
                for series in [&mut compiled, &mut interpreted] {
                    assert!(series.set_parameters(lane, &parameters));
                    series.set_scale(lane, if (step + lane) % 2 == 0 { 0.25 } else { -0.5 });
                }
            }
            for series in [&mut compiled, &mut interpreted] {
                series.set_states(&states, &[true; BATCH]);
                assert!(series.build());
            }
            by_code += u32::from(compiled.is_compiled());
            assert!(!interpreted.is_compiled());
            assert!(bits_of_all(&compiled) == bits_of_all(&interpreted), "{potential}");
        }
        if by_code > 5 {
            compiled_laws.push((*kinetic, *potential));
        }
    }
    // not where linear equations are solved for several unknowns at once, or a root is compared with zero
    assert!(compiled_laws.len() > 6, "{compiled_laws:?}");
    let [coupled, apart] = [LAWS[10], LAWS[11]];
    assert!(!compiled_laws.contains(&coupled) && compiled_laws.contains(&apart));
}

#[test]
fn zeros_have_the_sign_that_the_jet_gives_them() {
    // at rest in a minimum, and with one coordinate in its plane of symmetry; with parameters before and after what varies
    let of_parameters = "cos(x + a) + sin(a - x + y) + cos(y - a)*x + (a - x - y)^2";
    for potential in [LAWS[0].1, of_parameters] {
        let (model, system) = compile(&file(LAWS[0].0, potential));
        let parameters = system.inputs(&model.parameter_values());
        for (order, exact) in [(24, 0), (28, 8)] {
            let mut compiled = system.series(order, exact);
            let mut interpreted = system.interpreted().series(order, exact);
            for values in [[0.0; 4], [0.0, 0.3, 0.0, 0.2], [-0.0, 0.3, -0.0, -0.2], [-0.0; 4]] {
                let state = State::new(0.0, system.form(), values.to_vec());
                for series in [&mut compiled, &mut interpreted] {
                    series.set_parameters(&parameters);
                    series.set_scale(-0.5);
                    (0..WANTED).for_each(|_| series.build(&state).expect("regular"));
                }
                assert!(compiled.is_compiled());
                assert_eq!(bits(&compiled), bits(&interpreted), "{potential}: {values:?}");
            }
        }
    }
}

#[test]
fn a_root_of_zero_and_a_kink_are_left_to_the_jet() {
    let at_zero = |potential: &str| {
        let (model, system) = compile(&file(LAWS[0].0, potential));
        let mut series = system.series(12, 0);
        series.set_parameters(&system.inputs(&model.parameter_values()));
        let state = State::new(0.0, system.form(), vec![0.0, 0.5, 0.0, 0.0]);
        (0..WANTED).for_each(|_| series.build(&state).expect("a motion in the plane of symmetry"));
        series.is_compiled()
    };
    assert!(!at_zero("(x^2 + x^2*y^2)^(5/2)"));
    assert!(!at_zero("abs(y - 1)"));
    assert!(at_zero("(1 + x^2*y^2)^(5/2)"));
}

/// The bits of the states of an orbit after each step.
fn orbit(system: &System, parameters: &[f64], tolerance: Option<f64>) -> Vec<u64> {
    let state = system.initial(0.0, parameters, &[]).expect("regular");
    let settings = Settings { step: None, tolerance };
    let mut stepper = (METHODS[0].make)(system, &settings).expect("it fits every system");
    stepper.start(&state, parameters).expect("regular");
    let mut bits = Vec::new();
    for _ in 0..300 {
        stepper.step(1e6).expect("regular");
        let state = stepper.state();
        let numbers = [state.time, state.time_carry].into_iter().chain(state.values.clone());
        bits.extend(numbers.map(f64::to_bits));
    }
    bits
}

#[test]
fn whole_orbits_have_the_same_bits() {
    for text in [
        include_str!("../../../presets/chaos/henon-heiles.toml"),
        include_str!("../../../presets/chaos/double-pendulum.toml"),
        include_str!("../../../presets/chaos/duffing.toml"),
        include_str!("../../../presets/gravity/planet.toml"),
        include_str!("../../../presets/gravity/figure-eight.toml"),
        include_str!("../../../presets/gravity/restricted-three-body.toml"),
        include_str!("../../../presets/gravity/relativistic-orbit.toml"),
        include_str!("../../../presets/rigid-body/heavy-top.toml"),
        include_str!("../../../presets/rigid-body/kovalevskaya.toml"),
        include_str!("../../../presets/rigid-body/free-rigid-body.toml"),
        include_str!("../../../presets/oscillations/toda.toml"),
        include_str!("../../../presets/pendulums/spherical-pendulum.toml"),
        include_str!("../../../presets/pendulums/elastic-pendulum.toml"),
        include_str!("../../../presets/charges/magnetic-mirror.toml"),
        include_str!("../../../presets/machines/swinging-atwood.toml"),
    ] {
        let (model, system) = compile(text);
        let parameters = model.parameter_values();
        for tolerance in [Some(1e-15), None] {
            let compiled = orbit(&system, &parameters, tolerance);
            let interpreted = orbit(&system.interpreted(), &parameters, tolerance);
            let differs = compiled.iter().zip(&interpreted).position(|(a, b)| a != b);
            let title = text.lines().next();
            assert_eq!(differs, None, "{title:?} at {tolerance:?}");
            assert_eq!(compiled.len(), interpreted.len());
        }
    }
}
