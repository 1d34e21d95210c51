//! A law that is the same again after a while of one of its variables: where it enters by sines and cosines alone.
//!
//! In: expressions, a symbol. Out: the rates at which their arguments turn with it, the period that they have in common. Never
//! here: which law.

use std::collections::HashSet;

use crate::expr::{Expr, FunctionId, Node, Pool, Symbol};
use crate::mechanics::{Equations, Flow, Valuation};

/// The most turns of the slowest part in a common period.
const TURNS: u32 = 64;

/// A number of turns this close to a whole one is one.
const WHOLE: f64 = 1e-9;

pub(super) fn law(equations: &Equations) -> Vec<Expr> {
    match &equations.flow {
        Flow::Lagrange { mass, force, .. } => mass.iter().flatten().chain(force).copied().collect(),
        Flow::Hamilton { velocities, momentum_rates } => {
            velocities.iter().chain(momentum_rates).copied().collect()
        }
        Flow::Poisson { rates } => rates.clone(),
    }
}

/// The rates by which a symbol turns the arguments of sines and cosines; `None` where it enters otherwise, or at a rate that
/// depends on the motion, as time in sin(x t).
pub(super) fn turning_rates(
    equations: &Equations,
    mut open: Vec<Expr>,
    (symbol, values): (Symbol, &Valuation),
) -> Option<Vec<f64>> {
    let mut own: Option<Pool> = None;
    let mut seen = HashSet::new();
    let mut rates = Vec::new();
    let of_motion: Vec<Symbol> =
        equations.coordinates.iter().flat_map(|c| [c.position, c.velocity, c.momentum]).collect();
    while let Some(e) = open.pop() {
        if !equations.pool.depends(e, symbol) || !seen.insert(e) {
            continue;
        }
        match equations.pool.node(e).clone() {
            Node::Symbol(_) => return None,
            Node::Call(FunctionId::Sin | FunctionId::Cos | FunctionId::Tan, arguments) => {
                let pool = own.get_or_insert_with(|| equations.pool.clone());
                let slope = pool.derivative(*arguments.first()?, symbol);
                let rate = pool.evaluate(slope, &|other| {
                    if other == symbol { f64::NAN } else { values.at(other) }
                });
                if pool.depends_on_any(slope, &of_motion) || !rate.is_finite() {
                    return None;
                }
                if rate != 0.0 {
                    rates.push(rate.abs());
                }
            }
            node => open.extend(node.parts()),
        }
    }
    Some(rates)
}

/// The shortest time, or the least displacement, in which all turn by whole turns.
pub(super) fn common_period(rates: &[f64]) -> Option<f64> {
    let slowest = rates.iter().copied().fold(f64::INFINITY, f64::min);
    let whole = |turns: f64| (turns - turns.round()).abs() <= WHOLE * turns;
    let turn = std::f64::consts::TAU / slowest;
    let common = |count: &u32| rates.iter().all(|rate| whole(f64::from(*count) * rate / slowest));
    let count = (1..=TURNS).find(common).filter(|_| slowest.is_finite())?;
    Some(f64::from(count) * turn)
}

#[cfg(test)]
mod tests {
    use super::common_period;

    #[test]
    fn turns_have_a_period_in_common_up_to_a_billionth_and_sixty_four_turns() {
        let turns = |rates: &[f64]| Some(common_period(rates)? * rates[0] / std::f64::consts::TAU);
        assert_eq!(turns(&[2.0, 3.0]), Some(2.0));
        assert_eq!(turns(&[1.0, 1.0 + 0.9e-9]), Some(1.0));
        assert_eq!(turns(&[1.0, 1.0 + 1.1e-9]), None);
        assert_eq!(turns(&[64.0, 65.0]).map(f64::round), Some(64.0));
        assert_eq!(turns(&[65.0, 66.0]), None);
    }
}
