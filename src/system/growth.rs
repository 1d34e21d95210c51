//! The Taylor series of a motion in one precision, built order by order.
//!
//! In: the numbers of a state, the sides of its switches. Out: coefficients, or why there are none.
//! Never here: the choice of precision for each order, time.

use super::jet::{Coefficient, Jet, Side};
#[cfg(target_arch = "x86_64")]
use super::parts::PartwiseEvaluation;
use super::program::Singular;
use super::solve::Factored;
use super::state_sum::SeriesList;
use crate::cancel::Cancel;
use crate::num::{Analytic, DoubleDouble, ExtendedRange, Kernel, Real, vectorized};

/// The time of the origin, and the unit of time.
#[derive(Clone, Copy)]
pub(super) struct SeriesClock<R: Coefficient> {
    pub(super) time: R,
    pub(super) scale: R::Unit,
}

impl<R: Real> SeriesClock<R> {
    pub(super) fn new(time: DoubleDouble, scale: f64) -> SeriesClock<R> {
        SeriesClock { time: R::of(time), scale }
    }
}

/// Why a series cannot be built.
pub(super) enum Halt {
    Singular(Singular),
    /// No weights keep the switches at zero.
    Sticks,
    Cancelled,
}

impl From<Singular> for Halt {
    fn from(singular: Singular) -> Halt {
        Halt::Singular(singular)
    }
}

/// The series in one precision, built order by order.
#[derive(Clone, Debug)]
pub(super) struct SeriesBuilder<R: Coefficient> {
    pub(super) jet: Jet<R>,
    /// The highest order of the state's series.
    pub(super) order: usize,
    pub(super) inputs: usize,
    /// The coefficients of each number of the state, `order + 1` of them.
    state: Vec<R>,
    /// The switches that are kept at zero.
    pub(super) sliding: Vec<usize>,
    /// The number of orders after which a weight affects these switches: one if it acts on the
    /// numbers they depend on, two if it acts on the rates of these.
    pub(super) depth: usize,
    /// Whether the weights act on the rate of each number.
    steered: Vec<bool>,
}

/// What moves towards a surface, or from it, by no more than this part of what the forces on both sides do to it in the unit of time
/// is at rest there.
const STILL: f64 = 1e-12;

/// A coefficient this many roundings from zero, in terms of what the weights balance in it, is zero.
const BALANCED: f64 = 64.0;

impl<R: Coefficient> SeriesBuilder<R> {
    pub(super) fn new(jet: Jet<R>, inputs: usize, len: usize) -> SeriesBuilder<R> {
        let order = jet.order();
        let state = vec![R::ZERO; len * (order + 1)];
        let steered = vec![false; inputs];
        SeriesBuilder { jet, order, inputs, state, sliding: Vec::new(), depth: 1, steered }
    }

    #[inline]
    pub(super) fn series(&self, i: usize) -> &[R] {
        &self.state[i * (self.order + 1)..][..=self.order]
    }

    pub(super) fn coefficients(&self) -> &[R] {
        &self.state
    }

