//! The elementary functions of double-double numbers, to at least 27 digits: series after argument
//! reduction for exp, sin and cos; one correction of the `f64` value for their inverses.

use super::DoubleDouble;
use crate::num::convolution::{DoubleLanes, InnerProducts, LANES};
use crate::num::instruction_set::{Kernel, vectorized};
use crate::num::math;
use crate::num::real::{Analytic, Real};

const LN_2: DoubleDouble =
    DoubleDouble { high: std::f64::consts::LN_2, low: 2.319_046_813_846_299_6e-17 };

/// π/2 in three pieces.
const HALF_PI: [f64; 3] =
    [std::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17, -1.497_384_904_859_169_8e-33];

/// Above this, sine and cosine are those of `f64`, because the argument has no more digits.
const LARGE_ANGLE: f64 = 1e9;

/// The exponential reduces its argument by this power of two.
const HALVINGS: i32 = 8;

/// 1/n, for n up to 64. The second part is the remainder of the first over n, which is exact.
const RECIPROCALS: [DoubleDouble; 65] = {
    let mut table = [DoubleDouble::ZERO; 65];
    let mut n = 1;
    while n < table.len() {
        let high = 1.0 / n as f64;
        // n · high in two exact products, since the halves of high have 26 bits and n has 7
        let t = 134_217_729.0 * high;
        let upper = t - (t - high);
        let lower = high - upper;
        let rest = (1.0 - n as f64 * upper) - n as f64 * lower;
        table[n] = DoubleDouble { high, low: rest / n as f64 };
        n += 1;
    }
    table
};

/// The coefficients of the cosine in powers of the square of its argument, from the second on.
const COSINE: [DoubleDouble; 8] = [
    DoubleDouble { high: -0.5, low: 0.0 },
    DoubleDouble { high: 0.041_666_666_666_666_664, low: 2.312_964_634_635_742_7e-18 },
    DoubleDouble { high: -0.001_388_888_888_888_889, low: 5.300_543_954_373_577e-20 },
    DoubleDouble { high: 2.480_158_730_158_73e-05, low: 2.151_194_786_677_588_2e-23 },
    DoubleDouble { high: -2.755_731_922_398_589e-07, low: -2.376_771_462_225_029_7e-23 },
    DoubleDouble { high: 2.087_675_698_786_81e-09, low: -1.207_345_059_113_26e-25 },
    DoubleDouble { high: -1.147_074_559_772_972_5e-11, low: -2.065_551_275_283_074_5e-28 },
    DoubleDouble { high: 4.779_477_332_387_385e-14, low: 4.399_205_485_834_081e-31 },
];
/// The coefficients after those in double-double: their terms are below 10⁻¹⁷ up to π/4.
const COSINE_TAIL: [f64; 5] = [
    -1.561_920_696_858_622_5e-16,
    4.110_317_623_312_165e-19,
    -8.896_791_392_450_574e-22,
    1.611_737_571_096_118_4e-24,
    -2.479_596_263_224_797_6e-27,
];
/// The same of the sine over its argument.
const SINE: [DoubleDouble; 8] = [
    DoubleDouble { high: -0.166_666_666_666_666_66, low: -9.251_858_538_542_97e-18 },
    DoubleDouble { high: 0.008_333_333_333_333_333, low: 1.156_482_317_317_871_4e-19 },
    DoubleDouble { high: -0.000_198_412_698_412_698_4, low: -1.720_955_829_342_070_5e-22 },
    DoubleDouble { high: 2.755_731_922_398_589_3e-06, low: -1.858_393_274_046_472e-22 },
    DoubleDouble { high: -2.505_210_838_544_172e-08, low: 1.448_814_070_935_912e-24 },
    DoubleDouble { high: 1.605_904_383_682_161_3e-10, low: 1.258_529_458_875_209_8e-26 },
    DoubleDouble { high: -7.647_163_731_819_816e-13, low: -7.038_728_777_334_53e-30 },
    DoubleDouble { high: 2.811_457_254_345_520_6e-15, low: 1.650_884_273_086_143_3e-31 },
];
/// The coefficients of the sine after those in double-double.
const SINE_TAIL: [f64; 5] = [
    -8.220_635_246_624_33e-18,
    1.957_294_106_339_126_3e-20,
    -3.868_170_170_630_684e-23,
    6.446_950_284_384_474e-26,
    -9.183_689_863_795_546e-29,
];

