//! A run as it is written: row by row to its end, or until something ends it early.
//!
//! In: an experiment, times. Out: rows, and the report at the end. Never here: what was requested.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::super::error::CommandError;
use super::super::events::Events;
use super::super::interrupt::Interrupt;
use super::super::output::Output;
use super::super::report::{Closing, Header, RunStatus};
use super::super::rows::{RowFormat, Rows};
use super::super::stderr;
use super::adiabatic::Adiabatic;
use super::invariants::DriftedInvariant;
use super::outlook::Outlook;
use super::progress::Bar;
use super::times::Times;
use super::{cautions, invariants};
use crate::analysis::Verdict;
use crate::experiment::{self, AdvanceOutcome, Experiment, Gauge};
use crate::integrate::{Stepping, method_named};
use crate::printable;
use crate::system::{State, System};

/// The most steps between two checks for the time and for signals, and the longest time between two checks: if steps
/// are slow, fewer are taken.
pub(super) const STEPS_PER_CHECK: u64 = 4096;
const BETWEEN_CHECKS: Duration = Duration::from_millis(20);

/// A run that is about to be written.
pub(super) struct Run<'i> {
    pub(super) experiment: Experiment,
    pub(super) times: Times,
    pub(super) columns: usize,
    pub(super) interrupt: &'i Interrupt,
    /// The number of steps before the next check for the time and for signals.
    pub(super) steps: u64,
    /// Whether a motion that violates its conservation laws is a failure.
    pub(super) strict: bool,
    /// Whether it is given up where its steps are so short that it has no end.
    pub(super) gives_up: bool,
    /// Where parameters are ramped, what the action variable is found by: with the first state.
    pub(super) adiabatic: Option<(Adiabatic, Arc<State>, System)>,
    /// Why the motion cannot start, as a check of the file says it.
    pub(super) cannot_start: &'i dyn Fn() -> Option<String>,
    /// Where steps are all alike, why the motion ends before the run of so many steps does, if it does.
    pub(super) ends_before: Option<&'i dyn Fn(u64) -> Option<String>>,
}

/// Why a run ended early.
enum EarlyEnd {
    Error(experiment::RunError),
    Event,
    Signal(i32),
    Write(std::io::Error),
}

/// The rows so far, which are taken by whatever ends the run.
#[derive(Clone)]
struct PendingRows(Arc<Mutex<Option<Rows<Output>>>>);

impl PendingRows {
    fn rows(&self) -> MutexGuard<'_, Option<Rows<Output>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Ends the rows if a step does not finish; the report says that the run was stopped.
    fn end_within_a_step(&self) {
        // rows that are locked are being written and must be left alone
        let Some(rows) = self.0.try_lock().ok().and_then(|mut rows| rows.take()) else { return };
        let message = "stopped by a signal within a step; the invariants were not checked";
        let closing = Closing {
            invariants: Vec::new(),
            events: Events::unknown(),
            status: RunStatus::Stopped,
            message: Some(message.to_owned()),
        };
        if let Ok(out) = rows.end(&closing) {
            // a failure can no longer be reported
            let _ = out.finish();
        }
    }
}

