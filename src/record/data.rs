//! The trail of a motion as a table, like the output of `run` but for the rows that the laboratory has recorded; and what an
//! instrument has computed.
//!
//! In: a loaded system and its snapshot, a table. Out: comma-separated values, as `phaselab run` writes them. Never here:
//! files.

use std::io::{self, Write};

use crate::app::Loaded;
use crate::experiment::Snapshot;
use crate::instrument::PlotTable;
use crate::num::shortest;

/// Writes the version, title, parameters and method in `#` lines, the names of the columns, and one row for each
/// recorded time.
///
/// # Errors
/// Returns an error if writing fails.
pub fn write(loaded: &Loaded, snapshot: &Snapshot, out: &mut impl Write) -> io::Result<()> {
    let columns = &loaded.system.channels()[..loaded.system.columns()];
    let names = std::iter::once("t").chain(columns.iter().map(|c| c.name.as_str()));
    head(loaded, snapshot, names, out)?;
    snapshot.trail.rows().try_for_each(|row| line(&row[..row.len().min(1 + columns.len())], out))
}

/// Writes the same of a table that an instrument has computed.
///
/// # Errors
/// Returns an error if writing fails.
pub fn write_table(
    loaded: &Loaded,
    snapshot: &Snapshot,
    table: &PlotTable,
    out: &mut impl Write,
) -> io::Result<()> {
    head(loaded, snapshot, table.columns.iter().map(String::as_str), out)?;
    table.rows.iter().try_for_each(|row| {
        let cells = row.iter().enumerate().map(|(column, x)| match column {
            column if column < table.counts => format!("{x:.0}"),
            _ => cell(*x),
        });
        writeln!(out, "{}", cells.collect::<Vec<_>>().join(","))
    })
}

/// The lines before the rows.
fn head<'a>(
    loaded: &Loaded,
    snapshot: &Snapshot,
    columns: impl Iterator<Item = &'a str>,
    out: &mut impl Write,
) -> io::Result<()> {
    let model = &loaded.model;
    let title: Vec<&str> = model.info.title.split_whitespace().collect();
    writeln!(out, "# phaselab {}: {}", env!("CARGO_PKG_VERSION"), title.join(" "))?;
    let values = model.parameters.iter().zip(snapshot.parameters.iter());
    let parameters = values.map(|(p, value)| format!("{}={value:?}", p.name));
    writeln!(out, "# parameters: {}", parameters.collect::<Vec<_>>().join(" "))?;
    writeln!(out, "# method: name={}", snapshot.method.name)?;
    let mut names = csv::Writer::from_writer(Vec::new());
    names.write_record(columns)?;
    out.write_all(&names.into_inner().map_err(csv::IntoInnerError::into_error)?)
}

fn line(row: &[f64], out: &mut impl Write) -> io::Result<()> {
    let cells: Vec<String> = row.iter().map(|x| cell(*x)).collect();
    writeln!(out, "{}", cells.join(","))
}

/// A number so that it reads back; nothing where there is none.
fn cell(x: f64) -> String {
    shortest(x).unwrap_or_default()
}
