//! Names in the field's words: none of the private words that `CONTRIBUTING.md` replaces is part of a name in the source.

use std::collections::BTreeSet;
use std::path::Path;

use crate::honest::{plain, sources};

/// Words of which no name is made: each has a standard one.
const PRIVATE: [&str; 23] = [
    "blow",
    "calendar",
    "chronicle",
    "desk",
    "fault",
    "flaw",
    "happening",
    "haste",
    "keeper",
    "mistake",
    "needle",
    "news",
    "occasion",
    "occasions",
    "seat",
    "spot",
    "spots",
    "strike",
    "struck",
    "tape",
    "whereabouts",
    "wish",
    "wishes",
];

/// Names that contain one and are standard: a solution blows up.
const STANDARD: [&str; 3] = ["blow_up", "BlowUp", "BLOW_UP"];

/// The words of a name: `is_blowUp` has is, blow and up.
fn words(name: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let mut was_lower = false;
    for c in name.chars() {
        let begins = c.is_uppercase() && was_lower || words.is_empty();
        if c == '_' || begins {
            words.push(String::new());
        }
        if c != '_' {
            words.last_mut().expect("a word").extend(c.to_lowercase());
        }
        was_lower = c.is_lowercase();
    }
    words
}

/// The names in code of which a private word is a part.
fn private(code: &str) -> BTreeSet<String> {
    let names = code.split(|c: char| !(c.is_alphanumeric() || c == '_'));
    let is_private = |name: &&str| {
        let name = STANDARD.iter().fold((*name).to_owned(), |name, part| name.replace(part, ""));
        words(&name).iter().any(|word| PRIVATE.contains(&word.as_str()))
    };
    names.filter(is_private).map(str::to_owned).collect()
}

#[test]
fn names_are_made_of_the_words_of_the_field() {
    let mut texts = Vec::new();
    sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), &mut texts);
    assert!(texts.len() > 1000);
    let found = texts.iter().flat_map(|(path, text)| {
        private(&plain(text)).into_iter().map(|name| format!("{}: {name}", path.display()))
    });
    assert_eq!(found.collect::<Vec<_>>(), Vec::<String>::new());
}

#[test]
fn private_words_are_found_in_names_of_every_form() {
    let code = "struct ImpulseKeeper; fn is_struck(spot: f64) -> BlowUp { let blow_up = 1; SPOTS }";
    let found: Vec<String> = private(code).into_iter().collect();
    assert_eq!(found, ["ImpulseKeeper", "SPOTS", "is_struck", "spot"]);
}
