//! Arithmetic modulo a prime below 2⁶², exact and fast: what linear algebra needs when a rank is to be known and not
//! estimated.
//!
//! In and out: residues in Montgomery's form, and exact rationals. Every prime of [`PRIMES`] is ≡ 7 (mod 8), so that
//! −1 is no square and 2 is one, and ≡ 2 (mod 3) and ≢ 1 (mod 5, 7), so that odd roots are unique. A residue counts as
//! *positive* if it is a square; of the two roots of a square the positive one is taken, so that √a √b = √(ab) holds
//! as it does for positive reals. Never here: expressions.
//! Source: P. L. Montgomery, *Modular multiplication without trial division*, Math. Comp. 44 (1985) 519.

use super::number::Number;

/// The primes used, in the order in which they are taken.
pub const PRIMES: [u64; 8] = [
    4611686018427382439,
    4611686018427381479,
    4611686018427381239,
    4611686018427377039,
    4611686018427371999,
    4611686018427370559,
    4611686018427369839,
    4611686018427369719,
];

/// A residue in Montgomery's form, below the prime of its field.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Residue(u64);

impl Residue {
    /// Zero, the same in every field.
    pub const ZERO: Residue = Residue(0);

    /// Returns whether it is zero.
    pub fn is_zero(self) -> bool {
        self.0 == 0
    }
}

/// A sum of products of residues that waits for its reduction: times 2⁶⁴, and below the prime times 2⁶⁴.
#[derive(Clone, Copy, Debug)]
pub struct Unreduced(u128);

/// The field of integers modulo a prime.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct PrimeField {
    p: u64,
    /// −p⁻¹ mod 2⁶⁴.
    negative_inverse: u64,
    /// 2¹²⁸ mod p.
    square_of_radix: u64,
}

impl PrimeField {
    /// The field of the n-th prime of [`PRIMES`], counted cyclically.
    pub fn nth(n: usize) -> PrimeField {
        let p = PRIMES[n % PRIMES.len()];
        let mut inverse = 1_u64;
        for _ in 0..6 {
            inverse = inverse.wrapping_mul(2_u64.wrapping_sub(p.wrapping_mul(inverse)));
        }
        let radix = (1_u128 << 64) % u128::from(p);
        let square_of_radix = (radix * radix % u128::from(p)) as u64;
        PrimeField { p, negative_inverse: inverse.wrapping_neg(), square_of_radix }
    }

    /// The modulus p: residues are below it.
    pub fn prime(&self) -> u64 {
        self.p
    }

    #[inline]
    fn reduce(&self, x: u128) -> u64 {
        let m = (x as u64).wrapping_mul(self.negative_inverse);
        let t = ((x + u128::from(m) * u128::from(self.p)) >> 64) as u64;
        if t >= self.p { t - self.p } else { t }
    }

    /// `a · b`.
    #[inline]
    pub fn mul(&self, a: Residue, b: Residue) -> Residue {
        Residue(self.reduce(u128::from(a.0) * u128::from(b.0)))
    }

    /// `a + b`.
    #[inline]
    pub fn add(&self, a: Residue, b: Residue) -> Residue {
        let sum = a.0 + b.0;
        Residue(if sum >= self.p { sum - self.p } else { sum })
    }

    /// A residue as the beginning of a sum of products.
    #[inline]
    pub fn unreduced(&self, a: Residue) -> Unreduced {
        Unreduced(u128::from(a.0) << 64)
    }

    /// Adds `a · b` to a sum. A product is below p², and p² < p · 2⁶⁴, so that one subtraction keeps the bound.
    #[inline]
    pub fn add_product(&self, sum: &mut Unreduced, a: Residue, b: Residue) {
        let next = sum.0 + u128::from(a.0) * u128::from(b.0);
        let bound = u128::from(self.p) << 64;
        sum.0 = if next >= bound { next - bound } else { next };
    }

    /// Adds four products to a sum. Each is below p² < p · 2⁶², so that one subtraction still keeps the bound.
    #[inline]
    pub fn add_products(&self, sum: &mut Unreduced, a: [Residue; 4], b: [Residue; 4]) {
        let product = |k: usize| u128::from(a[k].0) * u128::from(b[k].0);
        let next = sum.0 + (product(0) + product(1) + product(2) + product(3));
        let bound = u128::from(self.p) << 64;
        sum.0 = if next >= bound { next - bound } else { next };
    }

    /// The residue of a sum of products.
    #[inline]
    pub fn reduced(&self, sum: Unreduced) -> Residue {
        Residue(self.reduce(sum.0))
    }

    /// `a − b`.
    #[inline]
    pub fn sub(&self, a: Residue, b: Residue) -> Residue {
        Residue(if a.0 >= b.0 { a.0 - b.0 } else { a.0 + self.p - b.0 })
    }

    /// `−a`.
    pub fn neg(&self, a: Residue) -> Residue {
        self.sub(Residue::ZERO, a)
    }

    /// One.
    pub fn one(&self) -> Residue {
        self.residue(1)
    }

    /// The residue of a number below 2⁶⁴.
    pub fn residue(&self, n: u64) -> Residue {
        Residue(self.reduce(u128::from(n % self.p) * u128::from(self.square_of_radix)))
    }

    /// The residue of an integer.
    pub fn integer(&self, n: i128) -> Residue {
        self.residue(n.rem_euclid(i128::from(self.p)) as u64)
    }

    /// The representative in 0 … p − 1.
    pub fn value(&self, a: Residue) -> u64 {
        self.reduce(u128::from(a.0))
    }

