//! A table of starts: one row an orbit, whose columns set parameters or initial values.
//!
//! In: a file of comma-separated values, or a grid. Out: a [`Start`] for each row. Never here: motions.

use std::path::Path;
use std::str::FromStr;

use super::assignment::{self, Assignment, name_in_letters, number};
use super::decimal::divisions;
use super::error::CommandError;
use crate::ensemble::Start;
use crate::file;
use crate::model::Model;
use crate::printable;

const LONGEST: u64 = 256 << 20;

const MOST_ROWS: usize = 10_000_000;

/// Rows of values under their names, as written.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub(super) struct Starts {
    pub(super) names: Vec<String>,
    pub(super) rows: Vec<Vec<String>>,
}

/// An evenly spaced axis of a grid, `NAME=FROM:TO:COUNT`.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct GridAxis {
    pub(super) name: String,
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) count: u32,
}

impl FromStr for GridAxis {
    type Err = String;

    fn from_str(text: &str) -> Result<GridAxis, String> {
        let form = "write it as name=from:to:count";
        let (name, range) = text.split_once('=').ok_or(form)?;
        let parts: Vec<&str> = range.split(':').collect();
        let &[from, to, count] = parts.as_slice() else { return Err(form.to_owned()) };
        let name = name_in_letters(name);
        if name.is_empty() {
            return Err(form.to_owned());
        }
        let count: u32 =
            count.trim().parse().map_err(|_| format!("{form}; the count is a whole number"))?;
        if count == 0 {
            return Err("a grid has at least one point".to_owned());
        }
        Ok(GridAxis { name, from: number(from)?, to: number(to)?, count })
    }
}

impl GridAxis {
    /// Its points; a single one is the first.
    pub(super) fn points(&self) -> Vec<f64> {
        if self.count == 1 {
            return vec![self.from];
        }
        if self.from <= self.to {
            return divisions(self.from, self.to, self.count - 1).collect();
        }
        let mut points: Vec<f64> = divisions(self.to, self.from, self.count - 1).collect();
        points.reverse();
        points
    }
}

impl Starts {
    /// Reads a table, whose first line has the names. Lines that begin with `#` are comments.
    pub(super) fn read(path: &Path) -> Result<Starts, CommandError> {
        let failed =
            |why: String| CommandError::WrongUse(format!("{}: {why}", printable::path(path)));
        let (bytes, size) =
            file::read(path, LONGEST).map_err(|why| CommandError::reading(path, &why))?;
        if size > LONGEST {
            return Err(failed(format!("a table of more than {} MiB", LONGEST >> 20)));
        }
        let text =
            String::from_utf8(bytes).map_err(|_| failed("it is not UTF-8 text".to_owned()))?;
        let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
        let mut reader = csv::ReaderBuilder::new()
            .comment(Some(b'#'))
            .trim(csv::Trim::All)
            .from_reader(text.as_bytes());
        let names = reader.headers().map_err(|why| failed(wrong_line(&why)))?;
        let names: Vec<String> = names.iter().map(str::to_owned).collect();
        if let Some(i) = names.iter().position(String::is_empty) {
            return Err(failed(format!("column {} has no name", i + 1)));
        }
        if let Some(name) = names.iter().enumerate().find(|(i, n)| names[..*i].contains(n)) {
            return Err(failed(format!("there are two columns `{}`", printable::quoted(name.1))));
        }
        let mut rows = Vec::new();
        for record in reader.records() {
            let record = record.map_err(|why| failed(wrong_line(&why)))?;
            rows.push(record.iter().map(str::to_owned).collect());
        }
        if rows.is_empty() {
            return Err(failed("the table has no rows".to_owned()));
        }
        Ok(Starts { names, rows })
    }

    /// All points of a grid; the last axis varies fastest.
    pub(super) fn grid(axes: &[GridAxis]) -> Result<Starts, CommandError> {
        let count = axes.iter().try_fold(1usize, |n, axis| n.checked_mul(axis.count as usize));
        if count.is_none_or(|count| count > MOST_ROWS) {
            let message = format!("a grid of more than {MOST_ROWS} points");
            return Err(CommandError::WrongUse(message));
        }
        for (i, axis) in axes.iter().enumerate() {
            if axes[..i].iter().any(|before| before.name == axis.name) {
                let name = printable::quoted(&axis.name);
                return Err(CommandError::WrongUse(format!("--grid gives {name} twice")));
            }
        }
        let mut rows: Vec<Vec<String>> = vec![Vec::new()];
        for axis in axes {
            let points: Vec<String> = axis.points().iter().map(|x| format!("{x:?}")).collect();
            let longer = |row: &Vec<String>| -> Vec<Vec<String>> {
                points.iter().map(|x| [row.as_slice(), std::slice::from_ref(x)].concat()).collect()
            };
            rows = rows.iter().flat_map(longer).collect();
        }
        Ok(Starts { names: axes.iter().map(|axis| axis.name.clone()).collect(), rows })
    }

    /// The start of each row: what it does not set is that of `base`.
    pub(super) fn starts(&self, model: &Model, base: &Start) -> Result<Vec<Start>, CommandError> {
        let mut starts = Vec::with_capacity(self.rows.len());
        for (i, row) in self.rows.iter().enumerate() {
            starts.push(self.start(model, base, row).map_err(|why| {
                let mut names = self.names.iter().zip(row).filter(|(_, cell)| !cell.is_empty());
                let unknown = names.find_map(|(name, _)| assignment::settable(model, name).err());
                let row = |why: &CommandError| format!("row {}: {}", i + 1, why.message());
                unknown.unwrap_or_else(|| CommandError::WrongUse(row(&why)))
            })?);
        }
        Ok(starts)
    }

    fn start(&self, model: &Model, base: &Start, row: &[String]) -> Result<Start, CommandError> {
        let cells = self.names.iter().zip(row).filter(|(_, cell)| !cell.is_empty());
        let cells: Vec<Assignment> = cells.map(|(name, cell)| Assignment::of(name, cell)).collect();
        let (set, init): (Vec<Assignment>, Vec<Assignment>) =
            cells.into_iter().partition(|cell| model.parameter(cell.name()).is_some());
        let mut start = base.clone();
        start.parameters = assignment::parameters(model, &set)?;
        if init.iter().any(|cell| cell.name() == "t") {
            start.time = assignment::start(model, &start.parameters, &init)?;
        }
        for given in assignment::initial(model, &start.parameters, &init)? {
            start.replace(given);
        }
        Ok(start)
    }
}

/// An error in comma-separated values, in words.
fn wrong_line(why: &csv::Error) -> String {
    match why.kind() {
        csv::ErrorKind::UnequalLengths { pos, expected_len, len } => {
            let line = pos.as_ref().map_or(0, csv::Position::line);
            format!("line {line} has {len} cells, the first line {expected_len}")
        }
        csv::ErrorKind::Io(why) => printable::why(why),
        _ => "it is not a table of comma-separated values".to_owned(),
    }
}
