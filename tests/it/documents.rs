//! The tables in the documents agree with those of the code.
//!
//! `UPDATE_EXPECT=1 cargo test documents` rewrites them.

use std::fmt::Write as _;
use std::path::Path;

use phaselab::app::keymap::{KEYS, KeyContext};
use phaselab::cli::EXITS;
use phaselab::instrument::INSTRUMENTS;
use phaselab::integrate::{METHODS, Preserves, Stepping};
use phaselab::record::script::{CLAIMS, COMMANDS};
use phaselab::shell::options::rows;

fn keys() -> String {
    let mut table = "| where | key | what it does |\n|---|---|---|\n".to_owned();
    for context in KeyContext::ALL {
        let mut title = context.title();
        for row in KEYS.iter().filter(|row| row.context == context) {
            let keys: Vec<String> = row.key_names().iter().map(|key| format!("`{key}`")).collect();
            writeln!(table, "| {title} | {} | {} |", keys.join(" "), row.help).unwrap();
            title = "";
        }
    }
    table
}

fn methods() -> String {
    let mut table =
        "| method | order | steps | what it keeps | what it needs |\n|---|---|---|---|---|\n"
            .to_owned();
    for method in METHODS {
        let order = method.order.map_or("by tolerance".to_owned(), |order| order.to_string());
        let steps = match method.stepping {
            Stepping::Adaptive => "adaptive",
            Stepping::Fixed => "fixed",
        };
        let keeps = match method.preserves {
            Preserves::Nothing => "–",
            Preserves::Symplectic => "the symplectic form",
            Preserves::SymplecticReversible => "the symplectic form, reversibility",
        };
        let needs = if method.needs.is_empty() { "–" } else { method.needs };
        writeln!(table, "| `{}` | {order} | {steps} | {keeps} | {needs} |", method.name).unwrap();
    }
    table
}

fn commands() -> String {
    let mut table = "| line | what it does |\n|---|---|\n".to_owned();
    for command in COMMANDS {
        writeln!(table, "| `{}` | {} |", command.form, command.about).unwrap();
    }
    table
}

fn claims() -> String {
    let mut table = "| `Assert …` | what must hold |\n|---|---|\n".to_owned();
    for (form, about) in CLAIMS {
        writeln!(table, "| `{form}` | {about} |").unwrap();
    }
    table
}

fn measures() -> String {
    let mut table = "| `KIND.WORD` | what it is |\n|---|---|\n".to_owned();
    for kind in INSTRUMENTS {
        for measure in kind.properties().measures {
            writeln!(
                table,
                "| `{}.{}` | {} |",
                kind.name(),
                measure.word,
                measure.about.replace('|', "\\|")
            )
            .unwrap();
        }
    }
    table
}

fn options() -> String {
    let mut table =
        "| option and key | what it may be | without it | what it is for |\n|---|---|---|---|\n"
            .to_owned();
    for row in rows() {
        let (name, usual, may_be) = (&row.name, &row.usual, row.may_be());
        writeln!(table, "| `{name}` | {may_be} | {usual} | {} |", row.about).unwrap();
    }
    table
}

fn exits() -> String {
    let mut table = "| code | when |\n|---|---|\n".to_owned();
    for exit in EXITS {
        writeln!(table, "| {} | {} |", exit.code, exit.when.replace('|', "\\|")).unwrap();
    }
    table
}

/// Checks (or writes) the part of a document between `<!-- name -->` and `<!-- end -->`.
fn check(document: &str, name: &str, table: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs").join(document);
    let text = std::fs::read_to_string(&path).expect("a document");
    let open = format!("<!-- {name} -->\n");
    let start = text.find(&open).expect("the mark before the table") + open.len();
    let end = start + text[start..].find("<!-- end -->").expect("the mark after the table");
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        let new = format!("{}{table}{}", &text[..start], &text[end..]);
        std::fs::write(&path, new).expect("writable");
    } else {
        assert!(
            text[start..end] == *table,
            "the {name} of docs/{document} are not those of the code; write them with UPDATE_EXPECT=1"
        );
    }
}

#[test]
fn the_tables_are_those_of_the_code() {
    check("lab.md", "keys", &keys());
    check("headless.md", "methods", &methods());
    check("lab.md", "options", &options());
    check("headless.md", "exits", &exits());
    check("demos.md", "script", &commands());
    check("demos.md", "claims", &claims());
    check("demos.md", "measures", &measures());
}

/// The TOML blocks in a document that are complete files (those with a title), without the indent of a list.
fn examples(document: &str) -> Vec<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(document);
    let text = std::fs::read_to_string(&path).expect("a document");
    let mut found = Vec::new();
    let mut block: Option<(usize, String)> = None;
    for line in text.lines() {
        let indent = line.len() - line.trim_start().len();
        match (&mut block, line.trim()) {
            (None, "```toml") => block = Some((indent, String::new())),
            (None, _) => {}
            (Some(_), "```") => found.extend(block.take().map(|(_, text)| text)),
            (Some((by, text)), _) => {
                text.push_str(line.get(*by..).unwrap_or(""));
                text.push('\n');
            }
        }
    }
    found.retain(|text| text.starts_with("title"));
    found
}

#[test]
fn the_examples_of_the_documents_have_no_errors() {
    for document in ["README.md", "docs/preset-format.md"] {
        let examples = examples(document);
        assert!(!examples.is_empty(), "no example in {document}");
        for text in examples {
            if let Err(diagnostics) = phaselab::preset::read(&text) {
                panic!("{}", phaselab::diagnostic::report(&text, document, &diagnostics, false));
            }
        }
    }
}

/// The complete reference of the file format.
#[test]
fn the_reference_of_the_format_is_that_of_the_code() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/preset-keys.md");
    let text = format!(
        "# The tables and keys of a preset\n\nWhat each table of a preset file may have; [The preset file](preset-format.md) says what they mean together.\n\n{}",
        phaselab::preset::reference()
    );
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("writable");
        std::fs::write(&path, &text).expect("writable");
    }
    let written = std::fs::read_to_string(&path).expect("the reference");
    assert!(
        written == text,
        "docs/preset-keys.md is not that of the code; write it with UPDATE_EXPECT=1"
    );
}
