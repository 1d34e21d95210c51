//! `phaselab run`: the motion as rows of numbers.

mod cautions;
mod clock;
mod invariants;
mod progress;
mod times;

use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use serde_json::{Map, Value};

use super::assignment::{self, Assignment, number};
use super::events::Events;
use super::failure::CommandError;
use super::interrupt::Interrupt;
use super::output::{Form, Output};
use super::report::{Closing, Header, Status};
use super::rows::{Format, Rows};
use super::{open, stderr};
use crate::experiment::{self, Experiment, Progress, Setup, choose_method};
use crate::integrate::{Method, Settings, Stepping};
use crate::model::Model;
use crate::printable;
use crate::system::System;

use invariants::Departure;
use progress::Bar;
use times::Times;

/// Integrate without a screen.
///
/// Rows go to standard output: the time, each coordinate, each velocity, each momentum, the
/// energy, the observables of the file, then those of --observe. Numbers are written so that they
/// read back exactly.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab run pendulum --set l=2 --init theta=pi/3 --until 20 --every 0.1
  phaselab run planet --at 0,0.5,1 --observe 'r*cos(theta)' --format json
  phaselab run henon-heiles --method yoshida4 --step 0.05 --until 1000 -o heiles.csv")]
pub(super) struct Arguments {
    /// A preset's name, or a file.
    #[arg(value_name = "PRESET|FILE")]
    name: OsString,
    /// Sets a parameter.
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true)]
    set: Vec<Assignment>,
    /// Sets an initial value: a coordinate `x`, a velocity `x'` or a momentum `p_x`.
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true)]
    init: Vec<Assignment>,
    /// When to end; where it is left out, the file says, or 10 after the start.
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = number)]
    until: Option<f64>,
    /// The time between two rows; 200 intervals where it is left out.
    #[arg(long, value_name = "DT", allow_hyphen_values = true, value_parser = number)]
    #[arg(conflicts_with = "at")]
    every: Option<f64>,
    /// Rows at these times and no other, increasing.
    #[arg(long, value_name = "T,…", allow_hyphen_values = true, value_parser = number)]
    #[arg(value_delimiter = ',')]
    at: Option<Vec<f64>>,
    /// The integrator, a name out of `phaselab methods`.
    #[arg(long, value_name = "NAME")]
    method: Option<String>,
    /// The step of an integrator of fixed step.
    #[arg(long, value_name = "H", allow_hyphen_values = true, value_parser = number)]
    step: Option<f64>,
    /// The relative tolerance of an integrator that chooses its steps.
    #[arg(long, value_name = "EPS", allow_hyphen_values = true, value_parser = number)]
    tolerance: Option<f64>,
    /// One more column: an expression, under a name of its own or as it is written.
    #[arg(long, value_name = "[NAME=]EXPR", allow_hyphen_values = true)]
    observe: Vec<String>,
    /// How the rows are written.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
    /// Ends with exit code 1 where what the law of motion conserves has left its value by more than a millionth of what
    /// moves; the rows are written all the same.
    #[arg(long)]
    strict: bool,
    /// Writes to a file, which appears when it is complete and takes the place of an old one.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// The most steps between two looks at the clock and at signals, and how long they are to take at most: where steps take
/// long there are fewer.
const STEPS_PER_LOOK: u64 = 4096;
const BETWEEN_LOOKS: Duration = Duration::from_millis(20);

/// How many times the gauges are looked at, whatever the rows.
const LOOKS: f64 = 1000.0;