impl Run<'_> {
    /// Writes all rows and the report at the end.
    pub(super) fn write(
        mut self,
        format: RowFormat,
        out: Output,
        header: &Header,
    ) -> Result<(), CommandError> {
        let name = out.name().to_owned();
        let failed = |error: &std::io::Error| CommandError::writing(&name, error);
        let table = PendingRows(Arc::default());
        let (stuck, out) = (table.clone(), out.waited_for(self.interrupt));
        self.interrupt.ends_by_itself(move || stuck.end_within_a_step());
        *table.rows() = Some(Rows::begin(format, out, header).map_err(|error| failed(&error))?);
        let mut end = self.rows(&table).err();
        if let Some(EarlyEnd::Signal(_)) = end {
            // what is left takes time with many events
            self.interrupt.prepares();
        }
        if let Some(EarlyEnd::Error(error)) = &mut end
            && error.time == self.times.start()
            && let Some(cause) = (self.cannot_start)()
        {
            error.message = cause;
        }
        if let Some(EarlyEnd::Write(error)) = &end {
            return Err(failed(error));
        }
        let closing = self.closing(end.as_ref());
        // rows that are gone were ended by the signal thread, which is about to end the process
        let Some(rows) = table.rows().take() else { return self.already_ended() };
        let out = rows.end(&closing).map_err(|error| failed(&error))?;
        out.finish()?;
        cautions::after(&self.experiment);
        let event_log = self.experiment.occurrences();
        if event_log.forgotten() > 0 && format != RowFormat::Csv {
            let (count, forgotten) = (event_log.count(), event_log.forgotten());
            stderr::report(&format!("of {count} events the first {forgotten} are not listed"));
        }
        if let Some(passed) = self.experiment.singular_passages() {
            stderr::report(&passed);
        }
        if let Some(passed) = self.experiment.comparison_passage() {
            stderr::report(&passed);
        }
        if let Some(passed) = self.experiment.passed_event() {
            stderr::report(&passed);
        }
        for sentence in self.experiment.vanishing_events() {
            stderr::report(&sentence);
        }
        let snapshot = self.experiment.snapshot();
        for line in invariants::unknown(&snapshot.gauges) {
            stderr::report(&line);
        }
        let departure = DriftedInvariant::of(&snapshot.gauges, &snapshot.method);
        let refused = self.strict && departure.as_ref().is_some_and(|departure| departure.proved);
        let (drift, line) =
            departure.map(|departure| (departure.drift, departure.line)).unwrap_or_default();
        let cut_short = matches!(end, Some(EarlyEnd::Error(_) | EarlyEnd::Signal(_)));
        // a small drift is the error of steps that are chosen by theirs
        let by_error = method_named(snapshot.method.name)
            .is_some_and(|method| method.stepping == Stepping::Adaptive);
        let has_drifted = |gauge: &Gauge| {
            let drifts = match gauge.verdict {
                Verdict::Secular(_) => !by_error,
                Verdict::Lost => true,
                _ => false,
            };
            // what swings and comes back is the method's own error
            let has_left = gauge.left.is_some() && gauge.verdict != Verdict::Bounded;
            gauge.proved && (drifts || has_left)
        };
        let steps = snapshot.method.steps;
        if end.is_none()
            && snapshot.gauges.iter().any(has_drifted)
            && let Some(why) = self.ends_before.and_then(|ends_before| ends_before(steps))
        {
            // smaller steps are no advice where there is no motion
            stderr::report(&drift);
            let method = snapshot.method.name;
            return Err(CommandError::CouldNot(format!(
                "{method} has stepped past the end of the motion, and what follows is no motion: {why}"
            )));
        }
        let narrow = self.experiment.narrow_passage();
        if refused && !cut_short {
            if let Some(narrow) = &narrow {
                stderr::report(narrow);
            }
            return Err(CommandError::CouldNot(line));
        }
        stderr::report(&line);
        match narrow {
            Some(narrow) if self.strict && !cut_short => {
                return Err(CommandError::CouldNot(narrow));
            }
            Some(narrow) => stderr::report(&narrow),
            None => {}
        }
        match end {
            Some(EarlyEnd::Error(error)) => Err(CommandError::CouldNot(error.message)),
            Some(EarlyEnd::Signal(signal)) => Err(CommandError::Signal(signal)),
            _ => Ok(()),
        }
    }

    fn already_ended(&self) -> Result<(), CommandError> {
        self.interrupt.signal().map_or(Ok(()), |signal| Err(CommandError::Signal(signal)))
    }

    fn rows(&mut self, table: &PendingRows) -> Result<(), EarlyEnd> {
        let (start, end) = (self.times.start(), self.times.end());
        let (mut bar, mut outlook) =
            (Bar::new(start, end), Outlook::new(start, end, self.experiment.system().has_kinks()));
        let mut last = f64::NEG_INFINITY;
        for time in self.times.rows() {
            let reached = self.reach(time, &mut bar, &mut outlook);
            self.end_at_event(&reached, last, table)?;
            reached?;
            self.write_row(time, table)?;
            last = time;
        }
        let mut reached = self.reach(end, &mut bar, &mut outlook);
        // an event may end the motion just when the run ends
        if reached.is_ok() && matches!(self.experiment.status(), experiment::Status::Ended(_)) {
            reached = Err(EarlyEnd::Event);
        }
        self.end_at_event(&reached, last, table)?;
        reached
    }

    /// Writes the state at which an event has ended the motion as the last row, unless the rows are at times that were listed.
    fn end_at_event(
        &self,
        reached: &Result<(), EarlyEnd>,
        last: f64,
        table: &PendingRows,
    ) -> Result<(), EarlyEnd> {
        let time = self.experiment.time();
        let ends = matches!(reached, Err(EarlyEnd::Event)) && !self.times.are_listed();
        if ends && time > last { self.write_row(time, table) } else { Ok(()) }
    }

    /// Writes the current state as the row of a time.
    fn write_row(&self, time: f64, table: &PendingRows) -> Result<(), EarlyEnd> {
        let values = &self.experiment.values()[..self.columns];
        let row: Vec<f64> = std::iter::once(time).chain(values.iter().copied()).collect();
        match &mut *table.rows() {
            Some(rows) => rows.row(&row).map_err(EarlyEnd::Write),
            None => self.interrupted(),
        }
    }

    fn interrupted(&self) -> Result<(), EarlyEnd> {
        self.interrupt.signal().map_or(Ok(()), |signal| Err(EarlyEnd::Signal(signal)))
    }

    fn reach(&mut self, time: f64, bar: &mut Bar, outlook: &mut Outlook) -> Result<(), EarlyEnd> {
        loop {
            let begun = Instant::now();
            let progress = self.experiment.advance(time, self.steps);
            self.steps = if begun.elapsed() > BETWEEN_CHECKS {
                (self.steps / 2).max(1)
            } else {
                (self.steps * 2).min(STEPS_PER_CHECK)
            };
            bar.show(self.experiment.time());
            // a step that a signal has cancelled is no error
            self.interrupted()?;
            if let experiment::Status::Failed(error) = self.experiment.status() {
                return Err(EarlyEnd::Error(error));
            }
            // the final instant still has its row
            if progress == AdvanceOutcome::Ended && self.experiment.time() != time {
                return Err(EarlyEnd::Event);
            }
            if matches!(progress, AdvanceOutcome::Arrived | AdvanceOutcome::Ended) {
                return Ok(());
            }
            let (time, steps) = self.experiment.computed();
            if self.gives_up
                && let Some(message) = outlook.see(time, steps)
            {
                let error = experiment::RunError { time, message, ends_motion: false };
                return Err(EarlyEnd::Error(error));
            }
        }
    }

    fn closing(&self, end: Option<&EarlyEnd>) -> Closing {
        let (status, message) = match end {
            Some(EarlyEnd::Error(error)) => (RunStatus::Failed, Some(error.message.clone())),
            Some(EarlyEnd::Signal(_) | EarlyEnd::Write(_)) => {
                (RunStatus::Stopped, Some("stopped by a signal".to_owned()))
            }
            Some(EarlyEnd::Event) | None => match self.experiment.status() {
                experiment::Status::Ended(name) => {
                    let time = self.experiment.time();
                    let time = printable::number(time);
                    (RunStatus::Stopped, Some(format!("`{name}` ended the motion at t = {time}")))
                }
                _ => (RunStatus::Completed, None),
            },
        };
        let snapshot = self.experiment.snapshot();
        let mut invariants = invariants::of(&snapshot.gauges);
        // what a signal or an error has ended is not followed any further
        let is_whole = matches!(end, None | Some(EarlyEnd::Event));
        if let Some((known, first, system)) = self.adiabatic.as_ref().filter(|_| is_whole) {
            invariants.extend(known.invariant(system, first, &snapshot.state));
        }
        let events = Events::of(self.experiment.model(), self.experiment.occurrences());
        Closing { invariants, events, status, message }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use serde_json::{Map, Value};

    use super::super::super::output::OutputForm;
    use super::*;

    /// The end of a table whose run is stuck within a step.
    fn ended(format: RowFormat) -> String {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("out");
        let table = begun(&path, format);
        table.clone().end_within_a_step();
        assert!(table.rows().is_none(), "nobody writes behind the end");
        std::fs::read_to_string(path).expect("it is there")
    }

    fn begun(path: &Path, format: RowFormat) -> PendingRows {
        let form = if format == RowFormat::Csv { OutputForm::Text } else { OutputForm::Json };
        let out = Output::open(Some(path), form).expect("it can be written");
        let header = Header {
            phaselab: "0",
            title: "it".to_owned(),
            parameters: Map::new(),
            method: Map::new(),
            columns: vec!["t".to_owned(), "x".to_owned()],
        };
        let mut rows = Rows::begin(format, out, &header).expect("written");
        rows.row(&[0.0, 1.0]).expect("written");
        PendingRows(Arc::new(Mutex::new(Some(rows))))
    }

    #[test]
    fn a_step_without_an_end_does_not_cost_the_rows_before_it() {
        assert!(
            ended(RowFormat::Csv)
                .contains("\n0.0,1.0\n# stopped: stopped by a signal within a step")
        );
        let read: Value = serde_json::from_str(&ended(RowFormat::Json)).expect("JSON");
        assert_eq!(read["rows"], serde_json::json!([[0.0, 1.0]]));
        assert_eq!(read["status"], "stopped");
        assert_eq!(ended(RowFormat::Jsonl).lines().count(), 3);
    }

    #[test]
    fn whoever_is_writing_is_not_disturbed() {
        let folder = tempfile::tempdir().expect("a folder");
        let table = begun(&folder.path().join("out"), RowFormat::Csv);
        let rows = table.rows();
        table.end_within_a_step();
        assert!(rows.is_some(), "they are still to be written");
    }
}
