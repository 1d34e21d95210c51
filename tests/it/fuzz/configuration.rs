//! Configurations: errors lie in the text, and settings can be written and read back.

use std::fmt::Write as _;

use phaselab::diagnostic::Document;
use phaselab::shell::config;

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
        Err(diagnostics) => return are_placed(&document, &diagnostics),
    };
    let mut text = String::new();
    for (name, word) in &options {
        // a switch is written without quotes
        let flag = ["true", "false"].contains(&word.as_str());
        let word = if flag { word.clone() } else { toml::Value::from(word.as_str()).to_string() };
        writeln!(text, "{name} = {word}").unwrap();
    }
    let again = config::read(&Document::new("again.toml", text.as_str()));
    let again = again.unwrap_or_else(|diagnostics| panic!("{text}: {diagnostics:?}"));
    assert_eq!(options, again, "{text}");
}