impl DoubleDouble {
    /// `self · 2^n`.
    fn scaled(self, n: i32) -> DoubleDouble {
        let (a, b) = (math::powi(2.0, n / 2), math::powi(2.0, n - n / 2));
        DoubleDouble { high: self.high * a * b, low: self.low * a * b }
    }

    /// `e^self − 1` for a small argument, without cancellation: a short series at `self / 2^8`,
    /// then `s ← 2 s + s²` eight times.
    fn exp_minus_one_reduced(self) -> DoubleDouble {
        let r = self.scaled(-HALVINGS);
        let (mut term, mut s) = (r, r);
        for n in 2..10 {
            term = term * r / f64::from(n);
            s = s + term;
        }
        for _ in 0..HALVINGS {
            s = s * 2.0 + s * s;
        }
        s
    }

    /// `e^self − 1`.
    fn exp_minus_one(self) -> DoubleDouble {
        if self.high.abs() < 0.35 {
            self.exp_minus_one_reduced()
        } else {
            self.exp() - DoubleDouble::ONE
        }
    }

    /// Sine and cosine of an argument up to π/4, by their series.
    fn sin_cos_reduced(self) -> (DoubleDouble, DoubleDouble) {
        vectorized(SinCosReduced(self))
    }
}

/// The kernel of [`DoubleDouble::sin_cos_reduced`], whose products take a fused multiply-add each.
struct SinCosReduced(DoubleDouble);

impl Kernel for SinCosReduced {
    type Output = (DoubleDouble, DoubleDouble);

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> (DoubleDouble, DoubleDouble) {
        let x = self.0;
        let square = x.times::<FUSED>(x);
        let sine = square.times::<FUSED>(even_series::<FUSED>(&SINE, &SINE_TAIL, square));
        let cosine = square.times::<FUSED>(even_series::<FUSED>(&COSINE, &COSINE_TAIL, square));
        (x + x.times::<FUSED>(sine), DoubleDouble::ONE + cosine)
    }
}

/// `Σ first_j x^j + Σ tail_j x^{j + 8}`.
#[inline(always)]
fn even_series<const FUSED: bool>(
    first: &[DoubleDouble; 8],
    tail: &[f64; 5],
    x: DoubleDouble,
) -> DoubleDouble {
    let mut rest = 0.0;
    for j in (0..tail.len()).rev() {
        rest = rest * x.high + tail[j];
    }
    let mut sum = first[first.len() - 1] + DoubleDouble::from(rest * x.high);
    for j in (0..first.len() - 1).rev() {
        sum = sum.times::<FUSED>(x) + first[j];
    }
    sum
}

impl Real for DoubleDouble {
    fn value(self) -> f64 {
        self.high
    }

    fn double(self) -> DoubleDouble {
        self
    }
}

impl Analytic for DoubleDouble {
    const ZERO: DoubleDouble = DoubleDouble::ZERO;
    const ONE: DoubleDouble = DoubleDouble::ONE;
    type Unit = f64;
    type Lanes = DoubleLanes<LANES>;
    const ZEROS: DoubleLanes<LANES> = DoubleLanes::ZERO;
    const SIDE: usize = LANES;

