//! The steps that the lowest orders of all series of several orbits allow, found for all orbits at once.
//!
//! In: the series of all numbers, the bounds of [`order_bounds`](super::order_bounds). Out: the logarithm of the step of each
//! orbit where these orders surely decide it, and which of the orbits those are. Never here: orbits that other orders decide.
//!
//! ```text
//!   last orders:   p − 9 … p − 4                      p − 3 … p
//!                  surely allow more than the least   bounds by the four lowest orders; the least of all numbers is
//!                  of these: by multiplications       the step, if no order above the lowest surely allows more
//! ```

use super::last_orders::{BEFORE, LANES, LAST, ROOM};
use super::order_bounds::OrderBounds;
use super::rough_logarithms::{four_logarithms, rough_exponential};
use super::step_screen::StepScreen;
use crate::num::{BATCH, Batch, FourLaneKernel, FourLanes, in_four_lanes};

/// The steps in the unit of their series in which no power of them underflows beside a coefficient that does not.
const STEPS: (f64, f64) = (0.25, 16.0);

/// What the lowest orders allow in each lane.
pub(super) struct LowestSteps {
    /// The step, in the unit of the series.
    pub(super) step: Batch,
    /// Whether it is decided.
    pub(super) decided: [bool; BATCH],
}

/// The same number in four lanes.
type Splat = [f64; LANES];

/// One of the last orders, against each of the lowest ones.
#[derive(Clone, Copy, Debug)]
struct LastOrder {
    reciprocals: [Splat; LANES],
    by_tolerance: [Splat; LANES],
    by_radius: [Splat; LANES],
}

/// The bounds of the numbers of a motion, or of what does not act on it.
#[derive(Clone, Debug)]
pub(super) struct LowestOfAll {
    order: usize,
    last: [LastOrder; LAST],
    /// What a term is multiplied by to be compared with that of each of the last orders, four orders at once: zero for the lowest.
    factors: [Vec<[f64; LANES]>; LAST],
    /// The first of the orders before the last, and what a term of each is multiplied by to be compared with those of the
    /// four lowest: the first two by the tolerance, the others by the radius of convergence.
    before: usize,
    shares: [[Splat; LANES]; BEFORE],
}

impl LowestOfAll {
    pub(super) fn new(order: usize, bounds: &OrderBounds, screen: &StepScreen) -> LowestOfAll {
        let chunks = |place: usize| bounds.chunks_of_last(LAST - 1 - place);
        let splats = |numbers: &[f64; LANES]| numbers.map(|x| [x; LANES]);
        let last = std::array::from_fn(|place| {
            let first = &chunks(place)[0];
            LastOrder {
                reciprocals: splats(&first.reciprocals),
                by_tolerance: splats(&first.by_tolerance),
                by_radius: splats(&first.by_radius),
            }
        });
        let factors = std::array::from_fn(|place| {
            let mut factors = vec![[0.0; LANES]; (order + 1).div_ceil(LANES)];
            for (factor, chunk) in factors.iter_mut().zip(chunks(place)).skip(1) {
                *factor = chunk.tolerance_factors;
            }
            factors
        });
        let (before, shares) = screen.before_last();
        LowestOfAll { order, last, factors, before, shares: shares.map(|own| splats(&own)) }
    }
}

/// Room for what belongs to the steps, order by order.
#[derive(Clone, Debug)]
pub(super) struct StepTables {
    powers: [[f64; LANES]; ROOM],
    /// What the terms are multiplied by to be compared with that of the order that decides.
    factors: [[f64; LANES]; ROOM],
}

impl StepTables {
    pub(super) const ZERO: StepTables =
        StepTables { powers: [[0.0; LANES]; ROOM], factors: [[0.0; LANES]; ROOM] };
}

/// The kernel of [`lowest_steps`].
struct OfAllSeries<'a, C> {
    /// The number of series, and how many of them are of the motion.
    counts: (usize, usize),
    coefficients_of: C,
    bounds: &'a [LowestOfAll; 2],
    tables: &'a mut StepTables,
}

/// The steps that the lowest orders of so many series allow, the first of which are of the motion, from the bounds of the motion
/// and those of what does not act on it.
pub(super) fn lowest_steps<'a>(
    counts: (usize, usize),
    coefficients_of: impl Fn(usize) -> &'a [Batch],
    bounds: &[LowestOfAll; 2],
    tables: &mut StepTables,
) -> LowestSteps {
    in_four_lanes(OfAllSeries { counts, coefficients_of, bounds, tables })
}

