//! The table of a sweep: what is set in each row, and the row that comes out.
//!
//! In: starts, measures. Out: for each start a row of cells. Never here: threads, files.

use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::super::advice::advice;
use super::super::assignment;
use super::super::cells::{self, TableCell};
use super::super::error::CommandError;
use super::super::interrupt::Interrupt;
use super::super::motion_options::{CompiledMotion, ModelReading, MotionOptions};
use super::super::report::Header;
use super::super::section::surface;
use super::super::starts::Starts;
use crate::diagnostic::nearest;
use crate::dynamics::PhaseSpace;
use crate::ensemble::{OrbitStatus, Start, add_section};
use crate::model::Direction;
use crate::num::BATCH;
use crate::orbits::{
    Departed, MEASURES, MeasuredOrbits, OrbitMeasure, RunOutcome, RunPlan, Zeros, measure_named,
};
use crate::printable;
use crate::system::{InitialOverride, System};

/// How long a run is where nothing says so.
const LENGTH: f64 = 10.0;

/// The most rows that one thread computes at a time, and how many such groups each has at least, so that none waits long
/// for another.
const GROUP: usize = 64;
const SHARES: usize = 4;

/// A measure as it is asked for, `NAME` or `NAME=EXPR`.
#[derive(Clone)]
pub(super) struct MeasureName {
    written: String,
    measure: &'static OrbitMeasure,
    expression: Option<String>,
}

impl std::fmt::Debug for MeasureName {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.written)
    }
}

impl FromStr for MeasureName {
    type Err = String;

    fn from_str(text: &str) -> Result<MeasureName, String> {
        let (name, expression) = match text.split_once('=') {
            Some((name, expression)) => (name.trim(), Some(expression.trim().to_owned())),
            None => (text.trim(), None),
        };
        let Some(measure) = measure_named(name) else {
            let names = MEASURES.iter().map(|measure| measure.name);
            return Err(match nearest(name, names.clone()) {
                Some(near) => format!("there is no such measure; did you mean `{near}`?"),
                None => format!("the measures are {}", names.collect::<Vec<_>>().join(", ")),
            });
        };
        if measure.of == Zeros::Given && expression.is_none() {
            return Err(format!("write it as {name}=EXPR: it is {}", measure.about));
        }
        if measure.of == Zeros::None && expression.is_some() {
            return Err(format!(
                "write it as {name}, without an expression: it is {}",
                measure.about
            ));
        }
        Ok(MeasureName { written: text.trim().to_owned(), measure, expression })
    }
}

/// A measure with the system that it is taken on.
struct Taken {
    name: MeasureName,
    system: System,
    event: Option<usize>,
}

/// What a column of the table sets.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Set {
    Parameter(usize),
    Initial(InitialOverride),
    Time,
}

/// All rows of a sweep.
pub(super) struct SweepTable {
    compiled: CompiledMotion,
    plan: RunPlan,
    names: Vec<String>,
    set: Vec<Set>,
    starts: Vec<Start>,
    until: Option<f64>,
    measures: Vec<Taken>,
    /// The text of the file.
    text: String,
}

/// One row that came out.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct SweepRow {
    pub(super) cells: Vec<TableCell>,
    pub(super) remark: Option<RowRemark>,
}

/// What is to be said of a row besides its numbers.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub(super) struct RowRemark {
    /// Why the run was not completed.
    pub(super) message: Option<String>,
    /// What is conserved by the law of motion, and has left its value.
    pub(super) departed: Option<Departed>,
}

impl SweepRow {
    /// As a line of comma-separated values.
    pub(super) fn line(&self) -> String {
        cells::csv([&self.cells[..]])
    }
}

