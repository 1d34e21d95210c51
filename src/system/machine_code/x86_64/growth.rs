//! Series that grow by machine code.
//!
//! In: a series whose origin is known. Out: all its orders, or that it is to be grown without. Never here: why a
//! series has no code.

use std::sync::Arc;

use super::basic_block::Width;
use super::cache::{Availability, CodeCache};
use super::compile::{Compiled, SeriesExtent};
use super::function::{BatchStretches, Stretches, Values, WorkMemory, widest};
use super::layout::FactoredPlace;
use super::values::CompiledValues;
use crate::num::{Batch, DoubleDouble, Real};
use crate::system::growth::{SeriesBuilder, SeriesClock};
use crate::system::program::Singular;
use crate::system::solve::Factored;

/// The growth of one series by machine code.
#[derive(Clone, Debug)]
pub(in crate::system) struct CompiledGrowth {
    /// The functions, until it is decided whether there is one.
    cache: Option<CodeCache>,
    code: Option<CodeInUse>,
    /// How many series are expected to follow the next one, as far as that is known.
    expected: f64,
    /// Whether the last one was computed.
    has_grown: bool,
}

/// A function and the numbers that it works with.
#[derive(Clone, Debug)]
struct CodeInUse {
    compiled: Arc<Compiled>,
    work: WorkMemory,
    /// What computes order 0.
    values: CompiledValues,
}

impl CompiledGrowth {
    /// That of a series of the program that a cache belongs to; without one, nothing is ever computed.
    pub(in crate::system) fn new(cache: Option<&CodeCache>) -> CompiledGrowth {
        CompiledGrowth { cache: cache.cloned(), code: None, expected: 0.0, has_grown: false }
    }

    /// Says how many series are expected to follow the next one.
    pub(in crate::system) fn expect(&mut self, count: f64) {
        self.expected = count;
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
        let expected = self.expected;
        self.ask(|cache| {
            let extent =
                SeriesExtent { orbits: Width::One, numbers: high.len(), inputs: high.inputs };
            let exact = low.as_ref().map(|low| low.jet.plan());
            cache.function(&high.jet.plan(), exact.as_ref(), extent, expected)
        });
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
        self.ask(|cache| {
            let (numbers, inputs) = (builder.len(), builder.inputs);
            let extent = SeriesExtent { orbits: widest(), numbers, inputs };
            cache.function(&builder.jet.plan(), None, extent, 0.0)
        });
        self.has_grown = false;
        if let Some(code) = &mut self.code {
            self.has_grown = code.grow_all(builder, clock)?;
        }
        Ok(self.has_grown)
    }

    /// Takes a function once it pays.
    fn ask(&mut self, function: impl FnOnce(&CodeCache) -> Availability) {
        let Some(cache) = &self.cache else { return };
        self.code = match function(cache) {
            Availability::NotYet => return,
            Availability::Never => None,
            Availability::Compiled(compiled) => Some(CodeInUse::of(compiled)),
        };
        self.cache = None;
    }
}

impl CodeInUse {
    fn of(compiled: Arc<Compiled>) -> CodeInUse {
        CodeInUse { work: compiled.work.clone(), compiled, values: CompiledValues::default() }
    }

