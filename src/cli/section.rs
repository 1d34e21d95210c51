//! `phaselab section`: where orbits cross a surface of section.

mod report;
mod rotation_columns;

use std::ops::Range;
use std::path::PathBuf;

use clap::ValueEnum;
use clap::builder::PossibleValue;

use self::report::{SectionReport, ShownColumn};
use self::rotation_columns::RotationColumns;
use super::assignment::{self, number, whole};
use super::cells::TableFormat;
use super::error::CommandError;
use super::interrupt::Interrupt;
use super::motion_options::{CompiledMotion, MotionOptions};
use super::output::Output;
use super::starts::Starts;
use super::threads::{self, ThreadOptions};
use crate::ensemble::{
    Crossings, EnergyShell, Root, SectionPlan, Start, add_section, crossings_of_all, section_group,
};
use crate::expr::Expr;
use crate::model::{Allowed, Direction, Model, Scope};
use crate::printable;
use crate::system::InitialOverride;

/// Find the crossings of orbits with a surface of section.
///
/// One row a crossing: the orbit, the number of the crossing, the time, and the columns of `run`.
/// Crossings are located on the dense output of the method, their times as exact as the method's
/// own; a start on the surface is not a crossing. A periodic function of the time makes a
/// stroboscopic section. --rotation adds the mean fraction of a turn between two crossings, by weighted
/// Birkhoff averages: a regular orbit has one with many digits, for a chaotic one none converges.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab section henon-heiles --count 200 --columns y,p_y > section.csv
  phaselab section henon-heiles --on x --orbits starts.csv --energy 1/8 --solve p_x
  phaselab section duffing --on 'sin(w*t)' --count 5000 --columns \"x,x'\" -o attractor.csv
  phaselab section kicked-rotor --on 'sin(2*pi*t/T - pi)' --until 1000 --format json
  phaselab section kicked-rotor --on 'sin(2*pi*t/T - pi)' --count 1000 --rotation theta
  phaselab section henon-heiles --on x --count 1000 --rotation y,p_y --format json")]
pub(super) struct Arguments {
    #[command(flatten)]
    motion: MotionOptions,
    /// The expression that vanishes on the surface; by default that of the file's first view of kind `section`.
    #[arg(long, value_name = "EXPR", allow_hyphen_values = true)]
    on: Option<String>,
    /// Which crossings count: by default the rising ones, or those of the file's own surface.
    #[arg(long, value_enum)]
    direction: Option<Direction>,
    /// The number of crossings after which an orbit ends; 100 where there is no --until either.
    #[arg(long, allow_hyphen_values = true, value_name = "N", value_parser = whole::<u64>(1, MOST))]
    count: Option<u64>,
    /// The time at which an orbit ends.
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = number)]
    until: Option<f64>,
    /// The columns after the time: names of columns, or expressions.
    #[arg(long, value_name = "A,B,…", allow_hyphen_values = true)]
    columns: Option<String>,
    /// One orbit a row; the columns of the table set parameters or initial values.
    #[arg(long, value_name = "TABLE.csv")]
    orbits: Option<PathBuf>,
    /// Completes each start to this energy, by the number of --solve.
    #[arg(long, value_name = "E", allow_hyphen_values = true, value_parser = number)]
    #[arg(requires = "solve")]
    energy: Option<f64>,
    /// The velocity or momentum that completes a start: its positive root, or with `-` its negative one.
    #[arg(long, value_name = "NAME|-NAME", allow_hyphen_values = true, requires = "energy")]
    solve: Option<String>,
    /// The rotation number of each orbit: of an angle, or of two columns around the middle of the orbit.
    #[arg(long, value_name = "A[,B]", allow_hyphen_values = true)]
    rotation: Option<String>,
    #[command(flatten)]
    threads: ThreadOptions,
    /// How the crossings are written.
    #[arg(long, value_enum, default_value_t = TableFormat::Csv)]
    format: TableFormat,
    /// Writes to a file, which appears when it is complete and replaces an old one.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// The crossings of an orbit where nothing says how many.
