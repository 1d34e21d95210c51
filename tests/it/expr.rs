//! The algebra: identities of every expression, and the expected canonical forms.

use phaselab::expr::{Expr, FUNCTIONS, FunctionId, Pool, Zero};
use phaselab::num::Number;
use proptest::prelude::*;

use crate::build::{names, read, sample, try_read};

mod division;
mod pool;

fn text(source: &str, f: impl Fn(&mut Pool, Expr) -> Expr) -> String {
    let mut model = names(&["q", "u", "theta", "phi"], &["m", "g", "l", "k", "a", "b"]);
    let e = read(&mut model, source);
    let e = f(&mut model.pool, e);
    model.pool.text(e)
}

#[test]
fn canonical_forms() {
    let check = |source: &str, form: &str| assert_eq!(text(source, |_, e| e), form, "{source}");
    check("q + q", "2*q");
    check("2*(q + u) - 2*u", "2*q");
    check("q*q*q/q", "q^2");
    check("(q + u)/(u + q)", "1");
    check("(2*q + 4*u)^2/(q + 2*u)", "4*q + 8*u");
    check("(a - b)^2 - (b - a)^2", "0");
    check("-q^2", "-q^2");
    check("2^-1*q", "1/2*q");
    check("2*-q", "-2*q");
    check("q/a/b", "q/(a*b)");
    check("q^u^2", "q^(u^2)");
    check("sqrt(q^2)", "sqrt(q^2)");
    check("sqrt(q)^2", "q");
    check("sqrt(4*q)", "2*sqrt(q)");
    check("1/sqrt(2)", "1/2*sqrt(2)");
    check("abs(q)^2", "q^2");
    check("abs(-q)", "abs(q)");
    check("sin(-q) + sin(q)", "0");
    check("cos(u - q) - cos(q - u)", "0");
    check("sin(pi/6)", "1/2");
    check("cos(pi)", "-1");
    check("exp(q)*exp(-q)", "1");
    check("ln(exp(q))", "q");
    check("0.1 + 0.2", "3/10");
    check("1e-3", "1/1000");
    check("1.00000000000000000001e30", "1e30");
    check("min(2, 3) + max(q, q)", "q + 2");
    // roots of squares, and of what has positive factors
    check("sqrt(1 - 2*q + q^2) - sqrt((q - 1)^2)", "0");
    check("sqrt(q^2 + 2*q*u + u^2) - sqrt((q + u)^2)", "0");
    check("sqrt(2*q^2 - 4*q + 2) - sqrt(2)*sqrt((q - 1)^2)", "0");
    check("(1/4 + q + q^2)^(1/3) - ((q + 1/2)^2)^(1/3)", "0");
    check("sqrt(1 + q^2 + u^2 - 2*q + 2*u - 2*q*u) - sqrt((q - u - 1)^2)", "0");
    check("sqrt(1 - 2*q^2 + q^4) - sqrt((q^2 - 1)^2)", "0");
    check("sqrt(q^2*u^2 - 2*q*u + 1) - sqrt((q*u - 1)^2)", "0");
    check("sqrt(1 - 2*q^2 + q^3)", "sqrt(q^3 - 2*q^2 + 1)");
    check("sqrt(1 - 2*q + 2*q^2)", "sqrt(2*q^2 - 2*q + 1)");
    check("sqrt(q^2 + 3*q + 1)", "sqrt(3*q + q^2 + 1)");
    check("sqrt(1 - tanh(q)^2)", "1/cosh(q)");
    check("1/sqrt(3 - 3*tanh(q)^2) - cosh(q)/sqrt(3)", "0");
    check("sqrt(1 - (1 - exp(q))^2) - exp(q/2)*sqrt(2 - exp(q))", "0");
    check("sqrt(u*cosh(q)^2) - cosh(q)*sqrt(u)", "0");
    check("sqrt(1 - tanh(q)^6)*cosh(q) - sqrt(1 + tanh(q)^2 + tanh(q)^4)", "0");
    check("sqrt(1 - (1 + exp(q))^-2) - exp(q/2)*sqrt(2 + exp(q))/(1 + exp(q))", "0");
    check("sqrt(1 - (1 - exp(q))^-2) - sqrt(1 - (exp(q) - 1)^-2)", "0");
    // powers that are written as exponentials
    check("exp(ln(q^2)/2)", "sqrt(q^2)");
    check("exp(0.3*ln(q^2 + u^2) - q) - (q^2 + u^2)^0.3*exp(-q)", "0");
    check("exp(ln(q)/2)", "sqrt(q)");
    check("exp(ln(q))", "exp(ln(q))");
    check("exp(-ln(q^2))", "exp(-ln(q^2))");
}

