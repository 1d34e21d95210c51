//! The grammar of expressions: grouping, exact numbers, and the message for each error.

use phaselab::expr::{Expr, Pool, Resolve, Span, Syntax, SyntaxError, parse};
use phaselab::num::Number;

/// A scope in which every name is a variable and every error a failure.
struct AnyName;

impl Resolve for AnyName {
    fn name(&mut self, pool: &mut Pool, name: &str, primes: usize, _: Span) -> Option<Expr> {
        Some(pool.named(&format!("{name}{}", "'".repeat(primes))))
    }

    fn is_variable(&self, _: &str) -> bool {
        true
    }

    fn complain(&mut self, error: SyntaxError) {
        panic!("{error}")
    }
}

/// Parses a text in a pool shared with the expressions it is compared with.
fn lower(pool: &mut Pool, text: &str) -> Expr {
    match parse(text) {
        Ok(syntax) => syntax.lower(pool, &mut AnyName),
        Err(error) => panic!("{text}: {error}"),
    }
}

#[test]
fn operators_group_as_the_format_says() {
    let check = |text: &str, same: &str| {
        let mut pool = Pool::new();
        assert_eq!(lower(&mut pool, text), lower(&mut pool, same), "{text} and {same}");
    };
    let differ = |text: &str, other: &str| {
        let mut pool = Pool::new();
        assert_ne!(lower(&mut pool, text), lower(&mut pool, other), "{text} and {other}");
    };
    check("-x^2", "-(x^2)");
    differ("-x^2", "(-x)^2");
    check("2^-1", "1/2");
    check("2^-x", "2^(-x)");
    check("2^-x^2", "2^(-(x^2))");
    check("2*-x", "-(2*x)");
    check("2/-x", "-(2/x)");
    check("x - -y", "x + y");
    check("--x", "x");
    check("-x*y", "(-x)*y");
    check("a/b/c", "(a/b)/c");
    differ("a/b/c", "a/(b/c)");
    check("a/b*c", "(a/b)*c");
    differ("a/b*c", "a/(b*c)");
    check("a - b - c", "(a - b) - c");
    differ("a - b - c", "a - (b - c)");
    check("x^y^z", "x^(y^z)");
    differ("x^y^z", "(x^y)^z");
    check("2^3^2", "512");
    check("a + b*c^2", "a + (b*(c^2))");
    check("x'^2", "(x')^2");
    check("sin(x)^2", "(sin(x))^2");
    check("-sin(x)^2", "-((sin(x))^2)");
    check("1/2*m*x'^2", "((1/2)*m)*(x'^2)");
    check(" x\t+\n y\r\n", "x+y");
    check("((x))", "x");
    check("atan2( y , x )", "atan2(y,x)");
    differ("atan2(y, x)", "atan2(x, y)");
    differ("x''", "x'");
}

#[test]
fn numbers_are_exact_where_they_fit() {
    let check = |text: &str, expected: Number| {
        let mut pool = Pool::new();
        let e = lower(&mut pool, text);
        assert_eq!(pool.as_number(e), Some(expected), "{text}");
    };
    let ratio = |n: i128, d: i128| Number::ratio(n, d);
    check(".5", ratio(1, 2));
    check("1.", ratio(1, 1));
    check("3", ratio(3, 1));
    check("2.5e-3", ratio(1, 400));
    check("2.5E+3", ratio(2500, 1));
    check("1e3", ratio(1000, 1));
    check("0.1 + 0.2", ratio(3, 10));
    check("1/3 + 1/6", ratio(1, 2));
    check("007", ratio(7, 1));
    check("0.000", ratio(0, 1));
    check("(2/3)^-2", ratio(9, 4));
    check("-7/4", ratio(-7, 4));
    check("1e-20", Number::Real(1e-20));
    check("3.141592653589793238", ratio(3_141_592_653_589_793, 1_000_000_000_000_000));
    check("123456789012345678901234567890", Number::Real(1.234_567_890_123_456_8e29));
}

/// The single error of a text: `start..end message; help`.
fn slip(text: &str) -> String {
    let error = parse(text).expect_err(text);
    assert!(text.get(error.span.start..error.span.end).is_some(), "{text}: {:?}", error.span);
    let reported = format!("{}..{} {error}", error.span.start, error.span.end);
    error.help.map_or(reported.clone(), |help| format!("{reported}; {help}"))
}

#[test]
fn each_slip_has_its_message() {
    let check = |text: &str, expected: &str| assert_eq!(slip(text), expected, "{text}");
    check("", "0..0 an expression is missing here");
    check("  ", "2..2 an expression is missing here");
    check("x +", "3..3 the expression ends too early");
    check("x + * y", "4..5 something is missing before `*`");
    check("/x", "0..1 something is missing before `/`");
    check("()", "1..2 something is missing before `)`");
    check("sin()", "4..5 something is missing before `)`");
    check("+x", "0..1 a plus sign needs something before it");
    check("x + +y", "4..5 a plus sign needs something before it");
    check("(x", "0..1 this parenthesis is never closed");
    check("sin(x", "0..3 this parenthesis is never closed");
    check("x)", "1..2 this parenthesis was never opened");
    check(
        "0,5",
        "1..2 a comma stands only between the arguments of a function; a decimal fraction is \
         written with a point",
    );
    check("x**2", "1..3 `**` is not an operator; a power is written with `^`");
    check(".", "0..1 a point alone is not a number");
    check("1e999", "0..5 the number `1e999` is too large");
    check("[x]", "0..1 `[` has no meaning in an expression; group with parentheses ( )");
    check(
        "x’",
        "1..4 `’` has no meaning in an expression; a velocity is written with a prime: x' or x′",
    );
    check(
        "x '",
        "2..3 `'` has no meaning in an expression; a prime follows the name of a coordinate at \
         once: x'",
    );
    check("x;", "1..2 `;` has no meaning in an expression");
    check("x\u{0}", "1..2 `\u{0}` has no meaning in an expression");
}

