//! The Taylor series of one orbit or of several by machine code, which is generated while the program runs, and the values of a
//! program at one point.
//!
//! In: a program with its schedule, the orders that are wanted. Out: a function that computes them, with the bits of
//! [`Jet`](super::Jet); nothing where there is none, and the jet computes them itself. Never here: functions at order 0,
//! the widest precision, kinks and powers with a live exponent, events.
//!
//! ```text
//!   Program, Schedule ──▶ layout: where every number lies          Jet: order 0, factored matrices
//!                            │                                              │
//!                         emitter: order by order, each unrolled            │ values
//!                            │     plain, double, lanes; solution            │
//!                         basic_block: instructions in a straight line      │
//!                            │                                              │
//!                         allocation: their registers                       │
//!                         encoding: their bytes; product_loops              ▼
//!                            │                  function in memory ──▶ growth: series of the state and of what is
//!                         compile ──────────────────▲                          read whole
//!                            ▲
//!                         cache: one function for a system and its orders
//! ```
//!
//! The lowest orders are computed in double-double, those above in `f64`, by one function. What is arithmetic of order 0 in `f64`,
//! and of the terms of conserved quantities after each step, is a function as well (`values`). On processors other than
//! x86-64 nothing is generated (`absent`), nor where there is no AVX2.

#[cfg(not(target_arch = "x86_64"))]
mod absent;
#[cfg(target_arch = "x86_64")]
mod x86_64;

#[cfg(not(target_arch = "x86_64"))]
pub(super) use super::parts::Interpreted as CompiledValues;
#[cfg(not(target_arch = "x86_64"))]
pub(super) use absent::{CodeCache, CompiledGrowth};
#[cfg(target_arch = "x86_64")]
pub(super) use x86_64::{CodeCache, CompiledGrowth, CompiledValues};
