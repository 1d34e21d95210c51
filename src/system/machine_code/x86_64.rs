//! Machine code for x86-64 processors with AVX2; eight orbits at once with AVX-512 where there is that.
//!
//! In and out: as [`machine_code`](super) says. Never here: other processors.

mod allocation;
mod arithmetic;
mod basic_block;
mod cache;
mod compile;
mod double;
mod emitter;
mod encoding;
mod function;
mod growth;
mod layout;
mod plain;
mod product_loops;
mod reciprocal;
mod solution;
mod values;

pub(in crate::system) use cache::CodeCache;
pub(in crate::system) use growth::CompiledGrowth;
pub(in crate::system) use values::CompiledValues;
