//! The options of every command that computes motions: the system, its parameters and initial values, the method.
//!
//! In: options. Out: a model with the start they describe, then the compiled system and its method. Never here: what a
//! command computes with them.

use std::ffi::OsString;
use std::sync::Arc;

use super::assignment::{self, Assignment, number, tolerance};
use super::failure::CommandError;
use super::interrupt::Interrupt;
use super::report::Header;
use super::run::{header, misplaced, refuse_twins, settings};
use super::{open, stderr};
use crate::diagnostic::Document;
use crate::ensemble::Start;
use crate::experiment::{Derived, choose_method};
use crate::integrate::{Method, Settings};
use crate::mechanics::Equations;
use crate::model::{Direction, Model};
use crate::system::System;

/// A system, its start and its method.
#[derive(Debug, clap::Args)]
pub(super) struct MotionOptions {
    /// A preset's name, or a file.
    #[arg(value_name = "PRESET|FILE")]
    pub(super) name: OsString,
    /// Sets a parameter.
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true)]
    set: Vec<Assignment>,
    /// Sets an initial value: a coordinate `x`, a velocity `x'` or a momentum `p_x`.
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true)]
    init: Vec<Assignment>,
    /// The integrator, a name from `phaselab methods`.
    #[arg(long, value_name = "NAME")]
    method: Option<String>,
    /// The step of a fixed-step integrator.
    #[arg(long, value_name = "H", allow_hyphen_values = true, value_parser = number)]
    step: Option<f64>,
    /// The relative tolerance of an integrator that chooses its steps: a number, `fast` (1e-15, in plain `f64`) or
    /// `exact` (1e-18, as by default: errors at the last digit shown).
    #[arg(long, value_name = "EPS", allow_hyphen_values = true, value_parser = tolerance)]
    tolerance: Option<f64>,
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
pub(super) struct Laid {
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
        let parameters = assignment::parameters(&model, &self.set)?;
        model.parameters.iter_mut().zip(&parameters).for_each(|(p, &value)| p.value = value);
        let overrides = assignment::initial(&model, &parameters, &self.init)?;
        model.run.start = assignment::start(&model, &parameters, &self.init)?;
        assignment::begin_at(&mut model, &overrides);
        let settings = settings(self.step, self.tolerance, &model)?;
        if self.method.is_none()
            && let Some(diagnostic) = open::unknown_method(&model)
        {
            return Err(open::refuse(&document, &[diagnostic]));
        }
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
    ) -> Result<Laid, CommandError> {
        let ModelReading { document, model, start, settings, .. } = reading;
        let mut derived = open::derive(&document, model)?;
        let Derived { model, equations } = &mut derived;
        equations.pool.set_cancel(interrupt.cancel().clone());
        let columns: Vec<_> = columns
            .iter()
            .map(|text| assignment::column(model, &mut equations.pool, text, called))
            .collect::<Result<_, _>>()?;
        let system = derived
            .compile(&columns)
            .map_err(|why| CommandError::WrongFile(format!("{}: {why}", document.path)))?;
        let Derived { model, equations } = derived;
        refuse_twins(&system)?;
        for name in system.redundant() {
            stderr::report(&format!(
                "the constraint `{name}` repeats at the start what those before it say"
            ));
        }
        let of_file = self.method.is_none() && (self.step, self.tolerance) == (None, None);
        if of_file && let Some(diagnostic) = open::unfit_method(&model, &system) {
            return Err(open::refuse(&document, &[diagnostic]));
        }
        let name = self.method.as_deref().unwrap_or(&model.run.method);
        let method =
            choose_method(&system, name).map_err(|why| CommandError::WrongUse(why.to_string()))?;
        misplaced(self.step, self.tolerance, method)?;
        (method.make)(&system, &settings).map_err(|why| CommandError::WrongUse(why.to_string()))?;
        let (model, equations) = (Arc::new(model), Arc::new(equations));
        Ok(Laid { model, equations, system, start, method, settings })
    }
}

impl Laid {
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