    /// `a ^ n`.
    pub fn pow(&self, a: Residue, n: u64) -> Residue {
        let (mut result, mut base, mut n) = (self.one(), a, n);
        while n > 0 {
            if n & 1 == 1 {
                result = self.mul(result, base);
            }
            base = self.mul(base, base);
            n >>= 1;
        }
        result
    }

    /// `1 / a`, or `None` for zero.
    pub fn inverse(&self, a: Residue) -> Option<Residue> {
        (!a.is_zero()).then(|| self.pow(a, self.p - 2))
    }

    /// `a ^ n` for an integer of either sign, or `None` for a negative power of zero.
    pub fn integer_power(&self, a: Residue, n: i64) -> Option<Residue> {
        let power = self.pow(a, n.unsigned_abs());
        if n < 0 { self.inverse(power) } else { Some(power) }
    }

    /// Returns whether it is a nonzero square.
    pub fn is_positive(&self, a: Residue) -> bool {
        self.pow(a, (self.p - 1) / 2) == self.one()
    }

    /// The positive d-th root of a positive residue; for odd d of any residue. `None` where there is none, or where
    /// roots of this order are not unique.
    pub fn root(&self, a: Residue, d: u64) -> Option<Residue> {
        let (mut root, mut d) = (a, d);
        while d % 2 == 0 {
            if !self.is_positive(root) {
                return None;
            }
            // of ± a^((p+1)/4) this one is itself a square, since −1 is not
            root = self.pow(root, (self.p + 1) / 4);
            d /= 2;
        }
        if d == 1 {
            return Some(root);
        }
        let order = i128::from(self.p - 1);
        let (mut r, mut s) = ((order, 0_i128), (i128::from(d), 1_i128));
        while s.0 != 0 {
            let q = r.0 / s.0;
            (r, s) = (s, (r.0 - q * s.0, r.1 - q * s.1));
        }
        (r.0 == 1).then(|| self.pow(root, r.1.rem_euclid(order) as u64))
    }

    /// The residue of a number; an `f64` that is not a short fraction counts as the dyadic rational that it is. `None`
    /// if it is not finite or its denominator is a multiple of p.
    pub fn number(&self, n: Number) -> Option<Residue> {
        match n {
            Number::Rational(n, 1) => Some(self.integer(n.into())),
            Number::Rational(n, d) => {
                let d = self.inverse(self.integer(d.into()))?;
                Some(self.mul(self.integer(n.into()), d))
            }
            Number::Real(x) if x.is_finite() => {
                let bits = x.to_bits();
                let exponent = ((bits >> 52) & 0x7ff) as i64;
                let fraction = i128::from(bits & ((1 << 52) - 1));
                let (mantissa, exponent) =
                    if exponent == 0 { (fraction, 1) } else { (fraction | 1 << 52, exponent) };
                let size = self.integer_power(self.residue(2), exponent - 1075)?;
                let size = self.mul(self.integer(mantissa), size);
                Some(if x < 0.0 { self.neg(size) } else { size })
            }
            Number::Real(_) => None,
        }
    }

    /// The short fraction that this is the residue of, see [`rational`].
    pub fn fraction(&self, x: Residue, spare: u32) -> Option<Number> {
        rational(self.value(x).into(), self.prime().into(), spare)
    }
}

/// The fraction n/d ≡ a (mod m) with |n|, d < √(m/2^`spare`), if there is one and it is exact as a number. The `spare` bits
/// make it improbable that there is one by chance.
/// Source: P. S. Wang, *A p-adic algorithm for univariate partial fractions*, SYMSAC 1981.
pub fn rational(a: u128, m: u128, spare: u32) -> Option<Number> {
    let bound = ((m >> spare.max(2)) as f64).sqrt() as i128;
    let (mut r, mut s) = ((i128::try_from(m).ok()?, 0_i128), (i128::try_from(a).ok()?, 1_i128));
    while s.0 > bound {
        let q = r.0 / s.0;
        (r, s) = (s, (r.0 - q * s.0, r.1 - q * s.1));
    }
    let (n, d) = s;
    if d == 0 || d.abs() > bound {
        return None;
    }
    let exact = Number::ratio(n * d.signum(), d.abs());
    matches!(exact, Number::Rational(..)).then_some(exact)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sum_of_products_is_what_it_is_term_by_term() {
        for n in 0..PRIMES.len() {
            let field = PrimeField::nth(n);
            let p = u128::from(field.prime());
            // the largest residues, so that every bound is met
            let factors: Vec<u64> = (1..200).map(|k| field.prime() - k * k).collect();
            let mut sum = field.unreduced(field.residue(factors[0]));
            let mut expected = u128::from(factors[0]);
            for pair in factors.windows(2) {
                field.add_product(&mut sum, field.residue(pair[0]), field.residue(pair[1]));
                expected = (expected + u128::from(pair[0]) * u128::from(pair[1])) % p;
                assert_eq!(u128::from(field.value(field.reduced(sum))), expected);
            }
            // in Montgomery's form too the largest
            let largest = Residue(field.prime() - 1);
            let mut sum = field.unreduced(largest);
            let mut slow = largest;
            for _ in 0..100 {
                field.add_product(&mut sum, largest, largest);
                slow = field.add(slow, field.mul(largest, largest));
                assert_eq!(field.reduced(sum), slow);
                field.add_products(&mut sum, [largest; 4], [largest; 4]);
                for _ in 0..4 {
                    slow = field.add(slow, field.mul(largest, largest));
                }
                assert_eq!(field.reduced(sum), slow);
            }
        }
    }
}
