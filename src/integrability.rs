//! What is conserved: constants of the motion found, proved, and proved absent.
//!
//! In: a model and its equations. Out: the constants of the motion that are polynomials in what the law is made of,
//! found by linear algebra modulo a prime and proved symbolically, and a statement of what was searched. Never here:
//! derivations, which are `mechanics`'; lowering, which is `system`'s; motion; clocks.

mod ansatz;
mod atoms;
mod coefficients;
mod determining_equations;
mod echelon;
mod evaluator;
mod explicit_motion;
mod formula;
mod found_names;
mod invariants;
mod involution;
mod known;
mod law;
mod level;
mod lie;
mod naming;
mod node_operation;
mod noether;
mod occurring_functions;
mod positive_roots;
mod quadratic;
mod radicals;
mod ramps;
mod random;
mod reflection;
mod scope;
mod search;
mod separation;
mod stand_in;
mod summary;
mod symmetry_flow;
mod transformations;
mod units;
mod vanishing;
mod varied_lagrangian;
mod verdict;

pub use found_names::found_names;
pub use invariants::{Constant, Invariants, Limits, Proof, Searched};
pub use involution::Commuting;
pub use known::KnownConstant;
pub use law::is_hamiltonian;
pub use lie::{PointSymmetries, PointSymmetry, point_symmetries};
pub use noether::{Symmetries, symmetries};
pub use search::{SIZE_LIMIT, invariants};
pub use separation::separates;
pub use summary::summary;
pub use symmetry_flow::symmetry_flow;
pub use transformations::changed;
pub use units::Unsupported;
pub use varied_lagrangian::Symmetry;
pub use verdict::{Relations, relations};
