//! From a law to equations of motion: one file per derivation step, all of it symbolic.
//!
//! In: a [`Model`](crate::model::Model). Out: [`Equations`]: accelerations (or q̇ and ṗ), momenta, the energy and its
//! rate of change, conserved quantities and their reasons. Never here: numerical motion.

mod at_values;
mod attitude;
mod bracket;
mod canonical;
mod canonical_condition;
mod canonical_verdict;
mod chain;
mod chart;
mod closed_forms;
mod collected;
mod conjugate_root;
mod conservation;
mod constrain;
mod derive;
mod determinant;
mod dimension;
mod domain;
mod equations;
mod frames;
mod frobenius;
mod further;
mod gauge;
mod generating;
mod generator;
mod group;
mod hamilton;
mod hamilton_jacobi;
mod image_rates;
mod implicit_map;
mod impulse_change;
mod invariants;
mod inverse_reach;
mod isolate;
mod lagrange;
mod latex;
mod law_steps;
mod legendre;
mod linear;
mod missing_functions;
mod modulo;
mod momenta_at_rest;
mod named_ramps;
mod nearest_image;
mod new_hamiltonian;
mod observe;
mod one_sided;
mod poisson;
mod poisson_structure;
mod potential;
mod rate_of_change;
mod rearrange;
mod report;
mod restricted;
mod rigid_body;
mod sampling;
mod separation;
mod similarity;
mod slope;
mod structure;
mod structure_error;
mod symmetry;
mod symplectic_inverse;
mod vakonomic;
mod valuation;
mod weighted_degree;

pub use at_values::{absent_at, constant_at, vanishing_at};
pub use bracket::{ChainRule, Recognised, bracket, in_phase_space, recognise, unreduced_bracket};
pub use canonical::PhaseMap;
pub use canonical_verdict::{CanonicalVerdict, FailingBracket};
pub use chart::ChartBracket;
pub use conservation::{Class, Classed, class_of, classes};
pub use constrain::with_reactions;
pub use derive::{derive, derive_for_motion, exact_constants};
pub use domain::widened;
pub use equations::{
    Apparent, Auxiliary, AuxiliaryRates, CLOSED_FORM_LIMIT, Conserved, ConstraintRow,
    CoordinateSymbols, Equations, Flow, ImplicitMap, NamedRamps, NoClosedForm, Reason, Separable,
    Supplements, TransformationMaps, Vakonomic,
};
pub use further::{Further, GeneratorReport, TransformationReport};
pub use gauge::GaugeDifference;
pub use generating::{GeneratingFunction, NoFunction};
pub use generator::{GeneratorFlow, flow_of};
pub use group::{phase_maps, relations_of};
pub use hamilton_jacobi::HamiltonJacobi;
pub use implicit_map::guesses;
pub use impulse_change::is_changed_by_impulse;
pub use invariants::casimir_rate;
pub use latex::latex;
pub use legendre::{hamiltonian_to_lagrangian, lagrangian_to_hamiltonian};
pub use one_sided::OneSided;
pub use poisson_structure::structure_errors;
pub use report::{
    BodyNumbers, BodyReport, ConservedKind, ConservedReport, ConstraintReport, ImpulseReport,
    LeftSide, Reaction, Report, ReportedEquation,
};
pub use rigid_body::{
    COMPONENTS, RigidBody, Tensor, body_constants, body_values, matrix, principal,
};
pub use sampling::{ANY_POINTS, POINTS, TRIES};
pub use separation::separation;
pub use similarity::Similarity;
pub use structure::{Holonomy, Separation};
pub use structure_error::StructureError;
pub use valuation::Valuation;
pub use weighted_degree::weighted_degree;
