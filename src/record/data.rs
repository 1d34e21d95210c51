//! The trail of a motion as a table, like the output of `run` but for the rows that the laboratory has recorded.
//!
//! In: a loaded system and its snapshot. Out: comma-separated values, as `phaselab run` writes them. Never here:
//! files.

use std::io::{self, Write};

use crate::app::Loaded;
use crate::experiment::Snapshot;

/// Writes the version, title, parameters and method in `#` lines, the names of the columns, and one row for each
/// recorded time.
///
/// # Errors
/// Returns an error if writing fails.
pub fn write(loaded: &Loaded, snapshot: &Snapshot, out: &mut impl Write) -> io::Result<()> {
    let (model, system) = (&loaded.model, &loaded.system);
    let title: Vec<&str> = model.info.title.split_whitespace().collect();
    writeln!(out, "# phaselab {}: {}", env!("CARGO_PKG_VERSION"), title.join(" "))?;
    let values = model.parameters.iter().zip(snapshot.parameters.iter());
    let parameters = values.map(|(p, value)| format!("{}={value:?}", p.name));
    writeln!(out, "# parameters: {}", parameters.collect::<Vec<_>>().join(" "))?;
    writeln!(out, "# method: name={}", snapshot.method.name)?;
    let columns = &system.channels()[..system.columns()];
    let mut names = csv::Writer::from_writer(Vec::new());
    names.write_record(std::iter::once("t").chain(columns.iter().map(|c| c.name.as_str())))?;
    out.write_all(&names.into_inner().map_err(csv::IntoInnerError::into_error)?)?;
    for row in snapshot.trail.rows() {
        let cell = |x: &f64| if x.is_finite() { format!("{x:?}") } else { String::new() };
        let cells: Vec<String> = row.iter().take(1 + columns.len()).map(cell).collect();
        writeln!(out, "{}", cells.join(","))?;
    }
    Ok(())
}
