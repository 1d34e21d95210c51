//! The second evaluator: Taylor coefficients of every function, compared with numbers of 60 digits, and
//! of random expressions, compared with plain series arithmetic.

use std::collections::HashMap;
use std::sync::Arc;

use phaselab::expr::{Expr, Node, Pool, Symbol};
use phaselab::model::Model;
use phaselab::num::{DoubleDouble, Number, Real};
use phaselab::system::{Jet, Program};
use proptest::prelude::*;

use crate::build::{names, read, sample, try_read};
use crate::expr::sources;
use crate::nonempty;

/// The functions in `tests/series.txt` with their coefficients.
fn known_series() -> impl Iterator<Item = (&'static str, Vec<f64>)> {
    let lines = include_str!("../../series.txt").lines().filter(|line| !line.starts_with('#'));
    lines.map(|line| {
        let (source, numbers) = line.split_once(" = ").expect("a function and its coefficients");
        (source, numbers.split(' ').map(|c| c.parse().expect("a coefficient")).collect())
    })
}

/// The program for one expression in u, x, t and the parameters n, s.
fn program(model: &mut Model, e: Expr) -> Arc<Program> {
    let parameters = [model.pool.symbol("n"), model.pool.symbol("s")];
    let inputs = [model.pool.symbol("u"), model.pool.symbol("x")];
    let time = model.symbols.time;
    Program::compile(&mut model.pool, &parameters, time, &inputs, &[e]).expect("known symbols")
}

fn coefficients<R: Real>(program: Arc<Program>, parameters: [f64; 2]) -> Vec<R> {
    let u = [R::of(Number::ratio(3, 10).double()), R::of(Number::ratio(1, 5).double())];
    let third = R::of(Number::ratio(-1, 10).double());
    let x = [R::of(Number::HALF.double()), R::of(Number::ratio(-1, 7).double())];
    let mut jet = Jet::<R>::new(program, 9);
    jet.set_parameters(&parameters.map(DoubleDouble::from_decimal));
    for k in 0..=9 {
        jet.set_input(0, k, *u.iter().chain([&third]).nth(k).unwrap_or(&R::ZERO));
        jet.set_input(1, k, *x.get(k).unwrap_or(&R::ZERO));
        jet.advance(k, R::of(DoubleDouble::from_decimal(0.4)), 1.0).expect("nothing is solved for");
    }
    (0..=9).map(|k| jet.output(0, k)).collect()
}

#[test]
fn every_function_has_the_right_series() {
    for (source, expected) in nonempty(known_series()) {
        let mut model = names(&["u", "x"], &["n", "s"]);
        let e = read(&mut model, source);
        let program = program(&mut model, e);
        let single = coefficients::<f64>(Arc::clone(&program), [5.0, 2.7]);
        let double = coefficients::<DoubleDouble>(program, [5.0, 2.7]);
        let size = expected.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
        for k in 0..10 {
            let error = (single[k] - expected[k]).abs();
            assert!(error < 2e-15 * size, "{source}, order {k}: {error:e}");
            let error = (double[k].high - expected[k]).abs();
            assert!(
                error <= 1e-28 * size + 2.3e-16 * expected[k].abs(),
                "{source}, order {k}: {error:e}"
            );
        }
    }
}

const ORDER: usize = 6;
type Plain = [f64; ORDER + 1];

/// Plain series arithmetic, with which the program is compared.
struct Oracle<'a> {
    pool: &'a mut Pool,
    inputs: HashMap<Symbol, Plain>,
    at: Box<dyn Fn(Symbol) -> f64>,
}