#[test]
fn values_along_a_symbol_are_those_at_each_place() {
    for source in ["a*q^2 + sin(u)*cos(q/2)", "a*u", "q", "(q^u - b)/(1 + abs(q))", "sqrt(q)"] {
        let mut model = names(&["q", "u"], &["a", "b"]);
        let e = read(&mut model, source);
        let [q, u, a] = ["q", "u", "a"].map(|name| model.pool.find_symbol(name).expect("declared"));
        let others = |symbol| match symbol {
            s if s == u => 0.7,
            s if s == a => -1.3,
            _ => 2.5,
        };
        let places = [-1.5, 0.0, 0.3, 4.0];
        let along = model.pool.evaluate_along(e, (q, &places), &others);
        for (place, value) in places.into_iter().zip(along) {
            let there = |symbol| if symbol == q { place } else { others(symbol) };
            let alone = model.pool.evaluate(e, &there);
            assert_eq!(value.to_bits(), alone.to_bits(), "{source} at {place}");
        }
    }
}

#[test]
fn the_size_of_terms_sees_what_cancels() {
    let check = |source: &str, size: &str| {
        assert_eq!(text(source, Pool::magnitude), size, "{source}");
    };
    check("q - u", "abs(q) + abs(u)");
    check("2*q^2 - 3", "2*q^2 + 3");
    check("a*(q - u)", "(abs(q) + abs(u))*abs(a)");
    check("(q - u)/(a - b)", "(abs(q) + abs(u))/abs(a - b)");
    check("sin(q) - u", "abs(sin(q)) + abs(u)");
    check("sin(q - u)", "abs(sin(q - u)) + (abs(q) + abs(u))*abs(cos(q - u))");
}

#[test]
fn derivatives() {
    let check = |source: &str, slope: &str| {
        let derived = text(source, |pool, e| {
            let q = pool.find_symbol("q").expect("known");
            pool.derivative(e, q)
        });
        assert_eq!(derived, slope, "{source}");
    };
    check("sin(q)", "cos(q)");
    check("q^3", "3*q^2");
    check("sqrt(q)", "1/2/sqrt(q)");
    check("exp(2*q)", "2*exp(2*q)");
    check("ln(q)", "1/q");
    check("abs(q)", "sign(q)");
    check("u^q", "u^q*ln(u)");
    check("max(q, u)", "1/2*sign(q - u) + 1/2");
    check("m*g", "0");
}

#[test]
fn simplification() {
    let check = |source: &str, simple: &str| {
        assert_eq!(text(source, Pool::simplify), simple, "{source}");
    };
    check("sin(q)^2 + cos(q)^2", "1");
    check("m*l^2*sin(q)^2 + m*l^2*cos(q)^2", "m*l^2");
    check("1 - sin(q)^2", "cos(q)^2");
    check("cosh(q)^2 - sinh(q)^2", "1");
    check("a*q^2 + a*q*u", "a*q*(q + u)");
    check("(q + u)^2 - q^2 - u^2", "2*q*u");
    check("cos(q)*cos(u) + sin(q)*sin(u) - cos(q - u)", "0");
    check("a*sin(q)*cos(u) + a*cos(q)*sin(u)", "a*sin(q + u)");
    check("sin(q)*cos(u) - cos(q)*sin(u)", "sin(q - u)");
    check("cos(q)*cos(u) + 2*sin(q)*sin(u)", "cos(q)*cos(u) + 2*sin(q)*sin(u)");
    check("(l*cos(q))^2 + (l*sin(q))^2 + k", "k + l^2");
    check("sqrt(q^2)", "sqrt(q^2)");
    // a root of any order is located as well as a simple one
    check("sign(q^3)", "sign(q)");
    check("sign(-2*q^4)", "-sign(q)^2");
    check("sign(max(0, q)^2)", "sign(max(0, q))^2");
}

