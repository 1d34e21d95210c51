//! Fuzzy search: how well a query matches the texts of a line.
//!
//! In: the query, the texts of a line. Out: a score and the letters to highlight. Never here: which lines there
//! are.
//!
//! Each word is matched separately, and scored by nucleo's matcher: starts of words count most, then consecutive
//! letters; gaps reduce the score. Letters scattered over a text match by chance (a long text contains almost any
//! sequence), so a match must reach a minimum score per letter, and its letters must be close together or be
//! initials. Both are compared as a keyboard spells them: `theta` finds θ, and `x2` finds x².

use nucleo_matcher::pattern::{Atom, AtomKind, CaseMatching, Normalization};
use nucleo_matcher::{Config, Matcher, Utf32Str};

use crate::expr::spelt;

/// The minimum score of a match per letter. A letter at the start of a word scores 24 or more, one that follows
/// another match 16 and a bonus; each gap costs some.
const LEAST: u32 = 24;

/// A bonus for a match at the start of a text, at the end of a word, and of a whole text.
const BEGINS: u32 = 8;
const ENDS: u32 = 4;
const ALL: u32 = 12;

/// A penalty for a name that is not shown first.
const SECOND: u32 = 4;

/// The divisor of the score of a match in a description.
const DESCRIBED: u32 = 4;

pub(super) struct Query {
    words: Vec<QueryWord>,
    matcher: Matcher,
}

/// A word, matched with gaps in names and without gaps in descriptions.
struct QueryWord {
    fuzzy: Atom,
    plain: Atom,
    letters: u32,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Texts<'a> {
    /// The label of the line; its matched letters are highlighted.
    pub label: &'a str,
    /// Other names of it.
    pub names: &'a [&'a str],
    /// Its descriptions.
    pub about: &'a [&'a str],
}

/// How a line matches a query.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FuzzyMatch {
    /// The score; higher is better.
    pub score: u32,
    /// The indices of the matched letters of the label, in rising order.
    pub letters: Vec<usize>,
}

impl Query {
    pub(super) fn new(text: &str) -> Self {
        let words = text.split_whitespace().map(QueryWord::new).collect();
        Self { words, matcher: Matcher::new(Config::DEFAULT) }
    }

    /// Returns how a line matches, if each word occurs somewhere in its texts.
    pub(super) fn fit(&mut self, texts: Texts<'_>) -> Option<FuzzyMatch> {
        let mut fit = FuzzyMatch::default();
        for word in &self.words {
            let found = word.fit(texts, &mut self.matcher)?;
            fit.score += found.score;
            fit.letters.extend(found.letters);
        }
        fit.letters.sort_unstable();
        fit.letters.dedup();
        Some(fit)
    }
}

impl QueryWord {
    fn new(word: &str) -> Self {
        let word = &*in_letters(word);
        let atom = |kind| Atom::new(word, CaseMatching::Ignore, Normalization::Smart, kind, false);
        let letters = word.chars().count() as u32;
        Self { fuzzy: atom(AtomKind::Fuzzy), plain: atom(AtomKind::Substring), letters }
    }

    /// Returns the word's score in these texts, and its letters in the label.
    fn fit(&self, texts: Texts<'_>, matcher: &mut Matcher) -> Option<FuzzyMatch> {
        let label = self.named(texts.label, matcher);
        let names = texts.names.iter().filter_map(|name| {
            let score = self.named(name, matcher)?.score.saturating_sub(SECOND);
            Some(FuzzyMatch { score, letters: Vec::new() })
        });
        // The label wins a tie, and its letters are highlighted even if another name fits better.
        let letters = label.as_ref().map(|fit| fit.letters.clone()).unwrap_or_default();
        let named = label.into_iter().chain(names);
        let best = named.reduce(|a, b| if b.score > a.score { b } else { a });
        best.map(|fit| FuzzyMatch { letters, ..fit }).or_else(|| {
            let described = texts.about.iter().filter_map(|text| self.described(text, matcher));
            described
                .max()
                .map(|score| FuzzyMatch { score: score / DESCRIBED, letters: Vec::new() })
        })
    }

    /// Returns the word's score in a name, and the indices of its letters.
    fn named(&self, text: &str, matcher: &mut Matcher) -> Option<FuzzyMatch> {
        let (mut buffer, mut places) = (Vec::new(), Vec::new());
        let spelling = Spelling::of(text);
        let text = Utf32Str::new(&spelling.letters, &mut buffer);
        let score = u32::from(self.fuzzy.indices(text, matcher, &mut places)?);
        let (first, last) = (*places.first()?, *places.last()?);
        let parts = |place: u32| place >= text.len() as u32 || !text.get(place).is_alphanumeric();
        let starts = |place: &u32| *place == 0 || parts(*place - 1);
        let spread = last - first + 1;
        let near = spread <= 2 * self.letters || places.iter().all(starts);
        let together = self.letters >= 2 && spread == self.letters;
        if !(together || near && score >= LEAST * self.letters) {
            return None;
        }
        let more = [
            (first == 0, BEGINS),
            (parts(last + 1), ENDS),
            (spread == self.letters && text.len() == places.len(), ALL),
        ];
        let more: u32 = more.into_iter().filter_map(|(is, more)| is.then_some(more)).sum();
        let letters = spelling.characters(&places)?;
        Some(FuzzyMatch { score: score + more, letters })
    }

    /// Returns the word's score in a description, where a word must begin with it, by two letters at least: otherwise
    /// `pend` would be found in what depends on something.
    fn described(&self, text: &str, matcher: &mut Matcher) -> Option<u32> {
        let (mut buffer, mut places) = (Vec::new(), Vec::new());
        let spelling = Spelling::of(text);
        let text = Utf32Str::new(&spelling.letters, &mut buffer);
        let score = u32::from(self.plain.indices(text, matcher, &mut places)?);
        let first = *places.iter().min()?;
        let begins = first == 0 || !text.get(first - 1).is_alphanumeric();
        (begins && self.letters > 1).then_some(score)
    }
}

