//! The options of every command that computes motions: the system, its parameters and initial values, the method.
//!
//! In: options. Out: a model with the start they describe, then the compiled system and its method. Never here: what a
//! command computes with them.

use std::ffi::OsString;
use std::sync::Arc;

use super::assignment;
use super::error::CommandError;
use super::interrupt::Interrupt;
use super::open;
use super::report::Header;
use super::run::header;
use super::start_options::StartOptions;
use crate::diagnostic::Document;
use crate::ensemble::Start;
use crate::experiment::Derived;
use crate::integrate::{Method, Settings};
use crate::mechanics::Equations;
use crate::model::{Direction, Model};
use crate::system::System;

/// A system, its start and its method.
#[derive(Debug, clap::Args)]
// where options of another struct are among them the group is empty, and a command with these as an option would never have them
#[group(args = ["name"])]
pub(super) struct MotionOptions {
    /// A preset's name, or a file.
    #[arg(value_name = "PRESET|FILE")]
    pub(super) name: OsString,
    #[command(flatten)]
    changes: StartOptions,
}

/// A model as the options set it, before anything is derived from it.
#[derive(Clone)]
pub(super) struct ModelReading {
    pub(super) document: Document,
    pub(super) model: Model,
    pub(super) start: Start,
    /// The first surface of section of the file's views, as it is written, and its direction.
    pub(super) surface: Option<(String, Direction)>,
    settings: Settings,
}

/// A compiled system with its start and its method.
pub(super) struct CompiledMotion {
    pub(super) model: Arc<Model>,
    pub(super) equations: Arc<Equations>,
    pub(super) system: System,
    pub(super) start: Start,
    pub(super) method: &'static Method,
    pub(super) settings: Settings,
}

impl MotionOptions {
    /// Reads the system and its start.
    pub(super) fn read(&self) -> Result<ModelReading, CommandError> {
        let document = open::find(&self.name)?;
        let mut model = open::read(&document)?;
        let surface = surface(&model);
        model.leave_views_out();
        let parameters = assignment::parameters(&model, &self.changes.set)?;
        model.set_parameters(&parameters);
        let overrides = assignment::initial(&model, &parameters, &self.changes.init)?;
        model.run.start = assignment::start(&model, &parameters, &self.changes.init)?;
        assignment::begin_at(&mut model, &overrides);
        let settings = self.changes.integrator.settings(&document, &model)?;
        let start = Start { time: model.run.start, parameters, overrides };
        Ok(ModelReading { document, model, start, surface, settings })
    }

    /// Derives and compiles a model, with further columns, each `EXPR` or `NAME=EXPR`, of the option `called`.
    pub(super) fn compile(
        &self,
        reading: ModelReading,
        columns: &[String],
        called: &str,
        interrupt: &Interrupt,
    ) -> Result<CompiledMotion, CommandError> {
        let ModelReading { document, model, start, settings, .. } = reading;
        let mut derived = open::derive(&document, model)?;
        let Derived { model, equations } = &mut derived;
        equations.pool.set_cancel(interrupt.cancel().clone());
        let columns: Vec<_> = columns
            .iter()
            .map(|text| assignment::column(model, &mut equations.pool, text, called))
            .collect::<Result<_, _>>()?;
        let system = open::compile(&document, &derived, &columns)?;
        let Derived { model, equations } = derived;
        let method = self.changes.integrator.choose(&document, &model, &system)?;
        (method.make)(&system, &settings).map_err(|why| CommandError::WrongUse(why.to_string()))?;
        let (model, equations) = (Arc::new(model), Arc::new(equations));
        Ok(CompiledMotion { model, equations, system, start, method, settings })
    }
}

impl CompiledMotion {
    /// The title, parameters, method and columns of a report.
    pub(super) fn header(&self) -> Header {
        header(&self.model, &self.system, &self.start.parameters, self.method, self.settings)
    }
}

/// The first surface of section of a file's views, which a view has as its last axis.
fn surface(model: &Model) -> Option<(String, Direction)> {
    model.views.iter().find_map(|view| {
        let section = model.sections.get(view.section?)?;
        let written = view.axes.last()?.first()?.written.clone();
        Some((written, section.direction))
    })
}
