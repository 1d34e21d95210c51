//! Expressions: mistakes lie in the text; an expression is read back equal after printing, and has a derivative.

use phaselab::expr::{Expr, Pool, Resolve, Span, SyntaxError, parse};

pub(crate) const WORDS: &[&str] = &[
    "x",
    "x'",
    "theta''",
    "p_x",
    "t",
    "pi",
    "1/2",
    "^2",
    "^-1",
    "^(1/3)",
    "+",
    "-",
    "*",
    "/",
    "(",
    ")",
    ",",
    "sin(",
    "atan2(x, ",
    "sqrt(",
    "abs(",
    "sign(",
    "max(",
    "exp(",
    "ln(",
    "1e-3",
    ".5",
    "'",
    "=",
    "θ",
];

/// The most nodes of an expression that is worked with: reading it is fast, but it is read hundreds of times.
const LARGEST: usize = 400;

/// A scope in which every name is a variable; it collects mistakes.
#[derive(Default)]
struct AnyName(Vec<SyntaxError>);

impl Resolve for AnyName {
    fn name(&mut self, pool: &mut Pool, name: &str, primes: usize, _: Span) -> Option<Expr> {
        Some(pool.named(&format!("{name}{}", "'".repeat(primes))))
    }

    fn is_variable(&self, _: &str) -> bool {
        false
    }

    fn complain(&mut self, error: SyntaxError) {
        self.0.push(error);
    }
}

fn is_placed(text: &str, error: &SyntaxError) {
    assert!(text.get(error.span.start..error.span.end).is_some(), "{error:?}");
    assert!(!error.to_string().is_empty());
}

/// Whether the values agree if numbers have more digits than can be read exactly.
fn is_near(pool: &Pool, e: Expr, again: Expr, printed: &str) -> bool {
    let long = printed.split(|c: char| !c.is_ascii_digit()).any(|digits| digits.len() > 15);
    let [(a, size), (b, _)] = [e, again].map(|e| pool.evaluate_with_size(e, &|_| 0.7));
    long && (!size.is_finite() || (a - b).abs() <= 1e-12 * size)
}

pub(crate) fn check(bytes: &[u8]) {
    let text = &*String::from_utf8_lossy(bytes);
    let syntax = match parse(text) {
        Ok(syntax) => syntax,
        Err(error) => return is_placed(text, &error),
    };
    let (mut pool, mut names) = (Pool::new(), AnyName::default());
    let e = syntax.lower(&mut pool, &mut names);
    names.0.iter().for_each(|error| is_placed(text, error));
    if !names.0.is_empty() || pool.is_full() || pool.count(e) > LARGEST {
        return;
    }
    let printed = pool.text(e);
    let again = parse(&printed).unwrap_or_else(|error| panic!("{text} as {printed}: {error}"));
    let again = again.lower(&mut pool, &mut names);
    assert!(names.0.is_empty(), "{text} as {printed}: {:?}", names.0);
    let exact = again == e || pool.text(again) == printed;
    assert!(exact || is_near(&pool, e, again, &printed), "{text} as {printed}");
    assert!(!pool.latex(e).is_empty());
    let x = pool.symbol("x");
    let slope = pool.derivative(e, x);
    pool.evaluate(slope, &|_| 0.7);
}