/// A text in the letters of a keyboard, and the character that each belongs to.
struct Spelling {
    letters: String,
    /// Empty if each letter is a character.
    of: Vec<usize>,
}

impl Spelling {
    fn of(text: &str) -> Spelling {
        if text.is_ascii() {
            return Spelling { letters: text.to_owned(), of: Vec::new() };
        }
        let spelt = spelt(text);
        let of = spelt
            .iter()
            .enumerate()
            .flat_map(|(place, letters)| letters.iter().map(move |_| place));
        Spelling { of: of.collect(), letters: spelt.concat().into_iter().collect() }
    }

    /// The characters that some letters belong to, in rising order. A match begins no character within its letters:
    /// `eta` is not in θ.
    fn characters(&self, places: &[u32]) -> Option<Vec<usize>> {
        let mut places: Vec<usize> = places.iter().map(|place| *place as usize).collect();
        places.sort_unstable();
        if self.of.is_empty() {
            return Some(places);
        }
        let mut characters: Vec<usize> = Vec::new();
        for (index, place) in places.iter().enumerate() {
            let character = *self.of.get(*place)?;
            let goes_on = index > 0 && places[index - 1] + 1 == *place;
            if characters.last() != Some(&character) {
                let is_first = *place == 0 || self.of[*place - 1] != character;
                let is_sign = |c: Option<char>| c.is_some_and(|c| !c.is_alphanumeric());
                // the caret of an exponent need not be typed
                if !is_first && !is_sign(self.letters.chars().nth(*place - 1)) {
                    return None;
                }
                characters.push(character);
            } else if !goes_on {
                return None;
            }
        }
        Some(characters)
    }
}

/// A word as a keyboard spells it; what has no spelling stays.
fn in_letters(word: &str) -> String {
    if word.is_ascii() { word.to_owned() } else { spelt(word).concat().into_iter().collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fit(query: &str, label: &str) -> Option<FuzzyMatch> {
        Query::new(query).fit(Texts { label, names: &["second"], about: &["about the line"] })
    }

    #[test]
    fn letters_are_found_together_as_initials_or_within_a_word() {
        let letters = |query, label| fit(query, label).map(|f| f.letters);
        assert_eq!(letters("zom", "zoom"), Some(vec![0, 1, 3]));
        assert_eq!(letters("Henon", "Hénon–Heiles"), Some(vec![0, 1, 2, 3, 4]));
        assert_eq!(letters("heiles", "Hénon–Heiles"), Some((6..12).collect()));
        assert_eq!(letters("dp", "Driven damped pendulum"), Some(vec![7, 14]));
        assert_eq!(letters("ene", "pause the motion here"), None, "chance is not meant");
        assert_eq!(letters("ene", "everyone"), None, "nor in one long word");
        assert_eq!(letters("m", "Sum"), None, "one letter begins a word");
        assert_eq!(letters("abo", "zoom"), Some(vec![]), "reported, not named");
        assert_eq!(letters("sec", "zoom"), Some(vec![]), "its second name");
        assert_eq!(letters("zoom xyz", "zoom"), None);
        assert_eq!(fit("", "zoom"), Some(FuzzyMatch::default()));
    }

    #[test]
    fn signs_are_found_as_they_are_spelt() {
        let letters = |query, label| fit(query, label).map(|f| f.letters);
        assert_eq!(letters("theta", "θ₁′ against t"), Some(vec![0]));
        assert_eq!(letters("th", "θ"), Some(vec![0]), "while it is typed");
        assert_eq!(letters("theta1", "θ₁"), Some(vec![0, 1]));
        assert_eq!(letters("θ", "θ"), Some(vec![0]));
        assert_eq!(letters("θ", "theta"), Some((0..5).collect()));
        assert_eq!(letters("eta", "θ"), None, "no sign is found in part");
        assert_eq!(letters("eta", "η"), Some(vec![0]));
        assert_eq!(letters("x2", "x² + y²"), Some(vec![0, 1]));
        assert_eq!(letters("x^2", "x² + y²"), Some(vec![0, 1]));
        assert_eq!(letters("omega", "energy, ω"), Some(vec![8]));
        assert_eq!(letters("poincaré", "Poincare"), Some((0..8).collect()));
        let described = Query::new("theta").fit(Texts { about: &["over θ"], ..Texts::default() });
        assert!(described.is_some());
    }

    /// A name that is all of a row comes before the same word in another row's title.
    #[test]
    fn a_name_comes_before_what_speaks_of_it() {
        let score = |label| fit("theta", label).map_or(0, |f| f.score);
        assert!(score("θ") > score("potential over theta"));
        assert!(score("θ") > score("θ′") && score("θ′") > score("potential over θ"));
    }

    #[test]
    fn the_nearer_to_the_beginning_the_better() {
        let score = |label| fit("ene", label).map_or(0, |f| f.score);
        let order = ["ene", "energy", "drift of energy", "engine", "scene", "nothing"];
        for pair in order.windows(2) {
            assert!(score(pair[0]) > score(pair[1]), "{pair:?}");
        }
        let score = |query, label| fit(query, label).map_or(0, |f| f.score);
        assert!(score("type l", "type l, length") > score("type l", "type it, 2*l"));
        let described = |query| fit(query, "zoom").map_or(0, |f| f.score);
        assert!(described("second") > described("about"), "a name counts more than what is said");
        assert!(described("line") > 0 && described("li") > 0);
        assert_eq!([described("ine"), described("l")], [0, 0], "a word begins with it");
    }
}
