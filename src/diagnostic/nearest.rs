//! The nearest known words to a misspelt one.

/// Returns the candidates that are a word with an index, as a list: `L_x`, `L_y` or `L_z` for `L`.
pub fn with_index(word: &str, candidates: &[&str]) -> Option<String> {
    let has_index = |c: &&&str| c.strip_prefix(word).is_some_and(|rest| rest.starts_with('_'));
    let names: Vec<String> =
        candidates.iter().filter(has_index).take(3).map(|c| format!("`{c}`")).collect();
    let (last, others) = names.split_last()?;
    Some(if others.is_empty() { last.clone() } else { format!("{} or {last}", others.join(", ")) })
}

/// Returns the candidate closest to a misspelt word, if one is close enough: at most a third of the
/// letters differ, and not all of them, or one is in the wrong place; or if the word is an abbreviation of three letters or
/// more, as `params`. Words of more than 64 letters are not compared.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let folded = word.to_lowercase();
    let stem = folded.trim_end_matches('s');
    let mut abbreviated = None;
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
    let found = candidates
        .into_iter()
        .filter(|c| longer(c) <= 64)
        .inspect(|c| {
            if stem.chars().count() >= 3 && c.to_lowercase().starts_with(stem) {
                abbreviated.get_or_insert(*c);
            }
        })
        .map(|c| (strsim::damerau_levenshtein(&folded, &c.to_lowercase()), c))
        .filter(|&(distance, c)| near(distance, c) && distance < longer(c))
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, c)| c);
    // `init` is `initial`, although `unit` is one letter away
    found.filter(|c| c.to_lowercase().starts_with(stem)).or(abbreviated).or(found)
}
