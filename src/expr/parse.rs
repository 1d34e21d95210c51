//! A recursive-descent parser for the expressions of the file format:
//!
//! ```text
//! sum     = product { (+|-) product }
//! product = signed { (*|/) signed | power }
//! signed  = - signed | power
//! power   = atom [ ^ exponent | raised ]        exponent = - exponent | power
//! atom    = number | name | name ( sum {, sum} ) | ( sum ) | "|" sum "|" | √ atom
//!         | function [ ^ number | raised ] ( number | name | "|" sum "|" | ( sum ) )
//! ```
//!
//! What two factors side by side mean, and which of them could mean two things, is in `juxtaposition`.

use super::function::FUNCTIONS;
use super::syntax::{BinaryOperator, Span, Syntax, SyntaxError, SyntaxKind};
use super::token::{Token, tokens};
use crate::num::Number;

/// The largest nesting depth of an expression.
const NESTING_LIMIT: usize = 256;

/// Parses one expression.
///
/// # Errors
/// Returns the first syntax error, with its span and a correction.
pub fn parse(text: &str) -> Result<Syntax, SyntaxError> {
    let (syntax, mut diagnostics) = parse_all(text);
    match syntax {
        Some(syntax) if diagnostics.is_empty() => Ok(syntax),
        _ => Err(diagnostics.swap_remove(0)),
    }
}

/// Parses one expression and returns all of its syntax errors. Those that leave no doubt about the structure, such as
/// `a/b c` where both readings are known, are reported together, and the syntax is then that from left to right.
pub fn parse_all(text: &str) -> (Option<Syntax>, Vec<SyntaxError>) {
    let words = match tokens(text) {
        Ok(words) => words,
        Err(error) => return (None, vec![error]),
    };
    let mut parser = Parser { text, words, at: 0, depth: 0, bars: 0, doubts: Vec::new() };
    match parser.whole() {
        Ok(syntax) => {
            let mut doubts = parser.doubts;
            if let [_, .., last] = &mut doubts[..] {
                let line =
                    syntax.plain(text, &|name, primes| format!("{name}{}", "'".repeat(primes)));
                if line.len() <= LONGEST_LINE {
                    let help = last.help.take().unwrap_or_default();
                    last.help = Some(format!("{help}{LEFT_TO_RIGHT}`{line}`"));
                }
            }
            (Some(syntax), doubts)
        }
        Err(error) => {
            parser.doubts.push(error);
            (None, parser.doubts)
        }
    }
}

/// What stands between the last of several doubts and the whole line.
pub const LEFT_TO_RIGHT: &str = "; read from left to right, all of it is ";

/// The most doubts that are collected in one expression.
const MOST_DOUBTS: usize = 100;

/// The longest line that a correction quotes whole.
const LONGEST_LINE: usize = 200;

pub(super) struct Parser<'t> {
    pub(super) text: &'t str,
    pub(super) words: Vec<(Token, Span)>,
    pub(super) at: usize,
    depth: usize,
    /// How many `|` are open.
    pub(super) bars: usize,
    /// Places that can be read in two ways.
    doubts: Vec<SyntaxError>,
}

