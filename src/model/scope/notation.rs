//! Names as the screen shows them (`θ₁`, `pₓ`, `φ̇₀`), which may be typed wherever the name in the file may.
//!
//! In: the names of a scope and how the model shows them. Out: the name in the file for a shown one, and the plain form
//! of an expression. Never here: what a name means.

use std::collections::{BTreeMap, BTreeSet};

use super::{Meaning, Scope};
use crate::expr::{EULER, Span, Syntax, SyntaxError, unicode_name, without_dots};
use crate::model::Model;

/// The longest unknown name that is taken apart.
const LONGEST_APART: usize = 40;

/// The names in the file for what the screen shows, by the shown name and its primes.
#[derive(Clone, Debug, Default)]
pub(super) struct Shown {
    names: BTreeMap<(String, usize), BTreeSet<String>>,
}

impl Shown {
    pub(super) fn of(model: &Model, names: &BTreeMap<String, Meaning>) -> Shown {
        let mut shown = Shown::default();
        for (name, meaning) in names {
            let symbol = match meaning {
                Meaning::Symbol(symbol)
                | Meaning::Position([symbol, ..])
                | Meaning::Other([symbol, _]) => *symbol,
                Meaning::Defined(_) | Meaning::Later => continue,
            };
            shown.add(&model.pool.symbol_info(symbol).unicode, name);
            if let Meaning::Position([_, velocity, acceleration]) = meaning {
                for (primes, symbol) in [("'", velocity), ("''", acceleration)] {
                    let unicode = &model.pool.symbol_info(*symbol).unicode;
                    shown.add(unicode, &format!("{name}{primes}"));
                }
            }
        }
        // a Greek letter for its name, also where the file shows another symbol
        for name in names.keys() {
            let (letters, dots) = without_dots(&unicode_name(name));
            if letters != *name
                && !names.contains_key(&letters)
                && !shown.names.contains_key(&(letters.clone(), dots))
            {
                shown.add(&letters, name);
            }
        }
        shown
    }

    fn add(&mut self, unicode: &str, name: &str) {
        self.names.entry(without_dots(unicode)).or_default().insert(name.to_owned());
    }

    /// Returns whether something is shown by these letters.
    pub(super) fn has(&self, letters: &str) -> bool {
        self.names.contains_key(&(letters.to_owned(), 0))
    }

    fn find(&self, letters: &str, primes: usize) -> Option<&BTreeSet<String>> {
        self.names.get(&(letters.to_owned(), primes))
    }
}

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
        let (found, primes) = match self.shown.find(name, primes) {
            Some(found) => (found, 0),
            None => match self.shown.find(name, 0) {
                Some(found) => (found, primes),
                None => return Ok((name.to_owned(), primes)),
            },
        };
        // where one of them may not stand, the other is meant
        let open = |name: &&String| match self.names.get(name.trim_end_matches('\'')) {
            Some(Meaning::Symbol(s)) => {
                self.kinds.get(s).is_none_or(|&k| self.refusal(k).is_none())
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
        let has_e = self.names.contains_key("e") || self.shown.has("e");
        if syntax.is_plain(text, has_e) {
            return None;
        }
        Some(syntax.plain(text, &|name, primes| {
            if name == "e" && primes == 0 && !has_e {
                return EULER.to_owned();
            }
            let (name, primes) = self
                .plain_name(name, primes, Span::default())
                .unwrap_or_else(|_| (name.to_owned(), primes));
            format!("{name}{}", "'".repeat(primes))
        }))
    }

    /// An unknown name as known ones side by side, if it consists of them: `mgl` is `m g l`.
    pub(super) fn taken_apart(&self, name: &str, primes: usize) -> Option<String> {
        if name.len() > LONGEST_APART {
            return None;
        }
        let known = |piece: &str| self.knows(piece) || self.shown.has(piece);
        let mut pieces: Vec<&str> = Vec::new();
        let mut rest = name;
        while !rest.is_empty() {
            let ends = rest.char_indices().map(|(at, c)| at + c.len_utf8());
            let end = ends.filter(|&end| known(&rest[..end])).last()?;
            pieces.push(&rest[..end]);
            rest = &rest[end..];
        }
        // `kk` is a slip
        let repeated = pieces.windows(2).any(|pair| pair[0] == pair[1]);
        (pieces.len() > 1 && !repeated)
            .then(|| format!("{}{}", pieces.join(" "), "'".repeat(primes)))
    }
}
