//! The table of methods. To add one, write its file, ending in its row, and add its line here;
//! picker, command line, documents and tests follow.

use super::{Stepper, dop853, gauss, leapfrog, rk4, taylor, yoshida};
use crate::system::System;

/// The table; the first row is the default.
pub const METHODS: &[Method] = &[
    taylor::METHOD,
    leapfrog::METHOD,
    yoshida::FOURTH_ORDER,
    yoshida::SIXTH_ORDER,
    yoshida::EIGHTH_ORDER,
    gauss::FOURTH_ORDER,
    gauss::SIXTH_ORDER,
    dop853::METHOD,
    rk4::METHOD,
];

/// A way to step through time.
pub struct Method {
    /// As chosen on the command line and in a file.
    pub name: &'static str,
    /// Its name in full.
    pub title: &'static str,
    /// Its order; `None` where it follows the tolerance.
    pub order: Option<u32>,
    /// How it chooses its steps.
    pub stepping: Stepping,
    /// What it keeps.
    pub preserves: Preserves,
    /// Whether steps end on kinks of the motion, rather than pass over them.
    pub locates_kinks: bool,
    /// What a system must be for it, in words; empty where any will do.
    pub needs: &'static str,
    /// What it is good for, in a sentence or two, and its source.
    pub about: &'static str,
    /// Whether it can be used for a system, and why not.
    pub fits: fn(&System) -> Result<(), MethodError>,
    /// A stepper for a system.
    pub make: fn(&System, &Settings) -> StepperResult,
}

/// A stepper, or why there is none.
pub type StepperResult = Result<Box<dyn Stepper>, MethodError>;

/// How a method chooses its steps.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Stepping {
    /// By a tolerance.
    Adaptive,
    /// All alike.
    Fixed,
}

/// What a method keeps of the exact motion's structure.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Preserves {
    /// Nothing but its accuracy.
    Nothing,
    /// The symplectic form, and reversibility.
    Symplectic,
}

/// What a user may set.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Settings {
    /// The step of a method of fixed step. Where there is none it is found anew at each start: a
    /// tenth of the steps that a Taylor series of modest accuracy takes along the motion
    /// ahead, which makes some hundred steps in a period of an oscillation.
    pub step: Option<f64>,
    /// The relative tolerance of an adaptive method.
    pub tolerance: Option<f64>,
}

/// Why a method cannot be used for a system: a sentence for the user.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[error("{method} cannot be used here: {reason}")]
pub struct MethodError {
    /// The method's name.
    pub method: &'static str,
    /// Why.
    pub reason: String,
}

/// The method of a name; `auto` is the first.
pub fn method_named(name: &str) -> Option<&'static Method> {
    if name == "auto" {
        return METHODS.first();
    }
    METHODS.iter().find(|method| method.name == name)
}
