//! The syntax tree that the parser returns, with a span at every node and names not yet resolved.
//! [`Syntax::lower`] converts it to a canonical expression with the help of a [`Resolve`].

use super::function::FUNCTIONS;
use super::node::{Expr, FunctionId};
use super::other_functions;
use super::pool::Pool;
use crate::diagnostic::nearest;
use crate::num::Number;

/// A range of bytes in the source text of one expression.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Span {
    /// The first byte.
    pub start: usize,
    /// One past the last byte.
    pub end: usize,
}

/// An error in one expression, with its place and a correction.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[error("{message}")]
pub struct SyntaxError {
    /// The place in the expression.
    pub span: Span,
    /// What is wrong.
    pub message: String,
    /// A correction, if one is known.
    pub help: Option<String>,
}

impl SyntaxError {
    /// Creates an error without a correction.
    pub fn new(span: Span, message: impl Into<String>) -> SyntaxError {
        SyntaxError { span, message: message.into(), help: None }
    }

    /// Adds a correction.
    #[must_use]
    pub fn with_help(mut self, help: impl Into<String>) -> SyntaxError {
        self.help = Some(help.into());
        self
    }
}

/// One node of the syntax tree.
#[derive(Clone, PartialEq, Debug)]
pub struct Syntax {
    /// Its place in the source text.
    pub span: Span,
    /// Its content.
    pub kind: SyntaxKind,
}

/// The operators that join the parts of sums and products.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[expect(missing_docs, reason = "the four operations of arithmetic")]
pub enum BinaryOperator {
    Add,
    Subtract,
    Multiply,
    Divide,
    /// A name directly before a parenthesis, `l(1 + x)`: a product where the name is a constant.
    Apply,
}

/// The content of a node. Long sums and products are flat lists, so the depth of a tree is that of
/// its parentheses.
#[derive(Clone, PartialEq, Debug)]
pub enum SyntaxKind {
    /// A numeric literal.
    Number(Number),
    /// A name with the number of its primes: `x''` is `("x", 2)`.
    Name(String, usize),
    /// A function's name, its span, and its arguments.
    Call(String, Span, Vec<Syntax>),
    /// The first operand, then each operator with its right operand, grouped to the left.
    Chain(Box<Syntax>, Vec<(BinaryOperator, Syntax)>),
    /// `−x`.
    Negate(Box<Syntax>),
    /// `base ^ exponent`.
    Power(Box<Syntax>, Box<Syntax>),
}

/// Resolves the names in an expression.
pub trait Resolve {
    /// The expression for a name with this many primes, or `None` after reporting an error.
    fn name(&mut self, pool: &mut Pool, name: &str, primes: usize, span: Span) -> Option<Expr>;
    /// Returns whether a name is known as something other than a function.
    fn is_variable(&self, name: &str) -> bool;
    /// Returns whether a name is that of a constant, which depends on nothing: `l(1 + x)` is then a product.
    fn is_constant(&self, _name: &str) -> bool {
        false
    }
    /// Records an error.
    fn complain(&mut self, error: SyntaxError);
}

impl Syntax {
    /// Converts the tree to a canonical expression. All errors go to the resolver. If there is
    /// one, the result is not usable; in it, unknown names become symbols, so that they cause no
    /// further errors.
    pub fn lower(&self, pool: &mut Pool, names: &mut dyn Resolve) -> Expr {
        match &self.kind {
            SyntaxKind::Number(n) => pool.number(*n),
            SyntaxKind::Name(name, 0) if name == "pi" || name == "π" => pool.pi(),
            SyntaxKind::Name(name, primes) => {
                if *primes == 0 && !names.is_variable(name) && FunctionId::by_name(name).is_some() {
                    names.complain(
                        SyntaxError::new(
                            self.span,
                            format!("`{name}` is a function and needs arguments"),
                        )
                        .with_help(format!("write {name}(...)")),
                    );
                    return pool.named(name);
                }
                match names.name(pool, name, *primes, self.span) {
                    Some(e) => e,
                    None => pool.named(&format!("{name}{}", "'".repeat(*primes))),
                }
            }
            SyntaxKind::Negate(inner) => {
                let inner = inner.lower(pool, names);
                pool.neg(inner)
            }
            SyntaxKind::Power(base, exponent) if is_euler(base, names) => {
                let exponent = exponent.lower(pool, names);
                pool.call(FunctionId::Exp, &[exponent])
            }
            SyntaxKind::Power(base, exponent) => {
                let base = base.lower(pool, names);
                let exponent = exponent.lower(pool, names);
                pool.pow(base, exponent)
            }
            SyntaxKind::Chain(first, rest) => lower_chain(first, rest, pool, names),
            SyntaxKind::Call(name, span, arguments) => {
                let lowered: Vec<Expr> = arguments.iter().map(|a| a.lower(pool, names)).collect();
                match check_call(name, *span, self.span, arguments.len(), names) {
                    Some(function) if takes_many(function) => among(pool, function, &lowered),
                    Some(function) => pool.call(function, &lowered),
                    None => pool.named(name),
                }
            }
        }
    }
}