#[test]
fn zeros_are_proved_and_others_are_not() {
    let zero = |source: &str| {
        let mut model = names(&["q", "u"], &["a", "b"]);
        let e = read(&mut model, source);
        model.pool.is_zero(e)
    };
    for identity in [
        "sin(2*q) - 2*sin(q)*cos(q)",
        "cos(q + u) - cos(q)*cos(u) + sin(q)*sin(u)",
        "tan(q)^2*cos(q)^2 + cos(q)^2 - 1",
        "(q^2 + u^2)*(q^2 + u^2)^(-3/2) - 1/sqrt(q^2 + u^2)",
        "1/(q - u) - 1/(q + u) - 2*u/(q^2 - u^2)",
        "cot(q)*tan(q) - 1",
        "(a*q + b)^4 - (a*q + b)^3*(b + q*a)",
        "sin(q)^4 - cos(q)^4 + cos(2*q)",
    ] {
        assert_eq!(zero(identity), Zero::Proved, "{identity}");
    }
    for other in ["sin(q)^2 - cos(q)^2", "q - u", "sqrt(q^2) - q", "1e-6*q", "q/a - q/b"] {
        assert_eq!(zero(other), Zero::No, "{other}");
    }
}

#[test]
fn mathematics_for_screens_and_latex() {
    let both = |source: &str| {
        let mut model = names(&["theta", "x1"], &["m", "g", "l", "omega0"]);
        let e = read(&mut model, source);
        (model.pool.unicode(e), model.pool.latex(e))
    };
    assert_eq!(both("1/2*m*l^2*theta'^2 + m*g*l*cos(theta)").0, "½ m l² θ′² + m g l cos θ");
    assert_eq!(both("x1'^2*omega0/9").0, "x1".replace("x1", "ω₀ x₁′²/9"));
    assert_eq!(both("sin(2*theta)^2").0, "sin²(2 θ)");
    assert_eq!(both("sqrt(m/l) - 9.81*g").0, "√(m/l) − 9.81 g");
    assert_eq!(both("exp(-theta^2)").0, "e^(−θ²)");
    assert_eq!(both("abs(theta)*m").0, "m |θ|");
    assert_eq!(both("1/2*m*l^2*theta'^2/g").1, "\\frac{m {l}^{2} {\\dot{\\theta}}^{2}}{2 g}");
}

#[test]
fn the_table_of_functions_is_in_order_and_has_no_twins() {
    for (i, row) in FUNCTIONS.iter().enumerate() {
        assert_eq!(row.id as usize, i, "{}", row.name);
        assert_eq!(FunctionId::by_name(row.name), Some(row.id));
    }
}

/// Compares every derivative in the table with a central difference.
#[test]
fn derivatives_of_the_table_agree_with_differences() {
    for row in &FUNCTIONS {
        let mut pool = Pool::new();
        let symbols = [pool.symbol("x"), pool.symbol("y")];
        let arguments: Vec<Expr> = symbols[..row.arity].iter().map(|&s| pool.variable(s)).collect();
        let call = pool.call(row.id, &arguments);
        for i in 0..row.arity {
            let slope = pool.derivative(call, symbols[i]);
            for at in [[0.3, 0.7], [0.71, 0.2], [0.5, 0.9]] {
                let value = pool.evaluate(slope, &|s| at[s.index()]);
                let shifted = |h: f64| {
                    let mut at = at;
                    at[i] += h;
                    (row.value)(&at[..row.arity])
                };
                let difference = (8.0 * (shifted(1e-3) - shifted(-1e-3))
                    - (shifted(2e-3) - shifted(-2e-3)))
                    / 12e-3;
                let error = (value - difference).abs();
                assert!(error < 1e-8, "{} by argument {i} at {at:?}: {value}", row.name);
            }
        }
    }
}

