//! Constraints with multipliers: derived, solved, satisfied.

use std::sync::Arc;

use phaselab::experiment::{AdvanceOutcome, Experiment, Setup, Status, choose_method};
use phaselab::expr::{Expr, Zero};
use phaselab::mechanics::{self, Equations};
use phaselab::model::Model;
use phaselab::system::{InitialOverride, MotionError, MotionErrorKind, System};

use crate::build::{constrain, lagrangian, read};
use crate::experiment::build;

/// Checks solved expressions against hand-written ones.
fn check(mut model: Model, accelerations: &[&str], multipliers: &[&str]) -> Equations {
    let by_hand: Vec<Expr> =
        accelerations.iter().chain(multipliers).map(|text| read(&mut model, text)).collect();
    let mut equations = mechanics::derive(&model).expect("it derives");
    let solved = equations.solved.clone().expect("accelerations");
    let forces = equations.multipliers.clone().expect("multipliers");
    for (found, right) in solved.into_iter().chain(forces).zip(by_hand) {
        let difference = equations.pool.sub(found, right);
        let text = equations.pool.text(found);
        assert_eq!(equations.pool.is_zero(difference), Zero::Proved, "{text}");
    }
    equations
}

const HOOP: &str = "m/2*x'^2 + m*r^2/2*theta'^2 + m*g*x*sin(phi)";

#[test]
fn a_hoop_rolls_down_at_half_the_acceleration() {
    // The Principles of Dynamics, § 1.3.2
    let mut model = lagrangian(&["x", "theta"], &["m", "g", "r", "phi"], HOOP);
    constrain(&mut model, &[("no slip", "r*theta' - x'")]);
    let half = "1/2*g*sin(phi)";
    let equations = check(model, &[half, "g*sin(phi)/(2*r)"], &["1/2*m*g*sin(phi)"]);
    assert!(equations.conserved.iter().any(|c| c.name == "energy"));
    assert!(equations.separable.is_err(), "not a motion under H alone");
}

#[test]
fn the_tension_has_the_sign_of_the_constraint_as_written() {
    let law = "m1/2*x1'^2 + m2/2*x2'^2 + m1*g*x1 + m2*g*x2";
    let fall = "(m1 - m2)*g/(m1 + m2)";
    let rise = "(m2 - m1)*g/(m1 + m2)";
    let pull = "2*m1*m2*g/(m1 + m2)";
    for (string, tension) in
        [("l - x1 - x2", pull.to_owned()), ("x1 + x2 - l", format!("-({pull})"))]
    {
        let mut model = lagrangian(&["x1", "x2"], &["m1", "m2", "g", "l"], law);
        constrain(&mut model, &[("string", string)]);
        check(model, &[fall, rise], &[&tension]);
    }
}

#[test]
fn a_wire_that_turns_does_work() {
    // y cos wt − x sin wt = 0; r'' = w² r along the wire
    let mut model = lagrangian(&["x", "y"], &["m", "w"], "m/2*(x'^2 + y'^2)");
    constrain(&mut model, &[("wire", "y*cos(w*t) - x*sin(w*t)")]);
    // dh/dt = −λ ∂f/∂t
    let rate = read(&mut model, "w*(y*sin(w*t) + x*cos(w*t))");
    let mut equations = mechanics::derive(&model).expect("it derives");
    let lambda = equations.pool.variable(equations.constraints[0].multiplier);
    let expected = equations.pool.mul(lambda, rate);
    let rest = equations.pool.sub(equations.energy_rate, expected);
    assert_eq!(equations.pool.is_zero(rest), Zero::Proved);
    assert!(equations.conserved.is_empty());
}

