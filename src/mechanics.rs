//! From a law to equations of motion: one file per arrow, all of it symbolic.
//!
//! In: a [`Model`]. Out: [`Equations`]: accelerations (or q̇ and ṗ), momenta, energy and the law
//! of its change, what is conserved and why. Never here: numbers in motion.

mod attitude;
mod bracket;
mod class;
mod comparison;
mod constrain;
mod derive;
mod dimension;
mod equations;
mod flaw;
mod frames;
mod hamilton;
mod invariants;
mod lagrange;
mod legendre;
mod linear;
mod modulo;
mod nearby;
mod observe;
mod poisson;
mod report;
mod rigid_body;
mod slope;
mod structure;
mod symmetry;
mod valuation;

pub use bracket::{ChainRule, Recognised, bracket, in_phase_space, rate_by_bracket, recognise};
pub use class::{Class, Classed, class_of, classes};
pub use constrain::with_reactions;
pub use derive::derive;
pub use equations::{
    Apparent, Beside, CLOSED_FORM_LIMIT, Carried, CarriedRates, Conserved, ConstraintRow,
    CoordinateSymbols, Equations, Flow, Reason, Separable, Twin, WhyNot,
};
pub use flaw::Flaw;
pub use invariants::casimir_rate;
pub use legendre::{hamiltonian_to_lagrangian, lagrangian_to_hamiltonian};
pub use nearby::{POINTS, TRIES};
pub use report::{
    Blow, BodyNumbers, BodyReport, Constant, Constrained, Further, Kept, Left, Line, Reaction,
    Report,
};
pub use rigid_body::{
    COMPONENTS, RigidBody, Tensor, body_constants, body_values, matrix, principal,
};
pub use structure::flaws;
pub use valuation::Valuation;
