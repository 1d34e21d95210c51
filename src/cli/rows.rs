//! Rows of numbers as CSV, JSON or JSON lines, written one by one.
//!
//! In: a [`Header`], rows, a [`Closing`]. Out: bytes. Never here: where the numbers come from.

use std::io::{self, Write};

use serde::Serialize;
use serde_json::{Value, json};

use super::cells;
use super::report::{Closing, Header, RunStatus, one_line};
use crate::num::push_shortest;

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
            RowFormat::Json => write!(out, "{{\n{},\n  \"rows\": [", members(header)?)?,
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
                let invariants = members(&json!({ "invariants": invariants }))?;
                write!(self.out, "{invariants},\n  \"events\": [")?;
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

/// The members of an object, one per line.
fn members(object: &impl Serialize) -> io::Result<String> {
    match serde_json::to_value(object)? {
        Value::Object(members) => Ok(cells::lines_of(&members)),
        _ => Err(io::Error::other("what is written is no object")),
    }
}

/// The version, parameters and method in `#` lines, then the names of the columns.
fn csv_header(out: &mut impl Write, header: &Header) -> io::Result<()> {
    let names = cells::record(header.columns.iter().cloned());
    out.write_all((header.lines() + &names).as_bytes())
}
