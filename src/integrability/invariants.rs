//! What a search for constants of the motion is asked, and what it answers.
//!
//! In: limits. Out: [`Invariants`]: what is found, how far it is proved, and what was searched. Never here: the search.

use super::known::KnownConstant;
use crate::expr::Expr;

/// Why a search ends where as many are known as can be independent.
pub(super) const EXHAUSTED: &str = "no more can be independent";

/// How far to search.
pub struct Limits<'a> {
    /// The greatest degree in the momenta; 6 if it is not given.
    pub degree: Option<u32>,
    /// Whether the search has to end: time is over, or it was cancelled.
    pub is_over: &'a dyn Fn() -> bool,
}

/// How far a constant of the motion is proved.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Proof {
    /// Symbolically, for all values of the parameters.
    Proved,
    /// Symbolically, for the parameters' present values, which are put in.
    AtTheseParameters,
    /// It holds at every random point modulo a prime, which is no proof.
    Unproved,
}

/// A constant of the motion that was found.
#[derive(Clone, Debug)]
pub struct Constant {
    /// As a function of the state: (q, p) where H is known and nothing else acts, (q, q̇) or the variables of a
    /// Poisson system elsewhere.
    pub expression: Expr,
    /// Its degree in the momenta (or velocities, or variables).
    pub degree: u32,
    /// How far it is proved.
    pub proof: Proof,
    /// Whether it is functionally independent of those known and those found before it.
    pub independent: bool,
    /// Whether an impulse of the file may change it.
    pub between_impulses: bool,
    /// With the parameters' values put in.
    pub(super) here: Expr,
}

/// One ansatz that was searched to the end.
#[derive(Clone, Debug)]
pub struct Searched {
    /// The degree in the momenta.
    pub degree: u32,
    /// The ansatz in words, with expressions as files have them.
    pub family: String,
    /// The same with expressions as the screen shows them.
    pub shown: String,
    /// The number of its independent monomials.
    pub size: usize,
    /// Whether it is the standard family of its degree, of which absence is stated.
    pub standard: bool,
}

/// What a search found.
#[derive(Clone, Debug, Default)]
pub struct Invariants {
    /// The constants of the motion that the equations already have.
    pub known: Vec<KnownConstant>,
    /// Which of them are independent of those before.
    pub known_independent: Vec<bool>,
    /// The constants that the file does not name.
    pub found: Vec<Constant>,
    /// What was searched to the end.
    pub searched: Vec<Searched>,
    /// The greatest degree up to which nothing else exists in what was searched.
    pub none_up_to: Option<u32>,
    /// The dimension of the space of states, less constraints.
    pub dimension: usize,
    /// Why the search ended early, or was not made.
    pub ended: Option<String>,
    /// Whether the law contains the time, so that constants without it are few.
    pub driven: bool,
}

impl Invariants {
    /// Whether as many are known as can be independent, so that a longer search finds no other.
    pub fn is_exhausted(&self) -> bool {
        self.ended.as_deref() == Some(EXHAUSTED)
    }

    /// The number of independent constants, known and found.
    pub fn independent(&self) -> usize {
        self.known_independent.iter().filter(|x| **x).count()
            + self.found.iter().filter(|c| c.independent).count()
    }
}
