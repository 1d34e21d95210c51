//! TOML's own grammar: text in, tables with spans out. Errors are reported in our own words, and as much of the file
//! as possible is recovered, so that its other errors can be reported as well.
//!
//! The message for an error depends on its context (between tokens, in a key, in a value, in a table), on what was
//! expected there, and on the text at its range; never on the parser's own words.

use toml::Spanned;
use toml::de::{DeTable, DeValue};
use toml_parser::decoder::Encoding;
use toml_parser::parser::{Event, EventKind, RecursionGuard, ValidateWhitespace, parse_document};
use toml_parser::{Expected, ParseError, Source};

use crate::diagnostic::Diagnostic;
use crate::diagnostic::Diagnostics;
use crate::diagnostic::SourceRange;
use crate::expr::{plain_name, unicode_name};
use crate::preset::number_help::{decimal_comma, number_with_unit};
use crate::printable;

/// Parses the file as a table. Whatever is not TOML is reported, then dropped or patched.
pub(super) fn parse<'f>(text: &'f str, diagnostics: &mut Diagnostics) -> Spanned<DeTable<'f>> {
    let (table, errors) = DeTable::parse_recoverable(text);
    let mut slips = if errors.is_empty() { Vec::new() } else { slips(text) };
    // the remaining errors lie beyond the grammar, such as duplicate keys
    let others: Vec<SourceRange> = errors
        .iter()
        .map(|error| error.span().unwrap_or(0..0))
        .filter(|place| slips.iter().all(|slip| slip.place != *place))
        .collect();
    slips.extend(others.into_iter().map(|place| beyond_grammar(text, place)));
    slips.sort_by_key(|slip| slip.place.start);
    // what follows on a line behind a decimal comma follows from it
    for slip in &mut slips {
        if let Some(comma) = comma_in_number_before(text, slip.place.start) {
            let place = comma..comma + 1;
            let decimal = Slip::new(place, "a number has no comma", Loses::Track);
            *slip = Slip { help: decimal_comma(text, comma), ..decimal };
        }
    }
    for Slip { place, message, help, loses } in slips {
        // once the parser has lost track, the errors that follow are mostly consequences
        if diagnostics.lost_track() {
            break;
        }
        let mut diagnostic = Diagnostic::error(place.clone(), message);
        diagnostic.help = help;
        diagnostics.push(diagnostic);
        match loses {
            Loses::Key => diagnostics.lose_key(text[place].trim_matches(['"', '\''])),
            Loses::Value => diagnostics.lose_value(place),
            Loses::Track => diagnostics.lose_track(),
        }
    }
    steering(table.get_ref(), diagnostics);
    table
}

/// The comma of a value such as `1,5` that stands on a line before a place.
fn comma_in_number_before(text: &str, place: usize) -> Option<usize> {
    let before = text.get(..place)?;
    let line = before.rfind('\n').map_or(0, |end| end + 1);
    let commas = before[line..].match_indices(',').map(|(at, _)| line + at);
    let mut decimal = commas.filter(|&comma| {
        let value =
            before[line..comma].trim_end_matches(|c: char| c.is_ascii_digit() || "+-".contains(c));
        value.trim_end().ends_with('=') && decimal_comma(text, comma).is_some()
    });
    decimal.next()
}

/// Reports every name and text that contains a terminal control character; no further errors are reported for it.
fn steering(table: &DeTable<'_>, diagnostics: &mut Diagnostics) {
    for (key, value) in table {
        if let Some(c) = key.get_ref().chars().find(|&c| printable::is_steering(c)) {
            let message = format!("the character U+{:04X} may not be used in a name", c as u32);
            diagnostics.push(Diagnostic::error(key.span(), message));
            diagnostics.lose_key(key.get_ref());
            diagnostics.lose_value(key.span());
        }
        steering_value(value, diagnostics);
    }
}

