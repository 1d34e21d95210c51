//! Numbers: the arithmetic in which everything else is computed.
//!
//! In and out: numbers. A program is evaluated in [`Analytic`] numbers: `f64`, [`DoubleDouble`] for twice its
//! digits, [`ExtendedRange`] for values outside the range of both, a [`Batch`] of the numbers of several
//! orbits. A [`Number`] is a constant in an
//! expression. A [`PrimeField`] has the residues in which ranks are computed. [`math`] has the
//! elementary functions, with the same bits on every machine. [`eigenvalues`] are those of a small
//! matrix of `f64`, [`gauss`] the nodes of a quadrature. [`bisect`], [`false_position`] and [`newton`] find a root of one
//! number, [`golden_section`] a least value, [`significant`] and its kin write one. Never here: expressions, units, files.

mod batch;
mod batch_double;
mod birkhoff;
mod compensated;
mod convolution;
mod digest;
mod double_double;
mod eigenvalues;
mod exponent;
mod extended_range;
mod finite;
mod format;
mod four_lanes;
mod horner;
mod instruction_set;
mod interval;
pub mod math;
mod number;
mod polytope;
mod power_series;
mod prime_field;
mod quadrature;
mod real;
mod root;

pub use batch::{BATCH, Batch};
pub use batch_double::BatchDouble;
pub use birkhoff::birkhoff_average;
pub use compensated::accumulate;
pub use digest::digest;
pub use double_double::DoubleDouble;
pub use eigenvalues::{eigenvalues, has_squares};
pub use extended_range::ExtendedRange;
pub use finite::all_finite;
pub use format::{
    no_longer_than, push_shortest, rounded, short, shortest, significant, to_its_error,
};
pub use four_lanes::{FourLaneKernel, FourLanes, LANES, ScalarLanes, in_four_lanes};
pub use horner::{Polynomial, four_tails, padded, polynomial, tail, tails};
pub use instruction_set::{Kernel, vectorized};
pub use interval::Interval;
pub use number::{Number, gcd};
pub use polytope::OrientationPolytope;
pub use power_series::{cosine_of_arctangent, cosine_of_half, square_root};
pub use prime_field::{PRIMES, PrimeField, Residue, Unreduced, rational};
pub use quadrature::{gauss, legendre};
pub use real::{Analytic, Real};
pub use root::{ALL_HALVINGS, GOLDEN, bisect, false_position, golden_section, newton};
