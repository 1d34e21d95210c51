//! The quantities that a file observes, and its claims about its own motion.

use crate::expr::Expr;

use crate::diagnostic::SourceRange;

/// A named quantity to be observed.
#[derive(Clone, Debug)]
pub struct Observable {
    /// Its name, also that of its column.
    pub name: String,
    /// In q, q̇, q̈, p, t, parameters, `energy`, `action`; earlier observables are already
    /// substituted.
    pub expression: Expr,
    /// The file's claim that it is conserved (`true`) or not conserved (`false`), if there is one.
    pub conserved: Option<bool>,
    /// Its unit; empty if it is the one that follows from those of coordinates and parameters.
    pub unit: String,
    /// The place of the claim in the file.
    pub place: SourceRange,
}

/// The file's own tests.
#[derive(Clone, Debug, Default)]
pub struct Expect {
    /// The quantities claimed to be conserved: `energy`, a momentum `p_x`, or an observable's name,
    /// each with its place.
    pub conserves: Vec<(String, Expr, SourceRange)>,
    /// Expected values of the motion.
    pub values: Vec<ExpectedValue>,
    /// Expected times of events and impulses.
    pub events: Vec<ExpectedEvent>,
    /// Expected counts of events and impulses.
    pub counts: Vec<ExpectedCount>,
    /// Expected values of brackets.
    pub brackets: Vec<ExpectedBracket>,
    /// Transformations that are expected to be a step of a method.
    pub steps: Vec<ExpectedStep>,
    /// The expected number of independent constants of the motion.
    pub invariants: Option<ExpectedInvariants>,
}

/// The expected number of independent constants of the motion that do not contain the time.
#[derive(Clone, Debug)]
pub struct ExpectedInvariants {
    /// The number, the energy among them.
    pub is: usize,
    /// The degree in the momenta up to which they are searched.
    pub degree: u32,
    /// The place of the claim in the file.
    pub place: SourceRange,
}

/// The expected time of an event or impulse.
#[derive(Clone, Debug)]
pub struct ExpectedEvent {
    /// The name of the event or impulse.
    pub name: String,
    /// The index of the occurrence; the first is 1.
    pub nth: usize,
    /// The expected time.
    pub at: f64,
    /// The absolute tolerance of the time, if the file gives one.
    pub within: Option<f64>,
    /// The source of the number.
    pub source: String,
    /// The place of the claim in the file.
    pub place: SourceRange,
}

/// The expected number of occurrences of an event or impulse.
#[derive(Clone, Debug)]
pub struct ExpectedCount {
    /// The name of the event or impulse.
    pub name: String,
    /// The time up to which occurrences are counted.
    pub until: f64,
    /// The expected count.
    pub is: usize,
    /// The source of the number.
    pub source: String,
    /// The place of the claim in the file.
    pub place: SourceRange,
}

/// The expected value of a bracket: \[f, g\] = is.
#[derive(Clone, Debug)]
pub struct ExpectedBracket {
    /// The first argument, written as an observable is.
    pub f: Expr,
    /// The second argument, written as an observable is.
    pub g: Expr,
    /// The expected bracket, written as an observable is.
    pub is: Expr,
    /// f and g as written in the file.
    pub written: String,
    /// The source of the claim.
    pub source: String,
    /// The place of the claim in the file.
    pub place: SourceRange,
}

/// A transformation that is one step of a method of integration.
#[derive(Clone, Debug)]
pub struct ExpectedStep {
    /// The name of the transformation.
    pub transformation: String,
    /// The name of the method.
    pub method: String,
    /// The step, in parameters.
    pub step: Expr,
    /// How far images and derivatives may lie apart, beside their size; 1e-10 if the file gives nothing.
    pub within: f64,
    /// The source of the claim.
    pub source: String,
    /// The place of the claim in the file.
    pub place: SourceRange,
}

/// An expected value of a quantity.
#[derive(Clone, Debug)]
pub struct ExpectedValue {
    /// The name of the quantity.
    pub name: String,
    /// The quantity, written as an observable is.
    pub expression: Expr,
    /// The time at which it is evaluated.
    pub at: f64,
    /// The expected value.
    pub is: f64,
    /// The absolute tolerance, if the file gives one.
    pub within: Option<f64>,
    /// The source of the number.
    pub source: String,
    /// The place of the claim in the file.
    pub place: SourceRange,
}