    pub(super) fn list(&self) -> SeriesList<'_, R> {
        SeriesList { coefficients: &self.state, stride: self.order + 1 }
    }

    /// How many coefficients of a number are final: a weight that acts two orders later is not known at the last order.
    pub(super) fn known_orders(&self) -> usize {
        let unknown = if self.sliding.is_empty() { 0 } else { self.depth - 1 };
        self.order + 1 - unknown
    }

    /// The registers, and the series of the state one after another.
    #[cfg(target_arch = "x86_64")]
    pub(super) fn parts(&mut self) -> (&mut Jet<R>, &mut [R]) {
        (&mut self.jet, &mut self.state)
    }

    /// Evaluates all registers at order 0, in parts.
    #[cfg(target_arch = "x86_64")]
    pub(super) fn evaluate(
        &mut self,
        parts: &mut impl PartwiseEvaluation,
        clock: SeriesClock<R>,
    ) -> Result<(), Singular> {
        self.jet.take_in(&self.state, self.inputs, 0);
        self.jet.begin_by(parts, clock.time)
    }

    #[cfg(target_arch = "x86_64")]
    pub(super) fn len(&self) -> usize {
        self.state.len() / (self.order + 1)
    }

    pub(super) fn set_origin(&mut self, i: usize, x: R) {
        self.state[i * (self.order + 1)] = x;
    }

    #[inline]
    pub(super) fn origin_mut(&mut self, i: usize) -> &mut R {
        &mut self.state[i * (self.order + 1)]
    }

    /// Computes the orders above `first` of the state, each from the one before, where no switch is
    /// kept at zero.
    pub(super) fn grow_plainly(
        &mut self,
        first: usize,
        clock: SeriesClock<R>,
        cancel: &Cancel,
    ) -> Result<(), Halt> {
        vectorized(Grow { builder: self, first, clock, cancel })
    }

    fn extend(&mut self, k: usize, clock: SeriesClock<R>) -> Result<(), Singular> {
        vectorized(Extend { builder: self, k, clock })
    }

    #[inline(always)]
    fn extend_with<const FUSED: bool>(
        &mut self,
        k: usize,
        clock: SeriesClock<R>,
    ) -> Result<(), Singular> {
        self.jet.take_in(&self.state, self.inputs, k);
        self.continue_with::<FUSED>(k, clock)
    }

    /// The same where the inputs of order `k` are set.
    #[inline(always)]
    fn continue_with<const FUSED: bool>(
        &mut self,
        k: usize,
        clock: SeriesClock<R>,
    ) -> Result<(), Singular> {
        self.jet.advance_with::<FUSED>(k, clock.time, clock.scale)?;
        let made = |x: R| x.integrated::<FUSED>(clock.scale, k + 1);
        self.jet.give_out((&mut self.state, self.inputs), k, made);
        Ok(())
    }

    /// Computes the highest order of everything but the state.
    pub(super) fn watch(&mut self, clock: SeriesClock<R>) -> Result<(), Singular> {
        let k = self.order;
        for i in 0..self.inputs {
            self.jet.set_input(i, k, self.state[i * (k + 1) + k]);
        }
        for &switch in &self.sliding {
            self.jet.set_weight(switch, k, R::ZERO);
        }
        self.jet.advance(k, clock.time, clock.scale)
    }
}

impl<R: Real> SeriesBuilder<R> {
    pub(super) fn begin(&mut self, origin: &[DoubleDouble], sides: &[Side]) {
        for (i, &x) in origin.iter().enumerate() {
            self.set_origin(i, R::of(x));
        }
        self.sliding.clear();
        for (switch, &side) in sides.iter().enumerate() {
            self.jet.set_side(switch, side);
            if side == Side::Between {
                self.sliding.push(switch);
            }
        }
    }

    /// Copies the origin and what was evaluated at it in another precision.
    #[cfg(target_arch = "x86_64")]
    pub(super) fn take_origin<S: Real>(&mut self, other: &SeriesBuilder<S>) {
        // counted along, since to divide a table into chunks takes a division
        let (mut place, mut from) = (0, 0);
        while place < self.state.len() {
            self.state[place] = R::of(other.state[from].double());
            (place, from) = (place + self.order + 1, from + other.order + 1);
        }
        self.sliding.clone_from(&other.sliding);
        self.jet.take_over_values(&other.jet);
    }

    /// Copies all orders known in another precision.
    pub(super) fn take_over<S: Real>(&mut self, other: &SeriesBuilder<S>) {
        let series = self.state.chunks_exact_mut(self.order + 1);
        for (own, other) in series.zip(other.state.chunks_exact(other.order + 1)) {
            own.iter_mut().zip(other).for_each(|(x, y)| *x = R::of(y.double()));
        }
        self.sliding.clone_from(&other.sliding);
        self.steered.clone_from(&other.steered);
        self.depth = other.depth;
        self.jet.take_over(&other.jet, other.order);
    }

    /// Copies all orders known in a wider range, those of each number of the state in a unit of its own, for
    /// reading only.
    pub(super) fn copy(&mut self, wide: &SeriesBuilder<ExtendedRange>, units: &[f64]) {
        for (i, unit) in units.iter().enumerate() {
            for k in 0..=self.order {
                let c = wide.series(i)[k].scaled(unit.recip());
                self.state[i * (self.order + 1) + k] = R::of(c.double());
            }
        }
        self.jet.copy(&wide.jet, self.order + 1);
    }

