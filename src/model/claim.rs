//! What a file wants watched, and what it claims of itself.

use crate::expr::Expr;

/// A range of bytes in the file, to point at when a claim turns out false.
pub type SourceRange = std::ops::Range<usize>;

/// A named quantity to be watched.
#[derive(Clone, Debug)]
pub struct Observable {
    /// Its name, also its column.
    pub name: String,
    /// In q, q̇, q̈, p, t, parameters, `energy`, `action`; earlier observables are opened.
    pub expression: Expr,
    /// Whether the file claims that it is conserved (`true`) or that it is not (`false`).
    pub conserved: Option<bool>,
    /// Where the claim stands.
    pub place: SourceRange,
}

/// The file's own test.
#[derive(Clone, Debug, Default)]
pub struct Expect {
    /// What is claimed to be conserved: `energy`, a momentum `p_x`, or an observable's name, each
    /// with its place.
    pub conserves: Vec<(String, Expr, SourceRange)>,
    /// Values the motion is to have.
    pub values: Vec<ExpectedValue>,
    /// When events and impulses are to happen.
    pub events: Vec<ExpectedEvent>,
    /// How often they are to happen.
    pub counts: Vec<ExpectedCount>,
    /// What brackets are to be.
    pub brackets: Vec<ExpectedBracket>,
}

/// A moment at which something is to happen.
#[derive(Clone, Debug)]
pub struct ExpectedEvent {
    /// The name of the event or impulse.
    pub name: String,
    /// Which time it is; the first is 1.
    pub nth: usize,
    /// When.
    pub at: f64,
    /// The absolute tolerance of the time; 1e-10 where the file gives none.
    pub within: f64,
    /// Where the number comes from.
    pub source: String,
    /// Where the claim stands.
    pub place: SourceRange,
}

/// How often something is to have happened.
#[derive(Clone, Debug)]
pub struct ExpectedCount {
    /// The name of the event or impulse.
    pub name: String,
    /// Until this time.
    pub until: f64,
    /// So often.
    pub is: usize,
    /// Where the number comes from.
    pub source: String,
    /// Where the claim stands.
    pub place: SourceRange,
}

/// \[f, g\] = is.
#[derive(Clone, Debug)]
pub struct ExpectedBracket {
    /// As in an observable.
    pub f: Expr,
    /// As in an observable.
    pub g: Expr,
    /// As in an observable.
    pub is: Expr,
    /// As the file writes f and g.
    pub written: String,
    /// Where it comes from.
    pub source: String,
    /// Where the claim stands.
    pub place: SourceRange,
}

/// A number the motion is to give.
#[derive(Clone, Debug)]
pub struct ExpectedValue {
    /// What it is.
    pub name: String,
    /// As in an observable.
    pub expression: Expr,
    /// At what time.
    pub at: f64,
    /// What it is to be.
    pub is: f64,
    /// The absolute tolerance; 1e-10 where the file gives none.
    pub within: f64,
    /// Where the number comes from.
    pub source: String,
    /// Where the claim stands.
    pub place: SourceRange,
}