pub(super) fn perform(arguments: &Arguments, interrupt: &Interrupt) -> Result<(), CommandError> {
    let document = open::find(&arguments.name)?;
    let mut model = open::read(&document)?;
    let parameters = assignment::parameters(&model, &arguments.set)?;
    // which constraints are redundant is judged where this run begins
    model.parameters.iter_mut().zip(&parameters).for_each(|(p, &value)| p.value = value);
    let given = assignment::initial(&model, &parameters, &arguments.init)?;
    model.run.start = assignment::start(&model, &parameters, &arguments.init)?;
    assignment::begin_at(&mut model, &given);
    let times = Times::plan(&model.run, arguments.until, arguments.every, arguments.at.as_deref())?;
    let settings = settings(arguments, &model)?;

    if arguments.method.is_none()
        && let Some(mistake) = open::unknown_method(&model)
    {
        return Err(open::refuse(&document, &[mistake]));
    }

    let mut equations = open::derive(&document, &model)?;
    equations.pool.set_cancel(interrupt.cancel().clone());
    let observed = arguments.observe.iter();
    let columns: Vec<_> = observed
        .map(|text| assignment::column(&model, &mut equations.pool, text))
        .collect::<Result<_, _>>()?;
    let system = System::compile(&model, &equations, &columns)
        .map_err(|why| CommandError::WrongFile(format!("{}: {why}", document.path)))?;
    refuse_twins(&system)?;
    for name in system.redundant() {
        stderr::tell(&format!("the constraint `{name}` repeats what those before it say"));
    }
    // where all of it is the file's, what does not fit is the file's mistake
    let of_file =
        arguments.method.is_none() && (arguments.step, arguments.tolerance) == (None, None);
    if of_file && let Some(mistake) = open::unfit_method(&model, &system) {
        return Err(open::refuse(&document, &[mistake]));
    }
    let name = arguments.method.as_deref().unwrap_or(&model.run.method);
    let method =
        choose_method(&system, name).map_err(|why| CommandError::WrongUse(why.to_string()))?;

    misplaced(arguments, method)?;
    cautions::before(&system, method);

    let header = header(&model, &system, &parameters, method, settings);
    let setup = Setup {
        parameters,
        given,
        method: method.name.to_owned(),
        settings,
        end: Some(times.end()),
        spacing: times.length() / LOOKS,
        ..Setup::of(&model)
    };
    let (model, equations) = (Arc::new(model), Arc::new(equations));
    let mut experiment = Experiment::new(&model, &equations, &system, setup)
        .map_err(|why| CommandError::WrongUse(why.to_string()))?;
    clock::check(&system, method, &experiment, &times)?;
    if arguments.format == Format::Csv {
        experiment.only_count_occurrences();
    }
    let form = match arguments.format {
        Format::Csv => Form::Text,
        Format::Json | Format::Jsonl => Form::Json,
    };
    let out = Output::open(arguments.output.as_deref(), form)?;
    let (columns, strict) = (system.columns(), arguments.strict);
    let run = Run { experiment, times, columns, interrupt, steps: STEPS_PER_LOOK, strict };
    match (run.write(arguments.format, out, &header), interrupt.signal()) {
        // whatever else went wrong meanwhile
        (Err(_), Some(signal)) => Err(CommandError::Signal(signal)),
        (written, _) => written,
    }
}

/// A run about to be written.
struct Run<'i> {
    experiment: Experiment,
    times: Times,
    columns: usize,
    interrupt: &'i Interrupt,
    /// How many steps are taken before the next look at the clock and at signals.
    steps: u64,
    /// Whether a motion that is not the one of its law is a failure.
    strict: bool,
}

/// How a run ended before its time.
enum End {
    Fault(experiment::Failure),
    Event,
    Signal(i32),
    Write(std::io::Error),
}

/// The rows so far, of which whoever ends the run takes hold.
#[derive(Clone)]
struct Table(Arc<Mutex<Option<Rows<Output>>>>);

impl Table {
    fn rows(&self) -> MutexGuard<'_, Option<Rows<Output>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Ends them where a step does not come to its end: what is known of the end is that it was stopped.
    fn end_within_a_step(&self, interrupt: &Interrupt) {
        // whoever holds them is writing, and cannot be helped
        let Some(rows) = self.0.try_lock().ok().and_then(|mut rows| rows.take()) else { return };
        let message =
            "stopped by a signal within a step; what should be constant was not looked at";
        let closing = Closing {
            invariants: Vec::new(),
            events: Events::unknown(),
            status: Status::Stopped,
            message: Some(message.to_owned()),
        };
        if let Ok(out) = rows.end(&closing) {
            if out.is_file() {
                interrupt.saves();
            }
            // nobody is left to be reported of a failure
            let _ = out.finish();
        }
    }
}

