//! The virtual work at an equilibrium: what each term of the forces does along a small displacement of each coordinate.
//!
//! δW = Σ Qᵢ δqᵢ vanishes for every displacement there (H. Goldstein, *Classical Mechanics*, §1.4). Qᵢ is the rate of pᵢ at rest: −∂V/∂qᵢ and
//! what acts beside it; where cyclic coordinates keep changing, the centrifugal forces of their motion are among its terms. Under
//! constraints the displacements that they forbid do work too, against the forces λ A of the constraints.
//!
//! In: equations, an equilibrium. Out: terms and their values. Never here: where equilibria are.

use std::collections::HashMap;

use nalgebra::{DMatrix, DVector};

use super::linear;
use crate::expr::{Expr, Pool, Symbol};
use crate::mechanics::{Equations, Flow, Valuation};
use crate::model::Model;
use crate::num::significant;

/// A sum of forces below this part of the largest is zero.
const SUMS_TO_ZERO: f64 = 1e-9;

/// Forces of a constraint below this part of what the constraints balance are rounding of the equations for the multipliers.
const SOLVED: f64 = 64.0 * f64::EPSILON;

/// Forces whose sum is more than this part of the largest of them, and of what they change by over the size of a coordinate or its
/// unit, do not balance.
const OUT_OF_BALANCE: f64 = 1e-4;

/// A term that has more parts than this is shown as a whole.
const MOST_PARTS: usize = 12;

/// The generalised force on a coordinate at an equilibrium, term by term.
#[derive(Clone, PartialEq, Debug)]
pub struct VirtualWork {
    /// The coordinate, by index.
    pub coordinate: usize,
    /// Each term, in mathematical notation, with its value.
    pub terms: Vec<(String, f64)>,
}

impl VirtualWork {
    /// The sum of the terms: zero but for rounding and the accuracy of the place.
    pub fn sum(&self) -> f64 {
        self.terms.iter().map(|(_, value)| value).sum()
    }

    /// The balance of the terms: `m ω² r² cos θ sin θ − g m r sin θ = 4.905 − 4.905 = 0`.
    pub fn balance(&self) -> String {
        let largest = self.terms.iter().fold(0.0_f64, |most, (_, value)| most.max(value.abs()));
        if largest == 0.0 {
            return "0".to_owned();
        }
        let short = |x: f64| significant(x, 4, 1e-4..1e5).replace('-', "−");
        let terms = added(self.terms.iter().map(|(term, _)| term.clone()));
        let values = added(self.terms.iter().map(|(_, value)| short(*value)));
        // beyond what the place is known to, the sum is zero
        let sum = if sums_to_zero(self.sum(), largest) { 0.0 } else { self.sum() };
        format!("{terms} = {values} = {}", short(sum))
    }
}

/// The forces at an equilibrium: the virtual work along each coordinate that rests, and the multiplier of each constraint.
pub(super) struct Balance {
    pub(super) work: Vec<VirtualWork>,
    /// Whether the forces balance there, as far as that is known without those of constraints: in the tail of exp(−x⁴) they vanish
    /// only for want of smaller numbers, and next to a singular place what is left is not rounding.
    pub(super) holds: bool,
    pub(super) multipliers: Vec<f64>,
}

/// A sum of terms that have their signs.
fn added(terms: impl Iterator<Item = String>) -> String {
    let mut text = String::new();
    for term in terms {
        match (text.is_empty(), term.strip_prefix('−')) {
            (true, _) => text.push_str(&term),
            (false, Some(rest)) => text.push_str(&format!(" − {rest}")),
            (false, None) => text.push_str(&format!(" + {term}")),
        }
    }
    text
}

struct ForceTerm {
    shown: String,
    expression: Expr,
    /// Its derivatives along the coordinates that rest, by index.
    slopes: Vec<(usize, Expr)>,
}

impl ForceTerm {
    fn new(pool: &mut Pool, expression: Expr, resting: &[(usize, Symbol)]) -> ForceTerm {
        let slope = |&(i, q): &(usize, Symbol)| (i, pool.derivative(expression, q));
        let slopes = resting.iter().map(slope).collect();
        ForceTerm { shown: pool.unicode(expression), expression, slopes }
    }

