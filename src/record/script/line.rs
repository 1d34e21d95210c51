//! One line of a script: words, quoted texts, times and the rest, each with its range.
//!
//! In: the line. Out: its pieces, or what was expected in place of something else. Never here: what they mean.

use crate::diagnostic::{Diagnostic, SourceRange, nearest};

use crate::record::clock::{Micros, SECOND};

/// A piece of a line whose meaning depends on the system, and its range.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LineText {
    /// The text without quotes.
    pub text: String,
    /// The range in the script.
    pub place: SourceRange,
}

/// A line that is read from left to right.
pub(in crate::record) struct ScriptLine<'a> {
    /// The line without its comment and trailing blanks.
    text: &'a str,
    /// The offset of the line in the script.
    start: usize,
    at: usize,
}

impl<'a> ScriptLine<'a> {
    pub(super) fn new(text: &'a str, start: usize) -> ScriptLine<'a> {
        let text = &text[..comment(text)];
        ScriptLine { text: text.trim_end(), start, at: 0 }
    }

    /// The current position, as a byte offset in the script.
    pub(super) fn here(&self) -> usize {
        self.start + self.at
    }

    fn skip(&mut self) {
        self.at += self.text[self.at..].len() - self.text[self.at..].trim_start().len();
    }

    pub(super) fn is_over(&mut self) -> bool {
        self.skip();
        self.at == self.text.len()
    }

    fn piece(&self, from: usize, to: usize) -> LineText {
        let place = self.start + from..self.start + to;
        LineText { text: self.text[from..to].to_owned(), place }
    }

    /// The next word, up to a blank.
    pub(super) fn word(&mut self) -> Option<LineText> {
        if self.is_over() {
            return None;
        }
        let rest = &self.text[self.at..];
        let from = self.at;
        self.at += rest.find(char::is_whitespace).unwrap_or(rest.len());
        Some(self.piece(from, self.at))
    }

    /// Consumes the next word if it is this one.
    pub(super) fn take(&mut self, word: &str) -> bool {
        let before = self.at;
        let taken = self.word().is_some_and(|next| next.text == word);
        if !taken {
            self.at = before;
        }
        taken
    }

    /// The next word, which is required.
    pub(super) fn need(&mut self, what: &str) -> Result<LineText, Diagnostic> {
        self.word().ok_or_else(|| self.missing(what))
    }

    /// An error at the end of the line.
    pub(super) fn missing(&self, what: &str) -> Diagnostic {
        let end = self.start + self.text.len();
        Diagnostic::error(end..end, format!("here {what} is missing"))
    }

    /// Whether a quoted text comes next.
    pub(super) fn is_quoted(&mut self) -> bool {
        self.skip();
        self.text[self.at..].starts_with('"')
    }

    /// A quoted text, or a single word without quotes.
    pub(super) fn name(&mut self, what: &str) -> Result<LineText, Diagnostic> {
        if self.is_quoted() { self.quoted(what) } else { self.need(what) }
    }

    /// A quoted text; `\"` and `\\` are the escapes.
    pub(super) fn quoted(&mut self, what: &str) -> Result<LineText, Diagnostic> {
        self.skip();
        let (from, rest) = (self.at, &self.text[self.at..]);
        let Some(inside) = rest.strip_prefix('"') else {
            let place = self.start + from..self.start + self.text.len();
            return Err(if rest.is_empty() {
                self.missing(what)
            } else {
                Diagnostic::error(place, format!("{what} belongs in quotes"))
                    .with_help(format!("write it as \"{}\"", rest.trim_matches('"')))
            });
        };
        let (mut text, mut escaped) = (String::new(), false);
        for (at, character) in inside.char_indices() {
            match character {
                '"' if !escaped => {
                    self.at = from + 1 + at + 1;
                    let place = self.start + from..self.start + self.at;
                    return Ok(LineText { text, place });
                }
                '\\' if !escaped => escaped = true,
                c if c.is_control() => {
                    let place = self.start + from + 1 + at..self.start + from + 2 + at;
                    let message = "this text has a character that cannot be shown";
                    return Err(Diagnostic::error(place, message));
                }
                c => {
                    text.push(c);
                    escaped = false;
                }
            }
        }
        let place = self.start + from..self.start + self.text.len();
        Err(Diagnostic::error(place, "this text has no end").with_help("put a \" after it"))
    }

    /// The text up to one of these words, which must be surrounded by blanks; at least one character.
    pub(super) fn until(&mut self, words: &[&str], what: &str) -> Result<LineText, Diagnostic> {
        self.skip();
        let from = self.at;
        let rest = &self.text[from..];
        let ends = words.iter().filter_map(|word| {
            let whole = |at: &usize| {
                let (before, after) = (rest[..*at].chars().last(), rest[at + word.len()..].chars());
                let blank = |c: Option<char>| c.is_none_or(char::is_whitespace);
                let messages = word.chars().all(char::is_alphanumeric);
                !messages || blank(before) && blank(after.clone().next())
            };
            rest.match_indices(*word).map(|(at, _)| at).find(whole)
        });
        let end = ends.min().unwrap_or(rest.len());
        let text = rest[..end].trim_end();
        if text.is_empty() {
            let place = self.start + from..self.start + from + end;
            return Err(Diagnostic::error(place, format!("here {what} is missing")));
        }
        self.at = from + text.len();
        Ok(self.piece(from, self.at))
    }

    /// A time: `2s`, `0.5s`, `150ms`.
    pub(super) fn time(&mut self) -> Result<Micros, Diagnostic> {
        let word = self.need("a time")?;
        let (number, unit) = match word.text.strip_suffix("ms") {
            Some(number) => (number, SECOND / 1000),
            None => (word.text.strip_suffix('s').unwrap_or(&word.text), SECOND),
        };
        let wrong = |message: String| Diagnostic::error(word.place.clone(), message);
        let seconds: f64 =
            number.parse().ok().filter(|n: &f64| n.is_finite()).ok_or_else(|| {
                wrong(format!("`{}` is not a time", word.text))
                    .with_help("write it as 2s, 0.5s or 150ms")
            })?;
        if number.len() == word.text.len() {
            let help = format!("write {number}s or {number}ms");
            return Err(wrong(format!("is {number} in seconds or milliseconds?")).with_help(help));
        }
        if seconds < 0.0 {
            return Err(wrong("a time cannot be negative".to_owned()));
        }
        Ok((seconds * unit as f64).round() as Micros)
    }

    pub(super) fn one_of(
        &mut self,
        what: &str,
        words: &[&'static str],
    ) -> Result<&'static str, Diagnostic> {
        let word = self.need(what)?;
        if let Some(known) = words.iter().find(|known| **known == word.text) {
            return Ok(known);
        }
        let diagnostic = Diagnostic::error(word.place, format!("`{}` is not {what}", word.text));
        Err(match nearest(&word.text, words.iter().copied()) {
            Some(near) => diagnostic.with_help(format!("did you mean `{near}`?")),
            None => diagnostic.with_help(format!("there are {}", words.join(" "))),
        })
    }

    /// Requires that the line is finished.
    pub(super) fn end(&mut self, form: &str) -> Result<(), Diagnostic> {
        if self.is_over() {
            return Ok(());
        }
        let place = self.here()..self.start + self.text.len();
        let message = format!("unexpected `{}`", &self.text[self.at..]);
        Err(Diagnostic::error(place, message).with_help(format!("it is written {form}")))
    }
}

/// The start of a comment: a `#` outside quotes.
fn comment(text: &str) -> usize {
    let (mut quoted, mut escaped) = (false, false);
    for (at, character) in text.char_indices() {
        match character {
            '"' if !escaped => quoted = !quoted,
            '#' if !quoted => return at,
            _ => {}
        }
        escaped = quoted && character == '\\' && !escaped;
    }
    text.len()
}