#[test]
fn a_rod_keeps_the_total_momentum_and_not_each() {
    let mut model =
        lagrangian(&["x1", "y1", "x2", "y2"], &["m", "l"], "m/2*(x1'^2 + y1'^2 + x2'^2 + y2'^2)");
    constrain(&mut model, &[("rod", "(x1 - x2)^2 + (y1 - y2)^2 - l^2")]);
    let equations = mechanics::derive(&model).expect("it derives");
    assert!(equations.cyclic.is_empty(), "the rod pulls on each");
    let names: Vec<_> = equations.conserved.iter().map(|c| c.reason.to_string()).collect();
    assert!(names.iter().any(|name| name.starts_with("translation of x₁")), "{names:?}");
    assert!(names.iter().any(|name| name.starts_with("rotation")), "{names:?}");
}

/// Sets the initial values of a model: coordinates, and velocities if given.
fn start(model: &mut Model, values: &[(&str, Option<&str>)]) {
    for (i, (position, rate)) in values.iter().enumerate() {
        let initial = read(model, position);
        let rate = rate.map(|text| read(model, text));
        let coordinate = &mut model.coordinates[i];
        coordinate.initial = initial;
        coordinate.rate_given = rate.is_some();
        coordinate.initial_rate = rate.unwrap_or(Expr::ZERO);
    }
}

fn system(model: &Model) -> System {
    let equations = mechanics::derive(model).expect("it derives");
    System::compile(model, &equations, &[]).expect("it compiles")
}

fn experiment(model: &Model, change: impl FnOnce(&mut Setup)) -> Experiment {
    let equations = Arc::new(mechanics::derive(model).expect("it derives"));
    let system = System::compile(model, &equations, &[]).expect("it compiles");
    let mut setup = Setup::of(model);
    change(&mut setup);
    Experiment::new(&Arc::new(model.clone()), &equations, &system, setup).expect("a method")
}

fn run(experiment: &mut Experiment, time: f64) {
    let progress = experiment.advance(time, 10_000_000);
    assert_eq!(progress, AdvanceOutcome::Arrived, "{:?}", experiment.status());
}

fn value(experiment: &Experiment, name: &str) -> f64 {
    let place = experiment.system().channels().iter().position(|c| c.name == name);
    experiment.values()[place.unwrap_or_else(|| panic!("no channel {name}"))]
}

/// A pendulum in x, y (down is −y), constrained by a rod.
fn pendulum() -> Model {
    let mut model = lagrangian(&["x", "y"], &["g"], "1/2*(x'^2 + y'^2) - g*y");
    constrain(&mut model, &[("rod", "x^2 + y^2 - 1")]);
    start(&mut model, &[("sin(2)", Some("0")), ("-cos(2)", None)]);
    model
}

#[test]
fn a_pendulum_held_by_a_rod_is_the_pendulum_in_its_angle() {
    let mut angle = lagrangian(&["theta"], &["g"], "1/2*theta'^2 + g*cos(theta)");
    start(&mut angle, &[("2", Some("0"))]);
    for method in ["taylor", "dop853"] {
        let mut held = experiment(&pendulum(), |setup| method.clone_into(&mut setup.method));
        let mut free = experiment(&angle, |_| ());
        for time in [1.0, 10.0, 60.0] {
            run(&mut held, time);
            run(&mut free, time);
            let (theta, rate) = (value(&free, "theta"), value(&free, "theta'"));
            let within = if method == "taylor" { 2e-14 } else { 2e-11 };
            assert!((value(&held, "x") - theta.sin()).abs() < within, "{method} at {time}");
            assert!((value(&held, "y") + theta.cos()).abs() < within, "{method} at {time}");
            assert!((value(&held, "x'") - rate * theta.cos()).abs() < 10.0 * within);
            // m (θ'² + g cos θ) = −2 λ l
            let tension = rate * rate + theta.cos();
            assert!((value(&held, "lambda_rod") + tension / 2.0).abs() < 10.0 * within);
        }
    }
}

