//! Four numbers side by side, computed with at once.
//!
//! In and out: four `f64`. Each operation does in every lane what it does with one `f64`, bit for bit, whether by one
//! instruction ([`V3`](pulp::x86::V3)) or by four ([`ScalarLanes`]). A compiler may or may not turn a loop over lanes into vector
//! instructions; here they are written explicitly. Never here: which numbers.

use super::double_double::DoubleDouble;
use super::instruction_set::FUSED_PLAINLY;
#[cfg(target_arch = "x86_64")]
use super::instruction_set::wide;

/// The number of lanes.
pub const LANES: usize = 4;

/// The instructions for four lanes.
pub trait FourLanes: Copy {
    /// Four numbers.
    type Numbers: Copy;

    /// The numbers of an array.
    #[allow(clippy::wrong_self_convention, reason = "`self` stands for the instructions")]
    fn from_array(self, numbers: [f64; LANES]) -> Self::Numbers;
    /// The array of the numbers.
    fn to_array(self, a: Self::Numbers) -> [f64; LANES];
    /// The same number in every lane.
    fn splat(self, x: f64) -> Self::Numbers;
    /// a + b.
    fn add(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    /// a − b.
    fn sub(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    /// a · b.
    fn mul(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    /// a · b and its rounding error; by a fused multiply-add where that is `FUSED`.
    fn product<const FUSED: bool>(
        self,
        a: Self::Numbers,
        b: Self::Numbers,
    ) -> (Self::Numbers, Self::Numbers);
    /// |a|.
    fn abs(self, a: Self::Numbers) -> Self::Numbers;
    /// The larger number in each lane, the first where one is NaN.
    fn max(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    /// The smaller number in each lane, the first where one is NaN.
    fn min(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    /// `then` in the lanes in which a < b, else `otherwise`.
    fn where_below(
        self,
        a: Self::Numbers,
        b: Self::Numbers,
        then: Self::Numbers,
        otherwise: Self::Numbers,
    ) -> Self::Numbers;
    /// The lanes in which a > b, the first in the lowest bit.
    fn above(self, a: Self::Numbers, b: Self::Numbers) -> u32;
    /// The lanes in which a = b.
    fn equal(self, a: Self::Numbers, b: Self::Numbers) -> u32;
    /// Of positive numbers x = m 2ᵉ with 1 ≤ m < 2 the mantissas m and the exponents e.
    fn mantissa_exponent(self, x: Self::Numbers) -> (Self::Numbers, Self::Numbers);

    /// a + b and its rounding error, as [`DoubleDouble::sum`] has them.
    #[inline(always)]
    fn sum(self, a: Self::Numbers, b: Self::Numbers) -> (Self::Numbers, Self::Numbers) {
        let sum = self.add(a, b);
        let part = self.sub(sum, a);
        (sum, self.add(self.sub(a, self.sub(sum, part)), self.sub(b, part)))
    }

    /// The least of four numbers, none of which is NaN.
    #[inline(always)]
    fn least(self, a: Self::Numbers) -> f64 {
        let [a, b, c, d] = self.to_array(a);
        let less = |a: f64, b: f64| if b < a { b } else { a };
        less(less(a, c), less(b, d))
    }

    /// The first numbers of four times four, the second ones, and so on.
    fn transposed(self, rows: [Self::Numbers; LANES]) -> [Self::Numbers; LANES];

    /// The largest of them.
    #[inline(always)]
    fn largest(self, a: Self::Numbers) -> f64 {
        let [a, b, c, d] = self.to_array(a);
        let more = |a: f64, b: f64| if b > a { b } else { a };
        more(more(a, c), more(b, d))
    }

    /// All lanes as bits.
    #[inline(always)]
    fn all_lanes(self) -> u32 {
        (1 << LANES) - 1
    }
}

/// A [`Kernel`](super::Kernel) that says where it computes with four lanes.
pub trait FourLaneKernel {
    /// Its result.
    type Output;
    /// Computes it. `FUSED` says whether a fused multiply-add is one instruction. Must be inlined into its caller.
    fn run<L: FourLanes, const FUSED: bool>(self, lanes: L) -> Self::Output;
}

/// Runs a kernel with AVX2 where the processor has it, and lane by lane elsewhere.
#[inline]
pub fn in_four_lanes<K: FourLaneKernel>(kernel: K) -> K::Output {
    #[cfg(target_arch = "x86_64")]
    {
        struct Call<K>(K, pulp::x86::V3);
        impl<K: FourLaneKernel> pulp::NullaryFnOnce for Call<K> {
            type Output = K::Output;
            #[inline(always)]
            fn call(self) -> K::Output {
                self.0.run::<_, true>(self.1)
            }
        }
        if let Some(wide) = wide() {
            return wide.vectorize(Call(kernel, wide));
        }
    }
    kernel.run::<_, FUSED_PLAINLY>(ScalarLanes)
}

/// In the last digits of 2⁵² an integer becomes a number by one subtraction.
const SHIFT: f64 = (1_u64 << 52) as f64;
const BIAS: f64 = 1023.0;
const MANTISSA: u64 = 0x000F_FFFF_FFFF_FFFF;
const ONE: u64 = 1.0_f64.to_bits();

/// Lane by lane, on any processor.
#[derive(Clone, Copy, Debug)]
pub struct ScalarLanes;

/// An operation on each lane.
macro_rules! each {
    ($lane:ident => $x:expr) => {{
        let mut lanes = [0.0; LANES];
        for $lane in 0..LANES {
            lanes[$lane] = $x;
        }
        lanes
    }};
}

/// The lanes in which something holds, as bits.
macro_rules! bits {
    ($lane:ident => $holds:expr) => {{
        let mut bits = 0;
        for $lane in 0..LANES {
            bits |= u32::from($holds) << $lane;
        }
        bits
    }};
}

impl FourLanes for ScalarLanes {
    type Numbers = [f64; LANES];

    #[inline(always)]
    fn from_array(self, numbers: [f64; LANES]) -> [f64; LANES] {
        numbers
    }
    #[inline(always)]
    fn to_array(self, a: [f64; LANES]) -> [f64; LANES] {
        a
    }
    #[inline(always)]
    fn splat(self, x: f64) -> [f64; LANES] {
        [x; LANES]
    }
    #[inline(always)]
    fn add(self, a: [f64; LANES], b: [f64; LANES]) -> [f64; LANES] {
        each!(i => a[i] + b[i])
    }
    #[inline(always)]
    fn sub(self, a: [f64; LANES], b: [f64; LANES]) -> [f64; LANES] {
        each!(i => a[i] - b[i])
    }
    #[inline(always)]
    fn mul(self, a: [f64; LANES], b: [f64; LANES]) -> [f64; LANES] {
        each!(i => a[i] * b[i])
    }
    #[inline(always)]
    fn product<const FUSED: bool>(
        self,
        a: [f64; LANES],
        b: [f64; LANES],
    ) -> ([f64; LANES], [f64; LANES]) {
        (self.mul(a, b), each!(i => DoubleDouble::product_by::<FUSED>(a[i], b[i]).low))
    }
    #[inline(always)]
    fn abs(self, a: [f64; LANES]) -> [f64; LANES] {
        each!(i => a[i].abs())
    }
    #[inline(always)]
    fn max(self, a: [f64; LANES], b: [f64; LANES]) -> [f64; LANES] {
        each!(i => if b[i] > a[i] { b[i] } else { a[i] })
    }
    #[inline(always)]
    fn min(self, a: [f64; LANES], b: [f64; LANES]) -> [f64; LANES] {
        each!(i => if b[i] < a[i] { b[i] } else { a[i] })
    }
    #[inline(always)]
    fn where_below(
        self,
        a: [f64; LANES],
        b: [f64; LANES],
        then: [f64; LANES],
        otherwise: [f64; LANES],
    ) -> [f64; LANES] {
        each!(i => if a[i] < b[i] { then[i] } else { otherwise[i] })
    }
    #[inline(always)]
    fn above(self, a: [f64; LANES], b: [f64; LANES]) -> u32 {
        bits!(i => a[i] > b[i])
    }
    #[inline(always)]
    fn equal(self, a: [f64; LANES], b: [f64; LANES]) -> u32 {
        bits!(i => a[i] == b[i])
    }
    #[inline(always)]
    fn transposed(self, rows: [[f64; LANES]; LANES]) -> [[f64; LANES]; LANES] {
        let mut columns = rows;
        for i in 0..LANES {
            for j in 0..LANES {
                columns[i][j] = rows[j][i];
            }
        }
        columns
    }
    #[inline(always)]
    fn mantissa_exponent(self, x: [f64; LANES]) -> ([f64; LANES], [f64; LANES]) {
        let mantissa = |x: f64| f64::from_bits((x.to_bits() & MANTISSA) | ONE);
        let exponent =
            |x: f64| f64::from_bits(SHIFT.to_bits() | (x.to_bits() >> 52)) - (SHIFT + BIAS);
        (each!(i => mantissa(x[i])), each!(i => exponent(x[i])))
    }
}

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use pulp::x86::V3;
    use pulp::{Simd, f64x4, m64x4, u64x4};

    use super::{BIAS, FourLanes, LANES, MANTISSA, ONE, SHIFT};

    #[inline(always)]
    fn bits(lanes: V3, mask: m64x4) -> u32 {
        lanes.avx._mm256_movemask_pd(pulp::cast(mask)) as u32
    }

    impl FourLanes for V3 {
        type Numbers = f64x4;

        #[inline(always)]
        fn from_array(self, [a, b, c, d]: [f64; LANES]) -> f64x4 {
            f64x4(a, b, c, d)
        }
        #[inline(always)]
        fn to_array(self, f64x4(a, b, c, d): f64x4) -> [f64; LANES] {
            [a, b, c, d]
        }
        #[inline(always)]
        fn splat(self, x: f64) -> f64x4 {
            self.splat_f64x4(x)
        }
        #[inline(always)]
        fn add(self, a: f64x4, b: f64x4) -> f64x4 {
            self.add_f64s(a, b)
        }
        #[inline(always)]
        fn sub(self, a: f64x4, b: f64x4) -> f64x4 {
            self.sub_f64s(a, b)
        }
        #[inline(always)]
        fn mul(self, a: f64x4, b: f64x4) -> f64x4 {
            self.mul_f64s(a, b)
        }
        #[inline(always)]
        fn product<const FUSED: bool>(self, a: f64x4, b: f64x4) -> (f64x4, f64x4) {
            let product = self.mul(a, b);
            (product, self.mul_sub_f64x4(a, b, product))
        }
        #[inline(always)]
        fn abs(self, a: f64x4) -> f64x4 {
            self.abs_f64x4(a)
        }
        // the instruction gives the second of its operands where one is NaN
        #[inline(always)]
        fn max(self, a: f64x4, b: f64x4) -> f64x4 {
            self.max_f64s(b, a)
        }
        #[inline(always)]
        fn min(self, a: f64x4, b: f64x4) -> f64x4 {
            self.min_f64s(b, a)
        }
        #[inline(always)]
        fn where_below(self, a: f64x4, b: f64x4, then: f64x4, otherwise: f64x4) -> f64x4 {
            self.select_f64x4(self.cmp_lt_f64x4(a, b), then, otherwise)
        }
        #[inline(always)]
        fn above(self, a: f64x4, b: f64x4) -> u32 {
            bits(self, self.cmp_gt_f64x4(a, b))
        }
        #[inline(always)]
        fn equal(self, a: f64x4, b: f64x4) -> u32 {
            bits(self, self.cmp_eq_f64x4(a, b))
        }
        #[inline(always)]
        fn transposed(self, [a, b, c, d]: [f64x4; LANES]) -> [f64x4; LANES] {
            let (a, b, c, d) = (pulp::cast(a), pulp::cast(b), pulp::cast(c), pulp::cast(d));
            let avx = self.avx;
            let (ab_even, ab_odd) = (avx._mm256_unpacklo_pd(a, b), avx._mm256_unpackhi_pd(a, b));
            let (cd_even, cd_odd) = (avx._mm256_unpacklo_pd(c, d), avx._mm256_unpackhi_pd(c, d));
            [
                pulp::cast(avx._mm256_permute2f128_pd::<0x20>(ab_even, cd_even)),
                pulp::cast(avx._mm256_permute2f128_pd::<0x20>(ab_odd, cd_odd)),
                pulp::cast(avx._mm256_permute2f128_pd::<0x31>(ab_even, cd_even)),
                pulp::cast(avx._mm256_permute2f128_pd::<0x31>(ab_odd, cd_odd)),
            ]
        }
        #[inline(always)]
        fn mantissa_exponent(self, x: f64x4) -> (f64x4, f64x4) {
            let x: u64x4 = pulp::cast(x);
            let all = |bits: u64| self.splat_u64x4(bits);
            let mantissa = self.or_u64x4(self.and_u64x4(x, all(MANTISSA)), all(ONE));
            let exponent = self.or_u64x4(self.shr_const_u64x4::<52>(x), all(SHIFT.to_bits()));
            let exponent = self.sub(pulp::cast(exponent), self.splat(SHIFT + BIAS));
            (pulp::cast(mantissa), exponent)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What every operation makes of some numbers, as bits.
    struct All([f64; LANES], [f64; LANES]);

    impl FourLaneKernel for All {
        type Output = Vec<u64>;

        #[inline(always)]
        fn run<L: FourLanes, const FUSED: bool>(self, lanes: L) -> Vec<u64> {
            let (a, b) = (lanes.from_array(self.0), lanes.from_array(self.1));
            let (mantissa, exponent) = lanes.mantissa_exponent(lanes.abs(a));
            let (sum, left) = lanes.sum(a, b);
            let (product, lost) = lanes.product::<FUSED>(a, b);
            let numbers = [
                lanes.add(a, b),
                lanes.sub(a, b),
                lanes.mul(a, b),
                lanes.abs(a),
                lanes.max(a, b),
                lanes.min(a, b),
                lanes.where_below(a, b, a, b),
                lanes.splat(self.0[1]),
                mantissa,
                exponent,
                sum,
                left,
                product,
            ];
            let [c, d, e, f] = lanes.transposed([a, b, sum, product]);
            let numbers = numbers.into_iter().chain([c, d, e, f]);
            let lists = numbers.flat_map(|x| lanes.to_array(x)).map(f64::to_bits);
            let masks = [lanes.above(a, b), lanes.equal(a, b), lanes.all_lanes()];
            // beyond these sizes the error is not known exactly
            let ordinary = |x: f64| x == 0.0 || (1e-200..1e150).contains(&x.abs());
            let ordinary = self.0.iter().chain(&self.1).all(|x| ordinary(*x));
            let lost = ordinary.then(|| lanes.to_array(lost).map(f64::to_bits));
            lists.chain(masks.map(u64::from)).chain(lost.into_iter().flatten()).collect()
        }
    }

    #[test]
    fn four_lanes_at_once_have_the_bits_of_each_by_itself() {
        let (inf, nan) = (f64::INFINITY, f64::NAN);
        let numbers =
            [0.0, 1.5, -2.75, 0.3, 7e-9, -0.1, 5e12, 1e-310, 3e300, inf, -inf, nan, 7e-200];
        for shift in 0..numbers.len() {
            for other in 0..numbers.len() {
                let a = std::array::from_fn(|i| numbers[(shift + i) % numbers.len()]);
                let b = std::array::from_fn(|i| numbers[(other + 3 * i) % numbers.len()]);
                let apart = All(a, b).run::<_, FUSED_PLAINLY>(ScalarLanes);
                let is_nan = |bits: u64| f64::from_bits(bits).is_nan();
                let at_once = in_four_lanes(All(a, b));
                assert_eq!(at_once.len(), apart.len());
                for (x, y) in at_once.into_iter().zip(apart) {
                    assert!(x == y || is_nan(x) && is_nan(y), "{a:?} {b:?}");
                }
            }
        }
    }

    #[test]
    fn a_number_is_its_mantissa_times_a_power_of_two() {
        let lanes = ScalarLanes;
        let (mantissas, exponents) = lanes.mantissa_exponent([1.0, 0.1, 3e300, 5e-300]);
        assert_eq!((mantissas[0], exponents[0]), (1.0, 0.0));
        assert_eq!((mantissas[1], exponents[1]), (1.6, -4.0));
        for (m, e) in mantissas.into_iter().zip(exponents) {
            assert!((1.0..2.0).contains(&m) && e.fract() == 0.0);
        }
        assert_eq!(lanes.least([3.0, -1.0, 2.0, 0.0]), -1.0);
        assert_eq!(lanes.largest([0.0, -1.0, 2.0, 3.0]), 3.0);
    }
}