    /// Whether its value is below the normal numbers by underflow.
    fn underflows(&self, pool: &Pool, known: &Valuation) -> bool {
        known.value(pool, self.expression).abs() < f64::MIN_POSITIVE
            && pool.underflows(self.expression, &|symbol| known.at(symbol))
    }

    /// By how much it changes over the size of each coordinate, or over its unit.
    fn change(&self, pool: &Pool, known: &Valuation, (place, units): (&[f64], &[f64])) -> f64 {
        let change = |&(i, slope): &(usize, Expr)| {
            known.value(pool, slope).abs() * place[i].abs().max(units[i])
        };
        self.slopes.iter().map(change).sum()
    }

    fn value(&self, pool: &Pool, known: &Valuation, place: &[f64]) -> f64 {
        let value = known.value(pool, self.expression);
        let slopes = self.slopes.iter();
        let sizes = slopes.map(|&(i, slope)| (known.value(pool, slope) * place[i]).abs());
        if sums_to_zero(value, sizes.fold(0.0, f64::max)) { 0.0 } else { value }
    }
}

/// A place: its variables, the units of the coordinates, the rates of the cyclic ones by index.
type TestConfiguration<'a> = (&'a [f64], &'a [f64], &'a [(usize, f64)]);

/// The forces at each place on the coordinates that rest; none where the law is a bracket.
pub(super) fn virtual_work(
    (model, equations): (&Model, &Equations),
    parameters: &[f64],
    places: &[TestConfiguration],
) -> Vec<Balance> {
    let (Flow::Lagrange { momentum_rates, .. } | Flow::Hamilton { momentum_rates, .. }) =
        &equations.flow
    else {
        return Vec::new();
    };
    let mut pool = equations.pool.clone();
    let n = equations.coordinates.len();
    let Some((_, _, going)) = places.first() else { return Vec::new() };
    // cyclic coordinates keep changing at every place
    let rests = |i: usize| going.iter().all(|&(cyclic, _)| cyclic != i);
    let resting: Vec<usize> = (0..n).filter(|&i| rests(i)).collect();
    let still: HashMap<_, _> =
        resting.iter().map(|&i| (equations.coordinates[i].velocity, Expr::ZERO)).collect();
    let symbols: Vec<(usize, Symbol)> =
        resting.iter().map(|&i| (i, equations.coordinates[i].position)).collect();
    let mut forces = Vec::new();
    for &i in &resting {
        let rate = pool.substitute(momentum_rates[i], &still);
        let mut force = Vec::new();
        for (factor, term) in pool.summands(rate) {
            let term = pool.scale(factor, term);
            let product = pool.multiplied_out(term);
            let mut parts = Vec::new();
            for (factor, part) in pool.summands(product) {
                let part = pool.scale(factor, part);
                parts.push(ForceTerm::new(&mut pool, part, &symbols));
            }
            parts.truncate(if parts.len() > MOST_PARTS { 0 } else { MOST_PARTS });
            force.push((ForceTerm::new(&mut pool, term, &symbols), parts));
        }
        forces.push((i, force));
    }
    let at = |&(variables, units, rates): &TestConfiguration| {
        let mut known = Valuation::of_parameters(model, parameters);
        known.set(equations.symbols.time, 0.0);
        for (i, symbols) in equations.coordinates.iter().enumerate() {
            known.set(symbols.position, variables[i]);
            known.set(symbols.momentum, variables[n + i]);
            known.set(symbols.velocity, 0.0);
        }
        for &(i, rate) in rates {
            known.set(equations.coordinates[i].velocity, rate);
        }
        without_constraints(equations, &mut known);
        let others = forces.iter().map(|(i, force)| {
            let rate = known.value(&pool, momentum_rates[*i]);
            let terms = force.iter().map(|(term, _)| term.value(&pool, &known, variables));
            let largest = terms.clone().fold(0.0_f64, |most, term| most.max(term.abs()));
            // rounding is nothing for a constraint to balance
            let balanced = sums_to_zero(terms.sum(), largest);
            if balanced { 0.0 } else { -rate }
        });
        let others = DVector::from_iterator(resting.len(), others);
        let multipliers = multipliers(&pool, equations, &resting, &mut known, &others);
        let work = forces.iter().map(|(coordinate, force)| {
            let value = |term: &ForceTerm| term.value(&pool, &known, variables);
            let mut terms = Vec::new();
            for (whole, parts) in force {
                let largest = parts.iter().fold(0.0_f64, |most, part| most.max(value(part).abs()));
                // forces with a common factor may balance within it
                let balanced = sums_to_zero(value(whole), largest);
                let shown = if balanced { &parts[..] } else { std::slice::from_ref(whole) };
                terms.extend(shown.iter().map(|term| (term.shown.clone(), value(term))));
            }
            // what is zero by itself is no part of the balance
            terms.retain(|(_, value)| *value != 0.0);
            VirtualWork { coordinate: *coordinate, terms }
        });
        let holds = forces.iter().all(|(_, force)| {
            let (mut sum, mut largest, mut change) = (0.0, 0.0_f64, 0.0);
            for (term, _) in force {
                let value = known.value(&pool, term.expression);
                sum += value;
                largest = largest.max(value.abs());
                change += term.change(&pool, &known, (variables, units));
            }
            let nothing = largest.max(change) < f64::MIN_POSITIVE;
            let lost = nothing && force.iter().any(|(term, _)| term.underflows(&pool, &known));
            // the forces of constraints are not among the terms
            let is_free = equations.constraints.is_empty();
            let pushed = is_free && is_out_of_balance(sum, largest + change);
            !lost && !pushed
        });
        Balance { work: work.collect(), holds, multipliers }
    };
    places.iter().map(at).collect()
}

