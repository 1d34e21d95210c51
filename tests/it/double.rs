//! Double-double arithmetic against values computed to 120 digits (mpmath).

#![allow(
    clippy::unreadable_literal,
    clippy::approx_constant,
    clippy::excessive_precision,
    reason = "digits as the reference printed them; some are near a constant's"
)]

use phaselab::num::{Analytic, DoubleDouble};

/// The function, its argument as written, and its value as the sum of two numbers.
const VALUES: &[(&str, f64, (f64, f64))] = &[
    ("exp", 0.1, (1.1051709180756477, -8.763017013024472e-17)),
    ("exp", -3.7, (0.02472352647033939, -3.725242127087014e-19)),
    ("exp", 0.0001, (1.0001000050001667, -4.326411477156449e-17)),
    ("exp", 20.25, (622964442.1984454, 4.431525420935365e-08)),
    ("exp", -1e-9, (0.999999999, -2.778193146359195e-17)),
    ("exp", 300.5, (3.202519714603633e+130, 3.450128650899247e+112)),
    ("ln", 0.1, (-2.302585092994046, 2.1707562233822494e-16)),
    ("ln", 3.7, (1.3083328196501787, 9.147020127290218e-17)),
    ("ln", 1.0001, (9.999500033330834e-05, -4.154282797748557e-21)),
    ("ln", 1e20, (46.051701859880914, -7.88798767963998e-16)),
    ("ln", 1e-30, (-69.07755278982137, -2.369515526854504e-15)),
    ("ln", 2.0, (0.6931471805599453, 2.3190468138462996e-17)),
    ("sin", 0.1, (0.09983341664682815, -2.443367540153075e-18)),
    ("sin", -3.7, (0.5298361409084932, 3.264280461246153e-17)),
    ("sin", 1e5, (0.03574879797201651, 1.5429743706109861e-18)),
    ("sin", 0.00001, (9.999999999833334e-06, -1.9979693281312932e-22)),
    ("sin", 100.7, (0.16823126505448543, 1.9535206858270185e-18)),
    ("cos", 0.1, (0.9950041652780258, -5.4466828902896175e-17)),
    ("cos", -30.2, (0.3474682721812606, 2.5693922874999527e-17)),
    ("cos", 12345.678, (0.7101193587161447, 6.577768174252705e-18)),
    ("tan", 0.3, (0.30933624960962325, -1.5311375567635374e-17)),
    ("tan", -1.2, (-2.5721516221263188, -1.7581198714506155e-16)),
    ("tan", 50.5, (0.23891364890036568, 3.655843139816145e-18)),
    ("sinh", 0.001, (0.001000000166666675, -5.653412071989394e-20)),
    ("sinh", -0.3, (-0.3045202934471426, -2.0782931986205492e-17)),
    ("sinh", 2.5, (6.0502044810397875, -1.5266669624477375e-16)),
    ("sinh", 30.5, (8809508975677.816, -0.0007001695076479125)),
    ("cosh", 0.001, (1.0000005000000416, 7.44379510853623e-17)),
    ("cosh", -0.3, (1.0453385141288605, 1.0752667023625657e-17)),
    ("cosh", 2.5, (6.132289479663686, 3.560067179782552e-16)),
    ("tanh", 0.001, (0.0009999996666668, -3.016047095887294e-21)),
    ("tanh", -0.3, (-0.2913126124515909, -3.699795598407408e-18)),
    ("tanh", 2.5, (0.9866142981514303, -2.4529238788172874e-17)),
    ("tanh", 20.5, (1.0, -3.1257643786699776e-18)),
    ("asin", 0.001, (0.0010000001666667416, 4.016359981162414e-20)),
    ("asin", -0.3, (-0.3046926540153975, 1.583144043021605e-17)),
    ("asin", 0.999999, (1.5693821131146724, 1.726124816832705e-17)),
    ("acos", 0.001, (1.56979632662823, -1.1011176689515366e-16)),
    ("acos", -0.3, (1.8754889808102941, -1.0110251704106218e-17)),
    ("acos", 0.999999, (0.0014142136802242518, -4.751641387087098e-20)),
    ("acos", -0.9, (2.6905658417935308, 5.1218239547619055e-17)),
    ("atan", 0.001, (0.0009999996666668666, 9.354834016115978e-20)),
    ("atan", -7.3, (-1.4346573659417559, -1.3666246266631692e-18)),
    ("atan", 1e10, (1.5707963266948965, 6.950637705727703e-17)),
    ("sqrt", 0.1, (0.31622776601683794, -7.976586724465037e-18)),
    ("sqrt", 2.0, (1.4142135623730951, -9.667293313452913e-17)),
    ("sqrt", 1e-20, (1e-10, -3.643219731549774e-27)),
    ("sqrt", 12345.6789, (111.11111060555555, 1.9946108307015468e-15)),
];