/// The span of a syntax tree is its text, at every node.
#[test]
fn spans_cover_what_they_name() {
    let text = "m*g*(x + l)^2 - atan2(y', -x)/2";
    let whole = parse(text).unwrap();
    let mut pieces = Vec::new();
    collect(&whole, text, &mut pieces);
    let expected = [
        text,
        "m*g*(x + l)^2",
        "m",
        "g",
        "(x + l)^2",
        "(x + l)",
        "x",
        "l",
        "2",
        "atan2(y', -x)/2",
        "atan2(y', -x)",
        "y'",
        "-x",
        "x",
        "2",
    ];
    assert_eq!(pieces, expected);
}

fn collect<'t>(syntax: &Syntax, text: &'t str, pieces: &mut Vec<&'t str>) {
    use phaselab::expr::SyntaxKind::{Call, Chain, Name, Negate, Number, Power};
    pieces.push(&text[syntax.span.start..syntax.span.end]);
    match &syntax.kind {
        Number(_) | Name(..) => {}
        Call(_, _, arguments) => {
            for argument in arguments {
                collect(argument, text, pieces);
            }
        }
        Negate(inner) => collect(inner, text, pieces),
        Power(base, exponent) => {
            collect(base, text, pieces);
            collect(exponent, text, pieces);
        }
        Chain(first, rest) => {
            collect(first, text, pieces);
            for (_, part) in rest {
                collect(part, text, pieces);
            }
        }
    }
}

/// Nesting depth uses stack and is limited; length does not.
#[test]
fn long_expressions_need_no_deep_stack() {
    let mut pool = Pool::new();
    let sum = vec!["x"; 500_000].join("+");
    let e = lower(&mut pool, &sum);
    assert_eq!(pool.text(e), "500000*x");
    let product = vec!["x"; 500_000].join("*");
    let e = lower(&mut pool, &product);
    assert_eq!(pool.text(e), "x^500000");
    let difference = vec!["1"; 500_000].join("-");
    let e = lower(&mut pool, &difference);
    assert_eq!(pool.as_number(e), Some(Number::integer(-499_998)));
}

#[test]
fn nesting_is_refused_beyond_256() {
    let nested =
        |n: usize, open: &str, close: &str| format!("{}x{}", open.repeat(n), close.repeat(n));
    for (open, close) in [("(", ")"), ("sin(", ")"), ("-", ""), ("x^", ""), ("2^-", "")] {
        assert!(parse(&nested(120, open, close)).is_ok(), "{open}");
        for n in [1000, 1 << 18] {
            let slip = slip(&nested(n, open, close));
            assert!(slip.ends_with("nested deeper than 256; name parts of it in [definitions]"));
        }
    }
    // as deep as is allowed, on the stack of a thread: also where nothing is optimised
    for (open, close) in
        [("(", ")"), ("sin(", ")"), ("1.5*(", ")"), ("1.5 + y*(", ")"), ("atan2(y, ", ")")]
    {
        lower(&mut Pool::new(), &nested(256, open, close));
        assert!(parse(&nested(257, open, close)).is_err(), "{open}");
    }
}

#[test]
fn a_mebibyte_of_anything_gets_an_answer() {
    let size = 1 << 20;
    assert!(parse(&"9".repeat(size)).is_err(), "a number beyond all range");
    assert!(parse(&format!("0.{}", "3".repeat(size))).is_ok());
    assert!(parse(&"x".repeat(size)).is_ok());
    assert!(parse(&"x ".repeat(size / 2)).is_ok());
    assert!(parse(&"x 2".repeat(size / 3)).is_err());
    assert!(parse(&"x/y z".repeat(size / 5)).is_err());
    assert!(parse(&"|".repeat(size)).is_err());
    assert!(parse(&"√".repeat(size / 3)).is_err());
    assert!(parse(&"sin ".repeat(size / 4)).is_err());
    assert!(parse(&"'".repeat(size)).is_err());
    assert!(parse(&" ".repeat(size)).is_err());
    assert!(parse(&"(".repeat(size)).is_err());
    assert!(parse(&"a(".repeat(size / 2)).is_err());
    assert!(parse(&"x,".repeat(size / 2)).is_err());
    assert!(parse(&"1e".repeat(size / 2)).is_ok(), "1 e1e1e...");
    assert!(parse(&format!("max({}x)", "x,".repeat(size / 2))).is_ok());
}
