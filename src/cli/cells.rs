//! Tables whose cells are numbers, counts or words: as comma-separated values, as JSON, as text in columns.
//!
//! In: cells. Out: text. Never here: where they come from.

use serde_json::{Map, Value};

use super::output::OutputForm;
use crate::num::{push_shortest, short, shortest};
use crate::printable;

/// How a table is written.
#[derive(Clone, Copy, PartialEq, Eq, Debug, clap::ValueEnum)]
pub(super) enum TableFormat {
    /// For reading: short numbers in columns.
    Text,
    /// Comma-separated values, every digit; anything else is in lines that begin with `#`.
    Csv,
    /// One JSON object.
    Json,
}

impl TableFormat {
    pub(super) fn form(self) -> OutputForm {
        match self {
            TableFormat::Text | TableFormat::Csv => OutputForm::Text,
            TableFormat::Json => OutputForm::Json,
        }
    }
}

#[derive(Clone, PartialEq, Debug)]
pub(super) enum TableCell {
    /// A place in an order.
    Count(u64),
    /// A number; what is not finite is left empty.
    Number(f64),
    Word(String),
}

impl TableCell {
    /// The cell in comma-separated values.
    pub(super) fn plain(&self) -> String {
        match self {
            TableCell::Count(n) => n.to_string(),
            TableCell::Number(x) => shortest(*x).unwrap_or_default(),
            TableCell::Word(word) => word.clone(),
        }
    }

    fn brief(&self) -> String {
        match self {
            TableCell::Number(x) if x.is_finite() => short(*x),
            TableCell::Number(_) => "–".to_owned(),
            other => other.plain(),
        }
    }

    pub(super) fn value(&self) -> Value {
        match self {
            TableCell::Count(n) => Value::from(*n),
            TableCell::Number(x) => Value::from(*x),
            TableCell::Word(word) => Value::from(word.clone()),
        }
    }
}

/// Lines of comma-separated values.
pub(super) fn csv<'a>(rows: impl IntoIterator<Item = &'a [TableCell]>) -> String {
    let mut out = String::new();
    for row in rows {
        push_row(&mut out, row);
    }
    out
}

/// Appends a line of comma-separated values.
fn push_row(out: &mut String, row: &[TableCell]) {
    for (i, cell) in row.iter().enumerate() {
        if i > 0 {
            out.push(',');
        }
        match cell {
            // nothing of it needs to be quoted
            TableCell::Number(x) => push_shortest(out, *x),
            TableCell::Count(_) => out.push_str(&cell.plain()),
            TableCell::Word(word) => push_field(out, word),
        }
    }
    out.push('\n');
}

/// One line of comma-separated values, quoted where that is needed.
pub(super) fn record(fields: impl IntoIterator<Item = String>) -> String {
    let mut out = String::new();
    for (i, field) in fields.into_iter().enumerate() {
        if i > 0 {
            out.push(',');
        }
        push_field(&mut out, &field);
    }
    out.push('\n');
    out
}

fn push_field(out: &mut String, field: &str) {
    let field = printable::line(field);
    if field.bytes().any(|byte| matches!(byte, b',' | b'"' | b'#')) {
        out.push('"');
        out.push_str(&field.replace('"', "\"\""));
        out.push('"');
    } else {
        out.push_str(&field);
    }
}

/// Columns of text, numbers to the right.
pub(super) fn text(names: &[String], rows: &[Vec<TableCell>]) -> String {
    let brief: Vec<Vec<String>> =
        rows.iter().map(|row| row.iter().map(TableCell::brief).collect()).collect();
    let width = |i: usize| {
        let cells = brief.iter().filter_map(|row| row.get(i)).chain(names.get(i));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..names.len()).map(width).collect();
    let line = |cells: &[String]| {
        let cells = cells.iter().zip(&widths).map(|(cell, &width)| format!("{cell:>width$}"));
        cells.collect::<Vec<_>>().join("  ").trim_end().to_owned() + "\n"
    };
    line(names) + &brief.iter().map(|row| line(row)).collect::<String>()
}

/// A JSON object with one member a line, and one line for each item of a list of lists or objects.
pub(super) fn object(members: &Map<String, Value>) -> String {
    format!("{{\n{}\n}}\n", lines_of(members))
}

/// The same in pieces, for a member with so many items that they take long to put into words.
pub(super) fn object_in_pieces(
    before: &Map<String, Value>,
    (key, items): (&str, impl Iterator<Item = Value>),
    after: &Map<String, Value>,
) -> impl Iterator<Item = String> {
    let key = Value::from(key);
    let head = format!("{{\n{},\n  {key}: [", lines_of(before));
    let tail = format!("],\n{}\n}}\n", lines_of(after));
    let mut count = 0;
    let mut items = items;
    let mut tail = Some(tail);
    let pieces = std::iter::from_fn(move || match items.next() {
        Some(item) => {
            count += 1;
            Some(format!("{}\n    {item}", if count > 1 { "," } else { "" }))
        }
        None => tail.take().map(|tail| if count > 0 { format!("\n  {tail}") } else { tail }),
    });
    std::iter::once(head).chain(pieces)
}

/// The members of an object, one per line, and one line for each item of a list of lists or objects.
pub(super) fn lines_of(members: &Map<String, Value>) -> String {
    let compound = |value: &Value| value.is_array() || value.is_object();
    let member = |(key, value): (&String, &Value)| {
        let key = Value::String(key.clone());
        match value.as_array() {
            Some(items) if items.iter().any(compound) => {
                let lines: Vec<String> = items.iter().map(|item| format!("    {item}")).collect();
                format!("  {key}: [\n{}\n  ]", lines.join(",\n"))
            }
            _ => format!("  {key}: {value}"),
        }
    };
    members.iter().map(member).collect::<Vec<_>>().join(",\n")
}
