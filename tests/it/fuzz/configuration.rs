//! Configurations: mistakes lie in the text, and what is asked for can be written and read again.

use std::fmt::Write as _;

use phaselab::diagnostic::Document;
use phaselab::shell::config;
use phaselab::shell::options::OPTIONS;

use super::preset::are_placed;

pub(crate) const WORDS: &[&str] = &[
    "fps = 30\n",
    "theme = \"dark\"\n",
    "color = 256\n",
    "glyphs = \"ascii\"\n",
    "mouse = true\n",
    "=",
    "\"",
    "\n",
    "auto",
    "[",
    "]",
    "#",
    "true",
    "'''",
    ".",
];

pub(crate) fn check(bytes: &[u8]) {
    let document = Document::from_bytes("config.toml", bytes);
    let options = match config::read(&document) {
        Ok(options) => options,
        Err(mistakes) => return are_placed(&document, &mistakes),
    };
    let mut text = String::new();
    for choice in OPTIONS {
        if let Some(word) = options.get(choice.name) {
            // a switch is written without quotes
            let flag = ["true", "false"].contains(&word);
            let word = if flag { word.to_owned() } else { toml::Value::from(word).to_string() };
            writeln!(text, "{} = {word}", choice.name).unwrap();
        }
    }
    let again = config::read(&Document::new("again.toml", text.as_str()));
    let again = again.unwrap_or_else(|mistakes| panic!("{text}: {mistakes:?}"));
    for choice in OPTIONS {
        assert_eq!(options.get(choice.name), again.get(choice.name), "{text}");
    }
}