fn sums_to_zero(sum: f64, largest: f64) -> bool {
    sum.abs() <= SUMS_TO_ZERO * largest
}

/// Whether forces do not balance, by their sum beside the largest and what they change by.
fn is_out_of_balance(sum: f64, size: f64) -> bool {
    sum.abs() > OUT_OF_BALANCE * size
}

/// Whether a force of a constraint is rounding beside what the constraints balance.
fn is_unresolved(force: f64, others: f64) -> bool {
    force <= SOLVED * others
}

/// Sets all multipliers to zero: what acts then are the other forces.
fn without_constraints(equations: &Equations, known: &mut Valuation) {
    for row in &equations.constraints {
        known.set(row.multiplier, 0.0);
    }
}

/// Sets the multipliers of least norm by which forces of constraints on the coordinates that rest come to these, and returns them.
fn multipliers(
    pool: &Pool,
    equations: &Equations,
    resting: &[usize],
    known: &mut Valuation,
    others: &DVector<f64>,
) -> Vec<f64> {
    let rows = &equations.constraints;
    if rows.is_empty() {
        return Vec::new();
    }
    let forces = DMatrix::from_fn(resting.len(), rows.len(), |i, k| {
        known.value(pool, rows[k].row[resting[i]])
    });
    let Some(mut found) = linear::least_squares(&forces, others, 0.0) else { return Vec::new() };
    for (k, multiplier) in found.iter_mut().enumerate() {
        if is_unresolved((forces.column(k) * *multiplier).norm(), others.norm()) {
            *multiplier = 0.0;
        }
    }
    rows.iter().zip(&found).for_each(|(row, &multiplier)| known.set(row.multiplier, multiplier));
    found.iter().copied().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_sum_to_zero_to_a_billionth_and_are_out_of_balance_beyond_1e_4() {
        assert!(sums_to_zero(-1.9e-9, 2.0) && !sums_to_zero(-2.1e-9, 2.0));
        assert!(is_out_of_balance(-2.1e-4, 2.0) && !is_out_of_balance(-1.9e-4, 2.0));
        // 64 units in the last place, 1.42e-14
        assert!(is_unresolved(2.8e-14, 2.0) && !is_unresolved(2.9e-14, 2.0));
    }

    #[test]
    fn a_balance_is_written_as_zero_to_a_billionth_of_its_largest_term() {
        let balance = |left: f64| {
            let terms = vec![("a".to_owned(), 2.0 + left), ("−b".to_owned(), -2.0)];
            VirtualWork { coordinate: 0, terms }.balance()
        };
        assert!(balance(1.9e-9).ends_with("= 0"), "{}", balance(1.9e-9));
        assert!(!balance(2.1e-9).ends_with("= 0"), "{}", balance(2.1e-9));
    }
}
