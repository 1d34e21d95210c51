//! The names of the constants that a search found: I1, I2, …, or another letter where the file has names like these.
//!
//! In: the equations' pool, the names of what is known, a count. Out: names as in files. Never here: how they are shown.

use super::known::KnownConstant;
use crate::expr::{Pool, plain_name};
use crate::model::Model;

/// The letters in the order in which they are tried.
const LETTERS: [char; 8] = ['I', 'C', 'K', 'F', 'G', 'Q', 'U', 'W'];

/// A name for each of the constants found. They share a letter that nothing in the file has with a number, neither as it
/// is written nor as it is shown: beside moments of inertia I₁ and I₃ a constant I₂ would be taken for another one.
pub fn found_names(
    model: &Model,
    pool: &Pool,
    known: &[KnownConstant],
    count: usize,
) -> Vec<String> {
    let infos = pool.symbol_infos();
    let symbols = infos.iter().flat_map(|info| [info.name.as_str(), info.unicode.as_str()]);
    let definitions = model.definitions.iter().map(|(name, _)| name.as_str());
    let observables = model.observables.iter().map(|observable| observable.name.as_str());
    let constants = known.iter().map(|known| known.name.as_str());
    let taken: Vec<String> = symbols
        .chain(definitions)
        .chain(observables)
        .chain(constants)
        .map(|name| plain_name(name).unwrap_or_else(|| name.to_owned()))
        .collect();
    let is_free = |letter: &char| !taken.iter().any(|name| is_numbered(name, *letter));
    let letter = LETTERS.into_iter().find(is_free).unwrap_or(LETTERS[0]);
    (1..=count).map(|number| format!("{letter}{number}")).collect()
}

/// Whether a name is this letter with a number: `I1`, `I_1`.
fn is_numbered(name: &str, letter: char) -> bool {
    let number = name.strip_prefix(letter).map(|rest| rest.strip_prefix('_').unwrap_or(rest));
    number.is_some_and(|n| !n.is_empty() && n.chars().all(|c| c.is_ascii_digit()))
}

#[cfg(test)]
mod tests {
    use super::is_numbered;

    #[test]
    fn a_letter_with_a_number_is_no_other_name() {
        for (name, numbered) in [
            ("I1", true),
            ("I_12", true),
            ("I", false),
            ("I_zz", false),
            ("I1z", false),
            ("J1", false),
        ] {
            assert_eq!(is_numbered(name, 'I'), numbered, "{name}");
        }
    }
}
