//! Series that grow by machine code.
//!
//! In: a series whose lowest orders are known. Out: all its orders, or that it is to be grown without. Never here: why a
//! series has no code.

use std::sync::Arc;

use super::cache::CodeCache;
use super::emitter::Extent;
use super::function::CompiledFunction;
use super::layout::Layout;
use crate::system::growth::{SeriesBuilder, SeriesClock};
use crate::system::jet::Jet;
use crate::system::program::Singular;

/// So many series are computed before a function is compiled: short motions end before it pays.
const PATIENCE: u32 = 64;

/// The growth of one series by machine code.
#[derive(Clone, Debug)]
pub(in crate::system) struct CompiledGrowth {
    cache: Option<CodeCache>,
    /// The number of series that were asked for.
    asked: u32,
    code: Option<Code>,
    /// Whether the last one was computed.
    has_grown: bool,
}

/// A function and the numbers that it works with.
#[derive(Clone, Debug)]
struct Code {
    function: Arc<CompiledFunction>,
    work: Vec<f64>,
}

impl CompiledGrowth {
    /// That of a series of the program that a cache belongs to; without one, nothing is ever computed.
    pub(in crate::system) fn new(cache: Option<&CodeCache>) -> CompiledGrowth {
        CompiledGrowth { cache: cache.cloned(), asked: 0, code: None, has_grown: false }
    }

    /// Whether the last series was computed by machine code.
    pub(in crate::system) fn has_grown(&self) -> bool {
        self.has_grown
    }

    /// Computes the orders above `first` of the state. Returns false where that is to be done without machine code.
    pub(in crate::system) fn grow(
        &mut self,
        builder: &mut SeriesBuilder<f64>,
        first: usize,
        clock: SeriesClock<f64>,
    ) -> Result<bool, Singular> {
        self.has_grown = false;
        if self.asked < PATIENCE {
            self.asked += 1;
            if self.asked < PATIENCE {
                return Ok(false);
            }
            let (numbers, inputs) = (builder.len(), builder.inputs);
            let extent = Extent { first, numbers, inputs };
            let function =
                self.cache.as_ref().and_then(|cache| cache.function(&builder.jet.plan(), extent));
            self.code = function.map(Code::of);
        }
        if let Some(code) = &mut self.code {
            self.has_grown = code.grow(builder, first, clock)?;
        }
        Ok(self.has_grown)
    }
}

impl Code {
    fn of(function: Arc<CompiledFunction>) -> Code {
        Code { work: function.layout().first_work(), function }
    }

    fn grow(
        &mut self,
        builder: &mut SeriesBuilder<f64>,
        first: usize,
        clock: SeriesClock<f64>,
    ) -> Result<bool, Singular> {
        if first == 0 {
            builder.evaluate(clock)?;
        }
        let layout = self.function.layout();
        let values = builder.jet.row(0);
        if layout.vanishing.iter().any(|&r| values[r as usize] == 0.0) {
            return Ok(false);
        }
        take_matrices(&builder.jet, layout, &mut self.work);
        take_orders(&builder.jet, layout, &mut self.work, first);
        let (jet, state) = builder.parts();
        let (values, series) = jet.values_and_series();
        self.function.call(values, &mut self.work, series, state, clock.scale);
        Ok(true)
    }
}

/// Takes the factored matrices of a jet.
fn take_matrices(jet: &Jet<f64>, layout: &Layout, work: &mut [f64]) {
    for (place, factored) in layout.factored.iter().zip(jet.factored()) {
        let size = factored.size();
        for (i, (row, entries)) in factored.rows().enumerate() {
            work[place.entries + i * size..][..size].copy_from_slice(entries);
            // its offset in bytes
            work[place.rows + i] = f64::from_bits(8 * row as u64);
        }
    }
}

/// Takes the orders below `first` of all operands.
fn take_orders(jet: &Jet<f64>, layout: &Layout, work: &mut [f64], first: usize) {
    for k in 1..first {
        for (i, &coefficient) in jet.row(k).iter().enumerate() {
            for address in layout.operands(i, k) {
                work[address.offset] = coefficient;
            }
        }
    }
}
