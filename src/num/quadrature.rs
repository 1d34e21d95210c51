//! Gauss's quadrature on an interval.
//!
//! In: a number of nodes. Out: nodes and weights on [0, 1]. The nodes are the zeros of Legendre's
//! polynomial, found by Newton's iteration (W. H. Press et al., Numerical Recipes, 4.6).

use super::math;
use super::root::newton;

/// The nodes and weights of the rule with `count` nodes on [0, 1].
pub fn gauss(count: usize) -> Vec<(f64, f64)> {
    (0..count).map(|i| node(count, i)).collect()
}

/// The Legendre polynomial of degree n ≥ 1, and that of the degree below it.
pub fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut last, mut value) = (1.0, x);
    for k in 2..=n {
        let k = k as f64;
        (last, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * last) / k);
    }
    (value, last)
}

fn node(count: usize, i: usize) -> (f64, f64) {
    let n = count as f64;
    let guess = math::cos(std::f64::consts::PI * (i as f64 + 0.75) / (n + 0.5));
    let mut slope = 1.0;
    let x = newton(guess, 100, |x| {
        let (value, last) = legendre(count, x);
        slope = n * (x * value - last) / (x * x - 1.0);
        value / slope
    });
    (0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rule_of_n_nodes_integrates_powers_below_2n() {
        for count in 2..=16 {
            let rule = gauss(count);
            for power in 0..2 * count {
                let sum: f64 = rule.iter().map(|(x, w)| w * math::powi(*x, power as i32)).sum();
                assert!((sum - 1.0 / (power as f64 + 1.0)).abs() < 4e-15, "{count}: x^{power}");
            }
            let beyond = 2 * count as i32;
            let sum: f64 = rule.iter().map(|(x, w)| w * math::powi(*x, beyond)).sum();
            assert!(count > 6 || (sum - 1.0 / f64::from(beyond + 1)).abs() > 1e-9, "{count}");
        }
    }
}