/// The source text of random expressions in q, u, a, b.
pub(crate) fn sources() -> impl Strategy<Value = String> {
    let leaf = prop_oneof![
        Just("q".to_owned()),
        Just("u".to_owned()),
        Just("a".to_owned()),
        Just("b".to_owned()),
        (0..50_i32).prop_map(|n| n.to_string()),
        (1..400_i32).prop_map(|n| format!("{}", f64::from(n) / 64.0)),
        Just("pi".to_owned()),
    ];
    leaf.prop_recursive(5, 48, 3, |inner| {
        prop_oneof![
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("({a} + {b})")),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("({a} - {b})")),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("({a})*({b})")),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("({a})/({b} + 3)")),
            (inner.clone(), -2..4_i32).prop_map(|(a, n)| format!("({a})^({n})")),
            inner.clone().prop_map(|a| format!("sin({a})")),
            inner.clone().prop_map(|a| format!("cos({a})")),
            inner.clone().prop_map(|a| format!("exp(sin({a}))")),
            inner.clone().prop_map(|a| format!("sqrt(1 + ({a})^2)")),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("max({a}, {b})")),
            inner.prop_map(|a| format!("-({a})")),
        ]
    })
}

/// Whether two values agree to rounding, or are both beyond comparison.
pub(crate) fn close(a: f64, b: f64, size: f64) -> bool {
    !a.is_finite() || !b.is_finite() || !size.is_finite() || (a - b).abs() <= 1e-9 * (1.0 + size)
}

proptest! {
    #![proptest_config(crate::cases(300))]

    #[test]
    fn printing_parses_back_to_the_same_tree(source in sources()) {
        let mut model = names(&["q", "u"], &["a", "b"]);
        let e = try_read(&mut model, &source);
        prop_assume!(e.is_ok());
        let e = e.expect("assumed");
        let printed = model.pool.text(e);
        let again = read(&mut model, &printed);
        prop_assert_eq!(e, again, "{} printed as {}", source, printed);
    }

    #[test]
    fn simplifying_and_reading_keep_the_value(source in sources(), seed in 0..1000_u64) {
        let mut model = names(&["q", "u"], &["a", "b"]);
        let e = try_read(&mut model, &source);
        prop_assume!(e.is_ok());
        let e = e.expect("assumed");
        let simple = model.pool.simplify(e);
        let at = sample(seed);
        let (a, size) = model.pool.evaluate_with_size(e, &at);
        let b = model.pool.evaluate(simple, &at);
        prop_assert!(close(a, b, size), "{} = {} but {} = {}", source, a, model.pool.text(simple), b);
    }

    #[test]
    fn differentiation_is_linear_and_keeps_leibniz(x in sources(), y in sources(), seed in 0..1000_u64) {
        let mut model = names(&["q", "u"], &["a", "b"]);
        let (x, y) = (try_read(&mut model, &x), try_read(&mut model, &y));
        prop_assume!(x.is_ok() && y.is_ok());
        let (x, y) = (x.expect("assumed"), y.expect("assumed"));
        let q = model.coordinates[0].position;
        let pool = &mut model.pool;
        let (dx, dy) = (pool.derivative(x, q), pool.derivative(y, q));
        let combined = pool.linear(Number::ONE, &[(Number::integer(3), x), (Number::HALF, y)]);
        let left = pool.derivative(combined, q);
        let right = pool.linear(Number::ZERO, &[(Number::integer(3), dx), (Number::HALF, dy)]);
        prop_assert_eq!(left, right);
        let product = pool.mul(x, y);
        let left = pool.derivative(product, q);
        let (a, b) = (pool.mul(dx, y), pool.mul(x, dy));
        let right = pool.add(a, b);
        let at = sample(seed);
        let (l, size) = pool.evaluate_with_size(left, &at);
        let (r, other) = pool.evaluate_with_size(right, &at);
        prop_assert!(close(l, r, size + other), "{} and {}", l, r);
    }
}
