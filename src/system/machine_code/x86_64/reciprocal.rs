//! Quotients by an integer as products with its reciprocal: a division takes three times as long as a product, and each order of a
//! series waits for that of the order before.
//!
//! In: an integer. Out: its reciprocal in two parts, with which two products have the bits of the division. Never here:
//! divisors that are not integers, code.
//!
//! ```text
//!   1/n = high + low,  high toward zero:    x/n  =  x · high + (x · low)      the outer product and sum with one rounding
//! ```
//!
//! The sum is off by no more than 2⁻⁵¹ of a last digit before it is rounded, while no quotient by n is nearer than 1/(2n) of one to the middle
//! between two numbers; one that is in the middle would have no room for x (N. Brisebarre, J.-M. Muller, IEEE Trans. Computers 57
//! (2008) 165, whose method this is). Both parts are positive, so that a zero keeps its sign. Quotients below 2⁻¹⁰⁰⁰ may differ
//! in the last digit.

/// The reciprocal of an integer.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Reciprocal {
    /// Rounded toward zero.
    pub(super) high: f64,
    /// What is missing; `None` for a power of two, of which nothing is.
    pub(super) low: Option<f64>,
}

impl Reciprocal {
    /// That of a positive integer.
    pub(super) fn of(n: usize) -> Reciprocal {
        let divisor = n as f64;
        let nearest = 1.0 / divisor;
        // exact, as is the same below
        let missing = |high: f64| (-divisor).mul_add(high, 1.0);
        let high = if missing(nearest) < 0.0 { nearest.next_down() } else { nearest };
        let low = missing(high) / divisor;
        Reciprocal { high, low: (low != 0.0).then_some(low) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the code computes.
    fn quotient(x: f64, Reciprocal { high, low }: Reciprocal) -> f64 {
        low.map_or(x * high, |low| x.mul_add(high, x * low))
    }

    #[test]
    fn products_with_a_reciprocal_have_the_bits_of_the_quotient() {
        let next =
            |x: &u64| Some(x.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407));
        let noise: Vec<u64> = std::iter::successors(Some(7), next).skip(1).take(2000).collect();
        for n in 1..=64 {
            let reciprocal = Reciprocal::of(n);
            assert_eq!(reciprocal.low.is_none(), n.is_power_of_two());
            // multiples and what is next to them, where the remainder is least
            let near = noise.iter().flat_map(|x| {
                let multiple = (n as u64 * (x >> 18)) as f64;
                [multiple, multiple.next_up(), multiple.next_down(), (x >> 11) as f64]
            });
            let scaled = near.zip(&noise).map(|(x, &bits)| {
                let power = f64::from_bits((523 + bits % 1000) << 52);
                if bits & 1 << 40 == 0 { x * power } else { -x * power }
            });
            for x in scaled.chain([0.0, -0.0, f64::INFINITY, f64::NEG_INFINITY]) {
                let (found, right) = (quotient(x, reciprocal), x / n as f64);
                assert_eq!(found.to_bits(), right.to_bits(), "{x:e}/{n}");
            }
            assert!(quotient(f64::NAN, reciprocal).is_nan());
        }
    }
}
