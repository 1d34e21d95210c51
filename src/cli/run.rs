//! `phaselab run`: the motion as rows of numbers.

mod adiabatic;
mod cautions;
mod clock;
mod execution;
mod flow_of;
mod invariants;
mod outlook;
mod overstepped;
pub(super) mod progress;
mod ramp;
mod times;

use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::Arc;

use serde_json::{Map, Value};

use super::assignment::{self, number};
use super::error::CommandError;
use super::interrupt::Interrupt;
use super::open;
use super::output::{Output, OutputForm};
use super::report::Header;
use super::rows::RowFormat;
use super::start_options::StartOptions;
use crate::claims;
use crate::experiment::{Derived, Experiment, Setup};
use crate::integrate::{Method, Settings, Stepping};
use crate::model::{Model, replace_by_ramps};
use crate::system::System;

use adiabatic::Adiabatic;
use execution::{Run, STEPS_PER_CHECK};
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
  phaselab run pendulum --ramp l=1:2:0:50 --until 60 > lengthened.csv
  phaselab run planet --flow-of p_theta --until 1
  phaselab run henon-heiles --method yoshida4 --step 0.05 --until 1000 -o heiles.csv")]
pub(super) struct Arguments {
    /// A preset's name, or a file.
    #[arg(value_name = "PRESET|FILE")]
    name: OsString,
    #[command(flatten)]
    changes: StartOptions,
    /// Changes a parameter with the time: by 10u³ − 15u⁴ + 6u⁵, or as FORM says, `cubic` or `linear`; it becomes a column.
    #[arg(long, value_name = "NAME=FROM:TO:START:DURATION[:FORM]", allow_hyphen_values = true)]
    ramp: Vec<ramp::RampArgument>,
    /// Carries the state along the flow of a generator in place of the motion: one of the file, by its name, or an
    /// expression G of q and p. The column t is then ε, from 0; dq/dε = ∂G/∂p, dp/dε = −∂G/∂q.
    #[arg(long, value_name = "NAME|EXPR", allow_hyphen_values = true, conflicts_with = "ramp")]
    flow_of: Option<String>,
    /// When to end; by default as the file says, or 10 after the start.
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = number)]
    until: Option<f64>,
    /// The time between two rows; by default 200 intervals.
    #[arg(long, value_name = "DT", allow_hyphen_values = true, value_parser = number)]
    #[arg(conflicts_with = "at")]
    every: Option<f64>,
    /// Rows at these times and no other, increasing.
    #[arg(long, value_name = "T,…", allow_hyphen_values = true, value_parser = number)]
    #[arg(value_delimiter = ',')]
    at: Option<Vec<f64>>,
    /// One more column: an expression, under a name of its own or as it is written.
    #[arg(long, value_name = "[NAME=]EXPR", allow_hyphen_values = true)]
    observe: Vec<String>,
    /// How the rows are written.
    #[arg(long, value_enum, default_value_t)]
    format: RowFormat,
    /// Ends with exit code 1 where what the law of motion conserves has left its value by more than a millionth of what
    /// moves; the rows are written all the same.
    #[arg(long)]
    strict: bool,
    /// Writes to a file, which appears when it is complete and replaces an old one.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// The number of times that the gauges are sampled at most, whatever the rows.
const OBSERVATIONS: f64 = 1000.0;

