//! Series that grow by machine code.
//!
//! In: a series whose origin is known. Out: all its orders, or that it is to be grown without. Never here: why a
//! series has no code.

use std::sync::Arc;

use super::cache::CodeCache;
use super::compile::{Compiled, Extent};
use super::function::{BatchStretches, Stretches, Values, Work};
use super::layout::FactoredPlace;
use crate::num::{BATCH, Batch, DoubleDouble, Real};
use crate::system::growth::{SeriesBuilder, SeriesClock};
use crate::system::program::Singular;
use crate::system::solve::Factored;

/// The growth of one series by machine code.
#[derive(Clone, Debug)]
pub(in crate::system) struct CompiledGrowth {
    /// The functions, until one was asked for.
    cache: Option<CodeCache>,
    code: Option<Code>,
    /// Whether the last one was computed.
    has_grown: bool,
}

/// A function and the numbers that it works with.
#[derive(Clone, Debug)]
struct Code {
    compiled: Arc<Compiled>,
    work: Work,
}

impl CompiledGrowth {
    /// That of a series of the program that a cache belongs to; without one, nothing is ever computed.
    pub(in crate::system) fn new(cache: Option<&CodeCache>) -> CompiledGrowth {
        CompiledGrowth { cache: cache.cloned(), code: None, has_grown: false }
    }

    /// Whether the last series was computed by machine code.
    pub(in crate::system) fn has_grown(&self) -> bool {
        self.has_grown
    }

    /// Computes all orders of a series from its origin, the lowest in double-double as well where there is a series for
    /// them. Returns false where that is to be done without machine code.
    pub(in crate::system) fn grow(
        &mut self,
        high: &mut SeriesBuilder<f64>,
        low: Option<&mut SeriesBuilder<DoubleDouble>>,
        (time, scale): (DoubleDouble, f64),
    ) -> Result<bool, Singular> {
        self.has_grown = false;
        let extent = Extent { orbits: 1, numbers: high.len(), inputs: high.inputs };
        let exact = low.as_ref().map(|low| low.jet.plan());
        self.ask(1, |cache| cache.function(&high.jet.plan(), exact.as_ref(), extent));
        if let Some(code) = &mut self.code {
            code.work.set(code.compiled.scale.offset, scale);
            self.has_grown = match low {
                Some(low) => code.grow_exactly(high, low, (time, scale))?,
                None => code.grow(high, SeriesClock::new(time, scale))?,
            };
        }
        Ok(self.has_grown)
    }

    /// Computes all orders of the series of several orbits. Returns false where that is to be done without machine code.
    pub(in crate::system) fn grow_all(
        &mut self,
        builder: &mut SeriesBuilder<Batch>,
        clock: SeriesClock<Batch>,
    ) -> Result<bool, Singular> {
        let extent = Extent { orbits: BATCH, numbers: builder.len(), inputs: builder.inputs };
        self.ask(BATCH, |cache| cache.function(&builder.jet.plan(), None, extent));
        self.has_grown = false;
        if let Some(code) = &mut self.code {
            self.has_grown = code.grow_all(builder, clock)?;
        }
        Ok(self.has_grown)
    }

    /// Takes a function for so many orbits once it pays.
    fn ask(&mut self, orbits: usize, function: impl FnOnce(&CodeCache) -> Option<Arc<Compiled>>) {
        if let Some(cache) = self.cache.take_if(|cache| cache.pays(orbits)) {
            self.code = function(&cache).map(Code::of);
        }
    }
}

impl Code {
    fn of(compiled: Arc<Compiled>) -> Code {
        Code { work: compiled.work.clone(), compiled }
    }

    fn grow(
        &mut self,
        high: &mut SeriesBuilder<f64>,
        clock: SeriesClock<f64>,
    ) -> Result<bool, Singular> {
        high.evaluate(clock)?;
        if self.vanishes(high.jet.values()) {
            return Ok(false);
        }
        take_matrices(high.jet.factored(), &self.compiled.factored, &mut self.work);
        let (jet, state) = high.parts();
        let (values, series) = jet.values_and_series();
        let (values, work) = (Values::Plain(values), &mut self.work);
        let (exact_series, exact_state) = (&mut [][..], &mut [][..]);
        let memory = Stretches { values, work, series, state, exact_series, exact_state };
        self.compiled.function.call(memory);
        Ok(true)
    }

    fn grow_exactly(
        &mut self,
        high: &mut SeriesBuilder<f64>,
        low: &mut SeriesBuilder<DoubleDouble>,
        (time, scale): (DoubleDouble, f64),
    ) -> Result<bool, Singular> {
        low.evaluate(SeriesClock::new(time, scale))?;
        let values = low.jet.values();
        if self.vanishes(values) || self.divides_badly(values) {
            return Ok(false);
        }
        high.take_origin(low)?;
        self.work.copy(self.compiled.values.offset, high.jet.values());
        take_matrices(high.jet.factored(), &self.compiled.factored, &mut self.work);
        take_matrices(low.jet.factored(), &self.compiled.exactly_factored, &mut self.work);
        let (jet, exact_state) = low.parts();
        let (values, exact_series) = jet.values_and_series();
        let (values, work) = (Values::Exact(values), &mut self.work);
        let (jet, state) = high.parts();
        let (_, series) = jet.values_and_series();
        let memory = Stretches { values, work, series, state, exact_series, exact_state };
        self.compiled.function.call(memory);
        Ok(true)
    }

    fn grow_all(
        &mut self,
        builder: &mut SeriesBuilder<Batch>,
        clock: SeriesClock<Batch>,
    ) -> Result<bool, Singular> {
        builder.evaluate(clock)?;
        let values = builder.jet.values();
        let vanishes = |r: &u32| values[*r as usize].0.contains(&0.0);
        if self.compiled.vanishing.iter().any(vanishes) {
            return Ok(false);
        }
        self.work.copy(self.compiled.scale.offset, &clock.scale.0);
        let (jet, state) = builder.parts();
        let (values, series) = jet.values_and_series();
        let work = &mut self.work;
        self.compiled.function.call_for_all(BatchStretches { values, work, series, state });
        Ok(true)
    }

    /// Whether a series that would be compared with zero begins with it.
    fn vanishes<R: Real>(&self, values: &[R]) -> bool {
        self.compiled.vanishing.iter().any(|&r| values[r as usize].value() == 0.0)
    }

    /// Whether something is divided by what is zero or not finite.
    fn divides_badly(&self, values: &[DoubleDouble]) -> bool {
        let is_bad = |x: f64| x == 0.0 || !x.is_finite();
        self.compiled.divisors.iter().any(|&r| is_bad(values[r as usize].high))
    }
}

/// Takes the factored matrices of a jet.
fn take_matrices<R: Real>(matrices: &[Factored<R>], places: &[FactoredPlace], work: &mut Work) {
    // the number of `f64` of a number
    let size = size_of::<R>() / size_of::<f64>();
    for (place, factored) in places.iter().zip(matrices) {
        let n = factored.size();
        for (i, (row, entries)) in factored.rows().enumerate() {
            for (j, entry) in entries.iter().enumerate() {
                let at = place.entries + (i * n + j) * size;
                let double = entry.double();
                work.set(at, double.high);
                if size > 1 {
                    work.set(at + 1, double.low);
                }
            }
            // its offset in bytes
            work.set(place.rows + i, f64::from_bits((8 * size * row) as u64));
        }
    }
}
