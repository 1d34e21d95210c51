//! What stands for machine code on processors for which none is generated: nothing is ever computed by it.

#![expect(
    clippy::unused_self,
    clippy::unnecessary_wraps,
    reason = "has the form of what it stands for"
)]

use std::ops::Range;

use crate::num::{Batch, DoubleDouble};
use crate::system::growth::{SeriesBuilder, SeriesClock};
use crate::system::parts::Parts;
use crate::system::program::{Program, Singular};

/// No functions.
#[derive(Clone, Debug)]
pub(in crate::system) struct CodeCache;

impl CodeCache {
    /// An empty one.
    pub(in crate::system) fn new() -> CodeCache {
        CodeCache
    }
}

/// No growth.
#[derive(Clone, Debug)]
pub(in crate::system) struct CompiledGrowth;

impl CompiledGrowth {
    /// Nothing, for a system.
    pub(in crate::system) fn new(_: Option<&CodeCache>) -> CompiledGrowth {
        CompiledGrowth
    }

    /// False.
    pub(in crate::system) fn has_grown(&self) -> bool {
        false
    }

    /// False: no order is computed.
    pub(in crate::system) fn grow(
        &mut self,
        _: &mut SeriesBuilder<f64>,
        _: Option<&mut SeriesBuilder<DoubleDouble>>,
        _: (DoubleDouble, f64),
    ) -> Result<bool, Singular> {
        Ok(false)
    }

    /// False: no order is computed.
    pub(in crate::system) fn grow_all(
        &mut self,
        _: &mut SeriesBuilder<Batch>,
        _: SeriesClock<Batch>,
    ) -> Result<bool, Singular> {
        Ok(false)
    }
}

/// No parts.
#[derive(Clone, Debug, Default)]
pub(in crate::system) struct CompiledValues;

impl Parts for CompiledValues {
    fn evaluate<M, E>(
        &mut self,
        program: &Program,
        memory: &mut M,
        _: impl Fn(&mut M) -> Option<&mut [f64]>,
        interpret: impl Fn(&mut M, Range<usize>) -> Result<(), E>,
    ) -> Result<(), E> {
        interpret(memory, 0..program.body.len())
    }
}