fn steering_value(value: &Spanned<DeValue<'_>>, diagnostics: &mut Diagnostics) {
    match value.get_ref() {
        DeValue::String(text) => {
            let layout = |c: char| matches!(c, '\n' | '\r' | '\t');
            if let Some(c) = text.chars().find(|&c| printable::is_steering(c) && !layout(c)) {
                let message = format!("the character U+{:04X} may not be used in a text", c as u32);
                diagnostics.push(Diagnostic::error(value.span(), message));
                diagnostics.lose_value(value.span());
            }
        }
        DeValue::Array(items) => items.iter().for_each(|item| steering_value(item, diagnostics)),
        DeValue::Table(table) => steering(table, diagnostics),
        _ => {}
    }
}

/// The part of the file that is lost to an error.
#[derive(Clone, Copy)]
enum Loses {
    /// The key at the range, with its value.
    Key,
    Value,
    /// Everything that follows.
    Track,
}

/// An error in our own words.
struct Slip {
    place: SourceRange,
    message: String,
    help: Option<String>,
    loses: Loses,
}

impl Slip {
    fn new(place: SourceRange, message: impl Into<String>, loses: Loses) -> Slip {
        Slip { place, message: message.into(), help: None, loses }
    }

    fn help(self, help: impl Into<String>) -> Slip {
        Slip { help: Some(help.into()), ..self }
    }
}

/// The greatest nesting of tables and lists, as in the TOML parser.
const DEEPEST: u32 = 80;

/// All errors of the grammar; duplicate keys are not among them.
fn slips(text: &str) -> Vec<Slip> {
    let source = Source::new(text);
    let (mut events, mut errors) = (Vec::<Event>::new(), Vec::new());
    let mut spaces = ValidateWhitespace::new(&mut events, source);
    let mut depth = RecursionGuard::new(&mut spaces, DEEPEST);
    parse_document(&source.lex().into_vec(), &mut depth, &mut errors);
    let mut slips: Vec<Slip> = errors.iter().map(|error| between_tokens(text, error)).collect();
    for event in &events {
        let Some(raw) = source.get(event) else { continue };
        let mut errors = Vec::new();
        match event.kind() {
            EventKind::SimpleKey => raw.decode_key(&mut (), &mut errors),
            EventKind::Scalar => {
                let _kind = raw.decode_scalar(&mut (), &mut errors);
            }
            _ => {}
        }
        for error in errors {
            let place = place_of(&error);
            slips.push(match (event.kind(), event.encoding()) {
                (
                    EventKind::SimpleKey,
                    None | Some(Encoding::MlBasicString | Encoding::MlLiteralString),
                ) => in_key(raw.as_str(), place),
                (_, None) => in_plain_value(raw.as_str(), place),
                (_, Some(quotes)) => in_quotes(text, place, quotes),
            });
        }
    }
    slips
}

fn place_of(error: &ParseError) -> SourceRange {
    error.unexpected().map_or(0..0, |span| span.start()..span.end())
}

/// The error of a well-formed but invalid value, such as a nonexistent date, or of a key that its table already has.
fn beyond_grammar(text: &str, place: SourceRange) -> Slip {
    let there = text.get(place.clone()).unwrap_or("");
    let before = text.get(..place.start).unwrap_or("").trim_end();
    if before.ends_with(['=', ',']) && there.starts_with(|c: char| c.is_ascii_digit()) {
        return Slip::new(place, "there is no such date or time", Loses::Value);
    }
    let key = there.trim_matches(['"', '\'']);
    Slip::new(place, format!("`{key}` is given twice"), Loses::Key).help("keep one of them")
}