pub(super) fn execute(arguments: &Arguments, interrupt: &Interrupt) -> Result<(), CommandError> {
    let document = open::find(&arguments.name)?;
    let mut model = open::read(&document)?;
    model.leave_views_out();
    let mut parameters = assignment::parameters(&model, &arguments.changes.set)?;
    let ramps = ramp::of(&model, &arguments.ramp, &arguments.changes.set)?;
    let start = assignment::start(&model, &parameters, &arguments.changes.init)?;
    for ramp in &ramps {
        parameters[ramp.parameter] = ramp.at(start);
    }
    // redundant constraints are determined at the start of this run
    model.set_parameters(&parameters);
    let given = assignment::initial(&model, &parameters, &arguments.changes.init)?;
    model.run.start = start;
    assignment::begin_at(&mut model, &given);
    let ramped = replace_by_ramps(&mut model, &ramps)
        .map_err(|why| CommandError::WrongUse(format!("--ramp: {why}")))?;
    let adiabatic = if arguments.flow_of.is_none() {
        Adiabatic::of(&model, &parameters, interrupt.cancel())
    } else {
        None
    };
    let mut run = model.run.clone();
    if arguments.flow_of.is_some() {
        run.start = 0.0;
    }
    let times = Times::plan(&run, arguments.until, arguments.every, arguments.at.as_deref())?;
    let settings = arguments.changes.integrator.settings(&document, &model)?;

    let mut derived = open::derive(&document, model)?;
    let Derived { model, equations } = &mut derived;
    equations.pool.set_cancel(interrupt.cancel().clone());
    let observed = arguments.observe.iter();
    let names = ramps.iter().map(|ramp| &model.parameters[ramp.parameter].name);
    let mut columns: Vec<_> = observed
        .chain(names)
        .map(|text| assignment::column(model, &mut equations.pool, text, "--observe"))
        .collect::<Result<_, _>>()?;
    for column in &mut columns {
        column.expression = ramped.replace(&mut equations.pool, column.expression);
    }
    let mut given = given;
    if let Some(written) = &arguments.flow_of {
        let carried = flow_of::carried(derived, &columns, written, &parameters, &given)?;
        (derived, columns, given) = (carried.derived, carried.columns, carried.given);
    }
    let system = open::compile(&document, &derived, &columns)?;
    let Derived { model, equations } = derived;
    let method = arguments.changes.integrator.choose(&document, &model, &system)?;
    cautions::before(&model, &system, &equations, method);

    let setup = Setup {
        parameters: parameters.clone(),
        overrides: given,
        method: method.name.to_owned(),
        settings,
        end: Some(times.end()),
        spacing: times.length() / OBSERVATIONS,
        ..Setup::of(&model)
    };
    let (model, equations) = (Arc::new(model), Arc::new(equations));
    let mut experiment = Experiment::new(&model, &equations, &system, setup)
        .map_err(|why| CommandError::WrongUse(why.to_string()))?;
    cautions::of_start(&model, &equations, &system, (method, settings), &experiment);
    if let Err(refused) = clock::check(&system, method, &experiment, &times) {
        // at a pole steps are that short whatever the clock
        let start = experiment.snapshot().state.clone();
        let pole = claims::start_on_a_pole((&model, &equations, &system), &start);
        return Err(pole.map_or(refused, |pole| CommandError::CouldNot(pole.message)));
    }
    experiment.forget_past();
    // what the file states, and no law proves, is refuted by samples alone
    if experiment.snapshot().gauges.iter().all(|gauge| gauge.proved) {
        experiment.record_for_gauges_only();
    }
    // where none is given, the step that the method has chosen at the start
    let step = Some(experiment.snapshot().method.step).filter(|step| *step > 0.0);
    let used = Settings { step: settings.step.or(step), ..settings };
    let header = header(&model, &system, &parameters, method, used);
    if arguments.format == RowFormat::Csv {
        experiment.only_count_occurrences();
    }
    let form = match arguments.format {
        RowFormat::Csv => OutputForm::Text,
        RowFormat::Json | RowFormat::Jsonl => OutputForm::Json,
    };
    let out = Output::open(arguments.output.as_deref(), form)?;
    let (columns, strict) = (system.columns(), arguments.strict);
    let gives_up = settings.step.is_none();
    let first = experiment.snapshot().state.clone();
    let begun = Arc::clone(&first);
    let adiabatic = adiabatic.map(|known| (known, first, system.clone()));
    let steps = STEPS_PER_CHECK;
    let asked = experiment.snapshot().setup.clone();
    let cannot_start = || {
        let law = (&*model, &*equations, &system);
        Some(claims::undefined_start(law, &begun, &asked.overrides)?.message)
    };
    let cannot_start = &cannot_start;
    let ends_before =
        |steps| overstepped::end_of_motion((&model, &equations, &system), &asked, steps);
    let ends_before: Option<&dyn Fn(u64) -> Option<String>> =
        if overstepped::may_step_over(method) { Some(&ends_before) } else { None };
    let run = Run {
        experiment,
        times,
        columns,
        interrupt,
        steps,
        strict,
        gives_up,
        adiabatic,
        cannot_start,
        ends_before,
    };
    match (run.write(arguments.format, out, &header), interrupt.signal()) {
        // a signal takes precedence over any other failure
        (Err(_), Some(signal)) => Err(CommandError::Signal(signal)),
        (written, _) => written,
    }
}

pub(super) fn header(
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
