//! Initial states, conversions between velocities and momenta, changes of parameters, and their failures.

use phaselab::integrate::METHODS;
use phaselab::integrate::Settings;
use phaselab::system::{Form, InitialOverride, MotionErrorKind, State};

use super::{compile, parameters};

const RELATIVISTIC: &str = r#"
title = "Relativistic particle in two dimensions"
[coordinates]
x = { initial = 0.5, velocity = 0.6 }
y = { initial = "b", velocity = 0.3 }
[parameters]
b = 2.0
c = 1.5
[lagrangian]
L = "-c^2*sqrt(1 - (x'^2 + y'^2)/c^2) - x*y"
"#;

/// A system without a closed form for q̇: coupled kinetic terms of fourth and sixth order.
const QUARTIC: &str = r#"
title = "Coupled quartic kinetic energy"
[coordinates]
x = { initial = 0.5, velocity = 0.6 }
y = { initial = 0.1, velocity = -0.3 }
[lagrangian]
L = "1/2*(x'^2 + y'^2) + 1/4*(x' + y')^4 + 1/6*(x' - 2*y')^6 + exp(x'/3) - 1/2*x^2"
"#;

fn close(a: f64, b: f64) {
    assert!((a - b).abs() <= 5e-16 * a.abs().max(b.abs()), "{a} and {b}");
}

#[test]
fn conversions_go_there_and_back() {
    for text in [RELATIVISTIC, QUARTIC, include_str!("../../../presets/rigid-body/heavy-top.toml")]
    {
        let (model, system) = compile(text);
        let p = parameters(&model);
        let state = system.initial(0.0, &p, &[]).expect("regular");
        let canonical = system.convert(&state, Form::Momentum, &p).expect("regular");
        let back = system.convert(&canonical, Form::Velocity, &p).expect("regular");
        for i in 0..2 * system.degrees() {
            let lost = back.exact(i) - state.exact(i);
            assert!(
                lost.high.abs() <= 1e-27 * state.values[i].abs().max(1e-3),
                "{}: {lost:?}",
                model.info.title
            );
        }
    }
}

#[test]
fn a_relativistic_momentum_finds_its_speed() {
    let (model, system) = compile(RELATIVISTIC);
    let given = [InitialOverride::Momentum(0, 300.0), InitialOverride::Momentum(1, 400.0)];
    let state = system.initial(0.0, &parameters(&model), &given).expect("there is one");
    // v = p / √(1 + p²/c²)
    let root = (1.0_f64 + 250_000.0 / 2.25).sqrt();
    close(state.values[2], 300.0 / root);
    close(state.values[3], 400.0 / root);
}

#[test]
fn given_values_take_the_place_of_the_files() {
    let (model, system) = compile(RELATIVISTIC);
    let p = [7.0, 1.5];
    assert_eq!(system.initial_values(&p), [0.5, 7.0, 0.6, 0.3]);
    let given = [InitialOverride::Position(0, -1.0), InitialOverride::Velocity(1, 0.9)];
    let state = system.initial(2.5, &p, &given).expect("regular");
    assert_eq!((state.time, state.values), (2.5, vec![-1.0, 7.0, 0.6, 0.9]));
    // one momentum given, the other coordinate's velocity as in the file
    let state = system.initial(0.0, &p, &[InitialOverride::Momentum(0, 0.8)]).expect("regular");
    close(state.values[3], 0.3);
    let canonical = system.convert(&state, Form::Momentum, &p).expect("regular");
    close(canonical.values[2], 0.8);
    assert_eq!(parameters(&model).len(), 2);
}

#[test]
fn a_hamiltonian_takes_a_velocity() {
    let (model, system) = compile(
        r#"
title = "Charge in a field"
[coordinates]
x = { initial = 1.0, momentum = 0.0 }
y = { initial = 2.0, momentum = 0.0 }
[hamiltonian]
H = "1/2*(p_x + y)^2 + 1/2*(p_y - x)^2 + p_x^4/4"
"#,
    );
    let given = [InitialOverride::Velocity(0, 3.0), InitialOverride::Velocity(1, 4.0)];
    let state = system.initial(0.0, &parameters(&model), &given).expect("regular");
    let (px, py) = (state.values[2], state.values[3]);
    close(px + 2.0 + px.powi(3), 3.0);
    close(py - 1.0, 4.0);
}

#[test]
fn decimals_mean_what_is_written() {
    let (model, system) = compile(RELATIVISTIC);
    let state = system.initial(0.1, &parameters(&model), &[]).expect("regular");
    assert_eq!(state.time_carry, -5.551115123125783e-18, "0.1 is not an f64");
    assert_eq!(state.carry[2], 2.2204460492503132e-17, "nor is 0.6");
}

#[test]
fn a_jump_of_a_parameter_keeps_momenta() {
    let (_, system) = compile(include_str!("../../../presets/pendulums/pendulum.toml"));
    // m, l, g, θ₀
    let (old, new) = ([1.0, 1.0, 9.81, 2.0], [1.0, 0.5, 9.81, 2.0]);
    let state = system.initial(0.0, &old, &[InitialOverride::Velocity(0, 0.7)]).expect("regular");
    let changed = system.change_parameters(&state, &old, &new).expect("regular");
    assert_eq!(changed.values[0], state.values[0]);
    close(changed.values[1], 0.7 * 4.0);
}

