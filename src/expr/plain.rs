//! A syntax tree in the plain form of files: ASCII, every product with its `*`, every function with its parentheses.
//!
//! In: a tree and its source text, for the digits of numbers as they were typed. Out: a text that parses to the same
//! tree. Never here: the meaning of names; whoever asks gives their plain form.

use super::notation::raised_digit;
use super::print::BindingStrength;
use super::syntax::{BinaryOperator, Syntax, SyntaxKind};
use crate::num::Number;

/// The plain form of a name with its primes.
type NameWriter<'n> = &'n dyn Fn(&str, usize) -> String;

impl Syntax {
    /// The tree in plain form.
    pub fn plain(&self, source: &str, names: NameWriter<'_>) -> String {
        self.written(source, names).0
    }

    /// Returns whether the source text is in plain form already: every factor after the first stands behind a `*` or
    /// `/`, every argument in parentheses. `has_e`: the name `e` is one of the file's own, not Euler's number.
    pub fn is_plain(&self, source: &str, has_e: &dyn Fn() -> bool) -> bool {
        source.is_ascii() && self.is_plain_inside(source, has_e)
    }

    fn is_plain_inside(&self, source: &str, has_e: &dyn Fn() -> bool) -> bool {
        let between = |left: &Syntax, right: &Syntax| {
            source[left.span.end..right.span.start].trim_matches(|c: char| c != '*' && c != '/')
        };
        match &self.kind {
            SyntaxKind::Number(_) | SyntaxKind::Name(..) => true,
            SyntaxKind::Call(_, name, arguments) => {
                source[name.end..].trim_start().starts_with('(')
                    && source[self.span.start..self.span.end].ends_with(')')
                    && arguments.iter().all(|a| a.is_plain_inside(source, has_e))
            }
            SyntaxKind::Negate(inner) => inner.is_plain_inside(source, has_e),
            SyntaxKind::Power(base, exponent) => {
                let euler = matches!(&base.kind, SyntaxKind::Name(name, 0) if name == "e");
                // the power of sin^2(x) stands inside
                let inside = exponent.span.start < base.span.end;
                (!euler || has_e())
                    && !inside
                    && base.is_plain_inside(source, has_e)
                    && exponent.is_plain_inside(source, has_e)
            }
            SyntaxKind::Chain(first, rest) => {
                let mut left: &Syntax = first;
                first.is_plain_inside(source, has_e)
                    && rest.iter().all(|(operator, part)| {
                        let sum =
                            matches!(operator, BinaryOperator::Add | BinaryOperator::Subtract);
                        let written = sum || !between(left, part).is_empty();
                        left = part;
                        written && part.is_plain_inside(source, has_e)
                    })
            }
        }
    }

    fn written(&self, source: &str, names: NameWriter<'_>) -> (String, BindingStrength) {
        let at_least = |part: &Syntax, level: BindingStrength| {
            let (text, own) = part.written(source, names);
            if own < level { format!("({text})") } else { text }
        };
        match &self.kind {
            SyntaxKind::Number(n) => number(*n, source.get(self.span.start..self.span.end)),
            SyntaxKind::Name(name, 0) if name == "π" => ("pi".to_owned(), BindingStrength::Atom),
            SyntaxKind::Name(name, primes) => (names(name, *primes), BindingStrength::Atom),
            SyntaxKind::Call(name, _, arguments) => {
                let all: Vec<String> = arguments.iter().map(|a| a.plain(source, names)).collect();
                (format!("{name}({})", all.join(", ")), BindingStrength::Atom)
            }
            SyntaxKind::Negate(inner) => {
                (format!("-{}", at_least(inner, BindingStrength::Power)), BindingStrength::Product)
            }
            SyntaxKind::Power(base, exponent) => match &base.kind {
                SyntaxKind::Name(name, 0) if name == "e" && names("e", 0) == EULER => {
                    (format!("exp({})", exponent.plain(source, names)), BindingStrength::Atom)
                }
                _ => {
                    let base = at_least(base, BindingStrength::Atom);
                    (
                        format!("{base}^{}", at_least(exponent, BindingStrength::Atom)),
                        BindingStrength::Power,
                    )
                }
            },
            SyntaxKind::Chain(first, rest) => {
                let sum = matches!(rest[0].0, BinaryOperator::Add | BinaryOperator::Subtract);
                let level = if sum { BindingStrength::Sum } else { BindingStrength::Product };
                // only the first part of a product may be a quotient: 1/2*m is (1/2)*m
                let mut text = at_least(first, level);
                for (operator, part) in rest {
                    text.push_str(match operator {
                        BinaryOperator::Add => " + ",
                        BinaryOperator::Subtract => " - ",
                        BinaryOperator::Multiply | BinaryOperator::Apply => "*",
                        BinaryOperator::Divide => "/",
                    });
                    let above = if sum { BindingStrength::Product } else { BindingStrength::Power };
                    text.push_str(&at_least(part, above));
                }
                (text, level)
            }
        }
    }
}

/// What the names give for `e` where it is Euler's number.
pub const EULER: &str = "exp(1)";

fn number(n: Number, typed: Option<&str>) -> (String, BindingStrength) {
    let ten = typed.and_then(|t| t.split_once("·10").or_else(|| t.split_once("×10")));
    if let Some((mantissa, exponent)) = ten {
        let exponent: String = exponent.chars().filter_map(raised_digit).collect();
        return (format!("{mantissa}e{exponent}"), BindingStrength::Atom);
    }
    let typed = typed.filter(|t| t.is_ascii() && !t.starts_with('^'));
    match (typed, n) {
        (Some(typed), _) => (typed.to_owned(), BindingStrength::Atom),
        (None, Number::Rational(n, 1)) if n < 0 => (n.to_string(), BindingStrength::Sum),
        (None, Number::Rational(n, 1)) => (n.to_string(), BindingStrength::Atom),
        (None, Number::Rational(n, d)) => (format!("{n}/{d}"), BindingStrength::Product),
        (None, Number::Real(x)) => (format!("{x:?}"), BindingStrength::Atom),
    }
}