    fn grow(
        &mut self,
        high: &mut SeriesBuilder<f64>,
        clock: SeriesClock<f64>,
    ) -> Result<bool, Singular> {
        high.evaluate(&mut self.values, clock)?;
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
        low.evaluate(&mut self.values, SeriesClock::new(time, scale))?;
        let values = low.jet.values();
        if self.vanishes(values) || self.divides_badly(values) {
            return Ok(false);
        }
        high.take_origin(low);
        self.work.copy(self.compiled.values.offset, high.jet.values());
        take_matrices(high.jet.factored(), &self.compiled.factored, &mut self.work);
        let places = &self.compiled.exactly_factored;
        if !take_matrices(low.jet.factored(), places, &mut self.work) {
            return Ok(false);
        }
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
        builder.evaluate(&mut self.values, clock)?;
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

    /// Whether something is divided by what has no reciprocal of all digits.
    fn divides_badly(&self, values: &[DoubleDouble]) -> bool {
        self.compiled.divisors.iter().any(|&r| !values[r as usize].has_reciprocal())
    }
}

/// Takes the factored matrices of a jet. Returns whether all entries are finite, and all pivots have reciprocals.
fn take_matrices<R: Real>(
    matrices: &[Factored<R>],
    places: &[FactoredPlace],
    work: &mut WorkMemory,
) -> bool {
    if places.is_empty() {
        return true;
    }
    let mut regular = true;
    // the number of `f64` of a number
    let size = size_of::<R>() / size_of::<f64>();
    for (place, factored) in places.iter().zip(matrices) {
        let n = factored.size();
        if n == 1 {
            // the code reads the number where it lies
            let is_pivot = |x: DoubleDouble| x.high.is_finite() && x.has_reciprocal();
            regular &= factored.rows().all(|(_, entries)| is_pivot(entries[0].double()));
            continue;
        }
        for (i, (row, entries)) in factored.rows().enumerate() {
            for (j, entry) in entries.iter().enumerate() {
                let at = place.entries + (i * n + j) * size;
                let double = entry.double();
                regular &= double.high.is_finite() && (i != j || double.has_reciprocal());
                work.set(at, double.high);
                if size > 1 {
                    work.set(at + 1, double.low);
                }
            }
            // its offset in bytes
            work.set(place.rows + i, f64::from_bits((8 * size * row) as u64));
        }
    }
    regular
}

#[cfg(test)]
mod tests {
    use super::super::compile::compile;
    use super::*;
    use crate::cancel::Cancel;
    use crate::expr::{FunctionId, Pool};
    use crate::system::jet::Jet;
    use crate::system::program::Program;

    /// ẋ = sin x/(2 + x y), ẏ = x² − y t + Σ sin kx: more numbers at a time than there are registers.
    fn program() -> Arc<Program> {
        let mut pool = Pool::new();
        let [x, y, t] = ["x", "y", "t"].map(|name| pool.symbol(name));
        let [a, b, time] = [x, y, t].map(|symbol| pool.variable(symbol));
        let sine = pool.call(FunctionId::Sin, &[a]);
        let (product, two) = (pool.mul(a, b), pool.integer(2));
        let below = pool.add(two, product);
        let first = pool.div(sine, below);
        let (square, fading) = (pool.mul(a, a), pool.mul(b, time));
        let mut second = pool.sub(square, fading);
        for k in 1..=12 {
            let factor = pool.integer(k);
            let angle = pool.mul(factor, a);
            let wave = pool.call(FunctionId::Sin, &[angle]);
            second = pool.add(second, wave);
        }
        Program::compile(&mut pool, &[], t, &[x, y], &[first, second]).expect("all are inputs")
    }

    /// Eight orbits at their origins, and their clock.
    fn orbits() -> (SeriesBuilder<Batch>, SeriesClock<Batch>) {
        let mut builder = SeriesBuilder::new(Jet::<Batch>::new(program(), 12), 2, 2);
        builder.jet.set_parameters(&[]);
        for i in 0..2 {
            let origin = |lane: usize| 0.1 * (lane + 3 * i) as f64 + 0.2;
            builder.set_origin(i, Batch(std::array::from_fn(origin)));
        }
        (builder, SeriesClock { time: Batch::splat(0.3), scale: Batch::splat(0.5) })
    }

    fn bits(builder: &SeriesBuilder<Batch>) -> Vec<u64> {
        builder.coefficients().iter().flat_map(|c| c.0.map(f64::to_bits)).collect()
    }

    #[test]
    fn four_orbits_at_once_have_the_bits_of_eight() {
        let (mut plain, clock) = orbits();
        assert!(plain.grow_plainly(0, clock, &Cancel::new()).is_ok());
        let widths = [Width::Four, Width::Eight].into_iter();
        for width in widths.filter(|width| width.numbers() <= widest().numbers()) {
            let (mut builder, clock) = orbits();
            let extent = SeriesExtent { orbits: width, numbers: 2, inputs: 2 };
            let compiled = compile(&builder.jet.plan(), None, extent);
            let mut code = CodeInUse::of(Arc::new(compiled.expect("a processor with AVX2")));
            assert!(code.grow_all(&mut builder, clock).expect("regular"));
            assert_eq!(bits(&builder), bits(&plain), "{width:?}");
        }
    }
}
