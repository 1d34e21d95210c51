//! The crossings of a section as they are written: CSV, JSON, or text.
//!
//! In: the crossings of all orbits. Out: their rows, a remark for each orbit that did not end as it should, and the exit code. Never
//! here: motions.

use std::iter::{once, once_with};

use serde_json::{Map, Value, json};

use super::super::cells::{self, TableCell, TableFormat};
use super::super::error::CommandError;
use super::super::interrupt::Interrupt;
use super::super::motion_options::CompiledMotion;
use super::super::output::Output;
use super::super::stderr;
use crate::dynamics::{NoRotation, Rotation};
use crate::ensemble::{Crossings, OrbitStatus};
use crate::printable;

/// A column by its name, and its place in a row of crossings.
pub(super) type ShownColumn = (String, usize);

/// All orbits, ready to be written.
pub(super) struct SectionReport<'a> {
    pub(super) compiled: &'a CompiledMotion,
    /// The expression of the surface as it was given, and the word for the direction.
    pub(super) on: &'a str,
    pub(super) direction: &'static str,
    pub(super) format: TableFormat,
    pub(super) orbits: &'a [Crossings],
    pub(super) shown: &'a [ShownColumn],
    /// The rotation number of each orbit, if they were asked for.
    pub(super) rotations: Vec<Result<Rotation, NoRotation>>,
}

impl SectionReport<'_> {
    pub(super) fn write(&self, out: Output, interrupt: &Interrupt) -> Result<(), CommandError> {
        let columns: Vec<String> = ["orbit".to_owned(), "n".to_owned()]
            .into_iter()
            .chain(self.shown.iter().map(|(name, _)| name.clone()))
            .collect();
        match self.format {
            TableFormat::Json => {
                let rows = self.rows().map(|row| row.iter().map(TableCell::value).collect());
                let (head, tail) = (self.head(&columns), self.tail());
                let pieces = cells::object_in_pieces(&head, ("rows", rows), &tail);
                out.write_pieces(pieces, interrupt)
            }
            TableFormat::Csv => {
                let on = format!("# section: {} {}\n", printable::line(self.on), self.direction);
                let head = self.compiled.header().lines() + &on + &cells::record(columns);
                let rows = self.rows().map(|row| cells::csv([row.as_slice()]));
                let pieces = once(head).chain(rows).chain(once_with(|| self.remarks("# ")));
                out.write_pieces(pieces, interrupt)
            }
            TableFormat::Text => {
                let rows = || self.rows().collect::<Vec<_>>();
                let text = || cells::text(&columns, &rows()) + &self.remarks("");
                out.write_after_signal(text, interrupt)
            }
        }
    }

    fn rows(&self) -> impl Iterator<Item = Vec<TableCell>> {
        (1..).zip(self.orbits).flat_map(move |(orbit, crossings)| {
            (1..).zip(&crossings.rows).map(move |(n, row)| {
                let numbers = self.shown.iter().map(|&(_, place)| TableCell::Number(row[place]));
                [TableCell::Count(orbit), TableCell::Count(n)].into_iter().chain(numbers).collect()
            })
        })
    }

    /// The members of the JSON object before the rows.
    fn head(&self, columns: &[String]) -> Map<String, Value> {
        let mut members = self.compiled.header().members();
        members.insert("on".to_owned(), self.on.into());
        members.insert("direction".to_owned(), self.direction.into());
        members.insert("columns".to_owned(), json!(columns));
        members
    }

    /// The members after them.
    fn tail(&self) -> Map<String, Value> {
        let orbits = (1u64..).zip(self.orbits).map(|(orbit, crossings)| {
            let mut object = json!({
                "orbit": orbit,
                "status": crossings.status.word(),
                "message": crossings.message,
                "crossings": crossings.rows.len(),
            });
            let index = usize::try_from(orbit - 1).unwrap_or(usize::MAX);
            if let Some(rotation) = self.rotations.get(index) {
                object["rotation"] = match rotation {
                    Ok(Rotation { number, error, .. }) => {
                        json!({ "number": number, "error": error })
                    }
                    Err(_) => Value::Null,
                };
                object["no_rotation"] = json!(rotation.as_ref().err().map(ToString::to_string));
            }
            object
        });
        Map::from_iter([("orbits".to_owned(), orbits.collect())])
    }

    /// A line for each orbit that did not end as it should, and for each rotation number.
    fn remarks(&self, lead: &str) -> String {
        let other = |(_, orbit): &(u64, &Crossings)| orbit.status != OrbitStatus::Completed;
        let line = |(i, orbit): (u64, &Crossings)| {
            let message = orbit.message.as_deref().unwrap_or_default();
            let message = message.split_whitespace().collect::<Vec<_>>().join(" ");
            format!("{lead}orbit {i}: {}: {}\n", orbit.status.word(), printable::line(&message))
        };
        let turn = |(i, rotation): (u64, &Result<Rotation, NoRotation>)| match rotation {
            Ok(found) => format!(
                "{lead}orbit {i}: rotation number {} ± {:.0e}\n",
                printable::number(found.number),
                found.error
            ),
            Err(why) => format!("{lead}orbit {i}: no rotation number: {why}\n"),
        };
        let ended = (1u64..).zip(self.orbits).filter(other).map(line);
        ended.chain((1u64..).zip(&self.rotations).map(turn)).collect()
    }

    /// The exit code: a failure where no orbit could be followed as it should.
    pub(super) fn ending(&self, interrupt: &Interrupt) -> Result<(), CommandError> {
        if let Some(signal) = interrupt.signal() {
            return Err(CommandError::Signal(signal));
        }
        let failed =
            |orbit: &&Crossings| matches!(orbit.status, OrbitStatus::Failed | OrbitStatus::Refused);
        let all = self.orbits.iter().filter(failed).collect::<Vec<_>>();
        let Some(first) = all.first() else { return Ok(()) };
        let why = first.message.clone().unwrap_or_default();
        let message = match (all.len(), self.orbits.len()) {
            (1, 1) => why,
            (failed, orbits) => {
                format!(
                    "{failed} of {orbits} orbits could not be followed to the end; the first: {why}"
                )
            }
        };
        if all.len() == self.orbits.len() {
            return Err(CommandError::CouldNot(message));
        }
        stderr::report(&message);
        Ok(())
    }
}
