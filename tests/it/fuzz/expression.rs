//! Expressions: errors lie in the text; an expression is read back equal after printing, and has a derivative.

use phaselab::expr::{
    Expr, FUNCTIONS, Pool, Resolve, Span, SyntaxError, Zero, parse, without_dots,
};

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
    "θ′²",
    "½",
    " ",
    "√",
    "|",
    "sin² ",
    "cos ",
    "e^",
    "−",
    "·",
];

/// The most nodes of an expression that is worked with: reading it is fast, but it is read hundreds of times.
const LARGEST: usize = 400;

/// A scope in which every name is a variable; it collects errors.
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

/// The symbols of a pool by what the screen shows.
struct Shown(Vec<(String, usize, Expr)>, Vec<SyntaxError>);

impl Resolve for Shown {
    fn name(&mut self, _: &mut Pool, name: &str, primes: usize, _: Span) -> Option<Expr> {
        self.0.iter().find(|(shown, dots, _)| shown == name && *dots == primes).map(|s| s.2)
    }

    fn is_variable(&self, name: &str) -> bool {
        self.0.iter().any(|(shown, ..)| shown == name)
    }

    fn complain(&mut self, error: SyntaxError) {
        self.1.push(error);
    }
}

/// What the screen shows of an expression is that expression when typed, or refused: never another one.
fn check_shown(pool: &mut Pool, e: Expr) {
    let shown = pool.unicode(e);
    let symbols: Vec<(String, usize, Expr)> = pool
        .symbols_of(e)
        .into_iter()
        .map(|symbol| {
            let (name, dots) = without_dots(&pool.symbol_info(symbol).unicode);
            (name, dots, pool.variable(symbol))
        })
        .collect();
    let unique = |s: &(String, usize, Expr)| {
        symbols.iter().filter(|other| (&other.0, other.1) == (&s.0, s.1)).count() == 1
    };
    let word =
        |s: &(String, usize, Expr)| !FUNCTIONS.iter().any(|f| f.name == s.0 || f.unicode == s.0);
    if !symbols.iter().all(|s| unique(s) && word(s)) {
        return;
    }
    let mut names = Shown(symbols, Vec::new());
    let syntax = parse(&shown).unwrap_or_else(|error| panic!("{shown}: {error}"));
    let again = syntax.lower(pool, &mut names);
    assert!(names.1.is_empty(), "{shown}: {:?}", names.1);
    let difference = pool.sub(again, e);
    // a form of textbooks need not be that in which the expression is kept
    let same = again == e
        || pool.unicode(again) == shown
        || matches!(pool.is_zero(difference), Zero::Proved | Zero::Numerically);
    assert!(
        same || is_near(pool, e, again, &shown),
        "{shown} is {}, not {}",
        pool.text(again),
        pool.text(e)
    );
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
    if printed.contains("inf") || printed.contains("NaN") {
        // a scope refuses it
        return;
    }
    let again = parse(&printed).unwrap_or_else(|error| panic!("{text} as {printed}: {error}"));
    let again = again.lower(&mut pool, &mut names);
    assert!(names.0.is_empty(), "{text} as {printed}: {:?}", names.0);
    let exact = again == e || pool.text(again) == printed;
    assert!(exact || is_near(&pool, e, again, &printed), "{text} as {printed}");
    assert!(!pool.latex(e).is_empty());
    check_shown(&mut pool, e);
    let x = pool.symbol("x");
    let slope = pool.derivative(e, x);
    pool.evaluate(slope, &|_| 0.7);
}
