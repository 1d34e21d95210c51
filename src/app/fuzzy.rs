//! Fuzzy search: whether what is typed stands in a text, if need be with gaps, and how well.
//!
//! In: what is typed, the texts of a line. Out: a score and the letters to be marked. Never here: which lines there are.
//!
//! Each word is sought by itself in the line's label, and only whole in what is said about the line: in a long text
//! almost any letters stand in order. The scores are those of nucleo, where letters that follow each other and begin
//! words count most.

use nucleo_matcher::pattern::{Atom, AtomKind, CaseMatching, Normalization};
use nucleo_matcher::{Config, Matcher, Utf32Str};

/// A word found in the label counts this much more than one found only in what is said about the line.
const NAMED: u32 = 20;

/// Each letter of a word found with gaps must have earned at least this much; less is chance.
const LEAST: u32 = 16;

/// What is typed, ready to be sought.
pub(super) struct Query {
    words: Vec<[Atom; 2]>,
    letters: Vec<u32>,
    matcher: Matcher,
}

/// How a line fits what is typed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Fit {
    /// The greater, the better.
    pub score: u32,
    /// The places of the letters of the label that were found, in rising order.
    pub letters: Vec<usize>,
}

impl Query {
    pub(super) fn new(text: &str) -> Self {
        let atom = |word: &str, kind| {
            Atom::new(word, CaseMatching::Ignore, Normalization::Smart, kind, false)
        };
        let words: Vec<&str> = text.split_whitespace().collect();
        Self {
            letters: words.iter().map(|word| word.chars().count() as u32).collect(),
            words: words
                .iter()
                .map(|word| [AtomKind::Fuzzy, AtomKind::Substring].map(|kind| atom(word, kind)))
                .collect(),
            matcher: Matcher::new(Config::DEFAULT),
        }
    }

    /// How a line fits, if each word stands in its label or in what is said about it.
    pub(super) fn fit(&mut self, label: &str, about: &str) -> Option<Fit> {
        let (mut first, mut second) = (Vec::new(), Vec::new());
        let label = Utf32Str::new(label, &mut first);
        let about = Utf32Str::new(about, &mut second);
        let mut fit = Fit::default();
        let mut letters = Vec::new();
        for ([fuzzy, whole], count) in self.words.iter().zip(&self.letters) {
            let before = letters.len();
            let found = fuzzy.indices(label, &mut self.matcher, &mut letters).map(u32::from);
            match found.filter(|score| *score >= LEAST * count) {
                Some(score) => fit.score += score + NAMED,
                None => {
                    letters.truncate(before);
                    fit.score += u32::from(whole.score(about, &mut self.matcher)?);
                }
            }
        }
        letters.sort_unstable();
        letters.dedup();
        fit.letters = letters.into_iter().map(|letter| letter as usize).collect();
        Some(fit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_in_order_are_found_and_together_they_count_most() {
        let fit = |query: &str, label: &str| Query::new(query).fit(label, "about the line");
        assert_eq!(fit("zom", "zoom").map(|f| f.letters), Some(vec![0, 1, 3]));
        assert_eq!(fit("Henon", "Hénon").map(|f| f.letters), Some(vec![0, 1, 2, 3, 4]));
        assert_eq!(fit("rp", "reset, then play").map(|f| f.letters), Some(vec![0, 12]));
        assert_eq!(fit("ene", "let time run slower"), None, "chance is not meant");
        assert_eq!(fit("abo", "zoom").map(|f| f.letters), Some(vec![]), "told of, not named");
        assert_eq!(fit("zoom xyz", "zoom"), None);
        let score = |label| fit("ene", label).map_or(0, |f| f.score);
        assert!(score("drift of energy") > score("ten lines, even"));
        assert_eq!(fit("", "zoom"), Some(Fit::default()));
    }
}
