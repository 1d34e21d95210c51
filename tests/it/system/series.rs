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

/// Coefficients of t^0 … t^9 for u = 3/10 + t/5 − t²/10 and x = 1/2 − t/7 (mpmath, 60 digits).
const SERIES: &[(&str, [f64; 10])] = &[
    (
        "sin(u)",
        [
            0.2955202066613396,
            0.1910672978251212,
            -0.1014440530457874,
            0.004636622147725983,
            0.0004527732920552701,
            -0.0009921916193761163,
            0.0001823795904634166,
            -3.4053844908318756e-06,
            -2.0431168617924883e-06,
            8.489733732853971e-07,
        ],
    ),
    (
        "cos(u)",
        [
            0.955336489125606,
            -0.05910404133226792,
            0.010445290883621837,
            0.01950075672472724,
            -0.005304033759675669,
            0.00016735395422682854,
            4.816549704771288e-05,
            -3.355917742398666e-05,
            4.644624373856211e-06,
            -3.027261397865305e-08,
        ],
    ),
    (
        "tan(u)",
        [
            0.30933624960962325,
            0.21913778306450943,
            -0.0960114395400662,
            -0.009796852613956497,
            -0.0018381121011490655,
            0.002077111891994883,
            -4.7553792031132706e-05,
            -2.945163321731569e-05,
            -4.3294130638192954e-05,
            7.4226465428974e-06,
        ],
    ),
    (
        "cot(u)",
        [
            3.2327281437658275,
            -2.2901062502991305,
            2.625711310660771,
            -2.4685060130350576,
            2.5103670915625864,
            -2.4967057669052335,
            2.5011611910710974,
            -2.499618195200545,
            2.500127584390682,
            -2.4999578555109134,
        ],
    ),
    (
        "asin(u)",
        [
            0.3046926540153975,
            0.20965696734438366,
            -0.09791671551798138,
            -0.004920098698296328,
            -0.0009941422355203675,
            0.001026808231272705,
            1.9729641797838013e-06,
            -7.623848377447327e-06,
            -2.597652470867753e-05,
            1.6841661070528785e-06,
        ],
    ),
    (
        "acos(u)",
        [
            1.2661036727794992,
            -0.20965696734438366,
            0.09791671551798138,
            0.004920098698296328,
            0.0009941422355203675,
            -0.001026808231272705,
            -1.9729641797838013e-06,
            7.623848377447327e-06,
            2.597652470867753e-05,
            -1.6841661070528785e-06,
        ],
    ),
    (
        "atan(u)",
        [
            0.2914567944778671,
            0.1834862385321101,
            -0.10184327918525377,
            0.008596976078013182,
            3.917591417190537e-05,
            -0.001740423962250115,
            0.0006293411565061894,
            -0.00011517813433582679,
            -2.0341887315832792e-05,
            2.461430669624617e-05,
        ],
    ),
    (
        "sinh(u)",
        [
            0.3045202934471426,
            0.20906770282577208,
            -0.0984434455439432,
            -0.004696621183437705,
            -0.0005477742081255317,
            0.0010075233777069184,
            -0.00015071291130042626,
            -3.2603036043258645e-06,
            -2.123392956532288e-06,
            8.173062353913857e-07,
        ],
    ),
    (
        "cosh(u)",
        [
            1.0453385141288605,
            0.060904058689428525,
            -0.009545259062137053,
            -0.020500743224647688,
            0.004687341218025274,
            0.00016595387901248695,
            5.1843252861081674e-05,
            -3.309246540020985e-05,
            3.68631519240251e-06,
            2.526468106207948e-08,
        ],
    ),
    (
        "tanh(u)",
        [
            0.2913126124515909,
            0.18302739236532584,
            -0.10217733374669201,
            0.008844562755894255,
            0.0003108685423025567,
            -0.0018443343378310778,
            0.0005542370124583796,
            -6.944778228349212e-05,
            -2.2058312393903387e-05,
            1.6197305966079337e-05,
        ],
    ),
    (
        "exp(u)",
        [
            1.3498588075760032,
            0.26997176151520064,
            -0.10798870460608025,
            -0.025197364408085392,
            0.004139567009899743,
            0.0011734772567194053,
            -9.886965843934458e-05,
            -3.635276900453571e-05,
            1.5629222358702217e-06,
            8.425709164534652e-07,
        ],
    ),
    (
        "ln(u)",
        [
            -1.203972804325936,
            0.6666666666666666,
            -0.5555555555555556,
            0.32098765432098764,
            -0.25308641975308643,
            0.1991769547325103,
            -0.16689529035208048,
            0.1427918218041675,
            -0.1250190519737845,
            0.11110546608184163,
        ],
    ),
    (
        "sqrt(u)",
        [
            0.5477225575051661,
            0.18257418583505536,
            -0.12171612389003691,
            0.04057204129667897,
            -0.027048027531119314,
            0.018032018354079544,
            -0.013524013765559657,
            0.010518677373213067,
            -0.008515119778315339,
            0.007068105959778093,
        ],
    ),
    (
        "atan2(u, x)",
        [
            0.5404195002705842,
            0.42016806722689076,
            -0.1329355271520373,
            0.007879572985892331,
            0.012834966958033997,
            -0.008042758004613732,
            0.0013059470146414948,
            0.0008456817732856889,
            -0.0007315586151122327,
            0.00018933929147540364,
        ],
    ),
    (
        "u^(-3/2)",
        [
            6.085806194501846,
            -6.085806194501846,
            8.114408259335795,
            -9.016009177039772,
            10.143010324169742,
            -11.04461124187372,
            11.921167689641475,
            -12.722590727600567,
            13.48227298233262,
            -14.199596071863906,
        ],
    ),
    (
        "u^(7/3)",
        [
            0.06024896550739526,
            0.09372061301150374,
            -0.005206700722861318,
            -0.038568153502676436,
            0.005442394994266564,
            0.003075929279349256,
            -0.001112956638113356,
            0.00043747579869592206,
            -0.00023196040161026725,
            0.000135172645007661,
        ],
    ),
    (
        "u^x",
        [
            0.5477225575051661,
            0.27678033777106514,
            -0.1343765802739195,
            0.03991234644911152,
            -0.01453090453481859,
            0.009414037847200877,
            -0.007151149897550603,
            0.005642203410011408,
            -0.0045593002292987905,
            0.003768136540396685,
        ],
    ),
    (
        "u/x",
        [
            0.6,
            0.5714285714285714,
            -0.036734693877551024,
            -0.010495626822157435,
            -0.00299875052061641,
            -0.00085678586303326,
            -0.0002447959608666457,
            -6.994170310475591e-05,
            -1.9983343744215975e-05,
            -5.709526784061707e-06,
        ],
    ),
    (
        "x^7",
        [
            0.0078125,
            -0.015625,
            0.013392857142857142,
            -0.006377551020408163,
            0.0018221574344023323,
            -0.0003123698458975427,
            2.9749509133099303e-05,
            -1.2142656789020123e-06,
            0.0,
            0.0,
        ],
    ),
    (
        "1/x^3",
        [
            8.0,
            6.857142857142857,
            3.9183673469387754,
            1.8658892128279883,
            0.7996668054977093,
            0.31986672219908374,
            0.12185398940917475,
            0.04476268998704379,
            0.01598667499537278,
            0.005582648411082559,
        ],
    ),
    (
        "u^n",
        [0.00243, 0.0081, 0.00675, -0.0036, -0.0057, 0.00092, 0.0019, -0.0004, -0.00025, 0.0001],
    ),
    (
        "x^s",
        [
            6.498019170849884,
            5.0127576460841965,
            2.649600470073075,
            1.1860116389850908,
            0.4828761673010727,
            0.1848725897666964,
            0.06778661624778869,
            0.02407116576962292,
            0.008338939570190797,
            0.002832592171461636,
        ],
    ),
    (
        "sin(t)*u",
        [
            0.11682550269259515,
            0.3542019666625956,
            0.0868576132234144,
            -0.1771009833312978,
            -0.006363386739138847,
            0.02089882190429405,
            -0.00024973241224317293,
            -0.0009305476492549789,
            2.0433299335724745e-05,
            2.0968117480095923e-05,
        ],
    ),
];

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
    for (source, expected) in SERIES {
        let mut model = names(&["u", "x"], &["n", "s"]);
        // in the table the sine's argument is t + 0.4, which is where the clock starts
        let e = read(&mut model, &source.replace("x^s", "x^(-s)"));
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