const COUNT: u64 = 100;

/// The most crossings of an orbit.
const MOST: u64 = 100_000_000;

/// The steps without a crossing after which an orbit without an end in time is given up, and those where their size was asked
/// for, which may be small.
const IDLE: u64 = 100_000;
const IDLE_ASKED: u64 = 1_000_000;

impl ValueEnum for Direction {
    fn value_variants<'a>() -> &'a [Self] {
        &Direction::ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let help = match self {
            Direction::Rising => "From below zero",
            Direction::Falling => "From above zero",
            Direction::Either => "Both",
        };
        Some(PossibleValue::new(self.word()).help(help))
    }
}

pub(super) fn execute(arguments: &Arguments, interrupt: &Interrupt) -> Result<(), CommandError> {
    let mut reading = arguments.motion.read()?;
    let (on, direction) = match (&arguments.on, reading.surface.take()) {
        (Some(on), _) => (on.clone(), Direction::Rising),
        (None, Some(of_file)) => of_file,
        (None, None) => {
            let message = "the file has no surface of section; --on says where, as `--on x`";
            return Err(CommandError::WrongUse(message.to_owned()));
        }
    };
    let direction = arguments.direction.unwrap_or(direction);
    let surface = surface(&mut reading.model, &on, "--on")?;
    let event = add_section(&mut reading.model, surface, direction);
    let wanted = arguments.columns.as_deref().map(split);
    let rotation_names = arguments.rotation.as_deref().map(split);
    let named: Vec<String> = wanted.iter().chain(&rotation_names).flatten().cloned().collect();
    let extra = unknown_columns(&reading.model, &named);
    let compiled = arguments.motion.compile(reading, &extra, "--columns", interrupt)?;
    let starts = match &arguments.orbits {
        Some(path) => Starts::read(path)?.starts(&compiled.model, &compiled.start)?,
        None => vec![compiled.start.clone()],
    };
    let shell = shell(arguments, &compiled.model)?;
    let first = starts.iter().map(|start| start.time).fold(f64::NEG_INFINITY, f64::max);
    if let Some(until) = arguments.until.filter(|&until| until < first) {
        let [until, first] = [until, first].map(printable::number);
        let message = format!("a motion begins at {first}; --until {until} is before it");
        return Err(CommandError::WrongUse(message));
    }
    let count = arguments.count.or(arguments.until.is_none().then_some(COUNT));
    let idle = if compiled.settings.step.is_some() { IDLE_ASKED } else { IDLE };
    let plan = SectionPlan { event, count, until: arguments.until, idle, all_channels: false };
    let shown = shown_columns(&compiled, wanted.as_deref())?;
    let rotation_columns =
        rotation_names.map(|names| RotationColumns::of(&compiled, &names)).transpose()?;
    let out = Output::open(arguments.output.as_deref(), arguments.format.form())?;

    let completed = |start: &Start| {
        let mut start = start.clone();
        let refused = shell.as_ref().map(|shell| shell.complete(&compiled.system, &mut start));
        refused.transpose().map(|_| start).map_err(|why| Crossings::refused(&why))
    };
    let group = |range: Range<usize>| {
        let starts = starts[range].iter().map(completed).collect();
        crossings_of_all(&compiled.system, compiled.method, compiled.settings, starts, &plan)
    };
    let size = section_group(&compiled.system, compiled.method, compiled.settings);
    let groups = (starts.len(), size);
    let orbits = threads::collect(&arguments.threads, groups, interrupt, group)?;
    // the rest takes time with many crossings, also after a signal
    interrupt.prepares();
    let section = SectionReport {
        compiled: &compiled,
        on: &on,
        direction: direction.word(),
        format: arguments.format,
        orbits: &orbits,
        shown: &shown,
        rotations: rotation_columns.map_or_else(Vec::new, |columns| {
            orbits.iter().map(|orbit| columns.rotation(&orbit.rows)).collect()
        }),
    };
    interrupt.is_prepared();
    section.write(out, interrupt)?;
    section.ending(interrupt)
}