    #[inline(always)]
    fn over<const FUSED: bool>(self, n: usize) -> DoubleDouble {
        self.times_unnormalized::<FUSED>(RECIPROCALS[n])
    }
    #[inline(always)]
    fn multiple<const FUSED: bool>(self, n: usize) -> DoubleDouble {
        let product = DoubleDouble::product_by::<FUSED>(self.high, n as f64);
        DoubleDouble { high: product.high, low: product.low + self.low * n as f64 }
    }
    #[inline]
    fn scaled(self, power_of_two: f64) -> DoubleDouble {
        DoubleDouble { high: self.high * power_of_two, low: self.low * power_of_two }
    }
    #[inline(always)]
    fn times<const FUSED: bool>(self, other: DoubleDouble) -> DoubleDouble {
        self.times_double::<FUSED>(other)
    }
    #[inline(always)]
    fn times_unnormalized<const FUSED: bool>(self, other: DoubleDouble) -> DoubleDouble {
        let product = DoubleDouble::product_by::<FUSED>(self.high, other.high);
        let mixed = self.high * other.low + self.low * other.high;
        DoubleDouble { high: product.high, low: product.low + mixed }
    }
    #[inline(always)]
    fn plus_unnormalized(self, other: DoubleDouble) -> DoubleDouble {
        let sum = DoubleDouble::sum(self.high, other.high);
        DoubleDouble { high: sum.high, low: (self.low + other.low) + sum.low }
    }
    #[inline(always)]
    fn renormalized(self) -> DoubleDouble {
        DoubleDouble::ordered_sum(self.high, self.low)
    }
    #[inline(always)]
    fn divided_by<const FUSED: bool>(self, other: DoubleDouble) -> DoubleDouble {
        self.quotient::<FUSED>(other)
    }
    #[inline(always)]
    fn divided_by_shared<const FUSED: bool>(self, divisor: DoubleDouble) -> DoubleDouble {
        if divisor.has_reciprocal() {
            self.times_unnormalized::<FUSED>(DoubleDouble::ONE.quotient::<FUSED>(divisor))
        } else {
            self.quotient::<FUSED>(divisor)
        }
    }
    #[inline(always)]
    fn side_by_side(number: impl Fn(usize) -> DoubleDouble) -> DoubleLanes<LANES> {
        let mut numbers = [DoubleDouble::ZERO; LANES];
        for lane in 0..LANES {
            numbers[lane] = number(lane);
        }
        DoubleLanes::of(numbers)
    }
    #[expect(
        clippy::manual_memcpy,
        reason = "is inlined into a kernel, which a copy of slices may not be"
    )]
    #[inline(always)]
    fn inner_products<const FUSED: bool>(
        left: &[DoubleLanes<LANES>],
        right: &[DoubleLanes<LANES>],
        out: &mut [DoubleDouble],
    ) {
        let products = InnerProducts { left, right }.run::<FUSED>();
        for lane in 0..LANES {
            out[lane] = products[lane];
        }
    }

    #[inline(always)]
    fn where_positive(self, a: DoubleDouble, b: DoubleDouble) -> DoubleDouble {
        if self.value() > 0.0 { a } else { b }
    }
    #[inline(always)]
    fn unless_vanishing(self, mut series: impl Iterator<Item = DoubleDouble>) -> DoubleDouble {
        if series.all(|x| x.value() == 0.0) { DoubleDouble::ZERO } else { self }
    }
    fn raised(self, exponent: DoubleDouble) -> DoubleDouble {
        self.power(exponent.double())
    }

    fn of(x: DoubleDouble) -> DoubleDouble {
        x
    }

    fn sqrt(self) -> DoubleDouble {
        self.root()
    }

    fn exp(self) -> DoubleDouble {
        if !(-700.0..=700.0).contains(&self.high) {
            return DoubleDouble::from(math::exp(self.high));
        }
        let n = (self.high / LN_2.high).round();
        let r = self - LN_2 * n;
        (r.exp_minus_one_reduced() + DoubleDouble::ONE).scaled(n as i32)
    }

    fn ln(self) -> DoubleDouble {
        let y = math::ln(self.high);
        if !y.is_finite() || y.abs() > 690.0 {
            return DoubleDouble::from(y);
        }
        // ln x = y + ln(x e^−y), where the second part is tiny
        let e = self * (-DoubleDouble::from(y)).exp() - DoubleDouble::ONE;
        DoubleDouble::from(y) + (e - e * e * 0.5)
    }

    fn sin_cos(self) -> (DoubleDouble, DoubleDouble) {
        if self.high.abs().partial_cmp(&LARGE_ANGLE) != Some(std::cmp::Ordering::Less) {
            let (sine, cosine) = math::sin_cos(self.high);
            return (DoubleDouble::from(sine), DoubleDouble::from(cosine));
        }
        let quarters = (self.high / HALF_PI[0]).round();
        let mut r = self;
        for piece in HALF_PI {
            r = r - DoubleDouble::product(quarters, piece);
        }
        let (sine, cosine) = r.sin_cos_reduced();
        match (quarters as i64).rem_euclid(4) {
            0 => (sine, cosine),
            1 => (cosine, -sine),
            2 => (-sine, -cosine),
            _ => (-cosine, sine),
        }
    }

    fn tan(self) -> DoubleDouble {
        let (sine, cosine) = self.sin_cos();
        sine / cosine
    }

    fn sinh_cosh(self) -> (DoubleDouble, DoubleDouble) {
        if self.high.abs() > 300.0 {
            return (
                DoubleDouble::from(math::sinh(self.high)),
                DoubleDouble::from(math::cosh(self.high)),
            );
        }
        let s = self.exp_minus_one();
        let e = s + DoubleDouble::ONE;
        ((s + s / e) * 0.5, (e + DoubleDouble::ONE / e) * 0.5)
    }

    fn tanh(self) -> DoubleDouble {
        if self.high.abs() > 40.0 {
            return DoubleDouble::from(self.high.signum());
        }
        let s = (self * 2.0).exp_minus_one();
        s / (s + DoubleDouble::from(2.0))
    }

    fn atan2(self, x: DoubleDouble) -> DoubleDouble {
        let angle = math::atan2(self.high, x.high);
        if (self.high == 0.0 && x.high == 0.0) || !self.is_finite() || !x.is_finite() {
            return DoubleDouble::from(angle);
        }
        // rotate the point back by the angle; the remaining angle is tiny
        let (sine, cosine) = DoubleDouble::from(angle).sin_cos();
        let rest = (self * cosine - x * sine) / (x * cosine + self * sine);
        DoubleDouble::from(angle) + rest
    }

    fn asin(self) -> DoubleDouble {
        self.atan2(((DoubleDouble::ONE - self) * (DoubleDouble::ONE + self)).root())
    }

    fn acos(self) -> DoubleDouble {
        ((DoubleDouble::ONE - self) * (DoubleDouble::ONE + self)).root().atan2(self)
    }

    fn power(self, exponent: DoubleDouble) -> DoubleDouble {
        let n = exponent.high;
        if exponent.low == 0.0 && n.abs() < 1024.0 && (2.0 * n).fract() == 0.0 {
            let size = n.abs();
            let mut result = if size.fract() == 0.0 { DoubleDouble::ONE } else { self.root() };
            let (mut base, mut left) = (self, size as u32);
            while left > 0 {
                if left & 1 == 1 {
                    result = result * base;
                }
                base = base * base;
                left >>= 1;
            }
            return if n < 0.0 { DoubleDouble::ONE / result } else { result };
        }
        if self.high <= 0.0 {
            return DoubleDouble::from(math::powf(self.high, n));
        }
        (self.ln() * exponent).exp()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_coefficients_are_those_of_taylors_series() {
        let rows: [(&[DoubleDouble], &[f64], u32); 2] =
            [(&COSINE, &COSINE_TAIL, 2), (&SINE, &SINE_TAIL, 3)];
        for (first, tail, start) in rows {
            assert!(!first.is_empty() && !tail.is_empty());
            let tail = tail.iter().map(|&c| DoubleDouble::from(c));
            for (j, c) in first.iter().copied().chain(tail).enumerate() {
                let n = start + 2 * j as u32;
                let sign = if n % 4 < 2 { 1.0 } else { -1.0 };
                let factors = (1..=n).map(f64::from);
                let expected = factors.fold(DoubleDouble::from(sign), |x, factor| x / factor);
                let allowed = if j < first.len() { 1e-31 } else { 1e-15 };
                let off = ((c - expected) / expected).high.abs();
                assert!(off < allowed, "1/{n}!: {off:e}");
            }
        }
    }

    #[test]
    fn sine_and_cosine_have_thirty_digits_on_the_whole_circle() {
        for i in -40..=40 {
            let x = DoubleDouble::from(f64::from(i)) * 0.07 + DoubleDouble::from(1e-19);
            let (sine, cosine) = x.sin_cos();
            let one = sine * sine + cosine * cosine - DoubleDouble::ONE;
            assert!(one.high.abs() < 1e-30, "{i}: {one:?}");
            // the angle tripled, by the addition theorem and by the series
            let tripled = (x * 3.0).sin_cos().0;
            let by_sine = sine * 3.0 - sine * sine * sine * 4.0;
            assert!((tripled - by_sine).high.abs() < 3e-30, "{i}: {:?}", tripled - by_sine);
        }
    }
}