impl SweepTable {
    pub(super) fn new(
        motion: &MotionOptions,
        starts: &Starts,
        until: Option<f64>,
        measures: &[MeasureName],
        interrupt: &Interrupt,
    ) -> Result<SweepTable, CommandError> {
        let reading = motion.read()?;
        let text = reading.document.text.clone();
        let base = reading.start.clone();
        let all = starts.starts(&reading.model, &base)?;
        let set = |name: &String| -> Result<Set, CommandError> {
            Ok(match reading.model.parameter(name) {
                Some(index) => Set::Parameter(index),
                None if name == "t" => Set::Time,
                None => Set::Initial(assignment::place(&reading.model, name, 0.0)?),
            })
        };
        let set = starts.names.iter().map(set).collect::<Result<Vec<Set>, _>>()?;
        let taken = |name: &MeasureName| taken(motion, reading.clone(), name, interrupt);
        let measures = measures.iter().map(taken).collect::<Result<Vec<Taken>, _>>()?;
        let compiled = motion.compile(reading, &[], "--observe", interrupt)?;
        let until = until.or(compiled.model.run.until);
        if let Some((row, start)) =
            all.iter().enumerate().find(|(_, s)| until.is_some_and(|until| until < s.time))
        {
            let start = printable::number(start.time);
            let message = format!("row {} begins at {start}, after the end, --until", row + 1);
            return Err(CommandError::WrongUse(message));
        }
        let plan = RunPlan {
            model: compiled.model.clone(),
            equations: compiled.equations.clone(),
            system: compiled.system.clone(),
            method: compiled.method.name.to_owned(),
            settings: compiled.settings,
        };
        let names = starts.names.clone();
        Ok(SweepTable { compiled, plan, names, set, starts: all, until, measures, text })
    }

    pub(super) fn count(&self) -> usize {
        self.starts.len()
    }

    /// The report before the rows.
    pub(super) fn header(&self) -> Header {
        self.compiled.header()
    }

    /// What to try where a conserved quantity has left its value.
    pub(super) fn advice(&self) -> String {
        let (settings, method) = (self.compiled.settings, self.compiled.method);
        advice(method.name, settings.step, settings.tolerance)
    }

    pub(super) fn columns(&self) -> Vec<String> {
        let set = self.names.iter().cloned();
        let end = self.header().columns;
        let measures = self.measures.iter().map(|taken| taken.name.written.clone());
        let words = ["status".to_owned()];
        let drift = ["energy_drift".to_owned()];
        set.chain(words).chain(end).chain(drift).chain(measures).collect()
    }

    /// Everything that the rows depend on.
    pub(super) fn everything(&self) -> Vec<u8> {
        let header = self.header();
        let parts = [
            header.phaselab.to_owned(),
            self.text.clone(),
            format!("{:?} {:?}", header.parameters, header.method),
            format!("{:?}", self.columns()),
            format!("{:?}", self.until),
            format!("{:?}", self.starts),
        ];
        parts.join("\0").into_bytes()
    }

    /// How many rows of so many one thread computes at a time.
    pub(super) fn group(&self, count: usize, threads: usize) -> usize {
        if self.plan.is_side_by_side() { (count / (SHARES * threads)).clamp(1, GROUP) } else { 1 }
    }

    /// Computes rows, and hands each to `done` with its place among these as soon as it is there. One that is cancelled is
    /// not.
    pub(super) fn rows(&self, indices: &[usize], mut done: impl FnMut(usize, SweepRow)) {
        let run = |&index: &usize| {
            let start = &self.starts[index];
            (start, self.until.unwrap_or(start.time + LENGTH))
        };
        let runs: Vec<(&Start, f64)> = indices.iter().map(run).collect();
        // as many are measured at a time as there are lanes
        let many = if self.plan.is_side_by_side() { BATCH } else { 1 };
        let mut ended = Vec::new();
        let mut rows = |ended: &mut Vec<(usize, RunOutcome)>| {
            let measured = self.measured(&runs, ended);
            for ((i, outcome), numbers) in ended.drain(..).zip(measured) {
                if let Some(numbers) = numbers {
                    done(i, self.row(runs[i].0, outcome, &numbers));
                }
            }
        };
        self.plan.run_all(&runs, |i, outcome| {
            ended.push((i, outcome));
            if self.measures.is_empty() || ended.len() >= many {
                rows(&mut ended);
            }
        });
        rows(&mut ended);
    }

