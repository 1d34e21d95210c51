//! The elementary functions at difficult points, compared with `tests/elementary.txt` (mpmath, 2400 bits).

use std::collections::BTreeMap;

use phaselab::num::math;

/// The greatest error allowed, in units in the last place of the true value.
const CLAIMED: f64 = 2.0;

/// The least number of points for each function.
const FEWEST: usize = 140;

/// The rank of a double among all doubles.
fn rank(x: f64) -> i64 {
    let bits = x.abs().to_bits() as i64;
    if x.is_sign_negative() { -bits } else { bits }
}

fn value(name: &str, x: f64, y: f64) -> f64 {
    match name {
        "sin" => math::sin(x),
        "cos" => math::cos(x),
        "tan" => math::tan(x),
        "asin" => math::asin(x),
        "acos" => math::acos(x),
        "atan" => math::atan(x),
        "atan2" => math::atan2(x, y),
        "sinh" => math::sinh(x),
        "cosh" => math::cosh(x),
        "tanh" => math::tanh(x),
        "exp" => math::exp(x),
        "exp2" => math::exp2(x),
        "ln" => math::ln(x),
        "ln_1p" => math::ln_1p(x),
        "log2" => math::log2(x),
        "log10" => math::log10(x),
        "cbrt" => math::cbrt(x),
        "hypot" => math::hypot(x, y),
        "powf" => math::powf(x, y),
        _ => panic!("there is no function {name}"),
    }
}

#[test]
fn elementary_functions_keep_to_two_units_of_the_last_place() {
    let mut worst: BTreeMap<&str, (usize, f64, f64, f64)> = BTreeMap::new();
    for line in include_str!("../elementary.txt").lines().filter(|line| !line.starts_with('#')) {
        let words: Vec<&str> = line.split(' ').collect();
        let (name, rest) = words.split_first().unwrap();
        let (beyond, numbers) = rest.split_last().unwrap();
        let number = |word: &&str| f64::from_bits(u64::from_str_radix(word, 16).unwrap());
        let numbers: Vec<f64> = numbers.iter().map(number).collect();
        let (nearest, arguments) = numbers.split_last().unwrap();
        let (x, y) = (arguments[0], arguments.get(1).copied().unwrap_or(f64::NAN));
        let found = value(name, x, y);
        let beyond: f64 = beyond.parse().unwrap();
        let error = ((rank(found) - rank(*nearest)) as f64 - beyond).abs();
        let error = if found.is_nan() { f64::INFINITY } else { error };
        let entry = worst.entry(name).or_insert((0, 0.0, x, y));
        entry.0 += 1;
        if error > entry.1 {
            (entry.1, entry.2, entry.3) = (error, x, y);
        }
    }
    assert_eq!(worst.len(), 19, "{worst:?}");
    let wrong = |(count, error, ..): &(usize, f64, f64, f64)| *count < FEWEST || *error > CLAIMED;
    assert!(!worst.values().any(wrong), "points, greatest error, where: {worst:#?}");
    // the test can detect an error of a whole unit
    assert!(worst.values().any(|(_, error, ..)| *error > 0.5), "{worst:?}");
}
