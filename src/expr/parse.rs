//! A recursive-descent parser for the expressions of the file format:
//!
//! ```text
//! sum     = product { (+|-) product }
//! product = signed { (*|/) signed }
//! signed  = - signed | power
//! power   = atom [ ^ exponent ]        exponent = - exponent | power
//! atom    = number | name | name ( sum {, sum} ) | ( sum )
//! ```

use super::syntax::{BinaryOperator, Span, Syntax, SyntaxError, SyntaxKind};
use super::token::{Token, tokens};

/// The largest nesting depth of an expression.
const NESTING_LIMIT: usize = 256;

/// Parses one expression.
///
/// # Errors
/// Returns the first syntax error, with its span and a correction.
pub fn parse(text: &str) -> Result<Syntax, SyntaxError> {
    let words = tokens(text)?;
    let mut parser = Parser { words, at: 0, depth: 0 };
    if parser.word() == &Token::End {
        return Err(SyntaxError::new(parser.span(), "an expression is missing here"));
    }
    let syntax = parser.sum()?;
    match parser.word() {
        Token::End => Ok(syntax),
        Token::Mark(')') => {
            Err(SyntaxError::new(parser.span(), "this parenthesis was never opened"))
        }
        Token::Mark(',') => Err(SyntaxError::new(
            parser.span(),
            "a comma stands only between the arguments of a function",
        )
        .with_help("a decimal fraction is written with a point")),
        _ => Err(parser.implied_product(&syntax)),
    }
}

struct Parser {
    words: Vec<(Token, Span)>,
    at: usize,
    depth: usize,
}

impl Parser {
    fn word(&self) -> &Token {
        &self.words[self.at].0
    }

    fn span(&self) -> Span {
        self.words[self.at].1
    }

    fn next(&mut self) {
        self.at = (self.at + 1).min(self.words.len() - 1);
    }

    fn take(&mut self, mark: char) -> bool {
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
        let operator = |word: &Token| match word {
            Token::Mark('*') => Some(BinaryOperator::Multiply),
            Token::Mark('/') => Some(BinaryOperator::Divide),
            _ => None,
        };
        self.chain(operator, Parser::signed)
    }

    fn chain(
        &mut self,
        operator: impl Fn(&Token) -> Option<BinaryOperator>,
        part: impl Fn(&mut Self) -> Result<Syntax, SyntaxError>,
    ) -> Result<Syntax, SyntaxError> {
        let first = part(self)?;
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
        let start = self.span().start;
        if !self.take('-') {
            return inner(self);
        }
        let operand = self.deeper(|p| p.negated(inner))?;
        let span = Span { start, end: operand.span.end };
        Ok(Syntax { span, kind: SyntaxKind::Negate(Box::new(operand)) })
    }

    fn power(&mut self) -> Result<Syntax, SyntaxError> {
        let base = self.atom()?;
        if !self.take('^') {
            return Ok(base);
        }
        let exponent = self.deeper(|p| p.negated(Parser::power))?;
        let span = Span { start: base.span.start, end: exponent.span.end };
        Ok(Syntax { span, kind: SyntaxKind::Power(Box::new(base), Box::new(exponent)) })
    }

    fn atom(&mut self) -> Result<Syntax, SyntaxError> {
        let span = self.span();
        match self.word().clone() {
            Token::Number(number) => {
                self.next();
                Ok(Syntax { span, kind: SyntaxKind::Number(number) })
            }
            Token::Name(name, 0) if self.words[self.at + 1].0 == Token::Mark('(') => {
                self.next();
                self.next();
                let (arguments, end) = self.deeper(|p| p.arguments(span))?;
                let whole = Span { start: span.start, end };
                Ok(Syntax { span: whole, kind: SyntaxKind::Call(name, span, arguments) })
            }
            Token::Name(name, primes) => {
                self.next();
                Ok(Syntax { span, kind: SyntaxKind::Name(name, primes) })
            }
            Token::Mark('(') => {
                self.next();
                let inner = self.deeper(Parser::sum)?;
                let end = self.span().end;
                if self.take(')') {
                    return Ok(Syntax { span: Span { start: span.start, end }, ..inner });
                }
                Err(self.unclosed(span, &inner))
            }
            Token::End => Err(SyntaxError::new(span, "the expression ends too early")),
            Token::Mark('+') => {
                Err(SyntaxError::new(span, "a plus sign needs something before it"))
            }
            Token::Mark(')') => Err(SyntaxError::new(span, "something is missing before `)`")),
            Token::Mark(mark) => {
                Err(SyntaxError::new(span, format!("something is missing before `{mark}`")))
            }
        }
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

    fn unclosed(&self, open: Span, before: &Syntax) -> SyntaxError {
        if self.word() == &Token::End || self.word() == &Token::Mark(',') {
            SyntaxError::new(open, "this parenthesis is never closed")
        } else {
            self.implied_product(before)
        }
    }

    /// The error for two operands side by side, which is the commonest slip.
    fn implied_product(&self, before: &Syntax) -> SyntaxError {
        let word = |token: &Token| match token {
            Token::Name(name, primes) => format!("{name}{}", "'".repeat(*primes)),
            Token::Number(n) => n.value().to_string(),
            Token::Mark(c) => c.to_string(),
            Token::End => String::new(),
        };
        let left = match &self.words[self.at.saturating_sub(1)].0 {
            Token::Mark(_) => "(...)".to_owned(),
            token => word(token),
        };
        let right = match self.word() {
            Token::Mark(_) => "(...)".to_owned(),
            token => word(token),
        };
        let start = self.words[self.at.saturating_sub(1)].1.start.max(before.span.start);
        let span = Span { start, end: self.span().end };
        SyntaxError::new(span, "an operator is missing: no product is implied")
            .with_help(format!("write {left}*{right}"))
    }
}