impl<'a, C: Fn(usize) -> &'a [Batch]> FourLaneKernel for OfAllSeries<'_, C> {
    type Output = LowestSteps;

    #[inline(always)]
    fn run<L: FourLanes, const FUSED: bool>(self, lanes: L) -> LowestSteps {
        let mut found = LowestSteps { step: Batch([0.0; BATCH]), decided: [false; BATCH] };
        let OfAllSeries { counts, coefficients_of, bounds, tables } = self;
        for half in 0..BATCH / LANES {
            let (step, decided) = of_half(lanes, half, counts, &coefficients_of, bounds, tables);
            for lane in 0..LANES {
                found.step.0[LANES * half + lane] = step[lane];
                found.decided[LANES * half + lane] = decided & (1 << lane) != 0;
            }
        }
        found
    }
}

/// The steps of one half of the lanes, and bits that say which are decided.
#[inline(always)]
fn of_half<'a, L: FourLanes>(
    lanes: L,
    half: usize,
    (len, inputs): (usize, usize),
    coefficients_of: &impl Fn(usize) -> &'a [Batch],
    [motion, spared]: &[LowestOfAll; 2],
    StepTables { powers, factors }: &mut StepTables,
) -> ([f64; LANES], u32) {
    let order = motion.order;
    let mut least = LeastBound::nothing(lanes);
    for i in 0..len {
        let bounds = if i < inputs { motion } else { spared };
        least.take(lanes, (&coefficients_of(i)[..=order], half), i, bounds);
    }
    let (log, place) = (lanes.to_array(least.log), lanes.to_array(least.place));
    let (mut step, mut power, mut number) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
    let mut of_place = [0; LANES];
    let mut decided = 0;
    for lane in 0..LANES {
        step[lane] = rough_exponential(log[lane]);
        // what does not act on the motion has other factors, and hardly ever decides
        let known = place[lane] >= 0.0 && place[lane] < (LAST * inputs) as f64;
        let in_range = step[lane] >= STEPS.0 && step[lane] <= STEPS.1;
        decided |= u32::from(known && in_range) << lane;
        let place = place[lane].max(0.0) as usize;
        (number[lane], of_place[lane]) = ((place / LAST) as f64, place % LAST);
    }
    set_powers(lanes, &mut powers[..(order + 1).next_multiple_of(LANES)], step);
    let powers = &powers[..=order];
    for lane in 0..LANES {
        power[lane] = powers[order + 1 - LAST + of_place[lane]][lane];
    }
    let (own, by_four) = (&motion.factors, factors.as_chunks_mut::<LANES>().0);
    // one by one, since what is given to a map of an array is not always inlined
    let [a, b, c, d] = of_place;
    let (a, b, c, d) = (&own[a][..], &own[b][..], &own[c][..], &own[d][..]);
    let count = a.len().min(by_four.len());
    let (b, c, d) = (&b[..count], &c[..count], &d[..count]);
    for i in 0..count {
        let (a, b) = (lanes.from_array(a[i]), lanes.from_array(b[i]));
        let (c, d) = (lanes.from_array(c[i]), lanes.from_array(d[i]));
        let [a, b, c, d] = lanes.transposed([a, b, c, d]);
        by_four[i] = [lanes.to_array(a), lanes.to_array(b), lanes.to_array(c), lanes.to_array(d)];
    }
    let factors = &factors[..=order];
    let own = lanes.mul(least.size, lanes.from_array(power));
    let (number, zero) = (lanes.from_array(number), lanes.splat(0.0));
    let (mut above, mut sum) = (zero, zero);
    for i in 0..len {
        let bounds = if i < inputs { motion } else { spared };
        let seen = bounds.compare(lanes, (&coefficients_of(i)[..=order], half), powers, factors);
        decided &= seen.before;
        // that of another number says nothing
        let others = lanes.equal(number, lanes.splat(i as f64)) ^ lanes.all_lanes();
        decided &= others | lanes.above(own, seen.above);
        sum = lanes.add(sum, seen.sum);
        above = lanes.max(above, seen.above);
    }
    // zero times what is not finite is NaN, and equal to nothing
    decided &= lanes.equal(lanes.mul(lanes.add(sum, above), zero), zero);
    (step, decided)
}

