//! Search by a few letters: how well what is typed fits the texts of a line.
//!
//! In: what is typed, the texts of a line. Out: a score and the letters to be marked. Never here: which lines there are.
//!
//! Each word is sought by itself. It fits best where a text begins with it, then where a word does, then inside a word;
//! initials (`dp`: Double pendulum) and gaps within one word (`zom`: zoom) come after these, and last what is only said
//! about the line. Letters scattered over a text are chance: in a long one almost any stand in order.

use nucleo_matcher::chars::{normalize, to_lower_case};

/// What a word is worth where it is found, the best place first.
const BEGINS: u32 = 500;
const STARTS_A_WORD: u32 = 400;
const INSIDE: u32 = 200;
const INITIALS: u32 = 150;
const WITH_GAPS: u32 = 100;
const SAID: u32 = 60;
const SAID_INSIDE: u32 = 30;

/// More for a whole word, and for all of the text.
const WHOLE: u32 = 20;
const ALL: u32 = 80;

/// More where all that is typed stands together.
const TOGETHER: u32 = 50;

/// Less for a name that is not shown first.
const SECOND: u32 = 10;

/// A word with gaps has at least so many letters, and is spread over at most twice as many.
const LEAST: usize = 3;

/// What is typed, ready to be sought.
pub(super) struct Query(Vec<Word>);

/// A word in small letters without accents.
struct Word(Vec<char>);

/// The texts of a line.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Texts<'a> {
    /// What the line is called; its letters are marked.
    pub label: &'a str,
    /// What else it is called.
    pub names: &'a [&'a str],
    /// What is said about it.
    pub about: &'a [&'a str],
}

/// How a line fits what is typed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Fit {
    /// The greater, the better.
    pub score: u32,
    /// The places of the letters of the label that were found, in rising order.
    pub messages: Vec<usize>,
}

impl Query {
    pub(super) fn new(text: &str) -> Self {
        Self(text.split_whitespace().map(|word| Word(folded(word))).collect())
    }

    /// How a line fits, if each word stands somewhere in its texts.
    pub(super) fn fit(&self, texts: Texts<'_>) -> Option<Fit> {
        let mut fit = Fit::default();
        for word in &self.0 {
            let (score, messages) = word.fit(texts)?;
            fit.score += score;
            fit.messages.extend(messages);
        }
        if self.0.len() > 1 {
            let spaced: Vec<&[char]> = self.0.iter().map(|word| word.0.as_slice()).collect();
            let all = Word(spaced.join(&' '));
            let label = folded(texts.label);
            let at = all.whole(&label).find_map(|place| all.worth(&label, place));
            fit.score += at.map_or(0, |_| TOGETHER);
        }
        fit.messages.sort_unstable();
        fit.messages.dedup();
        Some(fit)
    }
}

impl Word {
    /// What it is worth in these texts, and its letters in the label.
    fn fit(&self, texts: Texts<'_>) -> Option<(u32, Vec<usize>)> {
        let second = texts.names.iter().filter_map(|name| {
            let (score, _) = self.named(name)?;
            Some((score.saturating_sub(SECOND), Vec::new()))
        });
        let second = second.max_by_key(|(score, _)| *score);
        let both = [self.named(texts.label), second].into_iter().flatten();
        both.reduce(|a, b| if b.0 > a.0 { b } else { a }).or_else(|| {
            let said = texts.about.iter().filter_map(|text| self.said(text));
            said.max().map(|score| (score, Vec::new()))
        })
    }

    /// What it is worth in a name, and where its letters stand.
    fn named(&self, text: &str) -> Option<(u32, Vec<usize>)> {
        let messages = folded(text);
        let inside = (self.0.len() >= 2).then_some(INSIDE);
        let whole = self.whole(&messages).max_by_key(|place| self.worth(&messages, *place));
        let whole = whole.and_then(|place| {
            let score = self.worth(&messages, place).or(inside)?;
            Some((score, (place..place + self.0.len()).collect()))
        });
        whole.or_else(|| self.initials(&messages)).or_else(|| self.with_gaps(&messages))
    }

    /// What it is worth in what is said about a line.
    fn said(&self, text: &str) -> Option<u32> {
        let messages = folded(text);
        let inside = (self.0.len() >= LEAST).then_some(SAID_INSIDE);
        let worth =
            |place| if self.worth(&messages, place).is_some() { Some(SAID) } else { inside };
        self.whole(&messages).filter(|_| self.0.len() >= 2).filter_map(worth).max()
    }