    /// Computes the orders above `first` of the state, each from the one before.
    pub(super) fn grow(
        &mut self,
        first: usize,
        clock: SeriesClock<R>,
        cancel: &Cancel,
    ) -> Result<(), Halt> {
        if self.sliding.is_empty() {
            return self.grow_plainly(first, clock, cancel);
        }
        for k in first..self.order {
            if cancel.is_cancelled() {
                return Err(Halt::Cancelled);
            }
            self.extend(k, clock)?;
            let terms = self.solve_weights(k, clock)?;
            self.extend(k, clock)?;
            self.clear_balanced(k + 1, terms.as_deref());
        }
        Ok(())
    }

    /// Finds the coefficients of order `k` of the weights that make those of order `k + 1` of the
    /// kept switches vanish. The latter depend linearly on the former. Returns for each number how much
    /// the weights balance in its coefficient of order `k + 1`, or nothing where that order is the
    /// last and its weights are not known.
    fn solve_weights(&mut self, k: usize, clock: SeriesClock<R>) -> Result<Option<Vec<f64>>, Halt> {
        let sliding = self.sliding.clone();
        let n = sliding.len();
        if k == 0 {
            self.depth = 1;
        }
        if k + self.depth > self.order {
            for &switch in &sliding {
                self.jet.set_weight(switch, k, R::ZERO);
            }
            return Ok(None);
        }
        let mut matrix = vec![R::ZERO; n * n];
        let mut factored = Factored::new(n);
        let (inputs, place) = (self.inputs, self.order + 1);
        let mut parts = vec![R::ZERO; (n + 1) * inputs];
        // the rates of the switches, where the weights act on those of these
        let mut rates: Option<Vec<f64>> = None;
        let rest = loop {
            let rest = self.probe(k, clock, &sliding, None)?;
            for (i, part) in parts.iter_mut().take(inputs).enumerate() {
                *part = self.state[i * place + k + 1];
            }
            for (j, &switch) in sliding.iter().enumerate() {
                let moved = self.probe(k, clock, &sliding, Some(switch))?;
                let (without, with) = parts.split_at_mut((j + 1) * inputs);
                for (i, (part, &before)) in with.iter_mut().zip(&without[..inputs]).enumerate() {
                    *part = self.state[i * place + k + 1] - before;
                }
                for i in 0..n {
                    matrix[i * n + j] = moved[i] - rest[i];
                }
            }
            if factored.factor(|i, j| matrix[i * n + j]) {
                let forces = matrix
                    .chunks_exact(n)
                    .map(|row| row.iter().map(|x| x.value().abs()).fold(0.0, f64::max));
                let still = |(&rate, force): (&f64, f64)| is_still(rate, force);
                if rates.is_some_and(|rates| !rates.iter().zip(forces).all(still)) {
                    return Err(Halt::Sticks);
                }
                break rest;
            }
            // what is at rest on the surface, but for rounding, may be held there by a force
            if k > 0 || self.depth > 1 {
                return Err(Halt::Sticks);
            }
            rates = Some(rest.iter().map(|x| x.value().abs()).collect());
            self.depth = 2;
        };
        let mut weights: Vec<R> = rest.iter().map(|&x| -x).collect();
        factored.solve(&mut weights);
        for (&switch, &w) in sliding.iter().zip(&weights) {
            self.jet.set_weight(switch, k, w);
        }
        let acting = |i: usize| (1..=n).map(move |j| j * inputs + i);
        for (i, steered) in self.steered.iter_mut().enumerate() {
            *steered = acting(i).any(|part| parts[part].value() != 0.0);
        }
        let terms = (0..inputs).map(|i| {
            let balancing =
                acting(i).zip(&weights).map(|(part, &w)| (parts[part] * w).value().abs());
            parts[i].value().abs() + balancing.sum::<f64>()
        });
        Ok(Some(terms.collect()))
    }

    /// Sets the coefficients of an order to zero that are rounding errors of what the weights
    /// balance: a body held on a surface is at rest there. At the last order, whose weights may not be
    /// known, the series of what they act on ends one order earlier.
    fn clear_balanced(&mut self, order: usize, terms: Option<&[f64]>) {
        for i in 0..self.inputs {
            let c = &mut self.state[i * (self.order + 1) + order];
            let balanced =
                terms.is_none_or(|terms| is_balanced(c.value().abs(), terms[i], R::ROUNDING));
            if self.steered[i] && balanced {
                *c = R::ZERO;
            }
        }
    }