/// The least bound so far, and what it is of.
struct LeastBound<N> {
    log: N,
    /// The number times the count of last orders, and the place of the order among these; negative where the radius of
    /// convergence decides.
    place: N,
    /// The size of the coefficient.
    size: N,
}

/// A coefficient in one half of the lanes.
#[inline(always)]
fn size_of<L: FourLanes>(lanes: L, coefficient: &Batch, half: usize) -> L::Numbers {
    lanes.abs(coefficient.half(lanes, half))
}

impl<N: Copy> LeastBound<N> {
    #[inline(always)]
    fn nothing<L: FourLanes<Numbers = N>>(lanes: L) -> LeastBound<N> {
        let (log, place, size) = (f64::INFINITY, -1.0, 0.0);
        LeastBound { log: lanes.splat(log), place: lanes.splat(place), size: lanes.splat(size) }
    }

    /// Takes the bounds of the last orders of a number.
    #[inline(always)]
    fn take<L: FourLanes<Numbers = N>>(
        &mut self,
        lanes: L,
        (coefficients, half): (&[Batch], usize),
        number: usize,
        bounds: &LowestOfAll,
    ) {
        let (Some(first), Some(last)) =
            (coefficients.first_chunk::<LANES>(), coefficients.last_chunk::<LAST>())
        else {
            return;
        };
        let low = [
            log_of(lanes, &first[0], half),
            log_of(lanes, &first[1], half),
            log_of(lanes, &first[2], half),
            log_of(lanes, &first[3], half),
        ];
        let (any, radius) = (lanes.splat(f64::INFINITY), lanes.splat(-1.0));
        let mut code = lanes.splat((LAST * number) as f64);
        for place in 0..LAST {
            let size = size_of(lanes, &last[place], half);
            let own = four_logarithms(lanes, size);
            let (by_tolerance, by_radius) = bounds.last[place].allow(lanes, low, own);
            let log = lanes.min(by_tolerance, by_radius);
            // a coefficient that vanishes allows anything
            let log = lanes.where_below(own, lanes.splat(f64::MIN), any, log);
            let own_code = lanes.where_below(by_radius, by_tolerance, radius, code);
            self.place = lanes.where_below(log, self.log, own_code, self.place);
            self.size = lanes.where_below(log, self.log, size, self.size);
            self.log = lanes.min(self.log, log);
            code = lanes.add(code, lanes.splat(1.0));
        }
    }
}

/// The logarithm of its size.
#[inline(always)]
fn log_of<L: FourLanes>(lanes: L, coefficient: &Batch, half: usize) -> L::Numbers {
    four_logarithms(lanes, size_of(lanes, coefficient, half))
}

impl LastOrder {
    /// The logarithms of the steps that the lowest orders allow by the tolerance, and by the radius of convergence, of which the
    /// first two say nothing.
    #[inline(always)]
    fn allow<L: FourLanes>(
        &self,
        lanes: L,
        low: [L::Numbers; LANES],
        own: L::Numbers,
    ) -> (L::Numbers, L::Numbers) {
        let root =
            |j: usize| lanes.mul(lanes.sub(low[j], own), lanes.from_array(self.reciprocals[j]));
        let (a, b, c, d) = (root(0), root(1), root(2), root(3));
        let [by_a, by_b, by_c, by_d] = self.by_tolerance;
        let a = lanes.add(a, lanes.from_array(by_a));
        let b = lanes.add(b, lanes.from_array(by_b));
        let (c_radius, d_radius) =
            (lanes.from_array(self.by_radius[2]), lanes.from_array(self.by_radius[3]));
        let by_radius = lanes.max(lanes.add(c, c_radius), lanes.add(d, d_radius));
        let c = lanes.add(c, lanes.from_array(by_c));
        let d = lanes.add(d, lanes.from_array(by_d));
        (lanes.max(lanes.max(a, b), lanes.max(c, d)), by_radius)
    }
}

/// What the terms of a number at a step show.
struct SeenTerms<N> {
    /// The lanes in which the orders before the last surely allow the step, as bits.
    before: u32,
    /// More than what the orders above the lowest have for the order that decides.
    above: N,
    /// The sum of all terms, finite where they are.
    sum: N,
}

