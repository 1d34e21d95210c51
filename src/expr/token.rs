//! Tokens of an expression: numbers, names with primes, operators, each with its span. The notation of the screen
//! (`½ l² θ′²`, `√x`, `a · b − c`) has the same tokens as the plain one.

use super::notation::{
    RAISED_N, dotted_letter, on_the_line, plain_digit, raised_digit, vulgar_fraction,
};
use super::syntax::{Span, SyntaxError};
use crate::num::Number;

#[derive(Clone, PartialEq, Debug)]
pub(super) enum Token {
    Number(Number),
    /// A name and the number of primes after it.
    Name(String, usize),
    /// Digits above the line: a power.
    Raised(i64),
    /// One of `+ - * / ^ ( ) , | √`.
    Mark(char),
    End,
}

/// Splits an expression into tokens; the last is always [`Token::End`].
pub(super) fn tokens(text: &str) -> Result<Vec<(Token, Span)>, SyntaxError> {
    let bytes = text.as_bytes();
    let mut words = Vec::new();
    let mut at = 0;
    while let Some(c) = text[at..].chars().next() {
        let start = at;
        let token = match c {
            c if c.is_ascii_whitespace() || c == '\u{a0}' => {
                at += c.len_utf8();
                continue;
            }
            '*' if bytes.get(at + 1) == Some(&b'*') => {
                let span = Span { start, end: start + 2 };
                return Err(SyntaxError::new(span, "`**` is not an operator")
                    .with_help("a power is written with `^`"));
            }
            '+' | '-' | '*' | '/' | '^' | '(' | ')' | ',' | '|' | '√' | '·' | '⋅' | '×' | '−' =>
            {
                at += c.len_utf8();
                Token::Mark(match c {
                    '·' | '⋅' | '×' => '*',
                    '−' => '-',
                    other => other,
                })
            }
            c if c.is_ascii_digit() || c == '.' => {
                at = end_of_number(bytes, at);
                let (literal, end) = with_power_of_ten(text, start, at);
                at = end;
                match Number::from_literal(&literal) {
                    Some(number) => Token::Number(number),
                    None => return Err(bad_number(&literal, Span { start, end: at })),
                }
            }
            c if vulgar_fraction(c).is_some() => {
                at += c.len_utf8();
                let (above, below) = vulgar_fraction(c).unwrap_or((0, 1));
                Token::Number(Number::ratio(above.into(), below.into()))
            }
            c if raised_digit(c).is_some() => {
                let (digits, end) = raised(text, at);
                at = end;
                match digits.parse() {
                    Ok(n) => Token::Raised(n),
                    Err(_) => {
                        let message = format!("`{}` is not a power", &text[start..at]);
                        return Err(SyntaxError::new(Span { start, end: at }, message));
                    }
                }
            }
            RAISED_N => {
                at += c.len_utf8();
                words.push((Token::Mark('^'), Span { start, end: at }));
                Token::Name("n".to_owned(), 0)
            }
            c if begins_name(c) => {
                let (name, primes, end) = name(text, at);
                at = end;
                Token::Name(name, primes)
            }
            _ => return Err(unexpected(text, start)),
        };
        words.push((token, Span { start, end: at }));
    }
    words.push((Token::End, Span { start: at, end: at }));
    Ok(words)
}

fn begins_name(c: char) -> bool {
    c == '_' || (c.is_alphabetic() && raised_digit(c).is_none() && c != RAISED_N)
}

/// The name at a place without its dots and primes, their number, and where it ends. A subscript may stand behind a
/// prime, as in `φ′₀`.
fn name(text: &str, start: usize) -> (String, usize, usize) {
    let mut name = String::new();
    let (mut primes, mut at) = (0, start);
    for c in text[start..].chars() {
        let subscript = plain_digit(c).is_some();
        match c {
            '\'' | '′' | '\u{307}' => primes += 1,
            '″' | '\u{308}' => primes += 2,
            _ if primes > 0 && !subscript && !after_dot(&text[start..at]) => break,
            c if begins_name(c) || c.is_ascii_digit() || subscript => {
                let (letter, dots) = dotted_letter(c).unwrap_or((c, 0));
                name.push(letter);
                primes += dots;
            }
            _ => break,
        }
        at += c.len_utf8();
    }
    (on_the_line(&name), primes, at)
}

/// Returns whether the marks so far are dots above a letter, after which a name continues: `ẋ_1`.
fn after_dot(so_far: &str) -> bool {
    !so_far.contains(['\'', '′', '″'])
}

/// The digits above the line at a place, as plain ones, and where they end.
fn raised(text: &str, start: usize) -> (String, usize) {
    let mut at = start;
    let mut digits = String::new();
    for c in text[start..].chars() {
        let Some(plain) = raised_digit(c) else { break };
        digits.push(plain);
        at += c.len_utf8();
    }
    (digits, at)
}

/// The literal of a number with the power of ten that may follow it, `6.67·10⁻¹¹`, and where it ends.
fn with_power_of_ten(text: &str, start: usize, end: usize) -> (String, usize) {
    let literal = &text[start..end];
    let rest = ["·10", "×10"].iter().find_map(|ten| text[end..].strip_prefix(ten));
    if let Some(rest) = rest.filter(|_| !literal.contains(['e', 'E'])) {
        let (exponent, after) = raised(text, text.len() - rest.len());
        if exponent.trim_start_matches('-').parse::<u16>().is_ok() {
            return (format!("{literal}e{exponent}"), after);
        }
    }
    (literal.to_owned(), end)
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
        '=' if text[start + 1..].trim() == "0" => "an expression is one side only: leave `= 0` out",
        '=' => "an expression is one side only; what must vanish is written as a difference",
        '<' | '>' | '≤' | '≥' => {
            "an expression is a number: an event is where one passes 0, and (1 + sign(x))/2 is 1 where x > 0"
        }
        '[' | ']' | '{' | '}' => "group with parentheses ( )",
        '\'' | '′' | '″' => "a prime follows the name of a coordinate at once: x'",
        '’' => "a velocity is written with a prime: x' or x′",
        '°' => "angles are in radians: 30° is 30*pi/180",
        '–' | '—' => "minus is written with `-` or `−`",
        _ => return error,
    };
    error.with_help(help)
}