#[test]
fn constraints_are_kept_to_rounding_by_every_method_that_takes_them() {
    for (method, step) in [("taylor", None), ("dop853", None), ("rk4", Some(0.02))] {
        let mut held = experiment(&pendulum(), |setup| {
            method.clone_into(&mut setup.method);
            setup.settings.step = step;
        });
        run(&mut held, 100.0);
        let (x, y) = (value(&held, "x"), value(&held, "y"));
        let (u, v) = (value(&held, "x'"), value(&held, "y'"));
        assert!((x * x + y * y - 1.0).abs() < 4e-16, "{method}");
        assert!((x * u + y * v).abs() < 1e-15, "{method}");
    }
}

#[test]
fn methods_that_would_lose_what_they_are_chosen_for_refuse() {
    let system = system(&pendulum());
    for method in ["leapfrog", "yoshida4", "gauss4", "gauss6", "symplectic-euler"] {
        let refused = choose_method(&system, method).map(|m| m.name).unwrap_err().to_string();
        assert!(refused.contains("subject to constraints"), "{method}: {refused}");
    }
}

#[test]
fn a_knife_edge_on_a_slope_draws_a_cycloid() {
    // Neimark & Fufaev, Dynamics of Nonholonomic Systems, I.§6: from rest, turning at ω,
    // x = (g/2ω²) sin² ωt, y = (g/2ω²)(ωt − ½ sin 2ωt), g along the slope
    let mut model = lagrangian(&["x", "y", "phi"], &["g"], "1/2*(x'^2 + y'^2) + 1/2*phi'^2 + g*x");
    constrain(&mut model, &[("edge", "x'*sin(phi) - y'*cos(phi)")]);
    start(&mut model, &[("0", Some("0")), ("0", None), ("0", Some("2"))]);
    let mut sleigh = experiment(&model, |_| ());
    let omega = 2.0_f64;
    for time in [0.3, 1.7, 9.0, 40.0] {
        run(&mut sleigh, time);
        let size = 1.0 / (2.0 * omega * omega);
        let x = size * (omega * time).sin().powi(2);
        let y = size * (omega * time - 0.5 * (2.0 * omega * time).sin());
        assert!((value(&sleigh, "x") - x).abs() < 1e-14, "x at {time}");
        assert!((value(&sleigh, "y") - y).abs() < 4e-15 * (1.0 + y), "y at {time}");
    }
}

/// Rosenberg's particle, z' = y x' (R. M. Rosenberg, Analytical Dynamics of Discrete Systems, 1977).
const ROSENBERG: &str = r#"
title = "Rosenberg's particle"
[coordinates]
x = { initial = 0.0, velocity = 1.0 }
y = { initial = 0.5, velocity = 0.7 }
z = { initial = 0.0 }
[lagrangian]
L = "1/2*(x'^2 + y'^2 + z'^2) - 1/4*x^2"
[[constraints]]
name = "edge"
expression = "z' - y*x'"
[comparison]
eliminate = ["z"]
[[observables]]
name = "twin x"
expression = "other_x"
[[observables]]
name = "twin y"
expression = "other_y"
[[observables]]
name = "twin z'"
expression = "other_z' - other_y*other_x'"
"#;

#[test]
fn the_wrong_mechanics_is_that_of_the_shorter_lagrangian() {
    // substituted into L, the constraint leaves ½((1 + y²) x'² + y'²) − ¼x²
    let short = r#"
title = "the shorter Lagrangian"
[coordinates]
x = { initial = 0.0, velocity = 1.0 }
y = { initial = 0.5, velocity = 0.7 }
[lagrangian]
L = "1/2*((1 + y^2)*x'^2 + y'^2) - 1/4*x^2"
"#;
    let mut both = crate::experiment::build(ROSENBERG, |_| ());
    let mut vakonomic = crate::experiment::build(short, |_| ());
    for time in [0.5, 3.0, 12.0] {
        run(&mut both, time);
        run(&mut vakonomic, time);
        assert!((value(&both, "twin x") - value(&vakonomic, "x")).abs() < 2e-14, "x at {time}");
        assert!((value(&both, "twin y") - value(&vakonomic, "y")).abs() < 2e-14, "y at {time}");
        assert!(value(&both, "twin z'").abs() < 1e-14, "the twin keeps the constraint, too");
    }
    // and it is wrong: the correct motion has y'' = 0
    assert!((value(&both, "y") - (0.5 + 0.7 * 12.0)).abs() < 1e-14);
    assert!((value(&both, "y") - value(&both, "twin y")).abs() > 0.1);
}

