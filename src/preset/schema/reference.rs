//! The description of the format for users, made from the tables.
//!
//! In: the tables. Out: Markdown. Never here: keys.

use std::fmt::Write as _;

use super::FILE;
use super::key::SchemaTable;

/// The tables of the file, each before the tables nested in it.
fn sections() -> Vec<&'static SchemaTable> {
    let mut all = vec![&FILE];
    let mut at = 0;
    while at < all.len() {
        let inner = all[at].keys.iter().filter_map(|key| key.kind.section());
        let mut place = at + 1;
        for section in inner.collect::<Vec<_>>() {
            if !all.iter().any(|known| known.head == section.head) {
                let last = if at == 0 { all.len() } else { place };
                all.insert(last, section);
                place += 1;
            }
        }
        at += 1;
    }
    all
}

/// The tables and keys of the format, as Markdown.
pub fn reference() -> String {
    let mut text = String::new();
    for section in sections() {
        let head = section.head;
        let head = if head.starts_with('[') { format!("`{head}`") } else { head.to_owned() };
        // writing to a String cannot fail
        let _ = writeln!(text, "### {head}\n\n{}\n", section.about);
        let _ =
            writeln!(text, "| key | value | unit | where | what it is |\n|---|---|---|---|---|");
        for key in section.keys {
            let name = match key.missing {
                Some(_) => format!("`{}` (needed)", key.name),
                None => format!("`{}`", key.name),
            };
            let cells = [key.kind.words(), key.unit, &key.only.kinds().join(", "), &key.purpose()];
            let cells = cells.join(" | ").replace("  ", " ");
            let _ = writeln!(text, "| {name} | {cells} |");
        }
        text.push('\n');
    }
    text.truncate(text.trim_end().len());
    text.push('\n');
    text
}
