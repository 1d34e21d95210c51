//! The nearest known word to a misspelt one.

/// Returns the candidate closest to a misspelt word, if one is close enough: at most a third of the
/// letters differ, and not all of them, or one is in the wrong place. Words of more than 64 letters are not compared.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let folded = word.to_lowercase();
    let longer = |c: &str| word.chars().count().max(c.chars().count());
    let sorted = |word: &str| {
        let mut letters: Vec<char> = word.to_lowercase().chars().collect();
        letters.sort_unstable();
        letters
    };
    // a letter in the wrong place, as in `tetha`, counts once
    let near = |distance: usize, c: &str| {
        distance <= (longer(c) / 3).max(1) || (distance == 2 && sorted(word) == sorted(c))
    };
    candidates
        .into_iter()
        .filter(|c| longer(c) <= 64)
        .map(|c| (strsim::damerau_levenshtein(&folded, &c.to_lowercase()), c))
        .filter(|&(distance, c)| near(distance, c) && distance < longer(c))
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, c)| c)
}
