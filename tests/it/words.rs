//! Names in the field's words: none of the private words that `CONTRIBUTING.md` replaces is part of a name in the source.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use crate::honest::{plain, sources};
use crate::nonempty;

/// Words of which no name is made: each has a standard one.
const PRIVATE: &str = "\
    aside beat blow calendar chronicle clearance desk edition facts fault flaw foretold gone grip \
    happening haste held hold keeper kept kin laboratory laid likeness listen look looked looks mistake \
    needle news obey occasion occasions owed parted patience refusal said seat settle shelf sought spot \
    spots strange strike struck stubborn tally tape tell told twin unready walk whereabouts wish wishes";

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
        words(&name).iter().any(|word| PRIVATE.split(' ').any(|private| private == word))
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

/// Types of which there are several of one name: the arguments of each command, and what stands for machine code where there is
/// none.
const SEVERAL: [&str; 3] = ["Arguments", "CodeCache", "CompiledGrowth"];

/// The names of the types that a source declares outside of functions and tests.
fn types(code: &str) -> impl Iterator<Item = &str> {
    let lines = code.lines().filter(|line| line.starts_with(|c: char| c.is_alphabetic()));
    lines.filter_map(|line| {
        let words = line.split(|c: char| !(c.is_alphanumeric() || c == '_'));
        let words = words.take_while(|word| *word != "fn" && *word != "impl");
        words.skip_while(|word| !["struct", "enum", "trait", "type"].contains(word)).nth(1)
    })
}

#[test]
fn types_have_names_of_their_own() {
    let mut texts = Vec::new();
    sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), &mut texts);
    let mut declared: BTreeMap<String, usize> = BTreeMap::new();
    for (_, text) in nonempty(texts) {
        for name in types(&plain(&text)) {
            *declared.entry(name.to_owned()).or_default() += 1;
        }
    }
    let twice = declared.into_iter().filter(|(_, count)| *count > 1).map(|(name, _)| name);
    assert_eq!(twice.collect::<Vec<_>>(), SEVERAL);
}

#[test]
fn types_are_found_by_their_declarations() {
    let code = "pub struct A;\npub(super) enum B {\n    C,\n}\nfn struct_of(type_: u8) {}\n\
                pub trait D<E> {\n    type F;\n}\ntype G = A;\nimpl D<u8> for A {}\n";
    assert_eq!(types(code).collect::<Vec<_>>(), ["A", "B", "D", "G"]);
}
