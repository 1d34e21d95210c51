//! The description of a method.
//!
//! In: what its file knows. Out: a row of the table. Never here: the table.

use super::stepper::Stepper;
use crate::system::System;

/// A method of integration in time.
pub struct Method {
    /// The name on the command line and in a file.
    pub name: &'static str,
    /// The full name.
    pub title: &'static str,
    /// The order; `None` if it follows the tolerance.
    pub order: Option<u32>,
    /// How it chooses its steps.
    pub stepping: Stepping,
    /// Which structure of the flow it leaves intact.
    pub preserves: Preserves,
    /// Whether steps end on kinks of the motion, rather than pass over them.
    pub locates_kinks: bool,
    /// Whether the forces are evaluated within steps only, so that nothing is lost where steps end at a jump of theirs.
    pub stays_within_steps: bool,
    /// What it requires of a system, in words; empty if it requires nothing.
    pub needs: &'static str,
    /// What it is good for, in a sentence or two, and its source.
    pub about: &'static str,
    /// Checks whether it can be used for a system.
    pub fits: fn(&System) -> Result<(), MethodError>,
    /// The lengths of the leapfrogs that a step is composed of, as parts of it; none for another method.
    pub leapfrogs: fn() -> Vec<f64>,
    /// Creates a stepper for a system.
    pub make: fn(&System, &Settings) -> StepperResult,
}

impl Method {
    /// These settings in plain `f64` where no other tolerance is asked for: several orbits are then carried side by side.
    #[must_use]
    pub fn fast(&self, mut settings: Settings) -> Settings {
        let (_, tolerance) = ACCURACIES[0];
        if self.stepping == Stepping::Adaptive && self.order.is_none() {
            settings.tolerance.get_or_insert(tolerance);
        }
        settings
    }
}

/// A stepper, or why there is none.
pub type StepperResult = Result<Box<dyn Stepper>, MethodError>;

/// The two accuracies of the default method that have a name, and their tolerances: series in plain
/// `f64`, and with the lowest orders in double-double.
pub const ACCURACIES: [(&str, f64); 2] = [("fast", 1e-15), ("exact", 1e-18)];

/// How a method chooses its steps.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Stepping {
    /// By a tolerance.
    Adaptive,
    /// All equal.
    Fixed,
}

/// Which structure of the exact motion a method preserves.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Preserves {
    /// Nothing but its accuracy.
    Nothing,
    /// The symplectic form.
    Symplectic,
    /// The symplectic form, and reversibility: a step backwards is the inverse of one forwards.
    SymplecticReversible,
}

impl Preserves {
    /// Whether the symplectic form is preserved.
    pub fn is_symplectic(self) -> bool {
        self != Preserves::Nothing
    }
}

/// The settings of a method that a user may change.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Settings {
    /// The step of a method of fixed step. If it is `None`, it is determined again at each start: a
    /// tenth of the steps that a Taylor series of modest accuracy takes along the motion ahead,
    /// which is about a hundredth of the period of an oscillation.
    pub step: Option<f64>,
    /// The relative tolerance of an adaptive method.
    pub tolerance: Option<f64>,
}

/// Why a method cannot be used for a system, as a sentence for the user.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[error("{method} cannot be used here: {reason}")]
pub struct MethodError {
    /// The method's name.
    pub method: &'static str,
    /// The reason.
    pub reason: String,
}
