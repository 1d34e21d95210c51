//! Features of the energy that no number resolves: a barrier about x = 9 that is thinner than 1e-15 lies between two numbers, and every
//! motion passes it unseen.
//!
//! In: the energy, a start. Out: a warning. Never here: motions.

use crate::diagnostic::Diagnostic;
use crate::expr::{Expr, Node, Symbol};
use crate::mechanics::Equations;
use crate::model::Model;
use crate::num::short;
use crate::system::{State, System};

/// A change of the energy by this part of it counts.
const COUNTS: f64 = 1e-6;

/// A feature is within the first of these, in distances of numbers from its place, and the energy is the same at the second.
const BESIDE: [f64; 2] = [8.0, 64.0];

/// What is linear in a coordinate is so to this part.
const LINEAR: f64 = 1e-9;

/// What a motion may pass unseen, at the coordinate in whose direction it lies. Jumps of the law and what has no value are reported elsewhere.
pub fn unresolved_feature(
    (model, equations, system): (&Model, &Equations, &System),
    state: &State,
    parameters: &[f64],
) -> Option<Diagnostic> {
    if state.values.is_empty() || equations.has_impulses_at_steps() {
        return None;
    }
    let mut values = vec![f64::NAN; system.channels().len()];
    system.observer(parameters).observe(state, &mut values).ok()?;
    let known = system.valuation((model, equations), state.time, parameters, &values);
    let (pool, law) = (&equations.pool, equations.energy);
    let moves = |s: Symbol| {
        let of = |c: &[Symbol; 3]| c.contains(&s);
        let all = model.coordinates.iter().map(|c| [c.position, c.velocity, c.momentum]);
        s == model.symbols.time || all.into_iter().any(|c| of(&c))
    };
    let is_of = |e: Expr, x: Symbol| {
        let symbols = pool.symbols_of(e);
        let is_sum = matches!(pool.node(e), Node::Sum(..));
        is_sum && symbols.contains(&x) && symbols.iter().all(|&s| s == x || !moves(s))
    };
    let parts = pool.reachable(&[law]);
    model.coordinates.iter().find_map(|coordinate| {
        let x = coordinate.position;
        let along =
            |e: Expr, place: f64| pool.evaluate(e, &|s| if s == x { place } else { known.at(s) });
        let sums = parts.iter().copied().filter(|&e| is_of(e, x));
        let mut places = sums.filter_map(|e| zero_of(|place| along(e, place)));
        let place = places.find(|&place| is_unresolved(|place| along(law, place), place))?;
        let (name, apart) = (&coordinate.name, short(spacing(place)));
        let message = format!(
            "the energy has a feature at {name} = {place} that is narrower than numbers there are apart ({apart}): a motion passes it \
             unseen"
        );
        Some(Diagnostic::warning(coordinate.place.clone(), message))
    })
}

/// The distance from a number to the next.
fn spacing(x: f64) -> f64 {
    x.abs().next_up() - x.abs()
}

/// The zero of a function, if it is linear, and not zero at 0.
fn zero_of(function: impl Fn(f64) -> f64) -> Option<f64> {
    let [begin, one, two] = [0.0, 1.0, 2.0].map(&function);
    let slope = one - begin;
    let place = -begin / slope;
    let is_linear = (two - one - slope).abs() <= LINEAR * slope.abs();
    (is_linear && place.is_normal()).then_some(place)
}

/// Whether a function that is constant on either side of a place has another value there, or not the same on both.
fn is_unresolved(function: impl Fn(f64) -> f64, place: f64) -> bool {
    let at = |steps: f64| function(place + steps * spacing(place));
    let here = at(0.0);
    let [near, far] = BESIDE.map(|steps| [at(-steps), at(steps)]);
    let beside = near.iter().chain(&far);
    let size = beside.clone().fold(0.0_f64, |size, x| size.max(x.abs()));
    let is_same = |a: f64, b: f64| (a - b).abs() <= COUNTS * size;
    let is_flat = near.iter().zip(&far).all(|(&near, &far)| is_same(near, far));
    let changes = near.iter().any(|&near| !is_same(here, near));
    beside.into_iter().all(|x| x.is_finite()) && !here.is_nan() && is_flat && changes
}

#[cfg(test)]
mod tests {
    use super::{is_unresolved, zero_of};
    use crate::num::math;

    #[test]
    fn what_is_narrower_than_eight_numbers_is_not_resolved() {
        let barrier = |width: f64| move |x: f64| 0.5 + math::exp(-math::powi((x - 9.0) / width, 2));
        // 8 · 1.8e-15 is 3.9 widths of the second, where 2e-7 is left, and 3.6 of the third, where 2e-6 is
        assert!(is_unresolved(barrier(1e-30), 9.0) && is_unresolved(barrier(3.6e-15), 9.0));
        assert!(!is_unresolved(barrier(3.9e-15), 9.0) && !is_unresolved(barrier(1e-3), 9.0));
        assert!(is_unresolved(|x| 1.0 + 1e-60 / math::powi(x - 9.0, 2), 9.0));
        assert!(is_unresolved(|x| math::tanh((x - 9.0) / 1e-17), 9.0));
        assert!(!is_unresolved(|x| 1.0 / (x - 9.0), 9.0) && !is_unresolved(|x| x - 9.0, 9.0));
        assert!(!is_unresolved(|x| 2.0 + (x - 9.0).abs(), 9.0));
        assert!(!is_unresolved(|x| math::sin(x - 9.0) / (x - 9.0), 9.0));
        // what is a millionth of the energy counts
        let small = |part: f64| move |x: f64| 1.0 + if x == 9.0 { part } else { 0.0 };
        assert!(is_unresolved(small(1.1e-6), 9.0) && !is_unresolved(small(0.9e-6), 9.0));
    }

    #[test]
    fn linear_functions_have_one_zero() {
        assert_eq!(zero_of(|x| 2.0 * x - 18.0), Some(9.0));
        assert_eq!(
            (zero_of(|x| x * x - 4.0), zero_of(|x| 3.0 * x), zero_of(|_| 1.0)),
            (None, None, None)
        );
    }
}