    /// The kept switches `depth` orders later, with one weight of order `k` set to 1 and the others
    /// to 0.
    fn probe(
        &mut self,
        k: usize,
        clock: SeriesClock<R>,
        sliding: &[usize],
        one: Option<usize>,
    ) -> Result<Vec<R>, Singular> {
        for &switch in sliding {
            let weight = if one == Some(switch) { R::ONE } else { R::ZERO };
            self.jet.set_weight(switch, k, weight);
            for later in k + 1..=k + self.depth {
                self.jet.set_weight(switch, later, R::ZERO);
            }
        }
        let last = k + self.depth;
        for order in k..last {
            self.extend(order, clock)?;
            for i in 0..self.inputs {
                self.jet.set_input(i, order + 1, self.state[i * (self.order + 1) + order + 1]);
            }
        }
        self.jet.advance(last, clock.time, clock.scale)?;
        Ok(sliding.iter().map(|&switch| self.jet.switch(switch)[last]).collect())
    }
}

/// One order of a series.
struct Extend<'a, R: Coefficient> {
    builder: &'a mut SeriesBuilder<R>,
    k: usize,
    clock: SeriesClock<R>,
}

impl<R: Coefficient> Kernel for Extend<'_, R> {
    type Output = Result<(), Singular>;
    const OF_SEVERAL: bool = R::OF_SEVERAL;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Result<(), Singular> {
        self.builder.extend_with::<FUSED>(self.k, self.clock)
    }
}

/// All orders of a series without weights.
struct Grow<'a, R: Coefficient> {
    builder: &'a mut SeriesBuilder<R>,
    first: usize,
    clock: SeriesClock<R>,
    cancel: &'a Cancel,
}

impl<R: Coefficient> Kernel for Grow<'_, R> {
    type Output = Result<(), Halt>;
    const OF_SEVERAL: bool = R::OF_SEVERAL;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Result<(), Halt> {
        let Grow { builder, first, clock, cancel } = self;
        let SeriesBuilder { jet, state, inputs, order, .. } = builder;
        let (orders, clock) = (first..*order, (clock.time, clock.scale));
        let ends = || cancel.is_cancelled();
        if jet.grow::<FUSED>((state, *inputs), orders, clock, ends)? {
            Ok(())
        } else {
            Err(Halt::Cancelled)
        }
    }
}

/// Whether what moves towards a surface, or from it, at this rate is at rest beside what forces do to it in the unit of time.
fn is_still(rate: f64, force: f64) -> bool {
    rate <= STILL * force
}

/// Whether a coefficient of this size is rounding of what weights balance in it.
fn is_balanced(size: f64, terms: f64, rounding: f64) -> bool {
    terms.is_finite() && size > 0.0 && size <= BALANCED * rounding * terms
}

#[cfg(test)]
mod tests {
    use super::{is_balanced, is_still};

    #[test]
    fn what_moves_by_less_than_a_billionth_of_a_thousandth_of_what_forces_do_is_at_rest() {
        for force in [1e-200, 1.0, 1e200] {
            assert!(is_still(0.9e-12 * force, force) && !is_still(1.1e-12 * force, force));
        }
        assert!(is_still(0.0, 0.0) && !is_still(f64::NAN, 1.0) && !is_still(1e-300, 0.0));
    }

    #[test]
    fn a_coefficient_is_rounding_up_to_sixty_four_digits_of_what_is_balanced() {
        for terms in [1e-20, 1.0, 1e9] {
            assert!(is_balanced(63.0 * f64::EPSILON * terms, terms, f64::EPSILON));
            assert!(!is_balanced(65.0 * f64::EPSILON * terms, terms, f64::EPSILON));
        }
        // what is zero needs no clearing, and beside what is not finite nothing is known
        assert!(!is_balanced(0.0, 1.0, f64::EPSILON));
        assert!(!is_balanced(1.0, f64::INFINITY, f64::EPSILON));
    }
}
