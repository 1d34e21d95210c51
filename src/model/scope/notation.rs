//! Names as the screen shows them (`θ₁`, `pₓ`, `φ̇₀`), which may be typed wherever the name in the file may.
//!
//! In: the names of a scope and how their symbols are shown. Out: the names in the file for a shown one. Never here: which of
//! them is meant.

use std::collections::{BTreeMap, BTreeSet};

use super::meaning::Meaning;
use crate::expr::{Symbol, SymbolInfo, subscript, unicode_name, without_dots};

/// The names in the file for what the screen shows, by the shown name and its primes.
#[derive(Clone, Debug, Default)]
pub(super) struct ShownNames {
    names: BTreeMap<(String, usize), BTreeSet<String>>,
}

impl ShownNames {
    pub(super) fn of(infos: &[SymbolInfo], names: &BTreeMap<String, Meaning>) -> ShownNames {
        let unicode = |symbol: Symbol| &infos[symbol.index()].unicode;
        let mut shown = ShownNames::default();
        for (name, meaning) in names {
            let symbol = match meaning {
                Meaning::Symbol(symbol)
                | Meaning::Position([symbol, ..])
                | Meaning::Other([symbol, _]) => *symbol,
                Meaning::Defined(_) | Meaning::Later => continue,
            };
            shown.add(unicode(symbol), name);
            if let Meaning::Position([_, velocity, acceleration]) = meaning {
                for (primes, symbol) in [("'", velocity), ("''", acceleration)] {
                    shown.add(unicode(*symbol), &format!("{name}{primes}"));
                }
            }
        }
        // a Greek letter for its name, also where the file shows another symbol
        for name in names.keys() {
            let (letters, dots) = without_dots(&unicode_name(name));
            // θ1 as well as θ₁
            let on_the_line: String = letters.chars().map(|c| subscript(c).unwrap_or(c)).collect();
            for letters in [letters, on_the_line] {
                if !letters.is_ascii()
                    && letters != *name
                    && !names.contains_key(&letters)
                    && !shown.names.contains_key(&(letters.clone(), dots))
                {
                    shown.add(&letters, name);
                }
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

    pub(super) fn find(&self, letters: &str, primes: usize) -> Option<&BTreeSet<String>> {
        self.names.get(&(letters.to_owned(), primes))
    }
}
