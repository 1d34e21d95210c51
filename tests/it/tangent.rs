//! Tangent vectors: programs, series and methods against derivatives found in other ways.

use std::sync::Arc;

use phaselab::expr::Symbol;
use phaselab::integrate::{METHODS, Settings, Stepping, method_named};
use phaselab::num::DoubleDouble;
use phaselab::system::{Evaluator, Form, Jet, Program, State, System};

use crate::build::{names, read};
use crate::fixtures::{loaded, lowered};

/// Expressions in x, y, v and the parameters a, b that use every operation of a program.
const EXPRESSIONS: &[&str] = &[
    "3*x - 2*y + 5",
    "a*x*y*v",
    "x^2*y^3 - v^7",
    "(x + y)/(v - 3)",
    "a/(x^2 + y^2)",
    "sqrt(x^2 + b*y + 4)",
    "(x^2 + y^2 + 1)^(3/2)",
    "(x + 2)^(1/3)",
    "(y + 2)^(-7/5)",
    "(x + 2)^a",
    "(x + y + 3)^(2*b)",
    "(x + 2)^(y*v)",
    "sin(x*y) + cos(x - v)",
    "sin(a*x)*cos(a*x)",
    "tan(x*v/3)",
    "cot(x + 1)",
    "asin(x*y/3)",
    "acos(x*v/4)",
    "atan(x*y*v)",
    "atan2(x + y, v + 2)",
    "sinh(x)*cosh(y*v)",
    "tanh(x - v)",
    "exp(x*y - v^2)",
    "ln(x + y + 2)",
    "abs(x - 5)*y",
    "sign(v + 3)*x",
    "min(x, y)*v + max(x^2, v)",
    "t*x^2 + sin(t*y)",
];

const VARIABLES: [&str; 3] = ["x", "y", "v"];
const AT: [f64; 3] = [0.37, 0.81, -0.53];

/// The programs of all expressions, of their symbolic derivatives row by row, and the former with
/// tangent vectors.
fn programs() -> (Arc<Program>, Arc<Program>, Arc<Program>) {
    let mut model = names(&VARIABLES, &["a", "b"]);
    let outputs: Vec<_> = EXPRESSIONS.iter().map(|text| read(&mut model, text)).collect();
    let pool = &mut model.pool;
    let symbols = |pool: &mut phaselab::expr::Pool, names: &[&str]| -> Vec<Symbol> {
        names.iter().map(|name| pool.symbol(name)).collect()
    };
    let (parameters, inputs) = (symbols(pool, &["a", "b"]), symbols(pool, &VARIABLES));
    let time = pool.symbol("t");
    let mut derivatives = Vec::new();
    for &e in &outputs {
        derivatives.extend(inputs.iter().map(|&x| pool.derivative(e, x)));
    }
    let mut compile = |outputs: &[_]| {
        Program::compile(pool, &parameters, time, &inputs, outputs).expect("all are known")
    };
    let (plain, symbolic) = (compile(&outputs), compile(&derivatives));
    let carried = plain.with_tangents(3);
    (plain, symbolic, carried)
}

fn parameters() -> [DoubleDouble; 2] {
    [1.7, 1.5].map(DoubleDouble::from)
}

/// The inputs followed by the unit vectors.
fn with_unit_vectors(at: &[DoubleDouble]) -> Vec<DoubleDouble> {
    let mut inputs = at.to_vec();
    for i in 0..at.len() {
        inputs.extend((0..at.len()).map(|j| DoubleDouble::from(f64::from(u8::from(i == j)))));
    }
    inputs
}

fn evaluated(program: &Arc<Program>, inputs: &[DoubleDouble]) -> Vec<DoubleDouble> {
    let mut values = Evaluator::<DoubleDouble>::new(Arc::clone(program));
    values.set_parameters(&parameters());
    values.evaluate(DoubleDouble::from(0.9), inputs).expect("nothing is solved for");
    (0..program.outputs()).map(|i| values.output(i)).collect()
}

