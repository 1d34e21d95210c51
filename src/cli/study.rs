//! What the commands that study a motion have in common: their arguments, the system they begin
//! with, the head of their JSON, and how they end.
//!
//! In: arguments. Out: a system at a state, with a method; an object or a text, written. Never
//! here: what is computed.

use std::path::PathBuf;
use std::sync::Arc;

use clap::ValueEnum;
use serde_json::{Map, Value};

use super::assignment::{self, Assignment};
use super::error::CommandError;
use super::interrupt::Interrupt;
use super::motion_options::{CompiledMotion, MotionOptions};
use super::output::{Output, OutputForm};
use super::run;
use crate::dynamics::{CompiledLaw, DynamicsError, PhaseSpace};
use crate::integrate::{Method, Settings};
use crate::mechanics::Equations;
use crate::model::Model;
use crate::num::{DoubleDouble, significant};
use crate::system::{InitialOverride, State, System};

/// The arguments of each of these commands.
#[derive(Debug, clap::Args)]
pub(super) struct StudyArguments {
    #[command(flatten)]
    pub(super) motion: MotionOptions,
    /// How it is written.
    #[arg(long, value_enum, default_value_t)]
    format: StudyFormat,
    /// Writes to a file, which appears when it is complete and replaces an old one.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// How a result is written.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, ValueEnum)]
pub(super) enum StudyFormat {
    /// For reading.
    #[default]
    Text,
    /// One object.
    Json,
}

/// A system to be studied, at a state.
pub(super) struct Study {
    pub(super) model: Arc<Model>,
    pub(super) equations: Arc<Equations>,
    pub(super) space: PhaseSpace,
    /// The initial state, in the variables of the space.
    pub(super) start: State,
    pub(super) method: &'static Method,
    pub(super) settings: Settings,
}

impl Study {
    /// Reads, derives, compiles, and begins at the initial state, in a phase space that allows what may act on the motion.
    pub(super) fn open(
        arguments: &StudyArguments,
        interrupt: &Interrupt,
        space: impl Fn(CompiledLaw<'_>, &[f64]) -> Result<PhaseSpace, DynamicsError>,
    ) -> Result<Study, CommandError> {
        let reading = arguments.motion.read()?;
        let compiled = arguments.motion.compile(reading, &[], "", interrupt)?;
        let CompiledMotion { model, equations, system, start, method, settings } = compiled;
        let space = space((&model, &equations, &system), &start.parameters).map_err(failed)?;
        let start = start
            .state(&system)
            .and_then(|state| space.state(&state))
            .map_err(|error| CommandError::CouldNot(error.to_string()))?;
        Ok(Study { model, equations, space, start, method, settings })
    }

    /// When to end: as requested, otherwise as the file says, otherwise 10 after the start.
    pub(super) fn until(&self, until: Option<f64>) -> f64 {
        until.or(self.model.run.until).unwrap_or(self.start.time + 10.0)
    }

    /// The fields that every object begins with.
    pub(super) fn head(&self, settings: Settings) -> Map<String, Value> {
        let system = self.space.system();
        let parameters = self.space.parameters();
        head(&self.model, system, parameters, (self.method, settings))
    }

    /// The start with other coordinates.
    pub(super) fn around(&self, set: &[Assignment]) -> Result<State, CommandError> {
        let mut state = self.start.clone();
        let given = assignment::initial(&self.model, self.space.parameters(), set)?;
        for one in given {
            let InitialOverride::Position(i, x) = one else {
                let why = "--around takes coordinates; momenta are those of the start, --init";
                return Err(CommandError::WrongUse(why.to_owned()));
            };
            state.set(i, DoubleDouble::from_decimal(x));
        }
        Ok(state)
    }

    pub(super) fn named(&self, variables: &[f64]) -> Value {
        let names = self.space.names().iter().cloned();
        Value::Object(names.zip(variables.iter().map(|&x| x.into())).collect())
    }
}

/// The fields that every object begins with.
pub(super) fn head(
    model: &Model,
    system: &System,
    parameters: &[f64],
    (method, settings): (&'static Method, Settings),
) -> Map<String, Value> {
    run::header(model, system, parameters, method, settings).members()
}

#[expect(clippy::needless_pass_by_value, reason = "it is handed to map_err")]
pub(super) fn failed(error: DynamicsError) -> CommandError {
    match error {
        DynamicsError::Method(_) | DynamicsError::WrongRequest(_) => {
            CommandError::WrongUse(error.to_string())
        }
        DynamicsError::Motion(_)
        | DynamicsError::Unsuited(_)
        | DynamicsError::Unclosed(_)
        | DynamicsError::Singular(_)
        | DynamicsError::Unresolved(_) => CommandError::CouldNot(error.to_string()),
    }
}

/// The status of a result in its JSON.
pub(super) fn status(error: Option<&DynamicsError>) -> &'static str {
    match error {
        None => "completed",
        Some(error) if error.is_cancelled() => "stopped",
        Some(_) => "faulted",
    }
}

/// Writes a result, and ends as its failure or a signal requires.
pub(super) fn write(
    arguments: &StudyArguments,
    (object, text): (Map<String, Value>, String),
    error: Option<DynamicsError>,
    interrupt: &Interrupt,
) -> Result<(), CommandError> {
    let (form, text) = match arguments.format {
        StudyFormat::Text => (OutputForm::Text, text),
        StudyFormat::Json => (OutputForm::Json, format!("{:#}\n", Value::Object(object))),
    };
    let out = Output::open(arguments.output.as_deref(), form)?;
    out.write_after_signal(|| text, interrupt)?;
    match (interrupt.signal(), error) {
        (Some(signal), _) => Err(CommandError::Signal(signal)),
        (None, Some(error)) => Err(failed(error)),
        (None, None) => Ok(()),
    }
}

/// A number in a text: seven digits.
pub(super) fn shown(x: f64) -> String {
    // a zero has no sign
    significant(x + 0.0, 7, 1e-5..1e7)
}

/// Rows of cells in columns, the first to the left, the others to the right.
pub(super) fn table(rows: &[Vec<String>]) -> String {
    let width = |text: &str| unicode_width::UnicodeWidthStr::width(text);
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let widest = |j: usize| rows.iter().filter_map(|row| row.get(j)).map(|c| width(c)).max();
    let widths: Vec<usize> = (0..columns).map(|j| widest(j).unwrap_or(0)).collect();
    let mut text = String::new();
    for row in rows {
        let mut line = String::new();
        for (j, cell) in row.iter().enumerate() {
            let gap = " ".repeat(widths[j] - width(cell));
            let cell = if j == 0 { format!("{cell}{gap}") } else { format!("  {gap}{cell}") };
            line.push_str(&cell);
        }
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}