    /// All measures of each run that has ended; `None` for one that was cancelled.
    fn measured(
        &self,
        runs: &[(&Start, f64)],
        ended: &[(usize, RunOutcome)],
    ) -> Vec<Option<Vec<f64>>> {
        let begun = |(i, outcome): &(usize, RunOutcome)| {
            (outcome.status != OrbitStatus::Refused).then_some(runs[*i])
        };
        let orbits: Vec<(&Start, f64)> = ended.iter().filter_map(begun).collect();
        let mut all = vec![Some(Vec::new()); ended.len()];
        for taken in &self.measures {
            let orbits = MeasuredOrbits {
                model: &self.compiled.model,
                equations: &self.compiled.equations,
                system: &taken.system,
                event: taken.event,
                method: self.compiled.method,
                settings: self.compiled.settings,
                orbits: &orbits,
            };
            let mut found = (taken.name.measure.measure)(&orbits).into_iter();
            for (numbers, one) in all.iter_mut().zip(ended) {
                let number = begun(one).map_or(Some(f64::NAN), |_| found.next().flatten());
                *numbers = numbers.take().zip(number).map(|(mut numbers, number)| {
                    numbers.push(number);
                    numbers
                });
            }
        }
        all
    }

    fn row(&self, start: &Start, outcome: RunOutcome, measured: &[f64]) -> SweepRow {
        let mut cells: Vec<TableCell> =
            self.set.iter().map(|&set| TableCell::Number(value(set, start))).collect();
        cells.push(TableCell::Word(outcome.status.word().to_owned()));
        cells.push(TableCell::Number(outcome.time));
        cells.extend(outcome.values.iter().map(|&x| TableCell::Number(x)));
        cells.push(TableCell::Number(outcome.energy_drift));
        cells.extend(measured.iter().map(|&x| TableCell::Number(x)));
        let failed = matches!(outcome.status, OrbitStatus::Failed | OrbitStatus::Refused);
        let message = outcome.message.filter(|_| failed);
        let remark = RowRemark { message, departed: outcome.departed };
        let remark = (remark.message.is_some() || remark.departed.is_some()).then_some(remark);
        SweepRow { cells, remark }
    }
}

/// The number that a column has set; NaN where its cell is empty.
fn value(set: Set, start: &Start) -> f64 {
    let wanted = match set {
        Set::Parameter(index) => return start.parameters[index],
        Set::Time => return start.time,
        Set::Initial(wanted) => wanted,
    };
    let found = start.overrides.iter().find_map(|&given| match (given, wanted) {
        (InitialOverride::Position(i, x), InitialOverride::Position(j, _))
        | (InitialOverride::Velocity(i, x), InitialOverride::Velocity(j, _))
        | (InitialOverride::Momentum(i, x), InitialOverride::Momentum(j, _)) => {
            (i == j).then_some(x)
        }
        _ => None,
    });
    found.unwrap_or(f64::NAN)
}

/// Compiles a system with the zeros of a measure.
fn taken(
    motion: &MotionOptions,
    mut reading: ModelReading,
    name: &MeasureName,
    interrupt: &Interrupt,
) -> Result<Taken, CommandError> {
    if name.measure.of == Zeros::None {
        let compiled = motion.compile(reading, &[], "--observe", interrupt)?;
        let CompiledMotion { model, equations, system, start, .. } = compiled;
        // said once, and not in every row
        PhaseSpace::on_constraints((&model, &equations, &system), &start.parameters).map_err(
            |why| CommandError::WrongUse(format!("--measure {}: {why}", name.measure.name)),
        )?;
        return Ok(Taken { name: name.clone(), system, event: None });
    }
    let written = match (&name.expression, name.measure.of) {
        (Some(expression), _) => expression.clone(),
        (None, _) if reading.model.is_poisson() => {
            let message = format!(
                "--measure {0}: the variables of a [poisson] system have no velocities; write {0}=EXPR",
                name.measure.name
            );
            return Err(CommandError::WrongUse(message));
        }
        (None, _) => format!("-{}'", reading.model.coordinates[0].name),
    };
    let zeros = surface(&mut reading.model, &written, "--measure")?;
    let event = add_section(&mut reading.model, zeros, Direction::Rising);
    let compiled = motion.compile(reading, &[], "--observe", interrupt)?;
    Ok(Taken { name: name.clone(), system: compiled.system, event: Some(event) })
}