impl LowestOfAll {
    #[inline(always)]
    fn compare<L: FourLanes>(
        &self,
        lanes: L,
        (coefficients, half): (&[Batch], usize),
        powers: &[[f64; LANES]],
        factors: &[[f64; LANES]],
    ) -> SeenTerms<L::Numbers> {
        let zero = lanes.splat(0.0);
        let mut low = [zero; LANES];
        let (mut above, mut sum) = (zero, zero);
        let (coefficients_by_four, rest) = coefficients.as_chunks::<LANES>();
        let (powers_by_four, factors_by_four) =
            (powers.as_chunks::<LANES>().0, factors.as_chunks::<LANES>().0);
        let count = coefficients_by_four.len();
        let (powers_by_four, factors_by_four) =
            (&powers_by_four[..count], &factors_by_four[..count]);
        for i in 0..count {
            let (four, powers, factors) =
                (&coefficients_by_four[i], &powers_by_four[i], &factors_by_four[i]);
            let a = term_of(lanes, &four[0], half, &powers[0]);
            let b = term_of(lanes, &four[1], half, &powers[1]);
            let c = term_of(lanes, &four[2], half, &powers[2]);
            let d = term_of(lanes, &four[3], half, &powers[3]);
            if i == 0 {
                low = [a, b, c, d];
            }
            sum = lanes.add(sum, lanes.add(lanes.add(a, b), lanes.add(c, d)));
            let a = lanes.mul(a, lanes.from_array(factors[0]));
            let b = lanes.mul(b, lanes.from_array(factors[1]));
            let c = lanes.mul(c, lanes.from_array(factors[2]));
            let d = lanes.mul(d, lanes.from_array(factors[3]));
            above = lanes.max(above, lanes.max(lanes.max(a, b), lanes.max(c, d)));
        }
        for (i, coefficient) in rest.iter().enumerate() {
            let k = LANES * count + i;
            let term = term_of(lanes, coefficient, half, &powers[k]);
            sum = lanes.add(sum, term);
            above = lanes.max(above, lanes.mul(term, lanes.from_array(factors[k])));
        }
        let before = &coefficients[self.before..][..BEFORE];
        let powers = &powers[self.before..][..BEFORE];
        let (mut a, mut b, mut c, mut d) = (zero, zero, zero, zero);
        for k in 0..BEFORE {
            let (term, shares) = (term_of(lanes, &before[k], half, &powers[k]), &self.shares[k]);
            a = lanes.max(a, lanes.mul(term, lanes.from_array(shares[0])));
            b = lanes.max(b, lanes.mul(term, lanes.from_array(shares[1])));
            c = lanes.max(c, lanes.mul(term, lanes.from_array(shares[2])));
            d = lanes.max(d, lanes.mul(term, lanes.from_array(shares[3])));
        }
        let most = [a, b, c, d];
        let exceeds = |j: usize| lanes.above(most[j], low[j]);
        let by_neither = exceeds(0) & exceeds(1) | exceeds(2) & exceeds(3);
        SeenTerms { before: by_neither ^ lanes.all_lanes(), above, sum }
    }
}

/// The size of a term.
#[inline(always)]
fn term_of<L: FourLanes>(
    lanes: L,
    coefficient: &Batch,
    half: usize,
    power: &[f64; LANES],
) -> L::Numbers {
    lanes.mul(size_of(lanes, coefficient, half), lanes.from_array(*power))
}

/// The powers of steps, from the order 0 on.
#[inline(always)]
fn set_powers<L: FourLanes>(lanes: L, powers: &mut [[f64; LANES]], step: [f64; LANES]) {
    let step = lanes.from_array(step);
    let square = lanes.mul(step, step);
    let fourth = lanes.mul(square, square);
    let (mut a, mut b, mut c, mut d) = (lanes.splat(1.0), step, square, lanes.mul(square, step));
    for powers in powers.as_chunks_mut::<LANES>().0 {
        *powers = [lanes.to_array(a), lanes.to_array(b), lanes.to_array(c), lanes.to_array(d)];
        (a, b) = (lanes.mul(a, fourth), lanes.mul(b, fourth));
        (c, d) = (lanes.mul(c, fourth), lanes.mul(d, fourth));
    }
}