impl Parser<'_> {
    fn whole(&mut self) -> Result<Syntax, SyntaxError> {
        if self.word() == &Token::End {
            return Err(SyntaxError::new(self.span(), "an expression is missing here"));
        }
        let syntax = self.sum()?;
        match self.word() {
            Token::End => Ok(syntax),
            Token::Mark(')') => {
                Err(SyntaxError::new(self.span(), "this parenthesis was never opened"))
            }
            Token::Mark(',') => Err(SyntaxError::new(
                self.span(),
                "a comma stands only between the arguments of a function",
            )
            .with_help("a decimal fraction is written with a point")),
            _ => Err(SyntaxError::new(self.span(), "an operator is missing here")),
        }
    }

    pub(super) fn doubt(&mut self, error: SyntaxError) {
        if self.doubts.len() < MOST_DOUBTS {
            self.doubts.push(error);
        }
    }

    /// Returns whether the current token stands directly after the one before it.
    pub(super) fn is_glued(&self) -> bool {
        self.at > 0 && self.words[self.at - 1].1.end == self.span().start
    }

    pub(super) fn word(&self) -> &Token {
        &self.words[self.at].0
    }

    pub(super) fn span(&self) -> Span {
        self.words[self.at].1
    }

    pub(super) fn next(&mut self) {
        self.at = (self.at + 1).min(self.words.len() - 1);
    }

    pub(super) fn take(&mut self, mark: char) -> bool {
        let found = self.word() == &Token::Mark(mark);
        if found {
            self.next();
        }
        found
    }

    fn deeper<T>(
        &mut self,
        inner: impl FnOnce(&mut Self) -> Result<T, SyntaxError>,
    ) -> Result<T, SyntaxError> {
        self.depth += 1;
        if self.depth > NESTING_LIMIT {
            let message = format!("nested deeper than {NESTING_LIMIT}");
            return Err(SyntaxError::new(self.span(), message)
                .with_help("name parts of it in [definitions]"));
        }
        let result = inner(self);
        self.depth -= 1;
        result
    }

    fn sum(&mut self) -> Result<Syntax, SyntaxError> {
        let operator = |word: &Token| match word {
            Token::Mark('+') => Some(BinaryOperator::Add),
            Token::Mark('-') => Some(BinaryOperator::Subtract),
            _ => None,
        };
        self.chain(operator, Parser::product)
    }

    fn product(&mut self) -> Result<Syntax, SyntaxError> {
        let first = self.signed()?;
        match self.word() {
            Token::Mark('*' | '/') => self.product_of(first),
            _ if self.begins_factor() => self.product_of(first),
            _ => Ok(first),
        }
    }

    /// The rest of a product. It is apart from its beginning, as are all parts of the grammar that seldom occur, because
    /// what is nested deeply would otherwise reserve room for them at every level.
    fn product_of(&mut self, first: Syntax) -> Result<Syntax, SyntaxError> {
        let mut rest: Vec<(BinaryOperator, Syntax)> = Vec::new();
        // the divisor to which the next factor may belong
        let mut divisor: Option<Span> = None;
        loop {
            let operator = match self.word() {
                Token::Mark('*') => Some(BinaryOperator::Multiply),
                Token::Mark('/') => Some(BinaryOperator::Divide),
                _ => None,
            };
            if let Some(operator) = operator {
                self.next();
                let left = rest.last().map_or(&first, |(_, part)| part).span;
                if operator == BinaryOperator::Divide {
                    self.check_divided(left);
                }
                let right = self.signed()?;
                divisor = (operator == BinaryOperator::Divide).then_some(right.span);
                rest.push((operator, right));
            } else if self.begins_factor() {
                let operator = self.check_side_by_side();
                let right = self.power()?;
                if let Some(divisor) = divisor.take() {
                    self.doubt_divisor(first.span.start, divisor, right.span);
                }
                rest.push((operator, right));
            } else {
                break;
            }
        }
        let Some((_, last)) = rest.last() else { return Ok(first) };
        let span = Span { start: first.span.start, end: last.span.end };
        Ok(Syntax { span, kind: SyntaxKind::Chain(Box::new(first), rest) })
    }

    fn chain(
        &mut self,
        operator: impl Fn(&Token) -> Option<BinaryOperator>,
        part: impl Fn(&mut Self) -> Result<Syntax, SyntaxError>,
    ) -> Result<Syntax, SyntaxError> {
        let first = part(self)?;
        if operator(self.word()).is_none() {
            return Ok(first);
        }
        self.chain_of(first, operator, part)
    }

    fn chain_of(
        &mut self,
        first: Syntax,
        operator: impl Fn(&Token) -> Option<BinaryOperator>,
        part: impl Fn(&mut Self) -> Result<Syntax, SyntaxError>,
    ) -> Result<Syntax, SyntaxError> {
        let mut rest: Vec<(BinaryOperator, Syntax)> = Vec::new();
        while let Some(op) = operator(self.word()) {
            self.next();
            rest.push((op, part(self)?));
        }
        let Some((_, last)) = rest.last() else { return Ok(first) };
        let span = Span { start: first.span.start, end: last.span.end };
        Ok(Syntax { span, kind: SyntaxKind::Chain(Box::new(first), rest) })
    }

    fn signed(&mut self) -> Result<Syntax, SyntaxError> {
        self.negated(Parser::power)
    }

    fn negated(
        &mut self,
        inner: fn(&mut Self) -> Result<Syntax, SyntaxError>,
    ) -> Result<Syntax, SyntaxError> {
        if self.word() == &Token::Mark('-') { self.negative(inner) } else { inner(self) }
    }

    fn negative(
        &mut self,
        inner: fn(&mut Self) -> Result<Syntax, SyntaxError>,
    ) -> Result<Syntax, SyntaxError> {
        let start = self.span().start;
        self.next();
        let operand = self.deeper(|p| p.negated(inner))?;
        let span = Span { start, end: operand.span.end };
        Ok(Syntax { span, kind: SyntaxKind::Negate(Box::new(operand)) })
    }

    pub(super) fn power(&mut self) -> Result<Syntax, SyntaxError> {
        let base = self.atom()?;
        match self.word() {
            Token::Raised(_) | Token::Mark('^') => self.power_of(base),
            _ => Ok(base),
        }
    }

    fn power_of(&mut self, base: Syntax) -> Result<Syntax, SyntaxError> {
        if let &Token::Raised(n) = self.word() {
            let span = self.span();
            self.next();
            if matches!(self.word(), Token::Raised(_) | Token::Mark('^')) {
                return Err(SyntaxError::new(self.span(), "a power of a power needs parentheses"));
            }
            let kind = SyntaxKind::Number(Number::integer(n));
            let exponent = Syntax { span, kind };
            return Ok(raised_to(base, exponent));
        }
        self.next();
        let exponent = self.deeper(|p| p.negated(Parser::power))?;
        self.check_exponent(base.span, exponent.span);
        Ok(raised_to(base, exponent))
    }

    pub(super) fn atom(&mut self) -> Result<Syntax, SyntaxError> {
        match self.word() {
            Token::Name(name, 0) if self.is_call(name) => {
                let name = plain_name(name.clone());
                self.called(name)
            }
            Token::Name(name, 0) if is_function(name) && self.is_applied() => {
                let name = plain_name(name.clone());
                self.deeper(|p| p.applied(&name))
            }
            Token::Number(number) => {
                let kind = SyntaxKind::Number(*number);
                Ok(self.leaf(kind))
            }
            Token::Name(name, primes) => {
                let kind = SyntaxKind::Name(name.clone(), *primes);
                Ok(self.leaf(kind))
            }
            Token::Mark('(') => self.parenthesis(),
            Token::Mark('|') => self.absolute_value(),
            Token::Mark('√') => self.root(),
            &Token::Mark(mark) => Err(self.missing_before(mark)),
            Token::Raised(_) => Err(SyntaxError::new(self.span(), "a power needs a base")),
            Token::End => Err(SyntaxError::new(self.span(), "the expression ends too early")),
        }
    }

    fn leaf(&mut self, kind: SyntaxKind) -> Syntax {
        let span = self.span();
        self.next();
        Syntax { span, kind }
    }

    /// A function with its arguments in parentheses.
    fn called(&mut self, name: String) -> Result<Syntax, SyntaxError> {
        let span = self.span();
        self.next();
        self.next();
        let (arguments, end) = self.enclosed(|p| p.arguments(span))?;
        let whole = Span { start: span.start, end };
        Ok(Syntax { span: whole, kind: SyntaxKind::Call(name, span, arguments) })
    }

    fn parenthesis(&mut self) -> Result<Syntax, SyntaxError> {
        let span = self.span();
        self.next();
        let inner = self.enclosed(Parser::sum)?;
        let end = self.span().end;
        if self.take(')') {
            return Ok(Syntax { span: Span { start: span.start, end }, ..inner });
        }
        Err(self.unclosed(span, &inner))
    }

    fn absolute_value(&mut self) -> Result<Syntax, SyntaxError> {
        let span = self.span();
        self.next();
        self.bars += 1;
        let inner = self.deeper(Parser::sum)?;
        self.bars -= 1;
        let end = self.span().end;
        if self.word() == &Token::Mark('|') && !self.is_glued() && self.is_glued_to_next() {
            return Err(SyntaxError::new(self.span(), "this `|` may open or close")
                .with_help("write abs(...) for an absolute value inside another"));
        }
        if !self.take('|') {
            return Err(SyntaxError::new(span, "this `|` is never closed")
                .with_help("an absolute value is written |x| or abs(x)"));
        }
        Ok(call("abs", Span { start: span.start, end }, inner))
    }

    fn root(&mut self) -> Result<Syntax, SyntaxError> {
        let span = self.span();
        self.next();
        let inner = self.deeper(Parser::atom)?;
        self.check_root(inner.span);
        Ok(call("sqrt", Span { start: span.start, end: inner.span.end }, inner))
    }

    /// What is missing before a mark that begins nothing.
    fn missing_before(&self, mark: char) -> SyntaxError {
        let message = match mark {
            '+' => "a plus sign needs something before it".to_owned(),
            mark => format!("something is missing before `{mark}`"),
        };
        SyntaxError::new(self.span(), message)
    }

    fn arguments(&mut self, open: Span) -> Result<(Vec<Syntax>, usize), SyntaxError> {
        let mut arguments = vec![self.sum()?];
        loop {
            let end = self.span().end;
            if self.take(')') {
                return Ok((arguments, end));
            }
            if !self.take(',') {
                return Err(self.unclosed(open, &arguments[arguments.len() - 1]));
            }
            arguments.push(self.sum()?);
        }
    }

    /// Runs a part of the grammar between parentheses, where a `|` opens.
    pub(super) fn enclosed<T>(
        &mut self,
        inner: impl FnOnce(&mut Self) -> Result<T, SyntaxError>,
    ) -> Result<T, SyntaxError> {
        let bars = std::mem::take(&mut self.bars);
        let result = self.deeper(inner);
        self.bars = bars;
        result
    }

    fn unclosed(&self, open: Span, before: &Syntax) -> SyntaxError {
        if self.word() == &Token::End || self.word() == &Token::Mark(',') {
            SyntaxError::new(open, "this parenthesis is never closed")
        } else {
            let span = Span { start: before.span.start, end: self.span().end };
            SyntaxError::new(span, "an operator is missing here")
        }
    }

    /// Returns whether a name begins a call: a function before a parenthesis, or anything directly before one that
    /// holds several arguments.
    fn is_call(&self, name: &str) -> bool {
        if self.words[self.at + 1].0 != Token::Mark('(') {
            return false;
        }
        let glued = self.words[self.at].1.end == self.words[self.at + 1].1.start;
        is_function(name) || (glued && self.has_comma())
    }

    /// Returns whether the parenthesis after the current token holds a comma of its own.
    fn has_comma(&self) -> bool {
        let mut depth = 0_usize;
        for (word, _) in &self.words[self.at + 1..] {
            match word {
                Token::Mark('(') => depth += 1,
                Token::Mark(')') => depth -= 1,
                Token::Mark(',') if depth == 1 => return true,
                _ => {}
            }
            if depth == 0 {
                return false;
            }
        }
        false
    }
}

fn raised_to(base: Syntax, exponent: Syntax) -> Syntax {
    let span = Span { start: base.span.start, end: exponent.span.end };
    Syntax { span, kind: SyntaxKind::Power(Box::new(base), Box::new(exponent)) }
}

pub(super) fn call(name: &str, span: Span, argument: Syntax) -> Syntax {
    Syntax { span, kind: SyntaxKind::Call(name.to_owned(), span, vec![argument]) }
}

/// The function of a name in a file or on the screen (`arcsin`).
pub(super) fn is_function(name: &str) -> bool {
    FUNCTIONS.iter().any(|row| row.name == name || row.unicode == name)
}

/// The name in a file of a function.
fn plain_name(name: String) -> String {
    FUNCTIONS.iter().find(|row| row.unicode == name).map_or(name, |row| row.name.to_owned())
}