#[test]
fn a_singular_mass_matrix_is_reported_with_its_place() {
    let (model, system) = compile(
        r#"
title = "Spherical pendulum at its pole"
[coordinates]
theta = { symbol = "θ", initial = 0.0, velocity = 1.0 }
phi = { symbol = "φ", initial = 0.5, velocity = 1.0 }
[lagrangian]
L = "1/2*(theta'^2 + sin(theta)^2*phi'^2) + cos(theta)"
"#,
    );
    let p = parameters(&model);
    let state = system.initial(3.5, &p, &[]).expect("a state is a state");
    let mut stepper = (METHODS[0].make)(&system, &Settings::default()).expect("it fits");
    let outcome = stepper.start(&state, &p).and_then(|()| stepper.step(4.0));
    let error = outcome.expect_err("θ = 0 is a singularity of the chart");
    assert_eq!(
        error.to_string(),
        "the mass matrix is singular at t = 3.5, θ = 0: a chart singularity or a degenerate Lagrangian"
    );
}

#[test]
fn nearly_singular_matrices_are_found_by_their_pivots() {
    let (model, system) = compile(
        r#"
title = "Degenerate but for rounding"
[coordinates]
x = { initial = 0.0, velocity = 1.0 }
y = { initial = 0.0, velocity = 1.0 }
[lagrangian]
L = "1/2*(0.1*x' + 0.3*y')^2*10 - x^2 - y^2 + 1e-20*x'^2"
"#,
    );
    let p = parameters(&model);
    let state = system.initial(0.0, &p, &[]).expect("a state is a state");
    let mut stepper = (METHODS[0].make)(&system, &Settings::default()).expect("it fits");
    let outcome = stepper.start(&state, &p).and_then(|()| stepper.step(1.0));
    assert_eq!(outcome.expect_err("degenerate").kind, MotionErrorKind::SingularMass);
}

#[test]
fn momenta_out_of_range_are_refused() {
    let (model, system) = compile(
        r#"
title = "Bounded momentum"
[coordinates]
x = { initial = 0.0, velocity = 0.5 }
[lagrangian]
L = "x'*atan(x') - 1/2*ln(1 + x'^2)"
"#,
    );
    // p = atan(x') stays below π/2
    let outcome = system.initial(0.0, &parameters(&model), &[InitialOverride::Momentum(0, 2.0)]);
    let error = outcome.expect_err("there is no such velocity");
    assert!(
        matches!(error.kind, MotionErrorKind::NoVelocities | MotionErrorKind::SingularMass),
        "{error}"
    );
    let state =
        system.initial(0.0, &parameters(&model), &[InitialOverride::Momentum(0, 1.5)]).expect("is");
    close(state.values[1], 1.5_f64.tan());
}

#[test]
fn a_first_state_has_to_be_finite() {
    let (_, system) =
        compile(RELATIVISTIC.replace("initial = \"b\"", "initial = \"ln(b)\"").as_str());
    let error = system.initial(0.0, &[-1.0, 1.5], &[]).expect_err("ln(−1)");
    assert_eq!(error.kind, MotionErrorKind::NotFinite("y".to_owned()));
}

#[test]
fn states_are_copied_without_losing_what_was_cut_off() {
    let mut a = State::new(0.1, Form::Velocity, vec![1.0, 2.0]);
    a.carry[0] = 1e-20;
    let mut b = State::new(0.0, Form::Momentum, Vec::new());
    b.copy_from(&a);
    assert_eq!(a, b);
    b.values[1] = f64::INFINITY;
    assert!(a.is_finite() && !b.is_finite());
}

/// Links of unit length and mass on spherical joints, each by two angles. In one plane, set turning about an axis in it, they have
/// momenta p_a that are nothing but the rounding of terms sin b cos b − cos b sin b.
#[test]
fn velocities_of_zero_are_found_from_momenta_that_are_rounding() {
    for links in [5, 6] {
        let mut text = "title = \"links\"\n[coordinates]\n".to_owned();
        let (mut squares, mut weights) = (Vec::new(), Vec::new());
        let mut sums = [const { String::new() }; 3];
        for k in 0..links {
            let angle = 0.1 * f64::from(k + 1);
            text.push_str(&format!("a{k} = {{ initial = {angle:.1} }}\n"));
            text.push_str(&format!("b{k} = {{ initial = 0.1, velocity = 0.3 }}\n"));
            let along = [
                format!(" + cos(a{k})*cos(b{k})*a{k}' - sin(a{k})*sin(b{k})*b{k}'"),
                format!(" + cos(a{k})*sin(b{k})*a{k}' + sin(a{k})*cos(b{k})*b{k}'"),
                format!(" + sin(a{k})*a{k}'"),
            ];
            for (sum, along) in sums.iter_mut().zip(along) {
                sum.push_str(&along);
                squares.push(format!("(0{sum})^2"));
            }
            weights.push(format!("{}*cos(a{k})", links - k));
        }
        let (squares, weights) = (squares.join(" + "), weights.join(" + "));
        text.push_str(&format!("[lagrangian]\nL = \"1/2*({squares}) + {weights}\"\n"));
        let (model, system) = compile(&text);
        let p = parameters(&model);
        let state = system.initial(0.0, &p, &[]).expect("regular");
        let canonical = system.convert(&state, Form::Momentum, &p).expect("regular");
        let back = system.convert(&canonical, Form::Velocity, &p).expect("regular");
        for (found, given) in back.values.iter().zip(&state.values) {
            assert!((found - given).abs() < 1e-15, "{links}: {found} {given}");
        }
    }
}