#[test]
fn for_a_holonomic_constraint_both_mechanics_are_one() {
    let text = r#"
title = "hoop"
[coordinates]
x = { initial = 0.0, velocity = 0.0 }
theta = { initial = 0.0 }
[lagrangian]
L = "1/2*x'^2 + 1/2*theta'^2 + x"
[[constraints]]
name = "no slip"
expression = "theta' - x'"
[comparison]
eliminate = ["theta"]
[[observables]]
name = "twin"
expression = "other_x"
"#;
    let mut hoop = crate::experiment::build(text, |_| ());
    run(&mut hoop, 8.0);
    assert!((value(&hoop, "x") - 16.0).abs() < 1e-14);
    assert!((value(&hoop, "twin") - 16.0).abs() < 1e-14);
}

#[test]
fn what_is_said_twice_is_reported_and_shared_evenly() {
    let mut model = lagrangian(&["x", "y"], &["g"], "1/2*(x'^2 + y'^2) - g*y");
    constrain(&mut model, &[("rod", "x^2 + y^2 - 1"), ("twin", "2*x^2 + 2*y^2 - 2")]);
    start(&mut model, &[("sin(2)", Some("0")), ("-cos(2)", None)]);
    let mut twice = experiment(&model, |_| ());
    assert_eq!(twice.system().redundant(), ["twin"]);
    let mut once = experiment(&pendulum(), |_| ());
    run(&mut twice, 20.0);
    run(&mut once, 20.0);
    assert!((value(&twice, "x") - value(&once, "x")).abs() < 1e-14);
    // λ₁ + 2 λ₂ = λ with the least λ₁² + λ₂²: λ/5 and 2λ/5
    let lambda = value(&once, "lambda_rod");
    assert!((value(&twice, "lambda_rod") - lambda / 5.0).abs() < 1e-14);
    assert!((value(&twice, "lambda_twin") - 2.0 * lambda / 5.0).abs() < 1e-14);
    assert!(system(&pendulum()).redundant().is_empty());
}

#[test]
fn a_mass_matrix_that_is_singular_alone_is_solved_with_its_constraint() {
    // s has no mass: the constraint ties it to x
    let mut model = lagrangian(&["x", "s"], &["k"], "1/2*x'^2 - 1/2*k*s^2");
    constrain(&mut model, &[("tie", "x - s")]);
    start(&mut model, &[("1", Some("0")), ("1", None)]);
    let mut tied = experiment(&model, |_| ());
    run(&mut tied, 7.0);
    assert!((value(&tied, "x") - 7.0_f64.cos()).abs() < 2e-15);
    assert!((value(&tied, "s'") + 7.0_f64.sin()).abs() < 2e-15);
}

fn initial(model: &Model, given: &[InitialOverride]) -> Result<Vec<f64>, MotionErrorKind> {
    let parameters = model.parameter_values();
    let state = system(model).initial(0.0, &parameters, given);
    state.map(|state| state.values).map_err(|error: MotionError| error.kind)
}

