//! Tokens of an expression: numbers, names with primes, operators, each with its span.

use super::syntax::{Span, SyntaxError};
use crate::num::Number;

/// One token.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Token {
    Number(Number),
    /// A name and the number of primes after it.
    Name(String, usize),
    /// One of `+ - * / ^ ( ) ,`.
    Mark(char),
    End,
}

/// Splits an expression into tokens; the last is always [`Token::End`].
pub(super) fn tokens(text: &str) -> Result<Vec<(Token, Span)>, SyntaxError> {
    let bytes = text.as_bytes();
    let mut words = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let start = at;
        let token = match bytes[at] {
            b if b.is_ascii_whitespace() => {
                at += 1;
                continue;
            }
            b'*' if bytes.get(at + 1) == Some(&b'*') => {
                let span = Span { start, end: start + 2 };
                return Err(SyntaxError::new(span, "`**` is not an operator")
                    .with_help("a power is written with `^`"));
            }
            b @ (b'+' | b'-' | b'*' | b'/' | b'^' | b'(' | b')' | b',') => {
                at += 1;
                Token::Mark(char::from(b))
            }
            b if b.is_ascii_digit() || b == b'.' => {
                at = end_of_number(bytes, at);
                let literal = &text[start..at];
                match Number::from_literal(literal) {
                    Some(number) => Token::Number(number),
                    None => return Err(bad_number(literal, Span { start, end: at })),
                }
            }
            b if b.is_ascii_alphabetic() || b == b'_' => {
                while at < bytes.len() && (bytes[at].is_ascii_alphanumeric() || bytes[at] == b'_') {
                    at += 1;
                }
                let name = text[start..at].to_owned();
                let primes = bytes[at..].iter().take_while(|&&b| b == b'\'').count();
                at += primes;
                Token::Name(name, primes)
            }
            _ => return Err(unexpected(text, start)),
        };
        words.push((token, Span { start, end: at }));
    }
    words.push((Token::End, Span { start: at, end: at }));
    Ok(words)
}

fn end_of_number(bytes: &[u8], mut at: usize) -> usize {
    let digits = |mut at: usize| {
        while at < bytes.len() && bytes[at].is_ascii_digit() {
            at += 1;
        }
        at
    };
    at = digits(at);
    if bytes.get(at) == Some(&b'.') {
        at = digits(at + 1);
    }
    if matches!(bytes.get(at), Some(b'e' | b'E')) {
        let signed = at + 1 + usize::from(matches!(bytes.get(at + 1), Some(b'+' | b'-')));
        if bytes.get(signed).is_some_and(u8::is_ascii_digit) {
            at = digits(signed);
        }
    }
    at
}

fn bad_number(literal: &str, span: Span) -> SyntaxError {
    if literal == "." {
        SyntaxError::new(span, "a point alone is not a number")
    } else {
        SyntaxError::new(span, format!("the number `{literal}` is too large"))
    }
}

fn unexpected(text: &str, start: usize) -> SyntaxError {
    let c = text[start..].chars().next().unwrap_or(' ');
    let span = Span { start, end: start + c.len_utf8() };
    let error = SyntaxError::new(span, format!("`{c}` has no meaning in an expression"));
    let help = match c {
        '=' => "an expression is one side only; what must vanish is written as a difference",
        '[' | ']' | '{' | '}' => "group with parentheses ( )",
        '·' | '×' => "a product is written with `*`",
        '²' | '³' => "a power is written with `^`",
        '√' => "a square root is written sqrt(...)",
        '\'' => "a prime follows the name of a coordinate at once: x'",
        '−' => "minus is written with `-`",
        '’' | '′' => "a velocity is written with the ASCII quote: x'",
        'π' => "the circle constant is written `pi`",
        c if c.is_alphabetic() => {
            "names are ASCII here; give the letter to show as `symbol` of a coordinate or parameter"
        }
        _ => return error,
    };
    error.with_help(help)
}
