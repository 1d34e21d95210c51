//! Rows of numbers as CSV, JSON or JSON lines, written one by one.
//!
//! In: a [`Header`], rows, a [`Closing`]. Out: bytes. Never here: where the numbers come from.

use std::io::{self, Write};

use serde_json::{Value, json};

use super::report::{Closing, Header, RunStatus, one_line};
use crate::num::push_shortest;
use crate::printable;

/// How rows are written.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, clap::ValueEnum)]
pub(super) enum RowFormat {
    /// Comma-separated values; anything else is in lines that begin with `#`.
    #[default]
    Csv,
    /// One JSON object.
    Json,
    /// A JSON object, then one array a row, then a JSON object.
    Jsonl,
}

/// Writes one table.
#[derive(Debug)]
pub(super) struct Rows<W> {
    format: RowFormat,
    out: W,
    written: u64,
    /// The row being written.
    line: String,
}

impl<W: Write> Rows<W> {
    /// Writes the report before the rows.
    pub(super) fn begin(format: RowFormat, mut out: W, header: &Header) -> io::Result<Rows<W>> {
        match format {
            RowFormat::Csv => csv_header(&mut out, header)?,
            RowFormat::Json => {
                out.write_all(b"{\n")?;
                members(&mut out, &serde_json::to_value(header)?)?;
                out.write_all(b"  \"rows\": [")?;
            }
            RowFormat::Jsonl => {
                serde_json::to_writer(&mut out, header)?;
                out.write_all(b"\n")?;
            }
        }
        Ok(Rows { format, out, written: 0, line: String::new() })
    }

    /// Writes a row, with one number per column.
    pub(super) fn row(&mut self, row: &[f64]) -> io::Result<()> {
        match self.format {
            RowFormat::Csv => {
                self.line.clear();
                for &x in row {
                    push_shortest(&mut self.line, x);
                    self.line.push(',');
                }
                self.line.pop();
                self.line.push('\n');
                self.out.write_all(self.line.as_bytes())?;
            }
            RowFormat::Json => {
                let lead = if self.written == 0 { "\n    " } else { ",\n    " };
                self.out.write_all(lead.as_bytes())?;
                serde_json::to_writer(&mut self.out, row)?;
            }
            RowFormat::Jsonl => {
                serde_json::to_writer(&mut self.out, row)?;
                self.out.write_all(b"\n")?;
            }
        }
        self.written += 1;
        Ok(())
    }

    /// Writes the report after the rows and returns the stream.
    pub(super) fn end(mut self, closing: &Closing) -> io::Result<W> {
        match self.format {
            RowFormat::Csv => {
                if closing.status != RunStatus::Completed {
                    let message = closing.message.as_deref().unwrap_or_default();
                    writeln!(self.out, "# {}: {}", closing.status.word(), one_line(message))?;
                }
            }
            RowFormat::Json => {
                let end = if self.written == 0 { "],\n" } else { "\n  ],\n" };
                self.out.write_all(end.as_bytes())?;
                let Closing { invariants, events, status, message } = closing;
                members(&mut self.out, &json!({ "invariants": invariants }))?;
                self.out.write_all(b"  \"events\": [")?;
                let mut lead = "\n    ";
                for event in events.iter() {
                    write!(self.out, "{lead}{event}")?;
                    lead = ",\n    ";
                }
                let end = if lead.starts_with(',') { "\n  ],\n" } else { "],\n" };
                self.out.write_all(end.as_bytes())?;
                let (status, message) = (json!(status), json!(message));
                write!(self.out, "  \"status\": {status},\n  \"message\": {message}\n}}\n")?;
            }
            RowFormat::Jsonl => {
                serde_json::to_writer(&mut self.out, closing)?;
                self.out.write_all(b"\n")?;
            }
        }
        Ok(self.out)
    }
}

/// The members of an object, one per line, each followed by a comma.
fn members(out: &mut impl Write, object: &Value) -> io::Result<()> {
    let Some(object) = object.as_object() else { return Ok(()) };
    for (key, value) in object {
        write!(out, "  {}: ", Value::String(key.clone()))?;
        match value.as_array() {
            Some(items) if items.iter().any(Value::is_object) => {
                let lines: Vec<String> = items.iter().map(|item| format!("    {item}")).collect();
                writeln!(out, "[\n{}\n  ],", lines.join(",\n"))?;
            }
            _ => writeln!(out, "{value},")?,
        }
    }
    Ok(())
}

/// The version, parameters and method in `#` lines, then the names of the columns.
fn csv_header(out: &mut impl Write, header: &Header) -> io::Result<()> {
    out.write_all(header.lines().as_bytes())?;
    let mut names = csv::WriterBuilder::new().from_writer(Vec::new());
    names.write_record(header.columns.iter().map(|name| printable::line(name).into_owned()))?;
    let names = names.into_inner().map_err(csv::IntoInnerError::into_error)?;
    out.write_all(&names)
}
