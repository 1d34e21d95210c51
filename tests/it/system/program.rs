//! The first evaluator compared with a traversal of the expression's nodes.

use std::sync::Arc;

use phaselab::expr::{Expr, Pool, Symbol};
use phaselab::num::DoubleDouble;
use phaselab::system::{Evaluator, Program};
use proptest::prelude::*;

use crate::build::{names, read, sample, try_read};
use crate::expr::{close, sources};

/// A program for expressions of a model with the coordinates q, u, theta, phi and the parameters
/// m, g, l, k, a, b.
fn program(pool: &mut Pool, outputs: &[Expr]) -> (Arc<Program>, Vec<Symbol>, Vec<Symbol>) {
    let parameters = ["m", "g", "l", "k", "a", "b"].map(|name| pool.symbol(name)).to_vec();
    let inputs = ["q", "u", "theta", "phi"];
    let inputs: Vec<Symbol> = inputs
        .iter()
        .flat_map(|name| [(*name).to_owned(), format!("{name}'"), format!("p_{name}")])
        .map(|name| pool.symbol(&name))
        .collect();
    let time = pool.symbol("t");
    let program = Program::compile(pool, &parameters, time, &inputs, outputs);
    (program.expect("all symbols are known"), parameters, inputs)
}

proptest! {
    #![proptest_config(crate::cases(400))]

    #[test]
    fn values_agree_with_the_nodes(source in sources(), seed in 0..1000_u64) {
        let mut model = names(&["q", "u", "theta", "phi"], &["m", "g", "l", "k", "a", "b"]);
        let e = try_read(&mut model, &source);
        prop_assume!(e.is_ok());
        let e = e.unwrap();
        let (program, parameters, inputs) = program(&mut model.pool, &[e]);
        let at = sample(seed);
        let (expected, size) = model.pool.evaluate_with_size(e, &at);
        prop_assume!(size < 1e12);
        let time = at(model.symbols.time);

        let exact: Vec<DoubleDouble> = parameters.iter().map(|&s| DoubleDouble::from(at(s))).collect();
        let rounded: Vec<f64> = inputs.iter().map(|&s| at(s)).collect();
        let mut values = Evaluator::<f64>::new(Arc::clone(&program));
        values.set_parameters(&exact);
        values.evaluate(time, &rounded).expect("nothing is solved for");
        let single = values.output(0);
        prop_assert!(close(single, expected, size), "{} = {} but {}", source, expected, single);

        let inputs: Vec<DoubleDouble> = rounded.iter().map(|&x| DoubleDouble::from(x)).collect();
        let mut values = Evaluator::<DoubleDouble>::new(program);
        values.set_parameters(&exact);
        values.evaluate(DoubleDouble::from(time), &inputs).expect("nothing is solved for");
        let double = values.output(0).high;
        prop_assert!(close(double, expected, size), "{} = {} but {}", source, expected, double);
    }
}

/// The value of an expression at q = 0.3, u = −0.7, m = `m`.
fn value(source: &str, m: f64) -> f64 {
    let mut model = names(&["q", "u", "theta", "phi"], &["m", "g", "l", "k", "a", "b"]);
    let e = read(&mut model, source);
    let (program, _, _) = program(&mut model.pool, &[e]);
    let mut values = Evaluator::<f64>::new(program);
    values.set_parameters(&[DoubleDouble::from(m); 6]);
    let mut inputs = [0.0; 12];
    (inputs[0], inputs[3]) = (0.3, -0.7);
    values.evaluate(0.0, &inputs).expect("nothing is solved for");
    values.output(0)
}

#[test]
fn powers_with_a_parameter_for_exponent_take_any_base() {
    assert_eq!(value("u^m", 2.0), 0.7 * 0.7);
    assert_eq!(value("u^m", 3.0), -(0.7 * 0.7 * 0.7));
    assert_eq!(value("u^m", -1.0), 1.0 / -0.7);
    assert_eq!(value("u^m", 0.0), 1.0);
    assert!(value("u^m", 0.5).is_nan());
    assert!((value("q^m", 0.5) - 0.3_f64.sqrt()).abs() < 1e-16);
}

#[test]
fn roots_of_squares_are_absolute_values() {
    assert_eq!(value("sqrt(u^2)", 1.0), 0.7);
    assert!((value("(u^2*q)^(3/2)", 1.0) - (0.49_f64 * 0.3).powf(1.5)).abs() < 1e-16);
    assert!((value("(m*u^4)^(1/4)", 16.0) - 1.4).abs() < 1e-15);
}

#[test]
fn on_a_kink_the_branches_meet_in_the_middle() {
    assert_eq!(value("sign(q - 3/10)", 1.0), 0.0);
    assert_eq!(value("max(q, 3/10)", 1.0), 0.3);
    assert_eq!(value("abs(0*u + q - 3/10) + 1", 1.0), 1.0);
    assert!(value("sign(sqrt(u))", 1.0).is_nan());
}

#[test]
fn equal_parts_are_computed_once_and_parameters_apart() {
    let mut model = names(&["q", "u", "theta", "phi"], &["m", "g", "l", "k", "a", "b"]);
    let a = read(&mut model, "sin(theta - phi)*q^4 + cos(theta - phi)");
    let b = read(&mut model, "cos(phi - theta)*q^2/u");
    let (both, _, _) = program(&mut model.pool, &[a, b]);
    let (one, _, _) = program(&mut model.pool, &[a]);
    // b adds a product and a quotient, nothing else
    assert_eq!(both.len(), one.len() + 2);
    let fixed = read(&mut model, "sqrt(m*g/l) + k*sin(a)^2");
    let (program, _, _) = program(&mut model.pool, &[fixed]);
    assert_eq!(program.live_len(), 0);
}

#[test]
fn an_unknown_symbol_is_reported() {
    let mut model = names(&["q"], &["m"]);
    let e = read(&mut model, "q + m*energy");
    let inputs = [model.coordinates[0].position];
    let parameters = [model.parameters[0].symbol];
    let time = model.symbols.time;
    let outcome = Program::compile(&mut model.pool, &parameters, time, &inputs, &[e]);
    assert_eq!(outcome.expect_err("energy stands for nothing"), model.symbols.energy);
}
