//! The Taylor series of one orbit in `f64` by machine code, which is generated while the program runs.
//!
//! In: a program with its schedule, the orders that are wanted. Out: a function that computes them, with the bits of
//! [`Jet`](super::Jet); nothing where there is none, and the jet computes them itself. Never here: numbers at order 0,
//! wider precisions, several orbits, kinks and powers with a live exponent, events.
//!
//! ```text
//!   Program, Schedule ──▶ layout: where every number lies      Jet: order 0, factored matrices
//!                            │                                          │
//!                         emitter: order by order, each unrolled        │ values
//!                            │        inner_product, solution           ▼
//!                         function: machine code ──▶ growth: series of the state and of what is read whole
//!                            ▲
//!                         cache: one function for a system and its orders
//! ```
//!
//! Without the cargo feature `jit` nothing is generated (`absent`).

#[cfg(not(feature = "jit"))]
mod absent;
#[cfg(feature = "jit")]
mod cache;
#[cfg(feature = "jit")]
mod emitter;
#[cfg(feature = "jit")]
mod function;
#[cfg(feature = "jit")]
mod growth;
#[cfg(feature = "jit")]
mod inner_product;
#[cfg(feature = "jit")]
mod layout;
#[cfg(feature = "jit")]
mod solution;

#[cfg(not(feature = "jit"))]
pub(super) use absent::{CodeCache, CompiledGrowth};
#[cfg(feature = "jit")]
pub(super) use cache::CodeCache;
#[cfg(feature = "jit")]
pub(super) use growth::CompiledGrowth;
