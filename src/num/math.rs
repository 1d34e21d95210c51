//! The elementary functions of `f64`, with the same arithmetic on every machine.
//!
//! The functions in `std` come from the platform's C library and may differ in the last bit between
//! platforms. A chaotic motion turns that bit into a different motion, so a demo recorded on one
//! machine would differ from one recorded on another. The functions here come from `libm`, which
//! uses only operations that IEEE 754 defines to the bit. `sqrt`, `mul_add`, `floor`, … of `std`
//! are defined to the bit as well and are used directly.
//!
//! Angles are in radians: `asin` and `atan` lie in [−π/2, π/2], `acos` in [0, π], `atan2(y, x)` in [−π, π]. `ln_1p(x)` is
//! ln(1 + x), accurate for small x; `hypot(x, y)` is √(x² + y²), without overflow in between.
//!
//! In and out: numbers. Never here: other precisions (`double_double`), expressions. Elsewhere
//! `clippy.toml` and a test forbid the elementary functions of `std`.

pub use libm::{
    acos, asin, atan, atan2, cbrt, cos, cosh, exp, exp2, hypot, log as ln, log1p as ln_1p, log2,
    log10, pow as powf, sin, sincos as sin_cos, sinh, tan, tanh,
};

/// `x` raised to an integer power, by squaring; a negative power is the reciprocal of the positive
/// one.
///
/// `std` leaves the order of the products, and so their rounding, to the compiler.
pub fn powi(x: f64, n: i32) -> f64 {
    let (mut power, mut square, mut left) = (1.0, x, n.unsigned_abs());
    loop {
        if left & 1 == 1 {
            power *= square;
        }
        left >>= 1;
        if left == 0 {
            return if n < 0 { 1.0 / power } else { power };
        }
        square *= square;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// These bits must come out on every machine, for arguments where C libraries are known to
    /// differ; each result lies within two units of the last place of the true value.
    #[test]
    fn the_bits_are_the_same_everywhere() {
        let check = |name: &str, found: f64, expected: u64| {
            assert_eq!(found.to_bits(), expected, "{name}: {found:?} = {:#018x}", found.to_bits());
        };
        check("sin 1e22", sin(1e22), 0xbfeb_453a_b76b_f397);
        check("cos 0.5", cos(0.5), 0x3fec_1528_065b_7d50);
        check("tan 1.57", tan(1.57), 0x4093_9f0f_f737_e7f3);
        check("asin 0.9", asin(0.9), 0x3ff1_ea93_705f_a172);
        check("acos -0.3", acos(-0.3), 0x3ffe_0200_bbc9_6ad8);
        check("atan 3", atan(3.0), 0x3ff3_fc17_6b7a_8560);
        check("atan2 -1 2", atan2(-1.0, 2.0), 0xbfdd_ac67_0561_bb4f);
        check("sinh 1.3", sinh(1.3), 0x3ffb_2c93_1004_5c64);
        check("cosh 1.3", cosh(1.3), 0x3fff_88dd_5c27_9504);
        check("tanh 0.7", tanh(0.7), 0x3fe3_56fb_17af_2e90);
        check("exp 0.7", exp(0.7), 0x4000_1c2a_6126_8987);
        check("exp2 0.7", exp2(0.7), 0x3ff9_fdf8_bcce_533d);
        check("ln 10", ln(10.0), 0x4002_6bb1_bbb5_5516);
        check("ln_1p 1e-5", ln_1p(1e-5), 0x3ee4_f8ae_a9ae_7317);
        check("log10 2", log10(2.0), 0x3fd3_4413_509f_79ff);
        check("log2 10", log2(10.0), 0x400a_934f_0979_a371);
        check("powf 1.1 2.4", powf(1.1, 2.4), 0x3ff4_1cc1_c85f_4457);
        check("powi 1.1 13", powi(1.1, 13), 0x400b_9e40_5ed5_ecb6);
        check("cbrt 2", cbrt(2.0), 0x3ff4_28a2_f98d_728b);
        check("hypot 1 2", hypot(1.0, 2.0), 0x4001_e377_9b97_f4a8);
    }

    #[test]
    fn integer_powers_reach_both_ends() {
        assert_eq!(powi(2.0, i32::MIN), 0.0);
        assert_eq!(powi(0.5, i32::MIN), f64::INFINITY);
        assert_eq!((powi(0.0, 0), powi(-3.0, 3), powi(-2.0, -2)), (1.0, -27.0, 0.25));
    }
}
