//! What stands for machine code on processors for which none is generated: nothing is ever computed by it.

#![expect(
    clippy::unused_self,
    clippy::unnecessary_wraps,
    reason = "has the form of what it stands for"
)]

use crate::num::{Batch, DoubleDouble};
use crate::system::growth::{SeriesBuilder, SeriesClock};
use crate::system::program::Singular;

#[derive(Clone, Debug)]
pub(in crate::system) struct CodeCache;

impl CodeCache {
    /// An empty one.
    pub(in crate::system) fn new() -> CodeCache {
        CodeCache
    }
}

#[derive(Clone, Debug)]
pub(in crate::system) struct CompiledGrowth;

impl CompiledGrowth {
    pub(in crate::system) fn new(_: Option<&CodeCache>) -> CompiledGrowth {
        CompiledGrowth
    }

    pub(in crate::system) fn expect(&mut self, _: f64) {}

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