#[test]
fn velocities_left_out_follow_from_the_constraints() {
    let mut model = lagrangian(&["x", "theta"], &["m", "g", "r", "phi"], HOOP);
    constrain(&mut model, &[("no slip", "r*theta' - x'")]);
    start(&mut model, &[("0", Some("3")), ("0", None)]);
    assert_eq!(initial(&model, &[]), Ok(vec![0.0, 0.0, 3.0, 3.0]));
    assert_eq!(initial(&model, &[InitialOverride::Velocity(0, 5.0)]), Ok(vec![0.0, 0.0, 5.0, 5.0]));
    // p_x = m x'
    assert_eq!(initial(&model, &[InitialOverride::Momentum(0, 4.0)]), Ok(vec![0.0, 0.0, 4.0, 4.0]));
    // p_x = m x' and θ' are given, and inconsistent
    let model_of = |rates: [Option<&str>; 2]| {
        let mut model = lagrangian(&["x", "theta"], &["m", "g", "r", "phi"], HOOP);
        constrain(&mut model, &[("no slip", "r*theta' - x'")]);
        start(&mut model, &[("0", rates[0]), ("0", rates[1])]);
        model
    };
    let both = initial(&model_of([None, Some("1")]), &[InitialOverride::Momentum(0, 4.0)]);
    assert_eq!(both, Err(MotionErrorKind::Contradiction));
    // both are given, and inconsistent
    let apart = initial(&model, &[InitialOverride::Velocity(1, 2.0)]).unwrap_err();
    assert!(
        matches!(&apart, MotionErrorKind::VelocitiesMissed(name, _) if name == "no slip"),
        "{apart:?}"
    );
    start(&mut model, &[("0", None), ("0", None)]);
    let free = initial(&model, &[]).unwrap_err();
    assert!(
        matches!(&free, MotionErrorKind::FreeVelocities(names) if names.len() == 1),
        "{free:?}"
    );
}

#[test]
fn a_velocity_that_happens_to_be_free_at_the_start_is_not_guessed() {
    // at (1, 0) the rod fixes x' and leaves y' free; z is in no constraint and remains at rest
    let mut model = lagrangian(&["x", "y", "z"], &[], "1/2*(x'^2 + y'^2 + z'^2)");
    constrain(&mut model, &[("rod", "x^2 + y^2 - 1")]);
    start(&mut model, &[("1", None), ("0", None), ("0", None)]);
    let free = initial(&model, &[]).unwrap_err();
    assert_eq!(free, MotionErrorKind::FreeVelocities(vec!["y'".to_owned()]));
    let state =
        initial(&model, &[InitialOverride::Velocity(1, 2.0)]).expect("nothing is left to choose");
    assert_eq!(state, [1.0, 0.0, 0.0, 0.0, 2.0, 0.0]);
}

#[test]
fn a_start_off_the_constraint_is_refused_and_one_by_rounding_is_put_right() {
    let mut model = pendulum();
    start(&mut model, &[("1", Some("0")), ("1e-3", None)]);
    let off = initial(&model, &[]).unwrap_err();
    assert!(matches!(&off, MotionErrorKind::ConstraintMissed(name, _) if name == "rod"), "{off:?}");
    start(&mut model, &[("0.6", Some("0.8")), ("0.8 + 1e-11", None)]);
    let state = initial(&model, &[]).expect("it is put right");
    assert!((state[0].hypot(state[1]) - 1.0).abs() < 2e-16, "{state:?}");
    assert!((state[0] * state[2] + state[1] * state[3]).abs() < 2e-16, "{state:?}");
}

#[test]
fn a_place_where_constraints_coincide_is_an_error_that_names_it() {
    // where they touch they are equivalent, and just beside that point they have no common solution
    let mut model = lagrangian(&["x", "y"], &["g"], "1/2*(x'^2 + y'^2) - g*x");
    constrain(&mut model, &[("line", "y"), ("parabola", "y - x^2")]);
    start(&mut model, &[("0", Some("1")), ("0", None)]);
    let mut stuck = experiment(&model, |_| ());
    stuck.advance(1.0, 1000);
    let Status::Failed(error) = stuck.status() else { panic!("{:?}", stuck.status()) };
    let right = "the constraint `parabola`, which repeated those before it where the motion began, \
                 contradicts them";
    assert!(error.message.contains(right), "{}", error.message);
    assert!(error.message.contains("began at a singular configuration"), "{}", error.message);
}