impl Run<'_> {
    /// Writes all rows, and what is known at the end.
    fn write(mut self, format: Format, out: Output, header: &Header) -> Result<(), CommandError> {
        let name = out.name().to_owned();
        let failed = |error: &std::io::Error| CommandError::writing(&name, error);
        let table = Table(Arc::default());
        let (stuck, interrupt) = (table.clone(), self.interrupt.clone());
        self.interrupt.ends_by_itself(move || stuck.end_within_a_step(&interrupt));
        *table.rows() = Some(Rows::begin(format, out, header).map_err(|error| failed(&error))?);
        let end = self.rows(&table).err();
        if let Some(End::Write(error)) = &end {
            return Err(failed(error));
        }
        let closing = self.closing(end.as_ref());
        // where they are gone somebody else has ended them, and is about to end the process
        let Some(rows) = table.rows().take() else { return self.gone() };
        let out = rows.end(&closing).map_err(|error| failed(&error))?;
        if out.is_file() {
            self.interrupt.saves();
        }
        out.finish()?;
        cautions::after(&self.experiment);
        let event_log = self.experiment.occurrences();
        if event_log.forgotten() > 0 && format != Format::Csv {
            let (count, forgotten) = (event_log.count(), event_log.forgotten());
            stderr::tell(&format!("of {count} events the first {forgotten} are not listed"));
        }
        if let Some(passed) = self.experiment.singular_passages() {
            stderr::tell(&passed);
        }
        let snapshot = self.experiment.snapshot();
        let departure = Departure::of(&snapshot.gauges, &snapshot.method);
        let refused = self.strict && departure.as_ref().is_some_and(|departure| departure.proved);
        let line = departure.map(|departure| departure.line).unwrap_or_default();
        let cut_short = matches!(end, Some(End::Fault(_) | End::Signal(_)));
        if refused && !cut_short {
            return Err(CommandError::CouldNot(line));
        }
        stderr::tell(&line);
        match end {
            Some(End::Fault(fault)) => Err(CommandError::CouldNot(fault.message)),
            Some(End::Signal(signal)) => Err(CommandError::Signal(signal)),
            _ => Ok(()),
        }
    }

    /// A signal has ended the run meanwhile.
    fn gone(&self) -> Result<(), CommandError> {
        self.interrupt.signal().map_or(Ok(()), |signal| Err(CommandError::Signal(signal)))
    }

    fn rows(&mut self, table: &Table) -> Result<(), End> {
        let mut bar = Bar::new(self.times.start(), self.times.end());
        let mut row = vec![0.0; self.columns + 1];
        for time in self.times.rows() {
            self.reach(time, &mut bar)?;
            row[0] = time;
            row[1..].copy_from_slice(&self.experiment.values()[..self.columns]);
            match &mut *table.rows() {
                Some(rows) => rows.row(&row).map_err(End::Write)?,
                None => return self.interrupted(),
            }
        }
        let end = self.times.end();
        self.reach(end, &mut bar)
    }

    fn interrupted(&self) -> Result<(), End> {
        self.interrupt.signal().map_or(Ok(()), |signal| Err(End::Signal(signal)))
    }

    fn reach(&mut self, time: f64, bar: &mut Bar) -> Result<(), End> {
        loop {
            let begun = Instant::now();
            let progress = self.experiment.advance(time, self.steps);
            self.steps = if begun.elapsed() > BETWEEN_LOOKS {
                (self.steps / 2).max(1)
            } else {
                (self.steps * 2).min(STEPS_PER_LOOK)
            };
            bar.show(self.experiment.time());
            // a step that a signal has cancelled is no fault of the motion
            self.interrupted()?;
            if let experiment::Status::Failed(fault) = self.experiment.status() {
                return Err(End::Fault(fault));
            }
            // the moment itself still has its row
            if progress == Progress::Ended && self.experiment.time() != time {
                return Err(End::Event);
            }
            if matches!(progress, Progress::Arrived | Progress::Ended) {
                return Ok(());
            }
        }
    }

    fn closing(&self, end: Option<&End>) -> Closing {
        let (status, message) = match end {
            Some(End::Fault(fault)) => (Status::Failed, Some(fault.message.clone())),
            Some(End::Signal(_) | End::Write(_)) => {
                (Status::Stopped, Some("stopped by a signal".to_owned()))
            }
            Some(End::Event) | None => match self.experiment.status() {
                experiment::Status::Ended(name) => {
                    let time = self.experiment.time();
                    let time = printable::number(time);
                    (Status::Stopped, Some(format!("`{name}` ended the motion at t = {time}")))
                }
                _ => (Status::Completed, None),
            },
        };
        let gauges = self.experiment.snapshot().gauges;
        let events = Events::of(self.experiment.model(), self.experiment.occurrences());
        Closing { invariants: invariants::of(&gauges), events, status, message }
    }
}