/// The expression of a surface, as the option `called` gives it, read into the pool of a model.
pub(super) fn surface(
    model: &mut Model,
    written: &str,
    called: &str,
) -> Result<Expr, CommandError> {
    let mut pool = model.pool.clone();
    let scope = Scope::new(model, Allowed::Event, "a section");
    let e = assignment::read(scope, &mut pool, written, called)?;
    let is_parameter = |symbol| model.parameters.iter().any(|p| p.symbol == symbol);
    if pool.symbols_of(e).into_iter().all(is_parameter) {
        let written = printable::quoted(written);
        let message = format!("{called}: `{written}` is a constant, which is never crossed");
        return Err(CommandError::WrongUse(message));
    }
    model.pool = pool;
    Ok(e)
}

/// The shell that completes the starts.
fn shell(arguments: &Arguments, model: &Model) -> Result<Option<EnergyShell>, CommandError> {
    let (Some(energy), Some(solve)) = (arguments.energy, &arguments.solve) else { return Ok(None) };
    let (name, root) = match solve.strip_prefix('-') {
        Some(name) => (name, Root::Negative),
        None => (solve.as_str(), Root::Positive),
    };
    let by = assignment::place(model, name, 0.0)?;
    if matches!(by, InitialOverride::Position(..)) && !model.is_poisson() {
        let message = format!(
            "--solve {}: a velocity or a momentum completes a start",
            printable::quoted(name)
        );
        return Err(CommandError::WrongUse(message));
    }
    Ok(Some(EnergyShell { energy, by, root, about: 0.0 }))
}

/// The parts between commas that stand in no parentheses.
fn split(list: &str) -> Vec<String> {
    let (mut parts, mut depth) = (vec![String::new()], 0i32);
    for character in list.chars() {
        match character {
            ',' if depth == 0 => parts.push(String::new()),
            other => {
                depth += i32::from(other == '(') - i32::from(other == ')');
                if let Some(part) = parts.last_mut() {
                    part.push(other);
                }
            }
        }
    }
    parts.iter().map(|part| part.trim().to_owned()).filter(|part| !part.is_empty()).collect()
}

/// Those of the requested columns that are not columns of a run by themselves.
fn unknown_columns(model: &Model, wanted: &[String]) -> Vec<String> {
    let known = |name: &str| {
        let coordinate = |name: &str| model.coordinate(name).is_some();
        let rate = name.strip_suffix('\'').or(name.strip_prefix("p_"));
        name == "t"
            || name == "energy"
            || coordinate(name)
            || rate.is_some_and(|name| coordinate(name) && !model.is_poisson())
            || name.strip_prefix("lambda_").is_some()
            || model.observables.iter().any(|o| o.name == name)
            || matches!(&model.mechanics, crate::model::Mechanics::Poisson { casimirs, .. }
                if casimirs.iter().any(|c| c.0 == name))
    };
    let mut extra: Vec<String> = Vec::new();
    for name in wanted {
        if !known(name) && !extra.contains(name) {
            extra.push(name.clone());
        }
    }
    extra
}

fn shown_columns(
    compiled: &CompiledMotion,
    wanted: Option<&[String]>,
) -> Result<Vec<ShownColumn>, CommandError> {
    let names = compiled.header().columns;
    let Some(wanted) = wanted else { return Ok(names.into_iter().zip(0..).collect()) };
    let mut shown: Vec<ShownColumn> = vec![("t".to_owned(), 0)];
    for name in wanted.iter().filter(|name| *name != "t") {
        let called = name.split_once('=').map_or(name.as_str(), |(name, _)| name).trim();
        let Some(place) = names.iter().position(|n| n == called) else {
            let message = format!(
                "--columns: unknown column `{}`; there are {}",
                printable::quoted(called),
                names.join(", ")
            );
            return Err(CommandError::WrongUse(message));
        };
        shown.push((called.to_owned(), place));
    }
    Ok(shown)
}