fn lower_chain(
    first: &Syntax,
    rest: &[(BinaryOperator, Syntax)],
    pool: &mut Pool,
    names: &mut dyn Resolve,
) -> Expr {
    let reported = reported_applications(first, rest, names);
    if !reported.is_empty() {
        // The other names may be unknown, too.
        let parts = std::iter::once(first).chain(rest.iter().map(|(_, part)| part));
        for part in parts.filter(|part| !reported.contains(&part.span)) {
            part.lower(pool, names);
        }
        return Expr::ONE;
    }
    let head = first.lower(pool, names);
    let additive = matches!(rest[0].0, BinaryOperator::Add | BinaryOperator::Subtract);
    let mut parts = vec![(head, Number::ONE)];
    for (operator, part) in rest {
        let inverse = matches!(operator, BinaryOperator::Subtract | BinaryOperator::Divide);
        let lowered = part.lower(pool, names);
        if *operator == BinaryOperator::Divide && lowered == Expr::ZERO {
            names.complain(SyntaxError::new(part.span, "division by zero"));
        }
        parts.push((lowered, if inverse { Number::MINUS_ONE } else { Number::ONE }));
    }
    if additive {
        let terms: Vec<(Number, Expr)> = parts.into_iter().map(|(e, c)| (c, e)).collect();
        pool.linear(Number::ZERO, &terms)
    } else {
        pool.monomial(Number::ONE, &parts)
    }
}

/// Returns whether a base is Euler's number: the name `e`, where the file has none of its own.
fn is_euler(base: &Syntax, names: &dyn Resolve) -> bool {
    matches!(&base.kind, SyntaxKind::Name(name, 0) if name == "e") && !names.is_variable("e")
}

/// Reports the names directly before a parenthesis that are not read as products, and returns their spans.
fn reported_applications(
    first: &Syntax,
    rest: &[(BinaryOperator, Syntax)],
    names: &mut dyn Resolve,
) -> Vec<Span> {
    let mut left = first;
    let mut reported = Vec::new();
    for (operator, part) in rest {
        if *operator == BinaryOperator::Apply
            && let Some(error) = not_a_product(left, part, names)
        {
            names.complain(error);
            reported.push(left.span);
        }
        left = part;
    }
    reported
}

/// Why a name directly before a parenthesis is not read as a product, or `None` if it is one.
fn not_a_product(left: &Syntax, right: &Syntax, names: &dyn Resolve) -> Option<SyntaxError> {
    let SyntaxKind::Name(name, primes) = &left.kind else { return None };
    let inside = match &right.kind {
        SyntaxKind::Power(base, _) => &base.kind,
        kind => kind,
    };
    if *primes == 0 && names.is_constant(name) && !matches!(inside, SyntaxKind::Name(..)) {
        return None;
    }
    if *primes == 0 && !names.is_variable(name) {
        return Some(no_function(name, left.span));
    }
    let shown = format!("{name}{}", "'".repeat(*primes));
    let span = Span { start: left.span.start, end: right.span.end };
    let message = format!("`{shown}(...)` can be read as a product and as a function");
    Some(SyntaxError::new(span, message).with_help(format!(
        "write `{shown}*(...)` for the product; `{shown}` is not a function: what it depends on is not written, `{shown}` alone stands for its value"
    )))
}

fn no_function(name: &str, span: Span) -> SyntaxError {
    let error = SyntaxError::new(span, format!("unknown function `{name}`"));
    if let Some(help) = other_functions::written_here(name) {
        return error.with_help(help);
    }
    match nearest(name, FUNCTIONS.iter().map(|row| row.name)) {
        Some(near) => error.with_help(format!("did you mean `{near}`?")),
        None => {
            let all: Vec<&str> = FUNCTIONS.iter().map(|row| row.name).collect();
            error.with_help(format!("the functions are {}", all.join(" ")))
        }
    }
}

/// Returns whether a function of two arguments accepts more in the source text.
fn takes_many(function: FunctionId) -> bool {
    matches!(function, FunctionId::Max | FunctionId::Min)
}

/// The maximum or minimum of many arguments, by halves, so that the nesting is as shallow as
/// possible.
fn among(pool: &mut Pool, function: FunctionId, arguments: &[Expr]) -> Expr {
    match arguments {
        [one] => *one,
        many => {
            let (first, second) = many.split_at(many.len() / 2);
            let halves = [among(pool, function, first), among(pool, function, second)];
            pool.call(function, &halves)
        }
    }
}

/// The function of a call, if its name and its number of arguments are correct.
fn check_call(
    name: &str,
    name_span: Span,
    span: Span,
    count: usize,
    names: &mut dyn Resolve,
) -> Option<FunctionId> {
    let Some(function) = FunctionId::by_name(name) else {
        let error = if names.is_variable(name) {
            SyntaxError::new(name_span, format!("`{name}` is not a function"))
                .with_help(format!("a product is written with `*`: {name}*(...)"))
        } else {
            no_function(name, name_span)
        };
        names.complain(error);
        return None;
    };
    let arity = function.row().arity;
    let enough = if takes_many(function) { count >= arity } else { count == arity };
    if !enough {
        let arguments = match arity {
            1 => "one argument",
            _ if takes_many(function) => "two arguments or more",
            _ => "two arguments",
        };
        names.complain(SyntaxError::new(span, format!("`{name}` takes {arguments}, not {count}")));
        return None;
    }
    Some(function)
}