impl Oracle<'_> {
    fn series(&mut self, e: Expr) -> Plain {
        match self.pool.node(e).clone() {
            Node::Number(n) => constant(n.value()),
            Node::Pi => constant(std::f64::consts::PI),
            Node::Symbol(s) => self.inputs.get(&s).copied().unwrap_or(constant((self.at)(s))),
            Node::Sum(c, terms) => terms.iter().fold(constant(c.value()), |sum, &(c, t)| {
                let t = self.series(t);
                std::array::from_fn(|k| sum[k] + c.value() * t[k])
            }),
            Node::Product(c, factors) => {
                factors.iter().fold(constant(c.value()), |product, &(base, n)| {
                    let base = self.series(base);
                    times(product, compose(base, |x, k| power_derivative(x, n.value(), k)))
                })
            }
            Node::Power(base, exponent) => {
                let (base, exponent) = (self.series(base), self.series(exponent));
                let logarithm = compose(base, |x, k| match k {
                    0 => x.ln(),
                    _ => power_derivative(x, -1.0, k - 1),
                });
                compose(times(exponent, logarithm), |x, _| x.exp())
            }
            Node::Call(function, arguments) => {
                let row = function.row();
                let series: Vec<Plain> = arguments.iter().map(|&a| self.series(a)).collect();
                if arguments.len() == 2 {
                    // max, min: the chosen branch, if the choice is clear
                    let first = (row.value)(&[series[0][0], series[1][0]]) == series[0][0];
                    return if first { series[0] } else { series[1] };
                }
                // derivatives of the function by the rules of differentiation alone
                let mut derivatives = Vec::new();
                let x = self.pool.symbol("oracle");
                let mut derived = self.pool.variable(x);
                derived = self.pool.call(function, &[derived]);
                for _ in 0..=ORDER {
                    derivatives.push(self.pool.evaluate(derived, &|_| series[0][0]));
                    derived = self.pool.derivative(derived, x);
                }
                compose(series[0], |_, k| derivatives[k])
            }
        }
    }
}

fn constant(x: f64) -> Plain {
    std::array::from_fn(|k| if k == 0 { x } else { 0.0 })
}

fn times(a: Plain, b: Plain) -> Plain {
    std::array::from_fn(|k| (0..=k).map(|j| a[j] * b[k - j]).sum())
}

/// `f(u)` from the derivatives of `f` at `u_0`: `Σ f⁽ᵏ⁾(u_0)/k! (u − u_0)^k`.
fn compose(u: Plain, derivative: impl Fn(f64, usize) -> f64) -> Plain {
    let mut rest = u;
    rest[0] = 0.0;
    let (mut sum, mut power, mut factorial) = (constant(0.0), constant(1.0), 1.0);
    for k in 0..=ORDER {
        let c = derivative(u[0], k) / factorial;
        sum = std::array::from_fn(|j| sum[j] + if power[j] == 0.0 { 0.0 } else { c * power[j] });
        power = times(power, rest);
        factorial *= (k + 1) as f64;
    }
    sum
}

fn power_derivative(x: f64, n: f64, k: usize) -> f64 {
    (0..k).fold(1.0, |c, j| c * (n - j as f64)) * x.powf(n - k as f64)
}

proptest! {
    #![proptest_config(crate::cases(200))]

    #[test]
    fn series_agree_with_the_oracle(source in sources(), seed in 0..1000_u64) {
        let mut model = names(&["q", "u", "theta", "phi"], &["m", "g", "l", "k", "a", "b"]);
        let e = try_read(&mut model, &source);
        prop_assume!(e.is_ok());
        let e = e.unwrap();
        prop_assume!(!source.contains("max"));
        let symbols: Vec<Symbol> = model.pool.symbols_of(e);
        let at = sample(seed);
        let inputs: HashMap<Symbol, Plain> = symbols
            .iter()
            .map(|&s| (s, std::array::from_fn(|k| at(s) * 0.5_f64.powi(k as i32) * (1.0 - 0.3 * k as f64))))
            .collect();
        let time = model.symbols.time;
        let inputs: HashMap<Symbol, Plain> = inputs.into_iter().filter(|(s, _)| *s != time).collect();
        let order: Vec<Symbol> = inputs.keys().copied().collect();
        let program = Program::compile(&mut model.pool, &[], time, &order, &[e]);
        let program = program.expect("all symbols are inputs");
        let mut jet = Jet::<f64>::new(program, ORDER);
        jet.set_parameters(&[]);
        let mut oracle_inputs = inputs.clone();
        oracle_inputs.insert(time, std::array::from_fn(|k| [0.7, 1.0, 0.0][k.min(2)]));
        let mut oracle = Oracle { pool: &mut model.pool, inputs: oracle_inputs, at: Box::new(|_| f64::NAN) };
        let expected = oracle.series(e);
        let size = expected.iter().fold(1.0_f64, |m, c| m.max(c.abs()));
        prop_assume!(size < 1e6);
        for k in 0..=ORDER {
            for (i, s) in order.iter().enumerate() {
                jet.set_input(i, k, inputs[s][k]);
            }
            jet.advance(k, 0.7, 1.0).expect("nothing is solved for");
            let error = (jet.output(0, k) - expected[k]).abs();
            prop_assert!(error < 1e-9 * size, "{} at order {}: {:e} of {:e}", source, k, error, size);
        }
    }
}