fn apply(function: &str, x: DoubleDouble) -> DoubleDouble {
    match function {
        "exp" => x.exp(),
        "ln" => x.ln(),
        "sin" => x.sin_cos().0,
        "cos" => x.sin_cos().1,
        "tan" => x.tan(),
        "sinh" => x.sinh_cosh().0,
        "cosh" => x.sinh_cosh().1,
        "tanh" => x.tanh(),
        "asin" => x.asin(),
        "acos" => x.acos(),
        "atan" => x.atan2(DoubleDouble::ONE),
        "sqrt" => x.sqrt(),
        other => panic!("no such function: {other}"),
    }
}

/// The relative error of `x` against `high + low`.
fn error(x: DoubleDouble, (high, low): (f64, f64)) -> f64 {
    (((x.high - high) + (x.low - low)) / high).abs()
}

#[test]
fn elementary_functions_are_right_to_twenty_seven_digits() {
    for &(function, x, exact) in VALUES {
        let error = error(apply(function, DoubleDouble::from_decimal(x)), exact);
        assert!(error < 1e-27, "{function}({x}): relative error {error:e}");
    }
}

#[test]
fn powers_are_right_to_thirty_digits() {
    for (x, exponent, exact) in [
        (0.3, 2.5, (0.04929503017546495, -1.482748267792178e-18)),
        (7.1, -1.5, (0.052858213031042364, -4.058707814202256e-19)),
        (2.2, 0.1, (1.0820373898183429, -5.2812893380880684e-17)),
        (0.01, -7.0, (100000000000000.0, 0.0)),
        (3.3, 1.7, (7.611560396624157, 4.278794546759554e-16)),
    ] {
        let error =
            error(DoubleDouble::from_decimal(x).power(DoubleDouble::from_decimal(exponent)), exact);
        assert!(error < 1e-29, "{x}^{exponent}: relative error {error:e}");
    }
}

#[test]
fn angles_are_right_in_every_quadrant() {
    for (y, x, exact) in [
        (0.3, -2.5, (3.0221637275714546, 2.1437102977440378e-16)),
        (-0.3, -2.5, (-3.0221637275714546, -2.1437102977440378e-16)),
        (1e-5, 7.0, (1.4285714285704567e-06, 9.66494753728605e-23)),
        (-3.0, 0.001, (-1.570462993473909, -2.267643401254332e-17)),
    ] {
        let error =
            error(DoubleDouble::from_decimal(y).atan2(DoubleDouble::from_decimal(x)), exact);
        assert!(error < 1e-29, "atan2({y}, {x}): relative error {error:e}");
    }
}

/// The decimal of the shortest literal, by text.
fn by_text(x: f64) -> DoubleDouble {
    let text = format!("{x:e}");
    let (mantissa, exponent) = text.split_once('e').unwrap();
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits: i64 = format!("{whole}{fraction}").parse().unwrap();
    let exponent = exponent.parse::<i32>().unwrap() - fraction.len() as i32;
    let mut power = DoubleDouble::ONE;
    let (mut base, mut left) = (DoubleDouble::from(10.0), exponent.abs());
    while left > 0 {
        if left & 1 == 1 {
            power = power * base;
        }
        base = base * base;
        left >>= 1;
    }
    let digits = DoubleDouble::integer(digits);
    if exponent < 0 { digits / power } else { digits * power }
}

#[test]
fn the_digits_of_a_number_are_found_without_its_text() {
    let check = |x: f64| {
        let (found, expected) = (DoubleDouble::from_decimal(x), by_text(x));
        let bits = |x: DoubleDouble| (x.high.to_bits(), x.low.to_bits());
        assert_eq!(bits(found), bits(expected), "{x:e}");
    };
    // decimals of one to seventeen digits, their neighbours, and numbers of all sizes
    let mut seed = 1_u64;
    for k in 0..20_000 {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        let digits = (seed >> 11) % 10_u64.pow(1 + (k % 17) as u32);
        let x = digits as f64 / 10_f64.powi((seed % 22) as i32);
        for x in [x, x.next_up(), x.next_down(), -x, f64::from_bits(seed)] {
            // an integer stands for itself
            if x.fract() != 0.0 && x.is_finite() && (1e-200..1e200).contains(&x.abs()) {
                check(x);
            }
        }
    }
    (1..3000).for_each(|k| check(f64::from(k).mul_add(0.001, 0.0005)));
}

#[test]
fn what_is_written_is_meant() {
    // 0.1 = 0.1000000000000000055511151231257827… − 5.551115123125783e-18
    assert_eq!(DoubleDouble::from_decimal(0.1).low, -5.551115123125783e-18);
    assert_eq!(DoubleDouble::from_decimal(-2.5).low, 0.0);
    let third = DoubleDouble::ONE / DoubleDouble::from(3.0);
    assert_eq!((third * 3.0 - DoubleDouble::ONE).high.abs().max(1e-31), 1e-31);
    let small = DoubleDouble::from_decimal(9.109_383_701_5e-31);
    assert!(
        (small * DoubleDouble::from_decimal(1e31) - DoubleDouble::from_decimal(9.109_383_701_5))
            .high
            .abs()
            < 1e-30
    );
}
