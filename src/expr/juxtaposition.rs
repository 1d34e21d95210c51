//! Factors side by side, as in `½ m l² θ′²`, and functions without parentheses, as in `sin θ`: what they mean, and
//! which of them could mean two things. Those are refused by a sentence that offers both readings.
//!
//! In: the parser before such a place. Out: the operator or the application, and the doubts. Never here: the meaning of
//! names, on which only a name directly before a parenthesis depends (`syntax`).

use super::parse::Parser;
use super::syntax::{BinaryOperator, Span, Syntax, SyntaxError, SyntaxKind};
use super::token::Token;
use crate::num::Number;

/// The longest piece of text that a correction quotes.
const LONGEST: usize = 60;

impl Parser<'_> {
    /// Returns whether the current token begins a factor that stands beside the one before it.
    pub(super) fn begins_factor(&self) -> bool {
        match self.word() {
            Token::Number(_) | Token::Name(..) | Token::Mark('(' | '√') => true,
            Token::Mark('|') => self.bars == 0,
            _ => false,
        }
    }

    /// Returns whether a factor begins directly after the current token.
    pub(super) fn is_glued_to_next(&self) -> bool {
        self.words.get(self.at + 1).is_some_and(|(word, span)| {
            let begins =
                matches!(word, Token::Number(_) | Token::Name(..) | Token::Mark('(' | '√' | '|'));
            begins && span.start == self.span().end
        })
    }

    fn quote(&self, span: Span) -> &str {
        let piece = self.text.get(span.start..span.end).unwrap_or_default();
        if piece.len() <= LONGEST { piece } else { "..." }
    }

    fn two_ways(&mut self, span: Span, first: &str, second: &str) {
        let message = format!("`{}` can be read in two ways", self.quote(span));
        let help = format!("write `{first}` or `{second}`");
        self.doubt(SyntaxError::new(span, message).with_help(help));
    }

    /// The operator between the factor before the current token and the one that begins with it.
    pub(super) fn check_side_by_side(&mut self) -> BinaryOperator {
        let before = self.words[self.at - 1].clone();
        let span = Span { start: before.1.start, end: self.span().end };
        // m 2^x is a product
        let raised =
            matches!(self.words.get(self.at + 1), Some((Token::Mark('^') | Token::Raised(_), _)));
        if matches!(self.word(), Token::Number(_)) && (!raised || self.is_glued()) {
            let (left, right) =
                (self.quote(before.1).to_owned(), self.quote(self.span()).to_owned());
            let (message, help) = match before.0 {
                Token::Number(_) => (
                    "two numbers stand side by side".to_owned(),
                    format!("write `{left}*{right}` or `{left} + {right}`"),
                ),
                Token::Name(..) => (
                    "a number comes after what it multiplies".to_owned(),
                    format!(
                        "write `{right} {left}` for the product or `{left}^{right}` for the power"
                    ),
                ),
                _ => (
                    "a number comes after what it multiplies".to_owned(),
                    format!(
                        "write `{right} (...)` for the product or `(...)^{right}` for the power"
                    ),
                ),
            };
            self.doubt(SyntaxError::new(span, message).with_help(help));
        }
        let applied = matches!(before.0, Token::Name(..))
            && self.word() == &Token::Mark('(')
            && self.is_glued()
            && !self.ends_application(self.at);
        if applied { BinaryOperator::Apply } else { BinaryOperator::Multiply }
    }

    /// Returns whether the token before this place is the argument of a function without parentheses.
    fn ends_application(&self, at: usize) -> bool {
        let mut before = at - 1;
        if before == 0 {
            return false;
        }
        before -= 1;
        if let Token::Raised(_) = self.words[before].0 {
            before = before.saturating_sub(1);
        } else if let (Token::Number(_), true) =
            (&self.words[before].0, before >= 2 && self.words[before - 1].0 == Token::Mark('^'))
        {
            before -= 2;
        }
        matches!(&self.words[before].0, Token::Name(name, 0) if super::parse::is_function(name))
    }

    /// `a/b c`: the second factor may belong to the divisor.
    pub(super) fn doubt_divisor(&mut self, start: usize, divisor: Span, right: Span) {
        let above = self.quote(Span { start, end: divisor.start }).to_owned();
        let below =
            self.quote(Span { start: divisor.start, end: self.end_before(right.start) }).to_owned();
        let last = self.quote(right).to_owned();
        let span = Span { start, end: right.end };
        self.two_ways(
            span,
            &format!("({above}{below}) {last}"),
            &format!("{above}({below} {last})"),
        );
    }

    /// The end of the token before a place in the text.
    fn end_before(&self, start: usize) -> usize {
        let at = self.words.partition_point(|(_, span)| span.start < start);
        self.words[at.saturating_sub(1)].1.end
    }

    /// `e^2x`: what stands directly after an exponent may belong to it.
    pub(super) fn check_exponent(&mut self, base: Span, exponent: Span) {
        let closed = self.text[..exponent.end].ends_with(')');
        let follows =
            matches!(self.word(), Token::Number(_) | Token::Name(..) | Token::Mark('(' | '√'));
        if closed || !follows || !self.is_glued() {
            return;
        }
        let (base_text, power) = (self.quote(base).to_owned(), self.quote(exponent).to_owned());
        let next = self.quote(self.span()).to_owned();
        let span = Span { start: base.start, end: self.span().end };
        self.two_ways(
            span,
            &format!("{base_text}^{power} {next}"),
            &format!("{base_text}^({power} {next})"),
        );
    }

    /// `√2m` and `√x²`: what stands directly after the argument may belong to it.
    pub(super) fn check_root(&mut self, argument: Span) {
        let closed = self.text[..argument.end].ends_with([')', '|']);
        let follows = match self.word() {
            Token::Raised(_) | Token::Mark('^') => true,
            Token::Number(_) | Token::Name(..) | Token::Mark('(' | '√') => self.is_glued(),
            _ => false,
        };
        if closed || !follows {
            return;
        }
        let (inner, next) = (self.quote(argument).to_owned(), self.quote(self.span()).to_owned());
        let span = Span { start: argument.start, end: self.span().end };
        let between =
            if matches!(self.word(), Token::Raised(_) | Token::Mark('^')) { "" } else { " " };
        let next = if next == "^" { "^..." } else { &next };
        self.two_ways(
            span,
            &format!("√({inner}){between}{next}"),
            &format!("√({inner}{between}{next})"),
        );
    }

    /// `sin x/2`: the divisor may belong to the argument. By a name it does not: `g sin θ/l`.
    pub(super) fn check_divided(&mut self, left: Span) {
        let divisor = self.at;
        if !matches!(self.words[divisor].0, Token::Number(_)) || divisor < 3 {
            return;
        }
        let bare = matches!(self.words[divisor - 2].0, Token::Number(_) | Token::Name(..));
        if !bare || !self.ends_application(divisor - 1) {
            return;
        }
        let argument = self.words[divisor - 2].1;
        let name =
            self.quote(Span { start: left.start, end: argument.start }).trim_end().to_owned();
        let (argument, number) =
            (self.quote(argument).to_owned(), self.quote(self.span()).to_owned());
        let span = Span { start: left.start, end: self.span().end };
        self.two_ways(
            span,
            &format!("{name}({argument})/{number}"),
            &format!("{name}({argument}/{number})"),
        );
    }

    /// Returns whether a function at the current token has an argument without parentheses, or a power before it.
    pub(super) fn is_applied(&self) -> bool {
        let word = |ahead: usize| self.words.get(self.at + ahead).map(|(word, _)| word);
        let argument = |ahead| {
            matches!(word(ahead), Some(Token::Number(_) | Token::Name(..) | Token::Mark('(' | '|')))
        };
        match word(1) {
            Some(Token::Raised(_)) => argument(2),
            Some(Token::Mark('^')) => matches!(word(2), Some(Token::Number(_))) && argument(3),
            Some(Token::Mark('|')) => true,
            _ => argument(1),
        }
    }

    /// `sin θ`, `sin² θ`, `sin²(2 θ)`, `ln |x|`.
    pub(super) fn applied(&mut self, name: &str) -> Result<Syntax, SyntaxError> {
        let start = self.span();
        self.next();
        let raised = self.span();
        let power = match *self.word() {
            Token::Raised(n) => Some(Number::integer(n)),
            Token::Mark('^') => {
                self.next();
                match *self.word() {
                    Token::Number(n) => Some(n),
                    _ => None,
                }
            }
            _ => None,
        };
        if power.is_some() {
            self.next();
        }
        let argument = self.atom()?;
        let span = Span { start: start.start, end: argument.span.end };
        let enclosed = self.text[..span.end].ends_with([')', '|']);
        let inner = self.quote(argument.span).to_owned();
        if power.is_some_and(Number::is_negative) {
            let inverse = format!("a{name}({inner})");
            self.two_ways(span, &format!("1/{name}({inner})"), &inverse);
        } else if !enclosed {
            self.check_argument(name, raised, span, &inner);
        }
        let applied =
            Syntax { span, kind: SyntaxKind::Call(name.to_owned(), start, vec![argument]) };
        Ok(match power {
            None => applied,
            Some(power) => {
                let exponent = Syntax { span: raised, kind: SyntaxKind::Number(power) };
                let kind = SyntaxKind::Power(Box::new(applied), Box::new(exponent));
                Syntax { span, kind }
            }
        })
    }

    /// What follows an argument without parentheses may belong to it, unless it is another function.
    fn check_argument(&mut self, name: &str, raised: Span, span: Span, inner: &str) {
        let next = self.quote(self.span()).to_owned();
        let whole = Span { start: span.start, end: self.span().end };
        match self.word().clone() {
            Token::Raised(_) => {
                self.two_ways(
                    whole,
                    &format!("{name}{next} {inner}"),
                    &format!("{name}({inner}{next})"),
                );
            }
            Token::Mark('^') => {
                self.two_ways(
                    whole,
                    &format!("({name} {inner})^..."),
                    &format!("{name}({inner}^...)"),
                );
            }
            Token::Name(word, 0) if super::parse::is_function(&word) => {}
            Token::Name(word, 0)
                if word == "e" && self.words[self.at + 1].0 == Token::Mark('^') => {}
            Token::Number(_) | Token::Name(..) | Token::Mark('(') => {
                let next = if next == "(" { "(...)".to_owned() } else { next };
                let power = if raised.start == self.words[self.at - 1].1.start {
                    String::new()
                } else {
                    self.quote(Span { start: raised.start, end: self.end_of_power(raised) })
                        .to_owned()
                };
                self.two_ways(
                    whole,
                    &format!("{name}{power}({inner}) {next}"),
                    &format!("{name}{power}({inner} {next})"),
                );
            }
            _ => {}
        }
    }

    /// The end of the power that begins at a token: `²` or `^2`.
    fn end_of_power(&self, raised: Span) -> usize {
        let at = self.words.partition_point(|(_, span)| span.start < raised.start);
        let marks = usize::from(self.words[at].0 == Token::Mark('^'));
        self.words[at + marks].1.end
    }
}