/// The error of a missing or superfluous token.
fn between_tokens(text: &str, error: &ParseError) -> Slip {
    let place = place_of(error);
    let expects = |token: &str| {
        let expected = error.expected().unwrap_or_default();
        expected.iter().any(|e| matches!(e, Expected::Literal(literal) if *literal == token))
    };
    let opened = error.context().and_then(|span| text.get(span.start()..span.end()));
    let next = text.get(place.start..).and_then(|rest| rest.chars().next()).unwrap_or('\n');
    let message = match error.expected() {
        None => "tables and lists are nested too deep",
        _ if expects("\n") => {
            let help = decimal_comma(text, place.start);
            let message = "nothing more may follow on this line";
            return Slip { help, ..Slip::new(place, message, Loses::Track) };
        }
        Some(_) if ",=".contains(next) && !expects(&next.to_string()) => {
            let help = decimal_comma(text, place.start);
            let message = format!("one `{next}` too many");
            return Slip { help, ..Slip::new(place, message, Loses::Track) };
        }
        _ if expects("]]") => "a `]]` is missing before this",
        _ if expects("=") => "a key is followed by `=` and its value",
        _ => match (opened, expects(",")) {
            (Some("["), true) => "a `,` or `]` is missing before this",
            (Some("{"), true) => "a `,` or `}` is missing before this",
            (Some("["), _) => "a `]` is missing before this",
            (Some("{"), _) => "a `}` is missing before this",
            _ if expects("]") => "a `]` is missing before this",
            _ => "this is not TOML",
        },
    };
    Slip::new(place, message, Loses::Track)
}

/// The error of a key in other characters; `key` is all of it.
fn in_key(key: &str, place: SourceRange) -> Slip {
    if place.is_empty() {
        return Slip::new(place, "a key is missing here", Loses::Track);
    }
    let help = plain_name(key).map_or_else(
        || "letters to be shown are given by `symbol`: theta = { symbol = \"θ\" }".to_owned(),
        |plain| format!("write {plain}, which is shown as {}", unicode_name(&plain)),
    );
    Slip::new(place, "a key is made of ASCII letters, digits, `_` and `-`", Loses::Value).help(help)
}

/// The error of an unquoted value: an invalid number, a word, or nothing.
fn in_plain_value(value: &str, place: SourceRange) -> Slip {
    let loses = Loses::Value;
    let digits = value.trim_start_matches(['+', '-']);
    let numeric = |c: char| c.is_ascii_digit() || "+-._eE".contains(c);
    if value.is_empty() {
        Slip::new(place, "a value is missing here", loses)
    } else if value.contains('"') || value.ends_with('\'') {
        Slip::new(place, "the first quote of this text is missing", loses)
    } else if !value.chars().all(numeric) || !value.contains(|c: char| c.is_ascii_digit()) {
        let help = number_with_unit(value).unwrap_or_else(|| format!("write \"{value}\""));
        Slip::new(place, "text and expressions are written in quotes", loses).help(help)
    } else if value.contains('_') {
        Slip::new(place, "in a number `_` stands between digits", loses)
    } else if digits.starts_with('0') && digits[1..].starts_with(|c: char| c.is_ascii_digit()) {
        Slip::new(place, "a number does not begin with 0", loses)
    } else {
        let message = "a number of TOML has digits on both sides of its point";
        Slip::new(place, message, loses).help("write 0.5 and 1.0, or put an expression in quotes")
    }
}

/// The error of a text: an invalid escape or a missing quote.
fn in_quotes(text: &str, place: SourceRange, quotes: Encoding) -> Slip {
    let before = text.get(..place.start).unwrap_or("");
    // an incomplete escape is reported after its letter, such as `u`, or after its digits
    let escape = before.trim_end_matches(|c: char| c.is_ascii_hexdigit());
    if before.ends_with('\\') {
        let help = "write `\\\\` for a backslash, or quote with '...'";
        Slip::new(place, "no such escape", Loses::Value).help(help)
    } else if matches!(quotes, Encoding::BasicString | Encoding::MlBasicString)
        && ["\\u", "\\U", "\\x"].iter().any(|start| escape.ends_with(start))
    {
        Slip::new(place, "this escape has too few digits", Loses::Value)
    } else if text[place.start..]
        .chars()
        .next()
        .is_some_and(|c| c.is_control() && !"\r\n".contains(c))
    {
        Slip::new(place, "a text has no control characters but the tab", Loses::Value)
            .help("remove it, or write it as an escape, such as \\u001b")
    } else if matches!(quotes, Encoding::MlBasicString | Encoding::MlLiteralString) {
        Slip::new(place, "this text of several lines is never closed", Loses::Track)
    } else {
        Slip::new(place, "this text in quotes is not closed on its line", Loses::Value)
    }
}
