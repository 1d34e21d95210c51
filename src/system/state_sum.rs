//! The numbers of a state as the sums of their series.
//!
//! In: the coefficients of each number, in its unit, and a time. Out: the state then. Never here: how coefficients are computed.

use super::state::State;
use crate::num::{
    Analytic, DoubleDouble, FourLaneKernel, FourLanes, LANES, Polynomial, four_tails, tail,
};

/// Series of the numbers of a state one after another.
#[derive(Clone, Copy)]
pub(super) struct SeriesList<'a, R> {
    pub(super) coefficients: &'a [R],
    /// The number of coefficients of each.
    pub(super) stride: usize,
}

impl<'a, R> SeriesList<'a, R> {
    /// The series of one number.
    #[inline(always)]
    fn of(&self, i: usize) -> &'a [R] {
        &self.coefficients[i * self.stride..][..self.stride]
    }

    /// The series of four numbers, the first of which is this one.
    #[inline(always)]
    fn four(&self, first: usize) -> [&'a [R]; LANES] {
        let all = &self.coefficients[first * self.stride..][..LANES * self.stride];
        let (ab, cd) = all.split_at(2 * self.stride);
        let ((a, b), (c, d)) = (ab.split_at(self.stride), cd.split_at(self.stride));
        [a, b, c, d]
    }
}

/// The polynomials of a state, at a time in the unit of the series.
pub(super) struct StateSum<'a> {
    /// The terms of low order of each number in double-double, of which so many are summed.
    pub(super) low: SeriesList<'a, DoubleDouble>,
    pub(super) known: usize,
    /// All terms of each number.
    pub(super) high: SeriesList<'a, f64>,
    pub(super) units: &'a [f64],
    pub(super) x: DoubleDouble,
    pub(super) out: &'a mut State,
}

impl FourLaneKernel for StateSum<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: FourLanes, const FUSED: bool>(self, lanes: L) {
        let StateSum { low, known, high, units, x, out } = self;
        let (values, carry) = (&mut out.values[..units.len()], &mut out.carry[..units.len()]);
        let mut first = 0;
        // four numbers side by side, none of which waits for another; the last four may have some of those before once more
        while first < units.len() && units.len() >= LANES && x.low == 0.0 {
            let start = first.min(units.len() - LANES);
            let (low, high) = (low.four(start), high.four(start));
            let (sums, left) = sums_of_four::<L, FUSED>(lanes, (low, high, known), x.high);
            let own = start..start + LANES;
            if units[own.clone()] == [1.0; LANES] {
                values[own.clone()].copy_from_slice(&sums);
                carry[own].copy_from_slice(&left);
            } else {
                for lane in 0..LANES {
                    let number = DoubleDouble { high: sums[lane], low: left[lane] };
                    let number = in_unit(number, units[start + lane]);
                    (values[start + lane], carry[start + lane]) = (number.high, number.low);
                }
            }
            first += LANES;
        }
        for i in first..units.len() {
            let (low, high) = (&low.of(i)[..known], &high.of(i)[known..]);
            let tail = tail(lanes, high, x.high);
            let number = Polynomial { low, high, x }.with_tail::<_, FUSED>(lanes, tail);
            let number = in_unit(number, units[i]);
            (values[i], carry[i]) = (number.high, number.low);
        }
    }
}

/// What [`Polynomial::with_tail`] gives of four numbers where x is an `f64`, bit for bit. So many terms of each number are of low
/// order.
#[inline(always)]
fn sums_of_four<L: FourLanes, const FUSED: bool>(
    lanes: L,
    (low, high, known): ([&[DoubleDouble]; LANES], [&[f64]; LANES], usize),
    x: f64,
) -> ([f64; LANES], [f64; LANES]) {
    let [a, b, c, d] = high;
    let high = [&a[known..], &b[known..], &c[known..], &d[known..]];
    let (mut sums, mut errors) = (four_tails(lanes, high, x), lanes.splat(0.0));
    let x = lanes.splat(x);
    let [a, b, c, d] = low;
    let (a, b, c, d) = (&a[..known], &b[..known], &c[..known], &d[..known]);
    for j in (0..known).rev() {
        let (product, lost) = lanes.product::<FUSED>(sums, x);
        let terms = lanes.from_array([a[j].high, b[j].high, c[j].high, d[j].high]);
        let (next, left) = lanes.sum(product, terms);
        let terms = lanes.from_array([a[j].low, b[j].low, c[j].low, d[j].low]);
        let rest = lanes.add(lanes.add(lost, left), terms);
        errors = lanes.add(lanes.mul(errors, x), rest);
        sums = next;
    }
    let (sums, left) = lanes.sum(sums, errors);
    (lanes.to_array(sums), lanes.to_array(left))
}

/// A number in its unit. In a small one it is zero below the numbers that keep all their digits: what decays comes to
/// an end.
#[inline(always)]
fn in_unit(number: DoubleDouble, unit: f64) -> DoubleDouble {
    if unit == 1.0 {
        return number;
    }
    let number = number.scaled(unit);
    if number.high.is_normal() { number } else { DoubleDouble::ZERO }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::{ScalarLanes, in_four_lanes};
    use crate::system::Form;

    #[test]
    fn numbers_summed_side_by_side_have_the_bits_of_each_by_itself() {
        const STRIDE: usize = 29;
        let third = DoubleDouble::ONE / 3.0;
        for (count, known) in [(4, 1), (5, 8), (11, 1), (3, 8)] {
            let size =
                |i: usize, j: usize| (i as f64 - 1.7) / (j as f64 * 1.9 + 1.0 - 7.0 * i as f64);
            let high: Vec<f64> =
                (0..count * STRIDE).map(|at| size(at / STRIDE, at % STRIDE)).collect();
            let low: Vec<DoubleDouble> =
                (0..count * known).map(|at| third * size(at / known, at % known)).collect();
            let high = SeriesList { coefficients: &high, stride: STRIDE };
            let low = SeriesList { coefficients: &low, stride: known };
            let mut units = vec![1.0; count];
            units[1] = 0.25;
            for x in [DoubleDouble::from(0.7), DoubleDouble::from(-1.3) + third * 1e-17] {
                let sum = |at_once: bool| {
                    let mut out = State::new(0.0, Form::Velocity, vec![0.0; count]);
                    let sum = StateSum { low, known, high, units: &units, x, out: &mut out };
                    if at_once {
                        in_four_lanes(sum);
                    } else {
                        sum.run::<_, false>(ScalarLanes);
                    }
                    out
                };
                let together = sum(true);
                assert_eq!(together, sum(false));
                for i in 0..count {
                    let (low, high) =
                        (&low.coefficients[i * known..][..known], &high.coefficients[i * STRIDE..]);
                    let high = &high[known..STRIDE];
                    let polynomial = Polynomial { low, high, x };
                    let alone = polynomial
                        .with_tail::<_, false>(ScalarLanes, tail(ScalarLanes, high, x.high))
                        .scaled(units[i]);
                    assert_eq!(together.exact(i), alone, "{i} of {count}");
                }
            }
        }
    }
}