#[test]
fn a_body_may_roll() {
    let text = r#"
title = "a ball of parts rolls"
[coordinates]
x = { initial = 0.0, velocity = 1.0 }
theta = { initial = 0.0 }
[body]
pieces = [ { solid = "disc", mass = "2", radius = "0.5" } ]
[lagrangian]
L = "1/2*body_mass*x'^2 + 1/2*Izz*theta'^2 + x"
[[constraints]]
name = "no slip"
expression = "0.5*theta' - x'"
"#;
    let mut ball = crate::experiment::build(text, |_| ());
    run(&mut ball, 2.0);
    // M + I/R² = 2 + 1, so x'' = 1/3
    assert!((value(&ball, "x") - (2.0 + 4.0 / 6.0)).abs() < 1e-15);
}

#[test]
fn a_momentum_of_zero_is_a_momentum() {
    // p_x = x' + 0.1 y'
    let mut model = lagrangian(&["x", "y", "z"], &[], "1/2*(x'^2 + y'^2 + z'^2) + 0.1*x'*y'");
    constrain(&mut model, &[("edge", "z' - 0.7*x'")]);
    start(&mut model, &[("0", None), ("0", Some("0.3")), ("0", None)]);
    let state = initial(&model, &[InitialOverride::Momentum(0, 0.0)]).expect("there is one");
    for (found, right) in state[3..].iter().zip([-0.03, 0.3, -0.021]) {
        assert!((found - right).abs() < 1e-17, "{state:?}");
    }
}

/// A constraint on the velocities that follows from f(q) = const is kept as that: the velocities alone are kept by the
/// projection, and f would drift with the errors of a method.
#[test]
fn what_a_holonomic_constraint_on_the_velocities_keeps_constant_is_kept() {
    let wire = "title = 'wire'\n[coordinates]\nx = { initial = 0.3, velocity = 0.9 }\ny = { initial = 0.5, velocity = 0.54 }\n\
                [lagrangian]\nL = \"1/2*(x'^2 + y'^2) - y - 0.3*x\"\n\
                [[constraints]]\nname = 'wire'\nexpression = \"exp(x)*(y' - 2*x*x')\"\n";
    for (method, step) in [("rk4", Some(0.05)), ("dop853", None), ("taylor", None)] {
        let mut experiment = build(wire, |setup| {
            method.clone_into(&mut setup.method);
            setup.settings.step = step;
        });
        run(&mut experiment, 20.0);
        let off = value(&experiment, "y") - value(&experiment, "x").powi(2) - 0.41;
        assert!(off.abs() < 1e-15, "{method}: {off:e}");
    }
    // the motion is that of the bead on the wire y = x² + 0.41
    let given = wire.replace("exp(x)*(y' - 2*x*x')", "y - x^2 - 0.41");
    let mut of_velocities = build(wire, |_| ());
    let mut of_positions = build(&given, |_| ());
    run(&mut of_velocities, 20.0);
    run(&mut of_positions, 20.0);
    let off = value(&of_velocities, "x") - value(&of_positions, "x");
    assert!(off.abs() < 1e-13, "{off:e}");
}