#[test]
fn every_operation_has_the_derivative_of_symbols_and_of_differences() {
    let (plain, symbolic, carried) = programs();
    let n = EXPRESSIONS.len();
    let at = AT.map(DoubleDouble::from);
    let found = evaluated(&carried, &with_unit_vectors(&at));
    let expected = evaluated(&symbolic, &at);
    let values = evaluated(&plain, &at);
    for (k, text) in EXPRESSIONS.iter().enumerate() {
        assert_eq!(found[k], values[k], "{text}: the value itself");
        for i in 0..3 {
            let (own, other) = (found[n + i * n + k], expected[3 * k + i]);
            let size = other.high.abs().max(1.0);
            assert!((own - other).high.abs() <= 1e-28 * size, "∂({text})/∂{}", VARIABLES[i]);
            let step = 1e-8;
            let [above, below] = [step, -step].map(|step| {
                let mut there = at;
                there[i] = there[i] + DoubleDouble::from(step);
                evaluated(&plain, &there)[k]
            });
            let difference = (above - below) * (0.5 / step);
            assert!((own - difference).high.abs() <= 1e-13 * size, "Δ({text})/Δ{}", VARIABLES[i]);
        }
    }
}

#[test]
fn the_series_of_derivatives_are_the_derivatives_of_series() {
    const ORDER: usize = 9;
    let (_, symbolic, carried) = programs();
    let n = EXPRESSIONS.len();
    let mut own = Jet::<DoubleDouble>::new(carried, ORDER);
    let mut other = Jet::<DoubleDouble>::new(symbolic, ORDER);
    for jet in [&mut own, &mut other] {
        jet.set_parameters(&parameters());
        // abs(x − 5), sign(v + 3), min(x, y), max(x², v) at these values
        let sides: Vec<bool> = (0..jet.switches()).map(|_| true).collect();
        assert!(!sides.is_empty());
    }
    // both programs meet the switches in the same order only where they are the same
    let mut sides = Evaluator::<DoubleDouble>::new(programs().2);
    sides.set_parameters(&parameters());
    let at = AT.map(DoubleDouble::from);
    sides.evaluate(DoubleDouble::from(0.9), &with_unit_vectors(&at)).unwrap();
    for i in 0..own.switches() {
        own.set_side(i, side(sides.switch(i).high));
    }
    let mut sides = Evaluator::<DoubleDouble>::new(programs().1);
    sides.set_parameters(&parameters());
    sides.evaluate(DoubleDouble::from(0.9), &at).unwrap();
    for i in 0..other.switches() {
        other.set_side(i, side(sides.switch(i).high));
    }
    let time = DoubleDouble::from(0.9);
    for k in 0..=ORDER {
        for (i, &x) in AT.iter().enumerate() {
            // x + 0.3 s + 0.09 s² …: any series will do
            let c = x * 0.3_f64.powi(k as i32);
            own.set_input(i, k, DoubleDouble::from(c));
            other.set_input(i, k, DoubleDouble::from(c));
            for j in 0..3 {
                let unit = if k == 0 && i == j { 1.0 } else { 0.0 };
                own.set_input(3 + 3 * i + j, k, DoubleDouble::from(unit));
            }
        }
        own.advance(k, time, 1.0).unwrap();
        other.advance(k, time, 1.0).unwrap();
        for (e, text) in EXPRESSIONS.iter().enumerate() {
            for i in 0..3 {
                let (found, wanted) = (own.output(n + i * n + e, k), other.output(3 * e + i, k));
                let size = wanted.high.abs().max(1.0);
                let off = (found - wanted).high.abs();
                assert!(off <= 1e-26 * size, "order {k} of ∂({text})/∂{}", VARIABLES[i]);
            }
        }
    }
}

fn side(value: f64) -> phaselab::system::Side {
    use phaselab::system::Side;
    if value < 0.0 { Side::Negative } else { Side::Positive }
}

/// The motion of a system by a method, from a state whose tangent vectors are unit vectors; the
/// result is in the form of the start.
fn carried(
    (system, start, parameters): (&System, &State, &[f64]),
    method: &str,
    step: Option<f64>,
    until: f64,
) -> (State, Vec<Vec<f64>>) {
    let n = system.moving();
    let tangent = system.with_tangents(n);
    let mut state = tangent.extended(start, system);
    for i in 0..n {
        state.values[tangent.tangent_place(i) + i] = 1.0;
    }
    let end = stepped((&tangent, &state, parameters), method, step, until);
    let end = tangent.convert(&end, start.form, parameters).unwrap();
    let column = |j: usize| {
        let first = tangent.tangent_place(j);
        end.values[first..first + n].to_vec()
    };
    let columns = (0..n).map(column).collect();
    (system.extended(&end, &tangent), columns)
}