/// Step and tolerance: as asked for, else as the file says.
fn settings(arguments: &Arguments, model: &Model) -> Result<Settings, CommandError> {
    let wrong = |what: String| Err(CommandError::WrongUse(what));
    let told = printable::number;
    match (arguments.step, arguments.tolerance) {
        (Some(step), _) if step <= 0.0 => {
            wrong(format!("--step {}: a step is above zero", told(step)))
        }
        (_, Some(eps)) if eps <= 0.0 || eps >= 1.0 => {
            wrong(format!("--tolerance {}: a tolerance lies between 0 and 1", told(eps)))
        }
        (step, tolerance) => Ok(Settings {
            step: step.or(model.run.step),
            tolerance: tolerance.or(model.run.tolerance),
        }),
    }
}

/// A step is for methods of fixed step, a tolerance for the others.
fn misplaced(arguments: &Arguments, method: &Method) -> Result<(), CommandError> {
    let name = method.name;
    let wrong = |what: String| Err(CommandError::WrongUse(what));
    match method.stepping {
        Stepping::Adaptive if arguments.step.is_some() => {
            wrong(format!("--step: {name} chooses its steps by a tolerance, --tolerance"))
        }
        Stepping::Fixed if arguments.tolerance.is_some() => {
            wrong(format!("--tolerance: {name} has a fixed step, --step"))
        }
        _ => Ok(()),
    }
}

/// Two columns of one name could not be told apart.
fn refuse_twins(system: &System) -> Result<(), CommandError> {
    let columns = &system.channels()[..system.columns()];
    for (i, column) in columns.iter().enumerate() {
        if column.name == "t" || columns[..i].iter().any(|other| other.name == column.name) {
            let message = format!(
                "there would be two columns `{}`; give one a name of its own, --observe NAME=EXPR",
                printable::quoted(&column.name)
            );
            return Err(CommandError::WrongUse(message));
        }
    }
    Ok(())
}

fn header(
    model: &Model,
    system: &System,
    parameters: &[f64],
    method: &Method,
    settings: Settings,
) -> Header {
    let named = model.parameters.iter().zip(parameters);
    let mut about = Map::new();
    about.insert("name".to_owned(), method.name.into());
    about.insert("order".to_owned(), method.order.into());
    match method.stepping {
        Stepping::Fixed => about.insert("step".to_owned(), settings.step.into()),
        Stepping::Adaptive => about.insert("tolerance".to_owned(), settings.tolerance.into()),
    };
    let columns = system.channels()[..system.columns()].iter().map(|c| c.name.clone());
    Header {
        phaselab: env!("CARGO_PKG_VERSION"),
        title: model.info.title.clone(),
        parameters: named.map(|(p, &value)| (p.name.clone(), Value::from(value))).collect(),
        method: about,
        columns: std::iter::once("t".to_owned()).chain(columns).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a file holds of a table whose run is stuck within a step.
    fn ended(format: Format) -> String {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("out");
        let form = if format == Format::Csv { Form::Text } else { Form::Json };
        let out = Output::open(Some(&path), form).expect("it can be written");
        let header = Header {
            phaselab: "0",
            title: "it".to_owned(),
            parameters: Map::new(),
            method: Map::new(),
            columns: vec!["t".to_owned(), "x".to_owned()],
        };
        let mut rows = Rows::begin(format, out, &header).expect("written");
        rows.row(&[0.0, 1.0]).expect("written");
        let table = Table(Arc::new(Mutex::new(Some(rows))));
        table.clone().end_within_a_step(&Interrupt::default());
        assert!(table.rows().is_none(), "nobody writes behind the end");
        std::fs::read_to_string(path).expect("it is there")
    }

    #[test]
    fn a_step_without_an_end_does_not_cost_the_rows_before_it() {
        assert!(
            ended(Format::Csv).contains("\n0.0,1.0\n# stopped: stopped by a signal within a step")
        );
        let read: Value = serde_json::from_str(&ended(Format::Json)).expect("JSON");
        assert_eq!(read["rows"], serde_json::json!([[0.0, 1.0]]));
        assert_eq!(read["status"], "stopped");
        assert_eq!(ended(Format::Jsonl).lines().count(), 3);
    }

    #[test]
    fn whoever_is_writing_is_not_disturbed() {
        let table = Table(Arc::default());
        let rows = table.rows();
        table.end_within_a_step(&Interrupt::default());
        drop(rows);
    }
}
