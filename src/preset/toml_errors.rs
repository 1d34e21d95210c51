//! TOML's own grammar: text in, tables with spans out. Its mistakes are said in our words, and as
//! much of the file is saved as can be, so that the other mistakes can be reported as well.

use toml::Spanned;
use toml::de::{DeTable, DeValue, Error};

use crate::diagnostic::Diagnostic;
use crate::diagnostic::Diagnostics;
use crate::diagnostic::SourceRange;
use crate::printable;

/// The file as a table; what is not TOML is left out or patched, after a complaint.
pub(super) fn parse<'f>(text: &'f str, mistakes: &mut Diagnostics) -> Spanned<DeTable<'f>> {
    let (table, errors) = DeTable::parse_recoverable(text);
    let mut errors: Vec<(SourceRange, &Error)> =
        errors.iter().map(|error| (error.span().unwrap_or(0..0), error)).collect();
    errors.sort_by_key(|(place, _)| place.start);
    for (place, error) in errors {
        // once the way is lost, what follows is mostly its echo
        if mistakes.lost_track() {
            break;
        }
        let there = text.get(place.clone()).unwrap_or("");
        let (what, loses) = told(error.message(), there);
        let mut mistake = Diagnostic::error(place.clone(), what.message);
        mistake.help = what.help;
        mistakes.push(mistake);
        match loses {
            Loses::Key => mistakes.lose_key(there.trim_matches(['"', '\''])),
            Loses::Value => mistakes.lose_value(place),
            Loses::Track => mistakes.lose_track(),
        }
    }
    steering(table.get_ref(), mistakes);
    table
}

/// Complains of every name and text in which a character would steer the terminal that shows it; no more is said of it.
fn steering(table: &DeTable<'_>, mistakes: &mut Diagnostics) {
    for (key, value) in table {
        if let Some(c) = key.get_ref().chars().find(|&c| printable::is_steering(c)) {
            let message = format!("the character U+{:04X} may not stand in a name", c as u32);
            mistakes.push(Diagnostic::error(key.span(), message));
            mistakes.lose_key(key.get_ref());
            mistakes.lose_value(key.span());
        }
        steering_value(value, mistakes);
    }
}

fn steering_value(value: &Spanned<DeValue<'_>>, mistakes: &mut Diagnostics) {
    match value.get_ref() {
        DeValue::String(text) => {
            let layout = |c: char| matches!(c, '\n' | '\r' | '\t');
            if let Some(c) = text.chars().find(|&c| printable::is_steering(c) && !layout(c)) {
                let message = format!("the character U+{:04X} may not stand in a text", c as u32);
                mistakes.push(Diagnostic::error(value.span(), message));
                mistakes.lose_value(value.span());
            }
        }
        DeValue::Array(items) => items.iter().for_each(|item| steering_value(item, mistakes)),
        DeValue::Table(table) => steering(table, mistakes),
        _ => {}
    }
}

/// What is not there to be checked after a slip.
#[derive(Clone, Copy)]
enum Loses {
    /// The key that stands at the place, with its value.
    Key,
    /// What stands at the place.
    Value,
    /// Whatever follows.
    Track,
}

/// A slip in our words.
struct Told {
    message: String,
    help: Option<String>,
}

/// What the reader of TOML says, by its first words, and what we say for it.
const KNOWN: [(&str, &str, Loses); 22] = [
    ("invalid basic string", "this text in quotes is not closed on its line", Loses::Value),
    ("invalid literal string", "this text in quotes is not closed on its line", Loses::Value),
    ("invalid multi-line", "this text of several lines is never closed", Loses::Track),
    ("missing key for inline table element", "before here a `}` is missing", Loses::Track),
    ("missing comma between key-value pairs", "before here a `,` or `}` is missing", Loses::Track),
    ("unclosed inline table", "before here a `}` is missing", Loses::Track),
    ("missing comma between array elements", "before here a `,` or `]` is missing", Loses::Track),
    ("unexpected `=` in array", "before here a `]` is missing", Loses::Track),
    ("unclosed array table", "before here a `]]` is missing", Loses::Track),
    ("unclosed array", "before here a `]` is missing", Loses::Track),
    ("unclosed table", "before here a `]` is missing", Loses::Track),
    ("key with no value", "a key is followed by `=` and its value", Loses::Track),
    ("unexpected key or value", "nothing more may stand on this line", Loses::Track),
    ("extra `=`", "one `=` too many", Loses::Track),
    ("cannot recurse further", "tables and lists are nested too deep", Loses::Track),
    ("recursion limit", "tables and lists are nested too deep", Loses::Track),
    ("missing escaped value", "no such escape", Loses::Value),
    ("too few unicode value digits", "this escape has too few digits", Loses::Value),
    ("unexpected leading zero", "a number does not begin with 0", Loses::Value),
    ("`_` may only go between digits", "in a number `_` stands between digits", Loses::Value),
    ("invalid mantissa", "a number of TOML has digits on both sides of its point", Loses::Value),
    ("invalid fraction", "a number of TOML has digits on both sides of its point", Loses::Value),
];

/// A slip of TOML's grammar in our words, and what is lost by it.
fn told(said: &str, there: &str) -> (Told, Loses) {
    let tell = |message: &str, help: &str, loses| {
        let help = (!help.is_empty()).then(|| help.to_owned());
        (Told { message: message.to_owned(), help }, loses)
    };
    if said == "duplicate key" {
        let key = there.trim_matches(['"', '\'']);
        return tell(&format!("`{key}` is given twice"), "keep one of them", Loses::Key);
    }
    // a word that begins as `nan` does
    let word = said.starts_with("invalid float") && there.starts_with(char::is_alphabetic);
    if word || said.starts_with("string values must be quoted") {
        if there.is_empty() {
            return tell("a value is missing here", "", Loses::Value);
        }
        let help = format!("write \"{there}\"");
        return tell("text and expressions stand in quotes", &help, Loses::Value);
    }
    if said.starts_with("invalid unquoted key") {
        let help = "letters to be shown are given by `symbol`: theta = { symbol = \"θ\" }";
        let message = "a key is made of ASCII letters, digits, `_` and `-`";
        return tell(message, help, Loses::Value);
    }
    match KNOWN.iter().find(|(known, ..)| said.starts_with(known)) {
        Some((known, message, loses)) => {
            let help = match *known {
                "missing escaped value" => "write `\\\\` for a backslash, or quote with '...'",
                "invalid mantissa" | "invalid fraction" => {
                    "write 0.5 and 1.0, or put an expression in quotes"
                }
                _ => "",
            };
            tell(message, help, *loses)
        }
        None => tell(&format!("this is not TOML: {said}"), "", Loses::Track),
    }
}