fn stepped(
    (system, start, parameters): (&System, &State, &[f64]),
    method: &str,
    step: Option<f64>,
    until: f64,
) -> State {
    let settings = Settings { step, tolerance: None };
    let mut stepper = (method_named(method).unwrap().make)(system, &settings).unwrap();
    stepper.start(start, parameters).unwrap();
    while stepper.time() < until {
        stepper.step(until).unwrap();
    }
    let mut state = stepper.state().clone();
    stepper.at(until, &mut state).unwrap();
    state
}

/// A preset's system, its initial state in canonical variables where there are any, parameters.
fn preset(name: &str) -> (System, State, Vec<f64>) {
    let loaded = loaded(name, 1);
    let parameters = loaded.model.parameter_values();
    let system = System::clone(&loaded.system);
    let state = system.initial(0.0, &parameters, &[]).unwrap();
    let form = if system.form() == Form::Variables { Form::Variables } else { Form::Momentum };
    let state = system.convert(&state, form, &parameters).unwrap();
    (system, state, parameters)
}

/// The derivative of a motion by central differences of whole motions, of order 4.
fn differences(
    (system, start, parameters): (&System, &State, &[f64]),
    method: &str,
    step: Option<f64>,
    until: f64,
) -> Vec<Vec<f64>> {
    let small = 1e-6;
    let ends = |i: usize, by: f64| {
        let mut state = start.clone();
        state.set(i, state.exact(i) + DoubleDouble::from(by));
        let end = stepped((system, &state, parameters), method, step, until);
        system.convert(&end, start.form, parameters).unwrap()
    };
    let n = system.moving();
    let column = |i: usize| {
        let [far_below, below, above, far_above] =
            [-2.0, -1.0, 1.0, 2.0].map(|steps| ends(i, steps * small));
        let across =
            |above: &State, below: &State, k: usize| (above.exact(k) - below.exact(k)).high;
        let difference =
            |k: usize| 8.0 * across(&above, &below, k) - across(&far_above, &far_below, k);
        (0..n).map(|k| difference(k) / (12.0 * small)).collect()
    };
    (0..n).map(column).collect()
}

fn largest(columns: &[Vec<f64>]) -> f64 {
    columns.iter().flatten().fold(1.0, |m: f64, x| m.max(x.abs()))
}

fn assert_alike(name: &str, found: &[Vec<f64>], expected: &[Vec<f64>], within: f64) {
    let size = largest(expected);
    for (j, (own, other)) in found.iter().zip(expected).enumerate() {
        for (i, (a, b)) in own.iter().zip(other).enumerate() {
            assert!((a - b).abs() <= within * size, "{name}: ∂{i}/∂{j}: {a} but {b}");
        }
    }
}

/// |Mᵀ 𝕁 M − 𝕁|, for columns in (q, p).
fn symplectic_residual(columns: &[Vec<f64>]) -> f64 {
    let n = columns.len() / 2;
    let form =
        |a: &[f64], b: &[f64]| (0..n).map(|i| a[i] * b[n + i] - a[n + i] * b[i]).sum::<f64>();
    let mut residual = 0.0_f64;
    for (i, a) in columns.iter().enumerate() {
        for (j, b) in columns.iter().enumerate() {
            let unit = f64::from(i8::from(j == i + n) - i8::from(i == j + n));
            residual = residual.max((form(a, b) - unit).abs());
        }
    }
    residual
}

/// Presets with every kind of program: functions, quotients, roots, `Solve`, brackets, friction,
/// the time.
const PRESETS: &[&str] = &[
    "henon-heiles",
    "pendulum",
    "double-pendulum",
    "heavy-top",
    "planet",
    "restricted-three-body",
    "free-rigid-body",
    "kepler-brackets",
    "damped-pendulum",
    "driven-damped-pendulum",
    "relativistic-particle",
    "toda",
];

#[test]
fn the_derivative_of_a_motion_is_the_limit_of_its_differences() {
    for name in PRESETS {
        let (system, start, parameters) = preset(name);
        let case = (&system, &start, &parameters[..]);
        let (_, found) = carried(case, "taylor", None, 1.5);
        assert_alike(name, &found, &differences(case, "taylor", None, 1.5), 1e-7);
    }
}

