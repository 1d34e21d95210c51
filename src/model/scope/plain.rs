//! Expressions in the notation of the screen: which name is meant by what is shown, and the plain form of a text.
//!
//! In: names and syntax as typed. Out: names of the file, plain texts. Never here: what a name may be used for.

use super::Scope;
use super::meaning::Meaning;
use crate::expr::{EULER, FUNCTIONS, LEFT_TO_RIGHT, Span, Syntax, SyntaxError, parse_all};

/// The longest unknown name that is taken apart.
const LONGEST_APART: usize = 40;

/// The longest text that is written out with its corrections.
const LONGEST_LINE: usize = 240;

/// A name that may have primes of its own, and further ones.
fn with_primes(name: &str, primes: usize) -> (String, usize) {
    let bare = name.trim_end_matches('\'');
    (bare.to_owned(), primes + name.len() - bare.len())
}

impl Scope {
    /// The name in the file and its primes for a name as typed: itself, or one that the screen shows so.
    pub(super) fn plain_name(
        &self,
        name: &str,
        primes: usize,
        span: Span,
    ) -> Result<(String, usize), SyntaxError> {
        if name.is_ascii() && self.names.contains_key(name) {
            return Ok((name.to_owned(), primes));
        }
        let typed = primes;
        let (found, primes) = match self.shown().find(name, primes) {
            Some(found) => (found, 0),
            None => match self.shown().find(name, 0) {
                Some(found) => (found, primes),
                None => return Ok((name.to_owned(), primes)),
            },
        };
        // where one of them may not stand, the other is meant
        let open = |name: &&String| match self.names.get(name.trim_end_matches('\'')) {
            Some(Meaning::Symbol(s)) => {
                self.kinds.get(s).is_none_or(|&k| self.objection(k).is_none())
            }
            _ => true,
        };
        let mut usable = found.iter().filter(open);
        match (usable.next(), usable.next()) {
            (Some(one), None) => Ok(with_primes(one, primes)),
            (None, _) => Ok(found
                .first()
                .map_or_else(|| (name.to_owned(), primes), |one| with_primes(one, primes))),
            (Some(_), Some(_)) => {
                let all: Vec<String> = found.iter().map(|name| format!("`{name}`")).collect();
                let letters = format!("{name}{}", "′".repeat(typed));
                let message = format!("`{letters}` is shown for more than one name");
                let help = format!("write {}", all.join(" or "));
                Err(SyntaxError::new(span, message).with_help(help))
            }
        }
    }

    /// The plain form of an expression, if it was not written so.
    pub(super) fn plain_form(&self, text: &str, syntax: &Syntax) -> Option<String> {
        let has_e = || self.names.contains_key("e") || self.shown().has("e");
        if syntax.is_plain(text, &has_e) {
            return None;
        }
        Some(syntax.plain(text, &|name, primes| {
            if name == "e" && primes == 0 && !has_e() {
                return EULER.to_owned();
            }
            let (name, primes) = self
                .plain_name(name, primes, Span::default())
                .unwrap_or_else(|_| (name.to_owned(), primes));
            format!("{name}{}", "'".repeat(primes))
        }))
    }

    /// An unknown name as known ones side by side, if it consists of them: `mgl` is `m g l`, and `mlsin` before an argument
    /// `m l sin`.
    pub(super) fn taken_apart(&self, name: &str, primes: usize) -> Option<String> {
        if name.len() > LONGEST_APART {
            return None;
        }
        let is_function =
            |piece: &str| FUNCTIONS.iter().any(|row| [row.name, row.unicode].contains(&piece));
        let is_name = |piece: &str| self.knows(piece) || self.shown().has(piece);
        let known = |piece: &str| is_name(piece) || primes == 0 && is_function(piece);
        let mut pieces: Vec<&str> = Vec::new();
        let mut rest = name;
        while !rest.is_empty() {
            let mut ends = rest.char_indices().map(|(at, c)| at + c.len_utf8());
            let end = ends.rfind(|&end| known(&rest[..end]))?;
            pieces.push(&rest[..end]);
            rest = &rest[end..];
        }
        // `kk` is a slip
        let repeated = pieces.windows(2).any(|pair| pair[0] == pair[1]);
        (pieces.len() > 1 && !repeated && pieces.iter().any(|piece| is_name(piece)))
            .then(|| format!("{}{}", pieces.join(" "), "'".repeat(primes)))
    }

    /// Says how a whole text reads in which several products are run together, after what is said of each of them. Its errors
    /// are those at `from` and after.
    pub(super) fn add_corrected_line(&mut self, text: &str, from: usize) {
        let Some((words, line)) = self.corrected_line(text, from) else { return };
        for error in &mut self.diagnostics[from..] {
            // the line of the doubts alone still has what is run together
            if let Some((help, _)) =
                error.help.as_ref().and_then(|help| help.split_once(LEFT_TO_RIGHT))
            {
                error.help = Some(help.to_owned());
            }
        }
        let last = self.diagnostics.last_mut().and_then(|last| last.help.as_mut());
        if let Some(help) = last {
            help.push_str(&format!("{words}`{line}`"));
        }
    }

    /// A text with its products written apart, and the words before it, if those and what can be read in two ways are all
    /// its errors and there are several.
    fn corrected_line(&self, text: &str, from: usize) -> Option<(&'static str, String)> {
        let errors = self.diagnostics.get(from..)?;
        if errors.len() < 2 || text.len() > LONGEST_LINE {
            return None;
        }
        let (_, doubts) = parse_all(text);
        let is_doubt = |error: &SyntaxError| {
            doubts.iter().any(|doubt| doubt.span == error.span && doubt.message == error.message)
        };
        let apart = |error: &SyntaxError| {
            let written = text.get(error.span.start..error.span.end)?;
            let bare = written.trim_end_matches(['\'', '′']);
            let primes = written.chars().count() - bare.chars().count();
            let apart = self.taken_apart(bare, primes)?;
            let suggested = error.help.as_ref().is_some_and(|help| help.contains(&apart));
            suggested.then_some((error.span, apart))
        };
        let run_together = errors.iter().filter(|error| !is_doubt(error));
        let mut pieces: Vec<(Span, String)> = run_together.map(apart).collect::<Option<_>>()?;
        pieces.sort_by_key(|(span, _)| span.start);
        if pieces.is_empty() {
            return None;
        }
        let with = |enclosed: bool| {
            let (mut line, mut end) = (String::new(), 0);
            for (span, apart) in &pieces {
                line.push_str(text.get(end..span.start)?);
                line.push_str(&if enclosed { format!("({apart})") } else { apart.clone() });
                end = span.end;
            }
            line.push_str(text.get(end..)?);
            let (syntax, left) = parse_all(&line);
            match (syntax, left.is_empty()) {
                (_, true) => Some(("; all of it: ", line)),
                (Some(syntax), false) if left.len() == doubts.len() => {
                    let name = |name: &str, primes| format!("{name}{}", "'".repeat(primes));
                    Some((LEFT_TO_RIGHT, syntax.plain(&line, &name)))
                }
                _ => None,
            }
        };
        // `x/m l` can be read in two ways
        with(false).or_else(|| with(true))
    }
}