    /// Where it stands without gaps.
    fn whole<'a>(&'a self, messages: &'a [char]) -> impl Iterator<Item = usize> {
        let windows = messages.windows(self.0.len()).enumerate();
        windows.filter(|(_, window)| *window == self.0).map(|(place, _)| place)
    }

    /// What it is worth at the beginning of a word; nothing elsewhere.
    fn worth(&self, messages: &[char], place: usize) -> Option<u32> {
        let begins = place == 0 || !messages[place - 1].is_alphanumeric();
        let next = messages.get(place + self.0.len());
        let whole = next.is_none_or(|next| !next.is_alphanumeric());
        let all = self.0.len() == messages.len();
        let place = if place == 0 { BEGINS } else { STARTS_A_WORD };
        let extra = u32::from(whole) * WHOLE + u32::from(all) * ALL;
        begins.then_some(place + extra)
    }

    /// Its letters as the first ones of words that follow each other.
    fn initials(&self, messages: &[char]) -> Option<(u32, Vec<usize>)> {
        let starts: Vec<usize> = words(messages).map(|(start, _)| start).collect();
        let firsts: Vec<char> = starts.iter().map(|start| messages[*start]).collect();
        let place = self.whole(&firsts).next().filter(|_| self.0.len() >= 2)?;
        Some((INITIALS, starts[place..place + self.0.len()].to_vec()))
    }

    /// Its letters within one word, from the first on.
    fn with_gaps(&self, messages: &[char]) -> Option<(u32, Vec<usize>)> {
        words(messages).filter(|_| self.0.len() >= LEAST).find_map(|(start, end)| {
            let end = end.min(start + 2 * self.0.len());
            let mut places = start..end;
            let place = |letter: &char| places.find(|place| messages[*place] == *letter);
            let found: Option<Vec<usize>> = self.0.iter().map(place).collect();
            found.filter(|found| found[0] == start).map(|found| (WITH_GAPS, found))
        })
    }
}

/// The letters of a text, small and without accents, one for each.
fn folded(text: &str) -> Vec<char> {
    text.chars().map(|letter| to_lower_case(normalize(letter))).collect()
}

/// Where each word begins and ends.
fn words(messages: &[char]) -> impl Iterator<Item = (usize, usize)> {
    let within = |place: usize| messages.get(place).is_some_and(|c| c.is_alphanumeric());
    let starts = (0..messages.len()).filter(move |p| within(*p) && !(*p > 0 && within(p - 1)));
    let end = move |start| (start..messages.len()).find(|p| !within(*p)).unwrap_or(messages.len());
    starts.map(move |start| (start, end(start)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fit(query: &str, label: &str) -> Option<Fit> {
        Query::new(query).fit(Texts { label, names: &["second"], about: &["about the line"] })
    }

    #[test]
    fn letters_are_found_together_as_initials_or_within_a_word() {
        let messages = |query, label| fit(query, label).map(|f| f.messages);
        assert_eq!(messages("zom", "zoom"), Some(vec![0, 1, 3]));
        assert_eq!(messages("Henon", "Hénon–Heiles"), Some(vec![0, 1, 2, 3, 4]));
        assert_eq!(messages("heiles", "Hénon–Heiles"), Some((6..12).collect()));
        assert_eq!(messages("dp", "Driven damped pendulum"), Some(vec![7, 14]));
        assert_eq!(messages("rp", "reset, then play"), None, "a word stands between");
        assert_eq!(messages("ene", "let time run slower"), None, "chance is not meant");
        assert_eq!(messages("ene", "everyone"), None, "nor in one long word");
        assert_eq!(messages("m", "Sum"), None, "one letter begins a word");
        assert_eq!(messages("abo", "zoom"), Some(vec![]), "told of, not named");
        assert_eq!(messages("sec", "zoom"), Some(vec![]), "its second name");
        assert_eq!(messages("zoom xyz", "zoom"), None);
        assert_eq!(fit("", "zoom"), Some(Fit::default()));
    }

    #[test]
    fn the_nearer_to_the_beginning_the_better() {
        let score = |label| fit("ene", label).map_or(0, |f| f.score);
        let order = ["ene", "ene in", "energy", "drift of energy", "scene", "engine", "nothing"];
        for pair in order.windows(2) {
            assert!(score(pair[0]) > score(pair[1]), "{pair:?}");
        }
        let score = |query, label| fit(query, label).map_or(0, |f| f.score);
        assert!(score("type l", "type l, length") > score("type l", "type it, 2*l"));
        let said = |query| fit(query, "zoom").map_or(0, |f| f.score);
        assert!(said("second") > said("about"), "a name counts more than what is said");
        assert!(said("line") > said("ine"));
    }
}