/// Negatives: an angle of a point jumps by a turn where the constraint on its rate has nothing to jump, and is not kept; a blade
/// has no f at all.
#[test]
fn an_angle_that_jumps_stops_no_motion() {
    let turning = "title = 'turning'\n[coordinates]\nx = { initial = 1, velocity = 0 }\ny = { initial = 0, velocity = 1 }\n\
                   a = { initial = 0.2, velocity = 1 }\n[lagrangian]\n\
                   L = \"1/2*(x'^2 + y'^2 + a'^2) - (x^2 + y^2)\"\n\
                   [[constraints]]\nname = 'turns'\nexpression = \"a' - (x*y' - y*x')/(x^2 + y^2)\"\n";
    let mut experiment = build(turning, |_| ());
    run(&mut experiment, 12.0);
    let (x, y) = (value(&experiment, "x"), value(&experiment, "y"));
    let turns = (value(&experiment, "a") - 0.2 - y.atan2(x)) / std::f64::consts::TAU;
    assert!(turns > 0.5 && (turns - turns.round()).abs() < 1e-12, "{turns}");
    let blade = "title = 'blade'\n[coordinates]\nx = { initial = 0, velocity = 1 }\ny = { initial = 0 }\n\
                 a = { initial = 0, velocity = 0.7 }\n[lagrangian]\nL = \"1/2*(x'^2 + y'^2 + a'^2) - 0.3*x\"\n\
                 [[constraints]]\nname = 'blade'\nexpression = \"x'*sin(a) - y'*cos(a)\"\n";
    let mut experiment = build(blade, |_| ());
    run(&mut experiment, 5.0);
    let across = value(&experiment, "x'") * value(&experiment, "a").sin()
        - value(&experiment, "y'") * value(&experiment, "a").cos();
    assert!(across.abs() < 1e-15, "{across:e}");
}

/// A thread that two points wind up, twice and three times as fast as their angles turn; they pass their cuts at other times. The
/// reference are their polar coordinates.
#[test]
fn a_constraint_goes_on_where_one_of_several_angles_begins_a_new_turn() {
    let wound = "[coordinates]\nx = { initial = 1.0, velocity = 0.0 }\ny = { initial = 0.0, velocity = 1.0 }\n\
                 X = { initial = 1.0, velocity = 0.1 }\nY = { initial = 0.0, velocity = 0.7 }\n\
                 s = { initial = 0.5, velocity = 4.1 }\n[lagrangian]\n\
                 L = \"1/2*(x'^2 + y'^2 + X'^2 + Y'^2 + s'^2) - 1/2*(x^2 + y^2 - 1)^2 - 1/2*(X^2 + Y^2 - 1)^2\"\n\
                 [[constraints]]\nname = \"thread\"\nexpression = \"s - 0.5 - 2*atan2(y, x) - 3*atan2(Y, X)\"\n";
    let polar = "[coordinates]\nr = { initial = 1.0, velocity = 0.0 }\nphi = { initial = 0.0, velocity = 1.0 }\n\
                 R = { initial = 1.0, velocity = 0.1 }\nPhi = { initial = 0.0, velocity = 0.7 }\n[lagrangian]\n\
                 L = \"1/2*(r'^2 + r^2*phi'^2 + R'^2 + R^2*Phi'^2 + (2*phi' + 3*Phi')^2) - 1/2*(r^2 - 1)^2 - 1/2*(R^2 - 1)^2\"\n";
    let mut free = build(polar, |_| ());
    run(&mut free, 20.0);
    let [r, phi, far, turned] = ["r", "phi", "R", "Phi"].map(|name| value(&free, name));
    assert!(phi.abs() > 7.0 || turned.abs() > 7.0, "{phi} {turned}");
    let wanted = [
        ("x", r * phi.cos()),
        ("y", r * phi.sin()),
        ("X", far * turned.cos()),
        ("Y", far * turned.sin()),
        ("s", 0.5 + 2.0 * phi + 3.0 * turned),
    ];
    for (method, step, within) in
        [("taylor", None, 1e-11), ("dop853", None, 1e-9), ("rk4", Some(0.01), 1e-6)]
    {
        let mut motion = build(wound, |setup| {
            method.clone_into(&mut setup.method);
            setup.settings.step = step;
        });
        run(&mut motion, 20.0);
        for (name, expected) in wanted {
            let found = value(&motion, name);
            assert!((found - expected).abs() < within, "{method}: {name} = {found}, {expected}");
        }
    }
}

