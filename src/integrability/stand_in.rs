//! Exact numbers in place of parameters' values that are no short fractions.
//!
//! In: a model with its values. Out: each parameter, and what follows from a body, with the number that a search puts in.
//! What is found for stand-ins is claimed only if it is proved with the names of the parameters. Never here: searches.

use crate::expr::Symbol;
use crate::mechanics::{Equations, exact_constants};
use crate::model::Model;
use crate::num::Number;

/// The parameters and what follows from a body, each with an exact number: its value, or where that is not a short fraction
/// a stand-in, since products of such values are rounded and the relations of a search would no longer hold. Those whose
/// ratio is a short fraction have stand-ins with that ratio, and no others have.
pub(super) fn constants(model: &Model, equations: &Equations) -> Vec<(Symbol, Number)> {
    stand_ins(exact_constants(model, equations))
}

/// Exact numbers in place of those that are not.
fn stand_ins(values: Vec<(Symbol, Number)>) -> Vec<(Symbol, Number)> {
    let mut classes: Vec<f64> = Vec::new();
    let class_of = |x: f64, classes: &mut Vec<f64>| {
        let ratio = |(k, &first): (usize, &f64)| Some((k, Number::short_ratio(x, first)?));
        classes.iter().enumerate().find_map(ratio).unwrap_or_else(|| {
            classes.push(x);
            (classes.len() - 1, Number::ONE)
        })
    };
    let placed: Vec<(Symbol, Result<Number, (usize, Number)>)> = values
        .into_iter()
        .map(|(s, value)| {
            let known = if value.is_long() {
                Err(class_of(value.value(), &mut classes))
            } else {
                Ok(value)
            };
            (s, known)
        })
        .collect();
    // a prime that divides a ratio or an exact value would make relations that the values do not have
    let taken: Vec<Number> =
        placed.iter().map(|(_, value)| value.unwrap_or_else(|(_, ratio)| ratio)).collect();
    let stand_in = |(class, ratio): (usize, Number)| {
        let sign = if classes[class] < 0.0 { Number::MINUS_ONE } else { Number::ONE };
        square(class, &taken) * ratio * sign
    };
    placed.into_iter().map(|(s, value)| (s, value.unwrap_or_else(stand_in))).collect()
}

/// Whether some of them are stand-ins: what is found for these is claimed only if it is proved with the names of the
/// parameters.
pub(super) fn has_stand_ins(model: &Model, equations: &Equations) -> bool {
    exact_constants(model, equations).iter().any(|(_, value)| value.is_long())
}

/// The square of a prime, so that roots of quotients are fractions; another one for each class, and none that divides one of
/// some numbers but zero. The primes are small, since products of many numbers must stay exact.
fn square(class: usize, taken: &[Number]) -> Number {
    let divides = |p: i64| {
        taken.iter().any(|number| match number {
            Number::Rational(n, d) => *n != 0 && n % p == 0 || d % p == 0,
            Number::Real(_) => false,
        })
    };
    let fits = |&p: &i64| (2..=p.isqrt()).all(|d| p % d != 0) && !divides(p);
    let root = (2..).filter(fits).nth(class).unwrap_or(2);
    Number::Rational(root, 1) * Number::Rational(root, 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::Pool;

    /// Every prime divides zero.
    #[test]
    fn a_zero_beside_them_takes_no_stand_in_away() {
        let mut pool = Pool::new();
        let (a, b) = (pool.symbol("a"), pool.symbol("b"));
        let given = vec![(a, Number::ZERO), (b, Number::Real(std::f64::consts::PI))];
        let exact = stand_ins(given);
        assert_eq!((exact[0].1, exact[1].1), (Number::ZERO, Number::integer(4)));
    }

    /// Products of measured values overflow exact numbers as those of tiny ones do.
    #[test]
    fn a_value_with_many_digits_has_a_stand_in_and_one_with_few_has_none() {
        let mut pool = Pool::new();
        let (a, b) = (pool.symbol("a"), pool.symbol("b"));
        let given = [(a, 15.994_914_619_56), (b, 15.9994)];
        let exact = stand_ins(given.map(|(s, x)| (s, Number::Real(x).canonical())).to_vec());
        assert_eq!((exact[0].1, exact[1].1.value()), (Number::integer(9), 15.9994));
    }

    /// 9/4 is the ratio of the squares of the first two primes.
    #[test]
    fn stand_ins_have_the_ratios_of_their_values_and_no_others() {
        let mut pool = Pool::new();
        let symbols = ["a", "b", "c", "d", "e"].map(|name| pool.symbol(name));
        let pi = std::f64::consts::PI;
        let values = [pi * 1e-30, 1e-30, 2.25 * pi * 1e-30, 4e-30 / 9.0, 25.0];
        let given = symbols.iter().zip(values).map(|(&s, x)| (s, Number::Real(x).canonical()));
        let exact = stand_ins(given.collect());
        let value = |k: usize| exact[k].1.value();
        assert_eq!(value(2) / value(0), 2.25);
        assert!((value(3) / value(1) - 4.0 / 9.0).abs() < 1e-15);
        assert_eq!(value(4), 25.0);
        for (i, j) in [(0, 1), (0, 3), (1, 2), (2, 3)] {
            let ratio = value(i) / value(j);
            assert!(Number::short_ratio(ratio, 1.0).is_none(), "{i} and {j}: {ratio}");
        }
    }
}
