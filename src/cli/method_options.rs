//! The options that choose an integrator.
//!
//! In: options, the file's settings. Out: the method and its settings. Never here: the system, its start.

use super::assignment::{number, tolerance};
use super::error::CommandError;
use super::open;
use crate::diagnostic::Document;
use crate::experiment::{Checkpoint, choose_method};
use crate::integrate::{Method, Settings, Stepping};
use crate::model::Model;
use crate::printable;
use crate::system::System;

/// The integrator and its settings, where they are not the file's.
#[derive(Debug, clap::Args)]
pub(super) struct MethodOptions {
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

impl MethodOptions {
    /// Whether any of them is given.
    pub(super) fn is_given(&self) -> bool {
        self.method.is_some() || (self.step, self.tolerance) != (None, None)
    }

    /// Puts what is given into a checkpoint.
    pub(super) fn set(&self, checkpoint: &mut Checkpoint) {
        checkpoint.method.clone_from(&self.method);
        (checkpoint.step, checkpoint.tolerance) = (self.step, self.tolerance);
    }

    /// The step and tolerance: as requested, otherwise the file's.
    ///
    /// # Errors
    /// Returns an error if one of them is out of its range, or if the file's method is to be used and there is none of its name.
    pub(super) fn settings(
        &self,
        document: &Document,
        model: &Model,
    ) -> Result<Settings, CommandError> {
        let wrong = |what: String| Err(CommandError::WrongUse(what));
        let shown = printable::number;
        match (self.step, self.tolerance) {
            (Some(step), _) if step <= 0.0 => {
                return wrong(format!("--step {}: a step must be above zero", shown(step)));
            }
            (_, Some(eps)) if eps <= 0.0 || eps >= 1.0 => {
                return wrong(format!(
                    "--tolerance {}: a tolerance must be between 0 and 1",
                    shown(eps)
                ));
            }
            _ => {}
        }
        if self.method.is_none()
            && let Some(diagnostic) = open::unknown_method(model)
        {
            return Err(open::refuse(document, &[diagnostic]));
        }
        let run = &model.run;
        Ok(Settings { step: self.step.or(run.step), tolerance: self.tolerance.or(run.tolerance) })
    }

    /// The method for a compiled system: as requested, otherwise the file's.
    ///
    /// # Errors
    /// Returns an error if the method does not suit the system, or a setting not the method.
    pub(super) fn choose(
        &self,
        document: &Document,
        model: &Model,
        system: &System,
    ) -> Result<&'static Method, CommandError> {
        // if all settings are the file's, an unsuitable method is the file's error
        let of_file = self.method.is_none() && (self.step, self.tolerance) == (None, None);
        if of_file && let Some(diagnostic) = open::unfit_method(model, system) {
            return Err(open::refuse(document, &[diagnostic]));
        }
        let name = self.method.as_deref().unwrap_or(&model.run.method);
        let method =
            choose_method(system, name).map_err(|why| CommandError::WrongUse(why.to_string()))?;
        self.fit(method)?;
        Ok(method)
    }

    /// A step is for fixed-step methods, a tolerance for adaptive ones.
    fn fit(&self, method: &Method) -> Result<(), CommandError> {
        let name = method.name;
        let wrong = |what: String| Err(CommandError::WrongUse(what));
        match method.stepping {
            Stepping::Adaptive if self.step.is_some() => {
                wrong(format!("--step: {name} chooses its steps by a tolerance, --tolerance"))
            }
            Stepping::Fixed if self.tolerance.is_some() => {
                wrong(format!("--tolerance: {name} has a fixed step, --step"))
            }
            _ => Ok(()),
        }
    }
}