/// 2 and 0.142859 have the common divisor 1e-6, of which anything that a step has missed is nearly a multiple; 2 and √2 have none.
#[test]
fn a_constraint_goes_on_where_one_of_several_angles_without_a_common_measure_begins_a_new_turn() {
    let wound = |ratio: &str| {
        format!(
            "[coordinates]\nx = {{ initial = 1.0, velocity = 0.0 }}\ny = {{ initial = 0.0, velocity = 1.0 }}\n\
             X = {{ initial = 1.0, velocity = 0.1 }}\nY = {{ initial = 0.0, velocity = 0.7 }}\ns = {{ initial = 0.5 }}\n[lagrangian]\n\
             L = \"1/2*(x'^2 + y'^2 + X'^2 + Y'^2 + s'^2) - 1/2*(x^2 + y^2 - 1)^2 - 1/2*(X^2 + Y^2 - 1)^2\"\n\
             [[constraints]]\nname = \"thread\"\nexpression = \"s - 0.5 - 2*atan2(y, x) - {ratio}*atan2(Y, X)\"\n"
        )
    };
    for (ratio, size) in [
        ("0.142859", 0.142_859),
        ("0.14", 0.14),
        ("1.5", 1.5),
        ("sqrt(2)", std::f64::consts::SQRT_2),
    ] {
        let mut motion = build(&wound(ratio), |setup| {
            "rk4".clone_into(&mut setup.method);
            setup.settings.step = Some(0.1);
        });
        // each angle is followed by its least change in a step
        let mut turned = [0.0_f64; 2];
        for step in 1..=60 {
            run(&mut motion, 0.2 * f64::from(step));
            for (angle, point) in turned.iter_mut().zip([["x", "y"], ["X", "Y"]]) {
                let [x, y] = point.map(|name| value(&motion, name));
                let tau = std::f64::consts::TAU;
                let change = y.atan2(x) - *angle;
                *angle += change - tau * (change / tau).round();
            }
            let off = value(&motion, "s") - 0.5 - 2.0 * turned[0] - size * turned[1];
            assert!(off.abs() < 1e-13, "{ratio}: {off:e} after {step}");
        }
        assert!(turned[0] > 4.0 && turned[1] > 4.0, "{ratio}: {turned:?}");
    }
}

/// A thread that is wound up by the angle of a point, over several turns: the motion of its polar coordinates.
#[test]
fn a_constraint_goes_on_where_an_angle_in_it_begins_a_new_turn() {
    let wound = |angle: &str| {
        format!(
            "[coordinates]\nx = {{ initial = 1.0, velocity = 0.0 }}\ny = {{ initial = 0.0, velocity = 1.0 }}\n\
             s = {{ initial = 0.5, velocity = 2.0 }}\n[lagrangian]\nL = \"1/2*(x'^2 + y'^2 + s'^2) - 1/2*(x^2 + y^2 - 1)^2\"\n\
             [[constraints]]\nname = \"thread\"\nexpression = \"s - 0.5 - {angle}\"\n"
        )
    };
    let polar = "[coordinates]\nr = { initial = 1.0, velocity = 0.0 }\nphi = { initial = 0.0, velocity = 1.0 }\n[lagrangian]\n\
                 L = \"1/2*(r'^2 + (r^2 + 4)*phi'^2) - 1/2*(r^2 - 1)^2\"\n";
    let mut free = build(polar, |_| ());
    run(&mut free, 30.0);
    let (r, phi) = (value(&free, "r"), value(&free, "phi"));
    assert!(phi > 25.0, "{phi}");
    for (method, step, within) in
        [("taylor", None, 1e-12), ("dop853", None, 1e-10), ("rk4", Some(0.01), 1e-7)]
    {
        let mut motion = build(&wound("2*atan2(y, x)"), |setup| {
            method.clone_into(&mut setup.method);
            setup.settings.step = step;
        });
        run(&mut motion, 30.0);
        for (name, expected) in [("x", r * phi.cos()), ("y", r * phi.sin()), ("s", 0.5 + 2.0 * phi)]
        {
            let found = value(&motion, name);
            assert!((found - expected).abs() < within, "{method}: {name} = {found}, {expected}");
        }
    }
}