#[test]
fn the_flow_of_a_hamiltonian_is_symplectic_and_one_with_friction_is_not() {
    for name in ["henon-heiles", "pendulum", "double-pendulum", "heavy-top", "planet", "toda"] {
        let (system, start, parameters) = preset(name);
        let (_, found) = carried((&system, &start, &parameters), "taylor", None, 3.0);
        let residual = symplectic_residual(&found);
        assert!(residual <= 1e-14 * largest(&found).powi(2), "{name}: {residual:e}");
    }
    let (system, start, parameters) = preset("damped-pendulum");
    let (_, found) = carried((&system, &start, &parameters), "taylor", None, 3.0);
    assert!(symplectic_residual(&found) > 1e-3);
}

#[test]
fn the_variational_equations_of_a_forced_pendulum_agree_with_published_digits() {
    // heyoka.py, var_ode_sys: ẍ = cos t − 0.4 ẋ − sin x, (0.2, 0.3) to t = 3
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 0.2, velocity = 0.3 }\n\
                [lagrangian]\nL = \"1/2*x'^2 + cos(x)\"\nforces = { x = \"cos(t) - 0.4*x'\" }\n";
    let loaded = lowered(text);
    let start = loaded.system.initial(0.0, &[], &[]).unwrap();
    let (state, found) = carried((&loaded.system, &start, &[]), "taylor", None, 3.0);
    assert_alike(
        "state",
        &[state.values[..2].to_vec()],
        &[vec![0.117572149311105, -1.24940655918711]],
        2e-14,
    );
    let expected = vec![
        vec![-0.425477996842754, -0.191718183438907],
        vec![0.419836489925857, -0.518719944062857],
    ];
    assert_alike("M", &found, &expected, 2e-14);
    let determinant = found[0][0] * found[1][1] - found[1][0] * found[0][1];
    assert!((determinant - (-1.2_f64).exp()).abs() < 1e-15);
}

#[test]
fn tangent_vectors_do_not_act_on_the_motion() {
    for method in METHODS {
        for name in ["henon-heiles", "double-pendulum", "planet"] {
            let (system, start, parameters) = preset(name);
            // the iteration of an implicit method may end a pass earlier where fewer numbers move
            let gauss = method.name.starts_with("gauss") || method.name == "symplectic-euler";
            if (method.fits)(&system).is_err() || (gauss && name == "planet") {
                continue;
            }
            let fixed = method.stepping == Stepping::Fixed;
            let step = fixed.then_some(0.0125);
            let case = (&system, &start, &parameters[..]);
            let end = stepped(case, method.name, step, 2.0);
            let end = system.convert(&end, start.form, &parameters).unwrap();
            let (with, _) = carried(case, method.name, step, 2.0);
            let exact = fixed && !gauss;
            for i in 0..system.moving() {
                let off = (with.exact(i) - end.exact(i)).high.abs();
                // adaptive methods may choose other steps, Gauss's may take another pass
                let allowed = match method.name {
                    _ if exact => 0.0,
                    "dop853" => 1e-11,
                    _ => 4e-15,
                };
                assert!(
                    off <= allowed * end.values[i].abs().max(1.0),
                    "{name} {}: {off:e}",
                    method.name
                );
            }
        }
    }
}

#[test]
fn a_method_of_fixed_step_has_the_derivative_of_its_own_map() {
    for method in METHODS.iter().filter(|method| method.stepping == Stepping::Fixed) {
        for name in ["henon-heiles", "double-pendulum"] {
            let (system, start, parameters) = preset(name);
            if (method.fits)(&system).is_err() {
                continue;
            }
            let case = (&system, &start, &parameters[..]);
            let step = Some(if name == "henon-heiles" { 0.25 } else { 0.0625 });
            let until = 1.0;
            let (_, found) = carried(case, method.name, step, until);
            let expected = differences(case, method.name, step, until);
            assert_alike(&format!("{} of {name}", method.name), &found, &expected, 1e-8);
            let (_, exact) = carried(case, "taylor", None, until);
            let apart = found.iter().flatten().zip(exact.iter().flatten());
            let apart = apart.fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
            // the map of the method is not the flow
            assert!(apart > 1e-9, "{} of {name}: {apart:e}", method.name);
            if method.preserves.is_symplectic() {
                let residual = symplectic_residual(&found);
                assert!(
                    residual < 1e-12 * largest(&found),
                    "{} of {name}: {residual:e}",
                    method.name
                );
            }
        }
    }
}
